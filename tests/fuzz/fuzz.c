/* The context of a fuzz target: it counts memory and keeps the log; and the properties of any mesh. */
#include "fuzz.h"

#include "kernels/layout.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* No input is longer than some KB: what asks for more than this has believed a number of it. */
static const size_t LARGEST_BLOCK = (size_t)256 << 20;

void fuzz_break(const char *condition, const char *file, int line) {
    fprintf(stderr, "%s:%d: does not hold: %s\n", file, line, condition);
    abort();
}

/* ---- The context ---- */

static void *reallocate(void *user, void *block, size_t size_bytes) {
    fuzz_run *run = user;
    if (size_bytes == 0) {
        run->live_blocks -= block != NULL;
        free(block);
        return NULL;
    }
    REQUIRE(size_bytes <= LARGEST_BLOCK);
    if (++run->calls == run->refuse_at) {
        run->refused = true;
        return NULL;
    }
    void *moved = realloc(block, size_bytes);
    REQUIRE(moved);
    run->live_blocks += !block;
    return moved;
}

/* One line that a terminal shows as it is. */
static void take_message(void *user, camber_log_level level, const char *message) {
    fuzz_run *run = user;
    REQUIRE(message[0]);
    for (const char *c = message; *c; c++)
        REQUIRE((unsigned char)*c >= ' ' && *c != 0x7f);
    run->errors += level == CAMBER_LOG_ERROR;
}

bool fuzz_done(fuzz_run *run, camber_status status) {
    REQUIRE(run->errors == (status != CAMBER_OK));
    REQUIRE(status != CAMBER_ERROR_MEMORY || run->refused);
    REQUIRE(status >= CAMBER_OK && status <= CAMBER_ERROR_LIMIT);
    run->errors = 0;
    return status == CAMBER_OK;
}

/* FNV-1a. */
static uint64_t hash_of(const uint8_t *bytes, size_t size) {
    uint64_t hash = 14695981039346656037ull;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ bytes[i]) * 1099511628211ull;
    return hash ^ hash >> 32;
}

static size_t run_body(fuzz_run run, const uint8_t *bytes, size_t size, fuzz_body *body) {
    const camber_context_desc desc = {
        .reallocate = reallocate, .allocator_user = &run, .log = take_message, .log_user = &run, .cache_dir = ""};
    if (camber_context_create(&desc, &run.context) == CAMBER_OK)
        body(&run, bytes, size);
    else
        REQUIRE(run.refused);
    camber_context_destroy(run.refused && !run.context ? NULL : run.context);
    REQUIRE(run.live_blocks == 0);
    return run.calls;
}

void fuzz_each(const uint8_t *bytes, size_t size, fuzz_body *body) {
    fuzz_run run = {.hash = hash_of(bytes, size)};
    const size_t calls = run_body(run, bytes, size, body);
    if (run.hash % 4 == 0) {
        run.refuse_at = 1 + run.hash / 4 % calls;
        run_body(run, bytes, size, body);
    }
}

/* ---- Reading ---- */

uint64_t fuzz_take(fuzz_reader *from, size_t byte_count) {
    uint64_t value = 0;
    for (size_t i = 0; i < byte_count && from->size; i++, from->size--)
        value |= (uint64_t)*from->bytes++ << 8 * i;
    return value;
}

float fuzz_take_float(fuzz_reader *from) {
    const uint32_t word = (uint32_t)fuzz_take(from, 4);
    float number;
    memcpy(&number, &word, sizeof number);
    return number;
}

double fuzz_take_double(fuzz_reader *from) {
    const uint64_t word = fuzz_take(from, 8);
    double number;
    memcpy(&number, &word, sizeof number);
    return number;
}

camber_stroke fuzz_take_stroke(fuzz_reader *from) {
    const float width_px = fuzz_take_float(from), miter_limit = fuzz_take_float(from);
    const unsigned kinds = (unsigned)fuzz_take(from, 1);
    const float offset_px = kinds & 16 ? fuzz_take_float(from) : 0.0f;
    const float round_limit = kinds & 32 ? fuzz_take_float(from) : 0.0f;
    return (camber_stroke){.width_px = width_px,
                           .join = (camber_join)(kinds & 3),
                           .cap = (camber_cap)(kinds >> 2 & 3),
                           .miter_limit = miter_limit,
                           .offset_px = offset_px,
                           .round_limit = round_limit};
}

/* ---- Meshes ---- */

static void check_vertex(const camber_vertex *v, const camber_tessellation_desc *desc) {
    REQUIRE(isfinite(v->x) && isfinite(v->y) && isfinite(v->dx) && isfinite(v->dy));
    REQUIRE(isfinite(v->along) && isfinite(v->limit_px) && v->limit_px >= 0.0f);
    REQUIRE(v->flags < 512 && v->row < desc->stroke_count);
    /* A segment has a length that a float can square. */
    const float squared = v->dx * v->dx + v->dy * v->dy;
    REQUIRE(isfinite(squared) && (squared >= 1e-18f || (v->dx == 0.0f && v->dy == 0.0f)));
}

/* Runs of a strip, or lists: every index is a vertex, every vertex is used, and the triangles are as many as said. */
static void check_indices(const camber_mesh_data *mesh) {
    const camber_mesh_info *info = &mesh->info;
    bool *used = calloc(info->vertex_count + 1, 1);
    REQUIRE(used);
    size_t triangles = 0, length = 0;
    for (size_t i = 0; i < info->index_count; i++) {
        const uint32_t index = mesh->indices[i];
        if (info->strips && index == CAMBER_RESTART_INDEX) {
            REQUIRE(i < 2 || length == 0 || length >= 4);
            length = 0;
            continue;
        }
        REQUIRE(index < info->vertex_count);
        REQUIRE(!info->strips || i > 1);
        used[index] = true;
        length++;
        triangles += i > 1 && camber_mesh_data_draws(mesh, i - 2);
    }
    REQUIRE(info->strips ? info->index_count == 0 || length >= 4 : info->index_count % 3 == 0);
    REQUIRE(triangles == info->triangle_count);
    size_t unused = 0;
    for (size_t i = 0; i < info->vertex_count; i++)
        unused += !used[i];
    REQUIRE(unused == 0);
    free(used);
}

/* Lines beside others have points of their own. */
static bool has_offsets(const camber_tessellation_desc *desc) {
    for (size_t i = 0; i < desc->stroke_count; i++)
        if (desc->strokes[i].offset_px < 0.0f || desc->strokes[i].offset_px > 0.0f)
            return true;
    return false;
}

/* The joins follow from what cleaning has counted: all points but ends, dots and the points at which rings close. */
static void check_counts(const camber_mesh_info *info, const camber_polylines_stats *stats) {
    const size_t open = stats->kept_points - stats->kept_segments - stats->dots - stats->rings;
    REQUIRE(info->joins == stats->kept_points - stats->dots - 2 * open - stats->rings);
    REQUIRE(info->tight_joins + info->split_joins <= info->joins);
    REQUIRE(info->undrawn_dots <= stats->dots);
    REQUIRE((info->index_count == 0) == (stats->kept_segments == 0 && info->undrawn_dots == stats->dots));
}

/* Points come in order, each with the vertices that lie at it, and their joins are those that were counted. */
static void check_stages(fuzz_run *run, const camber_polylines *polylines, const camber_tessellation_desc *desc,
                         const camber_mesh_data *mesh) {
    const camber_mesh_info *info = &mesh->info;
    size_t kinds[16] = {0};
    camber_stages stages = {0};
    if (!fuzz_done(run, camber_stages_tessellate(run->context, polylines, desc, &stages)))
        return;
    const bool offset = has_offsets(desc);
    REQUIRE(offset || stages.point_count == camber_polylines_get_stats(polylines).kept_points);
    for (size_t i = 0; i < stages.point_count; i++) {
        const camber_point_stages *at = stages.points + i, *next = at + 1;
        const bool last = i + 1 == stages.point_count, ends = last || next->polyline != at->polyline;
        const size_t end_vertex = last ? info->vertex_count : next->first_vertex;
        const size_t end_index = last ? info->index_count : next->first_index;
        REQUIRE(i > 0 || (at->first_vertex == 0 && at->first_index == 0 && at->point == 0));
        REQUIRE(last || (ends ? next->polyline > at->polyline && next->point == 0 : next->point == at->point + 1));
        REQUIRE(at->first_vertex <= end_vertex && end_vertex <= info->vertex_count);
        REQUIRE(at->first_index <= end_index && end_index <= info->index_count);
        for (size_t v = at->first_vertex; v < end_vertex; v++)
            REQUIRE(mesh->vertices[v].x == at->x && mesh->vertices[v].y == at->y);
        REQUIRE(desc->method == CAMBER_METHOD_STRIP ||
                (at->join >> CAMBER_JOIN_TRIANGLES_SHIFT & 127) <= CAMBER_JOIN_TRIANGLES_MAX);
        kinds[at->join >> CAMBER_JOIN_KIND_SHIFT]++;
    }
    const camber_polylines_stats stats = camber_polylines_get_stats(polylines);
    REQUIRE(kinds[CAMBER_KIND_SENTINEL] == info->undrawn_dots);
    REQUIRE(offset || kinds[CAMBER_KIND_SENTINEL] + kinds[CAMBER_KIND_DOT] == stats.dots);
    /* A ring's seam stands at both of its ends. */
    REQUIRE(offset ||
            kinds[CAMBER_KIND_CUT] + kinds[CAMBER_KIND_TIGHT] + kinds[CAMBER_KIND_SPLIT] == info->joins + stats.rings);
    REQUIRE(kinds[CAMBER_KIND_TIGHT] >= info->tight_joins && kinds[CAMBER_KIND_SPLIT] >= info->split_joins);
    camber_stages_destroy(&stages);
}

bool fuzz_tessellate(fuzz_run *run, const camber_polylines *polylines, const camber_tessellation_desc *desc,
                     camber_mesh_data *keep) {
    camber_mesh_data mesh = {0};
    if (!fuzz_done(run, camber_mesh_data_tessellate(run->context, polylines, desc, &mesh))) {
        REQUIRE(!mesh.vertices && !mesh.indices);
        return false;
    }
    const camber_polylines_stats stats = camber_polylines_get_stats(polylines);
    REQUIRE(mesh.info.method == desc->method && mesh.info.strips == (desc->method == CAMBER_METHOD_STRIP));
    for (size_t i = 0; i < mesh.info.vertex_count; i++)
        check_vertex(mesh.vertices + i, desc);
    check_indices(&mesh);
    if (!has_offsets(desc))
        check_counts(&mesh.info, &stats);
    check_stages(run, polylines, desc, &mesh);
    if (keep)
        *keep = mesh;
    else
        camber_mesh_data_destroy(&mesh);
    return true;
}

void fuzz_check_lines(const camber_lines *lines) {
    REQUIRE(lines->offsets[0] == 0 && lines->offsets[lines->polyline_count] == lines->point_count);
    for (size_t i = 0; i < lines->polyline_count; i++)
        REQUIRE(lines->offsets[i] <= lines->offsets[i + 1]);
}

/* ---- A sink ---- */

static bool write_bytes(void *user, const void *bytes, size_t size_bytes) {
    fuzz_bytes *list = user;
    if (list->size + size_bytes > list->capacity) {
        list->capacity = 2 * (list->size + size_bytes);
        list->bytes = realloc(list->bytes, list->capacity);
        REQUIRE(list->bytes);
    }
    if (size_bytes)
        memcpy(list->bytes + list->size, bytes, size_bytes);
    list->size += size_bytes;
    return true;
}

camber_sink fuzz_sink(fuzz_bytes *bytes) {
    return (camber_sink){.write = write_bytes, .user = bytes};
}

__attribute__((weak)) int LLVMFuzzerInitialize(int *argument_count, char ***arguments) {
    (void)argument_count;
    (void)arguments;
    return 0;
}
