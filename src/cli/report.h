/* Messages of the tool: errors, warnings, progress bars, JSON. */
#ifndef CAMBER_CLI_REPORT_H
#define CAMBER_CLI_REPORT_H

#include "base/clock.h"
#include "cli/options.h"

#include <jansson.h>

#if defined(__GNUC__)
#define CAMBER_PRINTF(format_index, first) __attribute__((format(printf, format_index, first)))
#else
#define CAMBER_PRINTF(format_index, first)
#endif

typedef struct camber_report {
    bool quiet, verbose;
    bool bars; /* standard error is a terminal, and bars are wanted */
    bool bar_drawn;
    bool terminal;      /* it is one, and not to be quiet */
    bool said_compiles; /* that a first run waits for a compiler */
    double bar_ms;      /* when it was drawn */
    const char *spool;  /* the copy of standard input, which messages name as that; NULL: none */
    bool sealed;        /* the first failure is known; what it causes is not news */
    bool keeps;         /* failures are kept in error, and not printed */
    char error[4096];   /* the library's last error: the message of the status that a call returns */
} camber_report;

void camber_report_open(camber_report *report, const camber_options *options);

/* Callbacks of a context; user is the report. An error is kept until camber_report_status, since what the
 * library got around is no error of the tool. */
void camber_report_log(void *user, camber_log_level level, const char *message);
void camber_report_progress(void *user, const char *stage, double fraction);
void camber_report_erase_bar(camber_report *report);

/* Prints one line "camber: ..." on standard error and returns exit_status. */
int camber_report_fail(camber_report *report, int exit_status, const char *format, ...) CAMBER_PRINTF(3, 4);
/* Tells the message of a status; returns its exit status, 0 for CAMBER_OK. */
int camber_report_status(camber_report *report, camber_status status);
/* Standard input cannot be read, for the reason that errno gave. Returns the exit status, its line printed. */
int camber_report_input(camber_report *report, int cause);
void camber_report_warn(camber_report *report, const char *format, ...) CAMBER_PRINTF(2, 3);

/* A line of people's text on standard error, unless quiet. */
void camber_report_say(camber_report *report, const char *format, ...) CAMBER_PRINTF(2, 3);

/* "s" behind a noun of which there are so many; "" of one. */
const char *camber_plural(size_t count);

/* A string for JSON: bytes that are not UTF-8 become '?'. */
json_t *camber_json_text(const char *text);
json_t *camber_json_count(size_t count);
/* Milliseconds, to the microsecond. */
json_t *camber_json_ms(double milliseconds);
/* Prints the object on standard output and releases it. Returns CAMBER_EXIT_DONE, CAMBER_EXIT_INTERNAL (object is
 * NULL or incomplete) or CAMBER_EXIT_IO. */
int camber_report_json(camber_report *report, json_t *object);
/* Flushes standard output; CAMBER_EXIT_IO where it did not take what was printed. */
int camber_report_flush(camber_report *report);

/* The most memory that the process has held. */
size_t camber_peak_rss_bytes(void);

#endif
