/* Surfaces: one file per back end (surface_egl.c, surface_osmesa.c). Drawing code does not know the back ends: it calls
 * through camber_gl and camber_surface_ops. */
#ifndef CAMBER_GL_SURFACE_H
#define CAMBER_GL_SURFACE_H

#include "gl/gl.h"
#include "gpu/shared_buffer.h"

typedef struct camber_surface_ops {
    camber_backend backend;
    /* Loads the library and makes a context, current on this thread. Logs on failure. */
    camber_status (*create)(camber_surface *surface);
    bool (*make_current)(camber_surface *surface); /* false: permanently, if the surface's lost is set */
    void (*release)(camber_surface *surface);      /* afterwards no context is current on this thread */
    camber_function *(*load)(camber_surface *surface, const char *name);
    camber_gl_handles (*handles)(const camber_surface *surface); /* NULL: none */
    void (*destroy)(camber_surface *surface);
} camber_surface_ops;

extern const camber_surface_ops camber_surface_egl;
extern const camber_surface_ops camber_surface_osmesa;

struct camber_surface {
    camber_context *context;
    const camber_surface_ops *ops;
    void *egl_context, *egl_display; /* the caller's, with which the context shares objects. NULL: none */
    void *state;                     /* the back end's */
    const char *name;                /* set by create: "EGL surfaceless", ... */
    camber_gl gl;
    camber_surface_info info;
    bool half_float_targets; /* half-float textures can be drawn into, with blending */
    bool es_3_2;             /* GLES 3.2, or desktop GL with the same functions */
    uint32_t records_max;    /* the most records in a texture buffer */
    GLint largest_viewport[2];
    bool lost; /* the GL context is lost, and everything in it */
};

/* Makes the surface's GL context current. Every public call that draws begins with this: EGL and OSMesa share one
 * dispatch table, and another surface may have been current. */
camber_status camber_surface_make_current(camber_surface *surface);
/* The same before GL objects are freed, without logging. Returns false if they were freed with the context, or will be.
 */
bool camber_surface_try_current(camber_surface *surface);

/* Returns as a status the errors that GL has reported since the last check, and logs them. `what` names the call that
 * failed. */
camber_status camber_surface_check(camber_surface *surface, const char *what);
/* Drops the errors that GL has reported, after a failure that is logged already. */
void camber_surface_forget_errors(camber_surface *surface);

#endif
