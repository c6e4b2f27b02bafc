/* The plan of mesh tiles: how the style draws lines between one whole zoom and the next.
 *
 * A mesh tile is drawn at all zooms from its own, z, to just below z + 1. Its geometry is that of the plan just below
 * z + 1. Its paints are sampled: at z + 0, 1/4, 1/2, 3/4 and just below z + 1. */
#ifndef CAMBER_TILES_MESH_PLAN_H
#define CAMBER_TILES_MESH_PLAN_H

#include "map/zoom_plan.h"

enum { CAMBER_MESH_SAMPLES = 5 };

typedef struct camber_mesh_plan {
    camber_context *context;
    camber_zoom_plan
        *zoom; /* just below z + 1, but px are those of zoom z: its strokes are the widest of all samples */
    camber_plan samples[CAMBER_MESH_SAMPLES - 1]; /* the others, from z on */
    size_t *sample_layers;  /* by sample and layer of the zoom's plan: the layer of the sample's; SIZE_MAX: none */
    uint32_t *pair_classes; /* by pair of the zoom's plan */
    uint32_t *pair_rows;    /* by pair: pairs with equal paints and strokes have one row */
    uint32_t *row_pairs;    /* row_count: the first pair of each row */
    size_t row_count;
    float *reach_px;      /* by row: how far from its lines it is drawn, px of zoom z; below 0: it is not drawn */
    bool *has_arc_length; /* by row: a paint goes by what lies along its lines */
} camber_mesh_plan;

/* desc: of zoom z. The features must outlive the plan. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT. */
camber_status camber_mesh_plan_create(const camber_features *features, const camber_zoom_desc *desc,
                                      camber_mesh_plan **plan);
/* Also the zoom's plan. */
void camber_mesh_plan_destroy(camber_mesh_plan *plan);
/* The paint that a layer of the zoom's plan gives a row of its set at a sample. Its width is 0 where it is not drawn.
 */
camber_paint camber_mesh_plan_paint(const camber_mesh_plan *plan, size_t layer, uint32_t row, size_t sample);
/* Whether mesh tiles have what is drawn with a paint. Images are left out, of lines and of areas. */
static inline bool camber_mesh_plan_draws(const camber_paint *paint) {
    return paint->fill ? !paint->fill->image && paint->fill->color.a > 0.0f : paint->width_px > 0.0f && !paint->image;
}
/* The offset of a row in a layer at a sample, px of that zoom. */
float camber_mesh_plan_offset(const camber_mesh_plan *plan, size_t layer, uint32_t row, size_t sample);
/* Whether the row is one of the set. */
static inline bool camber_mesh_plan_has_row(const camber_mesh_plan *plan, size_t set, uint32_t row) {
    const camber_plan_set *own = plan->zoom->plan.sets + set;
    return plan->row_pairs[row] >= own->first_pair && plan->row_pairs[row] < own->first_pair + own->pair_count;
}
/* The zoom of a sample above z. */
static inline double camber_mesh_sample_zoom(size_t sample) {
    return sample + 1 < CAMBER_MESH_SAMPLES ? 0.25 * (double)sample : 1.0 - 0x1p-20;
}

#endif
