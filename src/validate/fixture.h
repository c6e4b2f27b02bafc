/* A device and what draws on it, opened as asked: the one way for tests, for the checks of validate, and for the
 * benchmark. What this machine lacks is left out, and the caller is told. */
#ifndef CAMBER_VALIDATE_FIXTURE_H
#define CAMBER_VALIDATE_FIXTURE_H

#include "camber.h"

/* Whatever draws pictures: a back end of GL, or kernels, which need no surface. */
typedef enum camber_fixture_drawer {
    CAMBER_FIXTURE_EGL = 0,
    CAMBER_FIXTURE_OSMESA,
    CAMBER_FIXTURE_OPENCL,
    CAMBER_FIXTURE_DRAWERS,
} camber_fixture_drawer;

enum {
    CAMBER_FIXTURE_BACKENDS = CAMBER_FIXTURE_OPENCL, /* of GL */
    /* Bits of camber_fixture_desc's drawers. */
    CAMBER_FIXTURE_IN_EGL = 1 << CAMBER_FIXTURE_EGL,
    CAMBER_FIXTURE_IN_OSMESA = 1 << CAMBER_FIXTURE_OSMESA,
    CAMBER_FIXTURE_IN_GL = CAMBER_FIXTURE_IN_EGL | CAMBER_FIXTURE_IN_OSMESA,
    CAMBER_FIXTURE_IN_OPENCL = 1 << CAMBER_FIXTURE_OPENCL,
};

/* "EGL", "OSMesa", "OpenCL" */
const char *camber_fixture_drawer_name(camber_fixture_drawer drawer);
/* CAMBER_BACKEND_AUTO for OpenCL. */
camber_backend camber_fixture_backend(camber_fixture_drawer drawer);

typedef struct camber_fixture_desc {
    camber_device_desc device;
    unsigned drawers;    /* CAMBER_FIXTURE_IN_*. 0: the device alone */
    bool first_gl;       /* one back end of GL is enough: the first that is here */
    bool on_surface;     /* the device opens for the first surface, so that meshes can be shared with GL */
    bool surfaces_alone; /* no renderers: the caller opens them with camber_fixture_open_renderer */
    /* A drawer that was asked for is not here. The context's log has said why. NULL: nobody wants to know. */
    void (*missing)(void *user, camber_fixture_drawer drawer);
    void *user;
} camber_fixture_desc;

typedef struct camber_fixture {
    camber_device *device;
    camber_surface *surface[CAMBER_FIXTURE_BACKENDS];  /* NULL: not here, or not asked for */
    camber_renderer *renderer[CAMBER_FIXTURE_DRAWERS]; /* the same */
} camber_fixture;

/* Returns CAMBER_OK where the device is open and, where drawers were asked for, at least one of them. Else the status
 * of the last call that failed. The caller closes the fixture in any case. */
camber_status camber_fixture_open(camber_context *context, const camber_fixture_desc *desc, camber_fixture *fixture);
void camber_fixture_close(camber_fixture *fixture);

/* Opens one more renderer, which the caller destroys before the fixture closes. */
camber_status camber_fixture_open_renderer(const camber_fixture *fixture, camber_fixture_drawer drawer,
                                           camber_sharing sharing, camber_renderer **renderer);
/* The first renderer; NULL: there is none. */
camber_renderer *camber_fixture_any(const camber_fixture *fixture);

#endif
