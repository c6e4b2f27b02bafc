/* Finds chains of lines whose ends are partners. The stitcher of tiles and the merging of lines both use it. */
#ifndef CAMBER_FEATURES_CHAINS_H
#define CAMBER_FEATURES_CHAINS_H

#include "base/base.h"

#define CAMBER_NO_END UINT32_MAX

/* End e is the first point of line e / 2 if e is even, and its last point if e is odd. */
typedef struct camber_chain {
    uint32_t start; /* the end at which the chain begins */
    uint32_t key;   /* the lowest key of the chain's lines */
} camber_chain;

typedef struct camber_chains_desc {
    const uint32_t *partner; /* 2 * line_count, symmetric: the end at which end e continues; CAMBER_NO_END: none */
    size_t line_count;
    const uint32_t *keys; /* line_count, each less than key_count. NULL: each line's index is its key */
    size_t key_count;
    bool *visited; /* line_count, scratch: the caller sets it for lines that are to be skipped */
} camber_chains_desc;

/* Finds the chains and sorts them by key. Chains with the same key come in three groups: open chains that begin with
 * the first point of a line, the other open chains, and rings, which begin at the first point of their lowest line.
 * Free *chains with camber_free. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_chains_find(camber_context *context, const camber_chains_desc *desc, camber_chain **chains,
                                 size_t *count);

#endif
