#include "base/control_group.h"

#include <stdio.h>
#include <string.h>

void camber_control_group_visit(const char *root, void (*visit)(void *user, const char *folder), void *user) {
    char group[2048] = "", path[4096];
    snprintf(path, sizeof path, "%s/proc/self/cgroup", root);
    FILE *file = fopen(path, "re");
    while (file && fgets(group, sizeof group, file) && strncmp(group, "0::", 3) != 0)
        group[0] = 0;
    if (file)
        fclose(file);
    group[strcspn(group, "\n")] = 0;
    for (char *end = group + strlen(group); group[0] && end; end = strrchr(group + 3, '/')) {
        *end = 0;
        const int length = snprintf(path, sizeof path, "%s/sys/fs/cgroup%s", root, group + 3);
        if (length > 0 && (size_t)length < sizeof path)
            visit(user, path);
    }
}
