/* The files into which an archive of tiles is written. */
#ifndef CAMBER_CLI_TILES_FILES_H
#define CAMBER_CLI_TILES_FILES_H

#include "cli/session.h"

enum { CAMBER_TILES_FILES = 3 };

/* The temporary files of an archive that is being written. */
typedef struct camber_tiles_files {
    camber_session *session;
    char names[CAMBER_TILES_FILES][4096];
    size_t first; /* files from this index on are removed however the process ends */
    size_t guarded;
} camber_tiles_files;

/* Checks before the work starts that path can be written, so that errors show early. Both return an exit status; on
 * failure a line has been printed. */
int camber_tiles_look_at_output(camber_session *session, const char *path);
int camber_tiles_files_name(camber_tiles_files *files, const char *path);
/* From this call on, the files are removed however the process ends. user is the files. */
void camber_tiles_files_guard(void *user);
void camber_tiles_files_release(camber_tiles_files *files);

/* Prints the last line of a verb about an archive: its tiles, zooms and size, after the words `what`. tiles,
 * size_bytes: of a folder, if they are known; otherwise 0, and it is walked to count them. */
void camber_tiles_say_done(camber_session *session, const char *path, const char *what, uint64_t tiles,
                           uint64_t size_bytes);

#endif
