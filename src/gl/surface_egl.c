/* Opens EGL without a display: on Mesa's surfaceless platform, else on the first device that provides a GLES 3 context.
 */
#include "gl/egl.h"
#include "gl/surface.h"

#include <dlfcn.h>
#include <string.h>

enum { DEVICES_MAX = 16 };

typedef struct egl_state {
    void *library;
    EGLDisplay display;
    EGLContext context;
#define MEMBER(result, name, parameters) result(*egl##name) parameters;
    CAMBER_EGL_FUNCTIONS(MEMBER)
#undef MEMBER
} egl_state;

static bool load_library(egl_state *egl) {
    egl->library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
    if (!egl->library)
        return false;
    void *symbol;
#define LOAD(result, name, parameters)                                                                                 \
    symbol = dlsym(egl->library, "egl" #name);                                                                         \
    if (!symbol)                                                                                                       \
        return false;                                                                                                  \
    memcpy(&egl->egl##name, &symbol, sizeof symbol);
    CAMBER_EGL_FUNCTIONS(LOAD)
#undef LOAD
    return true;
}

static camber_function *load(camber_surface *surface, const char *name) {
    const egl_state *egl = surface->state;
    return egl->eglGetProcAddress(name);
}

/* Makes a GLES 3 context that reports its loss, if the driver supports that; else one that may draw garbage after a
 * loss, or end the process. */
static EGLContext create_context(const egl_state *egl, EGLConfig config, EGLContext shared) {
    static const EGLint telling[] = {EGL_CONTEXT_MAJOR_VERSION_KHR, 3,
                                     EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_EXT, EGL_LOSE_CONTEXT_ON_RESET_EXT,
                                     EGL_NONE};
    static const EGLint plain[] = {EGL_CONTEXT_MAJOR_VERSION_KHR, 3, EGL_NONE};
    const char *extensions = egl->eglQueryString(egl->display, EGL_EXTENSIONS);
    EGLContext made = NULL;
    if (extensions && strstr(extensions, "EGL_EXT_create_context_robustness"))
        made = egl->eglCreateContext(egl->display, config, shared, telling);
    return made ? made : egl->eglCreateContext(egl->display, config, shared, plain);
}

/* Makes a context on an initialised display. If it returns false, nothing is left to free but the display. */
static bool make_context(egl_state *egl, EGLContext shared) {
    static const EGLint config_wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT_KHR, EGL_SURFACE_TYPE, 0, EGL_NONE};
    EGLConfig config = NULL;
    EGLint count = 0;
    if (!egl->eglBindAPI(EGL_OPENGL_ES_API))
        return false;
    if (!egl->eglChooseConfig(egl->display, config_wanted, &config, 1, &count) || count < 1)
        config = NULL; /* EGL_NO_CONFIG_KHR: no surface is ever made */
    egl->context = create_context(egl, config, shared);
    if (!egl->context)
        return false;
    if (egl->eglMakeCurrent(egl->display, NULL, NULL, egl->context))
        return true;
    egl->eglDestroyContext(egl->display, egl->context);
    egl->context = NULL;
    return false;
}

static bool open_display(egl_state *egl, EGLDisplay display, EGLContext shared) {
    if (!display || !egl->eglInitialize(display, NULL, NULL))
        return false;
    egl->display = display;
    if (make_context(egl, shared))
        return true;
    egl->display = NULL; /* the display is not terminated: another surface may use it */
    return false;
}

static bool open_any(camber_surface *surface, egl_state *egl) {
    camber_egl_get_platform_display_fn *get_display;
    camber_egl_query_devices_fn *query_devices;
    camber_function *function = egl->eglGetProcAddress("eglGetPlatformDisplayEXT");
    memcpy(&get_display, &function, sizeof function);
    function = egl->eglGetProcAddress("eglQueryDevicesEXT");
    memcpy(&query_devices, &function, sizeof function);
    const char *client = egl->eglQueryString(NULL, EGL_EXTENSIONS);
    if (!get_display || !client)
        return false;
    surface->name = "EGL surfaceless";
    if (strstr(client, "EGL_MESA_platform_surfaceless") &&
        open_display(egl, get_display(EGL_PLATFORM_SURFACELESS_MESA, NULL, NULL), NULL))
        return true;
    surface->name = "EGL device";
    EGLDeviceEXT devices[DEVICES_MAX];
    EGLint count = 0;
    if (!query_devices || !query_devices(DEVICES_MAX, devices, &count))
        return false;
    for (EGLint i = 0; i < count; i++)
        if (open_display(egl, get_display(EGL_PLATFORM_DEVICE_EXT, devices[i], NULL), NULL))
            return true;
    return false;
}

static camber_status create(camber_surface *surface) {
    surface->name = "EGL";
    egl_state *egl = camber_alloc_zero(surface->context, 1, sizeof *egl);
    if (!egl)
        return CAMBER_ERROR_MEMORY;
    surface->state = egl;
    if (!load_library(egl))
        return camber_fail(surface->context, CAMBER_ERROR_DEVICE, "EGL: libEGL.so.1 cannot be loaded; install libegl1");
    if (surface->egl_context) {
        surface->name = "EGL shared";
        if (!open_display(egl, surface->egl_display, surface->egl_context))
            return camber_fail(surface->context, CAMBER_ERROR_DEVICE,
                               "EGL: no GLES 3 context shares objects with the caller's; give a GLES context and its "
                               "own display");
        return CAMBER_OK;
    }
    if (!open_any(surface, egl))
        return camber_fail(surface->context, CAMBER_ERROR_DEVICE,
                           "EGL: neither the surfaceless nor a device platform gives a GLES 3 context; install "
                           "libegl-mesa0 and libgl1-mesa-dri, or use OSMesa");
    return CAMBER_OK;
}

static bool make_current(camber_surface *surface) {
    const egl_state *egl = surface->state;
    /* Always, not only if another context is current: OSMesa replaces the dispatch table without EGL noticing. */
    if (egl->eglGetCurrentContext() == egl->context)
        egl->eglMakeCurrent(egl->display, NULL, NULL, NULL);
    egl->eglBindAPI(EGL_OPENGL_ES_API);
    if (egl->eglMakeCurrent(egl->display, NULL, NULL, egl->context))
        return true;
    surface->lost = egl->eglGetError() == EGL_CONTEXT_LOST;
    return false;
}

static void release(camber_surface *surface) {
    const egl_state *egl = surface->state;
    egl->eglMakeCurrent(egl->display, NULL, NULL, NULL);
}

static camber_gl_handles handles(const camber_surface *surface) {
    const egl_state *egl = surface->state;
    return (camber_gl_handles){
        .context = (intptr_t)egl->context, .display = (intptr_t)egl->display, .display_kind = CAMBER_GL_DISPLAY_EGL};
}

static void destroy(camber_surface *surface) {
    egl_state *egl = surface->state;
    if (!egl)
        return;
    if (egl->context) {
        release(surface);
        egl->eglDestroyContext(egl->display, egl->context);
    }
    /* The display belongs to the process and is shared by all surfaces on it, and the driver's library has running
     * threads. Both are kept, because EGL does not count references to a display. */
    camber_free(surface->context, egl);
}

const camber_surface_ops camber_surface_egl = {
    CAMBER_BACKEND_EGL, create, make_current, release, load, handles, destroy};
