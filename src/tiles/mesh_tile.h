/* Mesh tiles: the lines of a picture, cut into tiles, quantised and encoded as GLB. docs/mesh-tiles.md describes what a
 * tile contains. */
#ifndef CAMBER_TILES_MESH_TILE_H
#define CAMBER_TILES_MESH_TILE_H

#include "camber_proof.h"
#include "camber_tiles.h"
#include "map/triangulator.h"
#include "tiles/mesh_plan.h"

#include <math.h>

/* Flags of a record. */
enum {
    CAMBER_MESH_SENTINEL = 1, /* it separates polylines */
    CAMBER_MESH_FIRST = 2,
    CAMBER_MESH_LAST = 4,
    CAMBER_MESH_RING = 8, /* together with FIRST and LAST: the sentinels before and after hold the neighbours */
    CAMBER_MESH_CUT = 16, /* together with FIRST or LAST: the line continues outside */
};

/* The width of a tile in units, if lines reach at most half a tile beyond it; otherwise it is halved until they fit. */
enum { CAMBER_MESH_UNITS = 32768 };

typedef struct camber_mesh_line {
    size_t first, count; /* range of points */
    uint32_t pair;
    float x0, y0, x1, y1; /* bounding box, px */
    /* If the picture has cut a ring: the point before the first one, which is in the ring's last piece, and the point
     * after the last one, which is in its first piece, counted from 1. 0: none. */
    size_t before, behind;
} camber_mesh_line;

/* A point of the picture. A dot is stored as two equal points. */
typedef struct camber_mesh_point {
    float x, y;    /* px */
    uint32_t info; /* CAMBER_POINT_* */
    camber_arc_length at;
} camber_mesh_point;

/* The lines of a picture. */
typedef struct camber_mesh_picture {
    const camber_mesh_plan *plan; /* NULL: none */
    camber_mesh_point *points;    /* grouped by line */
    size_t point_count;
    camber_mesh_line *lines; /* line_count of them */
    size_t line_count;
    camber_mesh_line *rings; /* ring_count of them: closed rings that are filled, in drawing order */
    size_t ring_count;
    float *ring_points; /* ring_point_count pairs, px */
    size_t ring_point_count;
} camber_mesh_picture;

/* Takes the lines of a mesh that was tessellated for the picture with the zoom's plan. Free the picture with
 * camber_mesh_picture_free, also after a failure. Returns what camber_mesh_read_stages returns. */
camber_status camber_mesh_picture_take(const camber_mesh_plan *plan, camber_mesh *mesh, camber_mesh_picture *picture);
void camber_mesh_picture_free(camber_mesh_picture *picture);

/* A point of a tile. */
typedef struct camber_mesh_record {
    int16_t x, y;        /* units from the tile's centre, y down */
    uint16_t row, flags; /* row: index into camber_mesh_tile.rows */
    float along_px, total_px;
} camber_mesh_record;

/* The records of a set's lines, [first, end). */
typedef struct camber_mesh_range {
    size_t set, first, end;
} camber_mesh_range;

/* A corner of an area's triangles. */
typedef struct camber_mesh_corner {
    int16_t x, y;
    uint16_t row;
} camber_mesh_corner;

typedef struct camber_mesh_tile {
    camber_context *context;
    uint32_t units, tile_px;
    /* record_count of them, with sentinels first and last; none if no line touches the tile */
    camber_mesh_record *records;
    size_t record_count, record_capacity;
    uint32_t *rows; /* row_count of them: rows of the plan */
    size_t row_count, row_capacity;
    camber_mesh_range *ranges; /* range_count of them, in drawing order */
    size_t range_count, range_capacity;
    size_t segments;
    bool has_arc_length;
    camber_mesh_corner *corners; /* corner_count corners of areas */
    size_t corner_count, corner_capacity;
    uint32_t *triangles; /* index_count indices, three per triangle */
    size_t index_count, triangle_capacity;
    camber_mesh_range *fills; /* fill_count of them: ranges of the indices, by set */
    size_t fill_count, fill_capacity;
    uint32_t *row_slots; /* row_slot_count of them: for each row of the plan, the tile's row + 1 */
    size_t row_slot_count;
    camber_triangulator *triangulator; /* NULL until it is first needed */
} camber_mesh_tile;

/* Cuts tile x, y of a picture, counted from its north-western one. *tile reuses its memory from one call to the next;
 * free it with camber_mesh_tile_free. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT. */
camber_status camber_mesh_tile_cut(camber_context *context, const camber_mesh_picture *picture, uint32_t tile_px,
                                   uint32_t x, uint32_t y, camber_mesh_tile *tile);
void camber_mesh_tile_free(camber_mesh_tile *tile);
/* Returns the tile's number for a row of the plan. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT (records have 15
 * bits for it). */
camber_status camber_mesh_tile_number(camber_mesh_tile *tile, uint32_t row, uint16_t *number);
/* Records that the triangles from index `first` on belong to the set. Returns false if memory is exhausted. */
bool camber_mesh_tile_end_fill(camber_mesh_tile *tile, size_t set, size_t first);

/* Rounds px to whole units, clamped to the range of 16 bits. */
static inline int16_t camber_mesh_quantise(double px, double scale) {
    const double units = floor(px * scale + 0.5);
    return (int16_t)(units > 32767.0 ? 32767.0 : units < -32767.0 ? -32767.0 : units);
}
/* Returns the set that contains a pair. */
static inline size_t camber_mesh_set_of(const camber_plan *plan, uint32_t pair) {
    size_t set = 0;
    while (pair >= plan->sets[set].first_pair + plan->sets[set].pair_count)
        set++;
    return set;
}

/* Whether this build writes mesh tiles. */
bool camber_mesh_is_built(void);
/* Zoom, column and row of a tile. */
typedef struct camber_mesh_place {
    int zoom;
    uint32_t column, row;
    double ratio; /* device px per CSS px */
} camber_mesh_place;
/* Encodes a tile that has records or triangles. Free *bytes with camber_free. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_mesh_tile_encode(const camber_mesh_tile *tile, const camber_mesh_plan *plan,
                                      const camber_mesh_place *place, uint8_t **bytes, size_t *size_bytes);

#endif
