/* The network of the polylines that a plan draws, and the lines of it that a camera sees, projected on the host. */
#ifndef CAMBER_MAP_PLAN_NETWORK_H
#define CAMBER_MAP_PLAN_NETWORK_H

#include "map/zoom_plan.h"

typedef struct camber_plan_network {
    camber_context *context;
    bool has_arc_length;     /* the network has arc lengths, which dashes, gradients and patterns need */
    camber_network *network; /* rows are the plan's pairs; entries are ordered by set, then as the plan lists them */
    camber_network_entry *entries;
    size_t *first_entries; /* set_count + 1 */
    size_t set_count;
    uint64_t key;
} camber_plan_network;

/* Returns how far from its polyline a stroke touches pixels, including its offset but not a paint's translation. */
double camber_plan_stroke_reach(const camber_stroke *stroke);
/* Returns the largest reach of the plan's strokes, including the translation. */
double camber_plan_reach(const camber_plan *plan);
/* Returns the step of networks for pictures of one zoom: 1/4096 px. If the sides of 4096 px pictures are at whole px of
 * the world, each point then has exactly the same position in all of these pictures, whatever else is in their
 * networks, because floats hold it exactly. */
static inline double camber_plan_network_step(const camber_view *view) {
    return 1.0 / (4096.0 * view->scale_px);
}
/* The views that a network can be used for. */
typedef enum camber_network_views {
    CAMBER_NETWORK_VIEWS,  /* all views that draw the same entries, in the same copies of the world */
    CAMBER_NETWORK_VIEW,   /* one view: it leaves out points below the plan's least importance */
    CAMBER_NETWORK_WINDOW, /* one window of several: it also leaves out copies of the world that do not touch it */
} camber_network_views;

/* listed: the plan's entries to put into the network; they are freed, because the network has copies. Call
 * camber_plan_network_destroy even after a failure. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT. */
camber_status camber_plan_network_create(const camber_zoom_plan *zoom, const camber_view *view,
                                         camber_network_views views, camber_plan_entries *listed,
                                         camber_plan_network *geometry);
/* Whether the network can also be used for another view and plan of the same features. */
bool camber_plan_network_serves(const camber_plan_network *geometry, const camber_view *view, const camber_plan *plan);
void camber_plan_network_destroy(camber_plan_network *geometry);

typedef struct camber_visible_lines {
    camber_context *context;
    camber_lines lines;
    uint32_t *rows;          /* by polyline: its row of the plan; its entry is in lines.entries */
    size_t *first_polylines; /* set_count + 1 */
    size_t feature_count;    /* features that are at least partly visible, counted once per set */
    size_t points_in;        /* points of the polylines that are at least partly visible, without ends */
    size_t end_count;        /* polylines of one point, in lines, that are the ends of others */
} camber_visible_lines;

/* Projects the lines that the camera sees. Call camber_visible_lines_destroy even after a failure. */
camber_status camber_plan_network_project(const camber_zoom_plan *zoom, const camber_plan_network *geometry,
                                          const camber_camera *camera, const camber_tessellation_desc *desc,
                                          camber_visible_lines *seen);
void camber_visible_lines_destroy(camber_visible_lines *seen);

#endif
