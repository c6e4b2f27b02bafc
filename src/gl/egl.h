/* EGL as surface_egl.c calls it, as gl.h is GLES. Its null handles are NULL here. */
#ifndef CAMBER_GL_EGL_H
#define CAMBER_GL_EGL_H

#include "gl/gl.h"

typedef unsigned int EGLBoolean;
typedef unsigned int EGLenum;
typedef int32_t EGLint;
typedef void *EGLDisplay;
typedef void *EGLConfig;
typedef void *EGLSurface;
typedef void *EGLContext;
typedef void *EGLDeviceEXT;

#define EGL_CONTEXT_LOST 0x300E
#define EGL_CONTEXT_MAJOR_VERSION_KHR 0x3098
#define EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_EXT 0x3138
#define EGL_EXTENSIONS 0x3055
#define EGL_LOSE_CONTEXT_ON_RESET_EXT 0x31BF
#define EGL_NONE 0x3038
#define EGL_OPENGL_ES3_BIT_KHR 0x00000040
#define EGL_OPENGL_ES_API 0x30A0
#define EGL_PLATFORM_DEVICE_EXT 0x313F
#define EGL_PLATFORM_SURFACELESS_MESA 0x31DD
#define EGL_RENDERABLE_TYPE 0x3040
#define EGL_SURFACE_TYPE 0x3033

#define CAMBER_EGL_FUNCTIONS(X)                                                                                        \
    X(EGLBoolean, Initialize, (EGLDisplay, EGLint *, EGLint *))                                                        \
    X(EGLBoolean, BindAPI, (EGLenum))                                                                                  \
    X(EGLBoolean, ChooseConfig, (EGLDisplay, const EGLint *, EGLConfig *, EGLint, EGLint *))                           \
    X(EGLContext, CreateContext, (EGLDisplay, EGLConfig, EGLContext, const EGLint *))                                  \
    X(EGLBoolean, DestroyContext, (EGLDisplay, EGLContext))                                                            \
    X(EGLBoolean, MakeCurrent, (EGLDisplay, EGLSurface, EGLSurface, EGLContext))                                       \
    X(EGLContext, GetCurrentContext, (void))                                                                           \
    X(EGLint, GetError, (void))                                                                                        \
    X(const char *, QueryString, (EGLDisplay, EGLint))                                                                 \
    X(camber_function *, GetProcAddress, (const char *))

/* Functions of extensions. */
typedef EGLDisplay camber_egl_get_platform_display_fn(EGLenum platform, void *native, const EGLint *attributes);
typedef EGLBoolean camber_egl_query_devices_fn(EGLint capacity, EGLDeviceEXT *devices, EGLint *count);

#endif
