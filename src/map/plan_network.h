/* The network that a plan draws, and on the host the polylines of it that a camera sees. */
#ifndef CAMBER_MAP_PLAN_NETWORK_H
#define CAMBER_MAP_PLAN_NETWORK_H

#include "map/zoom_plan.h"

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
/* The views that a network serves. */
typedef enum camber_network_views {
    CAMBER_NETWORK_VIEWS,  /* those in which the same is drawn, in the same copies of the world */
    CAMBER_NETWORK_VIEW,   /* one: it leaves out the points of less importance than the plan's least */
    CAMBER_NETWORK_WINDOW, /* one of a plan that has others: so are the copies of the world that do not touch it */
} camber_network_views;

/* listed: what is drawn, of the plan; it goes, as the network has it.
 * Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT. camber_plan_network_destroy frees also what a failure left. */
camber_status camber_plan_network_create(const camber_zoom_plan *zoom, const camber_view *view,
                                         camber_network_views views, camber_plan_entries *listed,
                                         camber_plan_network *geometry);
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
camber_status camber_plan_network_project(const camber_zoom_plan *zoom, const camber_plan_network *geometry,
                                          const camber_camera *camera, const camber_tessellation_desc *desc,
                                          camber_visible_lines *seen);
void camber_visible_lines_destroy(camber_visible_lines *seen);

#endif
