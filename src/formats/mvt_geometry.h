/* The geometry of a vector tile's feature: converts drawing commands to lines. */
#ifndef CAMBER_FORMATS_MVT_GEOMETRY_H
#define CAMBER_FORMATS_MVT_GEOMETRY_H

#include "features/features.h"
#include "features/tile_stitcher.h"

typedef struct camber_mvt_geometry {
    camber_context *context;
    double *points; /* in world coordinates */
    size_t *ends;
    size_t point_count, point_capacity, line_count, line_capacity;
    size_t closed_rings; /* how many rings of areas were not closed, and so were closed by the reader */
    const char *damage;  /* NULL: none. If there is damage, the lines are those that could be read */
} camber_mvt_geometry;

typedef struct camber_mvt_commands {
    const uint32_t *words;
    size_t count;
    camber_geometry_kind kind;
    uint32_t column, row, extent;
    double side; /* the width of the world in tiles */
} camber_mvt_commands;

/* Replaces the lines by the lines that the commands draw. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_mvt_geometry_read(camber_mvt_geometry *geometry, const camber_mvt_commands *commands);
void camber_mvt_geometry_free(camber_mvt_geometry *geometry);

#endif
