/* OSMesa: Mesa draws into memory, with desktop GL's core profile. Newer versions of Mesa no longer have it, so it is
 * tried second. */
#include "gl/surface.h"

#include <dlfcn.h>
#include <string.h>

/* Copied from GL/osmesa.h, which newer systems lack, as they lack the library. */
#define OSMESA_FORMAT 0x22
#define OSMESA_RGBA GL_RGBA
#define OSMESA_PROFILE 0x33
#define OSMESA_CORE_PROFILE 0x34
#define OSMESA_CONTEXT_MAJOR_VERSION 0x36
#define OSMESA_CONTEXT_MINOR_VERSION 0x37
typedef struct osmesa_context *OSMesaContext;

typedef struct osmesa_state {
    void *library;
    OSMesaContext context;
    OSMesaContext (*create)(const int *attributes, OSMesaContext share);
    GLboolean (*make_current)(OSMesaContext context, void *buffer, GLenum type, GLsizei width, GLsizei height);
    camber_function *(*load)(const char *name);
    void (*destroy)(OSMesaContext context);
    uint32_t pixel; /* OSMesa needs a buffer of its own, but camber draws into framebuffer objects */
} osmesa_state;

static bool find(void *library, const char *name, void *function) {
    void *symbol = dlsym(library, name);
    memcpy(function, &symbol, sizeof symbol);
    return symbol != NULL;
}

static bool load_library(osmesa_state *osmesa) {
    static const char *const names[] = {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"};
    for (size_t i = 0; i < sizeof names / sizeof *names && !osmesa->library; i++)
        osmesa->library = dlopen(names[i], RTLD_NOW | RTLD_LOCAL);
    return osmesa->library && find(osmesa->library, "OSMesaCreateContextAttribs", &osmesa->create) &&
           find(osmesa->library, "OSMesaMakeCurrent", &osmesa->make_current) &&
           find(osmesa->library, "OSMesaGetProcAddress", &osmesa->load) &&
           find(osmesa->library, "OSMesaDestroyContext", &osmesa->destroy);
}

static bool make_current(camber_surface *surface) {
    osmesa_state *osmesa = surface->state;
    return osmesa->make_current(osmesa->context, &osmesa->pixel, GL_UNSIGNED_BYTE, 1, 1);
}

static void release(camber_surface *surface) {
    const osmesa_state *osmesa = surface->state;
    osmesa->make_current(NULL, NULL, 0, 0, 0);
}

static camber_status create(camber_surface *surface) {
    /* 4.3 has primitive restart with the fixed index, and compiles GLES 3 shaders. */
    static const int wanted[] = {OSMESA_FORMAT,
                                 OSMESA_RGBA,
                                 OSMESA_PROFILE,
                                 OSMESA_CORE_PROFILE,
                                 OSMESA_CONTEXT_MAJOR_VERSION,
                                 4,
                                 OSMESA_CONTEXT_MINOR_VERSION,
                                 3,
                                 0};
    surface->name = "OSMesa";
    osmesa_state *osmesa = camber_alloc_zero(surface->context, 1, sizeof *osmesa);
    if (!osmesa)
        return CAMBER_ERROR_MEMORY;
    surface->state = osmesa;
    if (!load_library(osmesa))
        return camber_fail(surface->context, CAMBER_ERROR_DEVICE,
                           "OSMesa: libOSMesa.so.8 cannot be loaded; install libosmesa6");
    osmesa->context = osmesa->create(wanted, NULL);
    if (!osmesa->context || !make_current(surface))
        return camber_fail(surface->context, CAMBER_ERROR_DEVICE, "OSMesa: no GL 4.3 core context; use EGL");
    return CAMBER_OK;
}

static camber_function *load(camber_surface *surface, const char *name) {
    const osmesa_state *osmesa = surface->state;
    return osmesa->load(name);
}

static void destroy(camber_surface *surface) {
    osmesa_state *osmesa = surface->state;
    if (!osmesa)
        return;
    if (osmesa->context) {
        release(surface);
        osmesa->destroy(osmesa->context);
    }
    /* The library stays loaded: its driver's threads may still be running in it. */
    camber_free(surface->context, osmesa);
}

const camber_surface_ops camber_surface_osmesa = {
    CAMBER_BACKEND_OSMESA, create, make_current, release, load, NULL, destroy};
