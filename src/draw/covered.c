/* Frames that kernels draw: passes become runs of polylines, tables of rows and brushes, and the picture is drawn an
 * area after the other. */
#include "base/perspective.h"
#include "draw/renderer.h"
#include "raster/raster.h"

#include <string.h>

/* Of an area: its tiles' counts and its pixels are what its memory goes by. */
enum { AREA_PX = 16 * 1024 * 1024, AREA_SIDE_PX = CAMBER_TILE_PX * CAMBER_TILES_MAX };
/* How far back a table looks for a brush of the same colour. */
enum { INKS_BACK = 16 };

typedef struct tables {
    camber_context *context;
    camber_renderer *renderer; /* has the tail */
    float *rows;
    camber_brush *brushes;
    camber_brush_ext *brush_ext; /* as many */
    camber_raster_input *runs;
    size_t row_count, row_capacity, brush_count, brush_capacity, more_capacity, run_count, run_capacity;
    bool is_rich; /* one of these has features */
    camber_covered_images images;
    uint32_t layers;     /* so far */
    float background[4]; /* premultiplied: what lies below the first run */
    float sky[4];        /* as well: what is seen where nothing but colours is drawn */
    /* The last table of what is not layered: the runs of a pass share it. */
    const camber_pass *pass;
    size_t first_row;
    /* The last dash in the tail: rows that follow each other mostly have the same. */
    const camber_dash *dash;
    float dash_unit_px, dash_texel[4];
    bool dash_round;
    bool pitched;
} tables;

static void free_tables(tables *t) {
    camber_free(t->context, t->images.held);
    camber_free(t->context, t->runs);
    camber_free(t->context, t->brush_ext);
    camber_free(t->context, t->brushes);
    camber_free(t->context, t->rows);
}

/* The number of a brush, which may be one of the table's that begins with brush first. */
static camber_status use_brush(tables *t, size_t first, const camber_brush *brush, const camber_brush_ext *brush_ext,
                               uint32_t *number) {
    for (size_t i = t->brush_count; i > first && i + INKS_BACK > t->brush_count; i--)
        if (memcmp(t->brushes + i - 1, brush, sizeof *brush) == 0 &&
            memcmp(t->brush_ext + i - 1, brush_ext, sizeof *brush_ext) == 0) {
            *number = (uint32_t)(i - 1);
            return CAMBER_OK;
        }
    if (!camber_grow(t->context, &t->brushes, &t->brush_capacity, t->brush_count + 1, sizeof *t->brushes) ||
        !camber_grow(t->context, &t->brush_ext, &t->more_capacity, t->brush_count + 1, sizeof *t->brush_ext))
        return CAMBER_ERROR_MEMORY;
    *number = (uint32_t)t->brush_count;
    t->is_rich = t->is_rich || brush_ext->features || brush->mode == CAMBER_BRUSH_MASKED;
    t->brush_ext[t->brush_count] = *brush_ext;
    t->brushes[t->brush_count++] = *brush;
    return CAMBER_OK;
}

static camber_status put_dash(tables *t, const camber_pass *pass, uint32_t row, camber_brush_ext *brush_ext) {
    const camber_paint *paint = pass->paints + row;
    const camber_dash *dash = pass->dashes + paint->dash - 1;
    const bool is_round = pass->mesh->host_rows[row].cap == CAMBER_CAP_ROUND;
    if (t->dash != dash || t->dash_round != is_round ||
        memcmp(&t->dash_unit_px, &paint->dash_unit_px, sizeof(float)) != 0) {
        const camber_status status = camber_tail_put_dash(t->renderer, pass, row, t->dash_texel);
        if (status != CAMBER_OK)
            return status;
        t->dash = dash;
        t->dash_round = is_round;
        t->dash_unit_px = paint->dash_unit_px;
    }
    brush_ext->features |= CAMBER_FEATURE_DASH;
    brush_ext->first_dash = (uint32_t)t->dash_texel[0];
    brush_ext->dash_count = (uint32_t)t->dash_texel[1] / 2;
    brush_ext->round_dashes = is_round;
    brush_ext->period = t->dash_texel[2];
    return CAMBER_OK;
}

/* What a row has beside its brush. */
static camber_status fill_more(tables *t, const camber_pass *pass, uint32_t row, camber_brush_ext *brush_ext) {
    const camber_paint *paint = pass->paints + row;
    camber_status status = CAMBER_OK;
    *brush_ext = (camber_brush_ext){0};
    if (paint->gap_px > 0.0f) {
        brush_ext->features |= CAMBER_FEATURE_GAP;
        brush_ext->half_gap = 0.5f * paint->gap_px;
    }
    if (paint->blur_px > 0.0f) {
        brush_ext->features |= CAMBER_FEATURE_BLUR;
        brush_ext->blur = paint->blur_px;
    }
    if (paint->trim_end > paint->trim_start) {
        float trim[2];
        camber_rows_put_trim(paint, trim);
        brush_ext->features |= CAMBER_FEATURE_TRIM;
        brush_ext->trim_from = trim[0];
        brush_ext->trim_to = trim[1];
    }
    if (paint->dash)
        status = put_dash(t, pass, row, brush_ext);
    if (paint->ramp && status == CAMBER_OK) {
        float texel[2];
        status = camber_tail_put_ramp(t->renderer, pass->ramps + paint->ramp - 1, texel);
        if (status != CAMBER_OK)
            return status;
        brush_ext->features |= CAMBER_FEATURE_RAMP;
        brush_ext->first_stop = (uint32_t)texel[0];
        brush_ext->stop_count = (uint32_t)texel[1];
    }
    if (paint->pattern && status == CAMBER_OK) {
        brush_ext->features |= CAMBER_FEATURE_IMAGE;
        status = camber_covered_put_line(t->renderer, &t->images, pass, paint, &brush_ext->image);
    }
    return status;
}

/* The table of a run: rows of other alphas are left out, and a layer's rows are drawn opaque. brush has its group. */
static camber_status fill_table(tables *t, const camber_run *run, camber_brush brush) {
    const camber_pass *pass = run->pass;
    const size_t count = pass->mesh->row_count, first_brush = t->brush_count;
    /* The union is of strokes with one edge on each side. */
    const bool united = run->layered && run->one_color && !run->bands;
    if (!camber_grow(t->context, &t->rows, &t->row_capacity, t->row_count + count,
                     CAMBER_RASTER_ROW_WORDS * sizeof *t->rows))
        return CAMBER_ERROR_MEMORY;
    if (run->layered && !united) {
        brush.layer = ++t->layers;
        brush.layer_opacity = run->alpha * run->opacity;
    }
    t->first_row = t->row_count;
    for (size_t i = 0; i < count; i++) {
        const camber_paint *paint = pass->paints + i;
        float *row = t->rows + CAMBER_RASTER_ROW_WORDS * t->row_count++;
        uint32_t number = 0;
        memset(row, 0, CAMBER_RASTER_ROW_WORDS * sizeof *row);
        row[0] = -1.0f;
        if (!camber_pass_draws(pass, (uint32_t)i) || (run->one_alpha && paint->color.a != run->alpha))
            continue;
        static const camber_color image_alone = {1, 1, 1, 1};
        const camber_color color = paint->pattern ? image_alone : united ? run->color : paint->color;
        brush.r = color.r;
        brush.g = color.g;
        brush.b = color.b;
        brush.a = united ? run->alpha * run->opacity : run->layered && run->one_alpha ? 1.0f : paint->color.a;
        brush.mode = united ? CAMBER_BRUSH_UNION : run->masked ? CAMBER_BRUSH_MASKED : CAMBER_BRUSH_OVER;
        camber_brush_ext brush_ext;
        camber_status status = fill_more(t, pass, (uint32_t)i, &brush_ext);
        if (status == CAMBER_OK)
            status = use_brush(t, first_brush, &brush, &brush_ext, &number);
        if (status != CAMBER_OK)
            return status;
        row[0] = camber_paint_half_width(paint);
        row[1] = paint->translate_x_px;
        row[2] = paint->translate_y_px;
        memcpy(row + 3, &number, sizeof number);
    }
    return CAMBER_OK;
}

static camber_status add_run(tables *t, const camber_run *run, camber_brush brush) {
    if (run->alpha <= 0.0f)
        return CAMBER_OK;
    const bool shares = !run->layered && t->pass && t->pass == run->pass && brush.group == 0;
    camber_status status = CAMBER_OK;
    if (!camber_grow(t->context, &t->runs, &t->run_capacity, t->run_count + 1, sizeof *t->runs))
        return CAMBER_ERROR_MEMORY;
    if (!shares)
        status = fill_table(t, run, brush);
    t->pass = run->layered || brush.group ? NULL : run->pass;
    t->runs[t->run_count++] = (camber_raster_input){run->pass->mesh, run->first, run->end, t->first_row};
    return status;
}

/* A row by itself, of a fill. */
static camber_status add_fill_row(tables *t, const camber_brush *brush, const camber_brush_ext *brush_ext) {
    uint32_t number = 0;
    if (!camber_grow(t->context, &t->rows, &t->row_capacity, t->row_count + 1,
                     CAMBER_RASTER_ROW_WORDS * sizeof *t->rows) ||
        !camber_grow(t->context, &t->runs, &t->run_capacity, t->run_count + 1, sizeof *t->runs))
        return CAMBER_ERROR_MEMORY;
    const camber_status status = use_brush(t, 0, brush, brush_ext, &number);
    if (status != CAMBER_OK)
        return status;
    float *row = t->rows + CAMBER_RASTER_ROW_WORDS * t->row_count;
    row[0] = CAMBER_FILL_PX;
    row[1] = row[2] = 0.0f;
    memcpy(row + 3, &number, sizeof number);
    t->runs[t->run_count++] = (camber_raster_input){.first_row = t->row_count++};
    return CAMBER_OK;
}

/* What lies below is not seen. */
static void hide_runs(tables *t) {
    t->run_count = 0;
    t->is_rich = false;
}

static camber_status add_images(tables *t, const camber_pass *pass, float alpha) {
    const camber_brush brush = {.r = 1, .g = 1, .b = 1, .a = alpha};
    camber_brush_ext brush_ext = {.features = CAMBER_FEATURE_IMAGE};
    bool is_opaque = false;
    const camber_status status = camber_covered_put_fill(t->renderer, &t->images, pass, &brush_ext.image, &is_opaque);
    if (status != CAMBER_OK)
        return status;
    if (is_opaque && alpha >= 1.0f)
        hide_runs(t);
    return add_fill_row(t, &brush, &brush_ext);
}

static void put_over(const float color[4], float below[4]) {
    for (int i = 0; i < 4; i++)
        below[i] = color[i] + (1.0f - color[3]) * below[i];
}

/* What an opaque colour hides is not drawn; below all lines a fill is part of the background. */
static camber_status add_fill(tables *t, const camber_pass *pass) {
    static const camber_brush_ext no_more = {0};
    const camber_color c = pass->fill.color;
    const float a = c.a * (pass->opacity > 0.0f ? pass->opacity : 1.0f);
    const float color[4] = {c.r * a, c.g * a, c.b * a, a};
    const camber_brush brush = {.r = c.r, .g = c.g, .b = c.b, .a = a};
    if (!(a > 0.0f))
        return CAMBER_OK;
    if (pass->fill.pattern)
        return add_images(t, pass, a);
    put_over(color, t->sky);
    if (a >= 1.0f)
        hide_runs(t);
    if (t->run_count > 0)
        return add_fill_row(t, &brush, &no_more);
    put_over(color, t->background);
    return CAMBER_OK;
}

static camber_status add_pass(tables *t, const camber_pass *pass) {
    const camber_mesh *mesh = pass->mesh;
    if (!mesh)
        return add_fill(t, pass);
    const bool fades = pass->opacity > 0.0f && pass->opacity < 1.0f;
    size_t end = pass->polyline_count ? pass->first_polyline + pass->polyline_count : mesh->polyline_count;
    end = end < mesh->polyline_count ? end : mesh->polyline_count;
    camber_brush brush = {0};
    camber_status status = CAMBER_OK;
    if (mesh->empty)
        return CAMBER_OK;
    camber_runs runs = camber_runs_begin(pass, end);
    camber_run run;
    while (status == CAMBER_OK && camber_runs_next(&runs, &run)) {
        const bool alone = !runs.by_alpha && run.first == pass->first_polyline && run.end == end;
        if (fades && alone && pass->overlap != CAMBER_OVERLAP_ACCUMULATE) {
            run.opacity = pass->opacity;
            run.one_alpha = run.one_alpha || !run.layered;
            run.layered = true;
        } else if (fades && brush.group == 0) {
            brush.group = ++t->layers;
            brush.group_opacity = pass->opacity;
        }
        status = add_run(t, &run, brush);
    }
    return status;
}

static camber_status make_tables(tables *t, const camber_frame *frame) {
    const camber_brush none = {0};
    const camber_brush_ext no_more = {0};
    uint32_t number;
    camber_status status = use_brush(t, 0, &none, &no_more, &number); /* there is one, also where nothing is drawn */
    for (size_t i = 0; i < frame->pass_count && status == CAMBER_OK; i++)
        status = add_pass(t, frame->passes + i);
    if (status == CAMBER_OK && !camber_grow(t->context, &t->rows, &t->row_capacity, t->row_count + 1,
                                            CAMBER_RASTER_ROW_WORDS * sizeof *t->rows))
        status = CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK)
        memset(t->rows + CAMBER_RASTER_ROW_WORDS * t->row_count, 0, CAMBER_RASTER_ROW_WORDS * sizeof *t->rows);
    return status;
}

/* Whole rows where they fit. */
static camber_raster_area first_area(const camber_renderer *renderer, const camber_frame *frame) {
    const camber_device *device = renderer->share.device;
    uint32_t side = AREA_SIDE_PX;
    if (frame->largest_piece_px && frame->largest_piece_px < side)
        side = frame->largest_piece_px < CAMBER_TILE_PX ? CAMBER_TILE_PX
                                                        : frame->largest_piece_px / CAMBER_TILE_PX * CAMBER_TILE_PX;
    if (camber_raster_widest(renderer->raster) < side)
        side = camber_raster_widest(renderer->raster);
    const uint32_t width = frame->width < side ? frame->width : side;
    const uint64_t most = device->info.largest_buffer_bytes / 4, pixels = most < AREA_PX ? most : AREA_PX;
    const uint32_t fitting = (uint32_t)(pixels / (width + CAMBER_TILE_PX)) / CAMBER_TILE_PX * CAMBER_TILE_PX;
    const uint32_t bound = fitting < side ? fitting : side, rows = bound > 0 ? bound : CAMBER_TILE_PX;
    return (camber_raster_area){.width = width, .height = frame->height < rows ? frame->height : rows};
}

typedef struct target {
    camber_rows_fn *rows;
    void *user;
    camber_area_fn *draw; /* in place of rows */
    uint8_t *band;        /* of several areas, or where rows are not as wide as the picture */
    uint32_t width;
    double user_ms; /* that the user took with an area: no part of reading back */
} target;

/* Copies the area into the band, or hands it over as it is. */
static camber_status take_area(camber_renderer *renderer, const camber_raster_area *area, target *to) {
    camber_raster_pixels pixels;
    const size_t width_bytes = 4 * (size_t)area->width, row_bytes = 4 * (size_t)to->width;
    const bool direct = !to->band;
    camber_status status = camber_raster_map(renderer->raster, &pixels);
    if (status != CAMBER_OK)
        return status;
    const double begin = camber_now_ms();
    if (direct && !to->rows(to->user, pixels.rgba, area->y, area->height))
        status = CAMBER_ERROR_IO;
    to->user_ms += camber_now_ms() - begin;
    for (size_t y = 0; !direct && y < area->height; y++)
        memcpy(to->band + y * row_bytes + 4 * (size_t)area->x, pixels.rgba + y * pixels.row_bytes, width_bytes);
    camber_raster_unmap(renderer->raster, pixels);
    return status;
}

static void add_times(const camber_renderer *renderer, camber_frame_stats *stats) {
    const camber_raster_times times = camber_raster_get_times(renderer->raster);
    stats->setup_ms += times.setup_ms;
    stats->bin_count_ms += times.bin_count_ms;
    stats->bin_scan_ms += times.bin_scan_ms;
    stats->bin_scatter_ms += times.bin_scatter_ms;
    stats->rasterize_ms += times.rasterize_ms;
}

/* The areas of a band of rows, from left to right. */
static camber_status draw_band(camber_renderer *renderer, const camber_raster_scene *scene, camber_raster_area area,
                               target *to, camber_frame_stats *stats) {
    const uint32_t widest = area.width;
    camber_status status = CAMBER_OK;
    for (area.x = 0; area.x < to->width && status == CAMBER_OK; area.x += widest) {
        const double begin = camber_now_ms();
        to->user_ms = 0;
        area.width = to->width - area.x < widest ? to->width - area.x : widest;
        status =
            to->draw ? to->draw(renderer, scene, &area, to->user) : camber_raster_draw(renderer->raster, scene, &area);
        const double drawn = camber_now_ms();
        stats->draw_ms += drawn - begin;
        stats->pieces++;
        add_times(renderer, stats);
        if (status == CAMBER_OK && to->rows)
            status = take_area(renderer, &area, to);
        stats->read_ms += camber_now_ms() - drawn - to->user_ms;
    }
    if (status == CAMBER_OK && to->band && to->rows && !to->rows(to->user, to->band, area.y, area.height))
        status = CAMBER_ERROR_IO;
    return status;
}

static camber_status draw_areas(camber_renderer *renderer, const camber_frame *frame, const camber_raster_scene *scene,
                                target *to, camber_frame_stats *stats) {
    camber_context *context = renderer->share.device->context;
    camber_raster_area area = first_area(renderer, frame);
    const uint32_t tallest = area.height;
    camber_status status = CAMBER_OK;
    to->width = frame->width;
    if (to->rows && (area.width < frame->width || frame->width % CAMBER_TILE_PX)) {
        to->band = camber_alloc(context, (size_t)frame->width * tallest, 4);
        status = to->band ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    }
    for (; area.y < frame->height && status == CAMBER_OK; area.y += tallest) {
        area.height = frame->height - area.y < tallest ? frame->height - area.y : tallest;
        status = draw_band(renderer, scene, area, to, stats);
        if (tallest < frame->height)
            camber_progress(context, "drawing", (double)(area.y + area.height) / frame->height);
    }
    camber_free(context, to->band);
    return status;
}

static void pitch_scene(const camber_frame *frame, const float sky[4], camber_raster_scene *scene) {
    if (!(frame->pitch_deg > 0.0))
        return;
    const camber_perspective p = camber_perspective_of(frame->pitch_deg, frame->height);
    scene->pitched = true;
    scene->eye = (camber_eye){0.5f * (float)frame->width, 0.5f * (float)frame->height, (float)p.cosine, (float)p.fall};
    scene->horizon = camber_perspective_horizon(&p, frame->height);
    memcpy(scene->sky, sky, sizeof scene->sky);
}

/* px of the picture that a px of the plane takes, at most. */
static double nearest_of(const camber_frame *frame) {
    if (!(frame->pitch_deg > 0.0))
        return 1.0;
    const camber_perspective p = camber_perspective_of(frame->pitch_deg, frame->height);
    return 1.0 / p.nearest;
}

static camber_status render_to(camber_renderer *renderer, const camber_frame *frame, target *to,
                               camber_frame_stats *stats) {
    const camber_color back = frame->background;
    tables t = {.renderer = renderer,
                .pitched = frame->pitch_deg > 0.0,
                .context = renderer->share.device->context,
                .images = {.nearest = nearest_of(frame)},
                .background = {back.r * back.a, back.g * back.a, back.b * back.a, back.a}};
    camber_frame_stats made = {0};
    memcpy(t.sky, t.background, sizeof t.sky);
    camber_tail_forget(renderer);
    camber_status status = make_tables(&t, frame);
    camber_raster_scene scene = {
        .rows = t.rows,
        .row_count = t.row_count + 1,
        .brushes = t.brushes,
        .brush_count = t.brush_count,
        .inputs = t.runs,
        .input_count = t.run_count,
        .background = {t.background[0], t.background[1], t.background[2], t.background[3]},
        .linear = frame->coverage == CAMBER_COVERAGE_LINEAR,
        .brush_ext = t.is_rich || frame->pitch_deg > 0.0 ? t.brush_ext : NULL,
        .side_table = renderer->tail_texels,
        .side_table_count = renderer->tail_count,
    };
    pitch_scene(frame, t.sky, &scene);
    if (status == CAMBER_OK)
        status = draw_areas(renderer, frame, &scene, to, &made);
    if (status == CAMBER_OK)
        *stats = made;
    free_tables(&t);
    return status;
}

camber_status camber_covered_render(camber_renderer *renderer, const camber_frame *frame, camber_rows_fn *rows,
                                    void *user, camber_frame_stats *stats) {
    target to = {.rows = rows, .user = user};
    return render_to(renderer, frame, &to, stats);
}

camber_status camber_covered_each(camber_renderer *renderer, const camber_frame *frame, camber_area_fn *draw,
                                  void *user) {
    target to = {.draw = draw, .user = user};
    camber_frame_stats stats;
    return render_to(renderer, frame, &to, &stats);
}

/* ---- Frames in two steps ---- */

static bool keep_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    camber_flight *flight = user;
    const size_t row_bytes = 4 * (size_t)flight->frame.width;
    memcpy(flight->rgba + first_row * row_bytes, rgba, row_count * row_bytes);
    return true;
}

camber_status camber_covered_begin(camber_renderer *renderer, const camber_frame *frame, camber_flight *flight) {
    camber_context *context = renderer->share.device->context;
    const camber_raster_area area = first_area(renderer, frame);
    camber_flight made = {.frame = *frame, .first = {.width = area.width, .height = area.height}};
    camber_status status = CAMBER_OK;
    if (area.width == frame->width && area.height == frame->height) {
        made.rgba = camber_alloc(context, (size_t)frame->width * frame->height, 4);
        status =
            made.rgba ? camber_covered_render(renderer, frame, keep_rows, &made, &made.stats) : CAMBER_ERROR_MEMORY;
    }
    if (status != CAMBER_OK) {
        camber_free(context, made.rgba);
        return status;
    }
    *flight = made;
    return CAMBER_OK;
}

camber_status camber_covered_end(camber_renderer *renderer, camber_flight *flight, camber_rows_fn *rows, void *user) {
    if (!flight->rgba)
        return camber_covered_render(renderer, &flight->frame, rows, user, &flight->stats);
    return !rows || rows(user, flight->rgba, 0, flight->frame.height) ? CAMBER_OK : CAMBER_ERROR_IO;
}
