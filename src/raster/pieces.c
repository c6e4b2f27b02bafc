/* Which records of which parts are drawn: what the device and the twin both begin with. */
#include "raster/raster.h"

#define BUTT_CAP                                                                                                       \
    ((uint32_t)CAMBER_KIND_CAP << CAMBER_JOIN_KIND_SHIFT | (uint32_t)CAMBER_END_BUTT << CAMBER_JOIN_END_SHIFT)

/* A line that no tile is beside: fills are drawn in their place among segments, by what draws these. */
const camber_record camber_fill_records[CAMBER_FILL_RECORDS] = {
    {-CAMBER_FILL_PX, 0.0f, BUTT_CAP, CAMBER_POINT_REAL | CAMBER_POINT_FIRST},
    {CAMBER_FILL_PX, 0.0f, BUTT_CAP, CAMBER_POINT_REAL | CAMBER_POINT_LAST},
};

/* Records of a part's polylines before one. A strip has two indices a record; kite and fan a record a slot. */
static camber_status first_record(const camber_mesh *mesh, const camber_mesh_part *part, size_t polyline,
                                  size_t *record) {
    uint64_t index = 0;
    *record = 0;
    if (polyline == part->first_polyline)
        return CAMBER_OK;
    *record = part->record_count;
    if (polyline == part->first_polyline + part->polyline_count) /* of a part that is not there, too */
        return CAMBER_OK;
    if (!mesh->mesh_info.strips)
        return camber_part_slot(mesh, part, polyline, record);
    const camber_status status = camber_part_first_index(mesh, part, polyline, &index);
    *record = (size_t)index / 2;
    return status;
}

static camber_status find_piece(const camber_cover_run *run, size_t which, camber_cover_piece *piece) {
    camber_mesh_part *part = run->mesh->parts + which;
    const size_t end = part->first_polyline + part->polyline_count;
    const size_t from = run->first > part->first_polyline ? run->first : part->first_polyline;
    const size_t to = run->end < end ? run->end : end;
    *piece = (camber_cover_piece){.mesh = run->mesh, .part = which, .first_row = run->first_row};
    if (from >= to || part->index_count == 0)
        return CAMBER_OK;
    const bool whole = from == part->first_polyline && to == end;
    camber_status status = whole ? CAMBER_OK : camber_part_ensure_made(run->mesh, part);
    if (status == CAMBER_OK)
        status = first_record(run->mesh, part, from, &piece->first);
    if (status == CAMBER_OK)
        status = first_record(run->mesh, part, to, &piece->end);
    return status;
}

/* What is listed so far. */
typedef struct piece_list {
    camber_context *context;
    camber_cover_piece *pieces;
    size_t count, capacity, shapes;
} piece_list;

static camber_status add_piece(piece_list *list, camber_cover_piece piece) {
    if (!camber_grow(list->context, &list->pieces, &list->capacity, list->count + 1, sizeof *list->pieces))
        return CAMBER_ERROR_MEMORY;
    piece.base = list->shapes;
    list->shapes += (piece.end - piece.first + 15) / 16 * 16;
    list->pieces[list->count++] = piece;
    return CAMBER_OK;
}

static camber_status add_run(piece_list *list, const camber_cover_run *run) {
    camber_status status = CAMBER_OK;
    if (!run->mesh)
        return add_piece(list, (camber_cover_piece){.end = CAMBER_FILL_RECORDS, .first_row = run->first_row});
    for (size_t i = 0; i < run->mesh->part_count && status == CAMBER_OK; i++) {
        camber_cover_piece piece;
        status = find_piece(run, i, &piece);
        if (status == CAMBER_OK && piece.first < piece.end)
            status = add_piece(list, piece);
    }
    return status;
}

camber_status camber_cover_list_pieces(camber_context *context, const camber_cover_scene *scene,
                                       camber_cover_piece **pieces, size_t *piece_count, size_t *shape_count) {
    piece_list list = {.context = context};
    camber_status status = CAMBER_OK;
    for (size_t r = 0; r < scene->run_count && status == CAMBER_OK; r++)
        status = add_run(&list, scene->runs + r);
    if (status != CAMBER_OK) {
        camber_free(context, list.pieces);
        return status;
    }
    *pieces = list.pieces;
    *piece_count = list.count;
    *shape_count = list.shapes;
    return CAMBER_OK;
}

unsigned camber_cover_variant(const camber_cover_scene *scene) {
    return (scene->more ? CAMBER_COVER_RICH : 0u) | (scene->pitched ? CAMBER_COVER_PITCHED : 0u);
}

camber_shape_range camber_cover_range(const camber_cover_scene *scene, const camber_cover_piece *piece,
                                      const camber_cover_area *area) {
    const camber_mesh *mesh = piece->mesh;
    const camber_mesh_part *part = mesh ? mesh->parts + piece->part : NULL;
    const bool strips = !mesh || mesh->mesh_info.strips;
    return (camber_shape_range){
        .first = (uint32_t)piece->first,
        .end = (uint32_t)piece->end,
        .record_count = (uint32_t)(!mesh    ? CAMBER_FILL_RECORDS
                                   : strips ? part->record_count
                                            : part->slot_count),
        .stride = mesh && mesh->mesh_info.measured ? 2 : 1,
        .strips = strips,
        .linear = scene->linear,
        .base = (uint32_t)piece->base,
        .first_row = (uint32_t)piece->first_row,
        .left = (float)area->x,
        .top = (float)area->y,
        .columns = camber_cover_tiles(area->width),
        .rows = camber_cover_tiles(area->height),
        .horizon = (float)scene->horizon,
        .eye = scene->eye,
    };
}

void camber_cover_stages_free(camber_context *context, camber_cover_stages *stages) {
    camber_free(context, stages->shapes);
    camber_free(context, stages->boxes);
    camber_free(context, stages->measures);
    camber_free(context, stages->planes);
    camber_free(context, stages->starts);
    camber_free(context, stages->lists);
    camber_free(context, stages->rgba);
    *stages = (camber_cover_stages){0};
}
