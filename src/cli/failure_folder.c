#include "cli/failure_folder.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { SCALE = 8 }; /* size of a pixel in the picture, px */

static bool is_empty(const char *folder) {
    DIR *directory = opendir(folder);
    bool empty = true;
    for (const struct dirent *entry; directory && (entry = readdir(directory)) != NULL;)
        empty = empty && (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0);
    if (directory)
        closedir(directory);
    return empty;
}

int camber_failure_folder_check(const camber_session *session) {
    const char *folder = session->options->pictures;
    struct stat info;
    if (!folder)
        return CAMBER_EXIT_DONE;
    if (stat(folder, &info) != 0) {
        /* The folder is created with the first picture, so that a run without failures leaves nothing behind. */
        const int made = mkdir(folder, 0777);
        if (made == 0)
            rmdir(folder);
        return made == 0
                   ? CAMBER_EXIT_DONE
                   : camber_report_fail(session->report, CAMBER_EXIT_CREATE,
                                        "%s: cannot be made (%s); name a folder that can", folder, strerror(errno));
    }
    if (!S_ISDIR(info.st_mode))
        return camber_report_fail(session->report, CAMBER_EXIT_CREATE, "%s: is not a folder; name one", folder);
    if (access(folder, W_OK | X_OK) != 0)
        return camber_report_fail(session->report, CAMBER_EXIT_CREATE,
                                  "%s: cannot be written to (%s); name a folder that you may write to", folder,
                                  strerror(errno));
    if (!session->options->force && !is_empty(folder))
        return camber_report_fail(session->report, CAMBER_EXIT_CREATE,
                                  "%s: is not empty; name another folder, or replace what is there with --force",
                                  folder);
    return CAMBER_EXIT_DONE;
}

/* Returns an exit status; on failure a line has been printed. */
static int write_image(camber_session *session, const camber_failure_image *image, const char *path) {
    const char *folder = session->options->pictures;
    if (mkdir(folder, 0777) != 0 && errno != EEXIST)
        return camber_report_fail(session->report, CAMBER_EXIT_CREATE,
                                  "%s: cannot be made (%s); name a folder that can", folder, strerror(errno));
    camber_output output = {0};
    int status = camber_output_open(&output, session->report, session->guard, path, session->options->force);
    if (status == CAMBER_EXIT_DONE) {
        const camber_status written = camber_difference_write(session->context, image->window, image->truth,
                                                              image->drawn, SCALE, camber_output_sink(&output));
        status = written == CAMBER_OK ? camber_output_publish(&output) : camber_output_status(&output, written);
    }
    camber_output_discard(&output);
    return status;
}

camber_status camber_failure_folder_write(void *user, const camber_failure_image *image, char **path) {
    camber_failure_folder *folder = user;
    const char *name = folder->session->options->pictures;
    const size_t size = strlen(name) + 32;
    char *made = malloc(size);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    snprintf(made, size, "%s/check-%04zu.png", name, image->number);
    folder->exit_status = write_image(folder->session, image, made);
    if (folder->exit_status == CAMBER_EXIT_DONE) {
        *path = made;
        return CAMBER_OK;
    }
    free(made);
    return CAMBER_ERROR_IO;
}
