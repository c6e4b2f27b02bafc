/* The GL functions that camber calls, loaded at run time: the libraries of EGL and of OSMesa both export gl* symbols,
 * so neither is linked. */
#ifndef CAMBER_GL_GL_H
#define CAMBER_GL_GL_H

#include "base/base.h"

#include <GLES3/gl32.h>
/* This header needs the one above. */
#include <GLES2/gl2ext.h>

#define CAMBER_GL_FUNCTIONS(X)                                                                                         \
    X(GLenum, GetError, (void))                                                                                        \
    X(const GLubyte *, GetString, (GLenum))                                                                            \
    X(const GLubyte *, GetStringi, (GLenum, GLuint))                                                                   \
    X(void, GetIntegerv, (GLenum, GLint *))                                                                            \
    X(void, Enable, (GLenum))                                                                                          \
    X(void, Disable, (GLenum))                                                                                         \
    X(void, BlendFuncSeparate, (GLenum, GLenum, GLenum, GLenum))                                                       \
    X(void, BlendFunc, (GLenum, GLenum))                                                                               \
    X(void, StencilFunc, (GLenum, GLint, GLuint))                                                                      \
    X(void, StencilOp, (GLenum, GLenum, GLenum))                                                                       \
    X(void, Viewport, (GLint, GLint, GLsizei, GLsizei))                                                                \
    X(void, Scissor, (GLint, GLint, GLsizei, GLsizei))                                                                 \
    X(void, ClearColor, (GLfloat, GLfloat, GLfloat, GLfloat))                                                          \
    X(void, Clear, (GLbitfield))                                                                                       \
    X(void, Finish, (void))                                                                                            \
    X(void, Flush, (void))                                                                                             \
    X(GLsync, FenceSync, (GLenum, GLbitfield))                                                                         \
    X(GLenum, ClientWaitSync, (GLsync, GLbitfield, GLuint64))                                                          \
    X(void, WaitSync, (GLsync, GLbitfield, GLuint64))                                                                  \
    X(void, DeleteSync, (GLsync))                                                                                      \
    X(void, PixelStorei, (GLenum, GLint))                                                                              \
    X(void, ReadPixels, (GLint, GLint, GLsizei, GLsizei, GLenum, GLenum, void *))                                      \
    X(GLuint, CreateShader, (GLenum))                                                                                  \
    X(void, ShaderSource, (GLuint, GLsizei, const GLchar *const *, const GLint *))                                     \
    X(void, CompileShader, (GLuint))                                                                                   \
    X(void, GetShaderiv, (GLuint, GLenum, GLint *))                                                                    \
    X(void, GetShaderInfoLog, (GLuint, GLsizei, GLsizei *, GLchar *))                                                  \
    X(void, DeleteShader, (GLuint))                                                                                    \
    X(GLuint, CreateProgram, (void))                                                                                   \
    X(void, AttachShader, (GLuint, GLuint))                                                                            \
    X(void, LinkProgram, (GLuint))                                                                                     \
    X(void, GetProgramiv, (GLuint, GLenum, GLint *))                                                                   \
    X(void, GetProgramInfoLog, (GLuint, GLsizei, GLsizei *, GLchar *))                                                 \
    X(void, ProgramParameteri, (GLuint, GLenum, GLint))                                                                \
    X(void, GetProgramBinary, (GLuint, GLsizei, GLsizei *, GLenum *, void *))                                          \
    X(void, ProgramBinary, (GLuint, GLenum, const void *, GLsizei))                                                    \
    X(void, DeleteProgram, (GLuint))                                                                                   \
    X(void, UseProgram, (GLuint))                                                                                      \
    X(GLint, GetUniformLocation, (GLuint, const GLchar *))                                                             \
    X(void, Uniform1i, (GLint, GLint))                                                                                 \
    X(void, Uniform2f, (GLint, GLfloat, GLfloat))                                                                      \
    X(void, Uniform4f, (GLint, GLfloat, GLfloat, GLfloat, GLfloat))                                                    \
    X(void, GenVertexArrays, (GLsizei, GLuint *))                                                                      \
    X(void, DeleteVertexArrays, (GLsizei, const GLuint *))                                                             \
    X(void, BindVertexArray, (GLuint))                                                                                 \
    X(void, GenBuffers, (GLsizei, GLuint *))                                                                           \
    X(void, DeleteBuffers, (GLsizei, const GLuint *))                                                                  \
    X(void, BindBuffer, (GLenum, GLuint))                                                                              \
    X(void, BufferData, (GLenum, GLsizeiptr, const void *, GLenum))                                                    \
    X(void, BufferSubData, (GLenum, GLintptr, GLsizeiptr, const void *))                                               \
    X(void, CopyBufferSubData, (GLenum, GLenum, GLintptr, GLintptr, GLsizeiptr))                                       \
    X(GLboolean, UnmapBuffer, (GLenum))                                                                                \
    X(void *, MapBufferRange, (GLenum, GLintptr, GLsizeiptr, GLbitfield))                                              \
    X(void, DrawArrays, (GLenum, GLint, GLsizei))                                                                      \
    X(void, DrawElements, (GLenum, GLsizei, GLenum, const void *))                                                     \
    X(void, GenTextures, (GLsizei, GLuint *))                                                                          \
    X(void, DeleteTextures, (GLsizei, const GLuint *))                                                                 \
    X(void, ActiveTexture, (GLenum))                                                                                   \
    X(void, BindTexture, (GLenum, GLuint))                                                                             \
    X(void, TexParameteri, (GLenum, GLenum, GLint))                                                                    \
    X(void, GetTexLevelParameteriv, (GLenum, GLint, GLenum, GLint *))                                                  \
    X(void, TexStorage2D, (GLenum, GLsizei, GLenum, GLsizei, GLsizei))                                                 \
    X(void, TexSubImage2D, (GLenum, GLint, GLint, GLint, GLsizei, GLsizei, GLenum, GLenum, const void *))              \
    X(void, GenFramebuffers, (GLsizei, GLuint *))                                                                      \
    X(void, DeleteFramebuffers, (GLsizei, const GLuint *))                                                             \
    X(void, BindFramebuffer, (GLenum, GLuint))                                                                         \
    X(void, FramebufferTexture2D, (GLenum, GLenum, GLenum, GLuint, GLint))                                             \
    X(void, FramebufferRenderbuffer, (GLenum, GLenum, GLenum, GLuint))                                                 \
    X(void, GenRenderbuffers, (GLsizei, GLuint *))                                                                     \
    X(void, DeleteRenderbuffers, (GLsizei, const GLuint *))                                                            \
    X(void, BindRenderbuffer, (GLenum, GLuint))                                                                        \
    X(void, RenderbufferStorage, (GLenum, GLenum, GLsizei, GLsizei))                                                   \
    X(void, DrawBuffers, (GLsizei, const GLenum *))                                                                    \
    X(GLenum, CheckFramebufferStatus, (GLenum))

/* Extensions that not every driver has. */
typedef void camber_gl_buffer_storage_fn(GLenum target, GLsizeiptr size, const void *data, GLbitfield flags);
typedef GLenum camber_gl_reset_status_fn(void);
typedef void camber_gl_multi_draw_arrays_fn(GLenum mode, const GLint *first, const GLsizei *count, GLsizei draw_count);
typedef void camber_gl_tex_buffer_fn(GLenum target, GLenum format, GLuint buffer);

typedef struct camber_gl {
#define CAMBER_GL_MEMBER(result, name, parameters) result(*name) parameters;
    CAMBER_GL_FUNCTIONS(CAMBER_GL_MEMBER)
#undef CAMBER_GL_MEMBER
    camber_gl_buffer_storage_fn *BufferStorage;        /* NULL: absent */
    camber_gl_reset_status_fn *GetGraphicsResetStatus; /* NULL: absent */
    camber_gl_multi_draw_arrays_fn *MultiDrawArrays;   /* NULL: absent */
    camber_gl_tex_buffer_fn *TexBuffer;                /* required: core or an extension */
} camber_gl;

/* Any function, before it is cast to its type. */
typedef void camber_function(void);

#endif
