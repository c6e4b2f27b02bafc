/* Checks a map's areas. Input: the map's rings and lines, and the frame that draws them. The frame is drawn as it is,
 * and each layer of areas by itself, with its rings as one path. */
#include "validate/checks.h"

#include <stdio.h>
#include <stdlib.h>

/* The rings of one pass, as polylines of their own. All of them are filled. */
typedef struct area_layer {
    uint32_t *offsets;
    float *points;
    size_t ring_count, point_count;
} area_layer;

static bool is_filled(const camber_subject *s, const camber_pass *pass, size_t polyline) {
    const size_t row = s->rows ? s->rows[polyline] : 0;
    return row < pass->paint_count && pass->paints[row].fill;
}

/* Takes the filled polylines of a pass, which may also draw outlines. Returns false if memory is exhausted. */
static bool take_layer(const camber_subject *s, const camber_pass *pass, area_layer *made) {
    const uint32_t *offsets = s->lines.offsets;
    const size_t first = pass->first_polyline, end = first + pass->polyline_count;
    *made = (area_layer){.offsets = calloc(pass->polyline_count + 1, sizeof *made->offsets),
                         .points = malloc((offsets[end] - offsets[first] + 1) * 2 * sizeof *made->points)};
    if (!made->offsets || !made->points)
        return false;
    for (size_t i = first; i < end; i++) {
        if (!is_filled(s, pass, i))
            continue;
        for (size_t k = 2 * (size_t)offsets[i]; k < 2 * (size_t)offsets[i + 1]; k++)
            made->points[2 * made->point_count + k - 2 * (size_t)offsets[i]] = s->lines.points[k];
        made->point_count += offsets[i + 1] - offsets[i];
        made->offsets[++made->ring_count] = (uint32_t)made->point_count;
    }
    return true;
}

static camber_status check_layer(camber_validation *v, const camber_subject *of, const area_layer *layer,
                                 size_t number) {
    static const camber_stroke stroke;
    char name[256];
    const camber_polylines_desc desc = {.points = layer->points,
                                        .point_count = layer->point_count,
                                        .offsets = layer->offsets,
                                        .polyline_count = layer->ring_count,
                                        .keep_open = true};
    camber_polylines *rings = NULL;
    camber_status status = camber_polylines_create(v->desc->context, &desc, &rings);
    snprintf(name, sizeof name, "%s: layer %zu of areas", of->name, number);
    const camber_subject s = {.name = name,
                              .lines = {.points = layer->points,
                                        .offsets = layer->offsets,
                                        .point_count = layer->point_count,
                                        .polyline_count = layer->ring_count},
                              .keep_open = true,
                              .polylines = rings,
                              .strokes = &stroke,
                              .drawn_strokes = &stroke,
                              .stroke_count = 1,
                              .fills = true,
                              .width = of->width,
                              .height = of->height};
    if (status == CAMBER_OK)
        status = camber_check_pixels(v, &s);
    camber_polylines_destroy(rings);
    return status;
}

camber_status camber_check_areas(camber_validation *v, const camber_subject *s, const camber_frame *frame) {
    camber_status status = camber_check_frame(v, s, frame);
    for (size_t i = 0, number = 0; i < frame->pass_count && status == CAMBER_OK; i++) {
        area_layer layer = {0};
        if (frame->passes[i].kind != CAMBER_PASS_LINES)
            continue;
        if (!take_layer(s, frame->passes + i, &layer))
            status = CAMBER_ERROR_MEMORY;
        else if (layer.ring_count)
            status = check_layer(v, s, &layer, ++number);
        free(layer.points);
        free(layer.offsets);
    }
    return status;
}
