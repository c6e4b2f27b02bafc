/* Fills the list of fonts from all of its origins. */
#include "text/font_index.h"

#include "base/embedded.h"

#include <stdlib.h>

static camber_status add_shipped(camber_font_index *index) {
    const struct {
        const char *name, *style;
        const unsigned char *bytes;
        unsigned long size_bytes;
        camber_font_style is;
    } fonts[] = {
        {"Noto Sans", "Regular", camber_font_regular, camber_font_regular_size, {400.0f, 100.0f, false}},
        {"Noto Sans Bold", "Bold", camber_font_bold, camber_font_bold_size, {700.0f, 100.0f, false}},
        {"Noto Sans Italic", "Italic", camber_font_italic, camber_font_italic_size, {400.0f, 100.0f, true}},
    };
    for (size_t i = 0; i < sizeof fonts / sizeof *fonts; i++) {
        camber_font_entry *entry = camber_font_index_add(index, CAMBER_FONT_SHIPPED, "the Noto Sans that camber ships");
        if (!entry || !(entry->name = camber_copy_string(index->context, fonts[i].name)))
            return CAMBER_ERROR_MEMORY;
        entry->bytes = fonts[i].bytes;
        entry->size_bytes = fonts[i].size_bytes;
        entry->index = (uint32_t)i;
        entry->style = fonts[i].is;
        camber_font_entry_name(entry, "Noto Sans", fonts[i].style, NULL);
    }
    return CAMBER_OK;
}

static int compare(const void *a, const void *b) {
    const camber_font_entry *one = a, *other = b;
    if (one->origin != other->origin)
        return one->origin < other->origin ? -1 : 1;
    const int order = strcmp(one->path, other->path);
    if (order)
        return order;
    return one->index < other->index ? -1 : one->index > other->index;
}

camber_status camber_font_index_fill(camber_font_index *index, const char *const *folders, size_t folder_count,
                                     bool has_system) {
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < folder_count && !status; i++)
        status = camber_font_index_add_folder(index, folders[i]);
    if (!status)
        status = add_shipped(index);
    if (!status && has_system)
        status = camber_font_index_add_system(index);
    /* Which of several equal fonts is used must not depend on the order of files in folders. */
    if (!status && index->count)
        qsort(index->entries, index->count, sizeof *index->entries, compare);
    return status;
}
