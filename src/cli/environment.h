/* Prepares the environment, the standard streams and the descriptors that drivers need. */
#ifndef CAMBER_CLI_ENVIRONMENT_H
#define CAMBER_CLI_ENVIRONMENT_H

#include "cli/options.h"

/* Sets variables that the user has not set, sets the variables for --threads, and removes relative folders. Call it
 * before any thread starts. false: out of memory. */
bool camber_environment_set(const camber_options *options);
/* Returns the folder for temporary files, including GDAL's. */
const char *camber_environment_temporary(void);

/* Opens each closed standard stream in the direction in which it is not used. Reading and writing it then fail with
 * EBADF as before, and no file gets its number, so no library can print into a file by mistake. Call it before anything
 * else is opened. */
void camber_environment_fill_streams(void);
/* Whether the process may open as many files as a verb and its drivers need at least. */
bool camber_environment_has_descriptors(void);

#endif
