#include "base/control_group.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* Visits a group's folder and those above it, up to the folder where groups are mounted. */
static void visit_up(const char *mount, char *group, void (*visit)(void *user, const char *folder), void *user) {
    char path[4096];
    for (char *end = group + strlen(group); end; end = strrchr(group, '/')) {
        *end = 0;
        const int length = snprintf(path, sizeof path, "%s%s", mount, group);
        if (length > 0 && (size_t)length < sizeof path)
            visit(user, path);
    }
}

/* Whether a list such as "cpu,cpuacct" has the controller. */
static bool has_controller(const char *list, const char *controller) {
    const size_t length = strlen(controller);
    for (; *list; list += strcspn(list, ","), list += *list == ',')
        if (strcspn(list, ",") == length && strncmp(list, controller, length) == 0)
            return true;
    return false;
}

void camber_control_group_visit(const char *root, const char *controller, void (*visit)(void *user, const char *folder),
                                void *user) {
    char line[2048], mount[1024];
    snprintf(mount, sizeof mount, "%s/proc/self/cgroup", root);
    FILE *file = fopen(mount, "re");
    while (file && fgets(line, sizeof line, file)) { /* number:controllers:/group */
        char *list = strchr(line, ':'), *group = list ? strchr(list + 1, ':') : NULL;
        if (!group)
            continue;
        *group++ = 0;
        group[strcspn(group, "\n")] = 0;
        const bool is_unified = strcmp(line, "0:") == 0;
        if (!is_unified && !has_controller(list + 1, controller))
            continue;
        snprintf(mount, sizeof mount, "%s/sys/fs/cgroup%s%s", root, is_unified ? "" : "/",
                 is_unified ? "" : controller);
        visit_up(mount, group, visit, user);
    }
    if (file)
        fclose(file);
}
