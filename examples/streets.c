/* streets: draws a town's streets with their names into streets.png. The program places the names itself: each as near
 * to the middle of its street as the other names allow. */
#include <camber_files.h>
#include <camber_text.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WIDTH = 960, HEIGHT = 600, STREETS = 10, POINTS = 120 };

static const char *const names[STREETS] = {"Harbour Street", "Rue de l’Église", "Goethestraße", "Невский", "Mill Lane",
                                           "Station Road",   "Västra Gatan",    "Λεωφόρος",     "Żółta",   "Park Row"};
static float points[2 * STREETS * POINTS]; /* pairs of x and y in px */
static uint32_t offsets[STREETS + 1], rows[STREETS];

/* Half of the streets run from left to right, the others from top to bottom. */
static void make_streets(void) {
    for (uint32_t i = 0; i < STREETS; i++) {
        const float share = ((float)(i % 5) + 0.5f) / 5, bend = 22 * sinf(3 + 5 * (float)i);
        for (uint32_t k = 0; k < POINTS; k++) {
            const float along = 1.2f * (float)k / (POINTS - 1) - 0.1f, aside = bend * sinf(7 * along + (float)i);
            points[2 * (POINTS * i + k)] = i < 5 ? WIDTH * along : WIDTH * share + aside;
            points[2 * (POINTS * i + k) + 1] = i < 5 ? HEIGHT * share + aside : HEIGHT * along;
        }
        offsets[i + 1] = offsets[i] + POINTS;
        rows[i] = i % 3 == 0; /* a main street */
    }
}

static bool is_free(const camber_text_box *boxes, size_t count, camber_text_box box) {
    for (size_t i = 0; i < count; i++)
        if (box.left < boxes[i].right && boxes[i].left < box.right && box.top < boxes[i].bottom &&
            boxes[i].top < box.bottom)
            return false;
    return true;
}

/* Adds the names of all streets, each at the first place between two crossings that is free. */
static bool add_names(camber_fonts *fonts, camber_text_rings *rings) {
    static const char *const font[] = {"Noto Sans"};
    camber_text_box boxes[STREETS];
    size_t count = 0;
    for (uint32_t i = 0; i < STREETS; i++) {
        const camber_text_run run = {.text = names[i], .size_bytes = strlen(names[i]), .fonts = font, .font_count = 1};
        const camber_text_desc desc = {.runs = &run, .run_count = 1};
        camber_text_position on = {.size_px = 15, .points = points + 2 * offsets[i], .point_count = POINTS};
        camber_text *text = NULL;
        if (camber_text_shape(fonts, &desc, &text) != CAMBER_OK)
            return false;
        const float half_block = (i < 5 ? WIDTH : HEIGHT) / 10.0f; /* the middle of a street is a crossing */
        for (int place = 0; place < 4; place++) {
            on.shift_px = half_block * (float)(place % 2 ? -place : place + 1);
            if (camber_text_rings_add(rings, text, &on, &boxes[count]) != CAMBER_OK)
                return false;
            if (is_free(boxes, count, boxes[count])) {
                count++;
                break;
            }
            camber_text_rings_remove_last(rings);
        }
        camber_text_destroy(text);
    }
    printf("%zu of %d streets have their names\n", count, STREETS);
    return true;
}

static void print_message(void *user, camber_log_level level, const char *message) {
    if (level < CAMBER_LOG_INFO)
        fprintf(user, "streets: %s\n", message);
}

static bool write_bytes(void *file, const void *bytes, size_t size_bytes) {
    return fwrite(bytes, 1, size_bytes, file) == size_bytes;
}

static bool write_rows(void *png, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    (void)first_row;
    return camber_png_write_rows(png, rgba, row_count) == CAMBER_OK;
}

int main(void) {
    const camber_context_desc log = {.log = print_message, .log_user = stderr};
    const camber_png_desc picture = {.width = WIDTH, .height = HEIGHT, .opaque = true};
    FILE *file = fopen("streets.png", "wb");
    camber_context *context = NULL;
    camber_fonts *fonts = NULL;
    camber_text_rings *rings = NULL;
    camber_polylines *streets = NULL, *texts = NULL;
    camber_device *device = NULL;
    camber_renderer *renderer = NULL;
    camber_mesh *street_mesh = NULL, *text_mesh = NULL;
    camber_png *png = NULL;
    make_streets();
    bool done = file && camber_context_create(&log, &context) == CAMBER_OK &&
                camber_fonts_create(context, NULL, &fonts) == CAMBER_OK &&
                camber_text_rings_create(fonts, &rings) == CAMBER_OK && add_names(fonts, rings);
    if (!done)
        return 1;
    /* Streets and names are polylines in px; a stroke has the largest width that a pass draws. */
    const camber_polylines_desc lines = {
        .points = points, .point_count = STREETS * POINTS, .offsets = offsets, .polyline_count = STREETS, .rows = rows};
    const camber_polylines_desc outlines = camber_text_rings_get(rings);
    const camber_stroke wide[] = {{.width_px = 14}, {.width_px = 20}}, halo = {.width_px = 4};
    const camber_tessellation_desc by_street = {.strokes = wide, .stroke_count = 2};
    const camber_tessellation_desc by_text = {.strokes = &halo, .stroke_count = 1};
    done = camber_polylines_create(context, &lines, &streets) == CAMBER_OK &&
           camber_polylines_create(context, &outlines, &texts) == CAMBER_OK &&
           camber_device_create(context, NULL, &device) == CAMBER_OK &&
           camber_renderer_create(device, NULL, NULL, &renderer) == CAMBER_OK &&
           camber_mesh_create(device, renderer, &street_mesh) == CAMBER_OK &&
           camber_mesh_create(device, renderer, &text_mesh) == CAMBER_OK &&
           camber_mesh_tessellate(street_mesh, streets, &by_street) == CAMBER_OK &&
           camber_mesh_tessellate(text_mesh, texts, &by_text) == CAMBER_OK;
    /* The frame draws the edges of the streets, their insides, the halos of the names, and the names. */
    const camber_color edge = {0.72f, 0.70f, 0.66f, 1}, minor = {1, 1, 1, 1}, main_street = {1, 0.9f, 0.62f, 1};
    const camber_paint edges[] = {{.width_px = 14, .color = edge}, {.width_px = 20, .color = edge}};
    const camber_paint insides[] = {{.width_px = 11, .color = minor}, {.width_px = 17, .color = main_street}};
    const camber_paint halos = {.width_px = 4, .color = {1, 1, 1, 0.9f}};
    const camber_paint letters = {.fill = &(camber_fill){.color = {0.2f, 0.2f, 0.25f, 1}}};
    const camber_pass passes[] = {{.mesh = street_mesh, .paints = edges, .paint_count = 2},
                                  {.mesh = street_mesh, .paints = insides, .paint_count = 2},
                                  {.mesh = text_mesh, .paints = &halos, .paint_count = 1},
                                  {.mesh = text_mesh, .paints = &letters, .paint_count = 1}};
    const camber_frame frame = {
        .width = WIDTH, .height = HEIGHT, .background = {0.93f, 0.92f, 0.89f, 1}, .passes = passes, .pass_count = 4};
    done = done &&
           camber_png_create(context, &picture, (camber_sink){.write = write_bytes, .user = file}, &png) == CAMBER_OK &&
           camber_renderer_render(renderer, &frame, write_rows, png, NULL) == CAMBER_OK &&
           camber_png_finish(png) == CAMBER_OK;
    return done && fclose(file) == 0 ? 0 : 1; /* a program that continues would destroy its objects, the last first */
}
