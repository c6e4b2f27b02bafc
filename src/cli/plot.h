/* The averages of compare as bars, drawn by gnuplot. */
#ifndef CAMBER_CLI_PLOT_H
#define CAMBER_CLI_PLOT_H

#include "cli/comparison.h"

/* Whether gnuplot runs here, which is told before the work and not after it. Returns an exit status, its line printed.
 */
int camber_plot_check(camber_report *report);

/* Draws into output, which is still to be published: SVG or PNG, as its path says. Returns an exit status, its line
 * printed. */
int camber_plot_write(const camber_comparison *comparison, camber_output *output);

#endif
