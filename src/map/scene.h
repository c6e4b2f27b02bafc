/* Scenes of windows: they share one zoom's plan, for pictures that are parts of a larger one. */
#ifndef CAMBER_MAP_SCENE_H
#define CAMBER_MAP_SCENE_H

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

#endif
