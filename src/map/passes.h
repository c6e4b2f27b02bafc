/* The passes that draw a plan with a mesh of its lines. */
#ifndef CAMBER_MAP_PASSES_H
#define CAMBER_MAP_PASSES_H

#include "map/plan.h"

/* The passes over the polylines of a mesh: by entries and pairs where a network was tessellated, by lines and rows
 * where polylines were. */
typedef struct camber_pass_list {
    camber_pass *passes;
    size_t count;
    camber_paint *paints; /* the paints of all passes */
} camber_pass_list;

/* How a mesh numbers what the sets draw. */
typedef struct camber_row_order {
    const camber_plan *plan;
    bool by_pair;                  /* else by row */
    const size_t *first_polylines; /* set_count + 1 */
    const bool *used;              /* by pair or row: a polyline has it */
} camber_row_order;

/* Makes the passes, and in *layer_count how many layers of the style draw something. camber_passes_free frees also what
 * a failure left. Returns CAMBER_ERROR_LIMIT, CAMBER_ERROR_MEMORY. */
camber_status camber_passes_make(camber_context *context, const camber_row_order *n, size_t *layer_count,
                                 camber_pass_list *list);
void camber_passes_free(camber_context *context, camber_pass_list *list);

#endif
