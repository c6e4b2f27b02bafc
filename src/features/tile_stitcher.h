/* The stitcher joins features that were cut by vector tiles. tile_cut.c cuts their lines exactly at the tiles' borders,
 * and tile_join.c joins them across the borders. tile_area.c cuts areas, whose pieces stay separate; tile_label.c
 * chooses the one that is labelled. */
#ifndef CAMBER_FEATURES_TILE_STITCHER_H
#define CAMBER_FEATURES_TILE_STITCHER_H

#include "features/features.h"

typedef struct camber_tile_stitcher camber_tile_stitcher;

/* Sides of a tile: west x0, east x1, north y0, south y1. */
enum { CAMBER_SIDE_WEST = 1, CAMBER_SIDE_EAST = 2, CAMBER_SIDE_NORTH = 4, CAMBER_SIDE_SOUTH = 8 };

typedef struct camber_tile_feature {
    uint32_t column, row; /* the tile, from the north-west; columns may be in the next copy of the world */
    uint32_t class_index;
    bool outline; /* outlines of polygons: lines along the border are left out, because clipping made them */
    bool area;    /* its lines are rings as described in rings.h; each is cut to the tile, even at open sides */
    bool has_id;
    uint64_t id; /* equal in all tiles */
    bool has_progress;
    double progress[2];  /* line-progress at the ends of each line; ignored without has_progress */
    unsigned open_sides; /* CAMBER_SIDE_*: sides whose neighbour is not read, so the tile's buffer is kept */
} camber_tile_feature;

/* Polylines in world coordinates: line i ends before point ends[i]. */
typedef struct camber_tile_lines {
    const double *points;
    const size_t *ends;
    size_t line_count;
} camber_tile_lines;

/* Creates a stitcher for tiles of one zoom, 0 to 30. */
camber_status camber_tile_stitcher_create(camber_context *context, int zoom, camber_tile_stitcher **stitcher);
void camber_tile_stitcher_destroy(camber_tile_stitcher *stitcher);
/* Cuts the lines of a feature at the tile's border and keeps the parts inside. */
camber_status camber_tile_stitcher_add(camber_tile_stitcher *stitcher, const camber_tile_feature *feature,
                                       const camber_tile_lines *lines);
/* Gives points of areas on the borders of tiles the highest importance, so that simplification keeps them and the
 * pieces still meet. Does so for the polylines from first_polyline on, whose importance must have been computed. */
void camber_features_pin_borders(camber_features *features, size_t first_polyline, int zoom);
/* Joins the lines and adds them to the set. If the style depends on the direction of lines, the end of a line is joined
 * only to the start of another. */
camber_status camber_tile_stitcher_finish(camber_tile_stitcher *stitcher, camber_features *features);
/* Does the same for labels. Directions count only if icons show them. Joined pieces are not counted. */
camber_status camber_tile_stitcher_finish_labels(camber_tile_stitcher *labels, camber_features *features);

/* ---- Shared by the files of the stitcher ---- */

/* Keeps the largest piece of each area for labels, and removes the others, so that an area has one label. Returns
 * CAMBER_ERROR_MEMORY. */
camber_status camber_tile_stitcher_keep_largest(camber_tile_stitcher *labels, const camber_features *features);

/* Coordinates of cut lines are in units of 1/4096 of a tile, from the world's north-west corner. Tiles are rounded to
 * steps of one unit, or of half or double that size. A double represents such numbers exactly at all zooms. */
#define CAMBER_TILE_UNITS 4096.0

/* A line, or a ring of an area. */
typedef struct camber_cut_line {
    size_t first, count; /* the line's points; count 0: the line was removed */
    uint32_t feature;    /* index into features */
    uint32_t column, row;
    bool cut[2];       /* the first or last point was made by cutting, and is not a point of the feature */
    bool border[2];    /* this end is on the tile's border */
    bool along_border; /* the whole line is on the border, so the neighbour has it too */
    float progress[2];
} camber_cut_line;

typedef struct camber_cut_feature {
    uint64_t id;
    uint32_t class_index;
    bool has_id;
    uint32_t next; /* the next feature with the same hash, + 1 */
} camber_cut_feature;

struct camber_tile_stitcher {
    camber_context *context;
    double units;      /* the world's width in units */
    double grid;       /* the step of the coarsest tile's grid, in units */
    bool has_progress; /* some line has progress */
    double *points;
    size_t point_count, point_capacity;
    camber_cut_line *lines; /* fewer than 2^31 */
    size_t line_count, line_capacity;
    camber_cut_feature *features; /* one entry for all lines with the same id and class */
    size_t feature_count, feature_capacity;
    uint32_t *slots; /* hash table of features with an id, + 1; slot_count is a power of two */
    size_t slot_count;
    double *scratch; /* the points of one polyline */
    size_t scratch_capacity;
};

typedef struct camber_tile_box {
    double low[2], high[2];
} camber_tile_box;

/* Returns false if there is no memory. */
bool camber_tile_stitcher_add_point(camber_tile_stitcher *stitcher, const double *point);
camber_status camber_tile_stitcher_add_line(camber_tile_stitcher *stitcher, const camber_cut_line *line);
/* Cuts the ring in scratch, which has count points, to the box, and adds the result as a line with the other properties
 * of like. */
camber_status camber_tile_stitcher_add_ring(camber_tile_stitcher *stitcher, const camber_cut_line *like,
                                            const camber_tile_box *box, size_t count);

static inline bool camber_tile_stitcher_same(const double *p, const double *q) {
    return p[0] == q[0] && p[1] == q[1];
}

#endif
