/* Files to which an archive is written. Each failure is reported in one line that names the file and the cause, and
 * says what to do. */
#ifndef CAMBER_ARCHIVE_OUTPUT_FILE_H
#define CAMBER_ARCHIVE_OUTPUT_FILE_H

#include "base/base.h"
#include "base/whole_file.h"

/* Logs why a file cannot be written (cause is an errno). Returns CAMBER_ERROR_IO. */
camber_status camber_output_fail(camber_context *context, const char *name, int cause);
/* Writes all bytes at an offset of an open file. */
camber_status camber_write_at(camber_context *context, const char *name, int file, const void *bytes, size_t size_bytes,
                              uint64_t offset);
/* Syncs an open file. */
camber_status camber_sync(camber_context *context, const char *name, int file);
/* Syncs an open file, and closes it even if that fails. */
camber_status camber_sync_and_close(camber_context *context, const char *name, int file);
/* Renames a complete file or folder. force: it replaces any file or folder that has that name, and an old folder is
 * removed. */
camber_status camber_give_name(camber_context *context, const char *whole, const char *path, bool force);
/* Opens a new temporary file next to a path. path must stay valid until camber_output_end, which need not be called if
 * this fails. */
camber_status camber_output_begin(camber_context *context, const char *path, camber_whole_file *output);
/* Closes the file. It is renamed if status, the status of writing it, is CAMBER_OK; it is removed if status is an
 * error, or if syncing or renaming fails. Returns the first failure. */
camber_status camber_output_end(camber_context *context, camber_whole_file *output, camber_status status, bool force);
/* Removes a file, or a folder with everything in it, if it exists. */
void camber_remove_tree(camber_context *context, const char *path);

#endif
