/* The shapes of labels: the polylines of two meshes, and the passes that draw them. */
#ifndef CAMBER_MAP_LABEL_SHAPES_H
#define CAMBER_MAP_LABEL_SHAPES_H

#include "map/label_icons.h"

/* The labels of a layer of the style, or those of them that are flat or upright: ranges of polylines. */
typedef struct camber_label_range {
    size_t layer; /* of the style */
    size_t first_icon, icon_count;
    size_t first_ring, ring_count; /* of its texts, and of icons that are distances */
    bool has_halo;
    bool upright; /* they are in the picture as it is seen, and not in the plane of the map */
} camber_label_range;

typedef struct camber_label_shapes {
    camber_context *context;
    camber_polylines *texts, *icons; /* rings in px; rows are looks in texts, numbers of icons in icons. NULL: none */
    camber_stroke *strokes;          /* by look: the strokes of halos */
    camber_fill *fills;              /* by look, then by icon */
    camber_paint *halos, *paints;    /* by look; paints of icons follow the paints of looks */
    size_t look_count, icon_count;
    camber_icon_forms forms;
    camber_label_range *ranges; /* range_count of them, in drawing order */
    size_t range_count;
} camber_label_shapes;

/* Makes the shapes of labels. Call camber_label_shapes_free even after a failure.
 * Returns CAMBER_ERROR_LIMIT, CAMBER_ERROR_MEMORY. */
camber_status camber_label_shapes_make(const camber_labels *labels, camber_fonts *fonts, camber_label_shapes *shapes);
void camber_label_shapes_free(camber_label_shapes *shapes);

/* Tessellates the shapes into the mesh's companion, and icons into the companion's companion. Without labels both
 * companions are empty. Returns the errors of camber_mesh_tessellate. */
camber_status camber_label_shapes_tessellate(const camber_label_shapes *shapes, camber_mesh *mesh,
                                             camber_method method);

/* The mesh that a pass draws: the network's, or a companion. */
typedef enum camber_label_mesh {
    CAMBER_MESH_NETWORK = 0,
    CAMBER_MESH_TEXTS,
    CAMBER_MESH_ICONS,
} camber_label_mesh;

/* Writes the passes of a range, and which mesh each needs; the caller sets their meshes. Returns how many passes there
 * are, at most CAMBER_LABEL_PASSES. */
enum { CAMBER_LABEL_PASSES = 3 };
size_t camber_label_shapes_passes(const camber_label_shapes *shapes, const camber_label_range *range,
                                  camber_pass passes[CAMBER_LABEL_PASSES],
                                  camber_label_mesh meshes[CAMBER_LABEL_PASSES]);

#endif
