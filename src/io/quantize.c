/* Chooses a palette of up to 256 colours for a map. Input: its numbered colours and their pixel counts. Output: the
 * palette, and each colour's index in it.
 *
 * A map has a few colours that its author chose, and many mixtures of them by coverage, on the straight lines between
 * them. So flat colours, which many pixels have, get their own entries first, and mixtures that hardly differ from a
 * flat colour are replaced by it. The other colours are grouped into cells a few levels wide, and each cell takes the
 * nearest palette entry. The cell that contributes most to the error becomes an entry, until the error is small; then
 * the cell that is farthest from its entry does, until none is far away. Finally each entry becomes the mean of the
 * cells that took it.
 *
 * All sums are integers, so the result is the same on every machine. */
#include "io/quantize.h"

enum {
    FLAT_SHARE = 200,   /* a colour is flat if at least one in this many pixels has it */
    NEAR_LEVELS = 2,    /* a mixture is replaced by a flat colour if all channels differ by at most this, out of 255 */
    CELL_DROP = 2,      /* bits dropped: a cell is 4 levels wide */
    MEAN_PERCENT = 10,  /* target for the mean over all pixels of the channels' squared differences, added up: 0.1 */
    MEAN_COLORS = 80,   /* but only up to this many colours are chosen to reduce the mean */
    SQUARES_MOST = 144, /* the largest sum of squared differences of a cell: 12 levels */
};

typedef struct cell {
    uint8_t color[4];
    uint8_t place; /* index in the palette */
    uint16_t number;
    uint32_t pixels;
    uint32_t squares; /* sum of squared differences from its entry */
} cell;

struct camber_quantizer {
    camber_context *context;
    camber_key_table table;
    cell *cells;          /* CAMBER_KEYS_MOST */
    uint64_t (*sums)[5];  /* by cell: sums of its colours, weighted by pixels, and its pixels */
    uint16_t *cell_of;    /* by colour: its cell, or NO_CELL */
    uint8_t *cell_places; /* by cell: index in the palette */
};

static const uint16_t NO_CELL = UINT16_MAX;

camber_status camber_quantizer_create(camber_context *context, camber_quantizer **quantizer) {
    camber_quantizer *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = context;
    camber_status status = camber_key_table_make(context, CAMBER_KEYS_MOST, &made->table);
    if (status == CAMBER_OK && (!(made->cells = camber_alloc(context, CAMBER_KEYS_MOST, sizeof *made->cells)) ||
                                !(made->sums = camber_alloc(context, CAMBER_KEYS_MOST, sizeof *made->sums)) ||
                                !(made->cell_of = camber_alloc(context, CAMBER_KEYS_MOST, sizeof *made->cell_of)) ||
                                !(made->cell_places = camber_alloc(context, CAMBER_KEYS_MOST, 1))))
        status = CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK)
        *quantizer = made;
    else
        camber_quantizer_destroy(made);
    return status;
}

void camber_quantizer_destroy(camber_quantizer *quantizer) {
    if (!quantizer)
        return;
    camber_context *context = quantizer->context;
    camber_key_table_free(context, &quantizer->table);
    camber_free(context, quantizer->cells);
    camber_free(context, quantizer->sums);
    camber_free(context, quantizer->cell_of);
    camber_free(context, quantizer->cell_places);
    camber_free(context, quantizer);
}

/* ---- Flat colours ---- */

static uint64_t count_pixels(const camber_colors *colors) {
    uint64_t pixels = 0;
    for (size_t i = 0; i < colors->table.count; i++)
        pixels += colors->counts[i];
    return pixels;
}

static bool is_flat(const camber_colors *colors, size_t number, uint64_t pixels) {
    uint8_t color[4];
    memcpy(color, &colors->colors[number], 4);
    return color[3] == 0 || (uint64_t)FLAT_SHARE * colors->counts[number] > pixels;
}

/* Gives entries to the transparent colour and to flat colours, of which there are at most FLAT_SHARE. */
static void take_flat(camber_quantizer *self, const camber_colors *colors, camber_palette *palette) {
    const uint64_t pixels = count_pixels(colors);
    palette->count = 0;
    for (size_t i = 0; i < colors->table.count; i++) {
        const bool flat = is_flat(colors, i, pixels);
        self->cell_of[i] = flat ? NO_CELL : 0;
        if (!flat)
            continue;
        memcpy(palette->colors[palette->count], &colors->colors[i], 4);
        palette->places[i] = (uint8_t)palette->count++;
    }
}

static bool is_opaque(const uint8_t color[4]) {
    return color[3] == 255;
}

/* Returns a flat colour that can replace this one, or palette->count if there is none. */
static size_t find_near(const camber_palette *palette, const uint8_t color[4]) {
    size_t found = palette->count;
    int least = NEAR_LEVELS + 1;
    for (size_t i = 0; i < palette->count; i++) {
        const uint8_t *flat = palette->colors[i];
        int apart = 0;
        for (int c = 0; c < 4; c++) {
            const int distance = color[c] > flat[c] ? color[c] - flat[c] : flat[c] - color[c];
            apart = distance > apart ? distance : apart;
        }
        if (apart < least && flat[3] > 0 && is_opaque(flat) == is_opaque(color)) {
            least = apart;
            found = i;
        }
    }
    return found;
}

/* ---- Cells ---- */

static void add_to_cell(camber_quantizer *self, size_t number, const uint8_t color[4], uint32_t pixels) {
    uint64_t *sums = self->sums[number];
    for (int c = 0; c < 4; c++)
        sums[c] += (uint64_t)color[c] * pixels;
    sums[4] += pixels;
}

/* Groups the colours that are neither flat nor close to a flat one into cells. */
static size_t make_cells(camber_quantizer *self, const camber_colors *colors, camber_palette *palette) {
    camber_key_table_clear(&self->table);
    for (size_t i = 0; i < colors->table.count; i++) {
        uint8_t color[4];
        memcpy(color, &colors->colors[i], 4);
        if (self->cell_of[i] == NO_CELL)
            continue;
        const size_t near = find_near(palette, color);
        if (near < palette->count) {
            self->cell_of[i] = NO_CELL;
            palette->places[i] = (uint8_t)near;
            continue;
        }
        const size_t known = self->table.count;
        const size_t number = camber_key_table_add(&self->table, camber_color_key(colors->colors[i], CELL_DROP));
        if (number == known)
            memset(self->sums[number], 0, sizeof *self->sums);
        self->cell_of[i] = (uint16_t)number;
        add_to_cell(self, number, color, colors->counts[i]);
    }
    for (size_t i = 0; i < self->table.count; i++) {
        const uint64_t *sums = self->sums[i], pixels = sums[4];
        self->cells[i] = (cell){.number = (uint16_t)i, .pixels = (uint32_t)pixels, .squares = UINT32_MAX};
        for (int c = 0; c < 4; c++)
            self->cells[i].color[c] = (uint8_t)((sums[c] + pixels / 2) / pixels);
    }
    return self->table.count;
}

/* Moves opaque cells to the front. Opaque cells take only opaque entries, and other cells only entries that are not
 * opaque. */
static size_t part_opaque(cell *cells, size_t count) {
    size_t opaque = 0;
    for (size_t i = 0; i < count; i++) {
        if (!is_opaque(cells[i].color))
            continue;
        const cell moved = cells[i];
        cells[i] = cells[opaque];
        cells[opaque++] = moved;
    }
    return opaque;
}

/* ---- The palette ---- */

typedef struct cell_range {
    cell *cells;
    size_t count, opaque;
    uint64_t pixels; /* pixels of the picture */
} cell_range;

/* Assigns this entry to the cells that are closer to it than to their current one. */
static void offer_color(const cell_range *range, const uint8_t color[4], size_t place) {
    const bool opaque = is_opaque(color);
    cell *const end = range->cells + (opaque ? range->opaque : range->count);
    for (cell *c = range->cells + (opaque ? 0 : range->opaque); c < end; c++) {
        uint32_t squares = 0;
        for (int k = 0; k < 4; k++)
            squares += (uint32_t)((c->color[k] - color[k]) * (c->color[k] - color[k]));
        c->place = squares < c->squares ? (uint8_t)place : c->place;
        c->squares = squares < c->squares ? squares : c->squares;
    }
}

/* Returns the cell whose colour the palette needs most, or NULL if the palette is good enough. */
static const cell *choose_cell(const cell_range *range, size_t color_count) {
    const cell *heaviest = NULL, *farthest = NULL;
    uint64_t most = 0, sum = 0;
    uint32_t far = SQUARES_MOST;
    for (const cell *c = range->cells; c < range->cells + range->count; c++) {
        const uint64_t error = (uint64_t)c->pixels * c->squares;
        sum += error;
        if (error > most) {
            most = error;
            heaviest = c;
        }
        if (c->squares > far) {
            far = c->squares;
            farthest = c;
        }
    }
    return color_count < MEAN_COLORS && 100 * sum > MEAN_PERCENT * range->pixels ? heaviest : farthest;
}

static void choose_colors(const cell_range *range, camber_palette *palette) {
    for (size_t i = 0; i < palette->count; i++)
        if (palette->colors[i][3] > 0)
            offer_color(range, palette->colors[i], i);
    while (palette->count < CAMBER_PALETTE_MOST) {
        const cell *chosen = choose_cell(range, palette->count);
        if (!chosen)
            break;
        uint8_t *color = palette->colors[palette->count];
        memcpy(color, chosen->color, 4);
        offer_color(range, color, palette->count++);
    }
}

/* Replaces entries that are not flat by the mean of the cells that took them. Each has at least the cell from which it
 * was made. */
static void center_colors(const cell_range *range, size_t flat_count, camber_palette *palette) {
    uint64_t sums[CAMBER_PALETTE_MOST][5] = {{0}};
    for (const cell *c = range->cells; c < range->cells + range->count; c++) {
        for (int k = 0; k < 4; k++)
            sums[c->place][k] += (uint64_t)c->pixels * c->color[k];
        sums[c->place][4] += c->pixels;
    }
    for (size_t i = flat_count; i < palette->count; i++)
        for (int k = 0; k < 4; k++)
            palette->colors[i][k] = (uint8_t)((sums[i][k] + sums[i][4] / 2) / sums[i][4]);
}

void camber_quantize(camber_quantizer *quantizer, const camber_colors *colors, camber_palette *palette) {
    take_flat(quantizer, colors, palette);
    cell_range range = {
        .cells = quantizer->cells, .count = make_cells(quantizer, colors, palette), .pixels = count_pixels(colors)};
    range.opaque = part_opaque(range.cells, range.count);
    const size_t flat_count = palette->count;
    choose_colors(&range, palette);
    center_colors(&range, flat_count, palette);
    for (size_t i = 0; i < range.count; i++)
        quantizer->cell_places[range.cells[i].number] = range.cells[i].place;
    for (size_t i = 0; i < colors->table.count; i++)
        if (quantizer->cell_of[i] != NO_CELL)
            palette->places[i] = quantizer->cell_places[quantizer->cell_of[i]];
}

bool camber_colors_have_flat(const camber_colors *colors) {
    const uint64_t pixels = count_pixels(colors);
    uint64_t flat = 0;
    for (size_t i = 0; i < colors->table.count; i++)
        flat += is_flat(colors, i, pixels) ? colors->counts[i] : 0;
    return 2 * flat > pixels;
}
