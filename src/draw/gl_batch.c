/* Draws polylines in as few draw calls as the driver allows.
 *
 * Commands of one mesh are queued together as long as nothing has to be drawn between them. Each has a table in the row
 * texture, and a vertex must know its table. For strips, the number of the vertex has the table in the bits above those
 * that the mesh needs. Kite and fan have their indices in the mesh, so a uniform has the table, and each command takes
 * a draw call. */
#include "draw/renderer.h"
#include "vertices/vertices.h"

#include "kernels/stroke_ends.h"

/* A feature bit times CAMBER_VARIANT_FEATURES is the variant of the same name. */
_Static_assert((int)CAMBER_VARIANT_GAP == (int)CAMBER_FEATURE_GAP * CAMBER_VARIANT_FEATURES &&
                   (int)CAMBER_VARIANT_PATTERN == (int)CAMBER_FEATURE_IMAGE * CAMBER_VARIANT_FEATURES &&
                   (int)CAMBER_VARIANT_MASK == 2 * (int)CAMBER_VARIANT_PATTERN,
               "features and variants are the same bits, and variants that are no features lie behind them");

/* The most rows of all tables of a draw call. The memory for more rows would not be worth the draw call that they save.
 */
enum { ROWS_MAX = 1 << 20 };

/* In a pitched view a segment is two triangles. */
enum { RECORD_VERTICES = 6 };

camber_status camber_gl_stroke_shader(camber_renderer *renderer, const camber_mesh *mesh, float thinnest_px,
                                      unsigned variant, const camber_shader **shader) {
    if (variant & CAMBER_VARIANT_PITCHED)
        thinnest_px = 0.0f; /* far away all lines are thin */
    /* A pixel reaches sqrt(1/2) px along any normal; stroke.vert says where a tip ends, which is beyond the end of the
     * cap. */
    const bool thin = thinnest_px < CAMBER_DIAGONAL,
               tips = thin || (mesh->round_caps && thinnest_px < 2.0f * CAMBER_TIPS_PX);
    const bool joins = mesh->mesh_info.method != CAMBER_METHOD_FAN || variant & CAMBER_VARIANT_PITCHED;
    const bool flat = mesh->flat_caps || (mesh->wide && joins);
    variant |= (mesh->sharp_joins ? CAMBER_VARIANT_SHARP_JOINS : 0u) | (flat ? CAMBER_VARIANT_FLAT_ENDS : 0u);
    variant |= (unsigned)mesh->mesh_info.method * CAMBER_VARIANT_METHOD;
    variant |= (thin ? CAMBER_VARIANT_THIN : 0u) | (tips ? CAMBER_VARIANT_TIPS : 0u);
    return camber_shaders_stroke(&renderer->gl.shaders, variant, shader);
}

void camber_gl_use_shader(camber_renderer *renderer, const camber_shader *shader, const camber_mesh *mesh,
                          const camber_gl_area *area) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const GLfloat x = (GLfloat)area->x, y = (GLfloat)area->y, w = (GLfloat)area->width, h = (GLfloat)area->height;
    const GLfloat guard_x = (GLfloat)camber_target_guard(renderer, 0, (GLsizei)area->width),
                  guard_y = (GLfloat)camber_target_guard(renderer, 1, (GLsizei)area->height);
    /* Triangles of a strip that wind the other way are between the two records of a tight join. */
    (mesh->mesh_info.strips && !area->view.pitched ? gl->Enable : gl->Disable)(GL_CULL_FACE);
    gl->UseProgram(shader->program);
    gl->Uniform2f(shader->origin, x, y);
    gl->Uniform2f(shader->corner, x - guard_x, y - guard_y);
    gl->Uniform2f(shader->scale, 2.0f / (w + 2.0f * guard_x), 2.0f / (h + 2.0f * guard_y));
    gl->Uniform1i(shader->table, mesh->mesh_info.strips ? 31 : 0);
    if (area->view.pitched)
        gl->Uniform4f(shader->eye, area->view.eye[0], area->view.eye[1], area->view.eye[2], area->view.eye[3]);
    gl->Uniform1i(shader->stride, mesh->mesh_info.has_arc_length ? 2 : 1);
}

void camber_gl_bind_part(camber_renderer *renderer, camber_mesh_part *part) {
    const camber_gl *gl = &renderer->share.surface->gl;
    for (size_t i = 0; i < sizeof part->buffers / sizeof *part->buffers; i++)
        part->buffers[i].drawn_frame = renderer->share.frames_begun;
    gl->BindTexture(GL_TEXTURE_2D, renderer->gl.rows.texture);
    gl->ActiveTexture(GL_TEXTURE0 + CAMBER_RECORDS_UNIT);
    gl->BindTexture(GL_TEXTURE_BUFFER, renderer->gl.record_texture);
    gl->TexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32UI, part->buffers[CAMBER_BUFFER_RECORDS].gl_name);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindVertexArray(renderer->gl.vertex_array);
    gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, part->buffers[CAMBER_BUFFER_INDICES].gl_name);
}

void camber_gl_draw_indices(camber_renderer *renderer, const camber_mesh *mesh, uint64_t first, uint64_t count) {
    const camber_gl *gl = &renderer->share.surface->gl;
    if (mesh->mesh_info.strips)
        gl->DrawArrays(GL_TRIANGLE_STRIP, (GLint)first, (GLsizei)count);
    else
        gl->DrawElements(GL_TRIANGLES, (GLsizei)count, GL_UNSIGNED_INT, (const void *)(uintptr_t)(4 * first));
}

/* Returns the number of vertices drawn for a part: the vertices of its strips or, in a pitched view, six per record.
 * The method makes no difference. */
static size_t vertex_count(const camber_mesh *mesh, const camber_mesh_part *part, bool pitched) {
    const size_t records = mesh->mesh_info.strips ? part->index_count / 2 : part->slot_count;
    return pitched ? RECORD_VERTICES * records : part->index_count;
}

/* Returns how many bits the number of a vertex within its part takes. If it returns 31, no bit is left for tables. */
static unsigned vertex_bits(const camber_mesh *mesh, bool pitched) {
    size_t most = 0;
    for (size_t i = 0; i < mesh->part_count; i++) {
        const size_t count = vertex_count(mesh, mesh->parts + i, pitched);
        most = count > most ? count : most;
    }
    unsigned bits = 1;
    while (bits < 31 && most >> bits)
        bits++;
    return bits;
}

static bool has_numbered_tables(const camber_mesh *mesh, const camber_gl_area *area) {
    return mesh->mesh_info.strips || area->view.pitched;
}

/* Returns how many texels of the side table a command with the given features needs: all or none. */
static size_t side_texels(const camber_renderer *renderer, unsigned features) {
    return features & (CAMBER_FEATURE_DASH | CAMBER_FEATURE_RAMP) ? renderer->list.side_table.count : 0;
}

/* Whether another command can be queued with the commands that are already queued. */
static bool has_room(const camber_renderer *renderer, const camber_draw_command *command, const camber_gl_area *area) {
    const camber_batch *batch = &renderer->gl.batch;
    const camber_mesh *mesh = command->mesh;
    const size_t tables = batch->table_count + 1;
    const unsigned bits = has_numbered_tables(mesh, area) ? vertex_bits(mesh, area->view.pitched) : 0;
    return batch->mesh == mesh && batch->upright == command->upright && tables * mesh->row_count <= ROWS_MAX &&
           camber_rows_fit(renderer, tables * mesh->row_count,
                           side_texels(renderer, batch->features | command->features)) &&
           tables <= (size_t)1 << (31 - bits);
}

camber_status camber_batch_hold_images(camber_renderer *renderer, const camber_draw_command *command,
                                       const camber_gl_area *area) {
    bool is_full;
    camber_status status = camber_atlas_hold(renderer, command, &is_full);
    if (status != CAMBER_OK || !is_full)
        return status;
    status = camber_batch_draw(renderer, 0, area); /* what is queued needs images that may be evicted now */
    return status == CAMBER_OK ? camber_atlas_renew(renderer, command) : status;
}

camber_status camber_batch_add(camber_renderer *renderer, const camber_draw_command *command,
                               const camber_gl_area *area) {
    camber_batch *batch = &renderer->gl.batch;
    camber_context *context = renderer->share.device->context;
    camber_status status = CAMBER_OK;
    if (command->features & CAMBER_FEATURE_IMAGE)
        status = camber_batch_hold_images(renderer, command, area);
    if (status == CAMBER_OK && batch->table_count && !has_room(renderer, command, area))
        status = camber_batch_draw(renderer, 0, area);
    if (status == CAMBER_OK)
        status = camber_rows_reserve(renderer, (batch->table_count + 1) * command->mesh->row_count,
                                     side_texels(renderer, batch->features | command->features));
    if (status == CAMBER_OK &&
        !camber_grow(context, &batch->ranges, &batch->range_capacity, batch->range_count + 1, sizeof *batch->ranges))
        status = CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK)
        status = camber_rows_write(renderer, command, batch->table_count);
    if (status != CAMBER_OK)
        return status;
    batch->mesh = command->mesh;
    batch->upright = command->upright;
    batch->features |= command->features;
    batch->ranges[batch->range_count++] = (camber_batch_range){command->first, command->end, batch->table_count++};
    return CAMBER_OK;
}

void camber_batch_clear(camber_renderer *renderer) {
    camber_batch *batch = &renderer->gl.batch;
    batch->table_count = batch->range_count = batch->call_count = 0;
    batch->features = 0;
}

/* ---- Draw calls ---- */

/* Draws the listed strips; in a pitched view they are triangles. */
static void draw_strips(camber_renderer *renderer, const camber_gl_area *area) {
    const camber_gl *gl = &renderer->share.surface->gl;
    camber_batch *batch = &renderer->gl.batch;
    size_t *draw_calls = area->draw_calls;
    const GLenum mode = area->view.pitched ? GL_TRIANGLES : GL_TRIANGLE_STRIP;
    if (gl->MultiDrawArrays && batch->call_count > 1) {
        gl->MultiDrawArrays(mode, batch->firsts, batch->counts, (GLsizei)batch->call_count);
        ++*draw_calls;
    } else {
        for (size_t i = 0; i < batch->call_count; i++)
            gl->DrawArrays(mode, batch->firsts[i], batch->counts[i]);
        *draw_calls += batch->call_count;
    }
    batch->call_count = 0;
}

static camber_status list_strip(camber_renderer *renderer, GLint first, GLsizei count) {
    camber_batch *batch = &renderer->gl.batch;
    camber_context *context = renderer->share.device->context;
    if (!camber_grow(context, &batch->firsts, &batch->first_capacity, batch->call_count + 1, sizeof *batch->firsts) ||
        !camber_grow(context, &batch->counts, &batch->count_capacity, batch->call_count + 1, sizeof *batch->counts))
        return CAMBER_ERROR_MEMORY;
    batch->firsts[batch->call_count] = first;
    batch->counts[batch->call_count++] = count;
    return CAMBER_OK;
}

/* Returns the first index of a polyline, or in a pitched view its first vertex. */
static camber_status first_of(camber_slot_starts *starts, size_t polyline, bool pitched, uint64_t *first) {
    size_t record = 0;
    if (!pitched)
        return camber_slot_starts_index(starts, polyline, first);
    const camber_status status = camber_slot_starts_record(starts, polyline, &record);
    *first = (uint64_t)RECORD_VERTICES * record;
    return status;
}

/* Lists or draws those polylines of a range that are in the bound part. */
static camber_status draw_part(camber_renderer *renderer, camber_slot_starts *starts, camber_batch_range range,
                               const camber_shader *shader, const camber_gl_area *area) {
    /* GL's counts are signed 32-bit numbers. Longer strips are cut between polylines. */
    enum { INDICES_MAX = 1 << 30 };
    const camber_mesh *mesh = renderer->gl.batch.mesh;
    const unsigned bits = vertex_bits(mesh, area->view.pitched);
    camber_status status = CAMBER_OK;
    while (range.first < range.end && status == CAMBER_OK) {
        size_t until = range.end;
        uint64_t from = 0, to = 0;
        status = first_of(starts, range.first, area->view.pitched, &from);
        if (status == CAMBER_OK)
            status = first_of(starts, until, area->view.pitched, &to);
        while (status == CAMBER_OK && to - from > INDICES_MAX && until - range.first > 1) {
            until = range.first + (until - range.first) / 2;
            status = first_of(starts, until, area->view.pitched, &to);
        }
        range.first = until;
        if (status != CAMBER_OK || to == from)
            continue;
        if (has_numbered_tables(mesh, area)) {
            status = list_strip(renderer, (GLint)((uint64_t)range.table << bits | from), (GLsizei)(to - from));
        } else {
            renderer->share.surface->gl.Uniform1i(shader->table, (GLint)range.table);
            camber_gl_draw_indices(renderer, mesh, from, to - from);
            ++*area->draw_calls;
        }
    }
    return status;
}

static camber_status draw_ranges(camber_renderer *renderer, const camber_shader *shader, const camber_gl_area *area) {
    const camber_batch *batch = &renderer->gl.batch;
    camber_mesh *mesh = batch->mesh;
    camber_slot_starts starts = {0}; /* for the bound part */
    camber_status status = CAMBER_OK;
    for (size_t r = 0; r < batch->range_count; r++)
        for (size_t i = 0; i < mesh->part_count && status == CAMBER_OK; i++) {
            camber_mesh_part *part = mesh->parts + i;
            const size_t part_end = part->first_polyline + part->polyline_count;
            camber_batch_range range = batch->ranges[r];
            range.first = range.first > part->first_polyline ? range.first : part->first_polyline;
            range.end = range.end < part_end ? range.end : part_end;
            if (range.first >= range.end || part->index_count == 0)
                continue;
            if (part != starts.finder.part) {
                draw_strips(renderer, area); /* their part is bound, and may have to be evicted */
                camber_slot_starts_unmap(&starts);
                status = camber_part_ensure_output(mesh, part);
                if (status != CAMBER_OK)
                    break;
                starts = camber_slot_starts_of(mesh, part);
                camber_gl_bind_part(renderer, part);
            }
            status = draw_part(renderer, &starts, range, shader, area);
        }
    camber_slot_starts_unmap(&starts);
    if (status == CAMBER_OK)
        draw_strips(renderer, area);
    return status;
}

void camber_gl_hide_horizon(camber_renderer *renderer, const camber_gl_area *area) {
    const uint32_t past = area->view.horizon > area->y ? area->view.horizon - area->y : 0;
    const GLint top = (GLint)(past < area->height ? past : area->height);
    renderer->share.surface->gl.Scissor(0, top, (GLsizei)area->width, (GLsizei)area->height - top);
}

camber_status camber_batch_draw(camber_renderer *renderer, unsigned variant, const camber_gl_area *area) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const camber_batch *batch = &renderer->gl.batch;
    const camber_mesh *mesh = batch->mesh;
    const camber_shader *shader;
    if (batch->range_count == 0)
        return CAMBER_OK;
    const size_t row_count = batch->table_count * mesh->row_count;
    variant |= batch->features * CAMBER_VARIANT_FEATURES;
    variant |= area->view.pitched ? CAMBER_VARIANT_PITCHED : 0u;
    variant |= area->coverage == CAMBER_COVERAGE_LINEAR ? CAMBER_VARIANT_LINEAR : 0u;
    camber_status status = camber_gl_stroke_shader(renderer, mesh, area->thinnest_px, variant, &shader);
    if (status == CAMBER_OK)
        status = camber_rows_upload(renderer, row_count, side_texels(renderer, batch->features));
    if (status == CAMBER_OK) {
        camber_gl_use_shader(renderer, shader, mesh, area);
        gl->Uniform1i(shader->table,
                      has_numbered_tables(mesh, area) ? (GLint)vertex_bits(mesh, area->view.pitched) : 0);
        gl->Uniform1i(shader->table_rows, (GLint)mesh->row_count);
        gl->Uniform1i(shader->side_table, (GLint)(CAMBER_ROW_TEXELS * row_count));
        if (variant & CAMBER_VARIANT_PATTERN)
            camber_atlas_bind(renderer);
        if (area->view.pitched && batch->upright)
            gl->Uniform4f(shader->eye, area->view.eye[0], area->view.eye[1], 1.0f, 0.0f);
        if (area->view.pitched)
            camber_gl_hide_horizon(renderer, area);
        status = draw_ranges(renderer, shader, area);
        if (area->view.pitched)
            gl->Scissor(0, 0, (GLsizei)area->width, (GLsizei)area->height);
        gl->BindVertexArray(0);
    }
    camber_batch_clear(renderer);
    return status;
}
