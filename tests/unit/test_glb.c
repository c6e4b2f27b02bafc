/* test_glb [FOLDER]: also writes its files there, for validate_glb.mjs. */
#include "base/base.h"
#include "camber_map.h"
#include "camber_proof.h"

#include <jansson.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

typedef struct file {
    unsigned char *bytes;
    size_t size, capacity, refuse_after;
} file;

typedef struct fixture {
    camber_context *context;
    int errors;
    const char *folder;
} fixture;

static void take_log(void *user, camber_log_level level, const char *message) {
    (void)message;
    ((fixture *)user)->errors += level == CAMBER_LOG_ERROR;
}

static bool take_bytes(void *user, const void *bytes, size_t size) {
    file *f = user;
    if (f->refuse_after && f->size + size > f->refuse_after)
        return false;
    if (f->size + size > f->capacity) {
        f->capacity = 2 * (f->size + size);
        f->bytes = realloc(f->bytes, f->capacity);
        assert_non_null(f->bytes);
    }
    memcpy(f->bytes + f->size, bytes, size);
    f->size += size;
    return true;
}

static camber_sink sink_of(file *f) {
    return (camber_sink){take_bytes, f};
}

/* ---- A reader of its own ---- */

typedef struct glb {
    json_t *json;
    const unsigned char *binary;
    size_t binary_bytes;
} glb;

static uint32_t get_u32(const unsigned char *bytes) {
    uint32_t value;
    memcpy(&value, bytes, 4);
    return value;
}

static glb parse(const file *f) {
    assert_true(f->size >= 20);
    assert_memory_equal(f->bytes, "glTF\2\0\0\0", 8);
    assert_int_equal(get_u32(f->bytes + 8), f->size);
    assert_memory_equal(f->bytes + 16, "JSON", 4);
    const size_t json_bytes = get_u32(f->bytes + 12);
    assert_int_equal(json_bytes % 4, 0);
    glb g = {.json = json_loadb((const char *)f->bytes + 20, json_bytes, 0, NULL)};
    assert_non_null(g.json);
    const size_t at = 20 + json_bytes;
    if (at < f->size) {
        assert_memory_equal(f->bytes + at + 4, "BIN\0", 4);
        g.binary_bytes = get_u32(f->bytes + at);
        g.binary = f->bytes + at + 8;
        assert_int_equal(at + 8 + g.binary_bytes, f->size);
    }
    return g;
}

static json_t *at(json_t *array, size_t i) {
    json_t *value = json_array_get(array, i);
    assert_non_null(value);
    return value;
}

static json_t *get(json_t *object, const char *key) {
    json_t *value = json_object_get(object, key);
    if (!value)
        fail_msg("no %s", key);
    return value;
}

static json_t *primitive_of(const glb *g) {
    return at(get(at(get(g->json, "meshes"), 0), "primitives"), 0);
}

static json_t *accessor_of(const glb *g, const char *attribute) {
    return at(get(g->json, "accessors"),
              (size_t)json_integer_value(get(get(primitive_of(g), "attributes"), attribute)));
}

static size_t integer(json_t *object, const char *key) {
    json_t *value = json_object_get(object, key);
    return value ? (size_t)json_integer_value(value) : 0;
}

/* Component k of element i, as glTF has it: normalised to -1 to 1 where the accessor says so. */
static double element(const glb *g, json_t *accessor, size_t i, size_t k) {
    json_t *view = at(get(g->json, "bufferViews"), integer(accessor, "bufferView"));
    const size_t type = integer(accessor, "componentType");
    const size_t size = type == 5126 || type == 5125 ? 4 : 2;
    const size_t stride = integer(view, "byteStride") ? integer(view, "byteStride") : size;
    const size_t offset = integer(accessor, "byteOffset") + i * stride + k * size;
    assert_int_equal(integer(accessor, "byteOffset") % 4, 0);
    assert_int_equal(stride % 4, 0);
    assert_true(i < integer(accessor, "count"));
    assert_true(offset + size <= integer(view, "byteLength"));
    const unsigned char *bytes = g->binary + integer(view, "byteOffset") + offset;
    const bool normalized = json_is_true(json_object_get(accessor, "normalized"));
    if (type == 5125)
        return get_u32(bytes);
    if (type == 5126) {
        float value;
        memcpy(&value, bytes, 4);
        return (double)value;
    }
    int16_t value;
    memcpy(&value, bytes, 2);
    if (type == 5122)
        return normalized ? value / 32767.0 : value;
    assert_int_equal(type, 5123);
    return normalized ? (uint16_t)value / 65535.0 : (uint16_t)value;
}

typedef struct triangles {
    uint32_t (*at)[3];
    size_t count;
} triangles;

/* Triangles of indices, degenerate ones and those that a mesh does not draw left out; winding and the last vertex as GL
 * has them. */
static triangles list_triangles(const uint32_t *indices, size_t count, bool strips, const camber_mesh_data *mesh) {
    triangles t = {malloc((count + 1) * sizeof *t.at), 0};
    size_t in_strip = 0;
    for (size_t i = 0; i < count; i++) {
        if (strips && indices[i] == UINT32_MAX) {
            in_strip = 0;
            continue;
        }
        in_strip++;
        if (strips ? in_strip < 3 : i % 3 != 2)
            continue;
        const uint32_t a = indices[i - 2], b = indices[i - 1], c = indices[i];
        const bool swap = strips && in_strip % 2 == 0;
        if (a == b || b == c || a == c || (mesh && !camber_mesh_data_draws(mesh, i - 2)))
            continue;
        memcpy(t.at[t.count++], ((uint32_t[]){swap ? b : a, swap ? a : b, c}), sizeof *t.at);
    }
    return t;
}

/* ---- Checks ---- */

static void check_indices(const glb *g, const camber_mesh_data *mesh) {
    json_t *accessor = at(get(g->json, "accessors"), integer(primitive_of(g), "indices"));
    assert_int_equal(integer(accessor, "componentType"), 5125);
    const size_t count = integer(accessor, "count");
    uint32_t *indices = malloc((count + 1) * sizeof *indices);
    for (size_t i = 0; i < count; i++) {
        indices[i] = (uint32_t)element(g, accessor, i, 0);
        assert_true(indices[i] < mesh->info.vertex_count);
    }
    const bool strips = integer(primitive_of(g), "mode") == 5;
    assert_int_equal(strips, mesh->info.strips);
    if (!strips)
        assert_int_equal(integer(primitive_of(g), "mode"), 4);
    const triangles wanted = list_triangles(mesh->indices, mesh->info.index_count, mesh->info.strips, mesh);
    const triangles found = list_triangles(indices, count, strips, NULL);
    assert_true(wanted.count > 0);
    assert_int_equal(found.count, wanted.count);
    assert_memory_equal(found.at, wanted.at, found.count * sizeof *found.at);
    free(found.at);
    free(wanted.at);
    free(indices);
}

/* The outline, by angles instead of unit vectors. */
static void outline(const camber_vertex *v, const camber_stroke *stroke, double *x, double *y) {
    const double half = (double)stroke->width_px / 2, angle = atan2((double)v->dy, (double)v->dx);
    const unsigned ends[2] = {v->flags & 7u, v->flags >> 3 & 7u};
    double along = (double)v->along * half;
    if (fabs(along) > (double)v->limit_px)
        along = copysign((double)v->limit_px, along);
    if (ends[v->flags >> 6 & 1] == CAMBER_END_BUTT)
        along = 0;
    const double across = v->across / 16384.0 * half;
    *x = (double)v->x + along * cos(angle) - across * sin(angle);
    *y = -((double)v->y + along * sin(angle) + across * cos(angle));
}

static void check_vertices(const glb *g, const camber_mesh_data *mesh, const camber_stroke *strokes) {
    json_t *position = accessor_of(g, "POSITION");
    assert_int_equal(integer(position, "count"), mesh->info.vertex_count);
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < mesh->info.vertex_count; i++) {
        const camber_vertex *v = mesh->vertices + i;
        double x, y;
        outline(v, strokes + v->row, &x, &y);
        const double tolerance = 1e-6 * (1.0 + hypot(x, y));
        assert_true(fabs(element(g, position, i, 0) - x) <= tolerance);
        assert_true(fabs(element(g, position, i, 1) - y) <= tolerance);
        assert_true(element(g, position, i, 2) == 0.0);
        for (size_t k = 0; k < 3; k++) {
            low[k] = fmin(low[k], element(g, position, i, k));
            high[k] = fmax(high[k], element(g, position, i, k));
        }
        assert_true(element(g, accessor_of(g, "_CENTER"), i, 0) == (double)v->x);
        assert_true(element(g, accessor_of(g, "_CENTER"), i, 1) == -(double)v->y);
        assert_true(element(g, accessor_of(g, "_SEGMENT"), i, 0) == (double)v->dx);
        assert_true(element(g, accessor_of(g, "_SEGMENT"), i, 1) == -(double)v->dy);
        assert_true(element(g, accessor_of(g, "_EXTRUDE"), i, 0) == (double)v->along);
        assert_true(element(g, accessor_of(g, "_EXTRUDE"), i, 1) == -v->across / 16384.0);
        assert_true(element(g, accessor_of(g, "_EXTRUDE"), i, 2) == (double)v->limit_px);
        assert_true(element(g, accessor_of(g, "_TURN"), i, 0) == -v->turn_a / 32767.0);
        assert_true(element(g, accessor_of(g, "_TURN"), i, 1) == -v->turn_b / 32767.0);
        assert_true(element(g, accessor_of(g, "_ROW"), i, 0) == v->row);
        assert_true(element(g, accessor_of(g, "_FLAGS"), i, 0) == v->flags);
    }
    for (size_t k = 0; k < 3; k++) {
        assert_true(json_number_value(at(get(position, "min"), k)) == low[k]);
        assert_true(json_number_value(at(get(position, "max"), k)) == high[k]);
    }
}

static void save(const fixture *f, const file *glb_file, const char *name) {
    if (!f->folder)
        return;
    char path[1024];
    snprintf(path, sizeof path, "%s/%s.glb", f->folder, name);
    FILE *out = fopen(path, "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(glb_file->bytes, 1, glb_file->size, out), glb_file->size);
    assert_int_equal(fclose(out), 0);
}

/* ---- Scenes ---- */

#define STROKES 9

static void make_strokes(camber_stroke *strokes, camber_paint *paints) {
    for (unsigned i = 0; i < STROKES; i++) {
        strokes[i] =
            (camber_stroke){0.7f + 3.0f * (float)i, (camber_join)(i % 3), (camber_cap)(i / 3), (float)(i % 2) * 4};
        if (i == 7)
            strokes[i].miter_limit = INFINITY; /* which JSON does not have */
        paints[i] =
            (camber_paint){.width_px = strokes[i].width_px, .color = {0.5f, (float)i / 8, 1.0f, i == 4 ? 0.5f : 1.0f}};
    }
}

static camber_mesh_data tessellate(const fixture *f, const camber_polylines_desc *lines, const camber_stroke *strokes,
                                   size_t stroke_count, camber_method method) {
    camber_polylines *polylines = NULL;
    assert_int_equal(camber_polylines_create(f->context, lines, &polylines), CAMBER_OK);
    camber_mesh_data mesh;
    const camber_tessellation_desc desc = {.strokes = strokes, .stroke_count = stroke_count, .method = method};
    assert_int_equal(camber_mesh_data_tessellate(f->context, polylines, &desc, &mesh), CAMBER_OK);
    camber_polylines_destroy(polylines);
    return mesh;
}

/* Random walks, a third of them rings, some dots, with sharp and tight turns. */
static void test_random_lines(void **state) {
    const fixture *f = *state;
    enum { LINES = 200 };
    static const char *const names[] = {"strip", "kite", "fan"};
    float points[2 * 12 * LINES];
    uint32_t offsets[LINES + 1] = {0}, rows[LINES], seed = 7;
    for (uint32_t i = 0; i < LINES; i++) {
        const uint32_t count = 1 + i % 12, first = offsets[i];
        for (uint32_t k = 0; k < 2 * count; k++) {
            seed = seed * 1664525u + 1013904223u;
            points[2 * first + k] = (float)(seed >> 8) / 16777216.0f * (i % 2 ? 500.0f : 9.0f);
        }
        if (count > 3 && i % 3 == 0)
            memcpy(points + 2 * (first + count - 1), points + 2 * first, 2 * sizeof *points);
        offsets[i + 1] = first + count;
        rows[i] = i % STROKES;
    }
    camber_stroke strokes[STROKES];
    camber_paint paints[STROKES];
    make_strokes(strokes, paints);
    const camber_polylines_desc lines = {
        .points = points, .point_count = offsets[LINES], .offsets = offsets, .polyline_count = LINES, .rows = rows};
    for (int method = 0; method < 3; method++) {
        camber_mesh_data mesh = tessellate(f, &lines, strokes, STROKES, (camber_method)method);
        for (int painted = 0; painted < 2; painted++) {
            const camber_glb_desc desc = {strokes, painted ? paints : NULL, STROKES,
                                          painted ? "\xc2\xa9 someone" : NULL};
            file bytes = {0};
            assert_int_equal(camber_glb_write(f->context, &mesh, &desc, sink_of(&bytes)), CAMBER_OK);
            const glb g = parse(&bytes);
            check_indices(&g, &mesh);
            check_vertices(&g, &mesh, strokes);
            json_t *rows_json = get(get(at(get(g.json, "meshes"), 0), "extras"), "rows");
            assert_int_equal(json_array_size(rows_json), STROKES);
            assert_string_equal(json_string_value(get(at(rows_json, 5), "join")), "bevel");
            assert_string_equal(json_string_value(get(at(rows_json, 5), "cap")), "round");
            assert_true(json_number_value(get(at(rows_json, 5), "width")) == (double)strokes[5].width_px);
            assert_true(json_number_value(get(at(rows_json, 4), "miterLimit")) == 2.0);
            assert_true(json_number_value(get(at(rows_json, 7), "miterLimit")) > 3e38);
            assert_int_equal(json_object_get(get(primitive_of(&g), "attributes"), "COLOR_0") != NULL, painted);
            char name[64];
            snprintf(name, sizeof name, "%s%s", names[method], painted ? "_painted" : "");
            save(f, &bytes, name);
            json_decref(g.json);
            free(bytes.bytes);
        }
        camber_mesh_data_destroy(&mesh);
    }
}

/* A square and a triangle of another layer, with lines above them and alone. */
static void test_areas(void **state) {
    const fixture *f = *state;
    float corners[] = {10, 10, 60, 10, 60, 60, 10, 60, 20, 20, 30, 20, 20, 30};
    uint32_t indices[] = {0, 2, 1, 0, 3, 2, 4, 6, 5};
    camber_area_fill fills[] = {{"water", 0, {0.0f, 0.5f, 1.0f, 1.0f}, 0, 4, 0, 6},
                                {"wood", 1, {0.0f, 1.0f, 0.0f, 0.5f}, 4, 3, 6, 3}};
    const camber_area_data areas = {f->context, corners, 7, indices, 9, fills, 2};
    const float points[] = {10, 20, 60, 20, 60, 90};
    const uint32_t offsets[] = {0, 3};
    const camber_polylines_desc lines = {.points = points, .point_count = 3, .offsets = offsets, .polyline_count = 1};
    const camber_stroke stroke = {.width_px = 10};
    camber_mesh_data mesh = tessellate(f, &lines, &stroke, 1, CAMBER_METHOD_STRIP), none = {.context = f->context};
    for (int alone = 0; alone < 2; alone++) {
        file bytes = {0};
        const camber_glb_desc desc = {.strokes = &stroke, .stroke_count = 1, .areas = &areas};
        assert_int_equal(camber_glb_write(f->context, alone ? &none : &mesh, &desc, sink_of(&bytes)), CAMBER_OK);
        const glb g = parse(&bytes);
        json_t *primitives = get(at(get(g.json, "meshes"), 0), "primitives"),
               *made = get(get(at(primitives, 0), "extras"), "fills");
        assert_int_equal(json_array_size(primitives), alone ? 1 : 2);
        assert_string_equal(json_string_value(get(at(made, 1), "layer")), "wood");
        assert_int_equal(json_integer_value(at(get(at(made, 1), "indices"), 0)), 6);
        json_t *position = accessor_of(&g, "POSITION"), *color = accessor_of(&g, "COLOR_0");
        assert_int_equal(integer(position, "count"), 7);
        for (size_t i = 0; i < 7; i++) {
            assert_true(element(&g, position, i, 0) == (double)corners[2 * i]);
            assert_true(element(&g, position, i, 1) == -(double)corners[2 * i + 1]);
            assert_true(element(&g, position, i, 2) == (i < 4 ? -2.0 : -1.0));
        }
        assert_true(json_number_value(at(get(position, "min"), 2)) == -2.0);
        assert_true(json_number_value(at(get(position, "max"), 2)) == -1.0);
        assert_true(fabs(element(&g, color, 0, 1) - 0.21404) < 1e-4 && fabs(element(&g, color, 6, 3) - 0.5) < 1e-4);
        json_t *taken = at(get(g.json, "accessors"), integer(primitive_of(&g), "indices"));
        for (size_t i = 0; i < 9; i++)
            assert_true((uint32_t)element(&g, taken, i, 0) == indices[i]);
        json_t *material = at(get(g.json, "materials"), integer(primitive_of(&g), "material"));
        assert_string_equal(json_string_value(get(material, "alphaMode")), "BLEND");
        save(f, &bytes, alone ? "areas_alone" : "areas");
        json_decref(g.json);
        free(bytes.bytes);
    }
    fills[1].color.g = INFINITY;
    file bytes = {0};
    const camber_glb_desc desc = {.areas = &areas};
    assert_int_equal(camber_glb_write(f->context, &none, &desc, sink_of(&bytes)), CAMBER_ERROR_ARGUMENT);
    free(bytes.bytes);
    camber_mesh_data_destroy(&mesh);
}

/* Turns are stored in 16 bits, which moves a corner by up to 2e-4 px here. */
static bool has_position(const glb *g, double x, double y) {
    json_t *position = accessor_of(g, "POSITION");
    for (size_t i = 0; i < integer(position, "count"); i++)
        if (fabs(element(g, position, i, 0) - x) < 1e-3 && fabs(element(g, position, i, 1) - y) < 1e-3)
            return true;
    return false;
}

/* The corners of an L of width 10, by hand: the mitre's tips, butt ends at the end points, square ends 5 past. */
static void test_outline_by_hand(void **state) {
    const fixture *f = *state;
    const float points[] = {10, 20, 60, 20, 60, 90};
    const uint32_t offsets[] = {0, 3};
    const camber_polylines_desc lines = {.points = points, .point_count = 3, .offsets = offsets, .polyline_count = 1};
    for (int square = 0; square < 2; square++) {
        const camber_stroke stroke = {10, CAMBER_JOIN_MITER, square ? CAMBER_CAP_SQUARE : CAMBER_CAP_BUTT, 2};
        const camber_paint paint = {.width_px = 10, .color = {1.0f, 0.5f, 0.0f, 1.0f}};
        camber_mesh_data mesh = tessellate(f, &lines, &stroke, 1, CAMBER_METHOD_STRIP);
        file bytes = {0};
        assert_int_equal(
            camber_glb_write(f->context, &mesh, &(camber_glb_desc){&stroke, &paint, 1, NULL}, sink_of(&bytes)),
            CAMBER_OK);
        const glb g = parse(&bytes);
        const double past = square ? 5 : 0;
        const double corners[6][2] = {{10 - past, -15}, {10 - past, -25}, {65, -15},
                                      {55, -25},        {55, -90 - past}, {65, -90 - past}};
        for (size_t i = 0; i < 6; i++)
            if (!has_position(&g, corners[i][0], corners[i][1]))
                fail_msg("no vertex at %g, %g", corners[i][0], corners[i][1]);
        json_t *position = accessor_of(&g, "POSITION");
        assert_true(fabs(json_number_value(at(get(position, "min"), 0)) - (10 - past)) < 1e-4);
        assert_true(fabs(json_number_value(at(get(position, "max"), 1)) + 15) < 1e-4);
        /* sRGB 0.5 is 0.21404 linear. */
        assert_true(fabs(element(&g, accessor_of(&g, "COLOR_0"), 0, 0) - 1.0) < 1e-4);
        assert_true(fabs(element(&g, accessor_of(&g, "COLOR_0"), 0, 1) - 0.21404) < 1e-4);
        assert_true(fabs(element(&g, accessor_of(&g, "COLOR_0"), 0, 3) - 1.0) < 1e-4);
        json_t *material = at(get(g.json, "materials"), 0);
        assert_string_equal(json_string_value(get(material, "alphaMode")), "OPAQUE");
        assert_true(json_is_true(get(material, "doubleSided")));
        json_decref(g.json);
        free(bytes.bytes);
        camber_mesh_data_destroy(&mesh);
    }
}

/* Strips of every length from 0 to 6, in all orders of two, with empty strips between and around. */
static void test_restarts(void **state) {
    const fixture *f = *state;
    camber_vertex vertices[16];
    memset(vertices, 0, sizeof vertices);
    for (size_t i = 0; i < 16; i++)
        vertices[i] = (camber_vertex){.x = (float)i, .y = (float)(i * i), .dx = 1, .limit_px = 3e38f};
    const camber_stroke stroke = {2, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0};
    for (uint32_t code = 0; code < 7 * 7 * 2; code++) {
        uint32_t indices[64];
        size_t count = 0;
        if (code >= 49)
            indices[count++] = UINT32_MAX;
        const uint32_t lengths[4] = {code % 7, 3 + code % 3, code / 7 % 7, 4};
        for (uint32_t s = 0; s < 4; s++) {
            for (uint32_t i = 0; i < lengths[s]; i++)
                indices[count++] = 4 * s + i < 16 ? 4 * s + i : 15 - i;
            indices[count++] = UINT32_MAX;
        }
        camber_mesh_data mesh = {.vertices = vertices, .indices = indices};
        mesh.info.strips = true;
        mesh.info.vertex_count = 16;
        mesh.info.index_count = count - (code % 2); /* the last restart may be missing */
        file bytes = {0};
        assert_int_equal(camber_glb_write(f->context, &mesh, &(camber_glb_desc){.strokes = &stroke, .stroke_count = 1},
                                          sink_of(&bytes)),
                         CAMBER_OK);
        const glb g = parse(&bytes);
        check_indices(&g, &mesh);
        json_decref(g.json);
        free(bytes.bytes);
    }
}

static void test_empty(void **state) {
    const fixture *f = *state;
    camber_vertex vertex = {.limit_px = 1};
    uint32_t two[2] = {0, 0};
    for (int vertices = 0; vertices < 2; vertices++) {
        camber_mesh_data mesh = {.vertices = &vertex, .indices = two};
        mesh.info.strips = true;
        mesh.info.vertex_count = (size_t)vertices;
        mesh.info.index_count = 2 * (size_t)vertices;
        file bytes = {0};
        assert_int_equal(
            camber_glb_write(f->context, &mesh, &(camber_glb_desc){.copyright = "someone"}, sink_of(&bytes)),
            CAMBER_OK);
        const glb g = parse(&bytes);
        assert_null(json_object_get(g.json, "meshes"));
        assert_null(json_object_get(g.json, "accessors"));
        assert_null(g.binary);
        char generator[64];
        snprintf(generator, sizeof generator, "camber %s", camber_version());
        assert_string_equal(json_string_value(get(get(g.json, "asset"), "generator")), generator);
        assert_string_equal(json_string_value(get(get(g.json, "asset"), "version")), "2.0");
        assert_string_equal(json_string_value(get(get(g.json, "asset"), "copyright")), "someone");
        save(f, &bytes, "empty");
        json_decref(g.json);
        free(bytes.bytes);
    }
}

static void test_failures(void **state) {
    fixture *f = *state;
    const float points[] = {10, 20, 60, 20, 60, 90};
    const uint32_t offsets[] = {0, 3};
    const camber_stroke stroke = {10, CAMBER_JOIN_ROUND, CAMBER_CAP_ROUND, 0};
    const camber_glb_desc desc = {.strokes = &stroke, .stroke_count = 1};
    camber_mesh_data mesh = tessellate(
        f, &(camber_polylines_desc){.points = points, .point_count = 3, .offsets = offsets, .polyline_count = 1},
        &stroke, 1, CAMBER_METHOD_STRIP);
    file whole = {0}, refused = {.refuse_after = 10};
    assert_int_equal(camber_glb_write(f->context, &mesh, &desc, sink_of(&whole)), CAMBER_OK);
    assert_int_equal(camber_glb_write(f->context, &mesh, &desc, sink_of(&refused)), CAMBER_ERROR_IO);

    f->errors = 0;
    const camber_glb_desc latin = {.strokes = &stroke, .stroke_count = 1, .copyright = "\xa9 someone"};
    assert_int_equal(camber_glb_write(f->context, &mesh, &latin, sink_of(&whole)), CAMBER_ERROR_ARGUMENT);
    assert_int_equal(f->errors, 1);
    const camber_paint endless = {.width_px = 1, .color = {0, INFINITY, 0, 1}};
    const camber_glb_desc bright = {.strokes = &stroke, .stroke_count = 1, .paints = &endless};
    assert_int_equal(camber_glb_write(f->context, &mesh, &bright, sink_of(&whole)), CAMBER_ERROR_ARGUMENT);
    assert_int_equal(f->errors, 2);

    camber_mesh_data huge = mesh;
    huge.info.vertex_count = (size_t)1 << 27;
    const size_t before = whole.size;
    assert_int_equal(camber_glb_write(f->context, &huge, &desc, sink_of(&whole)), CAMBER_ERROR_LIMIT);
    assert_int_equal(f->errors, 3);
    assert_int_equal(whole.size, before);
    free(whole.bytes);
    free(refused.bytes);
    camber_mesh_data_destroy(&mesh);
}

int main(int argc, char **argv) {
    fixture f = {.folder = argc > 1 ? argv[1] : NULL};
    if (camber_context_create(&(camber_context_desc){.log = take_log, .log_user = &f, .cache_dir = ""}, &f.context) !=
        CAMBER_OK)
        return 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(test_areas, &f),           cmocka_unit_test_prestate(test_random_lines, &f),
        cmocka_unit_test_prestate(test_outline_by_hand, &f), cmocka_unit_test_prestate(test_restarts, &f),
        cmocka_unit_test_prestate(test_empty, &f),           cmocka_unit_test_prestate(test_failures, &f),
    };
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    camber_context_destroy(f.context);
    return failed;
}
