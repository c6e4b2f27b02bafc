/* Pieces of features, between tiles.c that cuts them and join.c that joins them. */
#ifndef CAMBER_TILES_H
#define CAMBER_TILES_H

#include "source/source.h"

/* Coordinates of pieces are units of 1/4096 of a tile, from the world's north-west corner: tiles are quantised to
 * this or to half or double as much, and a double holds them exactly at all zooms. */
#define CAMBER_TILE_UNITS 4096.0

typedef struct camber_tile_piece {
    size_t first, count; /* points; count 0: not there any more */
    uint32_t feature;    /* index into features */
    uint32_t column, row;
    bool cut[2];    /* the first and last point were cut, and are no points of the feature */
    bool border[2]; /* they lie on the tile's border */
    bool run;       /* runs along the border: the neighbour has it too */
} camber_tile_piece;

typedef struct camber_tile_record {
    uint64_t id;
    uint32_t class_index;
    bool has_id;
    uint32_t next; /* with the same hash, + 1 */
} camber_tile_record;

struct camber_tiles {
    camber_context *context;
    double units; /* that the world is wide */
    double *points;
    size_t point_count, point_capacity;
    camber_tile_piece *pieces; /* fewer than 2^31 */
    size_t piece_count, piece_capacity;
    camber_tile_record *features; /* one for all the pieces with one id and class */
    size_t feature_count, feature_capacity;
    uint32_t *slots; /* of features with an id, + 1; slot_count is a power of two */
    size_t slot_count;
    double *scratch; /* one polyline */
    size_t scratch_capacity;
};

static inline bool camber_tiles_same(const double *p, const double *q) {
    return p[0] == q[0] && p[1] == q[1];
}

#endif
