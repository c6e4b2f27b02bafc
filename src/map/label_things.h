/* Things: the lines, areas and points that labels may name. They are found once for a set of features. A tree of their
 * boxes finds those of a part of the map without looking at all of them. */
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

/* The boxes of things as a tree: sixteen things, or nodes of the level below, are under each node. */
typedef struct camber_label_tree {
    uint64_t *codes;   /* of the things' middles, sorted; NULL: there is no tree yet */
    uint32_t *order;   /* the things in this order */
    camber_box *nodes; /* level by level; the last one is the root */
    size_t firsts[9];  /* the first node of each level, then the number of all */
    int level_count;
} camber_label_tree;

typedef struct camber_label_things {
    camber_context *context;
    camber_label_thing *items; /* sorted by class, then in the order of the features */
    size_t count, capacity;
    size_t *class_first; /* class_count + 1: class c has the things [class_first[c], class_first[c + 1]) */
    size_t class_count;
    camber_label_tree tree;
    bool told_too_far; /* that labels are left out because they reach too far (zoom_labels.c) */
} camber_label_things;

/* Finds the things of a set. Points may be dropped from the set later (camber_features_thin), but no features may be
 * added. seen: things that touch it in none of the three nearest copies of the world are left out; NULL: all are
 * wanted. Call camber_label_things_free even after a failure. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_label_things_find(const camber_features *features, const camber_box *seen,
                                       camber_label_things *things);
/* Selects the things that touch a box. It looks at all of them, unless there is a tree. Call camber_label_things_free
 * even after a failure. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_label_things_select(const camber_label_things *all, const camber_box *seen,
                                         camber_label_things *things);
void camber_label_things_free(camber_label_things *things);
/* Makes the tree, unless there is one. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_label_things_make_tree(camber_label_things *things);
/* Whether a thing touches a box, in one of the three nearest copies of the world. There must be a tree. */
bool camber_label_things_touch(const camber_label_things *things, const camber_box *box);

/* A square of the map: 1 / 2^level of the world wide. */
typedef struct camber_label_square {
    int level; /* 0 to 24 */
    uint32_t column, row;
} camber_label_square;

/* Counts the things whose middles are in a square. There must be a tree. */
size_t camber_label_things_count(const camber_label_things *things, const camber_label_square *square);
/* Returns in which copies of the world a box touches another: bit i stands for the copy that is moved by i - 1. */
uint8_t camber_label_find_worlds(const camber_box *seen, const camber_box *box);
/* Returns the box around some polylines. It is empty if none of their points is finite. */
camber_box camber_label_box_of(const camber_features *features, size_t first_polyline, size_t end_polyline);

#endif
