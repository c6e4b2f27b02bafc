/* Scenes of windows: they share one zoom's plan, for pictures that are parts of a larger one. */
#ifndef CAMBER_MAP_SCENE_H
#define CAMBER_MAP_SCENE_H

#include "map/labels.h"
#include "map/passes.h"
#include "map/plan_network.h"
#include "map/zoom_labels.h"
#include "map/zoom_plan.h"

/* The labels of a zoom, and the square of its finest level that contains a window. */
typedef struct camber_window_labels {
    camber_zoom_labels *labels; /* NULL: none */
    camber_label_square square;
} camber_window_labels;

/* Makes a scene of a window: the zoom's view, moved to the window. The zoom must outlive it. It is tessellated and
 * drawn like any scene, but cannot move. labels may be NULL. polylines: ascending, and at least those that reach into
 * the window. The images of fills have their positions in the window until a frame of another window is requested.
 * Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT. */
camber_status camber_scene_create_window(camber_zoom_plan *zoom, const camber_view *window,
                                         const camber_window_labels *labels, const uint32_t *polylines,
                                         size_t polyline_count, camber_scene **scene);

/* The parts that a scene is drawn from, for pages (print/). Passes are over the entries of the network: their paints
 * are indexed by the entries' rows. All of it is valid until the scene moves. */
typedef struct camber_scene_parts {
    const camber_zoom_plan *zoom;
    const camber_view *view;
    const camber_plan_network *geometry;
    const camber_pass_list *passes;
    const camber_labels *labels;
    camber_label_shapes *shapes;
} camber_scene_parts;

camber_scene_parts camber_scene_get_parts(camber_scene *scene);

#endif
