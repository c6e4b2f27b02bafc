/* Makes the line of a progress bar from what a callback tells, and draws it over itself on standard error. The line is
 * made by a clock that the caller passes, so that it can be tested; the rest only writes to the terminal. */
#define _DEFAULT_SOURCE /* TIOCGWINSZ */

#include "cli/progress.h"

#include "base/clock.h"
#include "cli/figures.h"

#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

enum { BAR_CELLS = 30, LEAST_BAR_CELLS = 10, LINE_SIZE = 256, COLUMNS_UNKNOWN = 80 };
static const double SHOW_EVERY_MS = 50, MARK_EVERY_MS = 10e3, MEASURED_MS = 1e3;

/* ---- Rates ---- */

/* Starts to measure when the stage begins, or begins again. */
static void mark(camber_progress_bar *bar, const camber_progress_info *progress, double now_ms) {
    const camber_progress_mark now = {now_ms, progress->fraction, progress->done};
    const bool goes_on = strncmp(bar->stage, progress->stage, sizeof bar->stage - 1) == 0 &&
                         now.fraction >= bar->newer.fraction && now.done >= bar->newer.done && now_ms >= bar->newer.ms;
    if (!goes_on) {
        snprintf(bar->stage, sizeof bar->stage, "%s", progress->stage);
        bar->older = bar->newer = now;
    } else if (now_ms - bar->newer.ms > MARK_EVERY_MS) {
        bar->older = bar->newer;
        bar->newer = now;
    }
}

static void write_left(char *text, size_t size, double left_s) {
    const unsigned s = (unsigned)(left_s + 0.5);
    if (s < 3600)
        snprintf(text, size, "%u:%02u left", s / 60, s % 60);
    else
        snprintf(text, size, "%u:%02u:%02u left", s / 3600, s / 60 % 60, s % 60);
}

/* ---- The line ---- */

typedef struct parts {
    char bar[BAR_CELLS + 16], percent[16], count[96], rate[48], left[32];
} parts;

static void fill_bar(double fraction, int width, parts *made) {
    char cells[BAR_CELLS + 1];
    memset(cells, ' ', (size_t)width);
    memset(cells, '#', (size_t)(fraction * width));
    cells[width] = 0;
    snprintf(made->bar, sizeof made->bar, " [%s]", cells);
}

static void fill_parts(const camber_progress_bar *bar, const camber_progress_info *progress, double now_ms,
                       parts *made) {
    const double fraction = progress->fraction < 1 ? progress->fraction : 1;
    const double elapsed_ms = now_ms - bar->older.ms, gained = fraction - bar->older.fraction;
    *made = (parts){.bar = ""};
    if (fraction >= 0) {
        fill_bar(fraction, BAR_CELLS, made);
        snprintf(made->percent, sizeof made->percent, " %3d %%", (int)(fraction * 100));
    }
    if (progress->unit && progress->total > 1)
        snprintf(made->count, sizeof made->count, "  %.24s of %.24s %.24s", camber_figure_count(progress->done).text,
                 camber_figure_count(progress->total).text, progress->unit);
    else if (progress->unit && progress->done > 1)
        snprintf(made->count, sizeof made->count, "  %.24s %.24s", camber_figure_count(progress->done).text,
                 progress->unit);
    if (elapsed_ms < MEASURED_MS)
        return;
    const double rate = (double)(progress->done - bar->older.done) / elapsed_ms * 1e3;
    if (progress->unit && rate > 0)
        snprintf(made->rate, sizeof made->rate, ", %.24s/s", camber_figure_number(rate, rate < 9.95 ? 1 : 0).text);
    const double left_s = gained > 0 ? elapsed_ms / 1e3 * (1 - fraction) / gained : -1;
    if (left_s >= 0 && left_s < 1e6) {
        snprintf(made->left, sizeof made->left, "%s", made->count[0] ? ", " : "  ");
        write_left(made->left + 2, sizeof made->left - 2, left_s);
    }
}

/* Writes a shorter bar, and leaves out parts, until the line fits, the least important first. */
void camber_progress_write(camber_progress_bar *bar, const camber_progress_info *progress, double now_ms,
                           size_t columns, char *line, size_t size) {
    parts made;
    mark(bar, progress, now_ms);
    fill_parts(bar, progress, now_ms, &made);
    char *const least[] = {made.rate, made.bar, made.count, made.left, made.percent};
    const bool unknown = !made.percent[0] && !made.count[0];
    int cells = BAR_CELLS;
    for (size_t i = 0;;) {
        const int length = snprintf(line, size, "%-15s%s%s%s%s%s%s", bar->stage, made.bar, made.percent, made.count,
                                    made.rate, made.left, unknown ? " ..." : "");
        if (i == sizeof least / sizeof *least || (size_t)length < columns)
            break;
        if (made.bar[0] && cells > LEAST_BAR_CELLS)
            fill_bar(progress->fraction < 1 ? progress->fraction : 1, --cells, &made);
        else
            least[i++][0] = 0;
    }
    if (columns > 0 && columns <= size && strlen(line) >= columns)
        line[columns - 1] = 0;
}

/* ---- The terminal ---- */

static size_t count_columns(void) {
    struct winsize window;
    const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 0;
    return known ? window.ws_col : COLUMNS_UNKNOWN;
}

void camber_progress_show(camber_progress_bar *bar, const camber_progress_info *progress) {
    char line[LINE_SIZE];
    const double now_ms = camber_now_ms();
    const bool same = strncmp(bar->stage, progress->stage, sizeof bar->stage - 1) == 0;
    if (bar->drawn && same && now_ms - bar->drawn_ms < SHOW_EVERY_MS)
        return;
    camber_progress_write(bar, progress, now_ms, count_columns(), line, sizeof line);
    bar->drawn = true;
    bar->drawn_ms = now_ms;
    fprintf(stderr, "\r\033[K%s", line);
}

void camber_progress_erase(camber_progress_bar *bar) {
    if (bar->drawn)
        fputs("\r\033[K", stderr);
    bar->drawn = false;
}
