/* Draws the commands of a list into one area. Straight commands draw directly onto the target, and are queued in a
 * batch as long as possible. The lines of other commands are drawn into a layer, which a shader flattens onto the
 * target. The commands of a group are drawn into a separate target, which is then composited onto the area's target as
 * a whole. */
#include "draw/renderer.h"

#include <math.h>

/* ---- Layers ---- */

/* Returns the kind of layer that a command needs. Without half-float targets there is no union. */
static camber_flatten_kind kind_of(const camber_renderer *renderer, const camber_draw_command *command) {
    switch (command->composite) {
    case CAMBER_COMPOSITE_COVERAGE: return CAMBER_FLATTEN_COVERAGE;
    case CAMBER_COMPOSITE_UNION:
        return renderer->share.surface->half_float_targets ? CAMBER_FLATTEN_UNION : CAMBER_FLATTEN_COVERAGE;
    case CAMBER_COMPOSITE_MASKED: return CAMBER_FLATTEN_MASKED;
    case CAMBER_COMPOSITE_STRAIGHT:
    case CAMBER_COMPOSITE_AREA:
    case CAMBER_COMPOSITE_COLORS: break;
    }
    return CAMBER_FLATTEN_COLORS;
}

/* Sets how the fragments of a layer are blended. In the union's four channels, the first three add up, and the last
 * accumulates coverage, one fragment over another. A single channel has no alpha to blend by: a + b - ab is ONE,
 * ONE_MINUS_SRC_COLOR. */
static void set_blending(const camber_gl *gl, camber_flatten_kind kind) {
    if (kind == CAMBER_FLATTEN_UNION)
        gl->BlendFuncSeparate(GL_ONE, GL_ONE, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    else
        gl->BlendFunc(GL_ONE, kind == CAMBER_FLATTEN_COVERAGE ? GL_ONE_MINUS_SRC_COLOR : GL_ONE_MINUS_SRC_ALPHA);
}

/* Composites a layer onto the area's target. layer: a target; below 0: a fill. color is premultiplied; for a layer with
 * its own colours it is the opacity in all four channels. */
static camber_status flatten(camber_renderer *renderer, int layer, camber_flatten_kind kind, const float color[4],
                             const camber_gl_area *area) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const camber_shader *shader;
    camber_status status = camber_shaders_flatten(&renderer->gl.shaders, kind, &shader);
    if (status == CAMBER_OK)
        status = camber_target_bind(renderer, area->target, (GLsizei)area->width, (GLsizei)area->height);
    if (status != CAMBER_OK)
        return status;
    gl->BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    gl->UseProgram(shader->program);
    gl->Uniform4f(shader->layer_color, color[0], color[1], color[2], color[3]);
    if (kind == CAMBER_FLATTEN_MASKED) {
        gl->ActiveTexture(GL_TEXTURE0 + CAMBER_ALPHAS_UNIT);
        gl->BindTexture(GL_TEXTURE_2D, renderer->gl.targets[layer].alphas);
        gl->ActiveTexture(GL_TEXTURE0);
    }
    gl->BindTexture(GL_TEXTURE_2D, layer >= 0 ? renderer->gl.targets[layer].texture : 0);
    gl->BindVertexArray(renderer->gl.vertex_array);
    if (kind == CAMBER_FLATTEN_IMAGES)
        camber_gl_hide_horizon(renderer, area);
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
    if (kind == CAMBER_FLATTEN_IMAGES)
        gl->Scissor(0, 0, (GLsizei)area->width, (GLsizei)area->height);
    gl->BindVertexArray(0);
    ++*area->draw_calls;
    return CAMBER_OK;
}

static camber_status begin_layer(camber_renderer *renderer, int layer, const camber_gl_area *area) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const camber_status status = camber_target_bind(renderer, layer, (GLsizei)area->width, (GLsizei)area->height);
    if (status != CAMBER_OK)
        return status;
    gl->ClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    gl->Clear(GL_COLOR_BUFFER_BIT);
    return CAMBER_OK;
}

static camber_status draw_layered(camber_renderer *renderer, const camber_draw_command *command,
                                  const camber_gl_area *area) {
    const camber_gl *gl = &renderer->share.surface->gl;
    static const unsigned variants[CAMBER_FLATTEN_KINDS] = {
        [CAMBER_FLATTEN_UNION] = CAMBER_VARIANT_UNION, [CAMBER_FLATTEN_MASKED] = CAMBER_VARIANT_MASK};
    static const int layers[CAMBER_FLATTEN_KINDS] = {CAMBER_TARGET_LAYER, CAMBER_TARGET_COVERAGE,
                                                     CAMBER_TARGET_COVERAGE, CAMBER_TARGET_MASKED};
    const camber_flatten_kind kind = kind_of(renderer, command);
    const int layer = layers[kind];
    camber_status status = begin_layer(renderer, layer, area);
    if (status == CAMBER_OK)
        status = camber_batch_add(renderer, command, area);
    if (status != CAMBER_OK)
        return status;
    set_blending(gl, kind);
    status = camber_batch_draw(renderer, variants[kind], area);
    if (status != CAMBER_OK)
        return status;
    const bool has_colors = kind == CAMBER_FLATTEN_COLORS || kind == CAMBER_FLATTEN_MASKED;
    const float a = command->layer_opacity;
    const camber_color c = has_colors ? (camber_color){1, 1, 1, 1} : command->color;
    const float color[4] = {c.r * a, c.g * a, c.b * a, a};
    return flatten(renderer, layer, kind, color, area);
}

/* ---- Fills ---- */

/* Sets the uniforms for copies of an image side by side. */
static camber_status set_images(camber_renderer *renderer, const camber_shader *shader, const camber_fill_paint *fill,
                                const camber_gl_area *area) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const camber_image_use *use = renderer->list.image_uses + fill->image_use;
    const camber_image_use *mean_use = renderer->list.image_uses + fill->mean_use;
    const double angle = fill->bearing_deg * (3.14159265358979323846 / 180.0);
    const float cosine = (float)cos(angle), sine = (float)sin(angle), *eye = area->view.eye;
    const float width_px = (float)use->width_px, height_px = (float)use->height_px;
    float rect[4], mean[4];
    camber_status status = camber_atlas_find(renderer, use, rect);
    if (status == CAMBER_OK)
        status = camber_atlas_find(renderer, mean_use, mean);
    if (status != CAMBER_OK)
        return status;
    camber_atlas_bind(renderer);
    gl->UseProgram(shader->program);
    gl->Uniform4f(shader->image_rect, rect[0], rect[1], rect[2], rect[3]);
    gl->Uniform2f(shader->mean, mean[0] + 0.5f * mean[2], mean[1] + 0.5f * mean[3]);
    gl->Uniform2f(shader->origin, (float)area->x, (float)area->y);
    gl->Uniform2f(shader->first, fill->x_px, fill->y_px);
    gl->Uniform2f(shader->axis_x, cosine / width_px, -sine / width_px);
    gl->Uniform2f(shader->axis_y, sine / height_px, cosine / height_px);
    gl->Uniform4f(shader->eye, eye[0], eye[1], eye[2], eye[3]);
    return CAMBER_OK;
}

/* Draws a fill. A colour covers the whole picture. Images are in the plane of the map, so none are drawn beyond the far
 * plane. */
static camber_status draw_fill(camber_renderer *renderer, const camber_draw_command *command,
                               const camber_gl_area *area) {
    const camber_fill_paint *fill = &command->fill;
    const camber_color c = fill->color;
    const float color[4] = {c.r * c.a, c.g * c.a, c.b * c.a, c.a};
    const camber_flatten_kind kind = fill->has_image ? CAMBER_FLATTEN_IMAGES : CAMBER_FLATTEN_FILL;
    const camber_shader *shader;
    camber_status status = CAMBER_OK;
    if (fill->has_image)
        status = camber_batch_hold_images(renderer, command, area);
    if (status == CAMBER_OK)
        status = camber_shaders_flatten(&renderer->gl.shaders, kind, &shader);
    if (status == CAMBER_OK && fill->has_image)
        status = set_images(renderer, shader, fill, area);
    return status == CAMBER_OK ? flatten(renderer, -1, kind, color, area) : status;
}

/* ---- Areas ---- */

/* Draws consecutive commands of polygons. */
static camber_status draw_areas(camber_renderer *renderer, const camber_draw_command *first,
                                const camber_draw_command *end, const camber_gl_area *area) {
    const float whole[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    camber_status status = camber_batch_draw(renderer, 0, area); /* what is queued is below */
    if (status == CAMBER_OK)
        status = camber_target_bind(renderer, CAMBER_TARGET_LAYER, (GLsizei)area->width, (GLsizei)area->height);
    if (status == CAMBER_OK)
        status = camber_gl_fill_layer(renderer, first, end, area);
    return status == CAMBER_OK ? flatten(renderer, CAMBER_TARGET_LAYER, CAMBER_FLATTEN_COLORS, whole, area) : status;
}

/* ---- Commands ---- */

static camber_status draw_command(camber_renderer *renderer, const camber_draw_command *command,
                                  const camber_gl_area *area) {
    if (command->mesh && command->composite == CAMBER_COMPOSITE_STRAIGHT)
        return camber_batch_add(renderer, command, area);
    const camber_status status = camber_batch_draw(renderer, 0, area); /* what is queued is below */
    if (status != CAMBER_OK)
        return status;
    return command->mesh ? draw_layered(renderer, command, area) : draw_fill(renderer, command, area);
}

/* Draws commands that have the same target. */
static camber_status draw_commands(camber_renderer *renderer, const camber_draw_command *first,
                                   const camber_draw_command *end, const camber_gl_area *area) {
    camber_status status = CAMBER_OK;
    for (const camber_draw_command *next; first < end && status == CAMBER_OK; first = next) {
        for (next = first; next < end && next->composite == CAMBER_COMPOSITE_AREA; next++)
            continue;
        if (next > first)
            status = draw_areas(renderer, first, next, area);
        else
            status = draw_command(renderer, next++, area);
    }
    return status;
}

static camber_status draw_group(camber_renderer *renderer, const camber_draw_command *first,
                                const camber_draw_command *end, const camber_gl_area *area) {
    camber_gl_area group = *area;
    group.target = CAMBER_TARGET_GROUP;
    camber_status status = camber_batch_draw(renderer, 0, area);
    if (status == CAMBER_OK)
        status = begin_layer(renderer, group.target, &group);
    if (status == CAMBER_OK)
        status = draw_commands(renderer, first, end, &group);
    if (status == CAMBER_OK)
        status = camber_batch_draw(renderer, 0, &group);
    const float a = first->group_opacity, color[4] = {a, a, a, a};
    return status == CAMBER_OK ? flatten(renderer, group.target, CAMBER_FLATTEN_COLORS, color, area) : status;
}

camber_status camber_gl_draw_commands(camber_renderer *renderer, const camber_gl_area *area) {
    const camber_draw_command *at = renderer->list.commands, *end = at + renderer->list.command_count, *next;
    camber_status status = CAMBER_OK;
    for (; at < end && status == CAMBER_OK; at = next) {
        for (next = at + 1; next < end && next->group == at->group; next++)
            continue;
        status = at->group ? draw_group(renderer, at, next, area) : draw_commands(renderer, at, next, area);
    }
    return status == CAMBER_OK ? camber_batch_draw(renderer, 0, area) : status;
}
