/* The files that an archive of tiles is written into. */
#ifndef CAMBER_CLI_TILES_FILES_H
#define CAMBER_CLI_TILES_FILES_H

#include "cli/session.h"

enum { CAMBER_TILES_FILES = 3 };

/* The files beside an archive that is being written. */
typedef struct camber_tiles_files {
    camber_session *session;
    char names[CAMBER_TILES_FILES][4096];
    size_t first; /* files from here on are removed however the process ends */
    size_t guarded;
} camber_tiles_files;

/* Looks whether path can be written, before the work, so that an error shows early. Returns an exit status, its line
 * printed; so does the next. */
int camber_tiles_look_at_output(camber_session *session, const char *path);
int camber_tiles_files_name(camber_tiles_files *files, const char *path);
/* user is the files. From then on they are removed however the process ends. */
void camber_tiles_files_guard(void *user);
void camber_tiles_files_release(camber_tiles_files *files);

#endif
