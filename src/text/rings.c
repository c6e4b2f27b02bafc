/* Collects texts as rings in px.
 *
 * Input: shaped texts, and where each is drawn. Output: closed polylines. Main idea: each cluster of glyphs has a
 * frame, which moves and turns its outlines. All clusters of a text at a point share one frame; along a line each has
 * its own, whose origin is on the line at the middle of the cluster. */
#include "base/maths.h"
#include "text/clusters.h"
#include "text/fonts.h"

#include <math.h>

static const double PI = 3.14159265358979323846;
static const float LARGEST_PX = 16384.0f;
static const float FARTHEST_PX = 1e9f; /* of camber_polylines_create */
static const size_t MOST_POINTS = (size_t)1 << 31;
#define EMPTY_BOX ((camber_text_box){INFINITY, INFINITY, -INFINITY, -INFINITY})

struct camber_text_rings {
    camber_fonts *fonts;
    float *points; /* point_count pairs */
    uint32_t *offsets, *rows;
    double *lengths; /* of the line that a text follows: from its first point to each */
    size_t point_count, ring_count, point_capacity, offset_capacity, row_capacity, length_capacity;
    size_t last_point_count, last_ring_count; /* before the last text */
};

/* Draws the point (u, v), in px from the origin, at (x + c u - s v, y + s u + c v). */
typedef struct frame {
    double x, y, c, s;
} frame;

static bool is_near(float x) {
    return fabsf(x) <= FARTHEST_PX;
}

camber_status camber_text_rings_create(camber_fonts *fonts, camber_text_rings **rings) {
    camber_text_rings *made = camber_alloc_zero(fonts->context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->fonts = fonts;
    *rings = made;
    return CAMBER_OK;
}

void camber_text_rings_destroy(camber_text_rings *rings) {
    if (!rings)
        return;
    camber_context *context = rings->fonts->context;
    camber_free(context, rings->points);
    camber_free(context, rings->offsets);
    camber_free(context, rings->rows);
    camber_free(context, rings->lengths);
    camber_free(context, rings);
}

void camber_text_rings_remove_last(camber_text_rings *rings) {
    rings->point_count = rings->last_point_count;
    rings->ring_count = rings->last_ring_count;
}

void camber_text_rings_clear(camber_text_rings *rings) {
    rings->point_count = rings->ring_count = rings->last_point_count = rings->last_ring_count = 0;
}

camber_polylines_desc camber_text_rings_get(const camber_text_rings *rings) {
    static const uint32_t none[] = {0};
    return (camber_polylines_desc){.points = rings->points,
                                   .point_count = rings->point_count,
                                   .offsets = rings->ring_count ? rings->offsets : none,
                                   .polyline_count = rings->ring_count,
                                   .rows = rings->rows};
}

/* ---- Glyphs ---- */

/* Begins a ring of so many points. */
static camber_status begin_ring(camber_text_rings *r, uint32_t row, size_t count) {
    camber_context *context = r->fonts->context;
    if (count > MOST_POINTS - r->point_count)
        return camber_fail(context, CAMBER_ERROR_LIMIT,
                           "the texts have more than %zu points; draw them in several meshes", MOST_POINTS);
    if (!camber_grow(context, &r->points, &r->point_capacity, 2 * (r->point_count + count), sizeof *r->points) ||
        !camber_grow(context, &r->offsets, &r->offset_capacity, r->ring_count + 2, sizeof *r->offsets) ||
        !camber_grow(context, &r->rows, &r->row_capacity, r->ring_count + 1, sizeof *r->rows))
        return CAMBER_ERROR_MEMORY;
    r->offsets[r->ring_count] = (uint32_t)r->point_count;
    r->offsets[r->ring_count + 1] = (uint32_t)(r->point_count + count);
    r->rows[r->ring_count++] = row;
    return CAMBER_OK;
}

static void add_point(camber_text_rings *r, const frame *f, double u, double v, camber_text_box *box) {
    float *p = r->points + 2 * r->point_count++;
    p[0] = (float)(f->x + f->c * u - f->s * v);
    p[1] = (float)(f->y + f->s * u + f->c * v);
    *box = (camber_text_box){fminf(box->left, p[0]), fminf(box->top, p[1]), fmaxf(box->right, p[0]),
                             fmaxf(box->bottom, p[1])};
}

/* Adds the rings of a glyph. middle_em: what of the text is at the frame's origin. */
static camber_status add_glyph(camber_text_rings *r, const camber_text_glyph *g, const camber_text_position *position,
                               const frame *f, double middle_em, camber_text_box *box) {
    const double em = (double)position->size_px, size = em * (double)g->scale;
    const double x = ((double)g->x - middle_em) * em, y = (double)g->y * em;
    camber_outline outline;
    if (g->glyph == CAMBER_NO_GLYPH || !(size > 0.0))
        return CAMBER_OK;
    camber_status status = camber_fonts_get_sized_outline(r->fonts, g->glyph, (float)size, &outline);
    for (size_t i = 0; i < outline.ring_count && status == CAMBER_OK; i++) {
        const uint32_t first = outline.offsets[i], count = outline.offsets[i + 1] - first;
        status = begin_ring(r, position->row, (size_t)count + 1);
        for (uint32_t k = 0; k <= count && status == CAMBER_OK; k++) {
            const float *p = outline.points + 2 * (size_t)(k < count ? first + k : first);
            const double u = size * (double)p[0], v = size * (double)p[1];
            add_point(r, f, x + (g->turned ? -v : u), y + (g->turned ? u : v), box);
        }
    }
    return status;
}

static camber_status add_at_point(camber_text_rings *r, const camber_text *text, const camber_text_position *position,
                                  camber_text_box *box) {
    const double turn = (double)position->turn_deg * (PI / 180.0);
    frame f = {.x = (double)position->x, .y = (double)position->y};
    camber_sine_cosine(turn, &f.s, &f.c);
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < text->glyph_count && status == CAMBER_OK; i++)
        status = add_glyph(r, text->glyphs + i, position, &f, 0.0, box);
    return status;
}

/* ---- Lines ---- */

/* A text's way along its line. */
typedef struct track {
    const float *points;
    const double *lengths;
    size_t count;
    double anchor; /* how far the text's anchor is from the line's first point */
    double sign;   /* -1: the text runs against the line */
} track;

/* Measures the line. false: it has no length, or an invalid point. */
static bool measure(camber_text_rings *r, const camber_text_position *position) {
    for (size_t i = 0; i < 2 * position->point_count; i++)
        if (!is_near(position->points[i]))
            return false;
    r->lengths[0] = 0.0;
    for (size_t i = 1; i < position->point_count; i++) {
        const float *a = position->points + 2 * (i - 1), *b = a + 2;
        r->lengths[i] = r->lengths[i - 1] + camber_length((double)b[0] - (double)a[0], (double)b[1] - (double)a[1]);
    }
    return r->lengths[position->point_count - 1] > 0.0;
}

/* Finds the frame at a place in the text, em from its anchor. false: the line ends before it. */
static bool find_frame(const track *t, double along_px, frame *f) {
    const double at = t->anchor + t->sign * along_px;
    size_t low = 0, high = t->count - 1; /* the first point whose length is at or after the place is in (low, high] */
    if (!(at >= 0.0 && at <= t->lengths[high]))
        return false;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (t->lengths[middle] < at)
            low = middle;
        else
            high = middle;
    }
    while (!(t->lengths[high] > t->lengths[low])) /* the line begins with a repeated point */
        high++;
    const float *a = t->points + 2 * low, *b = t->points + 2 * high;
    const double length = t->lengths[high] - t->lengths[low], share = (at - t->lengths[low]) / length;
    const double dx = (double)b[0] - (double)a[0], dy = (double)b[1] - (double)a[1];
    *f = (frame){(double)a[0] + share * dx, (double)a[1] + share * dy, t->sign * dx / length, t->sign * dy / length};
    return true;
}

/* Whether the line has room for the text and is straight enough; and whether the text reads from left to right.
 * least_cosine: of the angle by which it may turn between two clusters. */
static bool has_room(const camber_text *text, const track *t, double size_px, double least_cosine, bool *reads) {
    frame first = {0}, last = {0};
    for (size_t i = 0, end; i < text->glyph_count; i = end) {
        frame f;
        if (!find_frame(t, camber_text_cluster_middle(text, i, &end) * size_px, &f) ||
            (i && f.c * last.c + f.s * last.s < least_cosine))
            return false;
        if (!i)
            first = f;
        last = f;
    }
    const double dx = last.x - first.x;
    *reads = dx > 0.0 || (!(dx < 0.0) && last.c >= 0.0);
    return true;
}

static camber_status add_along(camber_text_rings *r, const camber_text *text, const camber_text_position *position,
                               camber_text_box *box) {
    if (position->point_count < 2 || !text->glyph_count)
        return CAMBER_OK;
    if (!camber_grow(r->fonts->context, &r->lengths, &r->length_capacity, position->point_count, sizeof *r->lengths))
        return CAMBER_ERROR_MEMORY;
    if (!measure(r, position))
        return CAMBER_OK;
    const double size = (double)position->size_px,
                 most = position->max_turn_deg > 0.0f ? (double)position->max_turn_deg : 45.0;
    track t = {.points = position->points, .lengths = r->lengths, .count = position->point_count, .sign = 1.0};
    t.anchor = t.lengths[t.count - 1] / 2.0 + (double)position->shift_px;
    const double least_cosine = cos(most * (PI / 180.0));
    bool reads, is_drawn = has_room(text, &t, size, least_cosine, &reads) && (reads || position->keep_direction);
    if (!is_drawn && !position->keep_direction) {
        t.sign = -1.0;
        is_drawn = has_room(text, &t, size, least_cosine, &reads) && reads;
    }
    camber_status status = CAMBER_OK;
    for (size_t i = 0, end; is_drawn && i < text->glyph_count && status == CAMBER_OK; i = end) {
        const double middle = camber_text_cluster_middle(text, i, &end);
        frame f;
        (void)find_frame(&t, middle * size, &f);
        for (size_t k = i; k < end && status == CAMBER_OK; k++)
            status = add_glyph(r, text->glyphs + k, position, &f, middle, box);
    }
    return status;
}

/* ---- Texts ---- */

static camber_status check(camber_context *context, const camber_text *text, const camber_text_position *position) {
    const bool along = position->points != NULL;
    if (!(position->size_px > 0.0f && position->size_px <= LARGEST_PX))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "a text has the size %g px; give more than 0, %g at most",
                           (double)position->size_px, (double)LARGEST_PX);
    if (along ? !is_near(position->shift_px)
              : !is_near(position->x) || !is_near(position->y) || !isfinite(position->turn_deg))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "a text's position is beyond %g px or not a number; leave out texts that are not seen",
                           (double)FARTHEST_PX);
    if (along && !(position->max_turn_deg >= 0.0f && position->max_turn_deg <= 180.0f))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "a text may turn by %g degrees; give 0 to 180",
                           (double)position->max_turn_deg);
    if (along && text->vertical)
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "vertical text cannot follow a line; shape it with vertical = false");
    return CAMBER_OK;
}

camber_status camber_text_rings_add(camber_text_rings *rings, const camber_text *text,
                                    const camber_text_position *position, camber_text_box *box) {
    const size_t point_count = rings->point_count, ring_count = rings->ring_count;
    camber_text_box around = EMPTY_BOX;
    camber_text_position given = *position;
    if (given.size_px == 0.0f)
        given.size_px = 16.0f;
    camber_status status = check(rings->fonts->context, text, &given);
    if (status != CAMBER_OK)
        return status;
    status = given.points ? add_along(rings, text, &given, &around) : add_at_point(rings, text, &given, &around);
    if (status != CAMBER_OK) {
        rings->point_count = point_count;
        rings->ring_count = ring_count;
        return status;
    }
    rings->last_point_count = point_count;
    rings->last_ring_count = ring_count;
    if (box)
        *box = around;
    return CAMBER_OK;
}
