/* Chains of lines whose ends are partners. Both the stitcher of tiles and the merging of lines use them. */
#ifndef CAMBER_FEATURES_CHAINS_H
#define CAMBER_FEATURES_CHAINS_H

#include "base/base.h"

#define CAMBER_NO_END UINT32_MAX

/* End e is the first point of line e / 2, or its last where e is odd. */
typedef struct camber_chain {
    uint32_t start; /* the end that the chain begins with */
    uint32_t key;   /* the lowest key of its lines */
} camber_chain;

typedef struct camber_chains_desc {
    const uint32_t
        *partner; /* 2 * line_count: the end that end e continues at, and the other way round; CAMBER_NO_END: none */
    size_t line_count;
    const uint32_t *keys; /* line_count, below key_count. NULL: the lines' numbers */
    size_t key_count;
    bool *visited; /* line_count, scratch: set for lines that are left out */
} camber_chains_desc;

/* Finds the chains, sorted by key. Chains of one key come in three groups: those that begin with the first point of
 * a line, those that do not, and rings, which begin at the first point of their lowest line. *chains is freed with
 * camber_free. */
camber_status camber_chains_find(camber_context *context, const camber_chains_desc *desc, camber_chain **chains,
                                 size_t *count);

#endif
