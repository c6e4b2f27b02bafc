/* Lists which records of which parts are drawn. Device and twin both begin with this list. */
#include "raster/raster.h"

#define BUTT_CAP                                                                                                       \
    ((uint32_t)CAMBER_KIND_CAP << CAMBER_JOIN_KIND_SHIFT | (uint32_t)CAMBER_END_BUTT << CAMBER_JOIN_END_SHIFT)

/* A line that covers every tile. A fill is drawn as this line, in its order among the segments. */
const camber_record camber_fill_records[CAMBER_FILL_RECORDS] = {
    {-CAMBER_FILL_PX, 0.0f, BUTT_CAP, CAMBER_POINT_REAL | CAMBER_POINT_FIRST},
    {CAMBER_FILL_PX, 0.0f, BUTT_CAP, CAMBER_POINT_REAL | CAMBER_POINT_LAST},
};

/* How many records of a part lie before a polyline's. A strip has two indices for each record, kite and fan a record
 * for each slot. */
static camber_status first_record(const camber_mesh *mesh, const camber_mesh_part *part, size_t polyline,
                                  size_t *record) {
    uint64_t index = 0;
    *record = 0;
    if (polyline == part->first_polyline)
        return CAMBER_OK;
    *record = part->record_count;
    if (polyline == part->first_polyline + part->polyline_count) /* also for a part that has not been made */
        return CAMBER_OK;
    if (!mesh->mesh_info.strips)
        return camber_part_slot(mesh, part, polyline, record);
    const camber_status status = camber_part_first_index(mesh, part, polyline, &index);
    *record = (size_t)index / 2;
    return status;
}

static camber_status find_range(const camber_raster_input *input, size_t which, camber_record_range *range) {
    camber_mesh_part *part = input->mesh->parts + which;
    const size_t end = part->first_polyline + part->polyline_count;
    const size_t from = input->first > part->first_polyline ? input->first : part->first_polyline;
    const size_t to = input->end < end ? input->end : end;
    *range = (camber_record_range){
        .mesh = input->mesh, .part = which, .first_row = input->first_row, .is_area = input->is_area};
    if (from >= to || part->index_count == 0)
        return CAMBER_OK;
    const bool whole = from == part->first_polyline && to == end;
    camber_status status = whole ? CAMBER_OK : camber_part_ensure_made(input->mesh, part);
    if (status == CAMBER_OK)
        status = first_record(input->mesh, part, from, &range->first);
    if (status == CAMBER_OK)
        status = first_record(input->mesh, part, to, &range->end);
    return status;
}

/* The ranges that are listed so far. */
typedef struct range_list {
    camber_context *context;
    camber_record_range *ranges;
    size_t count, capacity, segments;
} range_list;

static camber_status add_range(range_list *list, camber_record_range range) {
    if (!camber_grow(list->context, &list->ranges, &list->capacity, list->count + 1, sizeof *list->ranges))
        return CAMBER_ERROR_MEMORY;
    range.base = list->segments;
    list->segments += (range.end - range.first + 15) / 16 * 16;
    list->ranges[list->count++] = range;
    return CAMBER_OK;
}

static camber_status add_input(range_list *list, const camber_raster_input *input) {
    camber_status status = CAMBER_OK;
    if (!input->mesh)
        return add_range(list, (camber_record_range){.end = CAMBER_FILL_RECORDS, .first_row = input->first_row});
    for (size_t i = 0; i < input->mesh->part_count && status == CAMBER_OK; i++) {
        camber_record_range range;
        status = find_range(input, i, &range);
        if (status == CAMBER_OK && range.first < range.end)
            status = add_range(list, range);
    }
    return status;
}

camber_status camber_raster_list_ranges(camber_context *context, const camber_raster_scene *scene,
                                        camber_record_range **ranges, size_t *range_count, size_t *segment_count) {
    range_list list = {.context = context};
    camber_status status = CAMBER_OK;
    for (size_t r = 0; r < scene->input_count && status == CAMBER_OK; r++)
        status = add_input(&list, scene->inputs + r);
    if (status != CAMBER_OK) {
        camber_free(context, list.ranges);
        return status;
    }
    *ranges = list.ranges;
    *range_count = list.count;
    *segment_count = list.segments;
    return CAMBER_OK;
}

void camber_raster_find_edges(const camber_record_range *ranges, size_t range_count, size_t *first, size_t *end) {
    *first = *end = 0;
    for (size_t i = 0; i < range_count; i++) {
        if (!ranges[i].is_area)
            continue;
        *first = *end == 0 ? ranges[i].base : *first;
        *end = ranges[i].base + ranges[i].end - ranges[i].first;
    }
}

unsigned camber_raster_variant(const camber_raster_scene *scene) {
    return (scene->brush_ext ? CAMBER_RASTER_RICH : 0u) | (scene->pitched ? CAMBER_RASTER_PITCHED : 0u);
}

camber_setup_args camber_raster_setup_args(const camber_raster_scene *scene, const camber_record_range *range,
                                           const camber_raster_area *area) {
    const camber_mesh *mesh = range->mesh;
    const camber_mesh_part *part = mesh ? mesh->parts + range->part : NULL;
    const bool strips = !mesh || mesh->mesh_info.strips;
    return (camber_setup_args){
        .first = (uint32_t)range->first,
        .end = (uint32_t)range->end,
        .record_count = (uint32_t)(!mesh    ? CAMBER_FILL_RECORDS
                                   : strips ? part->record_count
                                            : part->slot_count),
        .stride = mesh && mesh->mesh_info.has_arc_length ? 2 : 1,
        .strips = strips,
        .linear = scene->linear,
        .base = (uint32_t)range->base,
        .first_row = (uint32_t)range->first_row,
        .left = (float)area->x,
        .top = (float)area->y,
        .columns = camber_raster_tiles(area->width),
        .rows = camber_raster_tiles(area->height),
        .horizon = (float)scene->horizon,
        .eye = scene->eye,
    };
}

void camber_raster_stages_free(camber_context *context, camber_raster_stages *stages) {
    camber_free(context, stages->segments);
    camber_free(context, stages->boxes);
    camber_free(context, stages->arc_lengths);
    camber_free(context, stages->planes);
    camber_free(context, stages->starts);
    camber_free(context, stages->lists);
    camber_free(context, stages->rgba);
    *stages = (camber_raster_stages){0};
}
