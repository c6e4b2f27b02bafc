/* The passes that draw a plan with a mesh of its lines. */
#ifndef CAMBER_MAP_PASSES_H
#define CAMBER_MAP_PASSES_H

#include "map/plan.h"

/* The passes over the polylines of a mesh. If a network was tessellated, these are its entries, numbered by pair;
 * otherwise they are lines, numbered by row. */
typedef struct camber_pass_list {
    camber_pass *passes;
    size_t count;
    camber_paint *paints; /* the paints of all passes */
} camber_pass_list;

/* How the polylines and rows of a mesh correspond to the sets of a plan. A number is a pair or a row of the plan. */
typedef struct camber_mesh_rows {
    const camber_plan *plan;
    bool by_pair;                  /* the numbers are pairs; else rows */
    const size_t *first_polylines; /* set_count + 1 */
    const bool *used;              /* by number: whether any polyline has it */
} camber_mesh_rows;

/* Makes the passes, and counts the layers of the style that draw something. Call camber_passes_free even after a
 * failure. Returns CAMBER_ERROR_LIMIT, CAMBER_ERROR_MEMORY. */
camber_status camber_passes_make(camber_context *context, const camber_mesh_rows *rows, size_t *layer_count,
                                 camber_pass_list *list);
void camber_passes_free(camber_context *context, camber_pass_list *list);

#endif
