/* Makes the rasterizer's scene from a draw list. A command becomes an input (polylines of a mesh), and a table with a
 * row for each of its mesh's rows. A row refers to a brush: its colour, its layer and group, and, in a second table,
 * its features. Polygons use the next brush from each change of their fill on.
 *
 * Fills below all lines become part of the background, and an opaque fill hides all inputs below it. */
#include "draw/draw_cl.h"

#include <string.h>

/* How many of the latest brushes are compared with a new one. */
enum { BRUSHES_BACK = 16 };

void camber_cl_tables_free(camber_cl_tables *t) {
    camber_free(t->context, t->images.held);
    camber_free(t->context, t->fill_images);
    camber_free(t->context, t->changes);
    camber_free(t->context, t->inputs);
    camber_free(t->context, t->brush_ext);
    camber_free(t->context, t->brushes);
    camber_free(t->context, t->rows);
}

/* Finds the number of a brush: of an equal brush from number `first` on, or of a new brush. The fill below it is the
 * last fill so far. */
static camber_status use_brush(camber_cl_tables *t, size_t first, const camber_brush *wanted,
                               const camber_brush_ext *brush_ext, uint32_t *number) {
    camber_brush brush = *wanted;
    brush.fill = t->fill;
    for (size_t i = t->brush_count; i > first && i + BRUSHES_BACK > t->brush_count; i--)
        if (memcmp(t->brushes + i - 1, &brush, sizeof brush) == 0 &&
            memcmp(t->brush_ext + i - 1, brush_ext, sizeof *brush_ext) == 0) {
            *number = (uint32_t)(i - 1);
            return CAMBER_OK;
        }
    if (!camber_grow(t->context, &t->brushes, &t->brush_capacity, t->brush_count + 1, sizeof *t->brushes) ||
        !camber_grow(t->context, &t->brush_ext, &t->ext_capacity, t->brush_count + 1, sizeof *t->brush_ext))
        return CAMBER_ERROR_MEMORY;
    *number = (uint32_t)t->brush_count;
    t->is_rich = t->is_rich || brush_ext->features || brush.mode == CAMBER_BRUSH_MASKED;
    t->brush_ext[t->brush_count] = *brush_ext;
    t->brushes[t->brush_count++] = brush;
    return CAMBER_OK;
}

/* ---- Lines and areas ---- */

static camber_status set_features(camber_cl_tables *t, const camber_draw_list *list, const camber_row_paint *paint,
                                  camber_brush_ext *brush_ext) {
    const unsigned features = paint->features;
    *brush_ext = (camber_brush_ext){.features = features};
    if (features & CAMBER_FEATURE_GAP)
        brush_ext->half_gap = paint->half_gap_px;
    if (features & CAMBER_FEATURE_BLUR)
        brush_ext->blur = paint->blur_px;
    if (features & CAMBER_FEATURE_TRIM) {
        brush_ext->trim_from = paint->trim[0];
        brush_ext->trim_to = paint->trim[1];
    }
    if (features & CAMBER_FEATURE_DASH) {
        brush_ext->first_dash = paint->dashes.first;
        brush_ext->dash_count = paint->dashes.count;
        brush_ext->round_dashes = paint->dashes.are_round;
        brush_ext->period = paint->dashes.period_px;
    }
    if (features & CAMBER_FEATURE_RAMP) {
        brush_ext->first_stop = paint->first_stop;
        brush_ext->stop_count = paint->stop_count;
    }
    return features & CAMBER_FEATURE_IMAGE
               ? camber_cl_images_add_line(&t->images, list->image_uses + paint->image_use, &brush_ext->image)
               : CAMBER_OK;
}

/* Returns a brush with the fields that all brushes of a command share. A union needs no layer, because its brush has
 * the opacity. */
static camber_brush brush_of_command(camber_cl_tables *t, const camber_draw_command *command) {
    camber_brush brush = {.mode = CAMBER_BRUSH_OVER, .group = command->group};
    if (command->group)
        brush.group_opacity = command->group_opacity;
    if (command->composite == CAMBER_COMPOSITE_UNION)
        brush.mode = CAMBER_BRUSH_UNION;
    if (command->composite == CAMBER_COMPOSITE_MASKED)
        brush.mode = CAMBER_BRUSH_MASKED;
    if (t->is_sum)
        brush.mode = CAMBER_BRUSH_SUM;
    if (command->composite != CAMBER_COMPOSITE_STRAIGHT && command->composite != CAMBER_COMPOSITE_UNION) {
        brush.layer = ++t->layers;
        brush.layer_opacity = command->layer_opacity;
    }
    return brush;
}

/* Finds the position of the words of a fill's image in the side table, which has each image's words once. The position
 * is never 0. */
static camber_status use_fill_image(camber_cl_tables *t, const camber_draw_list *list, int32_t fill, uint32_t *words) {
    bool is_opaque;
    camber_status status = CAMBER_OK;
    if (!t->fill_images)
        t->fill_images = camber_alloc_zero(t->context, list->fill_count, sizeof *t->fill_images);
    if (!t->fill_images)
        return CAMBER_ERROR_MEMORY;
    if (t->fill_images[fill] == 0)
        status = camber_cl_images_add_fill(&t->images, list, list->fills + fill, t->fill_images + fill, &is_opaque);
    *words = t->fill_images[fill];
    return status;
}

/* Adds the brush of a span of areas. No other span uses this brush, so the polygons of the span are united only with
 * each other. */
static camber_status add_area_brush(camber_cl_tables *t, const camber_draw_list *list,
                                    const camber_draw_command *command, int32_t fill, uint32_t *number) {
    const camber_fill_paint *paint = list->fills + fill;
    const camber_color c = paint->color;
    const bool evenodd = paint->rule == CAMBER_FILL_EVENODD;
    camber_brush brush = {.r = c.r, .g = c.g, .b = c.b, .a = c.a * command->layer_opacity, .group = command->group};
    camber_brush_ext brush_ext = {0};
    camber_status status = CAMBER_OK;
    brush.mode = evenodd ? CAMBER_BRUSH_AREA_EVENODD : CAMBER_BRUSH_AREA;
    if (command->group)
        brush.group_opacity = command->group_opacity;
    if (paint->has_image) {
        brush_ext.features = CAMBER_FEATURE_IMAGE;
        status = use_fill_image(t, list, fill, &brush_ext.image);
    }
    return status == CAMBER_OK ? use_brush(t, t->brush_count, &brush, &brush_ext, number) : status;
}

/* Adds the consecutive brushes of a command of polygons, and the polylines at which the brush changes. */
static camber_status add_area_brushes(camber_cl_tables *t, const camber_draw_list *list,
                                      const camber_draw_command *command, uint32_t *first) {
    const camber_area_span *spans = list->spans + command->first_span;
    camber_status status = add_area_brush(t, list, command, spans[0].fill, first);
    if (!camber_grow(t->context, &t->changes, &t->change_capacity, t->change_count + command->span_count,
                     sizeof *t->changes))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 1; i < command->span_count && status == CAMBER_OK; i++) {
        uint32_t next;
        t->changes[t->change_count++] = spans[i].first;
        status = add_area_brush(t, list, command, spans[i].fill, &next);
    }
    return status;
}

/* Adds the table of a command of polygons. */
static camber_status add_area_rows(camber_cl_tables *t, const camber_draw_list *list,
                                   const camber_draw_command *command) {
    const size_t count = command->mesh->row_count;
    uint32_t number = 0;
    if (!camber_grow(t->context, &t->rows, &t->row_capacity, t->row_count + count,
                     CAMBER_RASTER_ROW_WORDS * sizeof *t->rows))
        return CAMBER_ERROR_MEMORY;
    const camber_status status = add_area_brushes(t, list, command, &number);
    for (size_t i = 0; i < count && status == CAMBER_OK; i++) {
        const camber_row_paint *paint = list->rows + command->first_row + i;
        float *row = t->rows + CAMBER_RASTER_ROW_WORDS * t->row_count++;
        row[0] = camber_draw_command_alpha(command, paint) < 0.0f ? -1.0f : CAMBER_EDGE_PX;
        row[1] = paint->translate_px[0];
        row[2] = paint->translate_px[1];
        memcpy(row + 3, &number, sizeof number);
    }
    return status;
}

/* Adds the table of a command. Only the command's own brushes are reused for it. */
static camber_status add_rows(camber_cl_tables *t, const camber_draw_list *list, const camber_draw_command *command) {
    const size_t count = command->mesh->row_count, first_brush = t->brush_count;
    const bool is_united = command->composite == CAMBER_COMPOSITE_UNION;
    camber_brush brush = brush_of_command(t, command);
    camber_status status = CAMBER_OK;
    if (!camber_grow(t->context, &t->rows, &t->row_capacity, t->row_count + count,
                     CAMBER_RASTER_ROW_WORDS * sizeof *t->rows))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < count && status == CAMBER_OK; i++) {
        const camber_row_paint *paint = list->rows + command->first_row + i;
        const float alpha = camber_draw_command_alpha(command, paint);
        float *row = t->rows + CAMBER_RASTER_ROW_WORDS * t->row_count++;
        camber_brush_ext brush_ext;
        uint32_t number = 0;
        memset(row, 0, CAMBER_RASTER_ROW_WORDS * sizeof *row);
        row[0] = -1.0f;
        if (alpha < 0.0f)
            continue;
        brush.r = paint->color.r;
        brush.g = paint->color.g;
        brush.b = paint->color.b;
        brush.a = is_united ? command->layer_opacity : alpha;
        status = set_features(t, list, paint, &brush_ext);
        if (status == CAMBER_OK) /* in a sum, each row has a brush of its own */
            status = use_brush(t, list->is_sum ? t->brush_count : first_brush, &brush, &brush_ext, &number);
        row[0] = paint->half_width_px;
        row[1] = paint->translate_px[0];
        row[2] = paint->translate_px[1];
        memcpy(row + 3, &number, sizeof number);
    }
    return status;
}

static camber_status add_lines(camber_cl_tables *t, const camber_draw_list *list, const camber_draw_command *command) {
    const bool is_area = command->composite == CAMBER_COMPOSITE_AREA;
    const camber_raster_input input = {.mesh = command->mesh,
                                       .first = command->first,
                                       .end = command->end,
                                       .first_row = t->row_count,
                                       .is_area = is_area,
                                       .upright = command->upright,
                                       .first_change = t->change_count,
                                       .change_count = is_area ? command->span_count - 1 : 0};
    if (!camber_grow(t->context, &t->inputs, &t->input_capacity, t->input_count + 1, sizeof *t->inputs))
        return CAMBER_ERROR_MEMORY;
    t->inputs[t->input_count++] = input;
    return is_area ? add_area_rows(t, list, command) : add_rows(t, list, command);
}

/* ---- Fills ---- */

/* Removes everything below an opaque fill, which hides it. */
static void drop_hidden_inputs(camber_cl_tables *t) {
    t->input_count = 0;
    t->fill = 0;
    t->is_rich = false;
}

static void put_over(const float color[4], float below[4]) {
    for (int i = 0; i < 4; i++)
        below[i] = color[i] + (1.0f - color[3]) * below[i];
}

static camber_status add_fill(camber_cl_tables *t, const camber_draw_list *list, const camber_fill_paint *fill) {
    const camber_color c = fill->color;
    const float color[4] = {c.r * c.a, c.g * c.a, c.b * c.a, c.a};
    const camber_brush brush = {.r = c.r, .g = c.g, .b = c.b, .a = c.a, .mode = CAMBER_BRUSH_AREA};
    camber_brush_ext brush_ext = {0};
    bool is_opaque = true;
    if (fill->has_image) {
        brush_ext.features = CAMBER_FEATURE_IMAGE;
        const camber_status status = camber_cl_images_add_fill(&t->images, list, fill, &brush_ext.image, &is_opaque);
        if (status != CAMBER_OK)
            return status;
    } else {
        put_over(color, t->sky);
    }
    if (is_opaque && c.a >= 1.0f)
        drop_hidden_inputs(t);
    if (fill->has_image || t->input_count > 0 || t->fill > 0)
        return use_brush(t, t->brush_count, &brush, &brush_ext, &t->fill);
    put_over(color, t->background);
    return CAMBER_OK;
}

/* ---- The scene ---- */

static camber_status add_commands(camber_cl_tables *t, const camber_draw_list *list) {
    const camber_brush no_brush = {.mode = t->is_sum ? CAMBER_BRUSH_SUM : CAMBER_BRUSH_OVER};
    const camber_brush_ext no_more = {0};
    uint32_t number;
    camber_status status =
        use_brush(t, 0, &no_brush, &no_more, &number); /* there has to be a brush with which a tile begins */
    for (size_t i = 0; i < list->command_count && status == CAMBER_OK; i++) {
        const camber_draw_command *command = list->commands + i;
        status = command->mesh ? add_lines(t, list, command) : add_fill(t, list, &command->fill);
    }
    if (status == CAMBER_OK && !camber_grow(t->context, &t->rows, &t->row_capacity, t->row_count + 1,
                                            CAMBER_RASTER_ROW_WORDS * sizeof *t->rows))
        status = CAMBER_ERROR_MEMORY;
    if (status != CAMBER_OK)
        return status;
    memset(t->rows + CAMBER_RASTER_ROW_WORDS * t->row_count, 0, CAMBER_RASTER_ROW_WORDS * sizeof *t->rows);
    t->brushes[0].fill = t->fill;
    return CAMBER_OK;
}

static void set_view(const camber_plane_view *view, const float sky[4], camber_raster_scene *scene) {
    if (!view->pitched)
        return;
    scene->pitched = true;
    scene->eye = (camber_eye){view->eye[0], view->eye[1], view->eye[2], view->eye[3]};
    scene->horizon = view->horizon;
    memcpy(scene->sky, sky, sizeof scene->sky);
}

camber_status camber_cl_tables_make(camber_draw_list *list, const camber_frame *frame, camber_cl_tables *tables) {
    const camber_color back = frame->background;
    camber_cl_tables *t = tables;
    *t = (camber_cl_tables){.context = list->context,
                            .is_sum = list->is_sum,
                            .images = {.table = &list->side_table, .nearest = list->view.nearest},
                            .layers = list->group_count, /* layers and groups have numbers of their own */
                            .background = {back.r * back.a, back.g * back.a, back.b * back.a, back.a}};
    memcpy(t->sky, t->background, sizeof t->sky);
    const camber_status status = add_commands(t, list);
    t->scene = (camber_raster_scene){
        .rows = t->rows,
        .row_count = t->row_count + 1,
        .brushes = t->brushes,
        .brush_count = t->brush_count,
        .inputs = t->inputs,
        .input_count = t->input_count,
        .changes = t->changes,
        .background = {t->background[0], t->background[1], t->background[2], t->background[3]},
        .linear = frame->coverage == CAMBER_COVERAGE_LINEAR,
        .brush_ext = t->is_rich || list->view.pitched ? t->brush_ext : NULL,
        .side_table = list->side_table.texels,
        .side_table_count = list->side_table.count,
    };
    set_view(&list->view, t->sky, &t->scene);
    return status;
}
