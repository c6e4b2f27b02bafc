/* The example with a window, by SDL's drivers that have none: events go in, and what the window shows is compared with
 * pictures that are drawn here of the same view. The viewer's own functions run its main loop, turn by turn. */
#define main viewer_main
int viewer_main(int argc, char **argv);
#include "examples/viewer.c" /* NOLINT(bugprone-suspicious-include): a program has no header */
#undef main

#include <setjmp.h> /* cmocka wants these first */
#include <stdarg.h>

#include <cmocka.h>
#include <unistd.h>

#define CITY CAMBER_TEST_DATA "/santa_cruz/osm.mbtiles"
enum { WIDTH = 400, HEIGHT = 260, PATIENCE_MS = 300000, SMALL_FRAMES = 800 };

#ifdef __SANITIZE_ADDRESS__
enum { IS_SANITIZED = true };
#else
enum { IS_SANITIZED = false };
#endif

/* ---- A viewer ---- */

typedef struct options_of {
    const char *style, *size;
    int by_gl;
} options_of;

static void viewer_open(viewer *v, const options_of *o) {
    char *arguments[] = {(char *)(uintptr_t) "viewer",  (char *)(uintptr_t)CITY,
                         (char *)(uintptr_t) "--draw",  (char *)(uintptr_t)(o->by_gl ? "gl" : "cl"),
                         (char *)(uintptr_t) "--size",  (char *)(uintptr_t)(o->size ? o->size : "400x260"),
                         (char *)(uintptr_t) "--style", (char *)(uintptr_t)(o->style ? o->style : "city")};
    *v = (viewer){0};
    assert_true(parse_options(8, arguments, &v->options));
    assert_true(open_viewer(v));
}

static bool is_resting(viewer *v) {
    const bool is_idle = SDL_AtomicGet(&v->state) == STATE_IDLE && v->front->scene && v->back->scene;
    const job *made_for = &v->front->made_for;
    return is_idle && v->frame_count > 0 && is_same(&v->at, &v->drawn_at) && !v->redraw &&
           (v->order_failed ||
            (is_same(&v->at, &made_for->at) && made_for->dark == v->dark && made_for->edition == v->edition)) &&
           v->simplify_px <= SIMPLIFY_PX && v->is_titled;
}

/* Runs the viewer until it has taken all events, and its picture is the one that stays. */
static void rest(viewer *v) {
    const stand nowhere = {0};
    const Uint32 begin_ms = SDL_GetTicks();
    SDL_PumpEvents();
    do {
        assert_true(turn(v, &nowhere));
        assert_true(SDL_GetTicks() - begin_ms < PATIENCE_MS);
    } while (!is_resting(v) || SDL_HasEvents(SDL_QUIT, SDL_MOUSEWHEEL));
}

static void push(const SDL_Event *event) {
    SDL_Event copy = *event;
    assert_int_equal(SDL_PushEvent(&copy), 1);
}

static void push_key(SDL_Keycode key) {
    push(&(SDL_Event){.key = {.type = SDL_KEYDOWN, .keysym = {.sym = key}}});
}

static void push_motion(Uint32 buttons, int x, int y, int right, int down) {
    push(&(SDL_Event){
        .motion = {.type = SDL_MOUSEMOTION, .state = buttons, .x = x, .y = y, .xrel = right, .yrel = down}});
}

static void push_window(Uint8 event) {
    push(&(SDL_Event){.window = {.type = SDL_WINDOWEVENT, .event = event}});
}

/* ---- Pictures ---- */

typedef struct shot {
    uint8_t *rgba;
    uint32_t width, height;
} shot;

static shot shot_new(uint32_t width, uint32_t height) {
    shot s = {calloc((size_t)width * height, 4), width, height};
    assert_non_null(s.rgba);
    return s;
}

/* Takes what the window shows. */
static shot shot_take(const viewer *v) {
    shot s = shot_new(v->width, v->height);
    if (!v->gl) {
        assert_int_equal(SDL_RenderReadPixels(v->sdl, NULL, SDL_PIXELFORMAT_RGBA32, s.rgba, 4 * (int)s.width), 0);
        return s;
    }
    shot turned = shot_new(v->width, v->height); /* the texture's rows, from the bottom up */
    glBindFramebuffer(GL_READ_FRAMEBUFFER, v->framebuffer);
    glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, v->textures[0], 0);
    glReadPixels(0, 0, (GLsizei)s.width, (GLsizei)s.height, GL_RGBA, GL_UNSIGNED_BYTE, turned.rgba);
    for (uint32_t row = 0; row < s.height; row++)
        memcpy(s.rgba + 4 * (size_t)s.width * row, turned.rgba + 4 * (size_t)s.width * (s.height - 1 - row),
               4 * (size_t)s.width);
    free(turned.rgba);
    return s;
}

static bool take_shot_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    const shot *s = user;
    memcpy(s->rgba + 4 * (size_t)s->width * first_row, rgba, 4 * (size_t)s->width * row_count);
    return true;
}

/* The same view, drawn from the files by a scene, a device and a renderer of its own. */
static shot shot_of_view(viewer *v, const camber_view_desc *view) {
    side own = {0};
    const camber_scene_desc desc = {.view = *view, .simplify_px = SIMPLIFY_PX};
    camber_device *device = NULL;
    camber_renderer *renderer = NULL;
    const camber_renderer_desc how = {.rasterizer = v->options.rasterizer};
    camber_surface *surface = NULL;
    assert_int_equal(camber_context_create(NULL, &own.context), CAMBER_OK);
    if (v->gl)
        assert_int_equal(camber_surface_create(own.context, NULL, &surface), CAMBER_OK);
    assert_int_equal(camber_device_create(own.context, NULL, &device), CAMBER_OK);
    assert_int_equal(camber_renderer_create(device, surface, &how, &renderer), CAMBER_OK);
    assert_int_equal(camber_mesh_create(device, renderer, &own.mesh), CAMBER_OK);
    assert_true(restyle(v, &own, v->dark));
    assert_int_equal(camber_scene_create(own.features, &desc, &own.scene), CAMBER_OK);
    assert_int_equal(camber_scene_tessellate(own.scene, own.mesh, CAMBER_METHOD_STRIP), CAMBER_OK);
    const camber_frame frame = camber_scene_get_frame(own.scene, own.mesh);
    shot s = shot_new(frame.width, frame.height);
    assert_int_equal(camber_renderer_render(renderer, &frame, take_shot_rows, &s, NULL), CAMBER_OK);
    camber_mesh_destroy(own.mesh);
    camber_renderer_destroy(renderer);
    camber_device_destroy(device);
    camber_surface_destroy(surface);
    camber_scene_destroy(own.scene);
    camber_features_destroy(own.features);
    camber_style_destroy(own.style);
    camber_context_destroy(own.context);
    if (v->gl)
        eglMakeCurrent(v->display, v->screen, v->screen, v->gl);
    return s;
}

typedef struct distance {
    int most;
    double mean;
} distance;

/* Compares a with what lies right, down px from the same place in b, where both have pixels. */
static distance distance_of(const shot *a, const shot *b, int right, int down) {
    distance d = {0, 0};
    size_t count = 0;
    assert_true(a->width == b->width && a->height == b->height);
    for (int y = 0; y < (int)a->height; y++)
        for (int x = 0; x < (int)a->width; x++) {
            const int bx = x + right, by = y + down;
            if (bx < 0 || by < 0 || bx >= (int)a->width || by >= (int)a->height)
                continue;
            for (int c = 0; c < 3; c++) {
                const int levels =
                    abs(a->rgba[4 * ((int)a->width * y + x) + c] - b->rgba[4 * ((int)a->width * by + bx) + c]);
                d.most = levels > d.most ? levels : d.most;
                d.mean += levels;
                count++;
            }
        }
    d.mean /= (double)count;
    return d;
}

/* The window shows what a scene of its own shows, to a level. Shaders of GL may round otherwise in places. */
static void assert_shows_view(viewer *v) {
    rest(v);
    const job made_for = {false, v->at, v->dark, v->edition};
    const camber_view_desc view = view_of(&made_for);
    shot seen = shot_take(v), wanted = shot_of_view(v, &view);
    const distance d = distance_of(&seen, &wanted, 0, 0);
    if (d.most > (v->gl ? 3 : 1))
        fail_msg("the window is off by %d levels, %.3f on average, at zoom %g", d.most, d.mean, v->at.zoom);
    free(seen.rgba);
    free(wanted.rgba);
}

static double change_since(const viewer *v, const shot *before) {
    shot now = shot_take(v);
    const double mean = distance_of(&now, before, 0, 0).mean;
    free(now.rgba);
    return mean;
}

/* ---- Tests ---- */

static void test_start_is_the_fitted_map(void **state) {
    (void)state;
    viewer v;
    viewer_open(&v, &(options_of){0});
    rest(&v);
    const camber_view_desc whole = {.width = WIDTH, .height = HEIGHT};
    shot seen = shot_take(&v), wanted = shot_of_view(&v, &whole);
    assert_true(distance_of(&seen, &wanted, 0, 0).most <= 1);
    free(seen.rgba);
    free(wanted.rgba);
    close_viewer(&v);
}

static void test_drag_moves_the_picture(void **state) {
    (void)state;
    viewer v;
    viewer_open(&v, &(options_of){0});
    rest(&v);
    shot before = shot_take(&v);
    for (int i = 0; i < 30; i++)
        push_motion(SDL_BUTTON_LMASK, 100 + i, 100 + 2 * i / 3, 1, i % 3 != 0);
    assert_shows_view(&v);
    shot after = shot_take(&v);
    assert_true(distance_of(&before, &after, 30, 20).mean < 1);
    assert_true(distance_of(&before, &after, 0, 0).mean > 4);
    free(before.rgba);
    free(after.rgba);
    close_viewer(&v);
}

static void test_place_below_the_pointer_stays(void **state) {
    (void)state;
    for (int i = 0; i < 60; i++) {
        stand at = {0.3, 0.4, 10 + 0.1 * i, 6 * i, i, 1, WIDTH, HEIGHT};
        double before[2], after[2];
        const double x = 7 * i % WIDTH, y = HEIGHT - 1 - 11 * i % (HEIGHT / 2), px = 1 / (512 * exp2(at.zoom));
        look_under(&at, x, y, before, before + 1);
        zoom_at(&at, 0.3, x, y);
        look_under(&at, x, y, after, after + 1);
        assert_true(hypot(before[0] - after[0], before[1] - after[1]) < 1e-6 * px);
    }
}

/* The place below the pointer of a tilted map is where camber draws it: a dot there is seen there. */
static void test_place_below_the_pointer_is_where_it_is_drawn(void **state) {
    (void)state;
    const stand at = {0.3, 0.4, 12, 30, 50, 1, WIDTH, HEIGHT};
    const double pointers[][2] = {{120, 180}, {330, 60}, {200, 130}, {60, 240}};
    for (size_t i = 0; i < sizeof pointers / sizeof *pointers; i++) {
        double world[6];
        look_under(&at, pointers[i][0], pointers[i][1], world, world + 1);
        for (int k = 2; k < 6; k++) /* a short line */
            world[k] = world[k % 2] + (k > 3 ? 1e-9 : 0);
        const size_t offsets[] = {0, 2};
        const camber_network_desc lines = {.points = world + 2, .offsets = offsets, .polyline_count = 1};
        const camber_camera camera = {at.x, at.y, 512 * exp2(at.zoom), at.bearing_deg, WIDTH, HEIGHT,
                                      0,    0,    at.pitch_deg};
        const camber_stroke stroke = {.width_px = 12, .cap = CAMBER_CAP_ROUND};
        const camber_paint paint = {.width_px = 12, .color = {1, 1, 1, 1}};
        const camber_tessellation_desc desc = {.strokes = &stroke, .stroke_count = 1};
        camber_pass pass = {.paints = &paint, .paint_count = 1};
        const camber_frame frame = {.width = WIDTH, .height = HEIGHT, .passes = &pass, .pass_count = 1};
        camber_context *context;
        camber_device *device;
        camber_renderer *renderer;
        camber_network *network;
        shot s = shot_new(WIDTH, HEIGHT);
        assert_int_equal(camber_context_create(NULL, &context), CAMBER_OK);
        assert_int_equal(camber_device_create(context, NULL, &device), CAMBER_OK);
        assert_int_equal(camber_renderer_create(device, NULL, NULL, &renderer), CAMBER_OK);
        assert_int_equal(camber_mesh_create(device, renderer, &pass.mesh), CAMBER_OK);
        assert_int_equal(camber_network_create(context, &lines, &network), CAMBER_OK);
        assert_int_equal(camber_mesh_tessellate_network(pass.mesh, network, &camera, &desc), CAMBER_OK);
        assert_int_equal(camber_renderer_render(renderer, &frame, take_shot_rows, &s, NULL), CAMBER_OK);
        double sum = 0, x = 0, y = 0;
        for (int k = 0; k < WIDTH * HEIGHT; k++) {
            sum += s.rgba[4 * k + 3];
            x += s.rgba[4 * k + 3] * (k % WIDTH + 0.5);
            y += s.rgba[4 * k + 3] * (k / WIDTH + 0.5);
        }
        assert_true(sum > 0 && fabs(x / sum - pointers[i][0]) < 0.7 && fabs(y / sum - pointers[i][1]) < 0.7);
        free(s.rgba);
        camber_network_destroy(network);
        camber_mesh_destroy(pass.mesh);
        camber_renderer_destroy(renderer);
        camber_device_destroy(device);
        camber_context_destroy(context);
    }
}

static void test_wheel_keys_and_turns(void **state) {
    viewer v;
    viewer_open(&v, &(options_of){.by_gl = *state != NULL});
    rest(&v);
    const stand start = v.at;
    for (int i = 0; i < 8; i++)
        push(&(SDL_Event){.wheel = {.type = SDL_MOUSEWHEEL, .y = 1, .preciseY = 1}});
    assert_shows_view(&v);
    assert_true(v.at.zoom == start.zoom + 2);
    for (int i = 0; i < 40; i++)
        push_motion(SDL_BUTTON_RMASK, 100, 100, 2, -3);
    assert_shows_view(&v);
    assert_true(fabs(v.at.bearing_deg - 32) < 1e-9 && fabs(v.at.pitch_deg - 36) < 1e-9);
    static const SDL_Keycode keys[] = {SDLK_RIGHT, SDLK_UP,   SDLK_PLUS,  SDLK_q, SDLK_w,
                                       SDLK_LEFT,  SDLK_DOWN, SDLK_MINUS, SDLK_e, SDLK_s};
    const stand before = v.at;
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        push_key(keys[i]);
    assert_shows_view(&v);
    assert_true(fabs(v.at.zoom - before.zoom) < 1e-9 && fabs(v.at.pitch_deg - before.pitch_deg) < 1e-9);
    push_key(SDLK_n);
    assert_shows_view(&v);
    assert_true(v.at.bearing_deg == 0 && v.at.pitch_deg == 0);
    push_key(SDLK_ESCAPE);
    for (int i = 0; i < 3; i++) /* SDL may hand events over in two turns */
        assert_true(turn(&v, &start));
    assert_true(v.quit);
    close_viewer(&v);
}

static void test_theme_and_graph(void **state) {
    viewer v;
    viewer_open(&v, &(options_of){.by_gl = *state != NULL});
    rest(&v);
    shot light = shot_take(&v);
    push_key(SDLK_t);
    assert_shows_view(&v);
    assert_true(change_since(&v, &light) > 40);
    push_key(SDLK_t);
    assert_shows_view(&v);
    assert_true(change_since(&v, &light) == 0);
    push_key(SDLK_g);
    rest(&v);
    if (!v.gl) { /* the graph covers its corner and nothing else */
        shot graph = shot_take(&v);
        for (uint32_t i = 0; i < WIDTH * HEIGHT; i++)
            if (i % WIDTH >= GRAPH_WIDTH || i / WIDTH >= GRAPH_HEIGHT)
                assert_memory_equal(graph.rgba + 4 * i, light.rgba + 4 * i, 3);
        assert_true(distance_of(&graph, &light, 0, 0).mean > 20);
        int bright = 0;
        for (uint32_t i = 0; i < WIDTH * GRAPH_HEIGHT; i++)
            bright += i % WIDTH < GRAPH_WIDTH && graph.rgba[4 * i] > 200 && graph.rgba[4 * i + 2] < 120;
        assert_true(bright > 0); /* its line */
        free(graph.rgba);
    }
    push_key(SDLK_g);
    rest(&v);
    assert_true(change_since(&v, &light) == 0);
    free(light.rgba);
    close_viewer(&v);
}

static void write_style(const char *path, const char *color) {
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file,
            "{\"version\": 8, \"sources\": {}, \"layers\": [{\"id\": \"b\", \"type\": \"background\", \"paint\": "
            "{\"background-color\": %s}}, {\"id\": \"l\", \"type\": \"line\", \"source\": \"s\", "
            "\"paint\": {\"line-width\": 2}}]}",
            color);
    assert_int_equal(fclose(file), 0);
}

static void test_style_is_read_again(void **state) {
    (void)state;
    char path[] = "/tmp/camber-viewer-XXXXXX";
    const int file = mkstemp(path);
    assert_true(file >= 0 && close(file) == 0);
    write_style(path, "\"#102030\"");
    viewer v;
    viewer_open(&v, &(options_of){.style = path});
    assert_shows_view(&v);
    shot before = shot_take(&v);
    assert_true(before.rgba[0] == 0x10 && before.rgba[1] == 0x20 && before.rgba[2] == 0x30);
    static const char *const colors[] = {"\"#a0b0c0\"", "\"no colour", "\"#112233\""};
    static const uint8_t reds[] = {0xa0, 0xa0, 0x11}; /* what does not parse changes nothing */
    for (size_t i = 0; i < 3; i++) {
        const unsigned edition = v.edition;
        write_style(path, colors[i]);
        while (v.edition == edition)
            assert_true(turn(&v, &v.at));
        rest(&v);
        shot after = shot_take(&v);
        assert_int_equal(after.rgba[0], reds[i]);
        free(after.rgba);
        push_key(SDLK_MINUS); /* the map goes on all the same */
        rest(&v);
        after = shot_take(&v);
        assert_int_equal(after.rgba[0], reds[i]);
        assert_true(v.front->made_for.at.zoom == v.at.zoom && !v.order_failed);
        free(after.rgba);
    }
    free(before.rgba);
    close_viewer(&v);
    unlink(path);
}

static void test_resized_and_hidden(void **state) {
    viewer v;
    viewer_open(&v, &(options_of){.by_gl = *state != NULL});
    rest(&v);
    SDL_SetWindowSize(v.window, 333, 211);
    assert_shows_view(&v);
    assert_true(v.width == 333 && v.height == 211);
    push_window(SDL_WINDOWEVENT_MINIMIZED);
    assert_true(turn(&v, &v.at));
    const int frames = v.frame_count;
    push_motion(SDL_BUTTON_LMASK, 100, 100, 9, 9);
    for (int i = 0; i < 5; i++)
        assert_true(turn(&v, &v.at));
    assert_int_equal(v.frame_count, frames);
    push_window(SDL_WINDOWEVENT_RESTORED);
    assert_shows_view(&v);
    assert_true(v.frame_count > frames);
    close_viewer(&v);
}

/* Hundreds of frames of whatever comes, and at last the picture is right all the same. */
static void test_any_events(void **state) {
    (void)state;
    viewer v;
    uint32_t random = 20;
    viewer_open(&v, &(options_of){0});
    rest(&v);
    static const SDL_Keycode keys[] = {SDLK_LEFT, SDLK_RIGHT, SDLK_UP, SDLK_DOWN, SDLK_PLUS, SDLK_MINUS, SDLK_q,
                                       SDLK_e,    SDLK_w,     SDLK_s,  SDLK_n,    SDLK_t,    SDLK_g};
    for (int i = 0; i < 300; i++) {
        random = random * 1664525 + 1013904223;
        const int x = (int)(random >> 8) % WIDTH, y = (int)(random >> 16) % HEIGHT, way = (int)(random >> 12) % 21 - 10;
        switch (random >> 30) {
        case 0: push_motion(SDL_BUTTON_LMASK, x, y, way, way / 2); break;
        case 1: push_motion(SDL_BUTTON_RMASK, x, y, way, -way); break;
        case 2:
            push(&(SDL_Event){.wheel = {.type = SDL_MOUSEWHEEL, .preciseY = way > 0 || v.at.zoom < 10 ? 0.5f : -0.5f}});
            break;
        default: push_key(keys[(size_t)(random >> 9) % (sizeof keys / sizeof *keys)]);
        }
        assert_true(turn(&v, &v.at));
    }
    assert_true(v.frame_count > 200);
    if (v.is_graph_shown)
        push_key(SDLK_g);
    assert_shows_view(&v);
    close_viewer(&v);
}

static long resident_kb(void) {
    char line[128];
    long kb = 0;
    FILE *file = fopen("/proc/self/status", "r");
    while (file && fgets(line, sizeof line, file))
        if (sscanf(line, "VmRSS: %ld", &kb) == 1)
            break;
    if (file)
        fclose(file);
    return kb;
}

/* CAMBER_FRAMES of a small window: from a quarter of them on, when the flight has been seen in both themes, nothing
 * grows. */
static void test_nothing_grows(void **state) {
    (void)state;
    const char *text = getenv("CAMBER_FRAMES");
    const int frames = text ? atoi(text) : SMALL_FRAMES;
    long early_kb = 0;
    viewer v;
    viewer_open(&v, &(options_of){.size = "64x48"});
    rest(&v);
    const stand start = v.at;
    push_key(SDLK_g);
    for (int i = 0; i < frames; i++) {
        v.at = fly(&start, i % 100 / 100.0);
        if (i % 50 == 49) /* other styles, and with them other scenes */
            push_key(SDLK_t);
        assert_true(turn(&v, &start));
        if (i == frames / 4)
            early_kb = resident_kb();
    }
    const long late_kb = resident_kb();
    print_message("resident: %ld KB after %d frames, %ld KB after %d; %d scenes\n", early_kb, frames / 4, late_kb,
                  frames, v.scenes);
    assert_true(v.frame_count >= frames);
    /* Outlines of glyphs are kept, a few MB, and how soon depends on how fast scenes are made. AddressSanitizer keeps
     * what is freed for a while. */
    assert_true(IS_SANITIZED || late_kb - early_kb < 12288);
    close_viewer(&v);
}

static void test_bad_command_lines(void **state) {
    (void)state;
    static const char *const lines[][4] = {
        {"viewer"}, {"viewer", "a", "--size", "axb"}, {"viewer", "a", "--frames", "0"}, {"viewer", "a", "--what", "1"}};
    static const int counts[] = {1, 4, 4, 4};
    for (size_t i = 0; i < 4; i++)
        assert_int_equal(viewer_main(counts[i], (char **)(uintptr_t)lines[i]), 2);
    static const char *const missing[] = {"viewer", "/nowhere.mbtiles", "--draw", "cl"};
    assert_int_equal(viewer_main(4, (char **)(uintptr_t)missing), 1);
    static const char *const benchmark[] = {"viewer", CITY, "--draw", "cl", "--benchmark", "--frames", "30"};
    assert_int_equal(viewer_main(7, (char **)(uintptr_t)benchmark), 0);
}

/* Fewer frames than warm up: the ones that count come after these all the same. */
static void test_short_benchmark(void **state) {
    (void)state;
    char *arguments[] = {
        (char *)(uintptr_t) "viewer",   (char *)(uintptr_t)CITY,      (char *)(uintptr_t) "--draw",
        (char *)(uintptr_t) "cl",       (char *)(uintptr_t) "--size", (char *)(uintptr_t) "64x48",
        (char *)(uintptr_t) "--frames", (char *)(uintptr_t) "3",      (char *)(uintptr_t) "--benchmark"};
    viewer v = {0};
    assert_true(parse_options(9, arguments, &v.options));
    assert_true(open_viewer(&v) && run(&v));
    assert_true(v.is_warm && v.frame_count == 3);
    close_viewer(&v);
}

/* Whether SDL gives a GLES context without a screen. */
static bool has_gl(void) {
    SDL_Window *window = NULL;
    if (SDL_Init(SDL_INIT_VIDEO) == 0) {
        SDL_GL_SetAttribute(SDL_GL_CONTEXT_PROFILE_MASK, SDL_GL_CONTEXT_PROFILE_ES);
        SDL_GL_SetAttribute(SDL_GL_CONTEXT_MAJOR_VERSION, 3);
        window = SDL_CreateWindow("gl", 0, 0, 16, 16, SDL_WINDOW_OPENGL);
    }
    const SDL_GLContext context = window ? SDL_GL_CreateContext(window) : NULL;
    if (window)
        SDL_DestroyWindow(window);
    SDL_Quit();
    return context;
}

int main(void) {
    static int by_gl;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_place_below_the_pointer_stays),
        cmocka_unit_test(test_place_below_the_pointer_is_where_it_is_drawn),
        cmocka_unit_test(test_start_is_the_fitted_map),
        cmocka_unit_test(test_drag_moves_the_picture),
        cmocka_unit_test(test_wheel_keys_and_turns),
        cmocka_unit_test(test_theme_and_graph),
        cmocka_unit_test(test_style_is_read_again),
        cmocka_unit_test(test_resized_and_hidden),
        cmocka_unit_test(test_any_events),
        cmocka_unit_test(test_nothing_grows),
        cmocka_unit_test(test_bad_command_lines),
        cmocka_unit_test(test_short_benchmark),
    };
    const struct CMUnitTest gl_tests[] = {
        cmocka_unit_test_prestate(test_wheel_keys_and_turns, &by_gl),
        cmocka_unit_test_prestate(test_theme_and_graph, &by_gl),
        cmocka_unit_test_prestate(test_resized_and_hidden, &by_gl),
    };
    setenv("HWLOC_PLUGINS_PATH", "/dev/null", 0);
    setenv("SDL_VIDEODRIVER", "dummy", 1);
    int failed = cmocka_run_group_tests_name("dummy", tests, NULL, NULL);
    setenv("SDL_VIDEODRIVER", "offscreen", 1);
    if (!IS_SANITIZED && has_gl()) /* SDL unloads the drivers of GL, which keep what they allocate */
        failed += cmocka_run_group_tests_name("offscreen, by GL", gl_tests, NULL, NULL);
    else
        puts("no GLES by SDL's offscreen driver, or sanitizers: frames by GL are not tested");
    return failed;
}
