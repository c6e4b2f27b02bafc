/* Merges several lists of the same things into one order. This order decides which line is drawn on top in neighbouring
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

/* Writes all things to order (count entries). Each thing comes after those that precede it in a list; otherwise things
 * are sorted by number. If two lists contradict each other about a pair of things, the pair is in the order of one of
 * them. Returns CAMBER_ERROR_MEMORY. Cost: linear. */
camber_status camber_order_merge(camber_context *context, const camber_order_desc *desc, uint32_t *order);

#endif
