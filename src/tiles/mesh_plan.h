/* The plan of mesh tiles: how the style draws lines from one whole zoom up to the next.
 *
 * A mesh tile is drawn at all zooms from its own, z, to just below z + 1. Its geometry comes from the plan just below z
 * + 1. Its paints are sampled at z, z + 1/4, z + 1/2, z + 3/4 and just below z + 1. */
#ifndef CAMBER_TILES_MESH_PLAN_H
#define CAMBER_TILES_MESH_PLAN_H

#include "map/zoom_plan.h"

enum { CAMBER_MESH_SAMPLES = 5 };

typedef struct camber_mesh_plan {
    camber_context *context;
    camber_zoom_plan *zoom; /* just below z + 1, but in px of zoom z; its strokes are the widest of all samples */
    camber_plan samples[CAMBER_MESH_SAMPLES - 1]; /* the plans of the other samples, starting at z */
    size_t *sample_layers;  /* [sample][layer of the zoom's plan]: the layer in the sample's plan; SIZE_MAX: none */
    uint32_t *pair_classes; /* for each pair of the zoom's plan */
    uint32_t *pair_rows;    /* for each pair; pairs with equal paints and strokes share a row */
    uint32_t *row_pairs;    /* row_count of them: the first pair of each row */
    size_t row_count;
    float *reach_px; /* for each row: how far from its lines it is drawn, in px of zoom z; negative: it is not drawn */
    bool *has_arc_length; /* for each row: one of its paints depends on the length along the line */
} camber_mesh_plan;

/* desc: for zoom z. The features must outlive the plan. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT. */
camber_status camber_mesh_plan_create(const camber_features *features, const camber_zoom_desc *desc,
                                      camber_mesh_plan **plan);
/* Destroys the zoom's plan too. */
void camber_mesh_plan_destroy(camber_mesh_plan *plan);
/* Returns the paint that a layer of the zoom's plan gives to a row of its set at a sample. Its width is 0 if the row is
 * not drawn. */
camber_paint camber_mesh_plan_paint(const camber_mesh_plan *plan, size_t layer, uint32_t row, size_t sample);
/* Whether mesh tiles can show a paint. Paints with images are left out, for lines and for areas. */
static inline bool camber_mesh_plan_draws(const camber_paint *paint) {
    return paint->fill ? !paint->fill->image && paint->fill->color.a > 0.0f : paint->width_px > 0.0f && !paint->image;
}
/* Returns the offset of a row in a layer at a sample, in px of that zoom. */
float camber_mesh_plan_offset(const camber_mesh_plan *plan, size_t layer, uint32_t row, size_t sample);
/* Whether the row belongs to the set. */
static inline bool camber_mesh_plan_has_row(const camber_mesh_plan *plan, size_t set, uint32_t row) {
    const camber_plan_set *own = plan->zoom->plan.sets + set;
    return plan->row_pairs[row] >= own->first_pair && plan->row_pairs[row] < own->first_pair + own->pair_count;
}
/* Returns how far the zoom of a sample is above z. */
static inline double camber_mesh_sample_zoom(size_t sample) {
    return sample + 1 < CAMBER_MESH_SAMPLES ? 0.25 * (double)sample : 1.0 - 0x1p-20;
}

#endif
