/* Surfaces are opened first, then the device, which may share buffers with a surface, and renderers last. */
#include "validate/fixture.h"

static const struct {
    const char *name;
    camber_backend backend;
} drawers[CAMBER_FIXTURE_DRAWERS] = {
    {"EGL", CAMBER_BACKEND_EGL}, {"OSMesa", CAMBER_BACKEND_OSMESA}, {"OpenCL", CAMBER_BACKEND_AUTO}};

const char *camber_fixture_drawer_name(camber_fixture_drawer drawer) {
    return drawers[drawer].name;
}

camber_backend camber_fixture_backend(camber_fixture_drawer drawer) {
    return drawers[drawer].backend;
}

/* ---- Opening ---- */

typedef struct opening {
    camber_context *context;
    const camber_fixture_desc *desc;
    camber_fixture *fixture;
    unsigned here;        /* drawers whose surface is open, and OpenCL */
    camber_status status; /* of the last call that failed */
} opening;

static void leave_out(opening *o, camber_fixture_drawer drawer, camber_status status) {
    o->status = status;
    o->here &= ~(1u << drawer);
    if (o->desc->missing)
        o->desc->missing(o->desc->user, drawer);
}

static void open_surfaces(opening *o) {
    for (int i = 0; i < CAMBER_FIXTURE_BACKENDS; i++) {
        const camber_surface_desc desc = {.backend = drawers[i].backend};
        if (!(o->desc->drawers & 1u << i) || (o->desc->first_gl && o->here & CAMBER_FIXTURE_IN_GL))
            continue;
        const camber_status status = camber_surface_create(o->context, &desc, &o->fixture->surface[i]);
        if (status == CAMBER_OK)
            o->here |= 1u << i;
        else
            leave_out(o, (camber_fixture_drawer)i, status);
    }
    o->here |= o->desc->drawers & CAMBER_FIXTURE_IN_OPENCL;
}

static camber_status open_device(opening *o) {
    camber_surface *surface = NULL;
    for (int i = 0; i < CAMBER_FIXTURE_BACKENDS && o->desc->on_surface && !surface; i++)
        surface = o->fixture->surface[i];
    camber_device_desc desc = o->desc->device;
    desc.gl = camber_surface_get_handles(surface);
    return camber_device_create(o->context, &desc, &o->fixture->device);
}

static void open_renderers(opening *o) {
    for (int i = 0; i < CAMBER_FIXTURE_DRAWERS; i++) {
        const camber_fixture_drawer drawer = (camber_fixture_drawer)i;
        if (!(o->here & 1u << i) || o->desc->surfaces_alone)
            continue;
        const camber_status status =
            camber_fixture_open_renderer(o->fixture, drawer, CAMBER_SHARING_AUTO, &o->fixture->renderer[i]);
        if (status != CAMBER_OK)
            leave_out(o, drawer, status);
    }
}

camber_status camber_fixture_open(camber_context *context, const camber_fixture_desc *desc, camber_fixture *fixture) {
    *fixture = (camber_fixture){0};
    opening o = {.context = context, .desc = desc, .fixture = fixture};
    open_surfaces(&o);
    if (desc->drawers && !o.here)
        return o.status;
    const camber_status status = open_device(&o);
    if (status != CAMBER_OK)
        return status;
    open_renderers(&o);
    return o.here || !desc->drawers ? CAMBER_OK : o.status;
}

camber_status camber_fixture_open_renderer(const camber_fixture *fixture, camber_fixture_drawer drawer,
                                           camber_sharing sharing, camber_renderer **renderer) {
    const bool in_gl = drawer != CAMBER_FIXTURE_OPENCL;
    const camber_renderer_desc desc = {.sharing = sharing,
                                       .rasterizer = in_gl ? CAMBER_RASTERIZER_GL : CAMBER_RASTERIZER_OPENCL};
    return camber_renderer_create(fixture->device, in_gl ? fixture->surface[drawer] : NULL, &desc, renderer);
}

camber_renderer *camber_fixture_any(const camber_fixture *fixture) {
    for (int i = 0; i < CAMBER_FIXTURE_DRAWERS; i++)
        if (fixture->renderer[i])
            return fixture->renderer[i];
    return NULL;
}

void camber_fixture_close(camber_fixture *fixture) {
    for (int i = 0; i < CAMBER_FIXTURE_DRAWERS; i++)
        camber_renderer_destroy(fixture->renderer[i]);
    camber_device_destroy(fixture->device);
    for (int i = 0; i < CAMBER_FIXTURE_BACKENDS; i++)
        camber_surface_destroy(fixture->surface[i]);
    *fixture = (camber_fixture){0};
}
