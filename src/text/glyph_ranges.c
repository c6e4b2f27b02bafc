/* Reads ranges of glyphs when a text asks for a character in them. Messages are kept as protobuf unpacked them; a
 * glyph's bitmap becomes rings when its outline is needed. Glyphs outside their range, glyphs with metrics beyond
 * MOST_METRIC_PX, and bitmaps that do not have the size that they claim are left out. */
#include "text/glyph_ranges.h"

#include "text/contours.h"
#include "text/distances.h"

#include <glyphs.pb-c.h>

static const uint32_t MOST_BITMAP_PX = 256; /* in width and in height */
static const uint32_t MOST_METRIC_PX = 4096;

/* The memory that protobuf allocates from. */
typedef struct message_memory {
    camber_context *context;
    bool is_exhausted;
} message_memory;

static void *allocate(void *user, size_t size_bytes) {
    message_memory *memory = user;
    void *block = camber_alloc(memory->context, 1, size_bytes);
    memory->is_exhausted = memory->is_exhausted || !block;
    return block;
}

static void release(void *user, void *block) {
    camber_free(((message_memory *)user)->context, block);
}

static void free_message(camber_context *context, Camber__Glyphs__Range *range) {
    message_memory memory = {.context = context};
    ProtobufCAllocator allocator = {allocate, release, &memory};
    if (range)
        camber__glyphs__range__free_unpacked(range, &allocator);
}

/* Finds the baseline: it is the bottom of the letter H. */
static float find_ascender(camber_glyph_ranges *ranges) {
    static const char letters[] = "HEIx";
    for (const char *letter = letters; *letter; letter++) {
        const uint32_t index = camber_number_map_get(&ranges->found, (uint32_t)*letter);
        const camber_range_glyph *glyph = index ? &ranges->glyphs[index - 1] : NULL;
        if (glyph && glyph->height)
            return ((float)glyph->height - (float)glyph->top) / CAMBER_RANGE_EM_PX;
    }
    return 26.0f / CAMBER_RANGE_EM_PX;
}

camber_status camber_glyph_ranges_open(camber_context *context, camber_glyph_range_fn *read, void *user,
                                       const char *stack, camber_glyph_ranges **ranges) {
    camber_glyph_ranges *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    *made = (camber_glyph_ranges){.context = context, .read = read, .user = user};
    made->stack = camber_copy_string(context, stack);
    camber_status status = made->stack ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    if (!status) {
        camber_glyph_ranges_has(made, 'H');
        status = made->status;
    }
    if (status) {
        camber_glyph_ranges_close(made);
        return status;
    }
    made->ascender_em = find_ascender(made);
    *ranges = made;
    return CAMBER_OK;
}

void camber_glyph_ranges_close(camber_glyph_ranges *ranges) {
    if (!ranges)
        return;
    for (size_t i = 0; i < ranges->loaded_count; i++)
        free_message(ranges->context, ranges->loaded[i]);
    camber_free(ranges->context, ranges->loaded);
    camber_free(ranges->context, ranges->glyphs);
    camber_free(ranges->context, ranges->stack);
    camber_number_map_free(ranges->context, &ranges->asked);
    camber_number_map_free(ranges->context, &ranges->found);
    camber_free(ranges->context, ranges);
}

/* Whether a glyph can be used. A bitmap that does not have the glyph's size is ignored. */
static bool check_glyph(const Camber__Glyphs__Glyph *glyph, uint32_t first, camber_range_glyph *checked) {
    const int32_t most = (int32_t)MOST_METRIC_PX;
    if (!glyph->has_id || glyph->id < first || glyph->id - first > 255 || glyph->advance > MOST_METRIC_PX ||
        glyph->left < -most || glyph->left > most || glyph->top < -most || glyph->top > most)
        return false;
    *checked = (camber_range_glyph){.left = glyph->left, .top = glyph->top, .advance = glyph->advance};
    if (glyph->width && glyph->height && glyph->width <= MOST_BITMAP_PX && glyph->height <= MOST_BITMAP_PX &&
        glyph->bitmap.len ==
            (size_t)(glyph->width + 2 * CAMBER_RANGE_BORDER_PX) * (glyph->height + 2 * CAMBER_RANGE_BORDER_PX)) {
        checked->values = glyph->bitmap.data;
        checked->width = glyph->width;
        checked->height = glyph->height;
    }
    return true;
}

/* Records the glyphs of a range. If two glyphs have the same code point, the first is used. */
static bool note_glyphs(camber_glyph_ranges *ranges, const Camber__Glyphs__Range *range, uint32_t first) {
    for (size_t i = 0; i < range->n_stacks; i++)
        for (size_t j = 0; j < range->stacks[i]->n_glyphs; j++) {
            const Camber__Glyphs__Glyph *glyph = range->stacks[i]->glyphs[j];
            camber_range_glyph checked;
            if (!check_glyph(glyph, first, &checked) || camber_number_map_get(&ranges->found, glyph->id))
                continue;
            if (!camber_grow(ranges->context, &ranges->glyphs, &ranges->glyph_capacity, ranges->glyph_count + 1,
                             sizeof *ranges->glyphs))
                return false;
            ranges->glyphs[ranges->glyph_count++] = checked;
            if (!camber_number_map_set(ranges->context, &ranges->found, glyph->id, (uint32_t)ranges->glyph_count))
                return false;
        }
    return true;
}

/* Sets *range to NULL if the bytes are not a range. */
static camber_status unpack(camber_context *context, const uint8_t *bytes, size_t size_bytes,
                            Camber__Glyphs__Range **range) {
    message_memory memory = {.context = context};
    ProtobufCAllocator allocator = {allocate, release, &memory};
    camber_saved_log kept;
    camber_log_demote_errors(context, &kept);
    *range = camber__glyphs__range__unpack(&allocator, size_bytes, bytes);
    camber_log_restore(context, &kept);
    return *range || !memory.is_exhausted
               ? CAMBER_OK
               : camber_fail(context, CAMBER_ERROR_MEMORY, "there is no memory for a range of glyphs of %zu bytes",
                             size_bytes);
}

static camber_status load(camber_glyph_ranges *ranges, uint32_t first) {
    camber_context *context = ranges->context;
    Camber__Glyphs__Range *range = NULL;
    const uint8_t *bytes = NULL;
    size_t size_bytes = 0;
    const camber_status found = ranges->read(ranges->user, ranges->stack, first, &bytes, &size_bytes);
    if (found == CAMBER_ERROR_MEMORY)
        return found;
    camber_status status = found ? CAMBER_OK : unpack(context, bytes, size_bytes, &range);
    if (!status && !camber_grow(context, &ranges->loaded, &ranges->loaded_capacity, ranges->loaded_count + 1,
                                sizeof *ranges->loaded))
        status = CAMBER_ERROR_MEMORY;
    if (status) {
        free_message(context, range);
        return status;
    }
    if (range) {
        ranges->loaded[ranges->loaded_count++] = range;
        if (!note_glyphs(ranges, range, first))
            return CAMBER_ERROR_MEMORY;
    }
    if (!range && found != CAMBER_ERROR_NOT_FOUND && !ranges->is_told) {
        camber_log(context, CAMBER_LOG_WARNING,
                   "glyphs of %s: the range from U+%04X cannot be read: other fonts draw it", ranges->stack,
                   (unsigned)first);
        ranges->is_told = true;
    }
    return camber_number_map_set(context, &ranges->asked, first >> 8, 1) ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}

bool camber_glyph_ranges_has(camber_glyph_ranges *ranges, uint32_t code) {
    if (!ranges->status && !camber_number_map_get(&ranges->asked, code >> 8))
        ranges->status = load(ranges, code & ~255u);
    return camber_number_map_get(&ranges->found, code) != 0;
}

static const camber_range_glyph *get_glyph(const camber_glyph_ranges *ranges, uint32_t code) {
    const uint32_t index = camber_number_map_get(&ranges->found, code);
    return index ? &ranges->glyphs[index - 1] : NULL;
}

float camber_glyph_ranges_advance_em(const camber_glyph_ranges *ranges, uint32_t code) {
    const camber_range_glyph *glyph = get_glyph(ranges, code);
    return glyph ? (float)glyph->advance / CAMBER_RANGE_EM_PX : 0.0f;
}

void camber_glyph_ranges_draw(const camber_glyph_ranges *ranges, uint32_t code, camber_outline_maker *maker) {
    const camber_range_glyph *glyph = get_glyph(ranges, code);
    if (!glyph || !glyph->values)
        return;
    const size_t width = glyph->width + 2 * CAMBER_RANGE_BORDER_PX, height = glyph->height + 2 * CAMBER_RANGE_BORDER_PX;
    float *values = camber_distances_refine(ranges->context, glyph->values, width, height);
    if (!values) {
        maker->status = CAMBER_ERROR_MEMORY;
        return;
    }
    /* Each value belongs to the centre of a pixel. */
    const camber_contour_source source = {
        .values = values,
        .width = CAMBER_DISTANCE_STEPS * ((uint32_t)width - 1) + 1,
        .height = CAMBER_DISTANCE_STEPS * ((uint32_t)height - 1) + 1,
        .left = ((float)glyph->left - CAMBER_RANGE_BORDER_PX + 0.5f) / CAMBER_RANGE_EM_PX,
        .top = (-(float)glyph->top - CAMBER_RANGE_BORDER_PX + 0.5f) / CAMBER_RANGE_EM_PX - ranges->ascender_em,
        .scale = 1.0f / (CAMBER_DISTANCE_STEPS * CAMBER_RANGE_EM_PX),
    };
    camber_contours_trace(&source, maker);
    camber_free(ranges->context, values);
}
