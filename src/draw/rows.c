/* The row texture: tables of widths, places and colours, one a pass that is drawn, of which every row of the mesh has
 * its texels, and behind them the tail. */
#include "draw/renderer.h"

#include <math.h>
#include <string.h>

enum { ROW_TEXTURE_WIDTH = 2048, TEXELS_A_ROW = CAMBER_TEXELS_A_ROW }; /* the width as the shaders have it */

/* Progress that no line has. */
static const float FAR_BEYOND = 1e9f;

bool camber_renderer_holds_rows(const camber_renderer *renderer, size_t row_count, size_t tail_texels) {
    const size_t texels = (size_t)ROW_TEXTURE_WIDTH * renderer->share.surface->info.largest_target_px;
    return tail_texels <= texels && row_count <= (texels - tail_texels) / TEXELS_A_ROW;
}

void camber_rows_put_trim(const camber_paint *paint, float texel[2]) {
    const bool trims = paint->trim_end > paint->trim_start;
    texel[0] = !trims ? FAR_BEYOND : paint->trim_start <= 0.0f ? -FAR_BEYOND : paint->trim_start;
    texel[1] = !trims || paint->trim_end >= 1.0f ? FAR_BEYOND : paint->trim_end;
}

camber_status camber_renderer_fill_rows(camber_renderer *renderer, const camber_run *run, size_t table) {
    const camber_pass *pass = run->pass;
    float *texels = renderer->row_texels + 4 * TEXELS_A_ROW * table * pass->mesh->row_count;
    for (size_t i = 0; i < pass->mesh->row_count; i++) {
        const camber_paint *paint = pass->paints + i;
        float *texel = texels + 4 * TEXELS_A_ROW * i;
        memset(texel, 0, 4 * TEXELS_A_ROW * sizeof *texel);
        texel[0] = -1.0f;
        if (!camber_pass_draws(pass, (uint32_t)i) || (run->one_alpha && paint->color.a != run->alpha))
            continue;
        const float alpha = run->layered && run->one_alpha ? 1.0f : paint->color.a;
        const bool image = paint->pattern != 0;
        const float color[4] = {image ? alpha : paint->color.r * alpha, image ? alpha : paint->color.g * alpha,
                                image ? alpha : paint->color.b * alpha, alpha};
        texel[0] = camber_paint_half_width(paint);
        texel[1] = pass->mesh->host_rows[i].fan_step;
        texel[2] = paint->translate_x_px;
        texel[3] = paint->translate_y_px;
        texel[8] = paint->gap_px > 0.0f ? 0.5f * paint->gap_px : -1.0f;
        texel[9] = fmaxf(paint->blur_px, 0.0f);
        for (int c = 0; c < 4; c++)
            texel[4 + c] = run->layered && run->one_color ? 1.0f : color[c];
        camber_rows_put_trim(paint, texel + 16);
        if (paint->dash && camber_tail_put_dash(renderer, pass, (uint32_t)i, texel + 12) != CAMBER_OK)
            return CAMBER_ERROR_MEMORY;
        if (paint->ramp && camber_tail_put_ramp(renderer, pass->ramps + paint->ramp - 1, texel + 18) != CAMBER_OK)
            return CAMBER_ERROR_MEMORY;
        const camber_status status = image ? camber_patterns_put(renderer, pass, paint, texel + 20) : CAMBER_OK;
        if (status != CAMBER_OK)
            return status;
    }
    return CAMBER_OK;
}

camber_status camber_renderer_reserve_rows(camber_renderer *renderer, size_t row_count) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const size_t texels = TEXELS_A_ROW * (row_count ? row_count : 1) + renderer->tail_count;
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

camber_status camber_renderer_upload_rows(camber_renderer *renderer, size_t row_count) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const size_t texels = TEXELS_A_ROW * row_count + renderer->tail_count;
    const camber_status status = camber_renderer_reserve_rows(renderer, row_count);
    if (status != CAMBER_OK)
        return status;
    if (renderer->tail_count)
        memcpy(renderer->row_texels + 4 * TEXELS_A_ROW * row_count, renderer->tail_texels,
               4 * renderer->tail_count * sizeof *renderer->tail_texels);
    const GLsizei whole = (GLsizei)(texels / ROW_TEXTURE_WIDTH), rest = (GLsizei)(texels % ROW_TEXTURE_WIDTH);
    gl->BindTexture(GL_TEXTURE_2D, renderer->row_texture);
    if (whole)
        gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, ROW_TEXTURE_WIDTH, whole, GL_RGBA, GL_FLOAT, renderer->row_texels);
    if (rest)
        gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, whole, rest, 1, GL_RGBA, GL_FLOAT,
                          renderer->row_texels + 4 * (size_t)whole * ROW_TEXTURE_WIDTH);
    return CAMBER_OK;
}

camber_status camber_renderer_set_widths(camber_renderer *renderer, const camber_mesh *mesh, const camber_paint *paints,
                                         size_t paint_count) {
    const camber_status status = camber_renderer_reserve_rows(renderer, mesh->row_count);
    if (status != CAMBER_OK)
        return status;
    memset(renderer->row_texels, 0, 4 * TEXELS_A_ROW * mesh->row_count * sizeof *renderer->row_texels);
    for (size_t i = 0; i < mesh->row_count; i++) {
        const bool drawn = i < paint_count && paints[i].width_px > 0.0f;
        renderer->row_texels[4 * TEXELS_A_ROW * i] = drawn ? camber_paint_half_width(paints + i) : -1.0f;
        renderer->row_texels[4 * TEXELS_A_ROW * i + 1] = mesh->host_rows[i].fan_step;
    }
    return camber_renderer_upload_rows(renderer, mesh->row_count);
}
