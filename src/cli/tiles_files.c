#define _XOPEN_SOURCE 700

#include "cli/tiles_files.h"

#ifdef CAMBER_MAP

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

int camber_tiles_look_at_output(camber_session *session, const char *path) {
    const camber_options *options = session->options;
    struct stat about;
    char folder[4096];
    if (lstat(path, &about) == 0 && !options->force && !options->resume)
        return camber_report_fail(session->report, CAMBER_EXIT_CREATE,
                                  "%s: exists; name another file, or replace it with --force", path);
    snprintf(folder, sizeof folder, "%s", path);
    for (size_t length = strlen(folder); length > 1 && folder[length - 1] == '/'; length--)
        folder[length - 1] = 0;
    char *slash = strrchr(folder, '/');
    if (slash)
        slash[slash == folder] = 0;
    else
        snprintf(folder, sizeof folder, ".");
    if (access(folder, W_OK | X_OK) == 0)
        return CAMBER_EXIT_DONE;
    return camber_report_fail(session->report, CAMBER_EXIT_CREATE, "%s: cannot be created (%s); %s", path,
                              strerror(errno),
                              errno == ENOENT ? "make its folder first" : "name a folder that you may write to");
}

int camber_tiles_files_name(camber_tiles_files *files, const char *path) {
    for (size_t i = 0; i < CAMBER_TILES_FILES; i++)
        if (!camber_tiles_beside(path, i, files->names[i], sizeof files->names[i]))
            return camber_report_fail(files->session->report, CAMBER_EXIT_CREATE,
                                      "%s: is too long; choose a shorter name", path);
    return CAMBER_EXIT_DONE;
}

void camber_tiles_files_guard(void *user) {
    camber_tiles_files *files = user;
    camber_guard *guard = files->session->guard;
    camber_guard_lock(guard);
    for (size_t i = files->first; i < CAMBER_TILES_FILES && camber_guard_add(guard, files->names[i]); i++)
        files->guarded++;
    camber_guard_unlock(guard);
}

void camber_tiles_files_release(camber_tiles_files *files) {
    if (!files->guarded)
        return;
    camber_guard *guard = files->session->guard;
    camber_guard_lock(guard);
    while (files->guarded)
        camber_guard_remove(guard, files->names[files->first + --files->guarded]);
    camber_guard_unlock(guard);
}

typedef struct summary {
    uint64_t tiles, size_bytes;
    int min_zoom, max_zoom;
} summary;

/* Counts the tiles of an archive with a context of its own, because the session's does not read its outputs. */
static bool look_into(const char *path, summary *found) {
    const camber_context_desc desc = {.cache_dir = ""};
    camber_context *context = NULL;
    camber_tiles_info *info = NULL;
    const bool shown =
        camber_context_create(&desc, &context) == CAMBER_OK && camber_tiles_show(context, path, &info) == CAMBER_OK;
    if (shown)
        *found = (summary){info->tiles, 0, info->min_zoom, info->max_zoom};
    for (size_t i = 0; shown && i < info->zoom_count; i++)
        found->size_bytes += info->zooms[i].size_bytes;
    camber_tiles_info_destroy(info);
    camber_context_destroy(context);
    return shown;
}

void camber_tiles_say_done(camber_session *session, const char *path, const char *what, uint64_t tiles,
                           uint64_t size_bytes) {
    camber_report *report = session->report;
    struct stat about;
    char zooms[48] = "";
    summary found = {tiles, size_bytes, 0, 0};
    if (report->quiet || report->json)
        return;
    const bool is_file = stat(path, &about) == 0 && S_ISREG(about.st_mode);
    if ((is_file || !tiles) && look_into(path, &found))
        snprintf(zooms, sizeof zooms, ", zooms %d to %d", found.min_zoom, found.max_zoom);
    if (is_file)
        found.size_bytes = (uint64_t)about.st_size;
    camber_report_done(report, path, found.size_bytes, camber_session_elapsed_ms(session), "%s%s tile%s%s", what,
                       camber_figure_count(found.tiles).text, camber_plural((size_t)found.tiles), zooms);
}

#endif
