/* A device and its drawers, opened as requested, for tests, the checks of validate, and the benchmark. Missing drawers
 * are left out and reported to the caller. */
#ifndef CAMBER_VALIDATE_FIXTURE_H
#define CAMBER_VALIDATE_FIXTURE_H

#include "camber.h"

/* A drawer makes pictures: a GL back end, or kernels, which need no surface. */
typedef enum camber_fixture_drawer {
    CAMBER_FIXTURE_EGL = 0,
    CAMBER_FIXTURE_OSMESA,
    CAMBER_FIXTURE_OPENCL,
    CAMBER_FIXTURE_DRAWERS,
} camber_fixture_drawer;

enum {
    CAMBER_FIXTURE_BACKENDS = CAMBER_FIXTURE_OPENCL, /* number of GL back ends */
    /* Bits for camber_fixture_desc.drawers. */
    CAMBER_FIXTURE_IN_EGL = 1 << CAMBER_FIXTURE_EGL,
    CAMBER_FIXTURE_IN_OSMESA = 1 << CAMBER_FIXTURE_OSMESA,
    CAMBER_FIXTURE_IN_GL = CAMBER_FIXTURE_IN_EGL | CAMBER_FIXTURE_IN_OSMESA,
    CAMBER_FIXTURE_IN_OPENCL = 1 << CAMBER_FIXTURE_OPENCL,
};

/* "EGL", "OSMesa", "OpenCL" */
const char *camber_fixture_drawer_name(camber_fixture_drawer drawer);
/* Returns CAMBER_BACKEND_AUTO for OpenCL. */
camber_backend camber_fixture_backend(camber_fixture_drawer drawer);

typedef struct camber_fixture_desc {
    camber_device_desc device;
    unsigned drawers;    /* CAMBER_FIXTURE_IN_*. 0: only the device */
    bool first_gl;       /* open only the first GL back end that is available */
    bool on_surface;     /* open the device for the first surface, so that meshes can be shared with GL */
    bool surfaces_alone; /* open no renderers: the caller opens them with camber_fixture_open_renderer */
    /* Called for a requested drawer that is not available; the context's log has the reason. May be NULL. */
    void (*missing)(void *user, camber_fixture_drawer drawer);
    void *user;
} camber_fixture_desc;

typedef struct camber_fixture {
    camber_device *device;
    camber_surface *surface[CAMBER_FIXTURE_BACKENDS];  /* NULL: not available, or not requested */
    camber_renderer *renderer[CAMBER_FIXTURE_DRAWERS]; /* NULL: not available, or not requested */
} camber_fixture;

/* Returns CAMBER_OK if the device and, if drawers were requested, at least one of them are open; otherwise the status
 * of the last call that failed. The caller closes the fixture in any case. */
camber_status camber_fixture_open(camber_context *context, const camber_fixture_desc *desc, camber_fixture *fixture);
void camber_fixture_close(camber_fixture *fixture);

/* Opens another renderer, which the caller destroys before the fixture is closed. */
camber_status camber_fixture_open_renderer(const camber_fixture *fixture, camber_fixture_drawer drawer,
                                           camber_sharing sharing, camber_renderer **renderer);
/* Returns the first renderer; NULL if there is none. */
camber_renderer *camber_fixture_any(const camber_fixture *fixture);

#endif
