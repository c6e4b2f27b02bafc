/* Compares the kernels with the CPU twin, stage by stage and byte for byte, and with themselves: from run to run, with
 * other work-group sizes, and in parts. */
#include "validate/checks.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *camber_join_name(camber_join join) {
    static const char *const names[] = {"round", "miter", "bevel"};
    return names[join];
}

const char *camber_cap_name(camber_cap cap) {
    static const char *const names[] = {"butt", "round", "square"};
    return names[cap];
}

camber_stroke *camber_strokes_styled(const camber_stroke *strokes, size_t count, camber_style_fn *style,
                                     size_t number) {
    camber_stroke *styled = calloc(count + 1, sizeof *styled);
    for (size_t row = 0; styled && row < count; row++) {
        styled[row] = strokes[row];
        style(&styled[row], row, number);
    }
    return styled;
}

bool camber_subject_takes(const camber_subject *s, const camber_validation_desc *desc, camber_method method) {
    return s->network ? s->method == method : desc->method < 0 || desc->method == (int)method;
}

bool camber_draws_method(const camber_validation_desc *desc, camber_method method) {
    return desc->full || (int)method == (desc->method < 0 ? CAMBER_METHOD_STRIP : desc->method);
}

/* ---- Reading back ---- */

static camber_status see_twin(camber_validation *v, const camber_subject *s, const camber_tessellation_desc *desc,
                              camber_mesh_state *state) {
    camber_context *context = v->desc->context;
    const camber_status status = camber_stages_tessellate(context, s->polylines, desc, &state->stages);
    state->has_stages = status == CAMBER_OK;
    return status == CAMBER_OK ? camber_mesh_data_tessellate(context, s->polylines, desc, &state->mesh) : status;
}

static camber_status see_mesh(camber_mesh *mesh, const camber_subject *s, const camber_tessellation_desc *desc,
                              bool with_stages, camber_mesh_state *state) {
    const camber_status status = camber_subject_tessellate(s, mesh, desc);
    state->of_network = s->network != NULL;
    return status == CAMBER_OK ? camber_mesh_state_read(mesh, with_stages, state) : status;
}

/* A subject on a device with a method. */
typedef struct job {
    camber_validation *v;
    const camber_subject *s;
    camber_checked_device *checked;
    camber_tessellation_desc desc;
} job;

/* Compares a mesh with the expected one. If with_stages is true, the finding names the first stage that differs. */
static camber_status compare_mesh(job *j, camber_mesh *mesh, const camber_mesh_state *expected, bool with_stages,
                                  camber_check *check) {
    camber_mesh_state got = {0};
    const camber_status status = see_mesh(mesh, j->s, &j->desc, with_stages, &got);
    if (status == CAMBER_OK && camber_mesh_states_differ(&got, expected, &check->finding))
        check->result = CAMBER_RESULT_FAILED;
    camber_mesh_state_close(&got);
    return status;
}

/* ---- Comparison with the twin ---- */

/* One style for every join and cap; the last one has offsets. */
enum { BESIDE = 9, STYLES };

static void every_join_and_cap(camber_stroke *stroke, size_t row, size_t number) {
    static const float offsets_px[] = {6.0f, -6.0f, 2.5f, -20.0f, 0.0f};
    stroke->join = (camber_join)((number == BESIDE ? row : number / 3) % 3);
    stroke->cap = (camber_cap)(number % 3);
    stroke->offset_px = number == BESIDE ? offsets_px[row % (sizeof offsets_px / sizeof *offsets_px)] : 0.0f;
}

/* Returns the strokes for the next check; NULL if memory is exhausted. A network keeps its strokes, because its twin's
 * polylines are made with them. */
static camber_stroke *style(job *j, camber_style_fn *styled, size_t number) {
    camber_stroke *strokes =
        camber_strokes_styled(j->s->strokes, j->s->stroke_count, j->s->network ? camber_style_kept : styled, number);
    j->desc.strokes = strokes;
    return strokes;
}

static camber_status check_twin(job *j, size_t number) {
    camber_stroke *strokes = style(j, every_join_and_cap, number);
    camber_mesh_state twin = {0};
    char styled[64] = "";
    if (!j->s->network && number == BESIDE)
        snprintf(styled, sizeof styled, ", offset");
    else if (!j->s->network)
        snprintf(styled, sizeof styled, ", %s joins, %s caps", camber_join_name((camber_join)(number / 3 % 3)),
                 camber_cap_name((camber_cap)(number % 3)));
    camber_check check = camber_check_start(j->checked->name, NULL, "%s: %s%s: as the CPU twin, on %s", j->s->name,
                                            camber_method_get_name(j->desc.method), styled, j->checked->name);
    camber_status made = strokes ? see_twin(j->v, j->s, &j->desc, &twin) : CAMBER_ERROR_MEMORY;
    if (made == CAMBER_OK)
        made = compare_mesh(j, j->checked->mesh, &twin, true, &check);
    camber_status status = made;
    if (status == CAMBER_OK && check.result == CAMBER_RESULT_FAILED) {
        /* one picture is enough, because a fault in one style usually affects all of them */
        if (!j->checked->broken[j->desc.method])
            status = camber_failure_image_of_mesh(j->v, j->checked, j->s, &j->desc, &check.finding);
        j->checked->broken[j->desc.method] = true;
    }
    if (status == CAMBER_OK)
        camber_results_add(&j->v->results, &check);
    camber_mesh_state_close(&twin);
    free(strokes);
    return status;
}

/* ---- Comparison with itself ---- */

void camber_style_mixed(camber_stroke *stroke, size_t row, size_t number) {
    stroke->join = (camber_join)((row + number) % 3);
    stroke->cap = (camber_cap)((row / 3 + 2 * number) % 3);
}

void camber_style_kept(camber_stroke *stroke, size_t row, size_t number) {
    (void)stroke;
    (void)row;
    (void)number;
}

/* The smallest limit of camber_device_desc. */
enum { LEAST_BUFFER_BYTES = 4096 };

enum { REASON_BYTES = 501 }; /* size of a message that becomes a reason */

/* Returns a memory limit that is enough for the largest polyline, but not for the whole mesh. 0: there is none. */
static uint64_t part_bytes(const camber_mesh_state *whole, size_t stroke_count) {
    const camber_point_stages *points = whole->stages.points;
    const camber_mesh_info *info = &whole->mesh.info;
    const uint64_t record_bytes = info->record_count * sizeof(camber_record), index_bytes = info->bytes - record_bytes;
    const uint64_t mesh_bytes = record_bytes > index_bytes ? record_bytes : index_bytes;
    uint64_t largest = 32 * (stroke_count + 1), from = 0;
    largest = largest > LEAST_BUFFER_BYTES ? largest : LEAST_BUFFER_BYTES;
    for (size_t i = 0; i < whole->stages.point_count; i++) {
        const bool last = i + 1 == whole->stages.point_count;
        if (!last && points[i + 1].polyline == points[i].polyline)
            continue;
        /* strips have two indices per record; kite and fan have one record per point, in whole work-groups */
        const uint64_t indices = (last ? info->index_count : points[i + 1].first_index) - points[from].first_index;
        const uint64_t records = info->strips ? indices / 2 : i - from + 512;
        const uint64_t bytes[] = {records * sizeof(camber_record), info->strips ? 0 : indices * sizeof(uint32_t),
                                  4 * (i - from + 512)};
        for (size_t k = 0; k < sizeof bytes / sizeof *bytes; k++)
            largest = bytes[k] > largest ? bytes[k] : largest;
        from = i + 1;
    }
    const uint64_t wanted = largest > mesh_bytes / 3 ? largest : mesh_bytes / 3;
    return wanted < mesh_bytes ? wanted : 0;
}

/* Returns such a limit for a network, whose points are on the device, too. A polyline may have more points on the
 * device than are visible. */
static uint64_t network_part_bytes(const camber_subject *s) {
    const uint64_t wanted = 4 * (uint64_t)camber_network_get_stats(s->network).kept_points / 3;
    return wanted > LEAST_BUFFER_BYTES ? wanted : 0;
}

/* Compares with the mesh made in parts, which requires several polylines. */
static camber_status compare_parts(job *j, const camber_mesh_state *whole, camber_check *check) {
    const bool broken = j->checked->broken[j->desc.method];
    const uint64_t most = broken ? 0 : part_bytes(whole, j->s->stroke_count);
    const uint64_t network_most = broken || !j->s->network ? 0 : network_part_bytes(j->s);
    const uint64_t limit = most > network_most ? most : network_most;
    camber_device *device = NULL;
    camber_mesh *mesh = NULL;
    if (limit == 0) {
        check->result = CAMBER_RESULT_SKIPPED;
        snprintf(check->reason, sizeof check->reason, "%s",
                 broken          ? "the mesh is not the CPU twin's"
                 : j->s->network ? "the network fits the smallest buffer"
                                 : "one polyline is most of it, and parts are of whole ones");
        return CAMBER_OK;
    }
    camber_status status = camber_checked_device_open_small(j->checked, j->v, limit, &device, &mesh);
    if (status == CAMBER_OK)
        status = compare_mesh(j, mesh, whole, false, check);
    if (status == CAMBER_ERROR_LIMIT && j->s->network) {
        check->result = CAMBER_RESULT_SKIPPED;
        j->v->desc->host.take_message(j->v->desc->host.user, check->reason, REASON_BYTES);
        status = CAMBER_OK;
    }
    camber_mesh_destroy(mesh);
    camber_device_destroy(device);
    return status;
}

enum { AGAIN, IN_PARTS, IN_GROUPS };

/* Makes the mesh again in one of the ways, and compares it with the first mesh. */
static camber_status check_way(job *j, int way, const camber_mesh_state *first) {
    char what[64] = "from run to run";
    if (way == IN_PARTS)
        snprintf(what, sizeof what, "in parts");
    else if (way >= IN_GROUPS)
        snprintf(what, sizeof what, "in work-groups of %u", j->checked->groups[way - IN_GROUPS].size);
    camber_check check = camber_check_start(j->checked->name, NULL, "%s: %s: the same bytes %s, on %s", j->s->name,
                                            camber_method_get_name(j->desc.method), what, j->checked->name);
    camber_mesh *mesh = way < IN_GROUPS ? j->checked->mesh : j->checked->groups[way - IN_GROUPS].mesh;
    const camber_status compared =
        way == IN_PARTS ? compare_parts(j, first, &check) : compare_mesh(j, mesh, first, false, &check);
    const camber_status status = compared;
    if (status == CAMBER_OK)
        camber_results_add(&j->v->results, &check);
    return status;
}

static camber_status check_ways(job *j) {
    camber_stroke *strokes = style(j, camber_style_mixed, (size_t)j->desc.method);
    camber_mesh_state first = {0};
    const camber_status seen = strokes ? see_mesh(j->checked->mesh, j->s, &j->desc, true, &first) : CAMBER_ERROR_MEMORY;
    camber_status status = seen;
    for (int way = 0; way < IN_GROUPS + (int)j->checked->group_count && status == CAMBER_OK; way++)
        status = check_way(j, way, &first);
    camber_mesh_state_close(&first);
    free(strokes);
    return status;
}

camber_status camber_check_meshes(camber_validation *validation, const camber_subject *subject) {
    const size_t styles = subject->network ? 1 : STYLES;
    camber_status status = CAMBER_OK;
    for (size_t r = 0; r < validation->devices.count; r++)
        for (int method = 0; method < 3 && status == CAMBER_OK; method++) {
            job j = {validation,
                     subject,
                     &validation->devices.list[r],
                     {.stroke_count = subject->stroke_count, .method = (camber_method)method}};
            if (!camber_subject_takes(subject, validation->desc, (camber_method)method))
                continue;
            j.checked->broken[method] = false;
            for (size_t number = 0; number < styles && status == CAMBER_OK; number++)
                status = check_twin(&j, number);
            if (status == CAMBER_OK)
                status = check_ways(&j);
        }
    return status;
}
