/* Passes: the steps in which a plan is drawn with a mesh.
 *
 * Input: a plan, and which of its pairs or rows have polylines in the mesh. Output: passes over these polylines, each
 * with its paints. Main idea: opaque layers whose polylines follow each other become one pass. */
#include "map/passes.h"

#include <string.h>

/* 2.4 GB. */
static const size_t MOST_PAINTS = (size_t)1 << 26;

static size_t first_of(const camber_row_order *n, const camber_plan_set *set) {
    return n->by_pair ? set->first_pair : set->first_row;
}

static size_t end_of(const camber_row_order *n, const camber_plan_set *set) {
    return n->by_pair ? set->first_pair + set->pair_count : set->first_row + set->row_count;
}

static camber_paint paint_of(const camber_row_order *n, const camber_plan_layer *layer, size_t number) {
    const size_t row = n->by_pair ? n->plan->pair_rows[number] : number;
    return camber_plan_paint(n->plan, n->plan->sets + layer->set, row, layer->slot);
}

/* Consecutive layers that one pass draws. */
typedef struct layer_run {
    size_t first_layer, end_layer; /* of the plan */
    size_t first_polyline, end_polyline;
    size_t end_paint;
    float opacity; /* the layer's opacity; 1 where several layers are drawn at once */
    camber_overlap overlap;
    bool opaque;
    const camber_plan_fill *fill; /* NULL: none; else nothing of the above */
} layer_run;

static bool draws(const camber_paint *paint) {
    return paint->width_px > 0.0f || paint->fill;
}

/* Whether the layer draws anything, and only opaque lines, of what polylines have. */
static bool layer_draws(const camber_row_order *n, const camber_plan_layer *layer, bool *opaque) {
    const camber_plan_set *set = n->plan->sets + layer->set;
    bool drawn = false;
    *opaque = true;
    for (size_t i = first_of(n, set); i < end_of(n, set); i++) {
        const camber_paint paint = paint_of(n, layer, i);
        if (!n->used[i] || !draws(&paint))
            continue;
        drawn = true;
        *opaque &= !paint.fill && paint.color.a >= 1.0f && !(paint.ramp && layer->translucent_ramp);
    }
    return drawn;
}

/* Opaque layers whose polylines follow each other are drawn by one pass. A translucent layer has a pass of its own,
 * since it is flattened by itself; so has one of areas, since like fills of two layers would become one path. A layer
 * of areas with an opacity takes its outline along. Fills of the picture come between. */
static size_t find_runs(const camber_row_order *n, layer_run *runs, size_t *layer_count) {
    const camber_plan *plan = n->plan;
    size_t count = 0, fill = 0, counted = plan->layer_count;
    *layer_count = 0;
    for (size_t i = 0; i <= plan->layer_count; i++) {
        bool opaque;
        for (; fill < plan->patterns.fill_count && plan->patterns.fills[fill].before == i; fill++)
            runs[count++] = (layer_run){.fill = plan->patterns.fills + fill};
        if (i == plan->layer_count)
            break;
        if (!layer_draws(n, plan->layers + i, &opaque))
            continue;
        *layer_count += counted == plan->layer_count || plan->layers[i].look.layer != plan->layers[counted].look.layer;
        counted = i;
        const camber_plan_set *set = plan->sets + plan->layers[i].set;
        const float opacity = (float)plan->layers[i].look.paint.layer_opacity;
        opaque = opaque && opacity >= 1.0f;
        const size_t first = n->first_polylines[plan->layers[i].set], end = n->first_polylines[plan->layers[i].set + 1];
        const camber_overlap overlap = plan->layers[i].look.layer->overlap;
        layer_run *last = count ? runs + count - 1 : NULL;
        const bool same_group = opacity < 1.0f && plan->layers[i].part == CAMBER_PLAN_OUTLINE && last &&
                                last->end_layer == i && plan->layers[i - 1].part == CAMBER_PLAN_AREA;
        const bool goes_on = last && last->opaque && opaque && last->overlap == overlap;
        if ((goes_on || same_group) && last->end_polyline == first) {
            last->end_layer = i + 1;
            last->end_polyline = end;
            last->end_paint = end_of(n, set);
        } else {
            runs[count++] = (layer_run){i, i + 1, first, end, end_of(n, set), opacity, overlap, opaque, NULL};
        }
    }
    return count;
}

/* Lines that were cut do not know where their polylines begin, so patterns are dropped, and a gradient becomes the
 * colour of its middle. */
static void forget_progress(camber_paint *paint) {
    if (paint->ramp) {
        const float alpha = paint->color.a;
        paint->color = paint->ramp->stops[paint->ramp->count / 2].color;
        paint->color.a *= alpha;
    }
    paint->dash = NULL;
    paint->ramp = NULL;
    paint->image = NULL;
    paint->trim_start = paint->trim_end = 0.0f;
}

/* Writes the paints of a pass: one for each row below its end, of width 0 where the pass does not draw the row. */
static void put_paints(const camber_row_order *n, const layer_run *run, camber_paint *paints) {
    memset(paints, 0, run->end_paint * sizeof *paints);
    for (size_t i = run->first_layer; i < run->end_layer; i++) {
        const camber_plan_layer *layer = n->plan->layers + i;
        const camber_plan_set *set = n->plan->sets + layer->set;
        bool opaque;
        if (!layer_draws(n, layer, &opaque))
            continue;
        for (size_t k = first_of(n, set); k < end_of(n, set); k++) {
            paints[k] = paint_of(n, layer, k);
            if (!n->by_pair)
                forget_progress(paints + k);
        }
    }
}

camber_status camber_passes_make(camber_context *context, const camber_row_order *n, size_t *layer_count,
                                 camber_pass_list *list) {
    camber_status status = CAMBER_ERROR_MEMORY;
    layer_run *runs = camber_alloc(context, n->plan->layer_count + n->plan->patterns.fill_count, sizeof *runs);
    if (!runs)
        return CAMBER_ERROR_MEMORY;
    const size_t count = find_runs(n, runs, layer_count);
    size_t paint_count = 0;
    for (size_t i = 0; i < count; i++)
        paint_count += runs[i].end_paint;
    if (paint_count > MOST_PAINTS) {
        status = camber_fail(context, CAMBER_ERROR_LIMIT, "style: %zu passes over %zu kinds of lines; use fewer layers",
                             count, runs[count - 1].end_paint);
        goto done;
    }
    if (!(list->paints = camber_alloc(context, paint_count, sizeof *list->paints)) ||
        !(list->passes = camber_alloc(context, count, sizeof *list->passes)))
        goto done;
    camber_paint *paints = list->paints;
    for (size_t i = 0; i < count; i++) {
        put_paints(n, runs + i, paints);
        list->passes[i] = (camber_pass){.first_polyline = runs[i].first_polyline,
                                        .polyline_count = runs[i].end_polyline - runs[i].first_polyline,
                                        .paints = paints,
                                        .paint_count = runs[i].end_paint,
                                        .overlap = runs[i].overlap,
                                        .opacity = runs[i].opacity};
        if (runs[i].fill) {
            list->passes[i].kind = CAMBER_PASS_FILL;
            list->passes[i].fill = runs[i].fill->fill;
        }
        paints += runs[i].end_paint;
    }
    list->count = count;
    status = CAMBER_OK;
done:
    camber_free(context, runs);
    return status;
}

void camber_passes_free(camber_context *context, camber_pass_list *list) {
    camber_free(context, list->passes);
    camber_free(context, list->paints);
}
