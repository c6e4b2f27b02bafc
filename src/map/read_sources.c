/* Reads the parts of a style's own sources that a view sees. */
#include "formats/tile_reader.h"
#include "map/sources.h"
#include "map/view.h"

#include <math.h>

/* The same values as in fit.c. */
static const double FILL = 0.96, LARGEST_FIT_ZOOM = 22.0;
/* The largest circle radius, in CSS px, for which more tiles are read. It also applies to circles whose size depends on
 * the features. */
static const double MOST_CIRCLE_PX = 256.0;

/* Moves a view without a camera to show the bounds of all sources. */
static void fit_bounds(const camber_sources *sources, camber_view *view) {
    double world[4];
    if (!camber_sources_bounds(sources, world))
        return;
    camber_box bounds = CAMBER_BOX_EMPTY;
    for (int i = 0; i < 4; i++) {
        const double x = world[2 * (i & 1)], y = world[1 + 2 * (i >> 1)];
        camber_box_add(&bounds, x * view->cosine + y * view->sine, y * view->cosine - x * view->sine);
    }
    camber_view_frame(view, bounds, FILL, LARGEST_FIT_ZOOM);
}

/* Returns the tiles that the view sees, and those from which circles and labels reach into it: a point is only in the
 * tile that contains it, while a tile's buffer repeats the lines of its neighbours. */
static camber_tile_cover cover_of(const camber_features *features, const camber_view *view) {
    camber_tile_cover cover = {.zoom = view->zoom};
    double centre[2] = {0.0, 0.0};
    camber_view_corners(view, cover.corners);
    const double circle_px = fmin(camber_view_circle_reach(features->style, view), MOST_CIRCLE_PX * view->ratio);
    const double reach_px = fmax(circle_px, camber_view_label_reach(features, view));
    const double grown = 2.0 * reach_px / fmin((double)view->width, (double)view->height);
    for (int i = 0; i < 8; i++)
        centre[i & 1] += 0.25 * cover.corners[i];
    for (int i = 0; i < 8; i++)
        cover.corners[i] += (cover.corners[i] - centre[i & 1]) * grown;
    return cover;
}

camber_status camber_features_read_sources(camber_features *features, const camber_view_desc *view,
                                           const char *base_path) {
    const camber_features_mark before = camber_features_get_mark(features);
    camber_view seen;
    camber_sources *sources = NULL;
    camber_status status = camber_view_create(features->context, view, &seen);
    if (status != CAMBER_OK)
        return status;
    const camber_sources_desc desc = {.base_path = base_path, .ratio = seen.ratio};
    status = camber_sources_open(features, &desc, &sources);
    if (status == CAMBER_OK) {
        if (view->kind == CAMBER_VIEW_FIT)
            fit_bounds(sources, &seen);
        const camber_tile_cover cover = cover_of(features, &seen);
        status = camber_sources_read(sources, &cover);
    }
    camber_sources_close(sources);
    if (status != CAMBER_OK)
        camber_features_reset(features, &before);
    else
        camber_progress(features->context, "reading", 1);
    return status;
}
