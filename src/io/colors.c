/* Numbers the colours of a picture in one pass. Neighbouring pixels on a map are mostly equal, so the table is searched
 * only once per run of equal pixels. */
#include "io/colors.h"

enum { BITS_FIRST = 12 }; /* log2 of a slot count that fits into the first-level cache; small tables have fewer */

/* ---- Keys ---- */

camber_status camber_key_table_make(camber_context *context, size_t most, camber_key_table *table) {
    *table = (camber_key_table){.most = most};
    table->slots = camber_alloc(context, 2 * most, sizeof *table->slots);
    table->keys = table->slots ? camber_alloc(context, most, sizeof *table->keys) : NULL;
    if (table->slots && table->keys)
        return CAMBER_OK;
    camber_key_table_free(context, table);
    return CAMBER_ERROR_MEMORY;
}

void camber_key_table_free(camber_context *context, camber_key_table *table) {
    camber_free(context, table->slots);
    camber_free(context, table->keys);
    *table = (camber_key_table){0};
}

/* Returns the slot of the key, or the free slot for it. */
static size_t find_slot(const camber_key_table *table, uint32_t key) {
    const size_t mask = ((size_t)1 << table->bits) - 1;
    size_t at = (key * 2654435761u) >> (32 - table->bits); /* Knuth's multiplicative hash: the golden ratio of 2^32 */
    while (table->slots[at] && table->keys[table->slots[at] - 1] != key)
        at = (at + 1) & mask;
    return at;
}

static void use_slots(camber_key_table *table, unsigned bits) {
    table->bits = bits;
    memset(table->slots, 0, sizeof *table->slots << bits);
    for (size_t i = 0; i < table->count; i++)
        table->slots[find_slot(table, table->keys[i])] = (uint16_t)(i + 1);
}

void camber_key_table_clear(camber_key_table *table) {
    unsigned bits = BITS_FIRST;
    while (((size_t)1 << bits) > 2 * table->most)
        bits--;
    table->count = 0;
    use_slots(table, bits);
}

size_t camber_key_table_add(camber_key_table *table, uint32_t key) {
    size_t at = find_slot(table, key);
    if (table->slots[at])
        return table->slots[at] - 1u;
    if (table->count == table->most)
        return table->most;
    if (2 * (table->count + 1) > (size_t)1 << table->bits) {
        use_slots(table, table->bits + 1);
        at = find_slot(table, key);
    }
    table->keys[table->count] = key;
    table->slots[at] = (uint16_t)(table->count + 1);
    return table->count++;
}

/* ---- Colours ---- */

uint32_t camber_color_key(uint32_t color, unsigned drop) {
    uint8_t bytes[4];
    memcpy(bytes, &color, 4);
    if (bytes[3] == 0)
        return 0;
    const uint8_t mask = (uint8_t)(0xff << drop), alpha = bytes[3] & mask;
    for (int c = 0; c < 3; c++)
        bytes[c] &= mask;
    if (bytes[3] < 255)
        bytes[3] = alpha ? alpha : 1;
    memcpy(&color, bytes, 4);
    return color;
}

camber_status camber_colors_make(camber_context *context, size_t most, camber_colors *colors) {
    *colors = (camber_colors){.context = context};
    const camber_status status = camber_key_table_make(context, most, &colors->table);
    if (status != CAMBER_OK)
        return status;
    colors->colors = camber_alloc(context, most, sizeof *colors->colors);
    colors->counts = colors->colors ? camber_alloc(context, most, sizeof *colors->counts) : NULL;
    colors->votes = colors->counts ? camber_alloc(context, most, sizeof *colors->votes) : NULL;
    if (colors->votes)
        return CAMBER_OK;
    camber_colors_free(colors);
    return CAMBER_ERROR_MEMORY;
}

void camber_colors_free(camber_colors *colors) {
    if (!colors->context)
        return;
    camber_key_table_free(colors->context, &colors->table);
    camber_free(colors->context, colors->colors);
    camber_free(colors->context, colors->counts);
    camber_free(colors->context, colors->votes);
    camber_free(colors->context, colors->numbers);
    camber_free(colors->context, colors->row);
    *colors = (camber_colors){0};
}

/* Counts a run, and lets its pixels vote by the Boyer-Moore method: a colour with more than half of the votes wins. */
static void count_run(camber_colors *c, size_t number, uint32_t color, uint32_t pixels) {
    c->counts[number] += pixels;
    if (c->colors[number] == color) {
        c->votes[number] += pixels;
    } else if (c->votes[number] >= pixels) {
        c->votes[number] -= pixels;
    } else {
        c->colors[number] = color;
        c->votes[number] = pixels - c->votes[number];
    }
}

/* Numbers one row. *color and *number belong to the previous pixel. Returns false if there are too many colours. */
static bool number_row(camber_colors *c, size_t width, uint32_t *color, size_t *number, uint16_t *numbers) {
    const uint32_t *row = c->row;
    for (size_t x = 0; x < width;) {
        const uint32_t next = row[x];
        if (next != *color) {
            const size_t known = c->table.count;
            *number = camber_key_table_add(&c->table, camber_color_key(next, c->drop));
            if (*number == c->table.most)
                return false;
            if (*number == known) {
                c->colors[known] = next;
                c->counts[known] = c->votes[known] = 0;
            }
            *color = next;
        }
        const size_t first = x;
        for (const uint16_t each = (uint16_t)*number; x < width && row[x] == next; x++)
            numbers[x] = each;
        count_run(c, *number, next, (uint32_t)(x - first));
    }
    return true;
}

/* Numbers the colours with their lowest bits dropped. Returns false if there are too many. Rows are copied first: in a
 * large picture that is faster than waiting for memory at each pixel. */
static bool number_colors(camber_colors *c, const camber_pixels *pixels, uint32_t forced) {
    const size_t width = pixels->width, stride = pixels->stride_bytes ? pixels->stride_bytes : 4 * width;
    uint32_t color = 0;
    size_t number = 0;
    camber_key_table_clear(&c->table);
    for (size_t y = 0; y < pixels->height; y++) {
        memcpy(c->row, pixels->rgba + stride * y, 4 * width);
        for (size_t x = 0; x < width; x++)
            c->row[x] |= forced;
        if (y == 0)
            color = ~c->row[0];
        if (!number_row(c, width, &color, &number, c->numbers + width * y))
            return false;
    }
    return true;
}

camber_status camber_colors_number(camber_colors *colors, const camber_pixels *pixels, bool opaque, bool coarsen,
                                   bool *fits) {
    const uint8_t opaque_bytes[4] = {0, 0, 0, opaque ? 255 : 0};
    uint32_t forced;
    memcpy(&forced, opaque_bytes, sizeof forced);
    if (!camber_grow(colors->context, &colors->row, &colors->row_capacity, pixels->width, sizeof *colors->row) ||
        !camber_grow(colors->context, &colors->numbers, &colors->number_capacity,
                     (size_t)pixels->width * pixels->height, sizeof *colors->numbers))
        return CAMBER_ERROR_MEMORY;
    colors->drop = 0;
    bool found = number_colors(colors, pixels, forced);
    while (!found && coarsen) {
        colors->drop++;
        found = number_colors(colors, pixels, forced);
    }
    *fits = found;
    return CAMBER_OK;
}
