/* A file that is written whole or not at all. */
#ifndef CAMBER_CLI_OUTPUT_H
#define CAMBER_CLI_OUTPUT_H

#include "cli/guard.h"
#include "cli/report.h"

#include <sys/stat.h>

typedef struct camber_output {
    const char *path; /* as given by the user */
    camber_report *report;
    camber_guard *guard;
    FILE *file;   /* NULL: not open */
    char *target; /* path, or the file that it links to. NULL: written directly (standard output, a device, a pipe) */
    char *temporary; /* in the folder of target */
    int mark;        /* a second descriptor of temporary, which marks it as in use until it is renamed; 0: none */
    bool force;
    int error; /* errno of the first write that failed */
    size_t size_bytes;
} camber_output;

/* Opens path for writing; "-" is standard output. Open it before the work starts, so that errors show early. A regular
 * file is written to a temporary file, and renamed by camber_output_publish. Returns an exit status; on failure a line
 * has been printed. Discard the output in any case. */
int camber_output_open(camber_output *output, camber_report *report, camber_guard *guard, const char *path, bool force);
/* Whether info describes the file that the output writes or replaces. Such a file must not also be read. */
bool camber_output_is(const camber_output *output, const struct stat *info);
camber_sink camber_output_sink(camber_output *output);
/* Reports a failed call that wrote to this output: the file's error if writing failed, otherwise status. Returns an
 * exit status. */
int camber_output_status(camber_output *output, camber_status status);
int camber_output_publish(camber_output *output);
/* Removes the file unless it has been published, and frees the output. */
void camber_output_discard(camber_output *output);

/* A copy of standard input, because OGR seeks in the files that it reads. */
typedef struct camber_spool {
    char *path; /* NULL: there is no copy */
    int mark;   /* a second descriptor of it, which marks it as in use; 0: none */
} camber_spool;

/* Makes the copy; camber_spool_remove removes it. Returns an exit status; on failure a line has been printed, and there
 * is no copy. */
int camber_spool_input(camber_report *report, camber_guard *guard, camber_spool *spool);
void camber_spool_remove(camber_guard *guard, camber_spool *spool);

#endif
