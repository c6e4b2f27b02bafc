/* Files that an archive is written to: each failure is one line that names the file, the cause and a cure. */
#ifndef CAMBER_ARCHIVE_OUTPUT_FILE_H
#define CAMBER_ARCHIVE_OUTPUT_FILE_H

#include "base/base.h"
#include "base/whole_file.h"

/* Logs why a file cannot be written (cause is an errno). Returns CAMBER_ERROR_IO. */
camber_status camber_output_fail(camber_context *context, const char *name, int cause);
/* Writes bytes at an offset of an open file, all of them. */
camber_status camber_write_at(camber_context *context, const char *name, int file, const void *bytes, size_t size_bytes,
                              uint64_t offset);
/* Syncs an open file. */
camber_status camber_sync(camber_context *context, const char *name, int file);
/* Syncs an open file, and closes it in any case. */
camber_status camber_sync_and_close(camber_context *context, const char *name, int file);
/* Gives a file or folder that is whole its name. force: it replaces what has that name; a folder's old one is removed.
 */
camber_status camber_give_name(camber_context *context, const char *whole, const char *path, bool force);
/* Opens a new file beside a path. Nothing is left to end if it fails. path is read until the end. */
camber_status camber_output_begin(camber_context *context, const char *path, camber_whole_file *output);
/* Closes the file. It gets its name if status, that of what was written, is CAMBER_OK, and is removed if it is not or
 * if syncing or naming fails. Returns the first failure. */
camber_status camber_output_end(camber_context *context, camber_whole_file *output, camber_status status, bool force);
/* Removes a file, or a folder with all that is in it, if it is there. */
void camber_remove_tree(camber_context *context, const char *path);

#endif
