/* The tail of the row texture, behind the tables: what rows name there, dashes and the stops of ramps. */
#include "draw/renderer.h"

#include <float.h>
#include <math.h>
#include <string.h>

GLint camber_renderer_tail(size_t row_count) {
    return (GLint)(CAMBER_TEXELS_A_ROW * row_count);
}

void camber_tail_forget(camber_renderer *renderer) {
    renderer->tail_count = renderer->ramp_count = 0;
}

static bool make_room(camber_renderer *renderer, size_t texels) {
    return camber_grow(renderer->share.device->context, &renderer->tail_texels, &renderer->tail_capacity,
                       renderer->tail_count + texels, 4 * sizeof *renderer->tail_texels);
}

float *camber_tail_add(camber_renderer *renderer, size_t texels) {
    if (!make_room(renderer, texels))
        return NULL;
    float *added = renderer->tail_texels + 4 * renderer->tail_count;
    memset(added, 0, 4 * texels * sizeof *added);
    renderer->tail_count += texels;
    return added;
}

/* ---- Dashes: a texel each, from where to where it goes ---- */

/* In its unit. */
static double period_of(const camber_dash *dash) {
    double sum = 0.0;
    for (size_t i = 0; i < dash->count; i++)
        sum += (double)dash->lengths[i];
    return sum * (dash->count % 2 ? 2.0 : 1.0);
}

bool camber_dash_is_valid(const camber_dash *dash) {
    if (dash->count == 0 || dash->count > CAMBER_DASH_LENGTHS_MAX)
        return false;
    for (size_t i = 0; i < dash->count; i++)
        if (!(dash->lengths[i] >= 0.0f))
            return false;
    const double period = period_of(dash);
    return period > 0.0 && period <= (double)FLT_MAX;
}

/* Of the texture, with one more before and behind. */
static size_t dash_texels(const camber_dash *dash) {
    return (dash->count % 2 ? dash->count : dash->count / 2) + 2;
}

static void put_dash(camber_renderer *renderer, double from, double to) {
    float *texel = renderer->tail_texels + 4 * renderer->tail_count++;
    texel[0] = (float)from;
    texel[1] = (float)to;
    texel[2] = texel[3] = 0.0f;
}

/* A period's last dash stands before it once more and its first one behind it, so that the shader need not look
 * around. */
camber_status camber_tail_put_dash(camber_renderer *renderer, const camber_pass *pass, uint32_t row, float texel[4]) {
    const camber_paint *paint = pass->paints + row;
    const camber_dash *dash = pass->dashes + paint->dash - 1;
    const bool round = pass->mesh->host_rows[row].cap == CAMBER_CAP_ROUND;
    const double unit_px = paint->dash_unit_px > 0.0f ? (double)paint->dash_unit_px : 1.0;
    const size_t lengths = dash->count * (dash->count % 2 ? 2 : 1), count = dash_texels(dash);
    const double period = period_of(dash) * unit_px;
    const double left_out = (double)dash->lengths[(lengths - 1) % dash->count] * unit_px;
    double at = 0.0;
    if (!make_room(renderer, count))
        return CAMBER_ERROR_MEMORY;
    texel[0] = (float)renderer->tail_count;
    texel[1] = (float)(2 * count + round);
    texel[2] = (float)period;
    put_dash(renderer, -left_out - (double)dash->lengths[(lengths - 2) % dash->count] * unit_px, -left_out);
    for (size_t i = 0; i < lengths; i += 2) {
        const double end = at + (double)dash->lengths[i % dash->count] * unit_px;
        put_dash(renderer, at, end);
        at = end + (double)dash->lengths[(i + 1) % dash->count] * unit_px;
    }
    put_dash(renderer, period, period + (double)dash->lengths[0] * unit_px);
    return CAMBER_OK;
}

/* ---- Ramps: two texels a stop, its place and its premultiplied colour ---- */

bool camber_ramp_is_valid(const camber_ramp *ramp) {
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

size_t camber_tail_need(const camber_pass *pass) {
    size_t texels = 0;
    for (size_t i = 0; i < pass->ramp_count; i++)
        texels += 2 * pass->ramps[i].count;
    for (size_t i = 0; i < pass->paint_count && pass->dashes; i++)
        texels += pass->paints[i].dash ? dash_texels(pass->dashes + pass->paints[i].dash - 1) : 0;
    return texels;
}

/* Where the ramp lies, if it is there: rows that follow each other mostly have the same. */
static const camber_ramp_place *find_ramp(const camber_renderer *renderer, const camber_ramp *ramp) {
    for (size_t i = renderer->ramp_count; i-- > 0;)
        if (renderer->ramps[i].ramp == ramp)
            return renderer->ramps + i;
    return NULL;
}

camber_status camber_tail_put_ramp(camber_renderer *renderer, const camber_ramp *ramp, float texel[2]) {
    const camber_ramp_place *there = find_ramp(renderer, ramp);
    if (there) {
        texel[0] = (float)there->texel;
        texel[1] = (float)ramp->count;
        return CAMBER_OK;
    }
    if (!make_room(renderer, 2 * ramp->count) ||
        !camber_grow(renderer->share.device->context, &renderer->ramps, &renderer->ramp_capacity,
                     renderer->ramp_count + 1, sizeof *renderer->ramps))
        return CAMBER_ERROR_MEMORY;
    texel[0] = (float)renderer->tail_count;
    texel[1] = (float)ramp->count;
    renderer->ramps[renderer->ramp_count++] = (camber_ramp_place){ramp, renderer->tail_count};
    for (size_t i = 0; i < ramp->count; i++) {
        const camber_color c = ramp->stops[i].color;
        float *place = renderer->tail_texels + 4 * renderer->tail_count, *color = place + 4;
        place[0] = ramp->stops[i].place;
        place[1] = place[2] = place[3] = 0.0f;
        color[0] = c.r * c.a;
        color[1] = c.g * c.a;
        color[2] = c.b * c.a;
        color[3] = c.a;
        renderer->tail_count += 2;
    }
    return CAMBER_OK;
}
