/* The kernels' style table: one row per stroke. */
#ifndef CAMBER_POINTS_ROWS_H
#define CAMBER_POINTS_ROWS_H

#include "base/base.h"

#include "kernels/layout.h"

/* Checks a desc for polylines whose rows are below row_count, and makes the table. Free it with camber_free. */
camber_status camber_rows_create(camber_context *context, uint32_t row_count, const camber_tessellation_desc *desc,
                                 camber_row **rows);

#endif
