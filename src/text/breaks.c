/* Decides where lines break, by MapLibre's rules. Of all ways to break a text at places that allow a break, it takes
 * the one with the least badness:
 *
 *     average  = width of the whole text / number of lines that it needs
 *     badness  = (width - average)^2 of each line in 1/24 em, plus penalties for breaks at bad places;
 *                the last line counts half if it is short, and twice if it is long.
 *
 * A newline always breaks a line, so no break after it is paired with a break before it. Of the breaks since the last
 * newline, only the latest are tried, so few that the work stays linear in a long text. */
#include "text/scripts.h"
#include "text/shaping.h"

#include <math.h>

static const float UNITS = 24.0f; /* units per em in which badness is computed */

typedef struct line_break {
    uint32_t end;   /* the character that follows the break */
    uint32_t prior; /* index + 1 of the break before this one. 0: none */
    double x;
    double badness;
} line_break;

static bool is_breakable(uint32_t code) {
    switch (code) {
    case '\n':
    case ' ':
    case '&':
    case ')':
    case '+':
    case '-':
    case '/':
    case 0xad:   /* soft hyphen */
    case 0xb7:   /* middle dot */
    case 0x200b: /* zero width space */
    case 0x2010: /* hyphen */
    case 0x2013: /* en dash */
    case 0x2027: /* hyphenation point */ return true;
    default: return false;
    }
}

static double get_penalty(uint32_t code, uint32_t next, bool is_ideographic) {
    double penalty = is_ideographic ? 150.0 : 0.0;
    if (code == '(' || code == 0xff08)
        penalty += 50.0;
    if (next == ')' || next == 0xff09)
        penalty += 50.0;
    return penalty * penalty;
}

static double get_badness(double width, double average, bool is_last) {
    const double raggedness = (width - average) * (width - average);
    return !is_last ? raggedness : width < average ? raggedness / 2.0 : raggedness * 2.0;
}

typedef struct breaker {
    const camber_shaping *shaping;
    line_break *breaks;
    size_t count;
    size_t first;       /* the first break after the last newline */
    line_break newline; /* the last newline, or the beginning of the text */
    double average;
} breaker;

/* Returns how many earlier breaks are tried for each break. */
static size_t get_reach(const camber_shaping *shaping) {
    const size_t reach = ((size_t)1 << 22) / (shaping->count + 1);
    return reach < 64 ? 64 : reach;
}

/* Finds the best previous break, and adds the badness of the lines up to this one to the penalty that made->badness has
 * so far. */
static void choose_prior(const breaker *b, line_break *made, bool is_last) {
    const size_t reach = get_reach(b->shaping);
    const size_t first = b->count > b->first + reach ? b->count - reach : b->first;
    double best = b->newline.badness + get_badness(made->x - b->newline.x, b->average, is_last);
    bool is_found = false;
    made->prior = b->newline.prior;
    for (size_t i = b->count; i > first; i--) {
        const line_break *prior = &b->breaks[i - 1];
        const double badness = prior->badness + get_badness(made->x - prior->x, b->average, is_last);
        /* The last of several equally good breaks is used. */
        if (is_found ? badness < best : badness <= best) {
            best = badness;
            made->prior = (uint32_t)i;
            is_found = true;
        }
    }
    made->badness += best;
}

static void add_break(breaker *b, uint32_t end, double x, double penalty) {
    line_break made = {.end = end, .x = x, .badness = penalty};
    const bool is_last = end == b->shaping->count;
    choose_prior(b, &made, is_last);
    b->breaks[b->count++] = made;
    if (!is_last && b->shaping->codes[end - 1] == '\n') {
        b->newline = (line_break){.x = x, .prior = (uint32_t)b->count};
        b->first = b->count;
    }
}

static double measure(const camber_shaping *shaping, float spacing) {
    double width = 0.0;
    for (size_t i = 0; i < shaping->count; i++)
        width += (double)(shaping->characters[i].width_em + spacing);
    return width * (double)UNITS;
}

static void find_breaks(breaker *b, bool has_width, float spacing) {
    const camber_shaping *shaping = b->shaping;
    bool has_hints = false;
    double x = 0.0;
    for (size_t i = 0; i < shaping->count && !has_hints; i++)
        has_hints = shaping->codes[i] == 0x200b;
    for (size_t i = 0; i < shaping->count; i++) {
        const uint32_t code = shaping->codes[i], next = i + 1 < shaping->count ? shaping->codes[i + 1] : 0;
        if (!camber_is_white(code))
            x += (double)((shaping->characters[i].width_em + spacing) * UNITS);
        if (i + 1 == shaping->count || (!has_width && code != '\n') ||
            (code != '\n' && shaping->characters[i + 1].is_mark))
            continue;
        const bool is_ideographic = camber_is_ideographic(code);
        if (is_breakable(code) || is_ideographic || shaping->characters[i].is_image ||
            (i + 2 < shaping->count && next == '('))
            add_break(b, (uint32_t)i + 1, x, get_penalty(code, next, is_ideographic && has_hints));
    }
    add_break(b, (uint32_t)shaping->count, x, 0.0);
}

/* Returns a line without the white space at its ends. */
static camber_line_break trim(const camber_shaping *shaping, uint32_t first, uint32_t end) {
    while (first < end && camber_is_white(shaping->codes[first]))
        first++;
    while (end > first && camber_is_white(shaping->codes[end - 1]))
        end--;
    return (camber_line_break){first, end};
}

camber_status camber_shaping_break(camber_context *context, camber_shaping *shaping, const camber_text_desc *desc) {
    const float spacing = camber_shaping_spacing(shaping, desc);
    const bool has_width = desc->max_width_em > 0.0f;
    if (shaping->count == 0)
        return CAMBER_OK;
    if (!camber_grow(context, &shaping->breaks, &shaping->break_capacity, shaping->count + 1, sizeof(line_break)))
        return CAMBER_ERROR_MEMORY;
    breaker b = {.shaping = shaping, .breaks = shaping->breaks};
    const double width = measure(shaping, spacing);
    const double line_count = has_width ? ceil(width / ((double)desc->max_width_em * (double)UNITS)) : 1.0;
    b.average = width / (line_count > 1.0 ? line_count : 1.0);
    find_breaks(&b, has_width, spacing);
    size_t count = 0;
    for (uint32_t at = (uint32_t)b.count; at; at = b.breaks[at - 1].prior)
        count++;
    if (!camber_grow(context, &shaping->lines, &shaping->line_capacity, count, sizeof *shaping->lines))
        return CAMBER_ERROR_MEMORY;
    shaping->line_count = count;
    for (uint32_t at = (uint32_t)b.count, prior; at; at = prior) {
        prior = b.breaks[at - 1].prior;
        shaping->lines[--count] = trim(shaping, prior ? b.breaks[prior - 1].end : 0, b.breaks[at - 1].end);
    }
    return CAMBER_OK;
}
