/* Numbers as people read them: thousands separated, sizes and times in fitting units. */
#ifndef CAMBER_CLI_FIGURES_H
#define CAMBER_CLI_FIGURES_H

#include <stdint.h>

/* Used as in printf("%s", camber_figure_count(n).text): the text lives until the end of the full expression. */
typedef struct camber_figure {
    char text[48];
} camber_figure;

/* "1,234,567" */
camber_figure camber_figure_count(uint64_t count);
/* "1,234.50" */
camber_figure camber_figure_number(double value, int decimals);
/* "812 bytes", "1.2 MB"; a megabyte is 1,000,000 bytes. */
camber_figure camber_figure_bytes(uint64_t size_bytes);
/* "200M", as options take it: a size in KiB, MiB or GiB. If it is no whole number of them, "1.2 MB". */
camber_figure camber_figure_limit(uint64_t size_bytes);
/* "0.35 s", "12.3 s", "2 min 5 s", "3 h 20 min" */
camber_figure camber_figure_time(double ms);

#endif
