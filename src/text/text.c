/* Makes texts. */
#include "text/fonts.h"

/* Checks that all ranges that the text asked for could be loaded. If not, the next text tries again. */
static camber_status check_ranges(camber_fonts *fonts) {
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < fonts->source_count; i++) {
        camber_glyph_ranges *ranges = fonts->sources[i].ranges;
        if (ranges && ranges->status) {
            status = ranges->status;
            ranges->status = CAMBER_OK;
        }
    }
    return status;
}

camber_status camber_text_shape(camber_fonts *fonts, const camber_text_desc *desc, camber_text **text) {
    camber_context *context = fonts->context;
    camber_shaping *shaping = &fonts->shaping;
    camber_text *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    *made = (camber_text){.context = context, .vertical = desc->vertical};
    camber_status status = camber_shaping_read(context, shaping, desc);
    status = status ? status : camber_shaping_order(context, shaping);
    status = status ? status : camber_shaping_itemize(fonts, desc);
    status = status ? status : camber_shaping_shape(fonts, desc);
    status = status ? status : camber_shaping_break(context, shaping, desc);
    status = status ? status : camber_shaping_lay_out(fonts, desc, made);
    const camber_status of_ranges = check_ranges(fonts);
    status = status ? status : of_ranges;
    if (status)
        camber_text_destroy(made);
    else
        *text = made;
    return status;
}

camber_status camber_text_recall(camber_fonts *fonts, const camber_text_key *key, const camber_text_desc *desc,
                                 camber_text **text) {
    camber_text *made = NULL;
    bool found;
    camber_status status = camber_text_memo_find(fonts, key, &found, text);
    if (status != CAMBER_OK || found)
        return status;
    status = camber_text_shape(fonts, desc, &made);
    if (status == CAMBER_OK)
        status = camber_text_memo_put(fonts, key, made);
    if (status == CAMBER_OK)
        *text = made;
    else
        camber_text_destroy(made);
    return status;
}
