/* viewer FILE...: shows a map in a window, and how an engine draws one sixty times a second.
 *
 * Input: files that camber_map.h reads, a style, and the user's mouse and keys. Output: a window, or with --benchmark
 * the times of the frames on a flight over the map. Main idea: only fast work runs on the main thread. A frame moves
 * the camera over the network of the front scene, which takes milliseconds. A worker thread reads files and styles, and
 * evaluates the style for another zoom. It does so in the back scene, which has a context of its own. Then the two
 * scenes are swapped. So a frame never waits; while the user zooms, lines have the widths of a few frames ago.
 *
 *     drag, arrows: pan    right drag: turn, tilt    q, e: turn    w, s: tilt    n: north up, no tilt
 *     wheel, +, -: zoom    t: theme    g: graph of the frames' times    Escape: quit */
#include <EGL/egl.h>
#include <GLES3/gl3.h>
#include <SDL.h>
#include <camber_map.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { GRAPH_WIDTH = 240, GRAPH_HEIGHT = 100, BENCHMARK_FRAMES = 600, WARM_UPS = 10 };
enum { STATE_IDLE = 0, STATE_BUSY, STATE_DONE }; /* of the worker */

static const double PI = 3.14159265358979323846;
static const double SIMPLIFY_PX = 0.1, COARSEST_PX = 1; /* at rest; the most while moving */
static const double ZOOM_STEP = 0.1;                    /* between scenes, so widths differ by at most 7 % */
static const double SHORT_MS = 10, LONG_MS = 15; /* frames faster than this get more points, and slower ones fewer */

typedef struct options {
    char **paths;
    int path_count, width, height, frames;
    const char *style; /* name of a built-in style, or a file */
    bool dark, benchmark;
    camber_rasterizer rasterizer;
} options;

/* The camera's position. x and y are the centre, in the unit square of Web Mercator. */
typedef struct stand {
    double x, y, zoom, bearing_deg, pitch_deg;
    double ratio;           /* device px per CSS px */
    uint32_t width, height; /* CSS px */
} stand;

/* A job of the worker: which scene to make. */
typedef struct job {
    bool fit; /* the whole map; otherwise the view from the stand */
    stand at;
    bool dark;
    unsigned edition; /* version of the style's file */
} job;

/* A scene and everything that it is made from. One thread at a time uses it. */
typedef struct side {
    camber_context *context;
    camber_style *style;
    camber_features *features;
    camber_scene *scene;
    camber_mesh *mesh; /* used by the main thread, on its device, only for networks of this context */
    job made_for;
    bool muted;
} side;

typedef struct viewer {
    options options;
    side sides[2], *front, *back;

    SDL_Thread *thread;
    SDL_sem *begin;
    SDL_atomic_t state, leave;
    job order;        /* written only while the worker is idle */
    char *style_text; /* used by the worker: the last valid contents of the style's file; NULL: none */
    size_t style_bytes;
    bool order_failed;
    bool is_paired; /* both sides have scenes; the main thread may not read this while the worker is busy */
    int scenes;     /* made so far */

    SDL_Window *window;
    uint32_t width, height; /* device px */
    SDL_Renderer *sdl;      /* frames drawn by kernels go into a texture of SDL */
    SDL_Texture *streamed;
    uint8_t *pixels; /* while the texture is locked */
    int stride;
    uint32_t drawn_width;
    EGLContext gl; /* frames drawn by GL: SDL's context, and the surface of its window */
    EGLDisplay display;
    EGLSurface screen;
    GLuint textures[2], framebuffer; /* for the map, and for the graph */

    camber_context *context; /* the main thread's context */
    camber_surface *surface;
    camber_device *device;
    camber_renderer *renderer;
    camber_mesh *graph;

    stand at, drawn_at;
    bool dark, redraw, hidden, quit, is_graph_shown, is_titled, is_warm;
    double simplify_px, coarsest_px; /* of the last picture; the most of all pictures */
    unsigned edition;                /* version of the style's file */
    struct stat style_file;
    uint32_t style_looked_ms;
    double recent[GRAPH_WIDTH]; /* ring buffer of the last frames' times, ms */
    double *times;              /* options.frames of them */
    int frame_count;
} viewer;

static void tell(void *user, camber_log_level level, const char *message) {
    const side *s = user;
    if (level < CAMBER_LOG_INFO && !(s && s->muted))
        fprintf(stderr, "viewer: %s\n", message);
}

/* ---- The camera's position ---- */

static bool is_same(const stand *a, const stand *b) {
    return a->x == b->x && a->y == b->y && a->zoom == b->zoom && a->bearing_deg == b->bearing_deg &&
           a->pitch_deg == b->pitch_deg && a->ratio == b->ratio && a->width == b->width && a->height == b->height;
}

static double longitude_of(const stand *at) {
    return 360 * (at->x - 0.5);
}

static double latitude_of(const stand *at) {
    return atan(sinh(PI * (1 - 2 * at->y))) * 180 / PI;
}

static camber_view_desc view_of(const job *made_for) {
    const stand *at = &made_for->at;
    return (camber_view_desc){.kind = made_for->fit ? CAMBER_VIEW_FIT : CAMBER_VIEW_CENTER,
                              .longitude = longitude_of(at),
                              .latitude = latitude_of(at),
                              .zoom = at->zoom,
                              .bearing_deg = at->bearing_deg,
                              .pitch_deg = at->pitch_deg,
                              .width = at->width,
                              .height = at->height,
                              .ratio = at->ratio};
}

/* Finds the position on the map below a position in the window. The camera of camber.h looks from a distance of 1.5
 * heights. */
static void look_under(const stand *at, double window_x, double window_y, double *x, double *y) {
    const double seen_x = window_x - 0.5 * at->width, seen_y = window_y - 0.5 * at->height, away = 1.5 * at->height;
    const double pitch = at->pitch_deg * PI / 180, bearing = at->bearing_deg * PI / 180;
    const double fall = fmax(away * cos(pitch) + seen_y * sin(pitch), 0.1 * away); /* not beyond the horizon */
    const double down = seen_y * away / fall, right = seen_x * (away - down * sin(pitch)) / away;
    const double css_px = 512 * exp2(at->zoom);
    *x = at->x + (right * cos(bearing) - down * sin(bearing)) / css_px;
    *y = at->y + (right * sin(bearing) + down * cos(bearing)) / css_px;
}

static void keep_in_world(stand *at) {
    at->x -= floor(at->x);
    at->y = fmin(fmax(at->y, 0), 1);
    at->zoom = fmin(fmax(at->zoom, 0), 22);
    at->bearing_deg = remainder(at->bearing_deg, 360);
    at->pitch_deg = fmin(fmax(at->pitch_deg, 0), 70);
}

/* Zooms while the position below the pointer stays where it is. */
static void zoom_at(stand *at, double levels, double window_x, double window_y) {
    double before[2], after[2];
    look_under(at, window_x, window_y, before, before + 1);
    at->zoom = fmin(fmax(at->zoom + levels, 0), 22);
    look_under(at, window_x, window_y, after, after + 1);
    at->x += before[0] - after[0];
    at->y += before[1] - after[1];
}

static void drag(stand *at, const SDL_MouseMotionEvent *motion) {
    if (motion->state & SDL_BUTTON_LMASK) {
        double before[2], after[2];
        look_under(at, motion->x - motion->xrel, motion->y - motion->yrel, before, before + 1);
        look_under(at, motion->x, motion->y, after, after + 1);
        at->x += before[0] - after[0];
        at->y += before[1] - after[1];
    } else if (motion->state & SDL_BUTTON_RMASK) {
        at->bearing_deg += 0.4 * motion->xrel;
        at->pitch_deg -= 0.3 * motion->yrel;
    }
}

/* Returns a position on the benchmark's flight: around the map, down to the streets and up again. It turns, and tilts
 * near the ground. */
static stand fly(const stand *start, double share) {
    const double turn = 2 * PI * share, css_px = 512 * exp2(start->zoom);
    stand at = *start;
    at.x += 0.15 * start->width * sin(turn) / css_px;
    at.y += 0.1 * start->height * sin(2 * turn) / css_px;
    at.zoom += 2 - 2 * cos(turn);
    at.bearing_deg = 360 * share;
    at.pitch_deg = 40 * fmax(-cos(turn), 0);
    keep_in_world(&at);
    return at;
}

/* ---- The worker: files, styles, scenes ---- */

static char *read_text(const char *path, size_t *size_bytes) {
    FILE *file = fopen(path, "rb");
    struct stat status;
    char *text = file && fstat(fileno(file), &status) == 0 ? malloc((size_t)status.st_size + 1) : NULL;
    if (text)
        *size_bytes = fread(text, 1, (size_t)status.st_size, file);
    if (file)
        fclose(file);
    return text;
}

static bool parse(side *s, const char *text, size_t size_bytes, const char *name, camber_style **style) {
    return text && camber_style_parse(s->context, text, size_bytes, name, style) == CAMBER_OK;
}

/* Parses the style. If the file is not a valid style, perhaps because it is being edited, the last valid one is
 * used. */
static bool parse_style(viewer *v, side *s, bool dark, camber_style **style) {
    const char *name = v->options.style;
    size_t size_bytes = 0;
    const char *shipped = camber_style_get_text(name, dark ? CAMBER_THEME_DARK : CAMBER_THEME_LIGHT, &size_bytes);
    if (shipped)
        return parse(s, shipped, size_bytes, name, style);
    char *own = read_text(name, &size_bytes);
    if (!own)
        fprintf(stderr, "viewer: %s: no such style\n", name);
    if (parse(s, own, size_bytes, name, style)) {
        free(v->style_text);
        v->style_text = own;
        v->style_bytes = size_bytes;
        return true;
    }
    free(own);
    return parse(s, v->style_text, v->style_bytes, name, style);
}

static bool read_files(const viewer *v, side *s, const camber_style *style, camber_features **features) {
    camber_features *made = NULL;
    bool done = camber_features_create(s->context, style, &made) == CAMBER_OK;
    for (int i = 0; i < v->options.path_count && done; i++) {
        const camber_source_desc source = {.path = v->options.paths[i]};
        done = camber_features_read(made, &source) == CAMBER_OK;
    }
    if (done && !camber_style_get_text(v->options.style, CAMBER_THEME_LIGHT, &(size_t){0}))
        done = camber_features_read_sprites(made, 1, v->options.style) == CAMBER_OK;
    if (done)
        *features = made;
    else
        camber_features_destroy(made);
    return done;
}

/* Sets another style, and reads the files again if it needs other properties. */
static bool restyle(viewer *v, side *s, bool dark) {
    camber_style *style = NULL;
    camber_features *features = s->features;
    if (!parse_style(v, s, dark, &style))
        return false;
    s->muted = true;
    const bool kept = features && camber_features_restyle(features, style) == CAMBER_OK;
    s->muted = false;
    if (!kept && !read_files(v, s, style, &features)) {
        camber_style_destroy(style);
        return false;
    }
    camber_scene_destroy(s->scene);
    s->scene = NULL;
    if (!kept)
        camber_features_destroy(s->features);
    camber_style_destroy(s->style);
    s->features = features;
    s->style = style;
    return true;
}

static bool make_scene(viewer *v, side *s, const job *order) {
    const camber_scene_desc desc = {.view = view_of(order), .simplify_px = SIMPLIFY_PX};
    const bool is_other = order->dark != s->made_for.dark || order->edition != s->made_for.edition;
    if ((!s->style || is_other) && !restyle(v, s, order->dark))
        return false;
    s->made_for = *order;
    const camber_status status =
        s->scene ? camber_scene_move(s->scene, &desc.view) : camber_scene_create(s->features, &desc, &s->scene);
    return status == CAMBER_OK;
}

static int work(void *user) {
    viewer *v = user;
    SDL_SetThreadPriority(SDL_THREAD_PRIORITY_LOW); /* frames are more important */
    while (SDL_SemWait(v->begin) == 0 && !SDL_AtomicGet(&v->leave)) {
        v->order_failed = !make_scene(v, v->back, &v->order);
        SDL_AtomicSet(&v->state, STATE_DONE);
        SDL_PushEvent(&(SDL_Event){.type = SDL_USEREVENT}); /* the main thread may be waiting for events */
    }
    return 0;
}

/* The first scene fits the map, and the camera starts there. */
static void stand_at_fit(viewer *v) {
    const camber_scene_info info = camber_scene_get_info(v->front->scene);
    camber_camera camera;
    camber_tessellation_desc desc;
    camber_scene_get_network(v->front->scene, &camera, &desc);
    v->at.x = camera.x;
    v->at.y = camera.y;
    v->at.zoom = info.zoom;
    v->front->made_for.at = v->at;
    v->front->made_for.fit = false;
}

/* Takes the worker's result, and gives it the next job. While the camera pans, turns or tilts, the front scene is
 * sufficient; another zoom needs other lines and widths. If the camera is at rest, a scene is made for its exact
 * view. */
static void exchange(viewer *v, bool at_rest) {
    if (SDL_AtomicGet(&v->state) == STATE_DONE) {
        if (!v->order_failed) {
            side *made = v->back;
            v->back = v->front;
            v->front = made;
            v->scenes++;
            if (made->made_for.fit && !v->back->scene)
                stand_at_fit(v);
        } else if (!v->front->scene) {
            v->quit = true;
        }
        v->redraw = true;
        v->is_paired = v->front->scene && v->back->scene;
        SDL_AtomicSet(&v->state, STATE_IDLE);
    }
    if (SDL_AtomicGet(&v->state) != STATE_IDLE || v->quit)
        return;
    const bool fit = !v->front->scene;
    const job wanted = {fit, v->at, v->dark, v->edition};
    const job *last = v->order_failed ? &v->order : &v->front->made_for;
    if (fit || wanted.dark != last->dark || wanted.edition != last->edition ||
        fabs(wanted.at.zoom - last->at.zoom) >= ZOOM_STEP || (at_rest && !is_same(&wanted.at, &last->at)) ||
        (!v->back->scene && !v->order_failed)) {
        v->order = wanted;
        SDL_AtomicSet(&v->state, STATE_BUSY);
        SDL_SemPost(v->begin);
    }
}

/* ---- Drawing ---- */

/* Copies rows of the picture, or of the graph in its corner. */
static bool take_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    viewer *v = user;
    const size_t wide = v->drawn_width < v->width ? v->drawn_width : v->width;
    for (uint32_t row = 0; row < row_count && first_row + row < v->height; row++)
        memcpy(v->pixels + (size_t)v->stride * (first_row + row), rgba + 4 * (size_t)v->drawn_width * row, 4 * wide);
    return true;
}

/* camber draws in its own GL context, which shares textures with SDL's, and leaves it current. SDL's context then waits
 * on the GPU and shows the texture. SDL_GL_MakeCurrent would assume that SDL's context is still current, and do
 * nothing. */
static camber_status draw_by_gl(viewer *v, const camber_frame *frame, GLuint name) {
    const GLint width = (GLint)frame->width, height = (GLint)frame->height, top = (GLint)v->height;
    void *drawn = NULL;
    const camber_status status =
        camber_renderer_render_texture(v->renderer, frame, &(camber_texture){.name = name, .bottom_up = true}, &drawn);
    eglMakeCurrent(v->display, v->screen, v->screen, v->gl);
    if (drawn) {
        glWaitSync(drawn, 0, GL_TIMEOUT_IGNORED);
        glDeleteSync(drawn);
    }
    glBindFramebuffer(GL_READ_FRAMEBUFFER, v->framebuffer);
    glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, name, 0);
    glBlitFramebuffer(0, 0, width, height, 0, top - height, width, top, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    return status;
}

static camber_status draw_picture(viewer *v, const camber_frame *frame, int texture) {
    v->drawn_width = frame->width;
    return v->gl ? draw_by_gl(v, frame, v->textures[texture])
                 : camber_renderer_render(v->renderer, frame, take_rows, v, NULL);
}

static void size_gl_texture(GLuint *name, uint32_t width, uint32_t height) {
    glDeleteTextures(1, name);
    glGenTextures(1, name);
    glBindTexture(GL_TEXTURE_2D, *name);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, (GLsizei)width, (GLsizei)height);
    glFlush(); /* before another context draws into it */
}

/* Resizes the textures to the window. */
static bool fit_textures(viewer *v) {
    int width, height;
    SDL_GetWindowSizeInPixels(v->window, &width, &height);
    if (v->width == (uint32_t)width && v->height == (uint32_t)height)
        return true;
    v->width = (uint32_t)width;
    v->height = (uint32_t)height;
    if (v->gl) {
        size_gl_texture(&v->textures[0], v->width, v->height);
        size_gl_texture(&v->textures[1], GRAPH_WIDTH, GRAPH_HEIGHT);
        return true;
    }
    SDL_DestroyTexture(v->streamed);
    v->streamed = SDL_CreateTexture(v->sdl, SDL_PIXELFORMAT_RGBA32, SDL_TEXTUREACCESS_STREAMING, width, height);
    return v->streamed && SDL_SetTextureBlendMode(v->streamed, SDL_BLENDMODE_NONE) == 0;
}

/* Draws the front scene from the camera's position. If this is the position that the scene was made for, the scene's
 * own camera is exact. */
static camber_status draw_map(viewer *v) {
    side *s = v->front;
    const stand *at = &v->at;
    camber_camera camera;
    camber_tessellation_desc desc;
    camber_network *network = camber_scene_get_network(s->scene, &camera, &desc);
    if (!is_same(at, &s->made_for.at)) {
        camera.x = at->x;
        camera.y = at->y;
        camera.scale_px = 512 * at->ratio * exp2(at->zoom);
        camera.bearing_deg = at->bearing_deg;
        camera.pitch_deg = at->pitch_deg;
    }
    camera.width = v->width;
    camera.height = v->height;
    camera.simplify_px = v->simplify_px;
    camber_status status = camber_mesh_tessellate_network(s->mesh, network, &camera, &desc);
    if (status != CAMBER_OK)
        return status;
    camber_frame frame = camber_scene_get_frame(s->scene, s->mesh);
    frame.width = camera.width;
    frame.height = camera.height;
    frame.pitch_deg = camera.pitch_deg;
    return draw_picture(v, &frame, 0);
}

/* Uses camber to draw the times of the last frames as a line, over lines at 16.7 and 50 ms. The top is 60 ms. */
static camber_status draw_graph(viewer *v) {
    float points[2 * (GRAPH_WIDTH + 4)] = {0, GRAPH_HEIGHT * (1 - 16.7f / 60), GRAPH_WIDTH, points[1],
                                           0, GRAPH_HEIGHT * (1 - 50.0f / 60), GRAPH_WIDTH, points[5]};
    const size_t count = v->frame_count < GRAPH_WIDTH ? (size_t)v->frame_count : GRAPH_WIDTH;
    for (size_t i = 0; i < count; i++) {
        const double ms = v->recent[((size_t)v->frame_count - count + i) % GRAPH_WIDTH];
        points[8 + 2 * i] = (float)i + 0.5f;
        points[9 + 2 * i] = (float)(GRAPH_HEIGHT * (1 - fmin(ms, 60) / 60));
    }
    const uint32_t offsets[] = {0, 2, 4, 4 + (uint32_t)count}, rows[] = {0, 0, 1};
    const camber_polylines_desc lines = {points, 4 + count, offsets, 3, rows, true};
    const camber_stroke strokes[] = {{.width_px = 1}, {.width_px = 1.5f}};
    const camber_paint paints[] = {{.width_px = 1, .color = {0.5f, 0.5f, 0.5f, 1}},
                                   {.width_px = 1.5f, .color = {1, 0.8f, 0.3f, 1}}};
    const camber_tessellation_desc desc = {.strokes = strokes, .stroke_count = 2};
    const camber_pass pass = {.mesh = v->graph, .paints = paints, .paint_count = 2};
    const camber_frame frame = {.width = GRAPH_WIDTH,
                                .height = GRAPH_HEIGHT,
                                .background = {0.1f, 0.1f, 0.13f, 1},
                                .passes = &pass,
                                .pass_count = 1};
    camber_polylines *polylines = NULL;
    camber_status status = camber_polylines_create(v->context, &lines, &polylines);
    if (status == CAMBER_OK)
        status = camber_mesh_tessellate(v->graph, polylines, &desc);
    if (status == CAMBER_OK)
        status = draw_picture(v, &frame, 1);
    camber_polylines_destroy(polylines);
    return status;
}

/* Moving pictures have as many points as can be drawn in time. A picture at rest has all of them. */
static void choose_simplification(viewer *v, bool at_rest) {
    const double last_ms = v->frame_count ? v->recent[(v->frame_count - 1) % GRAPH_WIDTH] : 0;
    if (at_rest)
        v->simplify_px = SIMPLIFY_PX;
    else if (last_ms > LONG_MS)
        v->simplify_px = fmin(1.5 * v->simplify_px, COARSEST_PX);
    else if (last_ms < SHORT_MS)
        v->simplify_px = fmax(v->simplify_px / 1.1, SIMPLIFY_PX);
}

static void show(viewer *v) {
    if (v->gl) {
        SDL_GL_SwapWindow(v->window);
        return;
    }
    SDL_RenderCopy(v->sdl, v->streamed, NULL, NULL);
    SDL_RenderPresent(v->sdl);
}

static double now_ms(void) {
    return 1000.0 * (double)SDL_GetPerformanceCounter() / (double)SDL_GetPerformanceFrequency();
}

static bool draw(viewer *v, bool at_rest) {
    const double begin_ms = now_ms();
    void *pixels = NULL;
    choose_simplification(v, at_rest);
    if (!fit_textures(v) || (v->streamed && SDL_LockTexture(v->streamed, NULL, &pixels, &v->stride) != 0)) {
        fprintf(stderr, "viewer: %s\n", SDL_GetError());
        return false;
    }
    v->pixels = pixels;
    camber_status status = draw_map(v);
    if (status == CAMBER_OK && v->is_graph_shown)
        status = draw_graph(v);
    if (v->streamed)
        SDL_UnlockTexture(v->streamed);
    const double drawn_ms = now_ms();
    if (status == CAMBER_OK)
        show(v);
    else if (v->surface && camber_surface_is_lost(v->surface))
        fprintf(stderr, "viewer: the GL context is lost\n");
    /* interactive frames wait for the screen here; the benchmark's frames do not */
    const double ms = (v->options.benchmark ? now_ms() : drawn_ms) - begin_ms;
    v->recent[v->frame_count % GRAPH_WIDTH] = ms;
    if (v->frame_count < v->options.frames)
        v->times[v->frame_count] = ms;
    v->coarsest_px = fmax(v->coarsest_px, v->simplify_px);
    v->frame_count++;
    v->drawn_at = v->at;
    v->redraw = v->is_titled = false;
    return status == CAMBER_OK;
}

/* ---- Events ---- */

static void press(viewer *v, SDL_Keycode key) {
    const double step = 0.1 / exp2(v->at.zoom), middle_x = 0.5 * v->at.width, middle_y = 0.5 * v->at.height;
    const double cosine = cos(v->at.bearing_deg * PI / 180), sine = sin(v->at.bearing_deg * PI / 180);
    const int right = (key == SDLK_RIGHT) - (key == SDLK_LEFT), down = (key == SDLK_DOWN) - (key == SDLK_UP);
    v->at.x += step * (right * cosine - down * sine);
    v->at.y += step * (right * sine + down * cosine);
    switch (key) {
    case SDLK_PLUS:
    case SDLK_EQUALS: zoom_at(&v->at, 0.25, middle_x, middle_y); break;
    case SDLK_MINUS: zoom_at(&v->at, -0.25, middle_x, middle_y); break;
    case SDLK_q: v->at.bearing_deg -= 5; break;
    case SDLK_e: v->at.bearing_deg += 5; break;
    case SDLK_w: v->at.pitch_deg += 5; break;
    case SDLK_s: v->at.pitch_deg -= 5; break;
    case SDLK_n: v->at.bearing_deg = v->at.pitch_deg = 0; break;
    case SDLK_t: v->dark = !v->dark; break;
    case SDLK_g: v->is_graph_shown = !v->is_graph_shown, v->redraw = true; break;
    case SDLK_ESCAPE: v->quit = true; break;
    default: break;
    }
}

static void resize(viewer *v) {
    int width, height, width_px, height_px;
    SDL_GetWindowSize(v->window, &width, &height);
    SDL_GetWindowSizeInPixels(v->window, &width_px, &height_px);
    v->at.width = (uint32_t)width;
    v->at.height = (uint32_t)height;
    v->at.ratio = (double)width_px / width;
    v->redraw = true;
}

static void take_window_event(viewer *v, Uint8 event) {
    switch (event) {
    case SDL_WINDOWEVENT_SIZE_CHANGED: resize(v); break;
    case SDL_WINDOWEVENT_MINIMIZED:
    case SDL_WINDOWEVENT_HIDDEN: v->hidden = true; break;
    case SDL_WINDOWEVENT_SHOWN:
    case SDL_WINDOWEVENT_RESTORED: v->hidden = false; /* fallthrough */
    case SDL_WINDOWEVENT_EXPOSED: v->redraw = true; break;
    default: break;
    }
}

static void take_events(viewer *v) {
    for (SDL_Event event; SDL_PollEvent(&event);) {
        int x, y;
        switch (event.type) {
        case SDL_QUIT: v->quit = true; break;
        case SDL_WINDOWEVENT: take_window_event(v, event.window.event); break;
        case SDL_KEYDOWN: press(v, event.key.keysym.sym); break;
        case SDL_MOUSEMOTION: drag(&v->at, &event.motion); break;
        case SDL_MOUSEWHEEL:
            SDL_GetMouseState(&x, &y);
            zoom_at(&v->at, 0.25 * (double)event.wheel.preciseY, x, y);
            break;
        default: break;
        }
        keep_in_world(&v->at);
    }
}

/* Checks four times a second whether the style's file has changed. */
static void look_at_style(viewer *v) {
    struct stat now;
    if (SDL_GetTicks() - v->style_looked_ms < 250 || stat(v->options.style, &now) != 0)
        return;
    v->style_looked_ms = SDL_GetTicks();
    const struct stat before = v->style_file;
    v->edition += before.st_mtim.tv_sec != now.st_mtim.tv_sec || before.st_mtim.tv_nsec != now.st_mtim.tv_nsec ||
                  before.st_size != now.st_size;
    v->style_file = now;
}

static void write_title(const viewer *v) {
    const char *credit = camber_features_get_attribution(v->front->features);
    char title[512];
    snprintf(title, sizeof title, "camber %.8f,%.8f zoom %.6f bearing %.2f pitch %.2f %s", longitude_of(&v->at),
             latitude_of(&v->at), v->at.zoom, v->at.bearing_deg, v->at.pitch_deg, credit ? credit : "");
    SDL_SetWindowTitle(v->window, title);
}

/* ---- The run ---- */

/* One iteration of the main loop: handles events, takes the worker's result, and draws a picture if it has changed. */
static bool turn(viewer *v, const stand *start) {
    const bool is_ready = v->front->scene && (v->is_paired || !v->options.benchmark);
    take_events(v);
    look_at_style(v);
    if (v->options.benchmark && is_ready)
        v->at = fly(start, (double)v->frame_count / (v->is_warm ? v->options.frames : WARM_UPS));
    const bool at_rest = is_same(&v->at, &v->drawn_at);
    exchange(v, at_rest);
    const bool is_drawn = is_ready && !v->hidden && !v->quit &&
                          (v->options.frames || !at_rest || v->redraw || v->simplify_px > SIMPLIFY_PX);
    if (is_drawn)
        return draw(v, at_rest);
    if (at_rest && is_ready && !v->is_titled)
        write_title(v);
    v->is_titled = at_rest && is_ready;
    SDL_WaitEventTimeout(NULL, 50);
    return true;
}

static int compare(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void report(const viewer *v, double seconds) {
    const int count = v->frame_count;
    qsort(v->times, (size_t)count, sizeof *v->times, compare);
    printf("%d frames of %u x %u px by %s: %.1f a second; p50 %.1f ms, p95 %.1f ms, worst %.1f ms; %d scenes; "
           "simplified to %.2g px at most\n",
           count, v->width, v->height, v->gl ? "gl" : "cl", count / seconds, v->times[count / 2],
           v->times[count * 95 / 100], v->times[count - 1], v->scenes, v->coarsest_px);
}

/* Whether the requested number of frames has been drawn. A benchmark first draws some frames to warm up. */
static bool is_over(const viewer *v) {
    const int before = v->options.benchmark && !v->is_warm ? WARM_UPS : 0;
    return v->options.frames && v->frame_count >= before + v->options.frames;
}

static bool run(viewer *v) {
    stand start = v->at;
    double begin_ms = now_ms();
    bool done = true;
    while (done && !v->quit && !is_over(v)) {
        if (v->frame_count == 0 && !v->is_warm)
            start = v->at;
        if (v->options.benchmark && !v->is_warm && v->frame_count == WARM_UPS) { /* the kernels are loaded */
            v->is_warm = true;
            v->frame_count = v->scenes = 0;
            v->coarsest_px = 0;
            begin_ms = now_ms();
        }
        done = turn(v, &start);
    }
    if (v->is_warm && v->frame_count)
        report(v, (now_ms() - begin_ms) / 1000);
    return done && v->frame_count;
}

/* ---- Beginning and end ---- */

static bool open_window(viewer *v) {
    const bool by_gl = v->options.rasterizer == CAMBER_RASTERIZER_GL, is_soft = !camber_surface_may_be_hardware(NULL);
    const int middle = SDL_WINDOWPOS_CENTERED, vsync = !v->options.benchmark;
    SDL_SetHint(SDL_HINT_VIDEO_X11_FORCE_EGL, "1");
    SDL_SetHint(SDL_HINT_OPENGL_ES_DRIVER, "1");
    if (is_soft)
        SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_PROFILE_MASK, SDL_GL_CONTEXT_PROFILE_ES);
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_MAJOR_VERSION, 3);
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_MINOR_VERSION, 0);
    v->window = SDL_CreateWindow("camber", middle, middle, v->options.width, v->options.height,
                                 SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI | (by_gl ? SDL_WINDOW_OPENGL : 0));
    if (v->window && by_gl && SDL_GL_CreateContext(v->window)) {
        SDL_GL_SetSwapInterval(vsync);
        v->gl = eglGetCurrentContext();
        v->display = eglGetCurrentDisplay();
        v->screen = eglGetCurrentSurface(EGL_DRAW);
        glGenFramebuffers(1, &v->framebuffer);
    } else if (v->window && !by_gl) {
        v->sdl = SDL_CreateRenderer(v->window, -1,
                                    (is_soft ? SDL_RENDERER_SOFTWARE : SDL_RENDERER_ACCELERATED) |
                                        (vsync ? SDL_RENDERER_PRESENTVSYNC : 0));
    }
    if (v->gl || v->sdl)
        resize(v);
    else
        fprintf(stderr, "viewer: no window: %s\n", SDL_GetError());
    return v->gl || v->sdl;
}

static bool open_drawing(viewer *v) {
    const camber_context_desc log = {.log = tell};
    const camber_surface_desc shared = {.egl_context = v->gl, .egl_display = v->display};
    const camber_renderer_desc how = {.rasterizer = v->options.rasterizer};
    bool done = camber_context_create(&log, &v->context) == CAMBER_OK &&
                (!v->gl || camber_surface_create(v->context, &shared, &v->surface) == CAMBER_OK);
    const camber_device_desc near = {.gl = camber_surface_get_handles(v->surface)};
    done = done && camber_device_create(v->context, &near, &v->device) == CAMBER_OK &&
           camber_renderer_create(v->device, v->surface, &how, &v->renderer) == CAMBER_OK &&
           camber_mesh_create(v->device, v->renderer, &v->graph) == CAMBER_OK;
    for (int i = 0; i < 2 && done; i++) {
        const camber_context_desc own = {.log = tell, .log_user = &v->sides[i]};
        done = camber_context_create(&own, &v->sides[i].context) == CAMBER_OK &&
               camber_mesh_create(v->device, v->renderer, &v->sides[i].mesh) == CAMBER_OK;
    }
    if (v->gl)
        eglMakeCurrent(v->display, v->screen, v->screen, v->gl);
    return done;
}

static bool start_worker(viewer *v) {
    v->begin = SDL_CreateSemaphore(0);
    v->thread = v->begin ? SDL_CreateThread(work, "scenes", v) : NULL;
    return v->thread;
}

/* Destroys objects in reverse order. A busy worker first finishes its job. */
static void close_viewer(viewer *v) {
    SDL_AtomicSet(&v->leave, 1);
    if (v->thread) {
        SDL_SemPost(v->begin);
        SDL_WaitThread(v->thread, NULL);
    }
    SDL_DestroySemaphore(v->begin);
    for (int i = 0; i < 2; i++) {
        camber_mesh_destroy(v->sides[i].mesh);
        camber_scene_destroy(v->sides[i].scene);
        camber_features_destroy(v->sides[i].features);
        camber_style_destroy(v->sides[i].style);
        camber_context_destroy(v->sides[i].context);
    }
    camber_mesh_destroy(v->graph);
    camber_renderer_destroy(v->renderer);
    camber_device_destroy(v->device);
    camber_surface_destroy(v->surface);
    camber_context_destroy(v->context);
    if (v->sdl)
        SDL_DestroyRenderer(v->sdl); /* and the texture */
    if (v->window)
        SDL_DestroyWindow(v->window);
    SDL_Quit();
    free(v->style_text);
    free(v->times);
    free(v->options.paths);
}

/* ---- The command line ---- */

static bool take_option(options *o, const char *name, const char *value) {
    if (strcmp(name, "--style") == 0)
        o->style = value;
    else if (strcmp(name, "--theme") == 0)
        o->dark = strcmp(value, "dark") == 0;
    else if (strcmp(name, "--size") == 0)
        return sscanf(value, "%dx%d", &o->width, &o->height) == 2 && o->width > 0 && o->height > 0;
    else if (strcmp(name, "--frames") == 0)
        return (o->frames = atoi(value)) > 0;
    else if (strcmp(name, "--draw") == 0)
        o->rasterizer = strcmp(value, "gl") == 0 ? CAMBER_RASTERIZER_GL : CAMBER_RASTERIZER_OPENCL;
    else
        return false;
    return true;
}

static bool parse_options(int argc, char **argv, options *o) {
    *o = (options){.style = "city", .width = 1280, .height = 720};
    o->rasterizer = camber_surface_may_be_hardware(NULL) ? CAMBER_RASTERIZER_GL : CAMBER_RASTERIZER_OPENCL;
    o->paths = calloc((size_t)argc, sizeof *o->paths);
    for (int i = 1; i < argc && o->paths; i++) {
        if (strcmp(argv[i], "--benchmark") == 0)
            o->benchmark = true;
        else if (strncmp(argv[i], "--", 2) != 0)
            o->paths[o->path_count++] = argv[i];
        else if (i + 1 == argc || !take_option(o, argv[i], argv[i + 1]))
            return false;
        else
            i++;
    }
    if (o->benchmark && !o->frames)
        o->frames = BENCHMARK_FRAMES;
    return o->paths && o->path_count;
}

static bool open_viewer(viewer *v) {
    v->front = &v->sides[0];
    v->back = &v->sides[1];
    v->dark = v->options.dark;
    v->times = calloc((size_t)v->options.frames + 1, sizeof *v->times);
    stat(v->options.style, &v->style_file); /* fails for a built-in style, which is not a file */
    if (!v->times || SDL_Init(SDL_INIT_VIDEO) != 0) {
        fprintf(stderr, "viewer: %s\n", v->times ? SDL_GetError() : "out of memory");
        return false;
    }
    return open_window(v) && open_drawing(v) && start_worker(v);
}

int main(int argc, char **argv) {
    viewer v = {0};
    /* PoCL needs it before the first thread starts (docs/drivers.md) */
    setenv("HWLOC_PLUGINS_PATH", "/dev/null", 0);
    if (!parse_options(argc, argv, &v.options)) {
        fprintf(stderr, "viewer FILE... [--style NAME|FILE] [--theme light|dark] [--size WxH] [--draw cl|gl] "
                        "[--frames N] [--benchmark]\n");
        free(v.options.paths);
        return 2;
    }
    const bool done = open_viewer(&v) && run(&v);
    close_viewer(&v);
    return done ? 0 : 1;
}
