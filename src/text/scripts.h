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
/* Whether it has no glyph of its own: format characters, joiners and selectors of variants, which belong to the
 * character before them, whatever its font. */
bool camber_is_invisible(uint32_t code);
/* Whether a line may break after it, as between ideographs. */
bool camber_is_ideographic(uint32_t code);
/* Whether it is upright in vertical lines. */
bool camber_is_upright(uint32_t code);
/* Whether it is punctuation or a mark of ideographic scripts that is turned in vertical lines if its font has no
 * vertical form for it. */
bool camber_turns_without_form(uint32_t code);
/* Returns the code point of its vertical form, or 0. */
uint32_t camber_get_vertical_form(uint32_t code);
/* Returns the name of the Noto Sans family for a script, without "Noto Sans". language is the text's and may be NULL.
 * NULL: the script has no family of its own. */
const char *camber_get_script_name(hb_script_t script, const char *language);
/* Whether letters of its script touch, so that there may be no space between them. */
bool camber_is_cursive(uint32_t code);

#endif
