/* The network that a plan draws, and on the host the polylines of it that a camera sees. */
#ifndef CAMBER_MAP_PLAN_NETWORK_H
#define CAMBER_MAP_PLAN_NETWORK_H

#include "map/plan.h"

typedef struct camber_plan_network {
    camber_context *context;
    bool has_arc_length;     /* the network is, for what lies along lines */
    camber_network *network; /* rows are the plan's pairs; entries by set, and in input order in a set */
    camber_network_entry *entries;
    size_t *first_entries; /* set_count + 1 */
    size_t set_count;
    uint64_t key;
} camber_plan_network;

/* How far from its polyline a stroke touches pixels, its offset included; a paint's translation comes on top. */
double camber_plan_stroke_reach(const camber_stroke *stroke);
/* The same of all strokes of the plan, with the translation. */
double camber_plan_reach(const camber_plan *plan);
/* The step of networks for pictures of one zoom: 1/4096 px. Pictures of 4096 px, whose sides lie on whole px of the
 * world, then have each point at the very same place, whatever else is in their networks: floats hold it exactly. */
static inline double camber_plan_network_step(const camber_view *view) {
    return 1.0 / (4096.0 * view->scale_px);
}
/* A view that stays: its network leaves out the points of less importance. */
typedef struct camber_still {
    float least_importance;
} camber_still;

/* The plan's list of all polylines goes: the network has them. still: the network is for this view alone; NULL: for
 * others too.
 * Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT. camber_plan_network_destroy frees also what a failure left. */
camber_status camber_plan_network_create(const camber_features *features, const camber_view *view, camber_plan *plan,
                                         const camber_still *still, camber_plan_network *geometry);
/* Whether the geometry is that of another view and plan of the same features. */
bool camber_plan_network_serves(const camber_plan_network *geometry, const camber_view *view, const camber_plan *plan);
void camber_plan_network_destroy(camber_plan_network *geometry);

typedef struct camber_visible_lines {
    camber_context *context;
    camber_lines lines;
    uint32_t *rows;          /* by polyline: its row of the plan; lines.entries has its entry */
    size_t *first_polylines; /* set_count + 1 */
    size_t feature_count;    /* features of which something is seen, counted once a set */
    size_t points_in;        /* points of the polylines of which something is seen */
} camber_visible_lines;

/* camber_visible_lines_destroy frees also what a failure left. */
camber_status camber_plan_network_project(const camber_features *features, const camber_plan_network *geometry,
                                          const camber_plan *plan, const camber_camera *camera,
                                          const camber_tessellation_desc *desc, camber_visible_lines *seen);
void camber_visible_lines_destroy(camber_visible_lines *seen);

#endif
