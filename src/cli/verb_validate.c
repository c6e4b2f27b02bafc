/* camber validate: the kernels against the CPU twin, byte for byte, and against themselves. */
#include "cli/input.h"
#include "cli/scenes.h"
#include "cli/verbs.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const join_names[] = {"round", "miter", "bevel"};
static const char *const cap_names[] = {"butt", "round", "square"};

typedef struct subject {
    const char *name;
    const camber_polylines *polylines;
    const float *points; /* as given, to name the point where a difference is */
    const uint32_t *offsets;
    size_t point_count, polyline_count;
    camber_stroke *strokes; /* joins and caps are set by each check */
    size_t stroke_count;
} subject;

typedef struct checker {
    camber_session *session;
    camber_device *device;
    camber_mesh *mesh;
    char device_name[128];
    size_t checks, failures;
    json_t *list; /* of failures */
} checker;

/* ---- One check ---- */

/* The point that a vertex stands on: of those with its coordinates, the one nearest in order, as both are in input
 * order. */
static void place_vertex(const subject *s, const camber_mesh_data *data, size_t index, char *text, size_t size) {
    const camber_vertex *vertex = &data->vertices[index];
    const double expected = (double)index / (double)data->info.vertex_count * (double)s->point_count;
    size_t best = s->point_count;
    double best_distance = 0;
    for (size_t i = 0; i < s->point_count; i++) {
        const double distance = (double)i > expected ? (double)i - expected : expected - (double)i;
        if (memcmp(&s->points[i * 2], &vertex->x, 2 * sizeof(float)) == 0 &&
            (best == s->point_count || distance < best_distance)) {
            best = i;
            best_distance = distance;
        }
    }
    if (best == s->point_count) {
        snprintf(text, size, "vertex %zu at (%.9g, %.9g)", index, (double)vertex->x, (double)vertex->y);
        return;
    }
    size_t low = 0, high = s->polyline_count; /* the last polyline that begins at or before it, and has it */
    while (low + 1 < high) {
        const size_t middle = (low + high) / 2;
        if (s->offsets[middle] <= best)
            low = middle;
        else
            high = middle;
    }
    snprintf(text, size, "polyline %zu, point %zu (vertex %zu)", low, best - s->offsets[low], index);
}

static void name_field(const camber_vertex *a, const camber_vertex *b, char *text, size_t size) {
    const struct {
        const char *name;
        double a, b;
        bool equal;
    } fields[] = {
        {"x", (double)a->x, (double)b->x, memcmp(&a->x, &b->x, 4) == 0},
        {"y", (double)a->y, (double)b->y, memcmp(&a->y, &b->y, 4) == 0},
        {"dx", (double)a->dx, (double)b->dx, memcmp(&a->dx, &b->dx, 4) == 0},
        {"dy", (double)a->dy, (double)b->dy, memcmp(&a->dy, &b->dy, 4) == 0},
        {"along", (double)a->along, (double)b->along, memcmp(&a->along, &b->along, 4) == 0},
        {"limit_px", (double)a->limit_px, (double)b->limit_px, memcmp(&a->limit_px, &b->limit_px, 4) == 0},
        {"across", a->across, b->across, a->across == b->across},
        {"flags", a->flags, b->flags, a->flags == b->flags},
        {"turn_a", a->turn_a, b->turn_a, a->turn_a == b->turn_a},
        {"turn_b", a->turn_b, b->turn_b, a->turn_b == b->turn_b},
        {"row", a->row, b->row, a->row == b->row},
    };
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++)
        if (!fields[i].equal) {
            snprintf(text, size, "%s is %.9g, not %.9g", fields[i].name, fields[i].a, fields[i].b);
            return;
        }
}

/* Whether both meshes are the same bytes; else text says where they first differ. got and wanted are of the device
 * and of the twin, or of two runs. */
static bool same_mesh(const subject *s, const camber_mesh_data *got, const camber_mesh_data *wanted, char *text,
                      size_t size) {
    const camber_mesh_info *a = &got->info, *b = &wanted->info;
    const struct {
        const char *name;
        size_t a, b;
    } counts[] = {{"vertices", a->vertex_count, b->vertex_count},      {"indices", a->index_count, b->index_count},
                  {"triangles", a->triangle_count, b->triangle_count}, {"joins", a->joins, b->joins},
                  {"tight joins", a->tight_joins, b->tight_joins},     {"split joins", a->split_joins, b->split_joins},
                  {"undrawn dots", a->undrawn_dots, b->undrawn_dots}};
    for (size_t i = 0; i < b->vertex_count && i < a->vertex_count; i++)
        if (memcmp(&got->vertices[i], &wanted->vertices[i], sizeof(camber_vertex)) != 0) {
            char place[128], field[128] = "";
            place_vertex(s, wanted, i, place, sizeof place);
            name_field(&got->vertices[i], &wanted->vertices[i], field, sizeof field);
            snprintf(text, size, "%s: %s", place, field);
            return false;
        }
    for (size_t i = 0; i < b->index_count && i < a->index_count; i++)
        if (got->indices[i] != wanted->indices[i]) {
            snprintf(text, size, "index %zu is %u, not %u", i, got->indices[i], wanted->indices[i]);
            return false;
        }
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
        if (counts[i].a != counts[i].b) {
            snprintf(text, size, "%zu %s, not %zu", counts[i].a, counts[i].name, counts[i].b);
            return false;
        }
    return true;
}

static camber_status run_device(checker *c, const subject *s, const camber_tessellation_desc *desc,
                                camber_mesh_data *data) {
    const camber_status status = camber_tessellate(c->mesh, s->polylines, desc);
    return status == CAMBER_OK ? camber_mesh_read(c->mesh, data) : status;
}

static void record(checker *c, bool passed, const char *name, const char *what) {
    c->checks++;
    c->failures += !passed;
    if (c->session->options->json) {
        if (!passed)
            json_array_append_new(c->list,
                                  json_pack("{s:o, s:o, s:o}", "device", camber_json_text(c->device_name), "check",
                                            camber_json_text(name), "difference", camber_json_text(what)));
        return;
    }
    printf("%s %zu - %s\n", passed ? "ok" : "not ok", c->checks, name);
    if (!passed)
        printf("# %s\n", what);
}

static int check(checker *c, const subject *s, const camber_tessellation_desc *desc) {
    camber_context *context = c->session->context;
    camber_mesh_data twin = {0}, first = {0}, second = {0};
    char name[512], what[512] = "";
    snprintf(name, sizeof name, "%s: %s, %s joins, %s caps, on %s", s->name, camber_method_name(desc->method),
             join_names[desc->strokes[0].join], cap_names[desc->strokes[0].cap], c->device_name);
    camber_status status = camber_tessellate_on_host(context, s->polylines, desc, &twin);
    if (status == CAMBER_OK)
        status = run_device(c, s, desc, &first);
    if (status == CAMBER_OK)
        status = run_device(c, s, desc, &second);
    if (status == CAMBER_OK) {
        bool passed = same_mesh(s, &first, &twin, what, sizeof what);
        if (passed && !same_mesh(s, &second, &first, what, sizeof what)) {
            const char prefix[] = "from run to run: ";
            memmove(what + sizeof prefix - 1, what, sizeof what - sizeof prefix + 1);
            memcpy(what, prefix, sizeof prefix - 1);
            what[sizeof what - 1] = 0;
            passed = false;
        }
        record(c, passed, name, what);
    }
    camber_mesh_data_free(context, &second);
    camber_mesh_data_free(context, &first);
    camber_mesh_data_free(context, &twin);
    return camber_report_status(c->session->report, status);
}

/* Every method, join and cap. */
static int check_subject(checker *c, const subject *s) {
    int status = CAMBER_EXIT_DONE;
    for (int i = 0; i < 27 && status == CAMBER_EXIT_DONE; i++) {
        const int method = i / 9;
        if (c->session->options->method >= 0 && c->session->options->method != method)
            continue;
        for (size_t row = 0; row < s->stroke_count; row++) {
            s->strokes[row].join = (camber_join)(i / 3 % 3);
            s->strokes[row].cap = (camber_cap)(i % 3);
        }
        const camber_tessellation_desc desc = {
            .strokes = s->strokes, .stroke_count = s->stroke_count, .method = (camber_method)method};
        status = check(c, s, &desc);
    }
    return status;
}

/* ---- What is checked ---- */

static int check_builtin(checker *c, size_t number) {
    camber_session *session = c->session;
    camber_stroke strokes[CAMBER_SCENE_ROWS] = {{.width_px = 0.3f, .miter_limit = 1},
                                                {.width_px = 2, .miter_limit = 0},
                                                {.width_px = 9, .miter_limit = 10},
                                                {.width_px = 64, .miter_limit = 4}};
    camber_builtin scene;
    camber_polylines *polylines = NULL;
    camber_status made = CAMBER_ERROR_MEMORY;
    if (camber_builtin_make(number, &scene)) {
        const camber_polylines_desc desc = {.points = scene.points,
                                            .point_count = scene.point_count,
                                            .offsets = scene.offsets,
                                            .polyline_count = scene.polyline_count,
                                            .rows = scene.rows};
        made = camber_polylines_create(session->context, &desc, &polylines);
    }
    int status = camber_report_status(session->report, made);
    if (status == CAMBER_EXIT_DONE) {
        const subject s = {scene.name,           polylines, scene.points,     scene.offsets, scene.point_count,
                           scene.polyline_count, strokes,   CAMBER_SCENE_ROWS};
        status = check_subject(c, &s);
    }
    camber_polylines_destroy(polylines);
    camber_builtin_free(&scene);
    return status;
}

static int check_input(checker *c, const camber_input *input) {
    const camber_options *options = c->session->options;
    const camber_lines *lines = camber_input_lines(input);
    size_t count = 0;
    const camber_stroke *given = camber_input_strokes(input, &count);
    camber_stroke *strokes = calloc(count ? count : 1, sizeof *strokes);
    if (!strokes)
        return camber_report_status(c->session->report, CAMBER_ERROR_MEMORY);
    if (count)
        memcpy(strokes, given, count * sizeof *strokes);
    const subject s = {options->polylines     ? options->polylines
                       : options->input_count ? options->inputs[0]
                                              : options->style,
                       camber_input_polylines(input),
                       lines->points,
                       lines->offsets,
                       lines->point_count,
                       lines->polyline_count,
                       strokes,
                       count};
    const int status = check_subject(c, &s);
    free(strokes);
    return status;
}

static int check_device(checker *c, const char *match, const camber_input *input) {
    camber_session *session = c->session;
    const camber_device_desc desc = {.match = match};
    camber_status made = camber_device_create(session->context, &desc, NULL, &c->device);
    if (made == CAMBER_OK) {
        const camber_device_info info = camber_device_get_info(c->device);
        snprintf(c->device_name, sizeof c->device_name, "%s", info.name);
        made = camber_mesh_create(c->device, NULL, &c->mesh);
    }
    int status = camber_report_status(session->report, made);
    const size_t scenes = input ? 1 : camber_builtin_count();
    const bool bars = session->options->json || !isatty(STDOUT_FILENO); /* lines of TAP are progress enough */
    for (size_t i = 0; i < scenes && status == CAMBER_EXIT_DONE; i++) {
        if (bars)
            camber_report_progress(session->report, "checking", (double)i / (double)scenes);
        status = input ? check_input(c, input) : check_builtin(c, i);
    }
    camber_report_erase_bar(session->report);
    camber_mesh_destroy(c->mesh);
    camber_device_destroy(c->device);
    c->mesh = NULL;
    c->device = NULL;
    return status;
}

static int check_devices(checker *c, const camber_input *input) {
    camber_session *session = c->session;
    if (session->options->device)
        return check_device(c, session->options->device, input);
    size_t count = 0;
    camber_status listed = camber_device_list(session->context, 0, NULL, &count);
    if (listed == CAMBER_OK && count < 2)
        return check_device(c, NULL, input); /* none: opening it says why */
    camber_device_info *infos = listed == CAMBER_OK ? calloc(count, sizeof *infos) : NULL;
    const size_t capacity = count;
    if (infos)
        listed = camber_device_list(session->context, capacity, infos, &count);
    else if (listed == CAMBER_OK)
        listed = CAMBER_ERROR_MEMORY;
    int status = camber_report_status(session->report, listed);
    for (size_t i = 0; i < count && i < capacity && status == CAMBER_EXIT_DONE; i++)
        status = check_device(c, infos[i].name, input);
    free(infos);
    return status;
}

int camber_verb_validate(camber_session *session) {
    const camber_options *options = session->options;
    checker c = {.session = session, .list = json_array()};
    camber_input input = {0};
    const bool given = options->polylines || options->input_count || options->style;
    int status = camber_session_need(session, CAMBER_NEEDS_CONTEXT);
    if (status == CAMBER_EXIT_DONE && given)
        status = camber_input_open(&input, session);
    if (status == CAMBER_EXIT_DONE && given)
        status = camber_input_project(&input);
    if (status == CAMBER_EXIT_DONE && given)
        camber_input_warn_empty(&input, "nothing is checked");
    if (status == CAMBER_EXIT_DONE)
        status = check_devices(&c, given ? &input : NULL);
    camber_input_close(&input);
    if (status != CAMBER_EXIT_DONE) {
        json_decref(c.list);
        if (!options->json && c.checks)
            fflush(stdout);
        return status;
    }
    if (options->json) {
        status =
            camber_report_json(session->report, json_pack("{s:o, s:o, s:o}", "checks", camber_json_count(c.checks),
                                                          "failed", camber_json_count(c.failures), "failures", c.list));
    } else {
        json_decref(c.list);
        printf("1..%zu\n", c.checks);
        status = camber_report_flush(session->report);
    }
    return status == CAMBER_EXIT_DONE && c.failures ? CAMBER_EXIT_CHECK : status;
}
