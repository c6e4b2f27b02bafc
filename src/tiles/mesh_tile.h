/* Mesh tiles: the lines of a picture of tiles, cut into tiles, quantised and encoded as GLB. docs/mesh-tiles.md has
 * what a tile is made of. */
#ifndef CAMBER_TILES_MESH_TILE_H
#define CAMBER_TILES_MESH_TILE_H

#include "camber_proof.h"
#include "camber_tiles.h"
#include "map/triangulator.h"
#include "tiles/mesh_plan.h"

#include <math.h>

/* Flags of a record. */
enum {
    CAMBER_MESH_SENTINEL = 1, /* it stands between polylines */
    CAMBER_MESH_FIRST = 2,
    CAMBER_MESH_LAST = 4,
    CAMBER_MESH_RING = 8, /* with FIRST and LAST: the sentinels beside them have the neighbours */
    CAMBER_MESH_CUT = 16, /* with FIRST and LAST: the line goes on outside */
};

/* Units that a tile is wide, where lines reach half a tile beyond it at most; else a half of it, and so on. */
enum { CAMBER_MESH_UNITS = 32768 };

typedef struct camber_mesh_line {
    size_t first, count; /* of the points */
    uint32_t pair;
    float x0, y0, x1, y1; /* its box, px */
    /* If the picture has cut a ring: the point before its first one in the ring's last piece, and the point after its
     * last one in the first piece, counted from 1. 0: none. */
    size_t before, behind;
} camber_mesh_line;

/* A point of the picture. A dot's lies there twice. */
typedef struct camber_mesh_point {
    float x, y;    /* px */
    uint32_t info; /* CAMBER_POINT_* */
    camber_arc_length at;
} camber_mesh_point;

/* The lines of a picture. */
typedef struct camber_mesh_picture {
    const camber_mesh_plan *plan; /* NULL: none */
    camber_mesh_point *points;    /* line by line */
    size_t point_count;
    camber_mesh_line *lines; /* line_count */
    size_t line_count;
    camber_mesh_line *rings; /* ring_count: those that are filled, closed, in drawing order */
    size_t ring_count;
    float *ring_points; /* ring_point_count pairs, px */
    size_t ring_point_count;
} camber_mesh_picture;

/* Takes the lines of a mesh, which was tessellated for the picture with the zoom's plan. Free it with
 * camber_mesh_picture_free, also after a failure. Returns what camber_mesh_read_stages returns. */
camber_status camber_mesh_picture_take(const camber_mesh_plan *plan, camber_mesh *mesh, camber_mesh_picture *picture);
void camber_mesh_picture_free(camber_mesh_picture *picture);

/* A point of a tile. */
typedef struct camber_mesh_record {
    int16_t x, y;        /* units from the tile's centre, y down */
    uint16_t row, flags; /* row: of camber_mesh_tile.rows */
    float along_px, total_px;
} camber_mesh_record;

/* The records of a set's lines: [first, end). */
typedef struct camber_mesh_range {
    size_t set, first, end;
} camber_mesh_range;

/* A corner of a triangle of areas. */
typedef struct camber_mesh_corner {
    int16_t x, y;
    uint16_t row;
} camber_mesh_corner;

typedef struct camber_mesh_tile {
    camber_context *context;
    uint32_t units, tile_px;
    camber_mesh_record *records; /* record_count, sentinels first and last; none where no line touches the tile */
    size_t record_count, record_capacity;
    uint32_t *rows; /* row_count: rows of the plan */
    size_t row_count, row_capacity;
    camber_mesh_range *ranges; /* range_count, in drawing order */
    size_t range_count, range_capacity;
    size_t segments;
    bool has_arc_length;
    camber_mesh_corner *corners; /* corner_count, of areas */
    size_t corner_count, corner_capacity;
    uint32_t *triangles; /* index_count: three corners each */
    size_t index_count, triangle_capacity;
    camber_mesh_range *fills; /* fill_count: ranges of these, by set */
    size_t fill_count, fill_capacity;
    uint32_t *row_slots; /* row_slot_count: by row of the plan, the tile's row + 1 */
    size_t row_slot_count;
    camber_triangulator *triangulator; /* NULL: none was needed yet */
} camber_mesh_tile;

/* Cuts tile x, y of a picture, counted from its north-western one. *tile keeps its room from one call to the next; free
 * it with camber_mesh_tile_free. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT. */
camber_status camber_mesh_tile_cut(camber_context *context, const camber_mesh_picture *picture, uint32_t tile_px,
                                   uint32_t x, uint32_t y, camber_mesh_tile *tile);
void camber_mesh_tile_free(camber_mesh_tile *tile);
/* The tile's number of a row of the plan. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT (records have 15 bits). */
camber_status camber_mesh_tile_number(camber_mesh_tile *tile, uint32_t row, uint16_t *number);
/* Notes that the triangles from an index on are of the set. false: no memory. */
bool camber_mesh_tile_end_fill(camber_mesh_tile *tile, size_t set, size_t first);

/* Px as whole units; what 16 bits do not hold, becomes the farthest that they do. */
static inline int16_t camber_mesh_quantise(double px, double scale) {
    const double units = floor(px * scale + 0.5);
    return (int16_t)(units > 32767.0 ? 32767.0 : units < -32767.0 ? -32767.0 : units);
}
/* The set that has a pair. */
static inline size_t camber_mesh_set_of(const camber_plan *plan, uint32_t pair) {
    size_t set = 0;
    while (pair >= plan->sets[set].first_pair + plan->sets[set].pair_count)
        set++;
    return set;
}

/* Whether this build writes mesh tiles. */
bool camber_mesh_is_built(void);
/* Where a tile lies. */
typedef struct camber_mesh_place {
    int zoom;
    uint32_t column, row;
    double ratio; /* device px a CSS px */
} camber_mesh_place;
/* Encodes a tile that has records or triangles. *bytes are freed with camber_free. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_mesh_tile_encode(const camber_mesh_tile *tile, const camber_mesh_plan *plan,
                                      const camber_mesh_place *place, uint8_t **bytes, size_t *size_bytes);

#endif
