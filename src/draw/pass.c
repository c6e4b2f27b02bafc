/* Drawing one pass into one piece: directly where it is opaque or accumulates, else run by run through a layer that is
 * flattened onto the picture. */
#include "draw/renderer.h"

#include <math.h>

float camber_renderer_thinnest(const camber_frame *frame) {
    float thinnest_px = INFINITY;
    for (size_t p = 0; p < frame->pass_count; p++)
        for (size_t i = 0; i < frame->passes[p].paint_count; i++) {
            const float width_px = frame->passes[p].paints[i].width_px;
            thinnest_px = width_px > 0.0f && width_px < thinnest_px ? width_px : thinnest_px;
        }
    return thinnest_px;
}

/* What the layer of a run holds; of one that has none, colours. */
static camber_flatten_kind kind_of(const camber_renderer *renderer, const camber_run *run) {
    if (run->layered && run->masked)
        return CAMBER_FLATTEN_MASKED;
    if (!run->layered || !run->one_color)
        return CAMBER_FLATTEN_COLORS;
    /* The union is of strokes with one edge on each side. */
    return renderer->share.surface->half_float_targets && !run->bands ? CAMBER_FLATTEN_UNION : CAMBER_FLATTEN_COVERAGE;
}

/* How the fragments of a layer come together. Of the union's four, the last gathers one over the other and the first
 * three add up. One channel has no alpha of its own to blend by: a + b - ab is ONE, ONE_MINUS_SRC_COLOR. */
static void set_blending(const camber_gl *gl, camber_flatten_kind kind) {
    if (kind == CAMBER_FLATTEN_UNION)
        gl->BlendFuncSeparate(GL_ONE, GL_ONE, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    else
        gl->BlendFunc(GL_ONE, kind == CAMBER_FLATTEN_COVERAGE ? GL_ONE_MINUS_SRC_COLOR : GL_ONE_MINUS_SRC_ALPHA);
}

/* Puts a layer (below 0: a fill) over what the piece draws into; color is premultiplied, or of colours the opacity four
 * times. */
static camber_status flatten(camber_renderer *renderer, int layer, camber_flatten_kind kind, const float color[4],
                             const camber_piece *piece) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const camber_shader *shader;
    camber_status status = camber_renderer_flatten_shader(renderer, kind, &shader);
    if (status == CAMBER_OK)
        status = camber_renderer_bind_target(renderer, piece->target, (GLsizei)piece->width, (GLsizei)piece->height);
    if (status != CAMBER_OK)
        return status;
    gl->BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    gl->UseProgram(shader->program);
    gl->Uniform4f(shader->layer_color, color[0], color[1], color[2], color[3]);
    if (kind == CAMBER_FLATTEN_MASKED) {
        gl->ActiveTexture(GL_TEXTURE0 + CAMBER_ALPHAS_UNIT);
        gl->BindTexture(GL_TEXTURE_2D, renderer->targets[layer].alphas);
        gl->ActiveTexture(GL_TEXTURE0);
    }
    gl->BindTexture(GL_TEXTURE_2D, layer >= 0 ? renderer->targets[layer].texture : 0);
    gl->BindVertexArray(renderer->vertex_array);
    if (kind == CAMBER_FLATTEN_IMAGES)
        camber_renderer_hide_beyond(renderer, piece);
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
    if (kind == CAMBER_FLATTEN_IMAGES)
        gl->Scissor(0, 0, (GLsizei)piece->width, (GLsizei)piece->height);
    gl->BindVertexArray(0);
    ++*piece->draw_calls;
    return CAMBER_OK;
}

/* An empty layer to draw into. */
static camber_status begin_layer(camber_renderer *renderer, int layer, const camber_piece *piece) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const camber_status status =
        camber_renderer_bind_target(renderer, layer, (GLsizei)piece->width, (GLsizei)piece->height);
    if (status != CAMBER_OK)
        return status;
    gl->ClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    gl->Clear(GL_COLOR_BUFFER_BIT);
    return CAMBER_OK;
}

static camber_status draw_layered(camber_renderer *renderer, const camber_run *run, const camber_piece *piece) {
    const camber_gl *gl = &renderer->share.surface->gl;
    static const unsigned variants[CAMBER_FLATTEN_KINDS] = {
        [CAMBER_FLATTEN_UNION] = CAMBER_VARIANT_UNION, [CAMBER_FLATTEN_MASKED] = CAMBER_VARIANT_MASK};
    static const int layers[CAMBER_FLATTEN_KINDS] = {CAMBER_TARGET_LAYER, CAMBER_TARGET_COVERAGE,
                                                     CAMBER_TARGET_COVERAGE, CAMBER_TARGET_MASKED};
    const camber_flatten_kind kind = kind_of(renderer, run);
    const int layer = layers[kind];
    camber_status status = begin_layer(renderer, layer, piece);
    if (status == CAMBER_OK)
        status = camber_batch_add(renderer, run, piece);
    if (status != CAMBER_OK)
        return status;
    set_blending(gl, kind);
    status = camber_batch_draw(renderer, variants[kind], piece);
    if (status != CAMBER_OK)
        return status;
    const float a = run->alpha * run->opacity;
    const float color[4] = {run->one_color ? run->color.r * a : a, run->one_color ? run->color.g * a : a,
                            run->one_color ? run->color.b * a : a, a};
    return flatten(renderer, layer, kind, color, piece);
}

static bool same_color(camber_color a, camber_color b) {
    return a.r == b.r && a.g == b.g && a.b == b.b;
}

static unsigned bands_of(const camber_paint *paint) {
    return (paint->gap_px > 0.0f ? (unsigned)CAMBER_VARIANT_GAP : 0u) |
           (paint->blur_px > 0.0f ? (unsigned)CAMBER_VARIANT_BLUR : 0u) |
           (paint->dash ? (unsigned)CAMBER_VARIANT_DASH : 0u) |
           (paint->trim_end > paint->trim_start ? (unsigned)CAMBER_VARIANT_TRIM : 0u) |
           (paint->ramp ? (unsigned)CAMBER_VARIANT_RAMP : 0u) |
           (paint->pattern ? (unsigned)CAMBER_VARIANT_PATTERN : 0u);
}

static bool is_translucent(const camber_ramp *ramp) {
    for (size_t i = 0; i < ramp->count; i++)
        if (ramp->stops[i].color.a < 1.0f)
            return true;
    return false;
}

/* The paints that a run has met so far. */
typedef struct run_maker {
    camber_run run;
    const camber_ramp *known; /* the last one looked at */
    bool met;
} run_maker;

static run_maker make_run(const camber_pass *pass, size_t first, size_t end) {
    return (run_maker){
        .run = {.pass = pass, .first = first, .end = end, .alpha = 1.0f, .opacity = 1.0f, .one_color = true}};
}

static void meet(run_maker *made, const camber_paint *paint) {
    camber_run *run = &made->run;
    const camber_pass *pass = run->pass;
    const bool layered = pass->overlap != CAMBER_OVERLAP_ACCUMULATE;
    if (!made->met) {
        run->alpha = layered ? paint->color.a : 1.0f;
        run->color = paint->color;
    }
    run->one_color = run->one_color && same_color(paint->color, run->color) && !paint->ramp && !paint->pattern;
    run->bands |= bands_of(paint);
    if (layered && paint->ramp && !run->masked && pass->ramps + paint->ramp - 1 != made->known) {
        made->known = pass->ramps + paint->ramp - 1;
        run->masked = is_translucent(made->known);
    }
    made->met = true;
}

static camber_run end_run(run_maker *made) {
    camber_run *run = &made->run;
    if (!made->met)
        run->alpha = 0.0f; /* nothing to draw */
    run->layered = run->alpha < 1.0f || run->masked || (run->pass->overlap == CAMBER_OVERLAP_UNITE && run->one_color);
    run->one_alpha |= run->layered;
    return *run;
}

camber_run camber_pass_next_run(const camber_pass *pass, size_t first, size_t end) {
    const uint32_t *rows = pass->mesh->polyline_rows;
    const bool layered = pass->overlap != CAMBER_OVERLAP_ACCUMULATE;
    run_maker made = make_run(pass, first, first);
    for (; made.run.end < end; made.run.end++) {
        const uint32_t row = rows[made.run.end];
        if (!camber_pass_draws(pass, row))
            continue;
        if (made.met && layered && pass->paints[row].color.a != made.run.alpha)
            break;
        meet(&made, pass->paints + row);
    }
    return end_run(&made);
}

/* ---- Alphas that change from line to line ---- */

/* A layer costs as much as all of its pixels: so many a pass, in the order of lines or an alpha each. */
enum { LAYERS_MAX = 32 };

static bool makes_layer(const camber_run *run) {
    return run->layered && run->alpha > 0.0f;
}

/* Whether the runs from the pass's first one on are more layers than a pass may have. */
static bool changes_often(const camber_run *first, size_t end) {
    size_t at = first->end, layers = makes_layer(first);
    while (at < end && layers <= LAYERS_MAX) {
        const camber_run run = camber_pass_next_run(first->pass, at, end);
        layers += makes_layer(&run);
        at = run.end;
    }
    return layers > LAYERS_MAX;
}

static void add_alpha(camber_alphas *alphas, float alpha) {
    size_t at = 0;
    while (at < alphas->count && alphas->values[at] < alpha)
        at++;
    if (at < alphas->count && alphas->values[at] <= alpha)
        return;
    if (alphas->count == CAMBER_ALPHAS_MAX) {
        alphas->more = true;
        return;
    }
    for (size_t i = alphas->count++; i > at; i--)
        alphas->values[i] = alphas->values[i - 1];
    alphas->values[at] = alpha;
}

/* The polylines of one alpha, or all of them, each with its own. */
static camber_run choose(const camber_pass *pass, size_t end, const float *alpha) {
    const uint32_t *rows = pass->mesh->polyline_rows;
    run_maker made = make_run(pass, pass->first_polyline, end);
    made.run.one_alpha = alpha != NULL;
    for (size_t i = pass->first_polyline; i < end; i++)
        if (camber_pass_draws(pass, rows[i]) && (!alpha || pass->paints[rows[i]].color.a == *alpha))
            meet(&made, pass->paints + rows[i]);
    if (!alpha) {
        made.run.alpha = 1.0f;
        made.run.one_color = false;
        made.run.masked = made.run.layered = true;
        return made.run;
    }
    return end_run(&made);
}

camber_runs camber_runs_begin(const camber_pass *pass, size_t end) {
    camber_runs runs = {.pass = pass, .next = pass->first_polyline, .end = end};
    if (pass->first_polyline >= end)
        return runs;
    runs.first = camber_pass_next_run(pass, pass->first_polyline, end);
    if (!changes_often(&runs.first, end))
        return runs;
    const uint32_t *rows = pass->mesh->polyline_rows;
    for (size_t i = pass->first_polyline; i < end && !runs.alphas.more; i++)
        if (camber_pass_draws(pass, rows[i]))
            add_alpha(&runs.alphas, pass->paints[rows[i]].color.a);
    runs.masked = runs.alphas.more;
    runs.by_alpha = !runs.alphas.more;
    return runs;
}

bool camber_runs_next(camber_runs *runs, camber_run *run) {
    if (runs->by_alpha) {
        if (runs->alpha == runs->alphas.count)
            return false;
        *run = choose(runs->pass, runs->end, &runs->alphas.values[runs->alpha++]);
        return true;
    }
    if (runs->next >= runs->end)
        return false;
    *run = runs->masked ? choose(runs->pass, runs->end, NULL) : camber_pass_next_run(runs->pass, runs->next, runs->end);
    runs->next = run->end;
    return true;
}

static camber_status draw_run(camber_renderer *renderer, const camber_run *run, const camber_piece *piece) {
    if (run->alpha <= 0.0f)
        return CAMBER_OK;
    if (!run->layered)
        return camber_batch_add(renderer, run, piece);
    const camber_status status = camber_batch_draw(renderer, 0, piece); /* what waits lies below */
    return status == CAMBER_OK ? draw_layered(renderer, run, piece) : status;
}

static camber_status draw_runs(camber_renderer *renderer, const camber_pass *pass, size_t end,
                               const camber_piece *piece) {
    camber_runs runs = camber_runs_begin(pass, end);
    camber_run run;
    camber_status status = CAMBER_OK;
    while (status == CAMBER_OK && camber_runs_next(&runs, &run))
        status = draw_run(renderer, &run, piece);
    return status;
}

/* A pass with an opacity: its one run's layer takes it, or a layer that all its runs are drawn into. */
static camber_status draw_group(camber_renderer *renderer, const camber_pass *pass, size_t end,
                                const camber_piece *piece) {
    camber_run run = camber_pass_next_run(pass, pass->first_polyline, end);
    if (run.end == end && pass->overlap != CAMBER_OVERLAP_ACCUMULATE) {
        run.opacity = pass->opacity;
        run.layered = run.one_alpha = true;
        return draw_run(renderer, &run, piece);
    }
    camber_piece group = *piece;
    group.target = CAMBER_TARGET_GROUP;
    camber_status status = camber_batch_draw(renderer, 0, piece);
    if (status == CAMBER_OK)
        status = begin_layer(renderer, group.target, &group);
    if (status == CAMBER_OK)
        status = draw_runs(renderer, pass, end, &group);
    if (status == CAMBER_OK)
        status = camber_batch_draw(renderer, 0, &group);
    const float a = pass->opacity, color[4] = {a, a, a, a};
    return status == CAMBER_OK ? flatten(renderer, group.target, CAMBER_FLATTEN_COLORS, color, piece) : status;
}

/* What the shader of images takes, but for the colour. */
static void set_images(camber_renderer *renderer, const camber_shader *shader, const camber_fill *fill,
                       const camber_fill_place *at, const camber_piece *piece) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const double angle = fill->bearing_deg * (3.14159265358979323846 / 180.0);
    const float cosine = (float)cos(angle), sine = (float)sin(angle);
    const float *eye = piece->eye;
    camber_patterns_bind(renderer);
    gl->UseProgram(shader->program);
    gl->Uniform4f(shader->place, at->place[0], at->place[1], at->place[2], at->place[3]);
    gl->Uniform2f(shader->mean, at->mean[0] + 0.5f * at->mean[2], at->mean[1] + 0.5f * at->mean[3]);
    gl->Uniform2f(shader->origin, (float)piece->x, (float)piece->y);
    gl->Uniform2f(shader->first, fill->x_px, fill->y_px);
    gl->Uniform2f(shader->axis_x, cosine / at->size_px[0], -sine / at->size_px[0]);
    gl->Uniform2f(shader->axis_y, sine / at->size_px[1], cosine / at->size_px[1]);
    gl->Uniform4f(shader->eye, eye[0], eye[1], eye[2], eye[3]);
}

/* A colour is everywhere; images lie in the plane, and past the far plane there are none. */
static camber_status draw_fill(camber_renderer *renderer, const camber_pass *pass, const camber_piece *piece) {
    const camber_fill *fill = &pass->fill;
    const camber_shader *shader;
    const bool images = fill->pattern != 0;
    const float a = fill->color.a * (pass->opacity > 0.0f ? pass->opacity : 1.0f);
    const float color[4] = {images ? a : fill->color.r * a, images ? a : fill->color.g * a,
                            images ? a : fill->color.b * a, a};
    const camber_flatten_kind kind = images ? CAMBER_FLATTEN_IMAGES : CAMBER_FLATTEN_FILL;
    camber_fill_place at;
    if (!(a > 0.0f))
        return CAMBER_OK;
    camber_status status = camber_batch_draw(renderer, 0, piece); /* what waits lies below */
    if (status == CAMBER_OK && images)
        status = camber_patterns_hold(renderer, pass, piece);
    if (status == CAMBER_OK && images)
        status = camber_patterns_put_fill(renderer, pass, &at);
    if (status == CAMBER_OK)
        status = camber_renderer_flatten_shader(renderer, kind, &shader);
    if (status != CAMBER_OK)
        return status;
    if (images)
        set_images(renderer, shader, fill, &at, piece);
    return flatten(renderer, -1, kind, color, piece);
}

camber_status camber_renderer_draw_pass(camber_renderer *renderer, const camber_pass *pass, const camber_piece *piece) {
    const camber_mesh *mesh = pass->mesh;
    if (pass->kind == CAMBER_PASS_FILL)
        return draw_fill(renderer, pass, piece);
    if (mesh->empty)
        return CAMBER_OK;
    size_t end = pass->polyline_count ? pass->first_polyline + pass->polyline_count : mesh->polyline_count;
    end = end < mesh->polyline_count ? end : mesh->polyline_count;
    if (pass->opacity > 0.0f && pass->opacity < 1.0f && pass->first_polyline < end)
        return draw_group(renderer, pass, end, piece);
    return draw_runs(renderer, pass, end, piece);
}
