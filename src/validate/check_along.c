/* Compares with samples: lines with two sides and a gap, and lines that fade, are dashed, are drawn in part, change
 * their colour or show an image; the areas that the same points enclose; and glyphs with halos, as labels draw them.
 * Some are seen at an angle. */
#include "validate/along_truth.h"
#include "validate/checks.h"
#include "validate/glyph_truth.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE_PX = 96, LINES = 3, RINGS = 7, PIXELS = SIDE_PX * SIDE_PX };

/* Lines that are far apart from each other: straight, bent and curved. The rings are these lines, closed, and after
 * them a square, two crossing bars that are narrower than a pixel, and a disc, most of whose edges are shorter. */
static const float points[] = {
    6.3f,   9.6f,   89.1f,  20.2f,  10.3f,  34.6f,  38.1f,  30.2f,  60.8f,  47.4f,  86.7f,  43.9f,  8.0f,
    66.f,   18.0f,  58.0f,  28.0f,  56.0f,  38.0f,  60.0f,  46.0f,  68.0f,  56.0f,  76.0f,  68.0f,  80.0f,
    80.f,   78.0f,  88.0f,  70.0f,  54.3f,  2.4f,   66.6f,  2.4f,   66.6f,  9.7f,   54.3f,  9.7f,   70.1f,
    2.4f,   70.9f,  2.4f,   70.9f,  14.7f,  70.1f,  14.7f,  70.2f,  1.3f,   71.0f,  1.3f,   71.0f,  13.6f,
    70.2f,  13.6f,  22.93f, 86.30f, 22.78f, 86.90f, 22.39f, 87.45f, 21.91f, 87.93f, 21.43f, 88.29f, 20.95f,
    88.52f, 20.40f, 88.60f, 19.76f, 88.52f, 19.13f, 88.29f, 18.66f, 87.93f, 18.41f, 87.45f, 18.34f, 86.90f,
    18.33f, 86.30f, 18.34f, 85.70f, 18.41f, 85.15f, 18.66f, 84.67f, 19.13f, 84.31f, 19.76f, 84.08f, 20.40f,
    84.00f, 20.95f, 84.08f, 21.43f, 84.31f, 21.91f, 84.67f, 22.39f, 85.15f, 22.78f, 85.70f};
static const uint32_t offsets[] = {0, 2, 6, 15, 19, 23, 27, 51};

static const float even[] = {9.3f, 6.1f}, roomy[] = {7, 10.5f, 0, 9};
static const camber_dash dashes[] = {{even, 2}, {roomy, 4}};
static const camber_ramp_stop shades[] = {{0.1f, {1, 0, 0, 1}},    {0.4f, {0.2f, 0, 0, 1}}, {0.4f, {0.8f, 0, 0, 1}},
                                          {0.6f, {0.8f, 0, 0, 1}}, {0.6f, {0.1f, 0, 0, 1}}, {0.9f, {1, 0, 0, 1}}};
static const camber_ramp_stop panes[] = {
    {0.1f, {1, 0, 0, 0.2f}}, {0.5f, {0.5f, 0, 0, 0.9f}}, {0.5f, {1, 0, 0, 0.4f}}, {1, {1, 0, 0, 1}}};
/* A ramp that goes from dark to light and back within a pixel or two. */
static const camber_ramp_stop steps[] = {{0.2f, {0.1f, 0, 0, 1}}, {0.22f, {1, 0, 0, 1}}, {0.45f, {1, 0, 0, 1}},
                                         {0.46f, {0, 0, 0, 1}},   {0.7f, {0, 0, 0, 1}},  {0.715f, {1, 0, 0, 1}},
                                         {0.74f, {0.3f, 0, 0, 1}}};
static const camber_ramp ramps[] = {{shades, 6}, {panes, 4}, {steps, 7}};

/* Six by four texels, whose red values differ in both directions. The lowest row equals the top one, so that nothing
 * jumps from one copy to the next. */
#define RED(r) r, 0, 0, 255
static const uint8_t texels[] = {RED(250), RED(200), RED(140), RED(80),  RED(140), RED(200), /**/
                                 RED(190), RED(120), RED(60),  RED(20),  RED(60),  RED(120), /**/
                                 RED(100), RED(170), RED(230), RED(250), RED(230), RED(170), /**/
                                 RED(250), RED(200), RED(140), RED(80),  RED(140), RED(200)};
static const camber_image image = {texels, 6, 4, 0};

#define WHITE .color = {1, 1, 1, 1}
static const camber_fill fills[] = {{WHITE},
                                    {WHITE, .rule = CAMBER_FILL_EVENODD},
                                    {WHITE, .image = &image, .width_px = 24, .height_px = 18, .x_px = 3}};

/* The lines that are drawn, and the bounds of their pixels: measured with llvmpipe, plus a third. */
static const struct {
    const char *name;
    camber_cap cap;
    camber_paint paint;
    camber_pixel_bounds bounds;
    double pitch_deg;
    bool glyphs; /* the sheet of glyphs instead of the lines; the paint is unused */
} rows[] = {
    {"a gap", CAMBER_CAP_BUTT, {.width_px = 3, .gap_px = 4, WHITE}, {0.6, 0.002, 0.0005}},
    {"a blur", CAMBER_CAP_BUTT, {.width_px = 10, .blur_px = 3, WHITE}, {1.2, 0.001, 0.0005}},
    {"a smooth blur",
     CAMBER_CAP_ROUND,
     {.width_px = 10, .blur_px = 4, .smooth_blur = true, WHITE},
     {1.2, 0.001, 0.0005}},
    {"dashes", CAMBER_CAP_BUTT, {.width_px = 5, .dash = dashes, WHITE}, {0.7, 0.004, 0.0005}},
    {"round dashes", CAMBER_CAP_ROUND, {.width_px = 5, .dash = dashes + 1, WHITE}, {2.4, 0.004, 0.0005}},
    {"a trim", CAMBER_CAP_ROUND, {.width_px = 7, .trim_start = 0.31f, .trim_end = 0.62f, WHITE}, {0.7, 0.004, 0.0005}},
    {"a ramp", CAMBER_CAP_BUTT, {.width_px = 8, .ramp = ramps, WHITE}, {0.3, 0.002, 0.0005}},
    {"a steep ramp", CAMBER_CAP_BUTT, {.width_px = 8, .ramp = ramps + 2, WHITE}, {0.65, 0.004, 0.0005}},
    {"a translucent ramp", CAMBER_CAP_BUTT, {.width_px = 8, .ramp = ramps + 1, WHITE}, {0.3, 0.002, 0.0005}},
    {"areas", CAMBER_CAP_BUTT, {.fill = fills}, {0.33, 0.002, 0.0005}},
    {"areas by even-odd", CAMBER_CAP_BUTT, {.fill = fills + 1}, {0.33, 0.002, 0.0005}},
    {"an image", CAMBER_CAP_BUTT, {.width_px = 8, .image = &image, .image_px = 21, WHITE}, {1.9, 0.008, 0.0005}},
    {"areas of images", CAMBER_CAP_BUTT, {.fill = fills + 2}, {0.7, 0.002, 0.0005}},
    {"round caps at 40 degrees", CAMBER_CAP_ROUND, {.width_px = 7, WHITE}, {0.42, 0.002, 0.0005}, 40},
    {"dashes at 40 degrees", CAMBER_CAP_BUTT, {.width_px = 5, .dash = dashes, WHITE}, {0.95, 0.004, 0.0005}, 40},
    {"an image at 40 degrees",
     CAMBER_CAP_BUTT,
     {.width_px = 8, .image = &image, .image_px = 21, WHITE},
     {2.5, 0.018, 0.0005},
     40},
    {"areas of images at 40 degrees", CAMBER_CAP_BUTT, {.fill = fills + 2}, {0.7, 0.002, 0.0005}, 40},
    {"areas at 40 degrees", CAMBER_CAP_BUTT, {.fill = fills}, {0.2, 0.002, 0.0005}, 40},
    {"glyphs with halos", CAMBER_CAP_ROUND, {0}, {2.6, 0.037, 0.0015}, .glyphs = true},
};
_Static_assert((int)SIDE_PX == (int)CAMBER_SHEET_SIDE_PX, "all rows have pictures of one size");

/* Red and alpha. */
typedef struct channels {
    uint8_t levels[2 * PIXELS];
} channels;

static bool take(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    channels *to = user;
    for (size_t i = 0; i < (size_t)row_count * SIDE_PX; i++) {
        to->levels[(size_t)first_row * SIDE_PX + i] = rgba[4 * i];
        to->levels[PIXELS + (size_t)first_row * SIDE_PX + i] = rgba[4 * i + 3];
    }
    return true;
}

/* Returns how often a ring winds around a point, counted by its edges that pass to the left of the point. */
static int winding_around(size_t ring, double x, double y) {
    int winding = 0;
    const size_t first = offsets[ring], count = offsets[ring + 1] - first;
    for (size_t i = 0; i < count; i++) {
        const float *a = points + 2 * (first + i), *b = points + 2 * (first + (i + 1) % count);
        const double ax = (double)a[0], ay = (double)a[1], bx = (double)b[0], by = (double)b[1];
        if ((ay <= y) != (by <= y) && ax + (y - ay) / (by - ay) * (bx - ax) < x)
            winding += by > ay ? 1 : -1;
    }
    return winding;
}

static bool is_inside(camber_fill_rule rule, const double at[2]) {
    int winding = 0;
    for (size_t ring = 0; ring < RINGS; ring++)
        winding += winding_around(ring, at[0], at[1]);
    return rule == CAMBER_FILL_EVENODD ? winding % 2 != 0 : winding != 0;
}

/* Adds the inside of all rings, by samples. */
static void add_inside(const camber_fill *fill, double pitch_deg, float *rgba) {
    enum { SAMPLES = 32 };
    static const double size[] = {SIDE_PX, SIDE_PX};
    for (size_t i = 0; i < (size_t)PIXELS * SAMPLES * SAMPLES; i++) {
        const size_t pixel = i / (SAMPLES * SAMPLES), sample = i % (SAMPLES * SAMPLES);
        const double x = (double)(pixel % SIDE_PX) + ((double)(sample % SAMPLES) + 0.5) / SAMPLES;
        const double y = (double)(pixel / SIDE_PX) + ((double)(sample / SAMPLES) + 0.5) / SAMPLES;
        double at[] = {x, y}, depth;
        if (pitch_deg > 0 && !camber_ray_meets_plane(pitch_deg, size, x, y, at, &depth))
            continue;
        if (!is_inside(fill->rule, at))
            continue;
        const double red = !fill->image
                               ? 1
                               : camber_image_red(fill->image, (at[0] - (double)fill->x_px) / (double)fill->width_px,
                                                  (at[1] - (double)fill->y_px) / (double)fill->height_px);
        rgba[4 * pixel] += (float)red / (SAMPLES * SAMPLES);
        rgba[4 * pixel + 3] += 1.0f / (SAMPLES * SAMPLES);
    }
}

/* A row, and its expected pixels from samples. */
typedef struct expected {
    size_t number;
    float levels[2 * PIXELS];
} expected;

static bool sample_glyphs(float truth[2 * PIXELS]) {
    camber_glyph_sheet *sheet = malloc(sizeof *sheet);
    if (!sheet)
        return false;
    camber_glyph_sheet_make(sheet);
    camber_glyph_sheet_sample(sheet, truth);
    free(sheet);
    return true;
}

static bool make_truth(size_t number, float truth[2 * PIXELS]) {
    static const camber_window window = {0, 0, SIDE_PX, SIDE_PX};
    if (rows[number].glyphs)
        return sample_glyphs(truth);
    const camber_paint *paint = &rows[number].paint;
    float *rgba = calloc(PIXELS, 4 * sizeof *rgba);
    if (rgba && paint->fill)
        add_inside(paint->fill, rows[number].pitch_deg, rgba);
    for (size_t i = 0; i < LINES && rgba && !paint->fill; i++) {
        const camber_along_desc desc = {.points = points + 2 * offsets[i],
                                        .count = offsets[i + 1] - offsets[i],
                                        .cap = rows[number].cap,
                                        .paint = paint,
                                        .pitch_deg = rows[number].pitch_deg};
        camber_along_add(&desc, window, rgba);
    }
    for (size_t i = 0; i < PIXELS && rgba; i++) {
        truth[i] = rgba[4 * i];
        truth[PIXELS + i] = rgba[4 * i + 3];
    }
    const bool made = rgba != NULL;
    free(rgba);
    return made;
}

/* Draws glyphs as labels are drawn: strokes of the rings, and then their insides. The glyphs are red, the halos black,
 * so that red is the share of the glyphs, and alpha that of both. */
static camber_status draw_glyphs(camber_context *context, const camber_drawing_path *path, camber_method method,
                                 channels *drawn) {
    static const camber_fill red = {.color = {1, 0, 0, 1}};
    camber_stroke strokes[CAMBER_SHEET_ROWS] = {{0}};
    camber_paint halos[CAMBER_SHEET_ROWS] = {{0}}, glyphs[CAMBER_SHEET_ROWS] = {{0}};
    camber_polylines *polylines = NULL;
    camber_glyph_sheet *sheet = malloc(sizeof *sheet);
    if (!sheet)
        return CAMBER_ERROR_MEMORY;
    camber_glyph_sheet_make(sheet);
    for (size_t i = 0; i < CAMBER_SHEET_ROWS; i++) {
        const float width_px = 2.0f * camber_glyph_sheet_halo_px(i);
        strokes[i] = (camber_stroke){.width_px = width_px, .cap = CAMBER_CAP_ROUND};
        halos[i] = (camber_paint){.width_px = width_px, .color = {0, 0, 0, 1}};
        glyphs[i] = (camber_paint){.fill = &red};
    }
    const camber_polylines_desc desc = {.points = sheet->points,
                                        .point_count = sheet->offsets[CAMBER_SHEET_RINGS],
                                        .offsets = sheet->offsets,
                                        .polyline_count = CAMBER_SHEET_RINGS,
                                        .rows = sheet->rows};
    const camber_tessellation_desc tessellation = {
        .strokes = strokes, .stroke_count = CAMBER_SHEET_ROWS, .method = method};
    const camber_pass passes[] = {{.mesh = path->mesh, .paints = halos, .paint_count = CAMBER_SHEET_ROWS},
                                  {.mesh = path->mesh, .paints = glyphs, .paint_count = CAMBER_SHEET_ROWS}};
    const camber_frame frame = {.width = SIDE_PX, .height = SIDE_PX, .passes = passes, .pass_count = 2};
    camber_status status = camber_polylines_create(context, &desc, &polylines);
    if (status == CAMBER_OK)
        status = camber_mesh_tessellate(path->mesh, polylines, &tessellation);
    if (status == CAMBER_OK)
        status = camber_renderer_render(path->renderer, &frame, take, drawn, NULL);
    camber_polylines_destroy(polylines);
    free(sheet);
    return status;
}

static camber_status draw(camber_context *context, const camber_drawing_path *path, size_t number, camber_method method,
                          channels *drawn) {
    const camber_paint *paint = &rows[number].paint;
    const camber_stroke stroke = {.width_px = 2 * paint->width_px + paint->gap_px, .cap = rows[number].cap};
    const camber_polylines_desc desc = {
        .points = points, .point_count = offsets[LINES], .offsets = offsets, .polyline_count = LINES};
    const camber_tessellation_desc tessellation = {
        .strokes = &stroke, .stroke_count = 1, .method = method, .has_arc_length = true};
    const camber_pass pass = {.mesh = path->mesh, .paints = paint, .paint_count = 1};
    const camber_frame frame = {
        .width = SIDE_PX, .height = SIDE_PX, .passes = &pass, .pass_count = 1, .pitch_deg = rows[number].pitch_deg};
    const camber_areas_desc areas = {
        .points = points, .point_count = offsets[RINGS], .offsets = offsets, .ring_count = RINGS};
    camber_polylines *polylines = NULL;
    if (rows[number].glyphs)
        return draw_glyphs(context, path, method, drawn);
    camber_status status = paint->fill ? camber_areas_create(context, &areas, &polylines)
                                       : camber_polylines_create(context, &desc, &polylines);
    if (status == CAMBER_OK)
        status = camber_mesh_tessellate(path->mesh, polylines, &tessellation);
    if (status == CAMBER_OK)
        status = camber_renderer_render(path->renderer, &frame, take, drawn, NULL);
    camber_polylines_destroy(polylines);
    return status;
}

/* Finds the pixel with the largest error, and whether the bounds are exceeded. */
static bool find(const float *truth, const channels *drawn, camber_check *check) {
    const camber_difference d = camber_difference_of(truth, drawn->levels, 2 * PIXELS);
    const camber_pixel_bounds is = {camber_difference_mean(&d), (double)d.past_16 / (double)(d.touched ? d.touched : 1),
                                    (double)d.past_64 / (double)(d.touched ? d.touched : 1)};
    camber_finding *finding = &check->finding;
    check->has_error = true;
    check->error = (camber_pixel_error){.of = is, .windows = 1, .pixels = d.touched, .max = d.max};
    finding->field = !(is.mean <= check->most.mean)         ? "mean"
                     : !(is.past_16 <= check->most.past_16) ? "past_16"
                     : !(is.past_64 <= check->most.past_64) ? "past_64"
                                                            : NULL;
    if (!finding->field)
        return false;
    const bool by_mean = finding->field[0] == 'm', by_64 = finding->field[5] == '6' && finding->field[6] == '4';
    finding->stage = "pixels";
    finding->got = by_mean ? is.mean : by_64 ? is.past_64 : is.past_16;
    finding->expected = by_mean ? check->most.mean : by_64 ? check->most.past_64 : check->most.past_16;
    snprintf(finding->what, sizeof finding->what, "pixels: %s is %.4g, at most %.4g; most at %zu, %zu", finding->field,
             finding->got, finding->expected, d.max_at % PIXELS % SIDE_PX, d.max_at % PIXELS / SIDE_PX);
    return true;
}

static camber_status check_row(camber_validation *v, const camber_checked_device *checked,
                               const camber_checked_drawer *drawer, camber_method method, const expected *row) {
    static const camber_window window = {0, 0, SIDE_PX, SIDE_PX};
    camber_check check =
        camber_check_start(checked->name, drawer->name, "along lines: %s: %s: pixels, on %s, %s",
                           camber_method_get_name(method), rows[row->number].name, checked->name, drawer->name);
    channels *drawn = calloc(1, sizeof *drawn);
    check.most = rows[row->number].bounds;
    camber_status status =
        drawn ? draw(v->desc->context, &drawer->paths[0], row->number, method, drawn) : CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK && find(row->levels, drawn, &check)) {
        check.result = CAMBER_RESULT_FAILED;
        status = camber_failure_image_write(v, window, row->levels, drawn->levels, &check.finding);
    }
    if (status == CAMBER_OK)
        camber_results_add(&v->results, &check);
    free(drawn);
    return status;
}

static camber_status check_drawer(camber_validation *v, const camber_checked_device *checked,
                                  const camber_checked_drawer *drawer, const expected *row) {
    const camber_validation_desc *desc = v->desc;
    camber_status status = CAMBER_OK;
    for (int method = 0; method < 3 && status == CAMBER_OK; method++)
        if ((desc->method < 0 || desc->method == method) && camber_draws_method(desc, (camber_method)method) &&
            !checked->broken[method])
            status = check_row(v, checked, drawer, (camber_method)method, row);
    return status;
}

/* Each row is a group, because samples take most of the time. */
camber_status camber_check_along(camber_validation *v) {
    expected *row = malloc(sizeof *row);
    camber_status status = row ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < sizeof rows / sizeof *rows && status == CAMBER_OK; i++) {
        if (!camber_results_group(&v->results, "along lines: %s", rows[i].name))
            continue;
        row->number = i;
        status = make_truth(i, row->levels) ? CAMBER_OK : CAMBER_ERROR_MEMORY;
        for (size_t r = 0; r < v->devices.count; r++)
            for (size_t e = 0; e < v->devices.list[r].drawer_count && status == CAMBER_OK; e++)
                status = check_drawer(v, &v->devices.list[r], &v->devices.list[r].drawers[e], row);
    }
    free(row);
    return status;
}
