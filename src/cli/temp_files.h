/* Removes temporary files that killed runs have left behind. */
#ifndef CAMBER_CLI_TEMP_FILES_H
#define CAMBER_CLI_TEMP_FILES_H

#include <stdbool.h>

/* Marks a new file as in use until all its descriptors are closed. Returns false if another run has taken it for
 * abandoned and removed it. */
bool camber_temp_files_spare(int descriptor);

/* Removes abandoned files in the folder of path: files of this user with names like camber's (.camber-PID-N.tmp, or .in
 * and the like for copies of standard input) that no run has marked. The process number in the name does not prove that
 * the process is running, because another container may use the same number. */
void camber_temp_files_remove(const char *path);

#endif
