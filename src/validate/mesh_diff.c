/* Finds the first element in which two tessellations differ: stage, polyline, point, field and both values. */
#include "validate/checks.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>

camber_status camber_mesh_state_read(camber_mesh *mesh, bool with_stages, camber_mesh_state *state) {
    const camber_status status = with_stages ? camber_mesh_read_stages(mesh, &state->stages) : CAMBER_OK;
    state->has_stages = with_stages && status == CAMBER_OK;
    return status == CAMBER_OK ? camber_mesh_read(mesh, &state->mesh) : status;
}

void camber_mesh_state_close(camber_mesh_state *state) {
    camber_mesh_data_destroy(&state->mesh);
    camber_stages_destroy(&state->stages);
}

static void locate(camber_finding *finding, const camber_point_stages *point) {
    finding->has_point = true;
    finding->polyline = point->polyline;
    finding->point = point->point;
    finding->x = (double)point->x;
    finding->y = (double)point->y;
}

/* One field of a struct, actual and expected. */
typedef struct field_pair {
    const char *name;
    double got, expected;
    bool equal;
} field_pair;

#define FIELD(member)                                                                                                  \
    {                                                                                                                  \
#member, (double)got->member, (double)expected->member,                                                        \
            memcmp(&got->member, &expected->member, sizeof got->member) == 0                                           \
    }

static bool take_first(const field_pair *fields, size_t count, camber_finding *finding) {
    for (size_t i = 0; i < count; i++)
        if (!fields[i].equal) {
            finding->field = fields[i].name;
            finding->got = fields[i].got;
            finding->expected = fields[i].expected;
            return true;
        }
    return false;
}

static bool counts_differ(const char *stage, const char *field, size_t got, size_t expected, camber_finding *finding) {
    if (got == expected)
        return false;
    *finding = (camber_finding){.stage = stage, .field = field, .got = (double)got, .expected = (double)expected};
    snprintf(finding->what, sizeof finding->what, "%s: %zu %s, not %zu", stage, got, field, expected);
    return true;
}

/* ---- Stages ---- */

static void tell_stage(camber_finding *finding, const char *stage, const camber_point_stages *point) {
    finding->stage = stage;
    locate(finding, point);
    snprintf(finding->what, sizeof finding->what, "%s: polyline %zu, point %zu at (%.9g, %.9g): %s is %s, not %s",
             stage, finding->polyline, finding->point, finding->x, finding->y, finding->field,
             camber_value_print(finding->got).text, camber_value_print(finding->expected).text);
}

static bool points_differ(const camber_point_stages *got, const camber_point_stages *expected,
                          camber_finding *finding) {
    const field_pair fields[] = {FIELD(polyline), FIELD(point), FIELD(x), FIELD(y), FIELD(info)};
    return take_first(fields, sizeof fields / sizeof *fields, finding);
}

static bool classify_differs(const camber_point_stages *got, const camber_point_stages *expected,
                             camber_finding *finding) {
    const field_pair fields[] = {FIELD(join)};
    return take_first(fields, 1, finding);
}

static bool scan_differs(const camber_point_stages *got, const camber_point_stages *expected, camber_finding *finding) {
    const field_pair fields[] = {FIELD(first_vertex), FIELD(first_index)};
    return take_first(fields, sizeof fields / sizeof *fields, finding);
}

/* Compares stage by stage, because later stages inherit the errors of earlier ones. */
static bool stages_differ(const camber_stages *got, const camber_stages *expected, bool of_network,
                          camber_finding *finding) {
    const struct {
        const char *name;
        bool (*differs)(const camber_point_stages *got, const camber_point_stages *expected, camber_finding *finding);
    } stages[] = {
        {of_network ? "project" : "upload", points_differ}, {"classify", classify_differs}, {"scan", scan_differs}};
    for (size_t s = 0; s < sizeof stages / sizeof *stages; s++) {
        for (size_t i = 0; i < expected->point_count && i < got->point_count; i++)
            if (stages[s].differs(&got->points[i], &expected->points[i], finding)) {
                tell_stage(finding, stages[s].name, &expected->points[i]);
                return true;
            }
        if (s == 0 &&
            counts_differ(of_network ? "survey" : "upload", "points", got->point_count, expected->point_count, finding))
            return true;
    }
    return false;
}

/* ---- Meshes ---- */

/* Returns the last point whose elements begin at or before the element. A point without elements has the same start as
 * the next one. */
static const camber_point_stages *point_of(const camber_stages *stages, uint64_t element, bool index) {
    size_t low = 0, high = stages->point_count;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        const camber_point_stages *point = &stages->points[middle];
        if ((index ? point->first_index : point->first_vertex) <= element)
            low = middle;
        else
            high = middle;
    }
    return stages->point_count ? &stages->points[low] : NULL;
}

static void tell_emit(camber_finding *finding, const camber_stages *stages, const char *kind, size_t element) {
    const camber_point_stages *point = point_of(stages, element, kind[0] == 'i');
    char where[128] = "";
    finding->stage = "emit";
    if (point) {
        locate(finding, point);
        snprintf(where, sizeof where, "polyline %zu, point %zu at (%.9g, %.9g): ", finding->polyline, finding->point,
                 finding->x, finding->y);
    }
    snprintf(finding->what, sizeof finding->what, "emit: %s%s %zu: %s is %s, not %s", where, kind, element,
             finding->field, camber_value_print(finding->got).text, camber_value_print(finding->expected).text);
}

static bool vertices_differ(const camber_mesh_state *g, const camber_mesh_state *e, camber_finding *finding) {
    const size_t g_count = g->mesh.info.vertex_count, e_count = e->mesh.info.vertex_count;
    const size_t count = g_count < e_count ? g_count : e_count;
    if (count == 0 || memcmp(g->mesh.vertices, e->mesh.vertices, count * sizeof(camber_vertex)) == 0)
        return false;
    for (size_t i = 0; i < count; i++) {
        const camber_vertex *got = &g->mesh.vertices[i], *expected = &e->mesh.vertices[i];
        const field_pair fields[] = {FIELD(x),      FIELD(y),        FIELD(dx),     FIELD(dy),
                                     FIELD(along),  FIELD(limit_px), FIELD(across), FIELD(flags),
                                     FIELD(turn_a), FIELD(turn_b),   FIELD(row)};
        if (take_first(fields, sizeof fields / sizeof *fields, finding)) {
            tell_emit(finding, &e->stages, "vertex", i);
            return true;
        }
    }
    return false;
}

static bool indices_differ(const camber_mesh_state *g, const camber_mesh_state *e, camber_finding *finding) {
    const size_t g_count = g->mesh.info.index_count, e_count = e->mesh.info.index_count;
    const size_t count = g_count < e_count ? g_count : e_count;
    for (size_t i = 0; i < count; i++)
        if (g->mesh.indices[i] != e->mesh.indices[i]) {
            finding->field = "index";
            finding->got = g->mesh.indices[i];
            finding->expected = e->mesh.indices[i];
            tell_emit(finding, &e->stages, "index", i);
            return true;
        }
    return false;
}

/* Compares the records that the mesh is stored as. Vertices and indices, which are made from records, are compared
 * first, because they can be related to points. */
static bool records_differ(const camber_mesh_data *g, const camber_mesh_data *e, camber_finding *finding) {
    for (size_t i = 0; i < g->info.record_count && i < e->info.record_count; i++) {
        const camber_record *got = g->records + i, *expected = e->records + i;
        const field_pair fields[] = {FIELD(x), FIELD(y), FIELD(join), FIELD(last)};
        if (take_first(fields, sizeof fields / sizeof *fields, finding)) {
            tell_emit(finding, &(camber_stages){0}, "record", i);
            return true;
        }
    }
    return false;
}

bool camber_mesh_states_differ(const camber_mesh_state *got, const camber_mesh_state *expected,
                               camber_finding *finding) {
    const camber_mesh_info *a = &got->mesh.info, *b = &expected->mesh.info;
    const struct {
        const char *name;
        size_t got, expected;
    } counts[] = {{"records", a->record_count, b->record_count},
                  {"vertices", a->vertex_count, b->vertex_count},
                  {"indices", a->index_count, b->index_count},
                  {"triangles", a->triangle_count, b->triangle_count},
                  {"joins", a->joins, b->joins},
                  {"tight joins", a->tight_joins, b->tight_joins},
                  {"split joins", a->split_joins, b->split_joins},
                  {"undrawn dots", a->undrawn_dots, b->undrawn_dots}};
    *finding = (camber_finding){0};
    if ((got->has_stages && stages_differ(&got->stages, &expected->stages, got->of_network, finding)) ||
        vertices_differ(got, expected, finding) || indices_differ(got, expected, finding) ||
        records_differ(&got->mesh, &expected->mesh, finding))
        return true;
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
        if (counts_differ("emit", counts[i].name, counts[i].got, counts[i].expected, finding))
            return true;
    return false;
}
