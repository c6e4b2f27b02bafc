/* Prints each error and warning as one line on standard error, whatever characters a file's name contains; a progress
 * bar (progress.c) that is erased first; and JSON on standard output. Also turns a status of the library into an exit
 * status. */
#include "cli/report.h"

#include "base/whole_file.h"

#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

/* Colours of the word "camber" of a line, and of the name of OUT. */
#define RED "\033[31m"
#define YELLOW "\033[33m"
#define GREEN "\033[32m"
#define PLAIN "\033[0m"

/* https://no-color.org */
static bool shows_colors(void) {
    const char *none = getenv("NO_COLOR"), *kind = getenv("TERM");
    return isatty(STDERR_FILENO) && !(none && *none) && kind && *kind && strcmp(kind, "dumb") != 0;
}

void camber_report_open(camber_report *report, const camber_options *options) {
    *report = (camber_report){.quiet = options->quiet,
                              .verbose = options->verbose,
                              .json = options->json,
                              .bars = !options->quiet && isatty(STDERR_FILENO),
                              .colors = shows_colors()};
    report->terminal = report->bars;
}

/* A file name may contain any bytes: an error stays one line and sends no control characters to the terminal. It is
 * written in one call, so that lines of other threads and processes cannot interleave with it. color: of the prefix. */
static void print_line(camber_report *report, const char *color, const char *prefix, const char *text) {
    char line[4240];
    const size_t most = sizeof line - 2;
    const bool colored = report->colors && *color;
    size_t length = 0;
    const struct {
        const char *text;
        bool raw;
    } parts[] = {{colored ? color : "", true}, {prefix, false}, {colored ? PLAIN : "", true}, {text, false}};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        for (const char *c = parts[i].text; *c && length < most; c++)
            line[length++] = !parts[i].raw && ((unsigned char)*c < 0x20 || *c == 0x7f) ? '?' : *c;
    line[length] = '\n';
    camber_report_erase_bar(report);
    fwrite(line, 1, length + 1, stderr);
}

void camber_report_erase_bar(camber_report *report) {
    camber_progress_erase(&report->bar);
}

/* Prints a line that stays visible and says what takes so long, and that this happens only once. Another thread's
 * progress bar may be visible. */
static void say_compiles(camber_report *report, const char *stage) {
    if (!report->terminal || report->said_compiles)
        return;
    report->said_compiles = report->bar.drawn = true;
    camber_report_say(report, "%s for this machine, once; `camber info --warm` does it in advance, for all users",
                      stage);
}

void camber_report_progress(void *user, const camber_progress_info *progress) {
    camber_report *report = user;
    if (strcmp(progress->stage, "compiling kernels") == 0)
        say_compiles(report, progress->stage);
    else if (report->bars && !report->has_steps)
        camber_progress_show(&report->bar, progress);
}

void camber_report_step(camber_report *report, const char *stage, const char *unit, uint64_t done, uint64_t total) {
    const double fraction = total ? (double)done / (double)total : -1.0;
    if (report->bars)
        camber_progress_show(&report->bar, &(camber_progress_info){stage, fraction, unit, done, total});
}

/* Copies the message, and replaces the name of the temporary copy by "standard input". */
static void name_input(const camber_report *report, const char *message, char *text, size_t size) {
    const char *found = report->spool ? strstr(message, report->spool) : NULL;
    if (found)
        snprintf(text, size, "%.*sstandard input%s", (int)(found - message), message, found + strlen(report->spool));
    else
        snprintf(text, size, "%s", message);
}

void camber_report_log(void *user, camber_log_level level, const char *message) {
    camber_report *report = user;
    char text[4096];
    name_input(report, message, text, sizeof text);
    if (level == CAMBER_LOG_ERROR) {
        if (report->sealed)
            return;
        snprintf(report->error, sizeof report->error, "%s", text);
    } else if (level == CAMBER_LOG_WARNING && !report->quiet) {
        print_line(report, YELLOW, "camber: warning: ", text);
    } else if (level == CAMBER_LOG_INFO && report->verbose) {
        print_line(report, "", "camber: info: ", text);
    }
}

int camber_report_fail(camber_report *report, int exit_status, const char *format, ...) {
    char text[4096];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    if (report->keeps)
        snprintf(report->error, sizeof report->error, "%s", text);
    else
        print_line(report, RED, "camber: ", text);
    return exit_status;
}

int camber_report_input(camber_report *report, int cause) {
    if (cause == EBADF)
        return camber_report_fail(report, CAMBER_EXIT_IO, "standard input: is closed; give it a file or a pipe");
    if (cause == EISDIR)
        return camber_report_fail(report, CAMBER_EXIT_DATA, "standard input: is a folder; give it a file or a pipe");
    return camber_report_fail(report, CAMBER_EXIT_IO, "standard input: %s; copy it to a file and name that",
                              strerror(cause));
}

/* Drivers that lack memory or cannot write files do not report it: no device appears, or compiling fails. */
static void add_limits(char *text, size_t size) {
    static const struct {
        rlim_t small;
        int resource;
        char option;
    } limits[] = {{4ull << 30, RLIMIT_AS, 'v'}, {16 << 20, RLIMIT_FSIZE, 'f'}};
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++) {
        struct rlimit limit;
        const size_t used = strlen(text);
        if (getrlimit(limits[i].resource, &limit) == 0 && limit.rlim_cur < limits[i].small)
            snprintf(text + used, size - used, "; or raise ulimit -%c: drivers may need more than its %llu KB",
                     limits[i].option, (unsigned long long)limit.rlim_cur >> 10);
    }
}

int camber_report_status(camber_report *report, camber_status status) {
    int exit_status = CAMBER_EXIT_INTERNAL;
    switch (status) {
    case CAMBER_OK: return CAMBER_EXIT_DONE;
    case CAMBER_ERROR_ARGUMENT: exit_status = CAMBER_EXIT_USAGE; break;
    case CAMBER_ERROR_INPUT:
    case CAMBER_ERROR_LIMIT: exit_status = CAMBER_EXIT_DATA; break;
    case CAMBER_ERROR_NOT_FOUND: exit_status = CAMBER_EXIT_NO_INPUT; break;
    case CAMBER_ERROR_DEVICE: exit_status = CAMBER_EXIT_UNAVAILABLE; break;
    case CAMBER_ERROR_IO: exit_status = CAMBER_EXIT_IO; break;
    case CAMBER_ERROR_MEMORY: break;
    }
    if (status == CAMBER_ERROR_DEVICE)
        add_limits(report->error, sizeof report->error);
    return camber_report_fail(report, exit_status, "%s",
                              report->error[0] ? report->error : camber_status_get_name(status));
}

void camber_report_warn(camber_report *report, const char *format, ...) {
    char text[4096];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    camber_report_log(report, CAMBER_LOG_WARNING, text);
}

void camber_report_say(camber_report *report, const char *format, ...) {
    if (report->quiet)
        return;
    char text[4096];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    print_line(report, "", "", text);
}

void camber_report_done(camber_report *report, const char *out, uint64_t size_bytes, double ms, const char *format,
                        ...) {
    char what[2048], text[2304];
    if (report->quiet || report->json)
        return;
    va_list list;
    va_start(list, format);
    vsnprintf(what, sizeof what, format, list);
    va_end(list);
    snprintf(text, sizeof text, ": %s%s%s, %s", what, size_bytes ? ", " : "",
             size_bytes ? camber_figure_bytes(size_bytes).text : "", camber_figure_time(ms).text);
    print_line(report, GREEN, out, text);
}

const char *camber_plural(size_t count) {
    return count == 1 ? "" : "s";
}

json_t *camber_json_text(const char *text) {
    json_t *string = json_string(text);
    if (string)
        return string;
    char *copy = strdup(text);
    if (!copy)
        return NULL;
    for (char *c = copy; *c; c++)
        if ((unsigned char)*c >= 0x80)
            *c = '?';
    string = json_string(copy);
    free(copy);
    return string;
}

json_t *camber_json_count(size_t count) {
    return json_integer((json_int_t)count);
}

json_t *camber_json_ms(double milliseconds) {
    return json_real((double)(long long)(milliseconds * 1000 + 0.5) / 1000);
}

int camber_report_json(camber_report *report, json_t *object) {
    if (!object)
        return camber_report_fail(report, CAMBER_EXIT_INTERNAL, "JSON: out of memory; give it more");
    const int failed = json_dumpf(object, stdout, JSON_INDENT(2) | JSON_REAL_PRECISION(12));
    json_decref(object);
    fputc('\n', stdout);
    const int status = camber_report_flush(report);
    if (status == CAMBER_EXIT_DONE && failed)
        return camber_report_fail(report, CAMBER_EXIT_INTERNAL, "JSON: could not be written; give it more memory");
    return status;
}

int camber_report_flush(camber_report *report) {
    if (fflush(stdout) == 0 && !ferror(stdout))
        return CAMBER_EXIT_DONE;
    const int cause = errno;
    return camber_report_fail(report, CAMBER_EXIT_IO, "standard output: %s; %s", strerror(cause),
                              camber_file_cure(cause, "write to a file or a pipe that takes it"));
}

size_t camber_peak_rss_bytes(void) {
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) == 0 ? (size_t)usage.ru_maxrss * 1024 : 0;
}
