/* hello: draws lines into hello.png: waves in colours from blue to gold. */
#include <camber_files.h>
#include <math.h>
#include <stdio.h>

enum { WIDTH = 960, HEIGHT = 480, LINES = 48, POINTS = 200 };

static float points[2 * LINES * POINTS]; /* pairs of x, y in pixels */
static uint32_t offsets[LINES + 1];      /* where the points of each line begin, and where the last ends */
static uint32_t rows[LINES];             /* which stroke and paint each line has */
static camber_stroke strokes[LINES];
static camber_paint paints[LINES];

static void make_waves(void) {
    for (uint32_t i = 0; i < LINES; i++) {
        const float share = (float)i / (LINES - 1), swell = sinf(3.1416f * share);
        for (uint32_t k = 0; k < POINTS; k++) {
            const float x = (float)k / (POINTS - 1), bend = sinf(3.1416f * x) * swell * sinf(9 * x + 5 * share);
            points[2 * (POINTS * i + k)] = 60 + (WIDTH - 120) * x;
            points[2 * (POINTS * i + k) + 1] =
                HEIGHT * (0.2f + 0.6f * share) + 70 * bend + 25 * sinf(4 * x - 6 * share);
        }
        offsets[i + 1] = offsets[i] + POINTS;
        rows[i] = i;
        strokes[i] = (camber_stroke){.width_px = 1.5f + 3 * swell, .cap = CAMBER_CAP_ROUND};
        paints[i].width_px = strokes[i].width_px;
        paints[i].color = (camber_color){0.15f + 0.85f * share, 0.45f + 0.3f * share, 0.95f - 0.75f * share, 0.9f};
    }
}

static void print_message(void *user, camber_log_level level, const char *message) {
    if (level < CAMBER_LOG_INFO)
        fprintf(user, "hello: %s\n", message); /* why a call failed, and the cure */
}

static bool write_bytes(void *file, const void *bytes, size_t size_bytes) {
    return fwrite(bytes, 1, size_bytes, file) == size_bytes;
}

static bool write_rows(void *png, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    (void)first_row; /* rows come from the top down */
    return camber_png_write_rows(png, rgba, row_count) == CAMBER_OK;
}

/* README begins */
static bool draw(camber_context *context, camber_mesh *mesh, camber_renderer *renderer, camber_png *png) {
    camber_polylines_desc lines = {.points = points, .point_count = LINES * POINTS, .polyline_count = LINES};
    lines.offsets = offsets;
    lines.rows = rows;
    const camber_tessellation_desc desc = {.strokes = strokes, .stroke_count = LINES};
    const camber_pass pass = {.mesh = mesh, .paints = paints, .paint_count = LINES};
    camber_frame frame = {.width = WIDTH, .height = HEIGHT, .passes = &pass, .pass_count = 1};
    frame.background = (camber_color){0.05f, 0.06f, 0.1f, 1};
    camber_polylines *polylines;
    return camber_polylines_create(context, &lines, &polylines) == CAMBER_OK &&
           camber_mesh_tessellate(mesh, polylines, &desc) == CAMBER_OK &&
           camber_renderer_render(renderer, &frame, write_rows, png, NULL) == CAMBER_OK;
}
/* README ends */

int main(void) {
    const camber_context_desc log = {.log = print_message, .log_user = stderr};
    const camber_png_desc picture = {.width = WIDTH, .height = HEIGHT, .opaque = true};
    camber_context *context;
    camber_device *device;
    camber_renderer *renderer;
    camber_mesh *mesh;
    camber_png *png;
    FILE *file = fopen("hello.png", "wb");
    const camber_sink out = {.write = write_bytes, .user = file};
    make_waves();
    const bool done = file && camber_context_create(&log, &context) == CAMBER_OK &&
                      camber_device_create(context, NULL, &device) == CAMBER_OK &&
                      camber_renderer_create(device, NULL, NULL, &renderer) == CAMBER_OK &&
                      camber_mesh_create(device, renderer, &mesh) == CAMBER_OK &&
                      camber_png_create(context, &picture, out, &png) == CAMBER_OK &&
                      draw(context, mesh, renderer, png) && camber_png_finish(png) == CAMBER_OK;
    return done && fclose(file) == 0 ? 0 : 1; /* a program that goes on destroys what it made: the mesh first */
}
