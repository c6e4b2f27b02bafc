/* The row texture: one table for each queued command, in which every row of its mesh has CAMBER_ROW_TEXELS texels, and
 * then the side table. stroke.vert says what is in each texel. */
#include "draw/renderer.h"

#include <string.h>

enum { WIDTH = CAMBER_ROW_TEXTURE_WIDTH_PX, ROW_TEXELS = CAMBER_ROW_TEXELS, ROW_FLOATS = 4 * ROW_TEXELS };

bool camber_rows_fit(const camber_renderer *renderer, size_t row_count, size_t side_texels) {
    const size_t texels = (size_t)WIDTH * renderer->share.surface->info.largest_target_px;
    return side_texels <= texels && row_count <= (texels - side_texels) / ROW_TEXELS;
}

static void put_dashes(const camber_side_dashes *dashes, float texel[4]) {
    texel[0] = (float)dashes->first;
    texel[1] = (float)(2 * dashes->count + dashes->are_round);
    texel[2] = dashes->period_px;
}

static void put_color(const camber_draw_command *command, camber_color color, float alpha, float texel[4]) {
    const bool is_coverage =
        command->composite == CAMBER_COMPOSITE_COVERAGE || command->composite == CAMBER_COMPOSITE_UNION;
    texel[0] = is_coverage ? 1.0f : color.r * alpha;
    texel[1] = is_coverage ? 1.0f : color.g * alpha;
    texel[2] = is_coverage ? 1.0f : color.b * alpha;
    texel[3] = is_coverage ? 1.0f : alpha;
}

static camber_status put_row(camber_renderer *renderer, const camber_draw_command *command, size_t row, float *texels) {
    const camber_row_paint *paint = renderer->list.rows + command->first_row + row;
    const float alpha = camber_draw_command_alpha(command, paint);
    memset(texels, 0, ROW_FLOATS * sizeof *texels);
    texels[0] = -1.0f;
    if (alpha < 0.0f)
        return CAMBER_OK;
    texels[0] = paint->half_width_px;
    texels[1] = command->mesh->host_rows[row].fan_step;
    texels[2] = paint->translate_px[0];
    texels[3] = paint->translate_px[1];
    put_color(command, paint->color, alpha, texels + 4);
    texels[8] = paint->half_gap_px;
    texels[9] = paint->blur_px;
    if (paint->features & CAMBER_FEATURE_DASH)
        put_dashes(&paint->dashes, texels + 12);
    texels[16] = paint->trim[0];
    texels[17] = paint->trim[1];
    texels[18] = (float)paint->first_stop;
    texels[19] = (float)paint->stop_count;
    if (!(paint->features & CAMBER_FEATURE_IMAGE))
        return CAMBER_OK;
    const camber_image_use *use = renderer->list.image_uses + paint->image_use;
    texels[24] = (float)use->width_px;
    return camber_atlas_find(renderer, use, texels + 20);
}

camber_status camber_rows_write(camber_renderer *renderer, const camber_draw_command *command, size_t table) {
    const size_t count = command->mesh->row_count;
    float *texels = renderer->gl.rows.texels + ROW_FLOATS * table * count;
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < count && status == CAMBER_OK; i++)
        status = put_row(renderer, command, i, texels + ROW_FLOATS * i);
    return status;
}

camber_status camber_rows_reserve(camber_renderer *renderer, size_t row_count, size_t side_texels) {
    const camber_gl *gl = &renderer->share.surface->gl;
    camber_context *context = renderer->share.device->context;
    camber_row_texture *rows = &renderer->gl.rows;
    const size_t texels = ROW_TEXELS * (row_count ? row_count : 1) + side_texels;
    const size_t height = (texels + WIDTH - 1) / WIDTH;
    if (height > renderer->share.surface->info.largest_target_px)
        return camber_fail(context, CAMBER_ERROR_LIMIT, "%zu rows of style; merge equal ones", row_count);
    if (!camber_grow(context, &rows->texels, &rows->capacity, height * WIDTH, 4 * sizeof *rows->texels))
        return CAMBER_ERROR_MEMORY;
    if (rows->texture && rows->height >= (GLsizei)height)
        return CAMBER_OK;
    gl->DeleteTextures(1, &rows->texture);
    gl->GenTextures(1, &rows->texture);
    gl->BindTexture(GL_TEXTURE_2D, rows->texture);
    rows->height = (GLsizei)height;
    gl->TexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32F, WIDTH, rows->height);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    const camber_status status = camber_gl_check(renderer, "the table of rows");
    if (status != CAMBER_OK) {
        gl->DeleteTextures(1, &rows->texture);
        rows->texture = 0;
    }
    return status;
}

camber_status camber_rows_upload(camber_renderer *renderer, size_t row_count, size_t side_texels) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const size_t texels = ROW_TEXELS * row_count + side_texels;
    const camber_status status = camber_rows_reserve(renderer, row_count, side_texels);
    if (status != CAMBER_OK)
        return status;
    float *from = renderer->gl.rows.texels;
    if (side_texels)
        memcpy(from + ROW_FLOATS * row_count, renderer->list.side_table.texels, 4 * side_texels * sizeof *from);
    const GLsizei whole = (GLsizei)(texels / WIDTH), rest = (GLsizei)(texels % WIDTH);
    gl->BindTexture(GL_TEXTURE_2D, renderer->gl.rows.texture);
    if (whole)
        gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, WIDTH, whole, GL_RGBA, GL_FLOAT, from);
    if (rest)
        gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, whole, rest, 1, GL_RGBA, GL_FLOAT, from + 4 * (size_t)whole * WIDTH);
    return CAMBER_OK;
}

camber_status camber_rows_upload_widths(camber_renderer *renderer, const camber_mesh *mesh, const camber_paint *paints,
                                        size_t paint_count) {
    const camber_status status = camber_rows_reserve(renderer, mesh->row_count, 0);
    if (status != CAMBER_OK)
        return status;
    float *texels = renderer->gl.rows.texels;
    memset(texels, 0, ROW_FLOATS * mesh->row_count * sizeof *texels);
    for (size_t i = 0; i < mesh->row_count; i++) {
        const bool drawn = i < paint_count && paints[i].width_px > 0.0f;
        texels[ROW_FLOATS * i] = drawn ? camber_paint_half_width(paints + i) : -1.0f;
        texels[ROW_FLOATS * i + 1] = mesh->host_rows[i].fan_step;
    }
    return camber_rows_upload(renderer, mesh->row_count, 0);
}
