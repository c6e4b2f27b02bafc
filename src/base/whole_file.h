/* Files that appear whole or not at all: they are written beside their path, and get their name when they are complete.
 */
#ifndef CAMBER_BASE_WHOLE_FILE_H
#define CAMBER_BASE_WHOLE_FILE_H

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/stat.h>

/* Functions that return an int return 0 or an errno. No function logs anything. */

typedef struct camber_whole_file {
    const char *path;
    char beside[PATH_MAX];
    int file;
} camber_whole_file;

/* Consecutive bytes of a file. */
typedef struct camber_file_part {
    const void *bytes;
    size_t size_bytes;
} camber_file_part;

/* Opens a new file beside a path. The path must stay valid until camber_whole_file_end. If the call fails, there is
 * nothing to end. */
int camber_whole_file_begin(camber_whole_file *whole, const char *path, mode_t mode);
/* Closes the file and, if cause, the errno of the writing, is 0, gives it its name. Otherwise, or if closing or naming
 * fails, removes it. Returns the first failure. */
int camber_whole_file_end(camber_whole_file *whole, int cause, bool force);
/* Writes a file that can be made again and is therefore not synced. It replaces a file that has its name. Missing
 * folders of the path are made, except those named in its first `there` bytes. */
int camber_whole_file_write(const char *path, size_t there, mode_t mode, const camber_file_part *parts, size_t count);

/* Gives a complete file or folder its name. force: it replaces whatever has that name, except a folder with files.
 * Without force, returns EEXIST if something has that name, even if it appeared only just now; but on a file system
 * without hard links, a file that appears between the last check and the renaming is lost. */
int camber_file_name(const char *whole, const char *path, bool force);
/* Reads size_bytes bytes at an offset of an open file, or fewer if the file ends before that. *done: how many were
 * read. */
int camber_file_read(int file, void *bytes, size_t size_bytes, uint64_t offset, size_t *done);
/* Writes all bytes at an offset of an open file. */
int camber_file_write(int file, const void *bytes, size_t size_bytes, uint64_t offset);
/* Syncs an open file, if it is of a kind that can be synced. */
int camber_file_sync(int file);
/* Makes the missing folders of a path up to its last slash, except those named in its first `there` bytes. */
int camber_file_make_folders(char *path, size_t there, mode_t mode);

/* Whether a file with another name would fail in the same way. */
bool camber_file_fails_anyway(int cause);
/* Says what to do if a file cannot be written. otherwise: the text for a cause that is not a limit of the system. */
const char *camber_file_cure(int cause, const char *otherwise);

#endif
