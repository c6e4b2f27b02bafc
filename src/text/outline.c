/* Makes rings from what HarfBuzz draws: from lines, and from curves, which are flattened into as many equal steps as
 * the tolerance needs. A curve whose second derivative is at most d is at most d / (8 n^2) away from the polyline of n
 * steps. */
#include "text/outline.h"

#include <math.h>

static const size_t MOST_POINTS = (size_t)1 << 20;

void camber_outline_begin_ring(camber_outline_maker *maker) {
    if (maker->status)
        return;
    if (!camber_grow(maker->context, &maker->offsets, &maker->offset_capacity, maker->ring_count + 2,
                     sizeof *maker->offsets)) {
        maker->status = CAMBER_ERROR_MEMORY;
        return;
    }
    maker->offsets[maker->ring_count++] = (uint32_t)maker->point_count;
}

void camber_outline_add_point(camber_outline_maker *maker, float x, float y) {
    if (maker->status || maker->ring_count == 0 || !isfinite(x) || !isfinite(y))
        return;
    const size_t count = maker->point_count;
    if (count > maker->offsets[maker->ring_count - 1] && maker->points[2 * count - 2] == x &&
        maker->points[2 * count - 1] == y)
        return;
    if (count == MOST_POINTS) {
        maker->status =
            camber_fail(maker->context, CAMBER_ERROR_LIMIT, "a glyph's outline has more than %zu points", MOST_POINTS);
        return;
    }
    size_t capacity = maker->point_capacity;
    if (!camber_grow(maker->context, &maker->points, &capacity, count + 1, 2 * sizeof *maker->points)) {
        maker->status = CAMBER_ERROR_MEMORY;
        return;
    }
    maker->point_capacity = capacity;
    maker->points[2 * count] = x;
    maker->points[2 * count + 1] = y;
    maker->point_count++;
}

void camber_outline_end_ring(camber_outline_maker *maker) {
    if (maker->status || maker->ring_count == 0)
        return;
    const size_t first = maker->offsets[maker->ring_count - 1];
    const float *ring = maker->points + 2 * first;
    size_t count = maker->point_count - first;
    while (count > 1 && ring[0] == ring[2 * count - 2] && ring[1] == ring[2 * count - 1])
        count--;
    if (count < 3) {
        maker->ring_count--;
        count = 0;
    }
    maker->point_count = first + count;
}

/* Returns twice the area of a ring; positive if it is clockwise as seen, because y points down. */
static double get_area(const float *ring, size_t count) {
    double area = 0.0;
    for (size_t i = 0, j = count - 1; i < count; j = i++)
        area += (double)ring[2 * j] * ring[2 * i + 1] - (double)ring[2 * i] * ring[2 * j + 1];
    return area;
}

static void reverse(float *ring, size_t count) {
    for (size_t i = 0, j = count - 1; i < j; i++, j--)
        for (size_t axis = 0; axis < 2; axis++) {
            const float kept = ring[2 * i + axis];
            ring[2 * i + axis] = ring[2 * j + axis];
            ring[2 * j + axis] = kept;
        }
}

/* In PostScript fonts, outer rings run in the opposite direction to those in TrueType fonts: if the areas add up to
 * less than 0, all rings are reversed. */
static void orient(camber_outline_maker *maker) {
    double area = 0.0;
    for (size_t i = 0; i < maker->ring_count; i++)
        area += get_area(maker->points + 2 * (size_t)maker->offsets[i], maker->offsets[i + 1] - maker->offsets[i]);
    for (size_t i = 0; area < 0.0 && i < maker->ring_count; i++)
        reverse(maker->points + 2 * (size_t)maker->offsets[i], maker->offsets[i + 1] - maker->offsets[i]);
}

/* Moves each edge of a ring outwards by a distance. A corner moves by at most 2.9 times the distance.
 *
 *           \\    old corner           Clockwise rings grow, and holes, which are counter-clockwise, shrink.
 *     -------+\\
 *     ---------+   new corner
 */
static void move_edges(float *ring, size_t count, float distance) {
    const float first[2] = {ring[0], ring[1]};
    float before[2] = {ring[2 * count - 2], ring[2 * count - 1]};
    for (size_t i = 0; i < count; i++) {
        float *at = ring + 2 * i;
        const float *next = i + 1 < count ? at + 2 : first;
        const float in[2] = {at[0] - before[0], at[1] - before[1]}, out[2] = {next[0] - at[0], next[1] - at[1]};
        const float in_length = hypotf(in[0], in[1]), out_length = hypotf(out[0], out[1]);
        before[0] = at[0];
        before[1] = at[1];
        if (!(in_length > 0.0f && out_length > 0.0f))
            continue;
        const float ux = in[0] / in_length, uy = in[1] / in_length, vx = out[0] / out_length, vy = out[1] / out_length;
        const float scale = distance / fmaxf(1.0f + ux * vx + uy * vy, 0.25f);
        at[0] += scale * (uy + vy);
        at[1] -= scale * (ux + vx);
    }
}

static void copy(camber_outline_maker *maker, camber_outline *outline, unsigned char *block) {
    const size_t point_bytes = maker->point_count * 2 * sizeof *maker->points;
    memcpy(block, maker->points, point_bytes);
    memcpy(block + point_bytes, maker->offsets, (maker->ring_count + 1) * sizeof *maker->offsets);
    *outline = (camber_outline){.points = (const float *)(const void *)block,
                                .offsets = (const uint32_t *)(const void *)(block + point_bytes),
                                .ring_count = maker->ring_count,
                                .left = maker->points[0],
                                .top = maker->points[1],
                                .right = maker->points[0],
                                .bottom = maker->points[1]};
    for (size_t i = 0; i < maker->point_count; i++) {
        outline->left = fminf(outline->left, maker->points[2 * i]);
        outline->right = fmaxf(outline->right, maker->points[2 * i]);
        outline->top = fminf(outline->top, maker->points[2 * i + 1]);
        outline->bottom = fmaxf(outline->bottom, maker->points[2 * i + 1]);
    }
}

camber_status camber_outline_finish(camber_outline_maker *maker, camber_outline *outline, void **block) {
    camber_context *context = maker->context;
    camber_outline made = {0};
    unsigned char *bytes = NULL;
    if (!maker->status && maker->ring_count) {
        maker->offsets[maker->ring_count] = (uint32_t)maker->point_count;
        orient(maker);
        for (size_t i = 0; i < maker->ring_count && maker->wider_em > 0.0f; i++)
            move_edges(maker->points + 2 * (size_t)maker->offsets[i], maker->offsets[i + 1] - maker->offsets[i],
                       0.5f * maker->wider_em);
        bytes = camber_alloc(context, 1,
                             maker->point_count * 2 * sizeof *maker->points +
                                 (maker->ring_count + 1) * sizeof *maker->offsets);
        if (bytes)
            copy(maker, &made, bytes);
        else
            maker->status = CAMBER_ERROR_MEMORY;
    }
    camber_free(context, maker->points);
    camber_free(context, maker->offsets);
    if (!maker->status) {
        *outline = made;
        *block = bytes;
    }
    return maker->status;
}

/* ---- Functions that HarfBuzz calls ---- */

static void move_to(hb_draw_funcs_t *calls, void *user, hb_draw_state_t *state, float x, float y, void *unused) {
    camber_outline_maker *maker = user;
    (void)calls, (void)state, (void)unused;
    camber_outline_begin_ring(maker);
    camber_outline_add_point(maker, x * maker->scale, -y * maker->scale);
}

static void line_to(hb_draw_funcs_t *calls, void *user, hb_draw_state_t *state, float x, float y, void *unused) {
    camber_outline_maker *maker = user;
    (void)calls, (void)state, (void)unused;
    camber_outline_add_point(maker, x * maker->scale, -y * maker->scale);
}

/* Returns how many steps a curve needs if its second derivative is at most `second`, in the font's units. */
static unsigned count_steps(const camber_outline_maker *maker, float second) {
    const float steps = ceilf(sqrtf(second * maker->scale / (8.0f * maker->tolerance_em)));
    return steps >= 1.0f ? steps <= 65536.0f ? (unsigned)steps : 65536 : 1;
}

static void curve_to(camber_outline_maker *maker, const float p[8]) {
    const float first = hypotf(p[0] - 2.0f * p[2] + p[4], p[1] - 2.0f * p[3] + p[5]);
    const float last = hypotf(p[2] - 2.0f * p[4] + p[6], p[3] - 2.0f * p[5] + p[7]);
    const unsigned steps = count_steps(maker, 6.0f * fmaxf(first, last));
    for (unsigned i = 1; i <= steps && !maker->status; i++) {
        const float t = (float)i / (float)steps, s = 1.0f - t;
        const float a = s * s * s, b = 3.0f * s * s * t, c = 3.0f * s * t * t, d = t * t * t;
        camber_outline_add_point(maker, (a * p[0] + b * p[2] + c * p[4] + d * p[6]) * maker->scale,
                                 -(a * p[1] + b * p[3] + c * p[5] + d * p[7]) * maker->scale);
    }
}

static void quadratic_to(hb_draw_funcs_t *calls, void *user, hb_draw_state_t *state, float cx, float cy, float x,
                         float y, void *unused) {
    camber_outline_maker *maker = user;
    const float x0 = state->current_x, y0 = state->current_y;
    (void)calls, (void)unused;
    const unsigned steps = count_steps(maker, 2.0f * hypotf(x0 - 2.0f * cx + x, y0 - 2.0f * cy + y));
    for (unsigned i = 1; i <= steps && !maker->status; i++) {
        const float t = (float)i / (float)steps, s = 1.0f - t;
        camber_outline_add_point(maker, (s * s * x0 + 2.0f * s * t * cx + t * t * x) * maker->scale,
                                 -(s * s * y0 + 2.0f * s * t * cy + t * t * y) * maker->scale);
    }
}

static void cubic_to(hb_draw_funcs_t *calls, void *user, hb_draw_state_t *state, float ax, float ay, float bx, float by,
                     float x, float y, void *unused) {
    const float points[8] = {state->current_x, state->current_y, ax, ay, bx, by, x, y};
    (void)calls, (void)unused;
    curve_to(user, points);
}

static void close_path(hb_draw_funcs_t *calls, void *user, hb_draw_state_t *state, void *unused) {
    (void)calls, (void)state, (void)unused;
    camber_outline_end_ring(user);
}

static void draw(const camber_face *face, uint32_t glyph, camber_outline_maker *maker) {
    hb_draw_funcs_t *calls = hb_draw_funcs_create();
    hb_draw_funcs_set_move_to_func(calls, move_to, NULL, NULL);
    hb_draw_funcs_set_line_to_func(calls, line_to, NULL, NULL);
    hb_draw_funcs_set_quadratic_to_func(calls, quadratic_to, NULL, NULL);
    hb_draw_funcs_set_cubic_to_func(calls, cubic_to, NULL, NULL);
    hb_draw_funcs_set_close_path_func(calls, close_path, NULL, NULL);
    hb_font_get_glyph_shape(face->font, glyph, calls, maker);
    hb_draw_funcs_destroy(calls);
}

void camber_outline_draw_glyph(camber_outline_maker *maker, const camber_face *face, uint32_t glyph) {
    maker->scale = 1.0f / face->units_per_em;
    draw(face, glyph, maker);
}

static void note_move(hb_draw_funcs_t *calls, void *user, hb_draw_state_t *state, float x, float y, void *unused) {
    (void)calls, (void)state, (void)x, (void)y, (void)unused;
    *(bool *)user = true;
}

bool camber_face_has_outline(const camber_face *face, uint32_t glyph) {
    bool has = false;
    hb_draw_funcs_t *calls = hb_draw_funcs_create();
    hb_draw_funcs_set_move_to_func(calls, note_move, NULL, NULL);
    hb_font_get_glyph_shape(face->font, glyph, calls, &has);
    hb_draw_funcs_destroy(calls);
    return has;
}
