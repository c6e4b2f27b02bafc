/* Frames in textures: the bytes that rows have, by each way of sharing, in each kind of drawing; over what a texture
 * holds and upside down, as the host puts it together; in a context of the caller's; and what is refused or fails. */
#include "gl_fault.h"
#include "pictures.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>

enum { WIDTH = 203, HEIGHT = 149, ROWS = 3, KINDS = 2 };

static const camber_rasterizer KIND[KINDS] = {CAMBER_RASTERIZER_GL, CAMBER_RASTERIZER_OPENCL};
static const camber_sharing PATH[] = {CAMBER_SHARING_GL, CAMBER_SHARING_ZERO_COPY, CAMBER_SHARING_COPY};

/* ---- The pictures ---- */

typedef struct drawing {
    camber_mesh *mesh;
    camber_paint paints[2][ROWS];
    camber_pass passes[2];
    camber_frame frame;
} drawing;

/* Wide lines, and translucent ones over them, on nothing. */
static void begin_drawing(const fixture *s, camber_renderer *renderer, drawing *d) {
    static const camber_stroke strokes[ROWS] = {
        {.width_px = 9}, {.width_px = 5, .join = CAMBER_JOIN_MITER}, {.width_px = 2}};
    const camber_tessellation_desc desc = {.strokes = strokes, .stroke_count = ROWS};
    camber_made_scene lines = {0};
    uint64_t seed = 11;
    for (size_t i = 0; i < 30; i++) {
        for (int k = 0; k < 5; k++) {
            const double y = camber_random_between(&seed, -9, HEIGHT + 9);
            camber_made_scene_point(&lines, camber_random_between(&seed, -9, WIDTH + 9), y);
        }
        camber_made_scene_end(&lines, i % ROWS);
    }
    *d = (drawing){.frame = {.width = WIDTH, .height = HEIGHT, .pass_count = 2}};
    d->mesh = fixture_mesh(s, renderer, &lines, &desc);
    camber_made_scene_free(&lines);
    for (size_t i = 0; i < ROWS; i++) {
        const float shade = 0.3f * (float)i, width = strokes[i].width_px;
        d->paints[0][i] = (camber_paint){.width_px = width, .color = {1 - shade, 0.2f, shade, 1}};
        d->paints[1][i] = (camber_paint){.width_px = 0.6f * width, .color = {0, 1, shade, 0.5f}, .translate_x_px = 4};
    }
    for (size_t i = 0; i < 2; i++)
        d->passes[i] = (camber_pass){.mesh = d->mesh, .paints = d->paints[i], .paint_count = ROWS};
    d->frame.passes = d->passes;
}

/* ---- Textures ---- */

/* top down, or NULL: with nothing defined in it. The surface's context is current then. */
static GLuint make_texture(camber_surface *surface, const picture *p, uint32_t width, uint32_t height) {
    const camber_gl *gl = &surface->gl;
    GLuint name = 0;
    assert_int_equal(camber_surface_make_current(surface), CAMBER_OK);
    gl->GenTextures(1, &name);
    gl->BindTexture(GL_TEXTURE_2D, name);
    gl->TexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, (GLsizei)width, (GLsizei)height);
    if (p)
        gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, (GLsizei)width, (GLsizei)height, GL_RGBA, GL_UNSIGNED_BYTE, p->rgba);
    return name;
}

static picture read_texture(camber_surface *surface, GLuint name, uint32_t width, uint32_t height) {
    const camber_gl *gl = &surface->gl;
    picture p = {malloc(4 * (size_t)width * height), width, height, height, 0};
    GLuint framebuffer = 0;
    assert_non_null(p.rgba);
    assert_int_equal(camber_surface_make_current(surface), CAMBER_OK);
    gl->GenFramebuffers(1, &framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, name, 0);
    gl->ReadPixels(0, 0, (GLsizei)width, (GLsizei)height, GL_RGBA, GL_UNSIGNED_BYTE, p.rgba);
    gl->DeleteFramebuffers(1, &framebuffer);
    assert_int_equal(gl->GetError(), GL_NO_ERROR);
    return p;
}

static void drop_texture(camber_surface *surface, GLuint name) {
    surface->gl.DeleteTextures(1, &name);
}

/* ---- The same bytes ---- */

/* Frames of several sizes, in areas and at once, one behind the other and not waited for. */
static void compare_frames(const fixture *s, camber_surface *surface, camber_renderer *shared, camber_renderer *alone) {
    static const struct {
        uint32_t width, height, piece_px;
        camber_color background;
    } frames[] = {{WIDTH, HEIGHT, 0, {0, 0, 0, 0}},
                  {WIDTH, HEIGHT, 64, {0.2f, 0.4f, 1, 1}},
                  {64, 32, 0, {1, 1, 1, 0.5f}},
                  {WIDTH, HEIGHT, 0, {1, 1, 1, 1}},
                  {1, 1, 0, {1, 0, 0, 1}}};
    enum { FRAMES = sizeof frames / sizeof *frames };
    drawing d, reference;
    GLuint names[FRAMES];
    void *drawn[FRAMES];
    begin_drawing(s, shared, &d);
    begin_drawing(s, alone, &reference);
    for (size_t i = 0; i < FRAMES; i++)
        names[i] = make_texture(surface, NULL, frames[i].width, frames[i].height);
    for (size_t i = 0; i < FRAMES; i++) {
        d.frame.width = frames[i].width;
        d.frame.height = frames[i].height;
        d.frame.largest_area_px = frames[i].piece_px;
        d.frame.background = frames[i].background;
        drawn[i] = NULL;
        assert_int_equal(
            camber_renderer_render_texture(shared, &d.frame, &(camber_texture){.name = names[i]}, drawn + i),
            CAMBER_OK);
        reference.frame = d.frame;
        reference.frame.passes = reference.passes;
    }
    for (size_t i = 0; i < FRAMES; i++) {
        reference.frame.width = frames[i].width;
        reference.frame.height = frames[i].height;
        reference.frame.background = frames[i].background;
        picture wanted = picture_draw(alone, &reference.frame);
        assert_int_equal(camber_surface_make_current(surface), CAMBER_OK);
        assert_non_null(drawn[i]);
        assert_int_not_equal(surface->gl.ClientWaitSync(drawn[i], 0, 1000000000), GL_TIMEOUT_EXPIRED);
        surface->gl.DeleteSync(drawn[i]);
        picture p = read_texture(surface, names[i], frames[i].width, frames[i].height);
        picture_assert_same(&wanted, &p);
        drop_texture(surface, names[i]);
        picture_free(&wanted);
        picture_free(&p);
    }
    camber_mesh_destroy(d.mesh);
    camber_mesh_destroy(reference.mesh);
}

/* Kernels draw the same with a surface as without, also as rows. */
static void test_kernels(void **state) {
    const fixture *s = *state;
    camber_renderer *alone = NULL;
    size_t found = 0;
    assert_int_equal(camber_renderer_create(s->on.device, NULL, NULL, &alone), CAMBER_OK);
    for (size_t k = 0; k < CAMBER_FIXTURE_BACKENDS * 3; k++) {
        camber_surface *surface = s->on.surface[k / 3];
        const camber_renderer_desc desc = {.rasterizer = CAMBER_RASTERIZER_OPENCL, .sharing = PATH[k % 3]};
        camber_renderer *shared = NULL;
        host *h = (host *)(uintptr_t)&s->h;
        if (!surface || camber_renderer_create(s->on.device, surface, &desc, &shared) != CAMBER_OK) {
            h->errors = 0;
            continue;
        }
        printf("# %s, %s\n", fixture_name((int)k / 3), camber_sharing_get_name(PATH[k % 3]));
        found++;
        assert_int_equal(camber_renderer_get_sharing(shared), PATH[k % 3]);
        assert_int_equal(camber_renderer_get_rasterizer(shared), CAMBER_RASTERIZER_OPENCL);
        compare_frames(s, surface, shared, alone);
        drawing d, reference;
        begin_drawing(s, shared, &d);
        begin_drawing(s, alone, &reference);
        picture p = picture_draw(shared, &d.frame), wanted = picture_draw(alone, &reference.frame);
        picture_assert_same(&wanted, &p);
        picture_free(&p);
        picture_free(&wanted);
        camber_mesh_destroy(d.mesh);
        camber_mesh_destroy(reference.mesh);
        camber_renderer_destroy(shared);
    }
    camber_renderer_destroy(alone);
    assert_true(found > 0);
}

static void test_shaders(void **state) {
    const fixture *s = *state;
    for (int i = 0; i < CAMBER_FIXTURE_BACKENDS; i++)
        if (s->on.renderer[i] && s->on.surface[i])
            compare_frames(s, s->on.surface[i], s->on.renderer[i], s->on.renderer[i]);
}

/* ---- Over what a texture holds ---- */

static picture make_ground(void) {
    picture p = {malloc(4 * WIDTH * HEIGHT), WIDTH, HEIGHT, HEIGHT, 0};
    assert_non_null(p.rgba);
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            const uint32_t a = x < WIDTH / 2 ? 255 : 2 * y % 256, v = (x * 5 + y * 3) % 256;
            const uint8_t pixel[4] = {(uint8_t)(v * a / 255), (uint8_t)((255 - v) * a / 255), (uint8_t)(a / 2),
                                      (uint8_t)a};
            memcpy(p.rgba + 4 * ((size_t)WIDTH * y + x), pixel, 4);
        }
    return p;
}

static void turn_over(picture *p) {
    uint8_t row[4 * WIDTH];
    for (uint32_t y = 0; y < HEIGHT / 2; y++) {
        uint8_t *a = p->rgba + (size_t)y * sizeof row, *b = p->rgba + (size_t)(HEIGHT - 1 - y) * sizeof row;
        memcpy(row, a, sizeof row);
        memcpy(a, b, sizeof row);
        memcpy(b, row, sizeof row);
    }
}

/* Premultiplied, one over the other, by doubles. */
static picture put_over(const picture *below, const picture *above) {
    picture p = {malloc(4 * WIDTH * HEIGHT), WIDTH, HEIGHT, HEIGHT, 0};
    assert_non_null(p.rgba);
    for (size_t i = 0; i < 4 * WIDTH * HEIGHT; i++) {
        const double through = 1 - above->rgba[i / 4 * 4 + 3] / 255.0;
        const double sum = above->rgba[i] + through * below->rgba[i];
        p.rgba[i] = (uint8_t)(sum < 255 ? sum + 0.5 : 255);
    }
    return p;
}

static void compare_over(const fixture *s, camber_surface *surface, camber_renderer *renderer) {
    drawing d;
    begin_drawing(s, renderer, &d);
    picture lines = picture_draw(renderer, &d.frame);
    for (int way = 0; way < 4; way++) {
        const bool keep = way & 1, bottom_up = way & 2;
        picture ground = make_ground(), wanted = keep ? put_over(&ground, &lines) : lines;
        if (bottom_up)
            turn_over(&ground);
        const GLuint name = make_texture(surface, &ground, WIDTH, HEIGHT);
        const camber_texture texture = {.name = name, .keep = keep, .bottom_up = bottom_up};
        assert_int_equal(camber_renderer_render_texture(renderer, &d.frame, &texture, NULL), CAMBER_OK);
        picture p = read_texture(surface, name, WIDTH, HEIGHT);
        if (bottom_up)
            turn_over(&p);
        const difference apart = picture_compare(&wanted, &p);
        assert_true(apart.drawn > 1000);
        assert_true(apart.most <= (keep ? 1 : 0)); /* GL rounds what it blends once, the host as well */
        drop_texture(surface, name);
        picture_free(&p);
        picture_free(&ground);
        if (keep)
            picture_free(&wanted);
    }
    picture_free(&lines);
    camber_mesh_destroy(d.mesh);
}

static void test_over(void **state) {
    const fixture *s = *state;
    for (int i = 0; i < CAMBER_FIXTURE_BACKENDS * KINDS; i++) {
        camber_surface *surface = s->on.surface[i / KINDS];
        const camber_renderer_desc desc = {.rasterizer = KIND[i % KINDS]};
        camber_renderer *renderer = NULL;
        if (!surface)
            continue;
        assert_int_equal(camber_renderer_create(s->on.device, surface, &desc, &renderer), CAMBER_OK);
        compare_over(s, surface, renderer);
        camber_renderer_destroy(renderer);
    }
}

/* GL's lines below those of kernels, below GL's again, with nothing read back between. */
static void test_in_turn(void **state) {
    const fixture *s = *state;
    camber_surface *surface = s->on.surface[0] ? s->on.surface[0] : s->on.surface[1];
    const camber_renderer_desc desc = {.rasterizer = CAMBER_RASTERIZER_OPENCL};
    camber_renderer *turns[3] = {fixture_any(s), NULL, fixture_any(s)};
    drawing d[3];
    picture wanted = {calloc(4, WIDTH * HEIGHT), WIDTH, HEIGHT, HEIGHT, 0};
    assert_int_equal(camber_renderer_create(s->on.device, surface, &desc, &turns[1]), CAMBER_OK);
    const GLuint name = make_texture(surface, &wanted, WIDTH, HEIGHT);
    for (int i = 0; i < 3; i++) {
        void *drawn = NULL;
        begin_drawing(s, turns[i], &d[i]);
        d[i].passes[0].polyline_count = d[i].passes[1].polyline_count = 10;
        d[i].passes[0].first_polyline = d[i].passes[1].first_polyline = 10 * (size_t)i;
        picture lines = picture_draw(turns[i], &d[i].frame), both = put_over(&wanted, &lines);
        picture_free(&wanted);
        picture_free(&lines);
        wanted = both;
        assert_int_equal(camber_renderer_render_texture(turns[i], &d[i].frame,
                                                        &(camber_texture){.name = name, .keep = true}, &drawn),
                         CAMBER_OK);
        surface->gl.DeleteSync(drawn);
    }
    picture p = read_texture(surface, name, WIDTH, HEIGHT);
    assert_true(picture_compare(&wanted, &p).most <= 3); /* one a turn */
    drop_texture(surface, name);
    picture_free(&wanted);
    picture_free(&p);
    for (int i = 0; i < 3; i++)
        camber_mesh_destroy(d[i].mesh);
    camber_renderer_destroy(turns[1]);
}

/* ---- A context of the caller's ---- */

typedef struct engine {
    void *egl;
    EGLDisplay display;
    EGLContext context;
    PFNEGLMAKECURRENTPROC make_current;
    PFNEGLDESTROYCONTEXTPROC destroy;
    PFNEGLGETPROCADDRESSPROC load;
} engine;

static void *symbol_of(const engine *e, const char *name) {
    void *symbol = dlsym(e->egl, name);
    assert_non_null(symbol);
    return symbol;
}

#define TAKE(e, name, to)                                                                                              \
    do {                                                                                                               \
        void *symbol = symbol_of(e, name);                                                                             \
        memcpy(&(to), &symbol, sizeof symbol);                                                                         \
    } while (0)

static bool open_engine(engine *e) {
    static const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION_KHR, 3, EGL_NONE};
    PFNEGLGETPLATFORMDISPLAYEXTPROC get_display = NULL;
    PFNEGLINITIALIZEPROC initialize;
    PFNEGLBINDAPIPROC bind;
    PFNEGLCREATECONTEXTPROC create;
    *e = (engine){.egl = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL)};
    if (!e->egl)
        return false;
    TAKE(e, "eglInitialize", initialize);
    TAKE(e, "eglBindAPI", bind);
    TAKE(e, "eglCreateContext", create);
    TAKE(e, "eglMakeCurrent", e->make_current);
    TAKE(e, "eglDestroyContext", e->destroy);
    TAKE(e, "eglGetProcAddress", e->load);
    camber_function *function = e->load("eglGetPlatformDisplayEXT");
    memcpy(&get_display, &function, sizeof function);
    e->display = get_display ? get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL) : EGL_NO_DISPLAY;
    if (!initialize || !bind || !create || e->display == EGL_NO_DISPLAY || !initialize(e->display, NULL, NULL) ||
        !bind(EGL_OPENGL_ES_API))
        return false;
    e->context = create(e->display, NULL, EGL_NO_CONTEXT, wanted);
    return e->context != EGL_NO_CONTEXT && e->make_current && e->destroy;
}

static void use_engine(const engine *e) {
    assert_true(e->make_current(e->display, EGL_NO_SURFACE, EGL_NO_SURFACE, e->context));
}

/* The engine makes the texture and looks at it; between them are only fences. */
static void draw_for_engine(const fixture *s, const engine *e, camber_surface *surface, camber_rasterizer kind) {
    const camber_gl *gl = &surface->gl; /* the same functions in any context of EGL's */
    const camber_renderer_desc desc = {.rasterizer = kind};
    camber_renderer *renderer = NULL;
    drawing d;
    void *drawn = NULL;
    GLuint name = 0, framebuffer = 0;
    assert_int_equal(camber_renderer_create(s->on.device, surface, &desc, &renderer), CAMBER_OK);
    begin_drawing(s, renderer, &d);
    picture lines = picture_draw(renderer, &d.frame), ground = make_ground(), wanted = put_over(&ground, &lines);
    use_engine(e);
    gl->GenTextures(1, &name);
    gl->BindTexture(GL_TEXTURE_2D, name);
    gl->TexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, WIDTH, HEIGHT);
    gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, WIDTH, HEIGHT, GL_RGBA, GL_UNSIGNED_BYTE, ground.rgba);
    GLsync ready = gl->FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl->Flush();
    const camber_texture texture = {.name = name, .keep = true, .ready = (void *)ready};
    assert_int_equal(camber_renderer_render_texture(renderer, &d.frame, &texture, &drawn), CAMBER_OK);
    use_engine(e);
    gl->WaitSync(drawn, 0, GL_TIMEOUT_IGNORED);
    gl->GenFramebuffers(1, &framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, name, 0);
    picture p = {malloc(4 * WIDTH * HEIGHT), WIDTH, HEIGHT, HEIGHT, 0};
    gl->ReadPixels(0, 0, WIDTH, HEIGHT, GL_RGBA, GL_UNSIGNED_BYTE, p.rgba);
    assert_int_equal(gl->GetError(), GL_NO_ERROR);
    assert_true(picture_compare(&wanted, &p).most <= 1);
    gl->DeleteFramebuffers(1, &framebuffer);
    gl->DeleteTextures(1, &name);
    gl->DeleteSync(ready);
    gl->DeleteSync(drawn);
    picture_free(&p);
    picture_free(&lines);
    picture_free(&ground);
    picture_free(&wanted);
    camber_mesh_destroy(d.mesh);
    camber_renderer_destroy(renderer);
}

static void test_engine(void **state) {
    fixture *s = *state;
    engine e;
    camber_surface *surface = NULL;
    if (!open_engine(&e))
        skip();
    const camber_surface_desc desc = {.egl_context = e.context, .egl_display = e.display};
    assert_int_equal(camber_surface_create(s->context, &desc, &surface), CAMBER_OK);
    assert_string_equal(camber_surface_get_info(surface).backend, "EGL shared");
    for (int i = 0; i < KINDS; i++)
        draw_for_engine(s, &e, surface, KIND[i]);
    camber_surface_destroy(surface);
    /* The log tells what cannot be shared. */
    const camber_surface_desc osmesa = {CAMBER_BACKEND_OSMESA, e.context, e.display};
    assert_int_equal(camber_surface_create(s->context, &osmesa, &surface), CAMBER_ERROR_ARGUMENT);
    assert_story(&s->h, "use the back end EGL");
    const camber_surface_desc nowhere = {.egl_context = e.context};
    assert_int_equal(camber_surface_create(s->context, &nowhere, &surface), CAMBER_ERROR_DEVICE);
    assert_story(&s->h, "its own display");
    e.make_current(e.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    assert_true(e.destroy(e.display, e.context));
}

/* ---- Refusals ---- */

static void test_refused(void **state) {
    fixture *s = *state;
    for (int i = 0; i < CAMBER_FIXTURE_BACKENDS * KINDS; i++) {
        camber_surface *surface = s->on.surface[i / KINDS];
        const camber_renderer_desc desc = {.rasterizer = KIND[i % KINDS]};
        camber_renderer *renderer = NULL;
        drawing d;
        if (!surface)
            continue;
        assert_int_equal(camber_renderer_create(s->on.device, surface, &desc, &renderer), CAMBER_OK);
        begin_drawing(s, renderer, &d);
        const GLuint small = make_texture(surface, NULL, WIDTH, HEIGHT - 1),
                     good = make_texture(surface, NULL, WIDTH, HEIGHT);
        GLuint gray = 0;
        surface->gl.GenTextures(1, &gray);
        surface->gl.BindTexture(GL_TEXTURE_2D, gray);
        surface->gl.TexStorage2D(GL_TEXTURE_2D, 1, GL_R8, WIDTH, HEIGHT);
        const GLuint refused[] = {0, small, gray, 100000};
        for (size_t k = 0; k < sizeof refused / sizeof *refused; k++) {
            assert_int_equal(
                camber_renderer_render_texture(renderer, &d.frame, &(camber_texture){.name = refused[k]}, NULL),
                CAMBER_ERROR_ARGUMENT);
            assert_story(&s->h, "203 x 149 px, like the frame");
        }
        const uint32_t longest = camber_surface_get_info(surface).largest_target_px;
        camber_frame wide = d.frame;
        wide.width = longest + 1;
        if (wide.width <= 65535) {
            assert_int_equal(camber_renderer_render_texture(renderer, &wide, &(camber_texture){.name = good}, NULL),
                             CAMBER_ERROR_LIMIT);
            assert_story(&s->h, "draw a smaller one");
        }
        /* And then it draws. */
        assert_int_equal(camber_renderer_render_texture(renderer, &d.frame, &(camber_texture){.name = good}, NULL),
                         CAMBER_OK);
        const GLuint names[] = {small, good, gray};
        surface->gl.DeleteTextures(3, names);
        camber_mesh_destroy(d.mesh);
        camber_renderer_destroy(renderer);
    }
}

static void test_no_surface(void **state) {
    fixture *s = *state;
    camber_renderer *alone = NULL;
    drawing d;
    assert_int_equal(camber_renderer_create(s->on.device, NULL, NULL, &alone), CAMBER_OK);
    begin_drawing(s, alone, &d);
    assert_int_equal(camber_renderer_render_texture(alone, &d.frame, &(camber_texture){.name = 1}, NULL),
                     CAMBER_ERROR_ARGUMENT);
    assert_story(&s->h, "create it with a surface");
    camber_mesh_destroy(d.mesh);
    camber_renderer_destroy(alone);
}

/* ---- Faults ---- */

typedef struct victim {
    fixture *s;
    camber_surface *surface;
    camber_renderer *renderer;
    drawing d;
    GLuint name;
    picture wanted;
} victim;

static camber_status attempt(const victim *v) {
    return camber_renderer_render_texture(v->renderer, &v->d.frame,
                                          &(camber_texture){.name = v->name, .bottom_up = true}, NULL);
}

/* The n-th call fails for every n; what comes after is whole. */
static void sweep(victim *v, GLenum error) {
    size_t n = 1;
    for (bool reached = true; reached; n++) {
        assert_true(n < 500);
        fault_on(v->surface);
        fault.fail_at = n;
        fault.error = error;
        const camber_status status = attempt(v);
        reached = fault.calls >= n;
        fault_off();
        if (status != CAMBER_OK) {
            assert_int_equal(status, error == GL_OUT_OF_MEMORY ? CAMBER_ERROR_MEMORY : CAMBER_ERROR_DEVICE);
            assert_story(&v->s->h, ";");
        }
        assert_true(!reached || status != CAMBER_OK);
        assert_int_equal(attempt(v), CAMBER_OK);
        picture p = read_texture(v->surface, v->name, WIDTH, HEIGHT);
        picture_assert_same(&v->wanted, &p);
        picture_free(&p);
    }
    assert_true(n > 3);
}

static void check_loss(victim *v) {
    fault_on(v->surface);
    fault.only = "TexSubImage2D";
    fault.fail_at = 1;
    fault.error = GL_CONTEXT_LOST_KHR;
    assert_int_equal(attempt(v), CAMBER_ERROR_DEVICE);
    assert_story(&v->s->h, "lost");
    assert_true(camber_surface_is_lost(v->surface));
    assert_int_equal(attempt(v), CAMBER_ERROR_DEVICE);
    assert_story(&v->s->h, "lost");
    fault_off();
    /* Kernels still draw rows. */
    if (camber_renderer_get_rasterizer(v->renderer) == CAMBER_RASTERIZER_OPENCL) {
        picture p = picture_draw(v->renderer, &v->d.frame);
        turn_over(&p);
        picture_assert_same(&v->wanted, &p);
        picture_free(&p);
    }
}

static void test_faults(void **state) {
    fixture *s = *state;
    for (size_t k = 0; k < KINDS * 2; k++) {
        const camber_renderer_desc desc = {.rasterizer = KIND[k % KINDS],
                                           .sharing = k < KINDS ? CAMBER_SHARING_COPY : CAMBER_SHARING_AUTO};
        victim v = {.s = s};
        if (camber_surface_create(s->context, NULL, &v.surface) != CAMBER_OK)
            skip();
        assert_int_equal(camber_renderer_create(s->on.device, v.surface, &desc, &v.renderer), CAMBER_OK);
        begin_drawing(s, v.renderer, &v.d);
        v.name = make_texture(v.surface, NULL, WIDTH, HEIGHT);
        v.wanted = picture_draw(v.renderer, &v.d.frame);
        turn_over(&v.wanted);
        sweep(&v, GL_OUT_OF_MEMORY);
        sweep(&v, GL_INVALID_OPERATION);
        check_loss(&v);
        camber_mesh_destroy(v.d.mesh);
        camber_renderer_destroy(v.renderer);
        camber_surface_destroy(v.surface);
        picture_free(&v.wanted);
        assert_int_equal(s->h.errors, 0);
    }
}

static camber_status attempt_all(camber_context *context, void *user) {
    victim *v = user;
    const camber_renderer_desc desc = {.rasterizer = CAMBER_RASTERIZER_OPENCL};
    camber_renderer *renderer = NULL;
    camber_mesh *mesh = v->d.mesh;
    (void)context;
    camber_status status = camber_renderer_create(v->s->on.device, v->surface, &desc, &renderer);
    if (status == CAMBER_OK) {
        mesh->owner = renderer; /* it is the kernels' alike */
        status = camber_renderer_render_texture(renderer, &v->d.frame, &(camber_texture){.name = v->name, .keep = true},
                                                NULL);
    }
    camber_renderer_destroy(renderer);
    mesh->owner = v->renderer;
    return status;
}

static void test_memory(void **state) {
    fixture *s = *state;
    const camber_renderer_desc desc = {.rasterizer = CAMBER_RASTERIZER_OPENCL};
    victim v = {.s = s, .surface = s->on.surface[0] ? s->on.surface[0] : s->on.surface[1]};
    assert_int_equal(camber_renderer_create(s->on.device, v.surface, &desc, &v.renderer), CAMBER_OK);
    begin_drawing(s, v.renderer, &v.d);
    v.name = make_texture(v.surface, NULL, WIDTH, HEIGHT);
    assert_int_equal(attempt_all(s->context, &v), CAMBER_OK);
    each_allocation_fails(&s->h, attempt_all, s->context, &v);
    drop_texture(v.surface, v.name);
    camber_mesh_destroy(v.d.mesh);
    camber_renderer_destroy(v.renderer);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_kernels),    cmocka_unit_test(test_shaders), cmocka_unit_test(test_over),
        cmocka_unit_test(test_in_turn),    cmocka_unit_test(test_engine),  cmocka_unit_test(test_refused),
        cmocka_unit_test(test_no_surface), cmocka_unit_test(test_faults),  cmocka_unit_test(test_memory),
    };
    return FIXTURE_RUN(tests);
}
