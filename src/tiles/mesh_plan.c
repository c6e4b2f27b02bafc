/* Plans mesh tiles: evaluates the style at several zooms from one whole zoom to the next.
 *
 * Input: features and a zoom. Output: the plan just below the next zoom, whose sets and pairs the tiles use, and the
 * paints of all samples. Main idea: layers of two plans correspond if they come from the same layer of the style, and
 * pairs correspond if they have the same class of features. */
#include "tiles/mesh_plan.h"

#include "map/plan_network.h"

#include <math.h>

static const camber_plan *plan_at(const camber_mesh_plan *plan, size_t sample) {
    return sample + 1 < CAMBER_MESH_SAMPLES ? plan->samples + sample : &plan->zoom->plan;
}

/* Returns the row in another sample's set for the class and dot of a pair of the zoom's plan; CAMBER_NO_ROW if that set
 * does not draw them. A style has the same number of dots at all zooms, unless a layer appears between two samples: the
 * last dot belongs to the fill. */
static uint32_t row_of(const camber_mesh_plan *mesh, const camber_plan *plan, size_t set, uint32_t pair) {
    const uint32_t class = mesh->pair_classes[pair];
    const size_t above = mesh->zoom->plan.dot_count - mesh->zoom->plan.pair_dots[pair];
    for (size_t k = plan->by_class.first[class]; k < plan->by_class.first[class + 1]; k++) {
        const camber_set_pair *own = plan->by_class.pairs + k;
        if (own->set == set && plan->dot_count - plan->pair_dots[own->pair] == above)
            return plan->pair_rows[own->pair];
    }
    return CAMBER_NO_ROW;
}

/* Returns the paint of a pair in a layer at a sample. */
static camber_paint pair_paint(const camber_mesh_plan *plan, size_t layer, uint32_t pair, size_t sample) {
    const camber_plan *own = plan_at(plan, sample);
    const size_t at = plan->sample_layers[sample * plan->zoom->plan.layer_count + layer];
    camber_paint paint;
    memset(&paint, 0, sizeof paint);
    if (at == SIZE_MAX)
        return paint;
    const camber_plan_layer *found = own->layers + at;
    const uint32_t row = row_of(plan, own, found->set, pair);
    return row == CAMBER_NO_ROW ? paint : camber_plan_paint(own, own->sets + found->set, row, found->slot);
}

camber_paint camber_mesh_plan_paint(const camber_mesh_plan *plan, size_t layer, uint32_t row, size_t sample) {
    return pair_paint(plan, layer, plan->row_pairs[row], sample);
}

/* ---- Layers and pairs ---- */

static camber_status find_layers(camber_mesh_plan *plan) {
    const camber_plan *whole = &plan->zoom->plan;
    plan->sample_layers = camber_alloc(plan->context, whole->layer_count, CAMBER_MESH_SAMPLES * sizeof(size_t));
    if (!plan->sample_layers)
        return CAMBER_ERROR_MEMORY;
    for (size_t s = 0; s < CAMBER_MESH_SAMPLES; s++) {
        const camber_plan *own = plan_at(plan, s);
        for (size_t i = 0; i < whole->layer_count; i++) {
            size_t *found = plan->sample_layers + s * whole->layer_count + i;
            *found = SIZE_MAX;
            for (size_t k = 0; k < own->layer_count && *found == SIZE_MAX; k++)
                if (own->layers[k].look.layer == whole->layers[i].look.layer &&
                    own->layers[k].part == whole->layers[i].part)
                    *found = k;
        }
    }
    return CAMBER_OK;
}

static camber_status find_classes(camber_mesh_plan *plan) {
    const camber_plan *whole = &plan->zoom->plan;
    if (!(plan->pair_classes = camber_alloc(plan->context, whole->pair_count, sizeof *plan->pair_classes)))
        return CAMBER_ERROR_MEMORY;
    for (size_t c = 0; c < plan->zoom->features->class_count; c++)
        for (size_t k = whole->by_class.first[c]; k < whole->by_class.first[c + 1]; k++)
            plan->pair_classes[whole->by_class.pairs[k].pair] = (uint32_t)c;
    return CAMBER_OK;
}

static float whole_width(const camber_paint *paint) {
    return paint->gap_px > 0.0f ? paint->gap_px + 2.0f * paint->width_px : paint->width_px;
}

/* Returns the offset of a pair in a sample's set. */
static float offset_of(const camber_mesh_plan *plan, size_t layer, uint32_t pair, size_t sample) {
    const camber_plan *own = plan_at(plan, sample);
    const size_t at = plan->sample_layers[sample * plan->zoom->plan.layer_count + layer];
    const uint32_t row = at == SIZE_MAX ? CAMBER_NO_ROW : row_of(plan, own, own->layers[at].set, pair);
    return row == CAMBER_NO_ROW ? 0.0f : own->strokes[row].offset_px;
}

float camber_mesh_plan_offset(const camber_mesh_plan *plan, size_t layer, uint32_t row, size_t sample) {
    return offset_of(plan, layer, plan->row_pairs[row], sample);
}

/* Sets the width of a pair's stroke to its largest width at any sample, in px of zoom z, and returns its reach;
 * negative if it is not drawn. An offset or a translation makes the reach larger than the stroke's own; the camera
 * extends its window by the difference. */
static float widen(camber_mesh_plan *plan, const camber_plan_set *set, uint32_t pair) {
    camber_stroke *stroke = plan->zoom->strokes + pair;
    float reach = -1.0f;
    stroke->width_px = 0.0f;
    for (size_t n = 0, layer = set->first_layer; n < set->layer_count; n++, layer = plan->zoom->plan.layers[layer].next)
        for (size_t s = 0; s < CAMBER_MESH_SAMPLES; s++) {
            const float shrunk = (float)exp2(-camber_mesh_sample_zoom(s));
            const camber_paint paint = pair_paint(plan, layer, pair, s);
            camber_stroke own = *stroke;
            own.width_px = shrunk * whole_width(&paint);
            own.offset_px = shrunk * offset_of(plan, layer, pair, s);
            if (!camber_mesh_plan_draws(&paint))
                continue;
            stroke->width_px = fmaxf(stroke->width_px, own.width_px);
            reach = fmaxf(reach, (float)camber_plan_stroke_reach(&own) +
                                     shrunk * hypotf(paint.translate_x_px, paint.translate_y_px) + 1.0f);
        }
    stroke->offset_px = 0.0f; /* tiles contain the line itself, and shaders apply the offset */
    const float beyond = reach - (float)camber_plan_stroke_reach(stroke);
    plan->zoom->plan.translate_px = fmaxf(plan->zoom->plan.translate_px, beyond);
    return reach;
}

/* ---- Rows ---- */

typedef struct row_maker {
    camber_mesh_plan *plan;
    uint32_t *slots; /* index of a row + 1; 0: free */
    size_t slot_count;
    uint32_t *key, *other; /* of a pair: its rows in all samples, for each layer of its set */
} row_maker;

static size_t list_rows(const camber_mesh_plan *plan, const camber_plan_set *set, uint32_t pair, uint32_t *rows) {
    const size_t layers = plan->zoom->plan.layer_count;
    size_t count = 0;
    for (size_t n = 0, layer = set->first_layer; n < set->layer_count; n++, layer = plan->zoom->plan.layers[layer].next)
        for (size_t s = 0; s < CAMBER_MESH_SAMPLES; s++) {
            const size_t at = plan->sample_layers[s * layers + layer];
            rows[count++] =
                at == SIZE_MAX ? CAMBER_NO_ROW : row_of(plan, plan_at(plan, s), plan_at(plan, s)->layers[at].set, pair);
        }
    return count * sizeof *rows;
}

/* Finds the row of the set for the pair, or adds one. */
static void put_row(row_maker *m, const camber_plan_set *set, uint32_t pair) {
    camber_mesh_plan *plan = m->plan;
    const size_t size_bytes = list_rows(plan, set, pair, m->key);
    const uint64_t hash = camber_hash(CAMBER_HASH_START, m->key, size_bytes);
    size_t at = (size_t)(hash ^ hash >> 32) & (m->slot_count - 1);
    for (; m->slots[at]; at = (at + 1) & (m->slot_count - 1)) {
        const uint32_t other = plan->row_pairs[m->slots[at] - 1];
        if (other >= set->first_pair && list_rows(plan, set, other, m->other) == size_bytes &&
            memcmp(m->key, m->other, size_bytes) == 0)
            break;
    }
    if (!m->slots[at]) {
        plan->row_pairs[plan->row_count++] = pair;
        m->slots[at] = (uint32_t)plan->row_count;
    }
    plan->pair_rows[pair] = m->slots[at] - 1;
}

static bool goes_along(const camber_mesh_plan *plan, const camber_plan_set *set, uint32_t pair) {
    for (size_t n = 0, layer = set->first_layer; n < set->layer_count; n++, layer = plan->zoom->plan.layers[layer].next)
        for (size_t s = 0; s < CAMBER_MESH_SAMPLES; s++) {
            const camber_paint paint = pair_paint(plan, layer, pair, s);
            if (paint.dash || paint.ramp || paint.trim_end > paint.trim_start)
                return true;
        }
    return false;
}

static camber_status make_rows(camber_mesh_plan *plan, row_maker *m) {
    const camber_plan *whole = &plan->zoom->plan;
    const size_t pairs = whole->pair_count, tuple = whole->layer_count * CAMBER_MESH_SAMPLES;
    for (m->slot_count = 16; m->slot_count / 2 < pairs;)
        m->slot_count *= 2;
    if (!(m->slots = camber_alloc_zero(plan->context, m->slot_count, sizeof *m->slots)) ||
        !(m->key = camber_alloc(plan->context, tuple, sizeof *m->key)) ||
        !(m->other = camber_alloc(plan->context, tuple, sizeof *m->other)) ||
        !(plan->pair_rows = camber_alloc_zero(plan->context, pairs, sizeof *plan->pair_rows)) ||
        !(plan->row_pairs = camber_alloc(plan->context, pairs, sizeof *plan->row_pairs)) ||
        !(plan->reach_px = camber_alloc_zero(plan->context, pairs, sizeof *plan->reach_px)) ||
        !(plan->has_arc_length = camber_alloc_zero(plan->context, pairs, sizeof *plan->has_arc_length)))
        return CAMBER_ERROR_MEMORY;
    for (size_t s = 0; s < whole->set_count; s++) {
        const camber_plan_set *set = whole->sets + s;
        for (size_t k = 0; k < set->pair_count; k++) {
            const uint32_t pair = (uint32_t)(set->first_pair + k);
            const float reach = widen(plan, set, pair);
            const size_t rows = plan->row_count;
            put_row(m, set, pair);
            const uint32_t row = plan->pair_rows[pair];
            plan->reach_px[row] = plan->row_count > rows ? reach : fmaxf(plan->reach_px[row], reach);
            plan->has_arc_length[row] = plan->has_arc_length[row] || goes_along(plan, set, pair);
        }
    }
    return CAMBER_OK;
}

/* Finds how far each class reaches in any set. */
static void find_reaches(camber_mesh_plan *plan) {
    camber_zoom_plan *zoom = plan->zoom;
    const camber_plan *whole = &zoom->plan;
    zoom->most_reach_px = 0.0f;
    for (size_t c = 0; c < zoom->features->class_count; c++) {
        float reach = -1.0f;
        for (size_t k = whole->by_class.first[c]; k < whole->by_class.first[c + 1]; k++)
            reach = fmaxf(reach, plan->reach_px[plan->pair_rows[whole->by_class.pairs[k].pair]]);
        zoom->class_reach_px[c] = reach;
        zoom->most_reach_px = fmaxf(zoom->most_reach_px, reach);
    }
}

/* ---- The plan ---- */

static camber_status evaluate(const camber_features *features, const camber_zoom_desc *desc, camber_mesh_plan *plan) {
    camber_status status = CAMBER_OK;
    for (size_t s = 0; s + 1 < CAMBER_MESH_SAMPLES && status == CAMBER_OK; s++) {
        camber_zoom_desc own = *desc;
        own.zoom += camber_mesh_sample_zoom(s);
        const camber_view view = camber_zoom_view(&own);
        status = camber_plan_evaluate(features, &view, plan->samples + s);
    }
    camber_zoom_desc top = *desc;
    top.zoom += camber_mesh_sample_zoom(CAMBER_MESH_SAMPLES - 1);
    top.simplify_px *= 0.5; /* in px of zoom z + 1 */
    if (status == CAMBER_OK)
        status = camber_zoom_plan_create(features, &top, &plan->zoom);
    for (size_t s = 0; s + 1 < CAMBER_MESH_SAMPLES && status == CAMBER_OK; s++)
        plan->zoom->plan.has_arc_length |= plan->samples[s].has_arc_length;
    return status;
}

camber_status camber_mesh_plan_create(const camber_features *features, const camber_zoom_desc *desc,
                                      camber_mesh_plan **plan) {
    camber_mesh_plan *made = camber_alloc_zero(features->context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = features->context;
    for (size_t s = 0; s + 1 < CAMBER_MESH_SAMPLES; s++)
        made->samples[s].context = made->samples[s].patterns.context = features->context;
    row_maker maker = {.plan = made};
    camber_status status = evaluate(features, desc, made);
    if (status == CAMBER_OK)
        status = find_layers(made);
    if (status == CAMBER_OK)
        status = find_classes(made);
    if (status == CAMBER_OK)
        status = make_rows(made, &maker);
    camber_free(made->context, maker.slots);
    camber_free(made->context, maker.key);
    camber_free(made->context, maker.other);
    if (status == CAMBER_OK) {
        find_reaches(made);
        made->zoom->lines_only = true; /* areas are cut on the host */
        *plan = made;
    } else {
        camber_mesh_plan_destroy(made);
    }
    return status;
}

void camber_mesh_plan_destroy(camber_mesh_plan *plan) {
    if (!plan)
        return;
    for (size_t s = 0; s + 1 < CAMBER_MESH_SAMPLES; s++)
        camber_plan_destroy(plan->samples + s);
    camber_zoom_plan_destroy(plan->zoom);
    camber_free(plan->context, plan->sample_layers);
    camber_free(plan->context, plan->pair_classes);
    camber_free(plan->context, plan->pair_rows);
    camber_free(plan->context, plan->row_pairs);
    camber_free(plan->context, plan->reach_px);
    camber_free(plan->context, plan->has_arc_length);
    camber_free(plan->context, plan);
}
