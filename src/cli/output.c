/* Writes files atomically: to a temporary file in the same folder, which is synced and renamed when it is complete. The
 * guard removes it if the process ends earlier. Also copies standard input to a temporary file for readers that
 * seek. */
#define _XOPEN_SOURCE 700 /* realpath */

#include "cli/output.h"

#include "base/whole_file.h"
#include "cli/environment.h"
#include "cli/temp_files.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Makes a hidden name in the folder of path. It is short enough for every file system that allows path. */
static char *temporary_name(const char *path, unsigned attempt, const char *suffix) {
    const char *slash = strrchr(path, '/');
    const size_t folder = slash ? (size_t)(slash - path) + 1 : 0;
    const size_t size = folder + 64;
    char *name = malloc(size);
    if (name)
        snprintf(name, size, "%.*s.camber-%ld-%u%s", (int)folder, path, (long)getpid(), attempt, suffix);
    return name;
}

static void remove_temporary(camber_guard *guard, char *path) {
    camber_guard_lock(guard);
    unlink(path);
    camber_guard_remove(guard, path);
    camber_guard_unlock(guard);
    free(path);
}

/* Creates a file in the folder of path and registers it with the guard. Returns its descriptor, or -1 with errno. */
static int create_beside(camber_guard *guard, const char *path, const char *suffix, mode_t mode, char **made) {
    for (unsigned attempt = 0; attempt < 100; attempt++) {
        char *name = temporary_name(path, attempt, suffix);
        if (!name) {
            errno = ENOMEM;
            return -1;
        }
        camber_guard_lock(guard);
        int descriptor = open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
        int cause = errno;
        if (descriptor >= 0 && !camber_guard_add(guard, name)) {
            close(descriptor);
            unlink(name);
            descriptor = -1;
            cause = EMFILE;
        }
        camber_guard_unlock(guard);
        if (descriptor >= 0 && camber_temp_files_spare(descriptor)) {
            *made = name;
            return descriptor;
        }
        if (descriptor >= 0) {
            close(descriptor);
            remove_temporary(guard, name);
            continue;
        }
        free(name);
        errno = cause;
        if (cause != EEXIST)
            return -1;
    }
    return -1;
}

static int cannot_create(camber_output *output, int cause) {
    const char *cure = "name another file";
    if (cause == ENOENT || cause == ENOTDIR)
        cure = "make its folder first";
    else if (cause == EACCES || cause == EPERM || cause == EROFS)
        cure = "name a folder that you may write to";
    else if (cause == ENOMEM)
        cure = "give it more memory";
    const int status = cause == ENOMEM                   ? CAMBER_EXIT_INTERNAL
                       : camber_file_fails_anyway(cause) ? CAMBER_EXIT_IO
                                                         : CAMBER_EXIT_CREATE;
    return camber_report_fail(output->report, status, "%s: cannot be created (%s); %s", output->path, strerror(cause),
                              camber_file_cure(cause, cure));
}

static int open_stream(camber_output *output, int descriptor) {
    output->file = descriptor < 0 ? NULL : fdopen(descriptor, "wb");
    if (output->file)
        return CAMBER_EXIT_DONE;
    const int cause = errno;
    if (descriptor >= 0)
        close(descriptor);
    return cannot_create(output, cause);
}

/* Examines an existing file at path. It changes nothing, but opens a device or a pipe. */
static int look_at_existing(camber_output *output, mode_t *mode, bool *in_place) {
    struct stat info;
    const char *path = output->path;
    if (!output->force)
        return camber_report_fail(output->report, CAMBER_EXIT_CREATE,
                                  "%s: exists; name another file, or replace it with --force", path);
    if (stat(path, &info) != 0) { /* a dangling link is replaced */
        output->target = strdup(path);
        return CAMBER_EXIT_DONE;
    }
    if (S_ISDIR(info.st_mode))
        return camber_report_fail(output->report, CAMBER_EXIT_CREATE, "%s: is a folder; name a file in it", path);
    if (!S_ISREG(info.st_mode)) {
        *in_place = true;
        return open_stream(output, open(path, O_WRONLY | O_CLOEXEC));
    }
    *mode = info.st_mode & 0777;
    output->target = realpath(path, NULL);
    return CAMBER_EXIT_DONE;
}

int camber_output_open(camber_output *output, camber_report *report, camber_guard *guard, const char *path,
                       bool force) {
    *output = (camber_output){.path = path, .report = report, .guard = guard, .force = force};
    if (strcmp(path, "-") == 0) {
        output->path = "standard output";
        if (isatty(STDOUT_FILENO))
            return camber_report_fail(report, CAMBER_EXIT_USAGE,
                                      "standard output: is a terminal; redirect it to a file or a pipe");
        return open_stream(output, dup(STDOUT_FILENO));
    }
    struct stat info;
    mode_t mode = 0;
    bool in_place = false;
    if (lstat(path, &info) == 0) {
        const int status = look_at_existing(output, &mode, &in_place);
        if (status != CAMBER_EXIT_DONE || in_place)
            return status;
    } else if (errno != ENOENT) {
        return cannot_create(output, errno);
    } else {
        output->target = strdup(path);
    }
    if (!output->target)
        return cannot_create(output, ENOMEM);
    if (output->target[strlen(output->target) - 1] == '/')
        return camber_report_fail(report, CAMBER_EXIT_CREATE, "%s: names a folder; name a file in it", path);
    camber_temp_files_remove(output->target);
    const int descriptor = create_beside(guard, output->target, ".tmp", 0666, &output->temporary);
    output->mark = descriptor >= 0 ? fcntl(descriptor, F_DUPFD_CLOEXEC, STDERR_FILENO + 1) : 0;
    if (descriptor >= 0 && mode)
        fchmod(descriptor, mode); /* if it fails, the new file is less readable than the one it replaces */
    return open_stream(output, descriptor);
}

bool camber_output_is(const camber_output *output, const struct stat *info) {
    struct stat own;
    const bool found =
        output->target ? stat(output->target, &own) == 0 : output->file && fstat(fileno(output->file), &own) == 0;
    return found && S_ISREG(own.st_mode) && own.st_dev == info->st_dev && own.st_ino == info->st_ino;
}

static bool write_bytes(void *user, const void *bytes, size_t size_bytes) {
    camber_output *output = user;
    output->size_bytes += size_bytes;
    if (output->error == 0 && fwrite(bytes, 1, size_bytes, output->file) != size_bytes)
        output->error = errno ? errno : EIO;
    return output->error == 0;
}

camber_sink camber_output_sink(camber_output *output) {
    return (camber_sink){.write = write_bytes, .user = output};
}

int camber_output_status(camber_output *output, camber_status status) {
    if (output->error == 0)
        return camber_report_status(output->report, status);
    return camber_report_fail(output->report, CAMBER_EXIT_IO, "%s: %s; %s", output->path, strerror(output->error),
                              camber_file_cure(output->error, "write elsewhere"));
}

static void close_mark(int *mark) {
    if (*mark > 0)
        close(*mark);
    *mark = 0;
}

int camber_output_publish(camber_output *output) {
    if (fflush(output->file) != 0 && output->error == 0)
        output->error = errno;
    if (output->error == 0 && output->temporary)
        output->error = camber_file_sync(fileno(output->file));
    const int closed = fclose(output->file);
    output->file = NULL;
    if (closed != 0 && output->error == 0)
        output->error = errno;
    if (output->error)
        return camber_output_status(output, CAMBER_ERROR_IO);
    if (!output->temporary)
        return CAMBER_EXIT_DONE;
    camber_guard_lock(output->guard);
    const int cause = camber_file_name(output->temporary, output->target, output->force);
    if (cause == 0)
        camber_guard_remove(output->guard, output->temporary);
    camber_guard_unlock(output->guard);
    if (cause == EEXIST)
        return camber_report_fail(
            output->report, CAMBER_EXIT_CREATE,
            "%s: another program has created this file in the meantime; name another file, or replace it with --force",
            output->path);
    if (cause)
        return cannot_create(output, cause);
    free(output->temporary);
    output->temporary = NULL;
    close_mark(&output->mark);
    return CAMBER_EXIT_DONE;
}

void camber_output_discard(camber_output *output) {
    if (output->file)
        fclose(output->file);
    if (output->temporary)
        remove_temporary(output->guard, output->temporary);
    close_mark(&output->mark);
    free(output->target);
    *output = (camber_output){0};
}

/* ---- Standard input ---- */

/* Some OGR drivers depend on the extension. An SQLite file is an MBTiles archive, unless it has GP at byte 68, which
 * marks a GeoPackage. */
static const char *suffix_of(const char *head, size_t size) {
    if (size >= 2 && memcmp(head, "\x1f\x8b", 2) == 0)
        return ".in.gz";
    if (size < 72 || memcmp(head, "SQLite format 3", 16) != 0)
        return ".in";
    return memcmp(head + 68, "GP", 2) == 0 ? ".in.gpkg" : ".in.mbtiles";
}

static int cannot_spool(camber_report *report, const char *folder, int cause) {
    return camber_report_fail(
        report, CAMBER_EXIT_IO, "standard input: cannot be copied to %s (%s); %s", folder, strerror(cause),
        cause == ENOSPC || cause == EDQUOT ? "set TMPDIR to a larger folder"
                                           : camber_file_cure(cause, "set TMPDIR to a folder that you may write to"));
}

/* Copies the rest of standard input after the block that has been read. The results are errnos; 0: no failure. */
static void copy_input(FILE *file, char *block, size_t size, size_t capacity, int *unread, int *unwritten) {
    *unread = *unwritten = 0;
    while (size > 0 && !*unwritten) {
        if (fwrite(block, 1, size, file) != size)
            *unwritten = errno;
        size = fread(block, 1, capacity, stdin);
        if (size < capacity && ferror(stdin))
            *unread = errno;
    }
    if (fclose(file) != 0 && !*unwritten)
        *unwritten = errno;
}

int camber_spool_input(camber_report *report, camber_guard *guard, camber_spool *spool) {
    char block[8192], beside[PATH_MAX];
    *spool = (camber_spool){0};
    const size_t size = fread(block, 1, sizeof block, stdin);
    if (ferror(stdin))
        return camber_report_input(report, errno);
    snprintf(beside, sizeof beside, "%s/", camber_environment_temporary());
    camber_temp_files_remove(beside);
    const int descriptor = create_beside(guard, beside, suffix_of(block, size), 0600, &spool->path);
    FILE *file = descriptor < 0 ? NULL : fdopen(descriptor, "wb");
    int unread = 0, unwritten = file ? 0 : errno;
    spool->mark = file ? fcntl(descriptor, F_DUPFD_CLOEXEC, STDERR_FILENO + 1) : 0;
    if (file)
        copy_input(file, block, size, sizeof block, &unread, &unwritten);
    else if (spool->path)
        close(descriptor);
    if (!unread && !unwritten)
        return CAMBER_EXIT_DONE;
    camber_spool_remove(guard, spool);
    return unwritten ? cannot_spool(report, beside, unwritten) : camber_report_input(report, unread);
}

void camber_spool_remove(camber_guard *guard, camber_spool *spool) {
    if (spool->path)
        remove_temporary(guard, spool->path);
    close_mark(&spool->mark);
    spool->path = NULL;
}
