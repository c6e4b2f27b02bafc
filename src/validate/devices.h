/* What the checks of validate run on: every OpenCL device, alone, with every GL back end and every sharing path, and
 * drawing itself. */
#ifndef CAMBER_VALIDATE_DEVICES_H
#define CAMBER_VALIDATE_DEVICES_H

#include "cli/session.h"
#include "validate/results.h"

enum { CAMBER_RIG_EASELS = 3, CAMBER_RIG_PATHS = 3, CAMBER_RIG_GROUPS = 2 };

/* A way for a mesh to reach what draws it. */
typedef struct camber_drawing_path {
    const char *name;
    camber_renderer *renderer;
    camber_mesh *mesh;
} camber_drawing_path;

/* A GL back end, or OpenCL without any, with the device opened once more for it. */
typedef struct camber_checked_drawer {
    const char *name; /* "EGL", "OSMesa", "OpenCL" */
    camber_draw draw;
    camber_surface *surface; /* NULL: OpenCL draws */
    camber_device *device;
    camber_drawing_path paths[CAMBER_RIG_PATHS]; /* path_count, those that work; never none */
    size_t path_count;
} camber_checked_drawer;

typedef struct camber_checked_device {
    char name[160];  /* of the device, and which of several of that name */
    uint32_t number; /* camber_device_desc's */
    camber_device *device;
    camber_mesh *mesh;
    struct {
        uint32_t size;
        camber_device *device;
        camber_mesh *mesh;
    } groups[CAMBER_RIG_GROUPS];                     /* other work-group sizes */
    camber_checked_drawer easels[CAMBER_RIG_EASELS]; /* easel_count */
    size_t easel_count;
    bool broken[3]; /* by camber_method: meshes of the subject at hand differ from the twin's, and are not drawn */
} camber_checked_device;

typedef struct camber_checked_devices {
    camber_checked_device *list; /* count */
    size_t count;
} camber_checked_devices;

/* Opens what --device, --draw and --backend allow. What is not there becomes a skip; no device at all, or not the one
 * that was asked for, is CAMBER_EXIT_UNAVAILABLE, its line printed. Can be closed in any case. */
int camber_checked_devices_open(camber_checked_devices *rigs, camber_session *session, camber_results *verdicts);
void camber_checked_devices_close(camber_checked_devices *rigs);

/* The rig's device with no buffer larger than this, and a mesh on it. */
camber_status camber_checked_device_open_small(const camber_checked_device *rig, camber_session *session,
                                               uint64_t largest_buffer_bytes, camber_device **device,
                                               camber_mesh **mesh);

#endif
