/* A bar chart of compare's averages, drawn by gnuplot. */
#ifndef CAMBER_CLI_PLOT_H
#define CAMBER_CLI_PLOT_H

#include "cli/comparison.h"

/* Checks before the work starts that gnuplot runs. Returns an exit status; on failure a line has been printed. */
int camber_plot_check(camber_report *report);

/* Draws into an output that the caller publishes: SVG or PNG, depending on its path. Returns an exit status; on failure
 * a line has been printed. */
int camber_plot_write(const camber_comparison *comparison, camber_output *output);

#endif
