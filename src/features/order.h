/* Merges several lists of the same things into one order. It decides which line is drawn on top in two neighbouring
 * tiles. */
#ifndef CAMBER_FEATURES_ORDER_H
#define CAMBER_FEATURES_ORDER_H

#include "base/base.h"

#define CAMBER_LIST_END UINT32_MAX

typedef struct camber_order_desc {
    size_t count;          /* the number of things; they are numbered from 0 */
    const uint32_t *lists; /* item_count: things; each list ends with CAMBER_LIST_END or with the last item */
    size_t item_count;
} camber_order_desc;

/* Writes all things to order (count entries). Each comes after those that precede it in a list; otherwise they are
 * sorted by number. If lists contradict each other, some pairs follow only one of them. Returns CAMBER_ERROR_MEMORY.
 * Cost: linear. */
camber_status camber_order_merge(camber_context *context, const camber_order_desc *desc, uint32_t *order);

#endif
