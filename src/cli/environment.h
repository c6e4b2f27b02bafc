/* Prepares the environment, the standard streams and the descriptors that drivers need. */
#ifndef CAMBER_CLI_ENVIRONMENT_H
#define CAMBER_CLI_ENVIRONMENT_H

#include "cli/options.h"

/* Sets variables that the user has not set, sets those of --threads, and removes relative folders. Call it before any
 * thread starts. false: out of memory. */
bool camber_environment_set(const camber_options *options);
/* The folder for temporary files, also for GDAL's. */
const char *camber_environment_temporary(void);

/* Opens closed standard streams in the wrong direction. Reads and writes of them then fail with EBADF as before, and no
 * file gets their number, so that no library prints into it. Call it before anything else is opened. */
void camber_environment_fill_streams(void);
/* Whether the process may open as many files as a verb and its drivers need at least. */
bool camber_environment_has_descriptors(void);

#endif
