/* Removes temporary files that killed runs have left behind. */
#ifndef CAMBER_CLI_TEMP_FILES_H
#define CAMBER_CLI_TEMP_FILES_H

#include <stdbool.h>

/* Marks a new file as in use until all its descriptors are closed. false: another run has taken it for abandoned and
 * has removed it. */
bool camber_temp_files_spare(int descriptor);

/* Removes abandoned files in the folder of path: this user's files that are named like camber's (.camber-PID-N.tmp, or
 * .in and the like for copies of standard input) and that no run has marked. The process number in the name proves
 * nothing: another container may use it. */
void camber_temp_files_remove(const char *path);

#endif
