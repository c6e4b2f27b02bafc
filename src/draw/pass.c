/* Drawing one pass into one piece: directly where it is opaque or accumulates, else run by run through a layer that is
 * flattened onto the picture. */
#include "draw/renderer.h"

#include <math.h>
#include <string.h>

enum { ROW_TEXTURE_WIDTH = 2048, TEXELS_A_ROW = 2 };

/* Polylines of equal alpha that follow each other. */
typedef struct pass_run {
    size_t first, end; /* polylines */
    float alpha;       /* of the flattened layer; 1: straight onto the picture */
    bool one_color;    /* its layer holds coverage alone, and color is put over it */
    bool layered;
    camber_color color;
} pass_run;

float camber_renderer_thinnest(const camber_frame *frame) {
    float thinnest_px = INFINITY;
    for (size_t p = 0; p < frame->pass_count; p++)
        for (size_t i = 0; i < frame->passes[p].paint_count; i++) {
            const float width_px = frame->passes[p].paints[i].width_px;
            thinnest_px = width_px > 0.0f && width_px < thinnest_px ? width_px : thinnest_px;
        }
    return thinnest_px;
}

static bool is_drawn(const camber_pass *pass, uint32_t row) {
    return row < pass->paint_count && pass->paints[row].width_px > 0.0f && pass->paints[row].color.a > 0.0f;
}

/* The row texture of a run: rows of other alphas are left out, and a layer's rows are drawn opaque. Every row of the
 * mesh has its texels, since a run has polylines that are not drawn among those that are. */
static void fill_rows(camber_renderer *renderer, const camber_pass *pass, const pass_run *run) {
    for (size_t i = 0; i < pass->mesh->row_count; i++) {
        const camber_paint *paint = pass->paints + i;
        float *texel = renderer->row_texels + 4 * TEXELS_A_ROW * i;
        memset(texel, 0, 4 * TEXELS_A_ROW * sizeof *texel);
        texel[0] = -1.0f;
        if (!is_drawn(pass, (uint32_t)i) || (run->layered && paint->color.a != run->alpha))
            continue;
        const float alpha = run->layered ? 1.0f : paint->color.a;
        const float color[4] = {paint->color.r * alpha, paint->color.g * alpha, paint->color.b * alpha, alpha};
        texel[0] = 0.5f * paint->width_px;
        texel[1] = pass->mesh->host_rows[i].fan_step;
        for (int c = 0; c < 4; c++)
            texel[4 + c] = run->layered && run->one_color ? 1.0f : color[c];
    }
}

static camber_status reserve_rows(camber_renderer *renderer, size_t row_count) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const size_t texels = TEXELS_A_ROW * (row_count ? row_count : 1);
    const size_t height = (texels + ROW_TEXTURE_WIDTH - 1) / ROW_TEXTURE_WIDTH;
    if (height > renderer->share.surface->info.largest_target_px)
        return camber_fail(renderer->share.device->context, CAMBER_ERROR_LIMIT, "%zu rows of style; merge equal ones",
                           row_count);
    if (!camber_grow(renderer->share.device->context, &renderer->row_texels, &renderer->row_capacity,
                     height * ROW_TEXTURE_WIDTH, 4 * sizeof *renderer->row_texels))
        return CAMBER_ERROR_MEMORY;
    if (renderer->row_texture && renderer->row_height >= (GLsizei)height)
        return CAMBER_OK;
    gl->DeleteTextures(1, &renderer->row_texture);
    gl->GenTextures(1, &renderer->row_texture);
    gl->BindTexture(GL_TEXTURE_2D, renderer->row_texture);
    renderer->row_height = (GLsizei)height;
    gl->TexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32F, ROW_TEXTURE_WIDTH, renderer->row_height);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    const camber_status status = camber_renderer_check(renderer, "the table of rows");
    if (status != CAMBER_OK) {
        gl->DeleteTextures(1, &renderer->row_texture);
        renderer->row_texture = 0;
    }
    return status;
}

static void upload_rows(camber_renderer *renderer, size_t row_count) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const size_t texels = TEXELS_A_ROW * row_count;
    const GLsizei whole = (GLsizei)(texels / ROW_TEXTURE_WIDTH), rest = (GLsizei)(texels % ROW_TEXTURE_WIDTH);
    gl->BindTexture(GL_TEXTURE_2D, renderer->row_texture);
    if (whole)
        gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, ROW_TEXTURE_WIDTH, whole, GL_RGBA, GL_FLOAT, renderer->row_texels);
    if (rest)
        gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, whole, rest, 1, GL_RGBA, GL_FLOAT,
                          renderer->row_texels + 4 * (size_t)whole * ROW_TEXTURE_WIDTH);
}

camber_status camber_renderer_set_widths(camber_renderer *renderer, const camber_mesh *mesh, const camber_paint *paints,
                                         size_t paint_count) {
    const camber_status status = reserve_rows(renderer, mesh->row_count);
    if (status != CAMBER_OK)
        return status;
    memset(renderer->row_texels, 0, 4 * TEXELS_A_ROW * mesh->row_count * sizeof *renderer->row_texels);
    for (size_t i = 0; i < mesh->row_count; i++) {
        const float width_px = i < paint_count ? paints[i].width_px : 0.0f;
        renderer->row_texels[4 * TEXELS_A_ROW * i] = width_px > 0.0f ? 0.5f * width_px : -1.0f;
        renderer->row_texels[4 * TEXELS_A_ROW * i + 1] = mesh->host_rows[i].fan_step;
    }
    upload_rows(renderer, mesh->row_count);
    return CAMBER_OK;
}

camber_status camber_renderer_mesh_shader(camber_renderer *renderer, const camber_mesh *mesh, float thinnest_px,
                                          unsigned variant, const camber_shader **shader) {
    /* A pixel reaches sqrt(1/2) px along any normal; stroke.vert says where a tip ends: past where the cap does. */
    const bool thin = thinnest_px < 1.4143f, tips = thin || (mesh->round_caps && thinnest_px < 3.7f);
    variant |=
        (mesh->sharp_joins ? CAMBER_VARIANT_SHARP_JOINS : 0u) | (mesh->flat_caps ? CAMBER_VARIANT_FLAT_CAPS : 0u);
    variant |= (unsigned)mesh->mesh_info.method * CAMBER_VARIANT_METHOD;
    variant |= (thin ? CAMBER_VARIANT_THIN : 0u) | (tips ? CAMBER_VARIANT_TIPS : 0u);
    return camber_renderer_stroke_shader(renderer, variant, shader);
}

void camber_renderer_use_shader(camber_renderer *renderer, const camber_shader *shader, const camber_piece *piece) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const GLfloat x = (GLfloat)piece->x, y = (GLfloat)piece->y, w = (GLfloat)piece->width, h = (GLfloat)piece->height;
    const GLfloat guard_x = (GLfloat)camber_renderer_guard(renderer, 0, (GLsizei)piece->width),
                  guard_y = (GLfloat)camber_renderer_guard(renderer, 1, (GLsizei)piece->height);
    gl->UseProgram(shader->program);
    gl->Uniform2f(shader->origin, x, y);
    gl->Uniform2f(shader->corner, x - guard_x, y - guard_y);
    gl->Uniform2f(shader->scale, 2.0f / (w + 2.0f * guard_x), 2.0f / (h + 2.0f * guard_y));
}

void camber_renderer_bind_part(camber_renderer *renderer, const camber_mesh_part *part) {
    const camber_gl *gl = &renderer->share.surface->gl;
    gl->BindTexture(GL_TEXTURE_2D, renderer->row_texture);
    gl->ActiveTexture(GL_TEXTURE0 + CAMBER_RECORDS_UNIT);
    gl->BindTexture(GL_TEXTURE_BUFFER, renderer->record_texture);
    gl->TexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32UI, part->buffers[CAMBER_BUFFER_RECORDS].gl_name);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindVertexArray(renderer->vertex_array);
    gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, part->buffers[CAMBER_BUFFER_INDICES].gl_name);
}

void camber_renderer_draw_indices(camber_renderer *renderer, const camber_mesh *mesh, uint64_t first, uint64_t count) {
    const camber_gl *gl = &renderer->share.surface->gl;
    if (mesh->mesh_info.strips)
        gl->DrawArrays(GL_TRIANGLE_STRIP, (GLint)first, (GLsizei)count);
    else
        gl->DrawElements(GL_TRIANGLES, (GLsizei)count, GL_UNSIGNED_INT, (const void *)(uintptr_t)(4 * first));
}

/* Draws polylines [first, end) of a part, which is bound. */
static camber_status draw_part(camber_renderer *renderer, const camber_mesh *mesh, const camber_mesh_part *part,
                               size_t first, size_t end, size_t *draw_calls) {
    /* A count is a signed 32-bit number, and strips may be cut between polylines. */
    enum { INDICES_MAX = 1 << 30 };
    while (first < end) {
        size_t until = end;
        uint64_t from, to;
        camber_status status = camber_part_first_index(mesh, part, first, &from);
        if (status == CAMBER_OK)
            status = camber_part_first_index(mesh, part, until, &to);
        while (status == CAMBER_OK && to - from > INDICES_MAX && until - first > 1) {
            until = first + (until - first) / 2;
            status = camber_part_first_index(mesh, part, until, &to);
        }
        if (status != CAMBER_OK)
            return status;
        if (to > from) {
            camber_renderer_draw_indices(renderer, mesh, from, to - from);
            ++*draw_calls;
        }
        first = until;
    }
    return CAMBER_OK;
}

/* What the layer of a run holds; of one that has none, colours. */
static camber_flatten_kind kind_of(const camber_renderer *renderer, const pass_run *run) {
    if (!run->layered || !run->one_color)
        return CAMBER_FLATTEN_COLORS;
    return renderer->share.surface->half_float_targets ? CAMBER_FLATTEN_UNION : CAMBER_FLATTEN_COVERAGE;
}

/* How the fragments of a layer come together. Of the union's four, the last gathers one over the other and the first
 * three add up. One channel has no alpha of its own to blend by: a + b - ab is ONE, ONE_MINUS_SRC_COLOR. */
static void set_blending(const camber_gl *gl, camber_flatten_kind kind) {
    if (kind == CAMBER_FLATTEN_UNION)
        gl->BlendFuncSeparate(GL_ONE, GL_ONE, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    else
        gl->BlendFunc(GL_ONE, kind == CAMBER_FLATTEN_COVERAGE ? GL_ONE_MINUS_SRC_COLOR : GL_ONE_MINUS_SRC_ALPHA);
}

/* Draws the polylines of a run with the rows that are in the texture. */
static camber_status draw_run(camber_renderer *renderer, const camber_mesh *mesh, const pass_run *run,
                              const camber_piece *piece) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const camber_shader *shader;
    const unsigned variant = (piece->coverage == CAMBER_COVERAGE_LINEAR ? CAMBER_VARIANT_LINEAR : 0u) |
                             (kind_of(renderer, run) == CAMBER_FLATTEN_UNION ? CAMBER_VARIANT_UNION : 0u);
    camber_status status = camber_renderer_mesh_shader(renderer, mesh, piece->thinnest_px, variant, &shader);
    if (status != CAMBER_OK)
        return status;
    camber_renderer_use_shader(renderer, shader, piece);
    for (size_t i = 0; i < mesh->part_count && status == CAMBER_OK; i++) {
        const camber_mesh_part *part = mesh->parts + i;
        const size_t part_end = part->first_polyline + part->polyline_count;
        const size_t first = run->first > part->first_polyline ? run->first : part->first_polyline;
        const size_t end = run->end < part_end ? run->end : part_end;
        if (first >= end || part->index_count == 0)
            continue;
        camber_renderer_bind_part(renderer, part);
        status = draw_part(renderer, mesh, part, first, end, piece->draw_calls);
    }
    gl->BindVertexArray(0);
    return status;
}

static camber_status draw_layered(camber_renderer *renderer, const camber_pass *pass, const pass_run *run,
                                  const camber_piece *piece) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const GLsizei width = (GLsizei)piece->width, height = (GLsizei)piece->height;
    const int layer = run->one_color ? CAMBER_TARGET_COVERAGE : CAMBER_TARGET_LAYER;
    const camber_shader *shader;
    camber_status status = camber_renderer_bind_target(renderer, layer, width, height);
    if (status != CAMBER_OK)
        return status;
    gl->ClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    gl->Clear(GL_COLOR_BUFFER_BIT);
    set_blending(gl, kind_of(renderer, run));
    status = draw_run(renderer, pass->mesh, run, piece);
    if (status == CAMBER_OK)
        status = camber_renderer_flatten_shader(renderer, kind_of(renderer, run), &shader);
    if (status == CAMBER_OK)
        status = camber_renderer_bind_target(renderer, CAMBER_TARGET_PICTURE, width, height);
    if (status != CAMBER_OK)
        return status;
    const float a = run->alpha;
    gl->BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    gl->UseProgram(shader->program);
    if (run->one_color)
        gl->Uniform4f(shader->layer_color, run->color.r * a, run->color.g * a, run->color.b * a, a);
    else
        gl->Uniform4f(shader->layer_color, a, a, a, a);
    gl->BindTexture(GL_TEXTURE_2D, renderer->targets[layer].texture);
    gl->BindVertexArray(renderer->vertex_array);
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
    gl->BindVertexArray(0);
    ++*piece->draw_calls;
    return CAMBER_OK;
}

static bool same_color(camber_color a, camber_color b) {
    return a.r == b.r && a.g == b.g && a.b == b.b;
}

/* The longest run from a polyline on. Rows that are not drawn belong to any run. */
static pass_run next_run(const camber_pass *pass, size_t first, size_t end) {
    const uint32_t *rows = pass->mesh->polyline_rows;
    const bool layered = pass->overlap != CAMBER_OVERLAP_ACCUMULATE;
    pass_run run = {.first = first, .end = first, .alpha = 1.0f, .one_color = true};
    bool met = false;
    for (; run.end < end; run.end++) {
        if (!is_drawn(pass, rows[run.end]))
            continue;
        const camber_color color = pass->paints[rows[run.end]].color;
        if (met && layered && color.a != run.alpha)
            break;
        if (!met) {
            run.alpha = layered ? color.a : 1.0f;
            run.color = color;
        }
        run.one_color = run.one_color && same_color(color, run.color);
        met = true;
    }
    if (!met)
        run.alpha = 0.0f; /* nothing to draw */
    run.layered = run.alpha < 1.0f || (pass->overlap == CAMBER_OVERLAP_UNITE && run.one_color);
    return run;
}

camber_status camber_renderer_draw_pass(camber_renderer *renderer, const camber_pass *pass, const camber_piece *piece) {
    const camber_gl *gl = &renderer->share.surface->gl;
    camber_mesh *mesh = pass->mesh;
    if (mesh->empty)
        return CAMBER_OK;
    size_t end = pass->polyline_count ? pass->first_polyline + pass->polyline_count : mesh->polyline_count;
    end = end < mesh->polyline_count ? end : mesh->polyline_count;
    camber_status status = reserve_rows(renderer, mesh->row_count);
    for (size_t first = pass->first_polyline; first < end && status == CAMBER_OK;) {
        const pass_run run = next_run(pass, first, end);
        first = run.end;
        if (run.alpha <= 0.0f)
            continue;
        fill_rows(renderer, pass, &run);
        upload_rows(renderer, mesh->row_count);
        if (run.layered) {
            status = draw_layered(renderer, pass, &run, piece);
        } else {
            gl->BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
            status = draw_run(renderer, mesh, &run, piece);
        }
    }
    return status;
}
