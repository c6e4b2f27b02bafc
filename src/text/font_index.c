/* The list of fonts: keeps their names as keys, finds the font that a name means, and opens fonts when they are needed.
 */
#include "text/font_index.h"

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

void camber_font_index_free(camber_font_index *index) {
    for (size_t i = 0; i < index->count; i++) {
        camber_face_close(index->context, index->entries[i].face);
        camber_free(index->context, index->entries[i].path);
        camber_free(index->context, index->entries[i].name);
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

size_t camber_font_index_find_family(const camber_font_index *index, uint64_t family_key,
                                     const camber_font_style *style) {
    size_t best = SIZE_MAX;
    float least = 0.0f;
    for (size_t i = 0; i < index->count; i++) {
        const camber_font_entry *entry = &index->entries[i];
        const float difference = camber_font_style_compare(&entry->style, style);
        if (!entry->is_broken && (best == SIZE_MAX || difference < least) &&
            has_key(entry->family_keys, entry->family_count, family_key)) {
            best = i;
            least = difference;
        }
    }
    return best;
}

size_t camber_font_index_find(const camber_font_index *index, const char *name) {
    const camber_font_name wanted = camber_font_name_split(name);
    for (size_t i = 0; i < index->count; i++) {
        const camber_font_entry *entry = &index->entries[i];
        if (!entry->is_broken && has_key(entry->whole_keys, entry->whole_count, wanted.whole_key))
            return i;
    }
    return camber_font_index_find_family(index, wanted.family_key, &wanted.style);
}

camber_status camber_font_index_open(camber_font_index *index, size_t number, camber_face **face) {
    camber_font_entry *entry = &index->entries[number];
    if (!entry->face && !entry->is_broken) {
        camber_saved_log kept;
        camber_log_demote_errors(index->context, &kept);
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
