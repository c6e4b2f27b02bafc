/* Texts along lines: finds the part of a line that a text covers, and where on it each glyph is.
 *
 * Input: a candidate on a line. Output: a track, which has the points of the part of the line that the text covers.
 *
 *          first          anchor         last
 *      ----|--o-----------x---------o----|-----     o: points of the line
 *        negative         0        positive         distances, in the order of the text
 *
 * Main idea: a text runs with the line, or against it if it would be upside down. Each cluster of glyphs is turned as a
 * whole about its middle, which is on the line. If the line is steep, texts that may be written downwards are. */
#include "base/maths.h"
#include "map/label_layout.h"
#include "text/clusters.h"

#include <math.h>

/* How far the chord that gives a glyph its direction reaches to each side of it. */
static const double CHORD_EM = 0.5;

/* The line in the space in which the text is placed: the plane, or the picture as a pitch shows it. */
typedef struct text_line {
    const camber_label_layout *layout;
    double origin[2]; /* the points are relative to it */
    const float *points;
    size_t count;
    double translate[2];
    bool flat;
} text_line;

/* false: the point is not in front of the camera. */
static bool set_point(const text_line *line, const double plane[2], double at[2]) {
    const double moved[2] = {plane[0] + line->translate[0], plane[1] + line->translate[1]};
    if (!line->flat)
        return camber_lens_see(&line->layout->lens, moved, at) > 0.0;
    at[0] = moved[0];
    at[1] = moved[1];
    return true;
}

static bool line_point(const text_line *line, size_t i, double at[2]) {
    const double plane[2] = {line->origin[0] + (double)line->points[2 * i],
                             line->origin[1] + (double)line->points[2 * i + 1]};
    return set_point(line, plane, at);
}

static bool push(camber_label_track *track, const double at[2], double distance) {
    if (!camber_grow(track->context, &track->points, &track->capacity, track->count + 1, 3 * sizeof *track->points))
        return false;
    double *to = track->points + 3 * track->count++;
    to[0] = at[0];
    to[1] = at[1];
    to[2] = distance;
    return true;
}

/* The points of the line on one side of the anchor, in the order of the text. */
typedef struct side_of_line {
    size_t from; /* the point next to the anchor */
    int step;    /* 1 or -1 */
    double sign; /* of distances */
} side_of_line;

/* Adds the points of a side of the line until the text ends. CAMBER_ERROR_NOT_FOUND: the line ends before that. */
static camber_status walk(camber_label_track *track, const text_line *line, const double anchor[2], side_of_line side) {
    double at[2] = {anchor[0], anchor[1]}, distance = 0.0;
    const double wanted = side.sign < 0.0 ? -track->first : track->last;
    for (size_t i = side.from; distance < wanted; i += (size_t)side.step) {
        double next[2];
        if (i >= line->count || !line_point(line, i, next)) /* also before the first one */
            return CAMBER_ERROR_NOT_FOUND;
        const double length = camber_length(next[0] - at[0], next[1] - at[1]);
        memcpy(at, next, sizeof at);
        distance += length;
        if (length > 0.0 && !push(track, at, side.sign * distance))
            return CAMBER_ERROR_MEMORY;
    }
    return CAMBER_OK;
}

static void turn_round(double *points, size_t count) {
    for (size_t i = 0; i < count / 2; i++) {
        double held[3];
        memcpy(held, points + 3 * i, sizeof held);
        memcpy(points + 3 * i, points + 3 * (count - 1 - i), sizeof held);
        memcpy(points + 3 * (count - 1 - i), held, sizeof held);
    }
}

/* Lays the track along the line. with: it runs in the order of the stored points. CAMBER_ERROR_NOT_FOUND: the line is
 * too short. */
static camber_status lay(camber_label_track *track, const text_line *line, const camber_label_candidate *c, bool with) {
    double base[2], at[2];
    track->count = 0;
    camber_label_base(line->layout, c, base);
    if (!set_point(line, base, at))
        return CAMBER_ERROR_NOT_FOUND;
    if (!push(track, at, 0.0))
        return CAMBER_ERROR_MEMORY;
    const size_t low = c->segment, high = low + 1;
    camber_status status = walk(track, line, at, (side_of_line){with ? low : high, with ? -1 : 1, -1.0});
    turn_round(track->points, track->count);
    if (status == CAMBER_OK)
        status = walk(track, line, at, (side_of_line){with ? high : low, with ? 1 : -1, 1.0});
    return status == CAMBER_OK && track->count < 2 ? CAMBER_ERROR_NOT_FOUND : status;
}

/* Measures the text: where its first and last clusters are. */
static void measure(const camber_text *text, camber_label_track *track) {
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0, end; i < text->glyph_count; i = end) {
        const double middle = camber_text_cluster_middle(text, i, &end);
        low = fmin(low, middle);
        high = fmax(high, middle);
    }
    track->first = low * track->size + track->shift;
    track->last = high * track->size + track->shift;
}

/* Computes the point of the line at a distance. */
static void point_at(const camber_label_track *track, double distance, double at[2]) {
    size_t i = 0;
    while (i + 2 < track->count && track->points[3 * (i + 1) + 2] <= distance)
        i++;
    const double *a = track->points + 3 * i, *b = a + 3, t = (distance - a[2]) / (b[2] - a[2]);
    at[0] = a[0] + t * (b[0] - a[0]);
    at[1] = a[1] + t * (b[1] - a[1]);
}

/* A glyph has the direction of the chord of the line around it:
 *
 *            o              the line turns at a point, but the glyphs
 *          /   \            around it turn step by step, so they do not
 *        -- chord --        overlap
 */
camber_track_point camber_label_track_point(const camber_label_track *track, double distance) {
    const double reach = CHORD_EM * track->size;
    const double low = track->points[2], high = track->points[3 * (track->count - 1) + 2];
    double at[2], from[2], to[2];
    point_at(track, distance, at);
    point_at(track, fmin(fmax(distance - reach, low), distance), from);
    point_at(track, fmax(fmin(distance + reach, high), distance), to);
    double x = to[0] - from[0], y = to[1] - from[1], length = camber_length(x, y);
    if (!(length > 0.0)) { /* the line comes back to where it was */
        x = track->points[3] - track->points[0];
        y = track->points[4] - track->points[1];
        length = camber_length(x, y);
    }
    const double cosine = x / length, sine = y / length;
    return (camber_track_point){at[0] - sine * track->side * track->across,
                                at[1] + cosine * track->side * track->across, cosine, sine};
}

/* Computes the direction from the first glyph to the last, as it is seen; for a text of one glyph, the direction of its
 * segment. */
static void look_along(const camber_label_layout *layout, const camber_label_track *track, double way[2]) {
    const camber_track_point first = camber_label_track_point(track, track->first);
    const camber_track_point last = camber_label_track_point(track, track->last);
    const bool one = !(track->last > track->first);
    double from[2] = {first.x, first.y};
    double to[2] = {one ? first.x + first.cosine : last.x, one ? first.y + first.sine : last.y};
    if (track->flat && layout->lens.pitched) {
        (void)camber_lens_see(&layout->lens, from, from);
        (void)camber_lens_see(&layout->lens, to, to);
    }
    way[0] = to[0] - from[0];
    way[1] = to[1] - from[1];
}

static camber_status set_text(const camber_label_layout *layout, const camber_label_candidate *c, const text_line *line,
                              bool turned, camber_label_track *track) {
    const camber_label_form *form = layout->forms + c->form;
    const camber_label_rule *rule = layout->rules + form->rule;
    track->side = turned ? -1.0 : 1.0;
    track->shift = track->side * rule->offsets_em[0][0] * track->size;
    track->across = rule->offsets_em[0][1] * track->size;
    measure(track->vertical && form->vertical ? form->vertical : form->text, track);
    return lay(track, line, c, layout->lines[c->line].reversed == turned);
}

camber_status camber_label_track_find(const camber_label_layout *layout, const camber_label_candidate *c,
                                      camber_label_track *track, bool *fits) {
    const camber_label_form *form = layout->forms + c->form;
    const camber_label_rule *rule = layout->rules + form->rule;
    const camber_label_line *stored = layout->lines + c->line;
    double base[2];
    camber_label_base(layout, c, base);
    const text_line line = {.layout = layout,
                            .origin = {base[0] + c->line_x, base[1] + c->line_y},
                            .points = layout->line_points + 2 * stored->first,
                            .count = stored->count,
                            .translate = {rule->text_translate_px[0], rule->text_translate_px[1]},
                            .flat = rule->text_flat || !layout->lens.pitched};
    const double nearness = camber_label_nearness(layout, c);
    *fits = false;
    if (!(nearness > 0.0) || !form->text)
        return CAMBER_OK;
    track->flat = line.flat;
    track->size = rule->text_px * (!layout->lens.pitched ? 1.0 : line.flat ? 1.0 / nearness : nearness);
    track->vertical = false;
    camber_status status = set_text(layout, c, &line, false, track);
    if (status == CAMBER_OK && rule->symbol.text.keep_upright) {
        double way[2];
        look_along(layout, track, way);
        if (form->vertical && fabs(way[1]) > fabs(way[0])) {
            track->vertical = true;
            status = set_text(layout, c, &line, false, track);
            if (status == CAMBER_OK)
                look_along(layout, track, way);
        }
        if (status == CAMBER_OK && (track->vertical ? way[1] < 0.0 : way[0] < 0.0))
            status = set_text(layout, c, &line, true, track);
    }
    *fits = status == CAMBER_OK;
    return status == CAMBER_ERROR_NOT_FOUND ? CAMBER_OK : status;
}
