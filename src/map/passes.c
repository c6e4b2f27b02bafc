/* Passes: the steps in which a plan is drawn with a mesh.
 *
 * Input: a plan, and which of its pairs or rows have polylines in the mesh. Output: passes over these polylines, each
 * with its paints. Main idea: opaque layers whose polylines follow each other become one pass. */
#include "map/passes.h"

#include <string.h>

/* The paints of all passes take 2.4 GB at most. */
static const size_t MOST_PAINTS = (size_t)1 << 26;

static size_t first_of(const camber_mesh_rows *rows, const camber_plan_set *set) {
    return rows->by_pair ? set->first_pair : set->first_row;
}

static size_t end_of(const camber_mesh_rows *rows, const camber_plan_set *set) {
    return rows->by_pair ? set->first_pair + set->pair_count : set->first_row + set->row_count;
}

static camber_paint paint_of(const camber_mesh_rows *rows, const camber_plan_layer *layer, size_t number) {
    const size_t row = rows->by_pair ? rows->plan->pair_rows[number] : number;
    return camber_plan_paint(rows->plan, rows->plan->sets + layer->set, row, layer->slot);
}

/* Consecutive layers that are drawn by one pass. */
typedef struct layer_run {
    size_t first_layer, end_layer; /* of the plan */
    size_t first_polyline, end_polyline;
    size_t end_paint;
    float opacity; /* the layer's opacity; 1 if several layers are drawn together */
    camber_overlap overlap;
    bool opaque;
    const camber_plan_fill *fill;     /* NULL: none. With a fill or labels, the fields above are unused */
    const camber_label_range *labels; /* NULL: none */
} layer_run;

static bool draws(const camber_paint *paint) {
    return paint->width_px > 0.0f || paint->fill;
}

/* Whether the layer draws any of the polylines. Sets *opaque if it draws only opaque lines. */
static bool layer_draws(const camber_mesh_rows *rows, const camber_plan_layer *layer, bool *opaque) {
    const camber_plan_set *set = rows->plan->sets + layer->set;
    bool drawn = false;
    *opaque = true;
    for (size_t i = first_of(rows, set); i < end_of(rows, set); i++) {
        const camber_paint paint = paint_of(rows, layer, i);
        if (!rows->used[i] || !draws(&paint))
            continue;
        drawn = true;
        *opaque &= !paint.fill && paint.color.a >= 1.0f && !(paint.ramp && layer->translucent_ramp);
    }
    return drawn;
}

/* Whether a range of labels is below a layer of the plan. After the last layer, all ranges are. */
static bool are_below(const camber_mesh_rows *rows, size_t range, size_t layer) {
    return layer == rows->plan->layer_count ||
           rows->labels->ranges[range].layer < (size_t)(rows->plan->layers[layer].look.layer - rows->style_layers);
}

/* Groups layers into runs. Consecutive opaque layers whose polylines are adjacent are drawn by one pass. A translucent
 * layer has its own pass, because it is flattened separately. A layer of areas also has its own, because equal fills of
 * two layers would otherwise become one path; if it has an opacity, its outline is in the same pass. Fills of the whole
 * picture and labels are separate runs between them. */
static size_t find_runs(const camber_mesh_rows *rows, layer_run *runs, size_t *layer_count) {
    const camber_plan *plan = rows->plan;
    size_t count = 0, fill = 0, range = 0, counted = plan->layer_count;
    *layer_count = 0;
    for (size_t i = 0; i <= plan->layer_count; i++) {
        bool opaque;
        for (; fill < plan->patterns.fill_count && plan->patterns.fills[fill].before == i; fill++)
            runs[count++] = (layer_run){.fill = plan->patterns.fills + fill};
        for (; rows->labels && range < rows->labels->range_count && are_below(rows, range, i); range++)
            runs[count++] = (layer_run){.labels = rows->labels->ranges + range};
        if (i == plan->layer_count)
            break;
        if (!layer_draws(rows, plan->layers + i, &opaque))
            continue;
        *layer_count += counted == plan->layer_count || plan->layers[i].look.layer != plan->layers[counted].look.layer;
        counted = i;
        const camber_plan_set *set = plan->sets + plan->layers[i].set;
        const float opacity = (float)plan->layers[i].look.paint.layer_opacity;
        opaque = opaque && opacity >= 1.0f;
        const size_t first = rows->first_polylines[plan->layers[i].set],
                     end = rows->first_polylines[plan->layers[i].set + 1];
        const camber_overlap overlap = plan->layers[i].look.layer->overlap;
        layer_run *last = count ? runs + count - 1 : NULL;
        const bool same_group = opacity < 1.0f && plan->layers[i].part == CAMBER_PLAN_OUTLINE && last &&
                                last->end_layer == i && plan->layers[i - 1].part == CAMBER_PLAN_AREA;
        const bool goes_on = last && last->opaque && opaque && last->overlap == overlap;
        if ((goes_on || same_group) && last->end_polyline == first) {
            last->end_layer = i + 1;
            last->end_polyline = end;
            last->end_paint = end_of(rows, set);
        } else {
            runs[count++] = (layer_run){i, i + 1, first, end, end_of(rows, set), opacity, overlap, opaque, NULL, NULL};
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

/* Writes the paints of a pass, one for each row below its end. Rows that the pass does not draw get the width 0. */
static void put_paints(const camber_mesh_rows *rows, const layer_run *run, camber_paint *paints) {
    memset(paints, 0, run->end_paint * sizeof *paints);
    for (size_t i = run->first_layer; i < run->end_layer; i++) {
        const camber_plan_layer *layer = rows->plan->layers + i;
        const camber_plan_set *set = rows->plan->sets + layer->set;
        bool opaque;
        if (!layer_draws(rows, layer, &opaque))
            continue;
        for (size_t k = first_of(rows, set); k < end_of(rows, set); k++) {
            paints[k] = paint_of(rows, layer, k);
            if (!rows->by_pair)
                forget_progress(paints + k);
        }
    }
}

/* Adds the pass of a run of layers or of a fill. Returns the first of the paints that are left. */
static camber_paint *add_pass(const camber_mesh_rows *rows, const layer_run *run, camber_paint *paints,
                              camber_pass_list *list) {
    camber_pass *pass = list->passes + list->count++;
    put_paints(rows, run, paints);
    *pass = (camber_pass){.first_polyline = run->first_polyline,
                          .polyline_count = run->end_polyline - run->first_polyline,
                          .paints = paints,
                          .paint_count = run->end_paint,
                          .overlap = run->overlap,
                          .opacity = run->opacity};
    if (run->fill) {
        pass->kind = CAMBER_PASS_FILL;
        pass->fill = run->fill->fill;
    }
    return paints + run->end_paint;
}

static bool allocate_passes(camber_context *context, const layer_run *runs, size_t run_count, size_t paint_count,
                            camber_pass_list *list) {
    size_t count = 0;
    for (size_t i = 0; i < run_count; i++)
        count += runs[i].labels ? CAMBER_LABEL_PASSES : 1u;
    return (list->paints = camber_alloc(context, paint_count, sizeof *list->paints)) &&
           (list->passes = camber_alloc(context, count, sizeof *list->passes)) &&
           (list->meshes = camber_alloc_zero(context, count, sizeof *list->meshes));
}

camber_status camber_passes_make(camber_context *context, const camber_mesh_rows *rows, size_t *layer_count,
                                 camber_pass_list *list) {
    const size_t ranges = rows->labels ? rows->labels->range_count : 0;
    camber_status status = CAMBER_ERROR_MEMORY;
    layer_run *runs =
        camber_alloc(context, rows->plan->layer_count + rows->plan->patterns.fill_count + ranges, sizeof *runs);
    if (!runs)
        return CAMBER_ERROR_MEMORY;
    const size_t count = find_runs(rows, runs, layer_count);
    size_t paint_count = 0;
    for (size_t i = 0; i < count; i++)
        paint_count += runs[i].end_paint;
    if (paint_count > MOST_PAINTS) {
        status = camber_fail(context, CAMBER_ERROR_LIMIT, "style: %zu passes over %zu kinds of lines; use fewer layers",
                             count, runs[count - 1].end_paint);
        goto done;
    }
    if (!allocate_passes(context, runs, count, paint_count, list))
        goto done;
    camber_paint *paints = list->paints;
    for (size_t i = 0; i < count; i++) {
        if (runs[i].labels)
            list->count += camber_label_shapes_passes(rows->labels, runs[i].labels, list->passes + list->count,
                                                      list->meshes + list->count);
        else
            paints = add_pass(rows, runs + i, paints, list);
    }
    status = CAMBER_OK;
done:
    camber_free(context, runs);
    return status;
}

void camber_passes_free(camber_context *context, camber_pass_list *list) {
    camber_free(context, list->passes);
    camber_free(context, list->meshes);
    camber_free(context, list->paints);
}
