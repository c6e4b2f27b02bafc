/* Anchors of labels: the places along a line, or in an area, that labels may take. */
#ifndef CAMBER_MAP_LABEL_ANCHORS_H
#define CAMBER_MAP_LABEL_ANCHORS_H

#include "map/view.h"

/* A line in px, relative to any point. */
typedef struct camber_label_path {
    double *points; /* count pairs; no two neighbours are equal */
    double *along;  /* count: distances from the first point */
    size_t count;
} camber_label_path;

typedef struct camber_path_anchor {
    double along;
    size_t segment; /* of the path: the number of its first point */
    double number;  /* of the anchor, counted from the path's beginning, also if earlier ones are left out */
} camber_path_anchor;

typedef struct camber_path_anchors {
    camber_context *context;
    camber_path_anchor *items;
    size_t count, capacity;
} camber_path_anchors;

/* How labels are placed on a line. Lengths are px. */
typedef struct camber_anchor_rule {
    double spacing;      /* between anchors */
    double label_length; /* length of the line that a label takes up */
    double em;           /* the size of the text */
    double window;       /* no stretch of this length may turn by more than max_angle. 0: any turn is fine */
    double max_angle;    /* radians */
    camber_box seen;     /* anchors outside it are not needed */
} camber_anchor_rule;

/* Whether a label whose middle is at the anchor fits on the line, and the line does not turn too sharply for it. */
bool camber_path_takes(const camber_label_path *path, const camber_path_anchor *anchor, const camber_anchor_rule *rule);
/* Adds the anchors at even distances along a line, or one in the middle if the line has room for no other. The anchors
 * do not depend on rule->seen, except that anchors outside it are left out. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_path_repeat(const camber_label_path *path, const camber_anchor_rule *rule,
                                 camber_path_anchors *anchors);
/* Adds an anchor in the middle of the line, if a label fits there. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_path_middle(const camber_label_path *path, const camber_anchor_rule *rule,
                                 camber_path_anchors *anchors);
/* Computes the point at an anchor. */
void camber_path_point(const camber_label_path *path, const camber_path_anchor *anchor, double point[2]);

/* Finds the point of a polygon that is farthest from its edges, to within precision. Ring i has the points [offsets[i],
 * offsets[i + 1]), which are pairs of coordinates. The first ring is the outer one. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_pole_find(camber_context *context, const double *points, const size_t *offsets, size_t ring_count,
                               double precision, double pole[2]);

#endif
