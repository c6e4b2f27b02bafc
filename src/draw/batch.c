/* Draws that nothing comes between, in as few calls as the driver takes them in: runs of polylines of one mesh, each
 * with a table in the row texture. Of strips a vertex's number says its table, in the bits above the mesh's own
 * vertices; of kite and fan, whose indices are in the mesh, a uniform does. */
#include "draw/renderer.h"

/* Tables a call: more would hold more memory than a call costs. */
enum { ROWS_MAX = 1 << 20 };

/* Of the two triangles of a segment that is seen at an angle. */
enum { RECORD_VERTICES = 6 };

camber_status camber_renderer_mesh_shader(camber_renderer *renderer, const camber_mesh *mesh, float thinnest_px,
                                          unsigned variant, const camber_shader **shader) {
    if (variant & CAMBER_VARIANT_PITCHED)
        thinnest_px = 0.0f; /* far away all are */
    /* A pixel reaches sqrt(1/2) px along any normal; stroke.vert says where a tip ends: past where the cap does. */
    const bool thin = thinnest_px < 1.4143f, tips = thin || (mesh->round_caps && thinnest_px < 3.7f);
    variant |=
        (mesh->sharp_joins ? CAMBER_VARIANT_SHARP_JOINS : 0u) | (mesh->flat_caps ? CAMBER_VARIANT_FLAT_CAPS : 0u);
    variant |= (unsigned)mesh->mesh_info.method * CAMBER_VARIANT_METHOD;
    variant |= (thin ? CAMBER_VARIANT_THIN : 0u) | (tips ? CAMBER_VARIANT_TIPS : 0u);
    return camber_renderer_stroke_shader(renderer, variant, shader);
}

void camber_renderer_use_shader(camber_renderer *renderer, const camber_shader *shader, const camber_mesh *mesh,
                                const camber_piece *piece) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const GLfloat x = (GLfloat)piece->x, y = (GLfloat)piece->y, w = (GLfloat)piece->width, h = (GLfloat)piece->height;
    const GLfloat guard_x = (GLfloat)camber_renderer_guard(renderer, 0, (GLsizei)piece->width),
                  guard_y = (GLfloat)camber_renderer_guard(renderer, 1, (GLsizei)piece->height);
    /* What winds the other way in a strip lies between the two records of a tight join. */
    (mesh->mesh_info.strips && !piece->pitched ? gl->Enable : gl->Disable)(GL_CULL_FACE);
    gl->UseProgram(shader->program);
    gl->Uniform2f(shader->origin, x, y);
    gl->Uniform2f(shader->corner, x - guard_x, y - guard_y);
    gl->Uniform2f(shader->scale, 2.0f / (w + 2.0f * guard_x), 2.0f / (h + 2.0f * guard_y));
    gl->Uniform1i(shader->table, mesh->mesh_info.strips ? 31 : 0);
    if (piece->pitched)
        gl->Uniform4f(shader->eye, piece->eye[0], piece->eye[1], piece->eye[2], piece->eye[3]);
    gl->Uniform1i(shader->stride, mesh->mesh_info.measured ? 2 : 1);
}

void camber_renderer_bind_part(camber_renderer *renderer, camber_mesh_part *part) {
    const camber_gl *gl = &renderer->share.surface->gl;
    for (size_t i = 0; i < sizeof part->buffers / sizeof *part->buffers; i++)
        part->buffers[i].drawn_frame = renderer->share.frames_begun;
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

/* Of a part as it is drawn: a strip's vertices, or where the piece is pitched six a record, whatever the method. */
static size_t vertex_count(const camber_mesh *mesh, const camber_mesh_part *part, bool pitched) {
    const size_t records = mesh->mesh_info.strips ? part->index_count / 2 : part->slot_count;
    return pitched ? RECORD_VERTICES * records : part->index_count;
}

/* Bits of a vertex's number within its part; all 31 where the numbers leave no room for tables. */
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

static bool has_numbered_tables(const camber_mesh *mesh, const camber_piece *piece) {
    return mesh->mesh_info.strips || piece->pitched;
}

static bool has_room(const camber_renderer *renderer, const camber_run *run, const camber_piece *piece) {
    const camber_mesh *mesh = run->pass->mesh;
    const size_t tables = renderer->batch.table_count + 1;
    const size_t tail_texels = renderer->tail_count + camber_tail_need(run->pass);
    const unsigned bits = has_numbered_tables(mesh, piece) ? vertex_bits(mesh, piece->pitched) : 0;
    return tables * mesh->row_count <= ROWS_MAX &&
           camber_renderer_holds_rows(renderer, tables * mesh->row_count, tail_texels) &&
           tables <= (size_t)1 << (31 - bits);
}

camber_status camber_batch_add(camber_renderer *renderer, const camber_run *run, const camber_piece *piece) {
    camber_batch *batch = &renderer->batch;
    camber_context *context = renderer->share.device->context;
    const camber_mesh *mesh = run->pass->mesh;
    const bool again = batch->table_count && batch->pass == run->pass;
    if (run->bands & CAMBER_VARIANT_PATTERN && !again) {
        const camber_status held = camber_patterns_hold(renderer, run->pass, piece);
        if (held != CAMBER_OK)
            return held;
    }
    const bool same_mesh = batch->table_count == 0 || batch->mesh == mesh;
    const bool same_table = batch->table_count && same_mesh && batch->pass == run->pass;
    camber_status status = CAMBER_OK;
    if (!same_mesh || (!same_table && batch->table_count && !has_room(renderer, run, piece)))
        status = camber_batch_draw(renderer, 0, piece);
    if (status == CAMBER_OK && !same_table)
        status = camber_renderer_reserve_rows(renderer, (batch->table_count + 1) * mesh->row_count);
    if (status == CAMBER_OK &&
        !camber_grow(context, &batch->ranges, &batch->range_capacity, batch->range_count + 1, sizeof *batch->ranges))
        status = CAMBER_ERROR_MEMORY;
    if (status != CAMBER_OK)
        return status;
    if (!same_table)
        status = camber_renderer_fill_rows(renderer, run, batch->table_count++);
    if (status != CAMBER_OK)
        return status;
    batch->mesh = mesh;
    batch->pass = run->pass;
    batch->bands |= run->bands;
    batch->ranges[batch->range_count++] = (camber_batch_range){run->first, run->end, batch->table_count - 1};
    return CAMBER_OK;
}

void camber_batch_forget(camber_renderer *renderer) {
    renderer->batch.table_count = renderer->batch.range_count = renderer->batch.call_count = 0;
    renderer->batch.bands = 0;
    camber_tail_forget(renderer);
}

/* ---- Calls ---- */

/* Makes the strips that are listed, or triangles where the piece is pitched. */
static void draw_strips(camber_renderer *renderer, const camber_piece *piece) {
    const camber_gl *gl = &renderer->share.surface->gl;
    camber_batch *batch = &renderer->batch;
    size_t *draw_calls = piece->draw_calls;
    const GLenum mode = piece->pitched ? GL_TRIANGLES : GL_TRIANGLE_STRIP;
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
    camber_batch *batch = &renderer->batch;
    camber_context *context = renderer->share.device->context;
    if (!camber_grow(context, &batch->firsts, &batch->first_capacity, batch->call_count + 1, sizeof *batch->firsts) ||
        !camber_grow(context, &batch->counts, &batch->count_capacity, batch->call_count + 1, sizeof *batch->counts))
        return CAMBER_ERROR_MEMORY;
    batch->firsts[batch->call_count] = first;
    batch->counts[batch->call_count++] = count;
    return CAMBER_OK;
}

/* The first index of a polyline, or where the piece is pitched its first vertex. */
static camber_status first_of(const camber_mesh *mesh, const camber_mesh_part *part, size_t polyline, bool pitched,
                              uint64_t *first) {
    if (pitched && !mesh->mesh_info.strips) {
        size_t slot = 0;
        const camber_status found = camber_part_slot(mesh, part, polyline, &slot);
        *first = (uint64_t)RECORD_VERTICES * slot;
        return found;
    }
    const camber_status status = camber_part_first_index(mesh, part, polyline, first);
    if (status == CAMBER_OK && pitched)
        *first *= RECORD_VERTICES / 2;
    return status;
}

/* Lists or draws what a part, which is bound, has of a range. */
static camber_status draw_part(camber_renderer *renderer, const camber_mesh_part *part, camber_batch_range range,
                               const camber_shader *shader, const camber_piece *piece) {
    /* A count is a signed 32-bit number, and strips may be cut between polylines. */
    enum { INDICES_MAX = 1 << 30 };
    const camber_mesh *mesh = renderer->batch.mesh;
    const unsigned bits = vertex_bits(mesh, piece->pitched);
    camber_status status = CAMBER_OK;
    while (range.first < range.end && status == CAMBER_OK) {
        size_t until = range.end;
        uint64_t from = 0, to = 0;
        status = first_of(mesh, part, range.first, piece->pitched, &from);
        if (status == CAMBER_OK)
            status = first_of(mesh, part, until, piece->pitched, &to);
        while (status == CAMBER_OK && to - from > INDICES_MAX && until - range.first > 1) {
            until = range.first + (until - range.first) / 2;
            status = first_of(mesh, part, until, piece->pitched, &to);
        }
        range.first = until;
        if (status != CAMBER_OK || to == from)
            continue;
        if (has_numbered_tables(mesh, piece)) {
            status = list_strip(renderer, (GLint)((uint64_t)range.table << bits | from), (GLsizei)(to - from));
        } else {
            renderer->share.surface->gl.Uniform1i(shader->table, (GLint)range.table);
            camber_renderer_draw_indices(renderer, mesh, from, to - from);
            ++*piece->draw_calls;
        }
    }
    return status;
}

static camber_status draw_ranges(camber_renderer *renderer, const camber_shader *shader, const camber_piece *piece) {
    const camber_batch *batch = &renderer->batch;
    camber_mesh *mesh = batch->pass->mesh;
    const camber_mesh_part *bound = NULL;
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
            if (part != bound) {
                draw_strips(renderer, piece); /* of the part that is bound, and may have to go */
                status = camber_part_ensure_made(mesh, part);
                if (status != CAMBER_OK)
                    break;
                camber_renderer_bind_part(renderer, part);
            }
            bound = part;
            status = draw_part(renderer, part, range, shader, piece);
        }
    if (status == CAMBER_OK)
        draw_strips(renderer, piece);
    return status;
}

void camber_renderer_hide_beyond(camber_renderer *renderer, const camber_piece *piece) {
    const uint32_t past = piece->horizon > piece->y ? piece->horizon - piece->y : 0;
    const GLint top = (GLint)(past < piece->height ? past : piece->height);
    renderer->share.surface->gl.Scissor(0, top, (GLsizei)piece->width, (GLsizei)piece->height - top);
}

camber_status camber_batch_draw(camber_renderer *renderer, unsigned variant, const camber_piece *piece) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const camber_batch *batch = &renderer->batch;
    const camber_mesh *mesh = batch->mesh;
    const camber_shader *shader;
    if (batch->range_count == 0)
        return CAMBER_OK;
    variant |= batch->bands;
    variant |= piece->pitched ? CAMBER_VARIANT_PITCHED : 0u;
    variant |= piece->coverage == CAMBER_COVERAGE_LINEAR ? CAMBER_VARIANT_LINEAR : 0u;
    camber_status status = camber_renderer_mesh_shader(renderer, mesh, piece->thinnest_px, variant, &shader);
    if (status == CAMBER_OK)
        status = camber_renderer_upload_rows(renderer, batch->table_count * mesh->row_count);
    if (status == CAMBER_OK) {
        camber_renderer_use_shader(renderer, shader, mesh, piece);
        gl->Uniform1i(shader->table, has_numbered_tables(mesh, piece) ? (GLint)vertex_bits(mesh, piece->pitched) : 0);
        gl->Uniform1i(shader->table_rows, (GLint)mesh->row_count);
        gl->Uniform1i(shader->tail, camber_renderer_tail(batch->table_count * mesh->row_count));
        if (variant & CAMBER_VARIANT_PATTERN)
            camber_patterns_bind(renderer);
        if (piece->pitched)
            camber_renderer_hide_beyond(renderer, piece);
        status = draw_ranges(renderer, shader, piece);
        if (piece->pitched)
            gl->Scissor(0, 0, (GLsizei)piece->width, (GLsizei)piece->height);
        gl->BindVertexArray(0);
    }
    camber_batch_forget(renderer);
    return status;
}
