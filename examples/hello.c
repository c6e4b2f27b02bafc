/* hello: draws golden waves on a dark blue background into hello.png. */
#include <camber_files.h>
#include <math.h>
#include <stdio.h>

enum { WIDTH = 960, HEIGHT = 480, LINES = 48, POINTS = 200 };

static float points[2 * LINES * POINTS]; /* pairs of x and y in pixels */
static uint32_t offsets[LINES + 1];      /* where the points of each line begin, and where the last line ends */

static void make_waves(void) {
    for (uint32_t i = 0; i < LINES; i++) {
        const float share = (float)i / (LINES - 1), swell = sinf(3.1416f * share);
        for (uint32_t k = 0; k < POINTS; k++) {
            const float x = (float)k / (POINTS - 1), wave = sinf(3.1416f * x) * swell * sinf(9 * x + 5 * share);
            points[2 * (POINTS * i + k)] = 60 + (WIDTH - 120) * x;
            points[2 * (POINTS * i + k) + 1] = 96 + 288 * share + 70 * wave + 25 * sinf(4 * x - 6 * share);
        }
        offsets[i + 1] = offsets[i] + POINTS;
    }
}

static void print_message(void *user, camber_log_level level, const char *message) {
    if (level < CAMBER_LOG_INFO)
        fprintf(user, "hello: %s\n", message); /* why a call failed, and what to do */
}

static bool write_bytes(void *file, const void *bytes, size_t size_bytes) {
    return fwrite(bytes, 1, size_bytes, file) == size_bytes;
}

static bool write_rows(void *png, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    (void)first_row; /* rows arrive from top to bottom */
    return camber_png_write_rows(png, rgba, row_count) == CAMBER_OK;
}

/* README begins */
static bool draw(camber_context *context, camber_png *png) {
    const camber_polylines_desc lines = {
        .points = points, .point_count = LINES * POINTS, .offsets = offsets, .polyline_count = LINES};
    const camber_stroke stroke = {.width_px = 2.5f, .join = CAMBER_JOIN_ROUND, .cap = CAMBER_CAP_ROUND};
    const camber_paint paint = {.width_px = 2.5f, .color = {1, 0.78f, 0.3f, 1}};
    const camber_tessellation_desc shape = {.strokes = &stroke, .stroke_count = 1};
    camber_pass pass = {.paints = &paint, .paint_count = 1};
    camber_frame frame = {.width = WIDTH, .height = HEIGHT, .passes = &pass, .pass_count = 1};
    frame.background = (camber_color){0.05f, 0.06f, 0.1f, 1};
    camber_polylines *polylines = NULL;
    camber_device *device = NULL;
    camber_renderer *renderer = NULL;
    const bool drawn = camber_polylines_create(context, &lines, &polylines) == CAMBER_OK &&
                       camber_device_create(context, NULL, &device) == CAMBER_OK &&
                       camber_renderer_create(device, NULL, NULL, &renderer) == CAMBER_OK &&
                       camber_mesh_create(device, renderer, &pass.mesh) == CAMBER_OK &&
                       camber_mesh_tessellate(pass.mesh, polylines, &shape) == CAMBER_OK &&
                       camber_renderer_render(renderer, &frame, write_rows, png, NULL) == CAMBER_OK;
    camber_mesh_destroy(pass.mesh);
    camber_renderer_destroy(renderer);
    camber_device_destroy(device);
    camber_polylines_destroy(polylines);
    return drawn;
}
/* README ends */

int main(void) {
    const camber_context_desc log = {.log = print_message, .log_user = stderr};
    const camber_png_desc picture = {.width = WIDTH, .height = HEIGHT, .opaque = true};
    camber_context *context = NULL;
    camber_png *png = NULL;
    FILE *file = fopen("hello.png", "wb");
    const camber_sink out = {.write = write_bytes, .user = file};
    make_waves();
    const bool done = file && camber_context_create(&log, &context) == CAMBER_OK &&
                      camber_png_create(context, &picture, out, &png) == CAMBER_OK && draw(context, png) &&
                      camber_png_finish(png) == CAMBER_OK;
    camber_png_destroy(png);
    camber_context_destroy(context);
    return done && fclose(file) == 0 ? 0 : 1;
}
