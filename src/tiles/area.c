/* The area of a run. A tile is wanted if it overlaps the box, touches the region, or is in the list. */
#include "tiles/area.h"

#include "archive/archive.h"
#include "archive/pmtiles.h"
#include "features/features.h"
#include "features/mercator.h"

#include <math.h>
#include <stdlib.h>

static const camber_box WORLD = {0.0, 0.0, 1.0, 1.0};

static double bound(double value) {
    return fmin(fmax(value, 0.0), 1.0);
}

/* Converts west, south, east, north in degrees into a box, which crosses the antimeridian if east is less than west. */
static camber_box box_of(const double bbox[4]) {
    const double most = CAMBER_MERCATOR_LATITUDE;
    double x[2], y[2];
    camber_mercator_project(bbox[0], fmin(fmax(bbox[3], -most), most), &x[0], &y[0]);
    camber_mercator_project(bbox[2], fmin(fmax(bbox[1], -most), most), &x[1], &y[1]);
    return (camber_box){x[0], bound(y[0]), x[1] > x[0] ? x[1] : x[1] + 1.0, bound(y[1])};
}

static camber_status take_box(camber_context *context, const double bbox[4], camber_box *box) {
    for (int i = 0; i < 4; i++)
        if (!(fabs(bbox[i]) <= (i % 2 ? 90.0 : 180.0)))
            return camber_fail(context, CAMBER_ERROR_ARGUMENT, "tiles: %g in a bbox; give west, south, east, north",
                               bbox[i]);
    if (!(bbox[1] < bbox[3]) || bbox[0] == bbox[2])
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "tiles: the bbox %g,%g,%g,%g has no area; give west, south, east, north", bbox[0], bbox[1],
                           bbox[2], bbox[3]);
    *box = box_of(bbox);
    return CAMBER_OK;
}

/* ---- Lists ---- */

static int compare_numbers(const void *left, const void *right) {
    const uint64_t a = *(const uint64_t *)left, b = *(const uint64_t *)right;
    return a < b ? -1 : a > b;
}

static camber_status take_list(camber_context *context, const camber_tiles_draw_desc *desc, camber_tiles_area *area) {
    area->tiles = camber_alloc(context, desc->tile_count, sizeof *area->tiles);
    if (!area->tiles)
        return CAMBER_ERROR_MEMORY;
    area->min_zoom = CAMBER_LARGEST_TILE_ZOOM;
    area->max_zoom = 0;
    for (size_t i = 0; i < desc->tile_count; i++) {
        const camber_tiles_place *place = desc->tiles + i;
        const uint64_t most = place->zoom >= 0 && place->zoom < 32 ? UINT64_C(1) << place->zoom : 0;
        if (place->zoom < 0 || place->zoom > CAMBER_LARGEST_TILE_ZOOM || place->column >= most || place->row >= most)
            return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                               "tiles: there is no tile %d/%u/%u; zooms are 0 to %d, with 2^zoom columns and rows",
                               place->zoom, place->column, place->row, CAMBER_LARGEST_TILE_ZOOM);
        area->tiles[area->tile_count++] = camber_pmtiles_number(place->zoom, place->column, place->row);
        area->min_zoom = place->zoom < area->min_zoom ? place->zoom : area->min_zoom;
        area->max_zoom = place->zoom > area->max_zoom ? place->zoom : area->max_zoom;
    }
    qsort(area->tiles, area->tile_count, sizeof *area->tiles, compare_numbers);
    size_t count = 0;
    for (size_t i = 0; i < area->tile_count; i++)
        if (count == 0 || area->tiles[i] != area->tiles[count - 1])
            area->tiles[count++] = area->tiles[i];
    area->tile_count = count;
    return CAMBER_OK;
}

static bool is_listed(const camber_tiles_area *area, int zoom, uint32_t column, uint32_t row) {
    const uint64_t number = camber_pmtiles_number(zoom, column, row);
    return bsearch(&number, area->tiles, area->tile_count, sizeof number, compare_numbers) != NULL;
}

/* ---- Regions ---- */

/* Whether the segment meets the box, that is, whether no axis separates them. */
static bool meets(camber_box box, const double *a, const double *b) {
    if (fmax(a[0], b[0]) < box.x0 || fmin(a[0], b[0]) > box.x1 || fmax(a[1], b[1]) < box.y0 ||
        fmin(a[1], b[1]) > box.y1)
        return false;
    const double nx = b[1] - a[1], ny = a[0] - b[0], at = nx * a[0] + ny * a[1];
    const double corners[4] = {nx * box.x0 + ny * box.y0, nx * box.x1 + ny * box.y0, nx * box.x0 + ny * box.y1,
                               nx * box.x1 + ny * box.y1};
    const double least = fmin(fmin(corners[0], corners[1]), fmin(corners[2], corners[3]));
    const double most = fmax(fmax(corners[0], corners[1]), fmax(corners[2], corners[3]));
    return least <= at && at <= most;
}

static bool is_polygon(const camber_features *region, size_t polyline) {
    return region->classes[region->feature_class[region->polyline_feature[polyline]]].geometry ==
           CAMBER_GEOMETRY_POLYGON;
}

/* Whether an outline enters the box. If none does, *inside says whether the middle of the box is in a polygon, by the
 * even-odd rule over the rings of a feature. */
static bool crosses(const camber_features *region, camber_box box, bool *inside) {
    const double x = 0.5 * (box.x0 + box.x1), y = 0.5 * (box.y0 + box.y1);
    bool odd = false;
    *inside = false;
    for (size_t p = 0; p < region->polyline_count; p++) {
        if (p > 0 && region->polyline_feature[p] != region->polyline_feature[p - 1]) {
            *inside = *inside || odd;
            odd = false;
        }
        for (size_t i = region->offsets[p]; i + 1 < region->offsets[p + 1] && is_polygon(region, p); i++) {
            const double *a = region->points + 2 * i, *b = a + 2;
            if (meets(box, a, b))
                return true;
            if ((a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
                odd = !odd;
        }
    }
    *inside = *inside || odd;
    return false;
}

static bool touches_region(const camber_features *region, camber_box box) {
    bool inside;
    return crosses(region, box, &inside) || inside;
}

static camber_status take_region(camber_context *context, const camber_features *region, camber_tiles_area *area) {
    camber_box box = CAMBER_BOX_EMPTY;
    for (size_t p = 0; p < region->polyline_count; p++)
        for (size_t i = region->offsets[p]; i < region->offsets[p + 1] && is_polygon(region, p); i++)
            camber_box_add(&box, region->points[2 * i], region->points[2 * i + 1]);
    if (box.x0 > box.x1)
        return camber_fail(context, CAMBER_ERROR_INPUT, "the region has no polygon; give a file with at least one");
    area->region = region;
    area->region_box = box;
    return CAMBER_OK;
}

/* ---- The area ---- */

camber_status camber_tiles_area_make(camber_context *context, const camber_tiles_draw_desc *desc, camber_box data,
                                     camber_tiles_area *area) {
    camber_status status = CAMBER_OK;
    *area = (camber_tiles_area){.context = context,
                                .min_zoom = desc->min_zoom,
                                .max_zoom = desc->max_zoom,
                                .box = WORLD,
                                .bounds = data.x0 > data.x1 ? WORLD : data};
    if (desc->tile_count)
        status = take_list(context, desc, area);
    else if (desc->min_zoom < 0 || desc->max_zoom > CAMBER_LARGEST_TILE_ZOOM || desc->min_zoom > desc->max_zoom)
        status =
            camber_fail(context, CAMBER_ERROR_ARGUMENT, "tiles: zooms %d to %d; choose 0 to %d, the lower one first",
                        desc->min_zoom, desc->max_zoom, CAMBER_LARGEST_TILE_ZOOM);
    if (status == CAMBER_OK && desc->region)
        status = take_region(context, desc->region, area);
    if (status == CAMBER_OK && desc->has_bbox)
        status = take_box(context, desc->bbox, &area->box);
    else if (status == CAMBER_OK && desc->region)
        area->box = area->region_box;
    if (status == CAMBER_OK && (desc->has_bbox || desc->region))
        area->bounds = area->box;
    return status;
}

void camber_tiles_area_free(camber_tiles_area *area) {
    if (area->context)
        camber_free(area->context, area->tiles);
    *area = (camber_tiles_area){0};
}

/* Whether columns [column, column + 1), out of `tiles` columns, overlap [x0, x1) of the world in any of its copies. */
static bool meets_columns(const camber_box *box, double tiles, double column) {
    for (double world = -1.0; world <= 1.0; world += 1.0)
        if (column + 1.0 > (box->x0 + world) * tiles && column < (box->x1 + world) * tiles)
            return true;
    return false;
}

/* ---- An archive whose tiles are replaced ---- */

size_t camber_tiles_area_keep(camber_tiles_area *area, int min_zoom, int max_zoom, const double bounds[4]) {
    const camber_box box = bounds ? box_of(bounds) : WORLD;
    const size_t count = area->tile_count;
    area->tile_count = 0;
    for (size_t i = 0; i < count; i++) {
        const int zoom = camber_archive_zoom(area->tiles[i]);
        /* An archive's bounds reach a thousandth of a tile or more into each of its tiles. At high zooms this may be
         * less than the error of archives, which round bounds to 10^-7 degrees. */
        const double tiles = exp2(zoom), slack = zoom > 21 ? 1e-9 : 0.0;
        const camber_box wide = {box.x0 - slack, box.y0 - slack, box.x1 + slack, box.y1 + slack};
        uint32_t column, row;
        camber_pmtiles_locate(area->tiles[i] - camber_archive_first(zoom), zoom, &column, &row);
        if (zoom >= min_zoom && zoom <= max_zoom && meets_columns(&wide, tiles, column) &&
            row + 1.0 > wide.y0 * tiles && row < wide.y1 * tiles)
            area->tiles[area->tile_count++] = area->tiles[i];
    }
    if (area->tile_count) { /* tile numbers ascend with the zoom */
        area->min_zoom = camber_archive_zoom(area->tiles[0]);
        area->max_zoom = camber_archive_zoom(area->tiles[area->tile_count - 1]);
    }
    return count - area->tile_count;
}

bool camber_tiles_bounds_meet(const double bounds[4], camber_box data) {
    const camber_box box = box_of(bounds);
    for (double world = -1.0; world <= 1.0; world += 1.0)
        if (data.x0 <= data.x1 && data.x0 + world <= box.x1 && data.x1 + world >= box.x0 && data.y0 <= box.y1 &&
            data.y1 >= box.y0)
            return true;
    return false;
}

/* ---- Metatiles ---- */

static bool wants(const camber_tiles_area *area, const camber_box *box, int zoom, uint32_t column, uint32_t row) {
    const double tiles = exp2(zoom);
    if (!((double)row + 1.0 > box->y0 * tiles && (double)row < box->y1 * tiles) || !meets_columns(box, tiles, column))
        return false;
    if (area->tiles && !is_listed(area, zoom, column, row))
        return false;
    const camber_box tile = {column / tiles, row / tiles, (column + 1.0) / tiles, (row + 1.0) / tiles};
    return !area->region || touches_region(area->region, tile);
}

/* A tile of a metatile: its column and row within the metatile. */
typedef struct metatile_place {
    int zoom;
    uint32_t side, column, row;
} metatile_place;

static uint64_t pick(const camber_tiles_area *area, const camber_box *box, metatile_place at) {
    const double metatiles = exp2(at.zoom) / at.side;
    const camber_box metatile = {at.column / metatiles, at.row / metatiles, (at.column + 1.0) / metatiles,
                                 (at.row + 1.0) / metatiles};
    uint64_t picked = 0;
    if (at.zoom < area->min_zoom || at.zoom > area->max_zoom ||
        (area->region && !touches_region(area->region, metatile)))
        return 0;
    for (uint32_t i = 0; i < at.side * at.side; i++)
        if (wants(area, box, at.zoom, at.column * at.side + i % at.side, at.row * at.side + i / at.side))
            picked |= UINT64_C(1) << i;
    return picked;
}

uint64_t camber_tiles_area_pick(const camber_tiles_area *area, int zoom, uint32_t side, uint32_t column, uint32_t row) {
    return pick(area, &area->box, (metatile_place){zoom, side, column, row});
}

uint64_t camber_tiles_area_pick_bounds(const camber_tiles_area *area, int zoom, uint32_t side, uint32_t column,
                                       uint32_t row) {
    return pick(area, &area->bounds, (metatile_place){zoom, side, column, row});
}

camber_metatile_range camber_tiles_area_metatiles(const camber_tiles_area *area, int zoom, uint32_t side) {
    const double metatiles = exp2(zoom) / side;
    const camber_box *box = &area->bounds;
    camber_metatile_range range = {(int64_t)floor(box->x0 * metatiles), (int64_t)ceil(box->x1 * metatiles) - 1,
                                   (int64_t)floor(box->y0 * metatiles), (int64_t)ceil(box->y1 * metatiles) - 1};
    const int64_t last = (int64_t)metatiles - 1;
    if (range.last_column < range.first_column)
        range.last_column = range.first_column;
    if (range.last_row < range.first_row)
        range.last_row = range.first_row;
    if (range.last_column - range.first_column > last)
        range.last_column = range.first_column + last;
    range.first_row = range.first_row > last ? last : range.first_row;
    range.last_row = range.last_row > last ? last : range.last_row;
    return range;
}

void camber_tiles_area_meet(camber_tiles_area *area, int zoom, uint32_t column, uint32_t row) {
    const double tiles = exp2(zoom), inside = 1e-3 / tiles;
    camber_box *box = &area->bounds;
    if (!meets_columns(box, tiles, column)) {
        box->x0 = fmin(box->x0, (column + 1.0) / tiles - inside);
        box->x1 = fmax(box->x1, column / tiles + inside);
    }
    box->y0 = fmin(box->y0, (row + 1.0) / tiles - inside);
    box->y1 = fmax(box->y1, row / tiles + inside);
}

void camber_tiles_area_bounds(const camber_tiles_area *area, double bounds[4]) {
    const camber_box *box = &area->bounds;
    camber_mercator_unproject(bound(box->x0), bound(box->y1), &bounds[0], &bounds[1]);
    camber_mercator_unproject(bound(box->x1), bound(box->y0), &bounds[2], &bounds[3]);
    if (box->x1 > 1.0) { /* an archive's bounds cannot cross the antimeridian */
        bounds[0] = -180.0;
        bounds[2] = 180.0;
    }
    if (!(bounds[0] < bounds[2]) || !(bounds[1] < bounds[3])) { /* nor can they be empty */
        bounds[0] = fmax(bounds[0] - 1e-6, -180.0);
        bounds[2] = fmin(bounds[2] + 1e-6, 180.0);
        bounds[1] -= 1e-6;
        bounds[3] += 1e-6;
    }
}
