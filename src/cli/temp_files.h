/* Temporary files of runs that were killed. */
#ifndef CAMBER_CLI_TEMP_FILES_H
#define CAMBER_CLI_TEMP_FILES_H

#include <stdbool.h>

/* Marks a file that has just been created as that of a run that lives, until all descriptors of it are closed. false:
 * it has been taken for a leftover meanwhile, and is gone. */
bool camber_temp_files_spare(int descriptor);

/* Removes the leftovers in the folder of path: files of this user's that are named as camber's are, .camber-PID-N.tmp,
 * or .in and the like where they are copies of standard input, and that no run has marked. A process's number would not
 * do: it is another's in another container. */
void camber_temp_files_remove(const char *path);

#endif
