/* Turns a line-gradient into a ramp of colour stops.
 *
 * Input: an expression of line-progress. Output: sorted stops. The stops of the expression's own curves are also stops
 * of the ramp. Between these, more are added where the colour bends, so that linear interpolation between stops is as
 * good as the expression. */
#include "style/ramp.h"

#include "style/evaluation.h"

#include <math.h>
#include <stdlib.h>

/* A span between two stops is straight if samples inside it are this close to the line between its ends, premultiplied.
 */
static const double TOLERANCE = 1.0 / 512.0;
/* Shorter spans look like steps. */
static const double SHORTEST = 1e-6;
/* The most nodes that are evaluated and bytes of texts, in total: some hundred milliseconds. */
static const double MOST_WORK = 2e7;
enum { INSIDE = 15, GRID = 64, KNOWN_MAX = 1000, ENDS_MAX = KNOWN_MAX + 4 };
/* The most stops for halved spans in addition to their own; each halving needs two more. */
enum { ROOM = 64 };

typedef struct sampler {
    const camber_expression *expression;
    camber_layer_ramp *ramp;
    size_t capacity;   /* room in ramp->stops */
    bool failed;       /* out of memory */
    double cost, work; /* cost of one evaluation, and the work that may still be done */
    size_t spans;      /* spans still to be added; each needs two stops */
    const char **cause;
    double *failed_at;
} sampler;

typedef struct sample {
    double place;
    camber_color color;
} sample;

/* ---- Sampling ---- */

static sample sample_at(sampler *s, double place) {
    camber_evaluation evaluation;
    camber_value value;
    sample made = {.place = place};
    camber_evaluation_begin(&evaluation, 0.0, NULL);
    evaluation.line_progress = place;
    if (camber_expression_evaluate(s->expression, &evaluation, &value) && value.type == CAMBER_VALUE_COLOR) {
        made.color = value.color;
    } else if (!*s->cause) {
        *s->cause = evaluation.cause ? evaluation.cause : "expected a colour";
        *s->failed_at = place;
    }
    s->work -= s->cost + evaluation.work;
    camber_evaluation_end(&evaluation);
    return made;
}

static bool is_between(const sample *from, const sample *to, const sample *at) {
    const double t = (at->place - from->place) / (to->place - from->place);
    const camber_color a = from->color, b = to->color, c = at->color;
    const double aa = (double)a.a * (1.0 - t), ba = (double)b.a * t, ca = (double)c.a;
    return fabs(aa + ba - ca) <= TOLERANCE &&
           fabs((double)a.r * aa + (double)b.r * ba - (double)c.r * ca) <= TOLERANCE &&
           fabs((double)a.g * aa + (double)b.g * ba - (double)c.g * ca) <= TOLERANCE &&
           fabs((double)a.b * aa + (double)b.b * ba - (double)c.b * ca) <= TOLERANCE;
}

static bool is_straight(sampler *s, const sample *from, const sample *to) {
    for (int i = 1; i <= INSIDE; i++) {
        const sample at = sample_at(s, from->place + (to->place - from->place) * i / (INSIDE + 1));
        if (!is_between(from, to, &at))
            return false;
    }
    return true;
}

static void put_stop(sampler *s, const sample *at) {
    camber_layer_ramp *ramp = s->ramp;
    const camber_ramp_stop stop = {(float)at->place, at->color};
    if (ramp->count) {
        const camber_ramp_stop *last = ramp->stops + ramp->count - 1;
        const sample before = {at->place, last->color}, after = {at->place + 1.0, last->color};
        if (last->place >= stop.place && is_between(&before, &after, at))
            return;
    }
    if (!camber_grow(s->expression->context, &ramp->stops, &s->capacity, ramp->count + 1, sizeof *ramp->stops)) {
        s->failed = true;
        return;
    }
    ramp->translucent |= stop.color.a < 1.0f;
    ramp->stops[ramp->count++] = stop;
}

/* Adds the stops from one position to just before another. Stops for later spans stay reserved. */
static void put_span(sampler *s, double from, double to) {
    const sample first = sample_at(s, from), last = sample_at(s, to - 1e-7 * (to - from));
    const bool room = s->ramp->count + 2 * s->spans + ROOM <= CAMBER_RAMP_STOPS_MAX;
    if (room && !s->failed && s->work > 0.0 && to - from > SHORTEST && !is_straight(s, &first, &last)) {
        const double middle = 0.5 * (from + to);
        put_span(s, from, middle);
        put_span(s, middle, to);
        return;
    }
    put_stop(s, &first);
    put_stop(s, &(sample){to, last.color});
}

/* ---- The ends of spans ---- */

static int compare_numbers(const void *left, const void *right) {
    const double a = *(const double *)left, b = *(const double *)right;
    return a < b ? -1 : a > b;
}

static bool is_curve(const camber_node *node) {
    return (node->evaluate == camber_evaluate_step || node->evaluate == camber_evaluate_interpolate) &&
           node->reads_line_progress;
}

/* Whether only curves read the progress, so that the colour is linear between their stops. */
static bool is_plain(const camber_expression *e) {
    for (size_t i = 0; i < e->node_count; i++) {
        const camber_node *node = e->nodes + i;
        const bool follows =
            is_curve(node) && e->nodes[e->links[node->first]].evaluate == camber_evaluate_line_progress;
        if (node->reads_line_progress && node->evaluate != camber_evaluate_line_progress && !follows)
            return false;
    }
    return true;
}

/* Lists the stops that the expression names, and a grid if the colour may bend elsewhere: sorted, without duplicates.
 * If there are too many, stops that are close together are dropped. */
static camber_status list_ends(const camber_expression *e, double *ends, size_t *count) {
    double *stops = camber_alloc(e->context, e->stop_count + GRID, sizeof *stops);
    size_t found = 0;
    if (!stops)
        return CAMBER_ERROR_MEMORY;
    for (int i = 1; i < GRID && !is_plain(e); i++)
        stops[found++] = (double)i / GRID;
    for (size_t i = 0; i < e->node_count; i++)
        for (uint32_t k = 0; is_curve(e->nodes + i) && k < e->nodes[i].index_count; k++) {
            const double stop = e->stops[e->nodes[i].index + k];
            if (stop > 0.0 && stop < 1.0)
                stops[found++] = stop;
        }
    if (found)
        qsort(stops, found, sizeof *stops, compare_numbers);
    const double apart = found > KNOWN_MAX ? 1.0 / KNOWN_MAX : 0.0;
    ends[0] = 0.0;
    *count = 1;
    for (size_t i = 0; i < found; i++)
        if (stops[i] - ends[*count - 1] > apart)
            ends[(*count)++] = stops[i];
    ends[(*count)++] = 1.0;
    camber_free(e->context, stops);
    return CAMBER_OK;
}

camber_status camber_layer_ramp_create(const camber_expression *expression, camber_layer_ramp *ramp, const char **cause,
                                       double *failed_at) {
    camber_context *context = expression->context;
    camber_layer_ramp made = {0};
    double ends[ENDS_MAX];
    size_t end_count = 0, reading = 1;
    camber_status status = list_ends(expression, ends, &end_count);
    if (status != CAMBER_OK)
        return status;
    for (size_t i = 0; i < expression->node_count; i++)
        reading += expression->nodes[i].reads_line_progress;
    *cause = NULL;
    sampler s = {.expression = expression,
                 .ramp = &made,
                 .cost = (double)reading,
                 .work = MOST_WORK,
                 .cause = cause,
                 .failed_at = failed_at};
    for (size_t i = 0; i + 1 < end_count && !s.failed; i++) {
        s.spans = end_count - 2 - i;
        if (i == 0 || s.work > -MOST_WORK) /* after that, the last colour continues */
            put_span(&s, ends[i], ends[i + 1]);
    }
    if (s.failed) {
        camber_free(context, made.stops);
        return CAMBER_ERROR_MEMORY;
    }
    *ramp = made;
    return CAMBER_OK;
}

camber_status camber_layer_ramp_copy(camber_context *context, const camber_layer_ramp *ramp,
                                     camber_color (*change)(camber_color color), camber_layer_ramp *copy) {
    camber_layer_ramp made = {.count = ramp->count, .translucent = ramp->translucent};
    made.stops = camber_alloc(context, made.count, sizeof *made.stops);
    if (!made.stops)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < made.count; i++)
        made.stops[i] = (camber_ramp_stop){ramp->stops[i].place, change(ramp->stops[i].color)};
    *copy = made;
    return CAMBER_OK;
}
