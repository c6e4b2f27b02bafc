/* The order of text that mixes both directions: FriBidi applies Unicode's algorithm to one paragraph at a time. */
#include "text/shaping.h"

#include <fribidi.h>

camber_status camber_bidi_find_levels(camber_context *context, const uint32_t *codes, size_t count, int direction,
                                      uint8_t *levels) {
    FriBidiParType base = direction < 0 ? FRIBIDI_PAR_ON : direction ? FRIBIDI_PAR_RTL : FRIBIDI_PAR_LTR;
    FriBidiCharType *types = camber_alloc(context, count, sizeof *types);
    FriBidiBracketType *brackets = types ? camber_alloc(context, count, sizeof *brackets) : NULL;
    FriBidiLevel *found = brackets ? camber_alloc(context, count, sizeof *found) : NULL;
    camber_status status = found ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    if (!status && count) {
        fribidi_get_bidi_types(codes, (FriBidiStrIndex)count, types);
        fribidi_get_bracket_types(codes, (FriBidiStrIndex)count, types, brackets);
        if (fribidi_get_par_embedding_levels_ex(types, brackets, (FriBidiStrIndex)count, &base, found) == 0)
            status = camber_fail(context, CAMBER_ERROR_MEMORY, "there is no memory to order a text of %zu characters",
                                 count);
        for (size_t i = 0; i < count && !status; i++)
            levels[i] = (uint8_t)found[i];
    }
    camber_free(context, types);
    camber_free(context, brackets);
    camber_free(context, found);
    return status;
}

camber_status camber_shaping_order(camber_context *context, camber_shaping *shaping) {
    camber_status status = CAMBER_OK;
    if (!shaping->has_right_to_left)
        return CAMBER_OK; /* all levels are 0 */
    uint8_t *levels = camber_alloc(context, shaping->count, 1);
    if (!levels)
        return CAMBER_ERROR_MEMORY;
    for (size_t first = 0, end; first < shaping->count && !status; first = end) {
        for (end = first; end < shaping->count && shaping->codes[end] != '\n'; end++)
            ;
        end += end < shaping->count;
        status = camber_bidi_find_levels(context, shaping->codes + first, end - first, -1, levels + first);
    }
    for (size_t i = 0; i < shaping->count && !status; i++)
        shaping->characters[i].level = levels[i];
    camber_free(context, levels);
    return status;
}

/* Rule L2: from the highest level down to the lowest odd one, each stretch of characters of at least that level is
 * reversed. */
void camber_bidi_find_order(const uint8_t *levels, size_t count, uint32_t *order) {
    uint8_t highest = 0;
    for (size_t i = 0; i < count; i++) {
        order[i] = (uint32_t)i;
        highest = levels[i] > highest ? levels[i] : highest;
    }
    for (uint8_t level = highest; level > 0; level--)
        for (size_t first = 0, end; first < count; first = end + 1) {
            for (end = first; end < count && levels[order[end]] >= level; end++)
                ;
            for (size_t i = first, j = end; i + 1 < j; i++, j--) {
                const uint32_t kept = order[i];
                order[i] = order[j - 1];
                order[j - 1] = kept;
            }
        }
}
