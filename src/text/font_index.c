#include "text/font_index.h"

#include "base/embedded.h"

#include <stdlib.h>

camber_font_entry *camber_font_index_add(camber_font_index *index, camber_font_origin origin, const char *path) {
    if (!camber_grow(index->context, &index->entries, &index->capacity, index->count + 1, sizeof *index->entries))
        return NULL;
    camber_font_entry *entry = &index->entries[index->count];
    *entry = (camber_font_entry){.origin = origin, .style = CAMBER_FONT_STYLE_REGULAR};
    entry->path = camber_copy_string(index->context, path);
    if (!entry->path)
        return NULL;
    index->count++;
    return entry;
}

static void add_key(uint64_t *keys, size_t *count, uint64_t key) {
    for (size_t i = 0; i < *count; i++)
        if (keys[i] == key)
            return;
    if (*count < CAMBER_FONT_KEYS)
        keys[(*count)++] = key;
}

void camber_font_entry_name(camber_font_entry *entry, const char *family, const char *style, const char *full_name) {
    if (family && *family) {
        add_key(entry->family_keys, &entry->family_count, camber_font_name_key(family, NULL));
        add_key(entry->whole_keys, &entry->whole_count, camber_font_name_key(family, style));
    }
    if (full_name && *full_name)
        add_key(entry->whole_keys, &entry->whole_count, camber_font_name_key(full_name, NULL));
}

static camber_status add_shipped(camber_font_index *index) {
    const struct {
        const char *style;
        const unsigned char *bytes;
        unsigned long size_bytes;
        camber_font_style is;
    } fonts[] = {
        {"Regular", camber_font_regular, camber_font_regular_size, {400.0f, 100.0f, false}},
        {"Bold", camber_font_bold, camber_font_bold_size, {700.0f, 100.0f, false}},
        {"Italic", camber_font_italic, camber_font_italic_size, {400.0f, 100.0f, true}},
    };
    for (size_t i = 0; i < sizeof fonts / sizeof *fonts; i++) {
        camber_font_entry *entry = camber_font_index_add(index, CAMBER_FONT_SHIPPED, "the Noto Sans that camber ships");
        if (!entry)
            return CAMBER_ERROR_MEMORY;
        entry->bytes = fonts[i].bytes;
        entry->size_bytes = fonts[i].size_bytes;
        entry->style = fonts[i].is;
        camber_font_entry_name(entry, "Noto Sans", fonts[i].style, NULL);
    }
    return CAMBER_OK;
}

static int compare(const void *a, const void *b) {
    const camber_font_entry *one = a, *other = b;
    if (one->origin != other->origin)
        return one->origin < other->origin ? -1 : 1;
    const int order = one->origin == CAMBER_FONT_SHIPPED ? 0 : strcmp(one->path, other->path);
    if (order)
        return order;
    if (one->bytes || other->bytes)
        return one->bytes < other->bytes ? -1 : one->bytes > other->bytes;
    return one->index < other->index ? -1 : one->index > other->index;
}

camber_status camber_font_index_fill(camber_font_index *index, const char *const *folders, size_t folder_count,
                                     bool has_system) {
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < folder_count && !status; i++)
        status = camber_font_index_add_folder(index, folders[i]);
    if (!status && has_system)
        status = camber_font_index_add_system(index);
    /* Which of equal fonts is taken must not depend on the order of files in folders. */
    if (!status)
        qsort(index->entries, index->count, sizeof *index->entries, compare);
    return status ? status : add_shipped(index);
}

void camber_font_index_free(camber_font_index *index) {
    for (size_t i = 0; i < index->count; i++) {
        camber_face_close(index->context, index->entries[i].face);
        camber_free(index->context, index->entries[i].path);
    }
    camber_free(index->context, index->entries);
    if (index->config)
        FcConfigDestroy(index->config);
    *index = (camber_font_index){.context = index->context};
}

static bool has_key(const uint64_t *keys, size_t count, uint64_t key) {
    for (size_t i = 0; i < count; i++)
        if (keys[i] == key)
            return true;
    return false;
}

size_t camber_font_index_find(const camber_font_index *index, const char *name) {
    const camber_font_name wanted = camber_font_name_split(name);
    size_t best = SIZE_MAX;
    float least = 0.0f;
    for (size_t i = 0; i < index->count; i++) {
        const camber_font_entry *entry = &index->entries[i];
        if (!entry->is_broken && has_key(entry->whole_keys, entry->whole_count, wanted.whole_key))
            return i;
    }
    for (size_t i = 0; i < index->count; i++) {
        const camber_font_entry *entry = &index->entries[i];
        const float difference = camber_font_style_compare(&entry->style, &wanted.style);
        if (!entry->is_broken && (best == SIZE_MAX || difference < least) &&
            has_key(entry->family_keys, entry->family_count, wanted.family_key)) {
            best = i;
            least = difference;
        }
    }
    return best;
}

camber_status camber_font_index_open(camber_font_index *index, size_t number, camber_face **face) {
    camber_font_entry *entry = &index->entries[number];
    if (!entry->face && !entry->is_broken) {
        camber_soft_log kept;
        camber_log_soften(index->context, &kept);
        const camber_status status =
            entry->bytes
                ? camber_face_open_bytes(index->context, entry->path, entry->bytes, entry->size_bytes, &entry->face)
                : camber_face_open(index->context, entry->path, entry->index, &entry->face);
        camber_log_restore(index->context, &kept);
        if (status == CAMBER_ERROR_MEMORY)
            return camber_fail(index->context, status, "%s: there is no memory to open this font", entry->path);
        entry->is_broken = status != CAMBER_OK;
        if (status)
            camber_log(index->context, CAMBER_LOG_WARNING, "%s: this font cannot be read: other fonts draw its text",
                       entry->path);
    }
    *face = entry->face;
    return CAMBER_OK;
}
