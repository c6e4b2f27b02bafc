/* Every OpenCL device that checks run on, opened in each way that they need: alone, with other work-group sizes, and
 * once for each drawer, with every path on which a mesh may reach it. */
#ifndef CAMBER_VALIDATE_DEVICES_H
#define CAMBER_VALIDATE_DEVICES_H

#include "validate/fixture.h"
#include "validate/validation.h"

enum { CAMBER_CHECKED_PATHS = 3, CAMBER_CHECKED_GROUPS = 3 };

/* A path on which a mesh reaches what draws it. */
struct camber_drawing_path {
    const char *name; /* "gl", "zero-copy", "copy", as camber_sharing has them, or "no sharing" */
    camber_renderer *renderer;
    camber_mesh *mesh;
};

/* A GL back end, or OpenCL without any, with the device opened once more for it. */
typedef struct camber_checked_drawer {
    const char *name; /* "EGL", "OSMesa", "OpenCL" */
    bool in_gl;
    camber_fixture fixture;
    camber_drawing_path paths[CAMBER_CHECKED_PATHS]; /* path_count, those that work; never none */
    size_t path_count;
} camber_checked_drawer;

struct camber_checked_device {
    char name[160];  /* of the device, and which of several of that name */
    uint32_t number; /* camber_device_desc's */
    camber_device *device;
    camber_mesh *mesh;
    struct {
        uint32_t size, lanes;
        camber_device *device;
        camber_mesh *mesh;
    } groups[CAMBER_CHECKED_GROUPS];                       /* other work-group sizes and lanes */
    camber_checked_drawer drawers[CAMBER_FIXTURE_DRAWERS]; /* drawer_count */
    size_t drawer_count;
    /* By camber_method: meshes of the subject at hand differ from the twin's, and are not drawn. */
    bool broken[3];
};

/* Opens what the options allow. What is not there becomes a skip. No device at all, or not the one that was asked for,
 * is CAMBER_ERROR_DEVICE. Closed by the caller in any case. */
camber_status camber_checked_devices_open(camber_validation *validation);
void camber_checked_devices_close(camber_checked_devices *devices);

/* Opens the same device with no buffer larger than this, and a mesh on it that is not drawn. mesh NULL: none. */
camber_status camber_checked_device_open_small(const camber_checked_device *checked,
                                               const camber_validation *validation, uint64_t largest_buffer_bytes,
                                               camber_device **device, camber_mesh **mesh);

#endif
