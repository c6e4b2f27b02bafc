/* A file that appears whole or not at all. */
#ifndef CAMBER_CLI_OUTPUT_H
#define CAMBER_CLI_OUTPUT_H

#include "cli/guard.h"
#include "cli/report.h"

#include <sys/stat.h>

typedef struct camber_output {
    const char *path; /* as the user gave it */
    camber_report *report;
    camber_guard *guard;
    FILE *file;      /* NULL: not open */
    char *target;    /* path, or what it links to. NULL: written in place (standard output, a device, a pipe) */
    char *temporary; /* beside target */
    int mark;        /* a descriptor of it that stays open until it has its name; 0: none */
    bool force;
    int error; /* errno of the first write that failed */
    size_t size_bytes;
} camber_output;

/* Opens path for writing, "-" for standard output, so that what forbids it is known before the work. Regular files
 * are written beside and appear with camber_output_publish. Returns an exit status, its line printed; the output
 * can be discarded in any case. */
int camber_output_open(camber_output *output, camber_report *report, camber_guard *guard, const char *path, bool force);
/* Whether info is of the file that this one is written to or will replace, which must not be read as well. */
bool camber_output_is(const camber_output *output, const struct stat *info);
camber_sink camber_output_sink(camber_output *output);
/* The message of a failed call that wrote here: the file's, if writing is what failed, else status's. */
int camber_output_status(camber_output *output, camber_status status);
int camber_output_publish(camber_output *output);
/* Removes what was written, unless published; also frees the output. */
void camber_output_discard(camber_output *output);

/* A copy of standard input, as OGR wants to seek in what it reads. */
typedef struct camber_spool {
    char *path; /* NULL: there is none */
    int mark;   /* a descriptor of it that stays open as long as it is there; 0: none */
} camber_spool;

/* Makes it, to be removed by the other. Returns an exit status, its line printed; there is no copy where it is not 0.
 */
int camber_spool_input(camber_report *report, camber_guard *guard, camber_spool *spool);
void camber_spool_remove(camber_guard *guard, camber_spool *spool);

#endif
