/* Kinds of characters, as MapLibre's style specification and Unicode distinguish them. */
#ifndef CAMBER_TEXT_SCRIPTS_H
#define CAMBER_TEXT_SCRIPTS_H

#include <hb.h>

#include <stdbool.h>
#include <stdint.h>

/* White space that is cut from the ends of lines. */
static inline bool camber_is_white(uint32_t code) {
    return code == ' ' || (code >= 9 && code <= 13);
}
/* Whether it has no glyph of its own: format characters, joiners and selectors of variants, which go with the character
 * before them, whatever its font. */
bool camber_is_invisible(uint32_t code);
/* Whether a line may break after it, as between ideographs. */
bool camber_is_ideographic(uint32_t code);
/* Whether it stands upright in vertical lines. */
bool camber_is_upright(uint32_t code);
/* Whether it is punctuation or a mark of ideographic scripts that turns in vertical lines if its font has no vertical
 * form of it. */
bool camber_turns_without_form(uint32_t code);
/* The code point of its vertical form, or 0. */
uint32_t camber_get_vertical_form(uint32_t code);
/* Names the family of Noto Sans that has a script, without "Noto Sans". language: of the text; may be NULL. NULL: the
 * script has no family of its own. */
const char *camber_get_script_name(hb_script_t script, const char *language);
/* Whether letters of its script touch, so that nothing may come between them. */
bool camber_is_cursive(uint32_t code);

#endif
