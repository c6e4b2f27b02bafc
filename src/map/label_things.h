/* Things: the lines, areas and points that labels may name. They are found once for a set of features. */
#ifndef CAMBER_MAP_LABEL_THINGS_H
#define CAMBER_MAP_LABEL_THINGS_H

#include "features/features.h"
#include "map/view.h"

/* The polylines of an area, one line, or one polyline of points. */
typedef struct camber_label_thing {
    uint32_t class, feature;
    uint32_t first_polyline, end_polyline;
    camber_box box; /* world coordinates */
} camber_label_thing;

typedef struct camber_label_things {
    camber_context *context;
    camber_label_thing *items; /* sorted by class, then in the order of the features */
    size_t count, capacity;
    size_t *class_first; /* class_count + 1: class c has the things [class_first[c], class_first[c + 1]) */
    size_t class_count;
    uint64_t *codes; /* of all middles, sorted; NULL: not made yet */
} camber_label_things;

/* Finds the things of a set. Points may be dropped from the set later (camber_features_thin), but no features may be
 * added. seen: things that touch it in none of the three nearest copies of the world are left out; NULL: all are
 * wanted. Call camber_label_things_free even after a failure. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_label_things_find(const camber_features *features, const camber_box *seen,
                                       camber_label_things *things);
/* Selects the things that touch a box. Call camber_label_things_free even after a failure. Returns
 * CAMBER_ERROR_MEMORY. */
camber_status camber_label_things_select(const camber_label_things *all, const camber_box *seen,
                                         camber_label_things *things);
void camber_label_things_free(camber_label_things *things);
/* A square of the map: 1 / 2^level of the world wide. */
typedef struct camber_label_square {
    int level; /* 0 to 24 */
    uint32_t column, row;
} camber_label_square;

/* Counts the things whose middles are in a square. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_label_things_count(camber_label_things *things, const camber_label_square *square, size_t *count);
/* Returns in which copies of the world a box touches another: bit i stands for the copy that is moved by i - 1. */
uint8_t camber_label_find_worlds(const camber_box *seen, const camber_box *box);
/* Returns the box around some polylines. It is empty if none of their points is finite. */
camber_box camber_label_box_of(const camber_features *features, size_t first_polyline, size_t end_polyline);

#endif
