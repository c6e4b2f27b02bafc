/* The tiles that labels touch.
 *
 * Input: an engine's features and fonts. Output: the labels of a zoom, and bits of tiles. Main idea: a label belongs to
 * every tile that it touches, even if no line does, so that it is not cut at a tile's edge. */
#include "tiles/engine.h"

#include "archive/pmtiles.h"
#include "features/features.h"

#include <math.h>

/* An engine for archives places labels in blocks of about this many things: fewer take more time, since more of them
 * are placed twice. An engine that draws on demand places a metatile at a time, which takes the least time for the
 * first. */
enum { BLOCK_THINGS = 1 << 16 };
/* The memory that the blocks of all zooms may take before old ones are dropped. */
static const size_t KEPT_BYTES = (size_t)24 << 20;

camber_status camber_engine_get_labels(camber_tiles_engine *engine, int zoom, camber_zoom_labels **labels) {
    camber_engine_zoom *it = engine->zooms + zoom;
    camber_status status = CAMBER_OK;
    *labels = it->labels;
    if (!engine->features->fonts || engine->desc.meshes || it->labels)
        return CAMBER_OK;
    if (!engine->things.context)
        status = camber_label_things_find(engine->features, NULL, &engine->things);
    if (status != CAMBER_OK) {
        camber_label_things_free(&engine->things);
        return status;
    }
    const bool on_demand = engine->desc.on_demand_side > 0;
    engine->shelf.limit_bytes = KEPT_BYTES;
    const camber_zoom_labels_desc desc = {.features = engine->features,
                                          .things = &engine->things,
                                          .shelf = &engine->shelf,
                                          .zoom = it->plan->view.zoom,
                                          .least_importance = (double)it->plan->least_importance,
                                          .finest_level = camber_metatile_level(zoom, camber_engine_side(engine, zoom)),
                                          .block_things = on_demand ? 0 : BLOCK_THINGS};
    status = camber_zoom_labels_create(&desc, &it->labels);
    *labels = it->labels;
    return status;
}

camber_label_square camber_engine_square(const camber_tiles_engine *engine, int zoom, uint32_t column, uint32_t row) {
    return (camber_label_square){camber_metatile_level(zoom, camber_engine_side(engine, zoom)), column, row};
}

/* ---- Marking ---- */

/* Tiles as labels touch them. */
typedef struct touched_list {
    camber_context *context;
    int zoom;
    uint32_t side;
    camber_touched_tiles *items; /* count of them, all different */
    size_t count, capacity;
    uint32_t *slots; /* numbers + 1 by hash; 0: free. slot_count is a power of two */
    size_t slot_count;
} touched_list;

static size_t slot_of(const touched_list *list, uint32_t column, uint32_t row) {
    size_t at = (size_t)camber_mix(0, (uint64_t)row << 32 | column) & (list->slot_count - 1);
    while (list->slots[at] &&
           (list->items[list->slots[at] - 1].column != column || list->items[list->slots[at] - 1].row != row))
        at = (at + 1) & (list->slot_count - 1);
    return at;
}

static bool widen(touched_list *list) {
    if (list->slot_count > 2 * (list->count + 1))
        return true;
    const size_t count = list->slot_count ? 4 * list->slot_count : 256;
    uint32_t *slots = camber_alloc_zero(list->context, count, sizeof *slots);
    if (!slots)
        return false;
    camber_free(list->context, list->slots);
    list->slots = slots;
    list->slot_count = count;
    for (size_t i = 0; i < list->count; i++)
        slots[slot_of(list, list->items[i].column, list->items[i].row)] = (uint32_t)i + 1;
    return true;
}

static bool touch_tile(touched_list *list, uint32_t column, uint32_t row) {
    const uint32_t side = list->side;
    if (!widen(list))
        return false;
    const size_t slot = slot_of(list, column / side, row / side);
    if (!list->slots[slot]) {
        if (!camber_grow(list->context, &list->items, &list->capacity, list->count + 1, sizeof *list->items))
            return false;
        list->items[list->count] = (camber_touched_tiles){.column = column / side, .row = row / side};
        list->slots[slot] = (uint32_t)++list->count;
    }
    list->items[list->slots[slot] - 1].tiles |= UINT64_C(1) << (row % side * side + column % side);
    return true;
}

/* Marks the tiles of a block that a label touches. */
static camber_status touch(void *user, const camber_label_square *block, const camber_shown_label *label) {
    touched_list *list = user;
    const double tiles = exp2(list->zoom), size = exp2(list->zoom - block->level);
    const double first[2] = {block->column * size, block->row * size};
    const double x0 = fmax(floor(label->box.x0 * tiles), first[0]), y0 = fmax(floor(label->box.y0 * tiles), first[1]);
    const double x1 = fmin(ceil(label->box.x1 * tiles), first[0] + size);
    const double y1 = fmin(ceil(label->box.y1 * tiles), first[1] + size);
    for (double y = y0; y < y1; y += 1.0)
        for (double x = x0; x < x1; x += 1.0)
            if (!touch_tile(list, (uint32_t)x, (uint32_t)y))
                return CAMBER_ERROR_MEMORY;
    return CAMBER_OK;
}

static void free_list(touched_list *list) {
    camber_free(list->context, list->items);
    camber_free(list->context, list->slots);
}

camber_status camber_engine_find_label_tiles(camber_tiles_engine *engine, int zoom, uint32_t column, uint32_t row,
                                             uint64_t *tiles) {
    const uint32_t side = camber_engine_side(engine, zoom);
    const double size = side / exp2(zoom), inside = 1e-3 * size;
    const camber_box area = {column * size + inside, row * size + inside, (column + 1) * size - inside,
                             (row + 1) * size - inside};
    touched_list list = {.context = engine->context, .zoom = zoom, .side = side};
    camber_zoom_labels *labels;
    *tiles = 0;
    camber_status status = camber_engine_get_labels(engine, zoom, &labels);
    if (status == CAMBER_OK && labels)
        status = camber_zoom_labels_list(labels, &area, touch, &list);
    for (size_t i = 0; i < list.count && status == CAMBER_OK; i++)
        if (list.items[i].column == column && list.items[i].row == row)
            *tiles = list.items[i].tiles;
    free_list(&list);
    return status;
}

/* ---- Areas ---- */

/* Lists the labels in the metatiles of listed tiles, which are consecutive if they are in one metatile. */
static camber_status list_metatiles(camber_zoom_labels *labels, const camber_tiles_area *area, touched_list *list) {
    const uint64_t first = camber_pmtiles_number(list->zoom, 0, 0), end = camber_pmtiles_number(list->zoom + 1, 0, 0);
    const double size = list->side / exp2(list->zoom), inside = 1e-3 * size;
    camber_status status = CAMBER_OK;
    uint64_t before = UINT64_MAX;
    for (size_t i = 0; i < area->tile_count && status == CAMBER_OK; i++) {
        uint32_t column, row;
        if (area->tiles[i] < first || area->tiles[i] >= end)
            continue;
        camber_pmtiles_locate(area->tiles[i] - first, list->zoom, &column, &row);
        column /= list->side;
        row /= list->side;
        if (((uint64_t)row << 32 | column) == before)
            continue;
        before = (uint64_t)row << 32 | column;
        const camber_box box = {column * size + inside, row * size + inside, (column + 1) * size - inside,
                                (row + 1) * size - inside};
        status = camber_zoom_labels_list(labels, &box, touch, list);
    }
    return status;
}

camber_status camber_engine_add_label_tiles(camber_tiles_engine *engine, int zoom, const camber_tiles_area *area) {
    touched_list list = {.context = engine->context, .zoom = zoom, .side = camber_engine_side(engine, zoom)};
    camber_zoom_labels *labels;
    const double start_ms = camber_now_ms();
    camber_status status = camber_engine_get_labels(engine, zoom, &labels);
    if (status == CAMBER_OK && labels)
        status = area->tiles ? list_metatiles(labels, area, &list)
                             : camber_zoom_labels_list(labels, &area->box, touch, &list);
    if (status == CAMBER_OK && list.count)
        status = camber_census_touch(&engine->zooms[zoom].census, list.items, list.count);
    free_list(&list);
    engine->census_ms += camber_now_ms() - start_ms;
    return status;
}
