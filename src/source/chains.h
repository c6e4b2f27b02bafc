/* Chains of pieces whose ends are partners: what joining tile pieces and merging lines have in common. */
#ifndef CAMBER_CHAINS_H
#define CAMBER_CHAINS_H

#include "base/base.h"

#define CAMBER_NO_END UINT32_MAX

/* End e is the first point of piece e / 2, or its last where e is odd. */
typedef struct camber_chain {
    uint32_t start; /* end that it is entered by */
    uint32_t key;   /* the lowest of its pieces */
} camber_chain;

typedef struct camber_chains_desc {
    const uint32_t *partner; /* 2 * piece_count: where end e goes on, and the other way round; CAMBER_NO_END */
    size_t line_count;
    const uint32_t *keys; /* piece_count, below key_count. NULL: the pieces' numbers */
    size_t key_count;
    bool *visited; /* piece_count, scratch: pieces to leave out are set */
} camber_chains_desc;

/* Chains by key, those with one key as they are found: such that begin with the first point of a piece before those
 * that do not, and rings (entered by the first point of their lowest piece) last. *chains is freed with camber_free. */
camber_status camber_chains_find(camber_context *context, const camber_chains_desc *desc, camber_chain **chains,
                                 size_t *count);

#endif
