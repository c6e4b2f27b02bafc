/* Computes the importance of points with several threads. */
#ifndef CAMBER_LINES_IMPORTANCE_H
#define CAMBER_LINES_IMPORTANCE_H

#include "base/base.h"

/* The arguments of camber_importance_weigh, and the most threads that compute it. The result is the same for any. */
typedef struct camber_importance_desc {
    const double *points;
    const size_t *offsets;
    size_t polyline_count;
    float *importance;
    size_t threads;
} camber_importance_desc;

camber_status camber_importance_weigh_by(camber_context *context, const camber_importance_desc *desc);

#endif
