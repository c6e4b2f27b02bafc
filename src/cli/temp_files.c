#include "cli/temp_files.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

/* A file in use has an advisory lock, which the system releases however the process ends. On a file system without
 * locks, files are neither marked nor removed. */
bool camber_temp_files_spare(int descriptor) {
    struct stat info;
    (void)flock(descriptor, LOCK_EX); /* waits only as long as remove_one takes */
    return fstat(descriptor, &info) != 0 || info.st_nlink > 0;
}

static const char *skip_number(const char *text) {
    const size_t digits = strspn(text, "0123456789");
    return digits ? text + digits : "";
}

static bool is_ours(const char *name) {
    static const char head[] = ".camber-";
    static const char *const endings[] = {".tmp", ".in", ".in.gz", ".in.gpkg", ".in.mbtiles"};
    if (strncmp(name, head, sizeof head - 1) != 0)
        return false;
    name = skip_number(name + sizeof head - 1);
    if (*name != '-' || name[1] < '0' || name[1] > '9')
        return false;
    name = skip_number(name + 1);
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
        if (strcmp(name, endings[i]) == 0)
            return true;
    return false;
}

static void remove_one(int folder, const char *name) {
    struct stat info;
    const int descriptor = openat(folder, name, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0)
        return;
    if (fstat(descriptor, &info) == 0 && S_ISREG(info.st_mode) && info.st_uid == geteuid() &&
        flock(descriptor, LOCK_EX | LOCK_NB) == 0)
        unlinkat(folder, name, 0);
    close(descriptor);
}

void camber_temp_files_remove(const char *path) {
    const char *slash = strrchr(path, '/');
    char *name = slash ? strndup(path, (size_t)(slash - path) + 1) : strdup(".");
    DIR *folder = name ? opendir(name) : NULL;
    for (struct dirent *entry; folder && (entry = readdir(folder)) != NULL;)
        if (is_ours(entry->d_name))
            remove_one(dirfd(folder), entry->d_name);
    if (folder)
        closedir(folder);
    free(name);
}
