/* Every OpenCL device on which checks run, opened in each way that they need: by itself, with other work-group sizes,
 * and once for each drawer, with every path by which it may receive a mesh. */
#ifndef CAMBER_VALIDATE_DEVICES_H
#define CAMBER_VALIDATE_DEVICES_H

#include "validate/fixture.h"
#include "validate/validation.h"

enum { CAMBER_CHECKED_PATHS = 3, CAMBER_CHECKED_GROUPS = 3 };

/* A path by which a mesh reaches a drawer. */
struct camber_drawing_path {
    const char *name; /* "gl", "zero-copy" or "copy", as in camber_sharing, or "no sharing" */
    camber_renderer *renderer;
    camber_mesh *mesh;
};

/* A GL back end or OpenCL, with the device opened once more for it. */
typedef struct camber_checked_drawer {
    const char *name; /* "EGL", "OSMesa", "OpenCL" */
    bool in_gl;
    camber_fixture fixture;
    camber_drawing_path paths[CAMBER_CHECKED_PATHS]; /* path_count of them: those that work, at least one */
    size_t path_count;
} camber_checked_drawer;

struct camber_checked_device {
    char name[160];  /* name of the device, with a number if several have the same name */
    uint32_t number; /* as in camber_device_desc */
    camber_device *device;
    camber_mesh *mesh;
    struct {
        uint32_t size, lanes;
        camber_device *device;
        camber_mesh *mesh;
    } groups[CAMBER_CHECKED_GROUPS]; /* other work-group sizes and lanes, group_count of them */
    size_t group_count;
    camber_checked_drawer drawers[CAMBER_FIXTURE_DRAWERS]; /* drawer_count of them */
    size_t drawer_count;
    /* [camber_method]: the current subject's mesh differs from the twin's, and is not drawn */
    bool broken[3];
};

/* Opens what the options allow. Anything missing becomes a skipped check. Returns CAMBER_ERROR_DEVICE if there is no
 * device, or if the selected one is missing. The caller closes it in any case. */
camber_status camber_checked_devices_open(camber_validation *validation);
void camber_checked_devices_close(camber_checked_devices *devices);

/* Opens the same device again with a limit for buffer sizes, and a mesh on it that is not drawn. mesh: NULL if no mesh
 * is needed. */
camber_status camber_checked_device_open_small(const camber_checked_device *checked,
                                               const camber_validation *validation, uint64_t largest_buffer_bytes,
                                               camber_device **device, camber_mesh **mesh);

#endif
