/* Keeps compiled kernels and linked shaders in small files, so that the next run need not compile them. They are in the
 * user's cache folder. Kernels may also be in a folder beside the library, which all users of the machine read:
 * camber_device_warm fills it when camber is installed. A file from there runs as code in the reader's process. So it
 * is used only if nobody but its owner can have written it, and the owner can also write the library. */
#define _GNU_SOURCE /* dladdr, F_OFD_SETLK, realpath */

#include "base/base.h"
#include "base/whole_file.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { PATH_SIZE = CAMBER_FOLDER_SIZE, LARGEST_BYTES = 64 << 20 };

static const char SHARED_NAME[] = "camber-kernels";

/* ---- Folders ---- */

static bool users_folder(const camber_context *context, char folder[PATH_SIZE]) {
    int length;
    const char *xdg = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    if (context->desc.cache_dir)
        length = snprintf(folder, PATH_SIZE, "%s", context->desc.cache_dir);
    else if (xdg && xdg[0] == '/')
        length = snprintf(folder, PATH_SIZE, "%s/camber", xdg);
    else if (home && home[0] == '/')
        length = snprintf(folder, PATH_SIZE, "%s/.cache/camber", home);
    else
        return false;
    return length > 0 && length < PATH_SIZE;
}

/* Finds the shared folder: $CAMBER_KERNELS, or the one beside the library. *owner is the user who could have written
 * it. */
static bool shared_folder(char folder[PATH_SIZE], uid_t *owner) {
    const char *named = getenv("CAMBER_KERNELS");
    char library[PATH_MAX];
    Dl_info here;
    struct stat about;
    *owner = geteuid();
    if (named)
        return named[0] == '/' && snprintf(folder, PATH_SIZE, "%s", named) < PATH_SIZE;
    /* In a statically linked program this is argv[0]. Without a slash it would name a file in the working folder. */
    if (!dladdr(SHARED_NAME, &here) || !here.dli_fname || here.dli_fname[0] != '/' ||
        !realpath(here.dli_fname, library) || stat(library, &about) != 0)
        return false;
    *owner = about.st_uid;
    const int length = (int)(strrchr(library, '/') + 1 - library);
    return snprintf(folder, PATH_SIZE, "%.*s%s", length, library, SHARED_NAME) < PATH_SIZE;
}

static bool is_trusted(const struct stat *about, uid_t owner) {
    const bool is_owners = about->st_uid == 0 || about->st_uid == geteuid() || about->st_uid == owner;
    return is_owners && (about->st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

bool camber_cache_is_on(const camber_context *context) {
    char folder[PATH_SIZE];
    return users_folder(context, folder);
}

/* Makes the folder readable by all users, whatever the umask is. */
static bool make_shared(const char *folder) {
    return mkdir(folder, 0755) == 0 ? chmod(folder, 0755) == 0 : errno == EEXIST;
}

static bool may_share(void) {
    char folder[PATH_SIZE];
    struct stat about;
    uid_t owner;
    return shared_folder(folder, &owner) && make_shared(folder) && stat(folder, &about) == 0 &&
           S_ISDIR(about.st_mode) && is_trusted(&about, owner) && access(folder, W_OK | X_OK) == 0;
}

void camber_cache_share(camber_context *context, bool wanted) {
    context->saves_shared = wanted && may_share();
}

bool camber_cache_folder(const camber_context *context, char folder[PATH_SIZE]) {
    uid_t owner;
    if (context->saves_shared)
        return shared_folder(folder, &owner);
    return users_folder(context, folder) && camber_file_make_folders(folder, 1, 0700) == 0 &&
           (mkdir(folder, 0700) == 0 || errno == EEXIST);
}

bool camber_cache_can_save(const camber_context *context) {
    char folder[PATH_SIZE];
    return camber_cache_folder(context, folder) && access(folder, W_OK | X_OK) == 0;
}

/* ---- Files ---- */

/* Reads an open regular file, if nobody but its owner can write it and the owner is root, this user or the given one.
 */
static bool read_trusted(camber_context *context, int file, uid_t owner, char **bytes, size_t *size_bytes) {
    struct stat about;
    if (fstat(file, &about) != 0 || !S_ISREG(about.st_mode) || about.st_size > LARGEST_BYTES ||
        !is_trusted(&about, owner))
        return false;
    const size_t size = (size_t)about.st_size;
    char *block = camber_resize_quietly(context, NULL, size + 1);
    size_t got = 0;
    for (ssize_t more = 1; block && more > 0 && got<size; got += more> 0 ? (size_t)more : 0)
        more = read(file, block + got, size - got);
    if (!block || got < size) {
        camber_free(context, block);
        return false;
    }
    *bytes = block;
    *size_bytes = size;
    return true;
}

/* Opens folder and file first and checks the open handles, so that nobody can swap the file between check and read. */
static bool load_from(camber_context *context, const char *path, bool shared, uid_t owner, const char *name,
                      char **bytes, size_t *size_bytes) {
    struct stat about;
    const int folder = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const bool trusted = folder >= 0 && (!shared || (fstat(folder, &about) == 0 && is_trusted(&about, owner)));
    const int file = trusted ? openat(folder, name, O_RDONLY | O_CLOEXEC | O_NONBLOCK | (shared ? O_NOFOLLOW : 0)) : -1;
    const bool loaded = file >= 0 && read_trusted(context, file, owner, bytes, size_bytes);
    if (file >= 0)
        close(file);
    if (folder >= 0)
        close(folder);
    return loaded;
}

bool camber_cache_load(camber_context *context, const char *name, char **bytes, size_t *size_bytes) {
    char folder[PATH_SIZE];
    return users_folder(context, folder) && load_from(context, folder, false, geteuid(), name, bytes, size_bytes);
}

bool camber_cache_load_shared(camber_context *context, const char *name, char **bytes, size_t *size_bytes) {
    char folder[PATH_SIZE];
    uid_t owner;
    return shared_folder(folder, &owner) && load_from(context, folder, true, owner, name, bytes, size_bytes);
}

bool camber_cache_save(camber_context *context, const char *name, const void *bytes, size_t size_bytes) {
    const camber_file_part part = {bytes, size_bytes};
    char folder[PATH_SIZE], path[PATH_SIZE + 256];
    if (!camber_cache_folder(context, folder))
        return false;
    const int length = snprintf(path, sizeof path, "%s/%s", folder, name);
    return camber_whole_file_write(path, (size_t)length, context->saves_shared ? 0644 : 0600, &part, 1) == 0;
}

/* ---- Locks ---- */

int camber_cache_lock(camber_context *context, uint64_t key, double longest_ms) {
    char folder[PATH_SIZE], path[PATH_SIZE + 16];
    if (!camber_cache_folder(context, folder))
        return -1;
    snprintf(path, sizeof path, "%s/.lock", folder);
    const int handle = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (handle < 0)
        return -1;
    /* All keys share one file, in which each key has a byte to lock. Locks of an open file end with it, even if the
     * process dies. */
    struct flock byte = {
        .l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = (off_t)(key & INT32_MAX), .l_len = 1, .l_pid = 0};
    const double begin = camber_now_ms();
    while (fcntl(handle, F_OFD_SETLK, &byte) != 0) {
        const struct timespec pause = {.tv_nsec = 1000000};
        if ((errno != EAGAIN && errno != EACCES) || camber_now_ms() - begin > longest_ms) {
            close(handle);
            return -1;
        }
        nanosleep(&pause, NULL);
    }
    return handle;
}

void camber_cache_unlock(int lock) {
    if (lock >= 0)
        close(lock);
}
