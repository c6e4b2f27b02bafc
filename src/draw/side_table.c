/* Fills the side table of a frame with dashes and the stops of ramps, each once. */
#include "draw/side_table.h"

#include <float.h>
#include <math.h>
#include <string.h>

void camber_side_table_clear(camber_side_table *table) {
    table->count = table->ramp_count = 0;
    table->dash = NULL;
}

void camber_side_table_free(camber_side_table *table) {
    camber_free(table->context, table->ramps);
    camber_free(table->context, table->texels);
}

float *camber_side_table_add(camber_side_table *table, size_t texels) {
    if (!camber_grow(table->context, &table->texels, &table->capacity, table->count + texels,
                     4 * sizeof *table->texels))
        return NULL;
    float *added = table->texels + 4 * table->count;
    memset(added, 0, 4 * texels * sizeof *added);
    table->count += texels;
    return added;
}

static camber_status add_texels(camber_side_table *table, size_t texels, uint32_t *first, float **added) {
    if (table->count + texels > CAMBER_SIDE_TABLE_MAX) {
        camber_fail(table->context, CAMBER_ERROR_LIMIT,
                    "the dashes and ramps of a frame take more than %d texels; draw fewer of them",
                    (int)CAMBER_SIDE_TABLE_MAX);
        return CAMBER_ERROR_LIMIT;
    }
    *first = (uint32_t)table->count;
    *added = camber_side_table_add(table, texels);
    return *added ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}

/* ---- Dashes: one texel each, with its beginning and its end, px ---- */

/* Returns the period in the dash's own unit. */
static double period_of(const camber_dash *dash) {
    double sum = 0.0;
    for (size_t i = 0; i < dash->count; i++)
        sum += (double)dash->lengths[i];
    return sum * (dash->count % 2 ? 2.0 : 1.0);
}

static bool is_dash(const camber_dash *dash) {
    if (dash->count == 0 || dash->count > CAMBER_DASH_LENGTHS_MAX)
        return false;
    for (size_t i = 0; i < dash->count; i++)
        if (!(dash->lengths[i] >= 0.0f))
            return false;
    const double period = period_of(dash);
    return period > 0.0 && period <= (double)FLT_MAX;
}

/* Returns the dashes of a period, plus one before and one after. A list with an odd count of lengths is repeated twice.
 */
static size_t texels_of(const camber_dash *dash) {
    return (dash->count % 2 ? dash->count : dash->count / 2) + 2;
}

static float *put_dash(float *texel, double from, double to) {
    texel[0] = (float)from;
    texel[1] = (float)to;
    return texel + 4;
}

/* Writes a period. Its last dash is repeated before it, and its first one after it, so that the shader need not wrap
 * around. */
static void put_period(const camber_dash *dash, double unit_px, double period_px, float *texel) {
    const size_t lengths = dash->count * (dash->count % 2 ? 2 : 1);
    const double left_out = (double)dash->lengths[(lengths - 1) % dash->count] * unit_px;
    double at = 0.0;
    texel = put_dash(texel, -left_out - (double)dash->lengths[(lengths - 2) % dash->count] * unit_px, -left_out);
    for (size_t i = 0; i < lengths; i += 2) {
        const double end = at + (double)dash->lengths[i % dash->count] * unit_px;
        texel = put_dash(texel, at, end);
        at = end + (double)dash->lengths[(i + 1) % dash->count] * unit_px;
    }
    put_dash(texel, period_px, period_px + (double)dash->lengths[0] * unit_px);
}

camber_status camber_side_table_add_dash(camber_side_table *table, const camber_dash *dash, float unit_px,
                                         bool is_round, camber_side_dashes *dashes) {
    if (table->dash != dash || memcmp(&table->dash_unit_px, &unit_px, sizeof unit_px) != 0) {
        if (!is_dash(dash))
            return camber_fail(table->context, CAMBER_ERROR_ARGUMENT,
                               "a dash of %zu lengths; give up to %d of 0 and more, and one above 0", dash->count,
                               CAMBER_DASH_LENGTHS_MAX);
        const double unit = unit_px > 0.0f ? (double)unit_px : 1.0, period_px = period_of(dash) * unit;
        camber_side_dashes made = {.count = (uint32_t)texels_of(dash), .period_px = (float)period_px};
        float *texels = NULL;
        const camber_status status = add_texels(table, made.count, &made.first, &texels);
        if (status != CAMBER_OK)
            return status;
        put_period(dash, unit, period_px, texels);
        table->dash = dash;
        table->dash_unit_px = unit_px;
        table->dashes = made;
    }
    *dashes = table->dashes;
    dashes->are_round = is_round;
    return CAMBER_OK;
}

/* ---- Ramps: two texels per stop, its position and its premultiplied colour ---- */

static bool is_ramp(const camber_ramp *ramp) {
    if (ramp->count == 0 || ramp->count > CAMBER_RAMP_STOPS_MAX)
        return false;
    float before = -FLT_MAX;
    for (size_t i = 0; i < ramp->count; i++) {
        const camber_ramp_stop *stop = ramp->stops + i;
        const camber_color c = stop->color;
        if (!(stop->place >= before && stop->place <= FLT_MAX && isfinite(c.r + c.g + c.b + c.a)))
            return false;
        before = stop->place;
    }
    return true;
}

/* Finds a ramp, or returns NULL if the table does not have it. It searches from the end, because consecutive rows
 * usually have the same ramp. */
static const camber_side_ramp *find_ramp(const camber_side_table *table, const camber_ramp *ramp) {
    for (size_t i = table->ramp_count; i-- > 0;)
        if (table->ramps[i].ramp == ramp)
            return table->ramps + i;
    return NULL;
}

static void put_stop(const camber_ramp_stop *stop, float *texels) {
    const camber_color c = stop->color;
    texels[0] = stop->place;
    texels[4] = c.r * c.a;
    texels[5] = c.g * c.a;
    texels[6] = c.b * c.a;
    texels[7] = c.a;
}

camber_status camber_side_table_add_ramp(camber_side_table *table, const camber_ramp *ramp, uint32_t *first) {
    const camber_side_ramp *there = find_ramp(table, ramp);
    float *texels = NULL;
    if (there) {
        *first = there->first;
        return CAMBER_OK;
    }
    if (!is_ramp(ramp))
        return camber_fail(table->context, CAMBER_ERROR_ARGUMENT,
                           "a ramp of %zu stops; give 1 to %d in ascending places, and finite colours", ramp->count,
                           CAMBER_RAMP_STOPS_MAX);
    if (!camber_grow(table->context, &table->ramps, &table->ramp_capacity, table->ramp_count + 1, sizeof *table->ramps))
        return CAMBER_ERROR_MEMORY;
    const camber_status status = add_texels(table, 2 * ramp->count, first, &texels);
    if (status != CAMBER_OK)
        return status;
    table->ramps[table->ramp_count++] = (camber_side_ramp){ramp, *first};
    for (size_t i = 0; i < ramp->count; i++)
        put_stop(ramp->stops + i, texels + 8 * i);
    return CAMBER_OK;
}
