/* Files that appear whole or not at all: written beside their path, and given their name when they are complete. */
#ifndef CAMBER_BASE_WHOLE_FILE_H
#define CAMBER_BASE_WHOLE_FILE_H

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/stat.h>

/* Functions that return an int return 0 or an errno. None logs anything. */

typedef struct camber_whole_file {
    const char *path;
    char beside[PATH_MAX];
    int file;
} camber_whole_file;

/* Bytes that follow each other in a file. */
typedef struct camber_file_part {
    const void *bytes;
    size_t size_bytes;
} camber_file_part;

/* Opens a new file beside a path, which is read until the end. Nothing is left to end if it fails. */
int camber_whole_file_begin(camber_whole_file *whole, const char *path, mode_t mode);
/* Closes the file and gives it its name if cause, that of the writing, is 0. Else, or if closing or naming fails,
 * removes it. Returns the first failure. */
int camber_whole_file_end(camber_whole_file *whole, int cause, bool force);
/* Writes a file that can be made again, so it is not synced; it replaces what has its name. Folders of the path behind
 * its first `there` letters are made. */
int camber_whole_file_write(const char *path, size_t there, mode_t mode, const camber_file_part *parts, size_t count);

/* Gives a file, or folder, that is complete its name. force: it replaces what has that name, unless that is a folder
 * with files. Otherwise returns EEXIST, also if the name was taken just now; on a file system without hard links one
 * that is taken between a last look and the renaming is lost. */
int camber_file_name(const char *whole, const char *path, bool force);
/* Reads bytes at an offset of an open file: size_bytes, or *done of them up to its end. */
int camber_file_read(int file, void *bytes, size_t size_bytes, uint64_t offset, size_t *done);
/* Writes all bytes at an offset of an open file. */
int camber_file_write(int file, const void *bytes, size_t size_bytes, uint64_t offset);
/* Syncs an open file, if it is of a kind that can be synced. */
int camber_file_sync(int file);
/* Makes the folders of a path, up to its last slash, that are missing behind its first `there` letters. */
int camber_file_make_folders(char *path, size_t there, mode_t mode);

/* Whether a file with another name would fail in the same way. */
bool camber_file_fails_anyway(int cause);
/* The cure for a file that cannot be written. otherwise: the one for a cause that is no limit of the system. */
const char *camber_file_cure(int cause, const char *otherwise);

#endif
