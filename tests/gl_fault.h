/* A surface whose GL can be told to fail: its table of functions counts their calls, and the n-th has no effect but an
 * error. One surface at a time. */
#ifndef CAMBER_TESTS_GL_FAULT_H
#define CAMBER_TESTS_GL_FAULT_H

#include "core.h"

#include "draw/renderer.h"

static struct fault {
    camber_gl gl; /* the driver's */
    const camber_surface_ops *ops;
    camber_surface *surface;
    const char *only;      /* the function that is counted. NULL: all */
    size_t calls, fail_at; /* counted from 1; 0: none fails */
    GLenum error;          /* what GL reports of the call that failed. GL_NO_ERROR: nothing */
    GLenum pending;
    size_t current_calls, current_fail_at;
    bool current_lost;
    size_t queries, query_fail_at; /* of GetError */
    size_t resets, reset_at;       /* queries of the reset status */
} fault;

static bool fails(const char *name) {
    if (fault.only && strcmp(fault.only, name) != 0)
        return false;
    if (++fault.calls != fault.fail_at)
        return false;
    fault.pending = fault.error;
    return true;
}

static GLenum fail_GetError(void) {
    const GLenum error = fault.pending;
    if (++fault.queries == fault.query_fail_at) {
        fault.pending = fault.error == GL_CONTEXT_LOST_KHR ? fault.error : GL_NO_ERROR;
        return fault.error;
    }
    if (error == GL_NO_ERROR)
        return fault.gl.GetError();
    if (error != GL_CONTEXT_LOST_KHR) /* for ever */
        fault.pending = GL_NO_ERROR;
    return error;
}

static GLenum fail_GetGraphicsResetStatus(void) {
    return ++fault.resets == fault.reset_at ? GL_GUILTY_CONTEXT_RESET_EXT : GL_NO_ERROR;
}

/* Calls that the driver may refuse, without an effect then. */
#define STEPS(X)                                                                                                       \
    X(CompileShader, (GLuint a), (a))                                                                                  \
    X(LinkProgram, (GLuint a), (a))                                                                                    \
    X(UseProgram, (GLuint a), (a))                                                                                     \
    X(GenVertexArrays, (GLsizei a, GLuint * b), (a, b))                                                                \
    X(GenBuffers, (GLsizei a, GLuint * b), (a, b))                                                                     \
    X(BufferData, (GLenum a, GLsizeiptr b, const void *c, GLenum d), (a, b, c, d))                                     \
    X(BufferSubData, (GLenum a, GLintptr b, GLsizeiptr c, const void *d), (a, b, c, d))                                \
    X(BufferStorage, (GLenum a, GLsizeiptr b, const void *c, GLbitfield d), (a, b, c, d))                              \
    X(CopyBufferSubData, (GLenum a, GLenum b, GLintptr c, GLintptr d, GLsizeiptr e), (a, b, c, d, e))                  \
    X(GenTextures, (GLsizei a, GLuint * b), (a, b))                                                                    \
    X(TexStorage2D, (GLenum a, GLsizei b, GLenum c, GLsizei d, GLsizei e), (a, b, c, d, e))                            \
    X(TexSubImage2D, (GLenum a, GLint b, GLint c, GLint d, GLsizei e, GLsizei f, GLenum g, GLenum h, const void *i),   \
      (a, b, c, d, e, f, g, h, i))                                                                                     \
    X(GenRenderbuffers, (GLsizei a, GLuint * b), (a, b))                                                               \
    X(RenderbufferStorage, (GLenum a, GLenum b, GLsizei c, GLsizei d), (a, b, c, d))                                   \
    X(GenFramebuffers, (GLsizei a, GLuint * b), (a, b))                                                                \
    X(FramebufferTexture2D, (GLenum a, GLenum b, GLenum c, GLuint d, GLint e), (a, b, c, d, e))                        \
    X(Clear, (GLbitfield a), (a))                                                                                      \
    X(DrawArrays, (GLenum a, GLint b, GLsizei c), (a, b, c))                                                           \
    X(MultiDrawArrays, (GLenum a, const GLint *b, const GLsizei *c, GLsizei d), (a, b, c, d))                          \
    X(DrawElements, (GLenum a, GLsizei b, GLenum c, const void *d), (a, b, c, d))                                      \
    X(ReadPixels, (GLint a, GLint b, GLsizei c, GLsizei d, GLenum e, GLenum f, void *g), (a, b, c, d, e, f, g))

/* Calls that answer, and the answer of a failure. */
#define ANSWERS(X)                                                                                                     \
    X(GLuint, 0, CreateShader, (GLenum a), (a))                                                                        \
    X(GLuint, 0, CreateProgram, (void), ())                                                                            \
    X(void *, NULL, MapBufferRange, (GLenum a, GLintptr b, GLsizeiptr c, GLbitfield d), (a, b, c, d))                  \
    X(GLenum, GL_FRAMEBUFFER_UNSUPPORTED, CheckFramebufferStatus, (GLenum a), (a))

#define STEP(name, parameters, arguments)                                                                              \
    static void fail_##name parameters {                                                                               \
        if (!fails(#name))                                                                                             \
            fault.gl.name arguments;                                                                                   \
    }
#define ANSWER(result, none, name, parameters, arguments)                                                              \
    static result fail_##name parameters {                                                                             \
        return fails(#name) ? (none) : fault.gl.name arguments;                                                        \
    }
STEPS(STEP)
ANSWERS(ANSWER)

/* What a compiler says, in two lines. */
static void say_log(GLuint object, GLsizei size, GLsizei *length, GLchar *text) {
    (void)object;
    (void)length;
    snprintf(text, (size_t)size, "0:1: no such thing\n0:2: nor this\n");
}

static bool fail_make_current(camber_surface *surface) {
    if (++fault.current_calls != fault.current_fail_at)
        return fault.ops->make_current(surface);
    surface->lost = fault.current_lost;
    return false;
}

static camber_surface_ops fault_ops;

static inline void fault_on(camber_surface *surface) {
    fault = (struct fault){.gl = surface->gl, .ops = surface->ops, .surface = surface, .error = GL_OUT_OF_MEMORY};
    camber_gl *gl = &surface->gl;
#define INSTALL_STEP(name, parameters, arguments) gl->name = gl->name ? fail_##name : NULL;
#define INSTALL_ANSWER(result, none, name, parameters, arguments) gl->name = fail_##name;
    STEPS(INSTALL_STEP)
    ANSWERS(INSTALL_ANSWER)
    gl->GetError = fail_GetError;
    gl->GetGraphicsResetStatus = fail_GetGraphicsResetStatus;
    gl->GetShaderInfoLog = gl->GetProgramInfoLog = say_log;
    fault_ops = *surface->ops;
    fault_ops.make_current = fail_make_current;
    surface->ops = &fault_ops;
}

static inline void fault_off(void) {
    fault.surface->gl = fault.gl;
    fault.surface->ops = fault.ops;
}

#endif
