/* Guesses whether there is a GPU, from the files through which drivers reach GPUs. Asking drivers only to learn that
 * there is none can cost more than drawing the picture. */
#include "gpu/hardware.h"

#include <dirent.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static bool can_open(const char *folder, const char *name) {
    char path[512];
    const int length = snprintf(path, sizeof path, "%s/%s", folder, name);
    return length > 0 && (size_t)length < sizeof path && access(path, R_OK | W_OK) == 0;
}

/* Whether there is a render node. Mesa's drivers use render nodes, and draw in software if the process may not open
 * one. */
static bool has_render_node(const char *folder) {
    char path[512];
    bool found = false;
    snprintf(path, sizeof path, "%s/dri", folder);
    DIR *nodes = opendir(path);
    for (const struct dirent *node; nodes && !found && (node = readdir(nodes));)
        found = strncmp(node->d_name, "renderD", 7) == 0 && can_open(path, node->d_name);
    if (nodes)
        closedir(nodes);
    return found;
}

bool camber_hardware_in(const char *folder) {
    /* Drivers with device files of their own: NVIDIA on PCs and boards, Windows GPUs in WSL, Mali, Adreno, PowerVR,
     * Vivante. */
    static const char *const names[] = {"nvidiactl", "nvhost-gpu", "dxg", "mali0", "kgsl-3d0", "pvrsrvkm", "galcore"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (can_open(folder, names[i]))
            return true;
    return has_render_node(folder);
}

bool camber_hardware_is_here(void) {
#ifdef __linux__
    return camber_hardware_in("/dev");
#else
    return true;
#endif
}
