/* texture: draws a line with camber into a texture of an engine, over the engine's sky. Exits with 77 if EGL is not
 * available. */
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>
#include <camber.h>
#include <math.h>
#include <stdio.h>

#define HEAD "P7\nWIDTH 800\nHEIGHT 500\nDEPTH 4\nMAXVAL 255\nTUPLTYPE RGB_ALPHA\nENDHDR\n"
enum { WIDTH = 800, HEIGHT = 500, POINTS = 3000 };

static EGLDisplay display;
static EGLContext engine;
static uint8_t screen[4 * WIDTH * HEIGHT];
static float points[2 * POINTS];
static const uint32_t offsets[] = {0, POINTS};

static bool open_engine(void) {
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
    display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    if (eglInitialize(display, NULL, NULL) && eglBindAPI(EGL_OPENGL_ES_API))
        engine = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, version);
    return engine && eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, engine);
}

/* The engine's part: a texture with a night sky. */
static GLuint draw_sky(void) {
    GLuint texture, framebuffer;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, WIDTH, HEIGHT);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    glClearColor(0.06f, 0.08f, 0.2f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    return texture;
}

/* camber's part, in a GL context that shares textures with the engine's. */
static bool draw_line(camber_context *context, const camber_polylines *line, GLuint texture) {
    const camber_texture target = {.name = texture, .keep = true}; /* draw over the existing picture */
    const camber_surface_desc shared = {.egl_context = engine, .egl_display = display};
    const camber_stroke stroke = {.width_px = 3};
    const camber_paint paint = {.width_px = 3, .color = {1, 0.85f, 0.5f, 0.8f}};
    const camber_tessellation_desc desc = {.strokes = &stroke, .stroke_count = 1};
    camber_pass pass = {.paints = &paint, .paint_count = 1};
    const camber_frame frame = {.width = WIDTH, .height = HEIGHT, .passes = &pass, .pass_count = 1};
    camber_surface *surface;
    camber_device *device;
    camber_renderer *renderer;
    return camber_surface_create(context, &shared, &surface) == CAMBER_OK &&
           camber_device_create(context, NULL, &device) == CAMBER_OK && /* with desc.gl it shares buffers, too */
           camber_renderer_create(device, surface, NULL, &renderer) == CAMBER_OK &&
           camber_mesh_create(device, renderer, &pass.mesh) == CAMBER_OK &&
           camber_mesh_tessellate(pass.mesh, line, &desc) == CAMBER_OK &&
           camber_renderer_render_texture(renderer, &frame, &target, NULL) == CAMBER_OK;
}

int main(void) {
    camber_polylines_desc desc = {.points = points, .point_count = POINTS, .offsets = offsets, .polyline_count = 1};
    camber_context *context;
    camber_polylines *line;
    for (int i = 0; i < 2 * POINTS; i++) { /* a rosette: x, y, x, ... */
        const float turn = 6.2831853f * (float)(i / 2) / (POINTS - 1), radius = 130 + 90 * cosf(37 * turn);
        points[i] = i % 2 ? 0.5f * HEIGHT + radius * sinf(5 * turn) : 0.5f * WIDTH + 1.4f * radius * cosf(5 * turn);
    }
    if (!open_engine())
        return 77;
    const GLuint texture = draw_sky();
    glFinish(); /* or give camber a fence: camber_texture.ready */
    if (camber_context_create(NULL, &context) != CAMBER_OK ||
        camber_polylines_create(context, &desc, &line) != CAMBER_OK || !draw_line(context, line, texture))
        return 1;
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, engine); /* the engine continues */
    glReadPixels(0, 0, WIDTH, HEIGHT, GL_RGBA, GL_UNSIGNED_BYTE, screen);
    FILE *file = fopen("texture.pam", "wb");
    return !file || fputs(HEAD, file) < 0 || fwrite(screen, sizeof screen, 1, file) != 1 || fclose(file) ? 1 : 0;
}
