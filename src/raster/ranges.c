/* Lists which slots of which parts are drawn. The device and the twin both start from this list. */
#include "raster/raster.h"

#include <stdlib.h>
#include <string.h>

static camber_status add_range(camber_range_list *list, camber_slot_range range) {
    if (!camber_grow(list->context, &list->ranges, &list->capacity, list->count + 1, sizeof *list->ranges))
        return CAMBER_ERROR_MEMORY;
    range.base = list->segment_count;
    list->segment_count += (range.end - range.first + 15) / 16 * 16;
    list->ranges[list->count++] = range;
    if (!range.is_area)
        return CAMBER_OK;
    list->first_edge = list->end_edge == 0 ? range.base : list->first_edge;
    list->end_edge = range.base + range.end - range.first;
    return CAMBER_OK;
}

/* Lists the slots at which the brush changes within a range. polylines is NULL if the brush does not change. */
static camber_status add_changes(camber_range_list *list, const camber_slot_range *range, const size_t *polylines) {
    camber_status status = CAMBER_OK;
    if (!polylines)
        return CAMBER_OK;
    if (!camber_grow(list->context, &list->changes, &list->change_capacity, list->change_count + range->change_count,
                     sizeof *list->changes))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < range->change_count && status == CAMBER_OK; i++) {
        size_t slot = 0;
        status = camber_slot_finder_find(&list->finder, polylines[i], &slot);
        list->changes[list->change_count++] = (uint32_t)slot;
    }
    return status;
}

/* Adds the polylines [from, to) of a part. range has the fields that are already known; polylines says where the brush
 * changes within it. */
static camber_status add_polylines(camber_range_list *list, camber_slot_range range, size_t from, size_t to,
                                   const size_t *polylines) {
    camber_mesh_part *part = range.mesh->parts + range.part;
    const bool whole = from == part->first_polyline && to == part->first_polyline + part->polyline_count;
    if (list->finder.part != part) {
        camber_slot_finder_close(&list->finder); /* its part may have to be evicted */
        list->finder = (camber_slot_finder){.mesh = range.mesh, .part = part};
    }
    camber_status status = whole && range.change_count == 0 ? CAMBER_OK : camber_part_ensure_made(range.mesh, part);
    if (status == CAMBER_OK)
        status = camber_slot_finder_find(&list->finder, from, &range.first);
    if (status == CAMBER_OK)
        status = camber_slot_finder_find(&list->finder, to, &range.end);
    if (status != CAMBER_OK || range.first >= range.end)
        return status;
    status = add_changes(list, &range, polylines);
    return status == CAMBER_OK ? add_range(list, range) : status;
}

static camber_status add_input(camber_range_list *list, const camber_raster_scene *scene,
                               const camber_raster_input *input) {
    const size_t *changes = input->change_count ? scene->changes + input->first_change : NULL;
    size_t change = 0;
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < input->mesh->part_count && status == CAMBER_OK; i++) {
        const camber_mesh_part *part = input->mesh->parts + i;
        const size_t end = part->first_polyline + part->polyline_count;
        const size_t from = input->first > part->first_polyline ? input->first : part->first_polyline;
        const size_t to = input->end < end ? input->end : end;
        if (from >= to || part->slot_count == 0)
            continue;
        while (change < input->change_count && changes[change] <= from)
            change++;
        const size_t before = change;
        while (change < input->change_count && changes[change] < to)
            change++;
        const camber_slot_range range = {.mesh = input->mesh,
                                         .part = i,
                                         .first_row = input->first_row,
                                         .is_area = input->is_area,
                                         .upright = input->upright,
                                         .first_change = list->change_count,
                                         .change_count = change - before,
                                         .changes_before = before};
        status = add_polylines(list, range, from, to, range.change_count ? changes + before : NULL);
    }
    return status;
}

/* Orders ranges by part, and the ranges of one part by drawing order. */
static int compare_ranges(const void *left, const void *right) {
    const camber_slot_range *a = left, *b = right;
    const uintptr_t meshes[2] = {(uintptr_t)a->mesh, (uintptr_t)b->mesh};
    if (meshes[0] != meshes[1])
        return meshes[0] < meshes[1] ? -1 : 1;
    if (a->part != b->part)
        return a->part < b->part ? -1 : 1;
    return a->base < b->base ? -1 : a->base > b->base;
}

camber_status camber_raster_list_ranges(camber_context *context, const camber_raster_scene *scene,
                                        camber_range_list *list) {
    camber_status status = CAMBER_OK;
    *list = (camber_range_list){.context = context};
    for (size_t r = 0; r < scene->input_count && status == CAMBER_OK; r++)
        status = add_input(list, scene, scene->inputs + r);
    camber_slot_finder_close(&list->finder);
    for (size_t i = 0; i < list->count; i++)
        list->ranges[i].among_edges = list->ranges[i].base >= list->first_edge && list->ranges[i].base < list->end_edge;
    if (list->count > 1)
        qsort(list->ranges, list->count, sizeof *list->ranges, compare_ranges);
    return status;
}

void camber_raster_free_ranges(camber_range_list *list) {
    camber_free(list->context, list->changes);
    camber_free(list->context, list->ranges);
}

unsigned camber_raster_variant(const camber_raster_scene *scene) {
    return (scene->brush_ext ? CAMBER_RASTER_RICH : 0u) | (scene->pitched ? CAMBER_RASTER_PITCHED : 0u);
}

camber_setup_args camber_raster_setup_args(const camber_raster_scene *scene, const camber_slot_range *range,
                                           const camber_raster_area *area) {
    const camber_mesh *mesh = range->mesh;
    camber_eye eye = scene->eye;
    if (range->upright && scene->pitched)
        eye = camber_eye_upright(eye);
    return (camber_setup_args){
        .first = (uint32_t)range->first,
        .end = (uint32_t)range->end,
        .slot_count = (uint32_t)mesh->parts[range->part].slot_count,
        .has_arc_length = mesh->mesh_info.has_arc_length,
        .linear = scene->linear,
        .makes_edges = range->is_area,
        .among_edges = range->among_edges,
        .base = (uint32_t)range->base,
        .first_row = (uint32_t)range->first_row,
        .left = (float)area->x,
        .top = (float)area->y,
        .columns = camber_raster_tiles(area->width),
        .rows = camber_raster_tiles(area->height),
        .horizon = (float)scene->horizon,
        .eye = eye,
        .first_change = (uint32_t)range->first_change,
        .change_count = (uint32_t)range->change_count,
        .changes_before = (uint32_t)range->changes_before,
    };
}

void camber_raster_stages_show_edges(camber_context *context, camber_raster_stages *stages, size_t first_edge,
                                     size_t end_edge) {
    for (size_t i = first_edge; i < end_edge && i < stages->segment_count; i++) {
        const bool is_drawn = CAMBER_BOX_FIRST_X(stages->boxes[i]) <= CAMBER_BOX_LAST_X(stages->boxes[i]);
        const float *brush = stages->edges + camber_edge_brush(i);
        float *words = stages->segments + CAMBER_SEGMENT_WORDS * i;
        if (!is_drawn || camber_bits_of(*brush) == CAMBER_NO_EDGE)
            continue;
        memset(words, 0, CAMBER_SEGMENT_WORDS * sizeof *words);
        memcpy(words, stages->edges + camber_edge_ends(i), 4 * sizeof *words);
        words[CAMBER_SEGMENT_BRUSH] = *brush;
        if (stages->arc_lengths)
            memset(stages->arc_lengths + CAMBER_SEGMENT_ARC_LENGTHS * i, 0,
                   CAMBER_SEGMENT_ARC_LENGTHS * sizeof *stages->arc_lengths);
        if (stages->planes)
            memset(stages->planes + CAMBER_PLANE_WORDS * i, 0, CAMBER_PLANE_WORDS * sizeof *stages->planes);
    }
    camber_free(context, stages->edges);
    stages->edges = NULL;
}

void camber_raster_stages_free(camber_context *context, camber_raster_stages *stages) {
    camber_free(context, stages->segments);
    camber_free(context, stages->edges);
    camber_free(context, stages->boxes);
    camber_free(context, stages->arc_lengths);
    camber_free(context, stages->planes);
    camber_free(context, stages->starts);
    camber_free(context, stages->lists);
    camber_free(context, stages->rgba);
    *stages = (camber_raster_stages){0};
}
