/* Kinds of characters, as MapLibre's style specification and Unicode distinguish them. */
#ifndef CAMBER_TEXT_SCRIPTS_H
#define CAMBER_TEXT_SCRIPTS_H

#include <stdbool.h>
#include <stdint.h>

/* White space that is cut from the ends of lines. */
static inline bool camber_is_white(uint32_t code) {
    return code == ' ' || (code >= 9 && code <= 13);
}
/* Whether a line may break after it, as between ideographs. */
bool camber_is_ideographic(uint32_t code);
/* Whether it stands upright in vertical lines. */
bool camber_is_upright(uint32_t code);
/* Whether it is punctuation or a mark of ideographic scripts that turns in vertical lines if its font has no vertical
 * form of it. */
bool camber_turns_without_form(uint32_t code);
/* The code point of its vertical form, or 0. */
uint32_t camber_get_vertical_form(uint32_t code);
/* Whether letters of its script touch, so that nothing may come between them. */
bool camber_is_cursive(uint32_t code);

#endif
