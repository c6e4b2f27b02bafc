/* The control groups of the process, by which containers and services limit it. */
#ifndef CAMBER_BASE_CONTROL_GROUP_H
#define CAMBER_BASE_CONTROL_GROUP_H

/* Calls visit with the folder of the process's group, and of each group above it: of version 2, and of version 1 for a
 * controller such as "cpu". root is "" for the system's own files, or a folder that stands for /. */
void camber_control_group_visit(const char *root, const char *controller, void (*visit)(void *user, const char *folder),
                                void *user);

#endif
