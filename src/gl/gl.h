/* GLES 3 as camber calls it: the types, values and functions that it uses. The functions are loaded at run time: the
 * libraries of EGL and of OSMesa both export gl* symbols, so neither is linked, and a build needs nothing of GL. The
 * values and signatures are GL's own (tests/lint/declarations.py compares them with Khronos' headers). */
#ifndef CAMBER_GL_GL_H
#define CAMBER_GL_GL_H

#include "base/base.h"

#include <stddef.h>
#include <stdint.h>

typedef unsigned char GLboolean;
typedef unsigned char GLubyte;
typedef char GLchar;
typedef int GLint;
typedef int GLsizei;
typedef unsigned int GLuint;
typedef unsigned int GLenum;
typedef unsigned int GLbitfield;
typedef float GLfloat;
typedef uint64_t GLuint64;
typedef ptrdiff_t GLintptr;
typedef ptrdiff_t GLsizeiptr;
typedef struct __GLsync *GLsync;

#define GL_ARRAY_BUFFER 0x8892
#define GL_BLEND 0x0BE2
#define GL_COLOR_ATTACHMENT0 0x8CE0
#define GL_COLOR_ATTACHMENT1 0x8CE1
#define GL_COLOR_BUFFER_BIT 0x00004000
#define GL_COMPILE_STATUS 0x8B81
#define GL_CONTEXT_LOST_KHR 0x0507
#define GL_COPY_READ_BUFFER 0x8F36
#define GL_COPY_WRITE_BUFFER 0x8F37
#define GL_CULL_FACE 0x0B44
#define GL_DEPTH24_STENCIL8 0x88F0
#define GL_DEPTH_STENCIL_ATTACHMENT 0x821A
#define GL_DITHER 0x0BD0
#define GL_DYNAMIC_DRAW 0x88E8
#define GL_ELEMENT_ARRAY_BUFFER 0x8893
#define GL_EQUAL 0x0202
#define GL_EXTENSIONS 0x1F03
#define GL_FLOAT 0x1406
#define GL_FRAGMENT_SHADER 0x8B30
#define GL_FRAMEBUFFER 0x8D40
#define GL_FRAMEBUFFER_COMPLETE 0x8CD5
#define GL_INCR 0x1E02
#define GL_LEQUAL 0x0203
#define GL_LINEAR 0x2601
#define GL_LINK_STATUS 0x8B82
#define GL_MAJOR_VERSION 0x821B
#define GL_MAP_COHERENT_BIT_EXT 0x0080
#define GL_MAP_PERSISTENT_BIT_EXT 0x0040
#define GL_MAP_READ_BIT 0x0001
#define GL_MAP_WRITE_BIT 0x0002
#define GL_MAX_TEXTURE_BUFFER_SIZE 0x8C2B
#define GL_MAX_TEXTURE_SIZE 0x0D33
#define GL_MAX_VIEWPORT_DIMS 0x0D3A
#define GL_MINOR_VERSION 0x821C
#define GL_NEAREST 0x2600
#define GL_NO_ERROR 0
#define GL_NUM_EXTENSIONS 0x821D
#define GL_NUM_PROGRAM_BINARY_FORMATS 0x87FE
#define GL_ONE 1
#define GL_ONE_MINUS_SRC_ALPHA 0x0303
#define GL_ONE_MINUS_SRC_COLOR 0x0301
#define GL_OUT_OF_MEMORY 0x0505
#define GL_PACK_ROW_LENGTH 0x0D02
#define GL_PIXEL_UNPACK_BUFFER 0x88EC
#define GL_PROGRAM_BINARY_LENGTH 0x8741
#define GL_PROGRAM_BINARY_RETRIEVABLE_HINT 0x8257
#define GL_R8 0x8229
#define GL_RENDERBUFFER 0x8D41
#define GL_RENDERER 0x1F01
#define GL_RGBA 0x1908
#define GL_RGBA16F 0x881A
#define GL_RGBA32F 0x8814
#define GL_RGBA32UI 0x8D70
#define GL_RGBA8 0x8058
#define GL_SCISSOR_TEST 0x0C11
#define GL_STATIC_DRAW 0x88E4
#define GL_STENCIL_BUFFER_BIT 0x00000400
#define GL_STENCIL_TEST 0x0B90
#define GL_STREAM_DRAW 0x88E0
#define GL_STREAM_READ 0x88E1
#define GL_SYNC_GPU_COMMANDS_COMPLETE 0x9117
#define GL_TEXTURE0 0x84C0
#define GL_TEXTURE_2D 0x0DE1
#define GL_TEXTURE_BUFFER 0x8C2A
#define GL_TEXTURE_HEIGHT 0x1001
#define GL_TEXTURE_INTERNAL_FORMAT 0x1003
#define GL_TEXTURE_MAG_FILTER 0x2800
#define GL_TEXTURE_MIN_FILTER 0x2801
#define GL_TEXTURE_WIDTH 0x1000
#define GL_TIMEOUT_IGNORED 0xFFFFFFFFFFFFFFFFull
#define GL_TRIANGLES 0x0004
#define GL_TRIANGLE_STRIP 0x0005
#define GL_TRUE 1
#define GL_UNPACK_ROW_LENGTH 0x0CF2
#define GL_UNSIGNED_BYTE 0x1401
#define GL_UNSIGNED_INT 0x1405
#define GL_VERSION 0x1F02
#define GL_VERTEX_SHADER 0x8B31
#define GL_ZERO 0

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
