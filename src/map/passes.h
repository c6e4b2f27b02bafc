/* The passes that draw a plan with a mesh of its lines. */
#ifndef CAMBER_MAP_PASSES_H
#define CAMBER_MAP_PASSES_H

#include "map/label_shapes.h"
#include "map/plan.h"

/* The passes over the polylines of a mesh: by entries and pairs if a network was tessellated, by lines and rows if
 * polylines were. */
typedef struct camber_pass_list {
    camber_pass *passes;
    camber_label_mesh *meshes; /* by pass: what its mesh holds */
    size_t count;
    camber_paint *paints; /* the paints of all passes, except passes of labels */
} camber_pass_list;

/* How a mesh numbers the polylines that the sets draw. */
typedef struct camber_mesh_rows {
    const camber_plan *plan;
    bool by_pair;                      /* otherwise by row */
    const size_t *first_polylines;     /* set_count + 1 */
    const bool *used;                  /* by pair or row: a polyline has it */
    const camber_label_shapes *labels; /* drawn where their layers are. NULL: none */
    const camber_style_layer *style_layers;
} camber_mesh_rows;

/* Makes the passes, and sets *layer_count to the number of layers of the style that draw something. Call
 * camber_passes_free even after a failure. Returns CAMBER_ERROR_LIMIT, CAMBER_ERROR_MEMORY. */
camber_status camber_passes_make(camber_context *context, const camber_mesh_rows *rows, size_t *layer_count,
                                 camber_pass_list *list);
void camber_passes_free(camber_context *context, camber_pass_list *list);

#endif
