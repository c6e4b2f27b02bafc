/* What drivers are to find in the environment, and what of the system's they need. */
#ifndef CAMBER_CLI_ENVIRONMENT_H
#define CAMBER_CLI_ENVIRONMENT_H

#include "cli/options.h"

/* Sets what the user has not set and what --threads asks for, and forgets folders that are relative; before any thread
 * starts. false: out of memory. */
bool camber_environment_set(const camber_options *options);
/* The folder for temporary files, GDAL's too. */
const char *camber_environment_temporary(void);

/* Opens standard streams that are closed, in the wrong direction: what reads or writes them fails as before (EBADF),
 * and no file gets their number, which what a library prints would end in. Before anything else is opened. */
void camber_environment_fill_streams(void);
/* Whether the process may open the files that a verb and its drivers need at least. */
bool camber_environment_has_descriptors(void);

#endif
