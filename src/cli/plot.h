/* The averages of compare as bars, drawn by gnuplot. */
#ifndef CAMBER_CLI_PLOT_H
#define CAMBER_CLI_PLOT_H

#include "cli/comparison.h"

/* Checks that gnuplot runs, before the work starts. Returns an exit status, its line printed. */
int camber_plot_check(camber_report *report);

/* Draws into an output that the caller publishes: SVG or PNG by its path. Returns an exit status, its line printed. */
int camber_plot_write(const camber_comparison *comparison, camber_output *output);

#endif
