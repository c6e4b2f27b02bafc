/* GLB of any polylines in any style: read back by a reader that knows glTF alone, which trusts no number in it.
 *
 *     u8 method | paints << 2 | copyright << 3 | fine << 4, u8 strokes, u8 polylines
 *     strokes: f32 width, f32 miter limit, u8 join | cap << 2; with paints f32 width, four f32 or bytes
 *     copyright: u8 bytes, text
 *     polylines: u8 points, u8 row; points: two i8, or i16 / 16 where fine
 */
#include "fuzz.h"

#include "camber_map.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { STROKES_MAX = 8, POLYLINES_MAX = 255 };

/* ---- Reading the bytes ---- */

typedef struct input {
    camber_stroke strokes[STROKES_MAX];
    camber_paint paints[STROKES_MAX];
    uint32_t offsets[POLYLINES_MAX + 1], rows[POLYLINES_MAX];
    float *points;
    char copyright[256];
    camber_polylines_desc polylines;
    camber_tessellation_desc tessellation;
    camber_glb_desc glb;
} input;

static float take_share(fuzz_reader *from) {
    const unsigned byte = (unsigned)fuzz_take(from, 1);
    return byte == 255 ? fuzz_take_float(from) : (float)byte / 254.0f;
}

static void read_styles(fuzz_reader *from, unsigned head, input *made) {
    const size_t count = 1 + fuzz_take(from, 1) % STROKES_MAX;
    made->glb = (camber_glb_desc){.strokes = made->strokes, .stroke_count = count};
    for (size_t i = 0; i < count; i++) {
        made->strokes[i] = fuzz_take_stroke(from);
        if (!(head & 4))
            continue;
        made->glb.paints = made->paints;
        made->paints[i].width_px = fuzz_take_float(from);
        made->paints[i].color = (camber_color){take_share(from), take_share(from), take_share(from), take_share(from)};
    }
    if (!(head & 8))
        return;
    const size_t length = (size_t)fuzz_take(from, 1);
    for (size_t i = 0; i < length; i++)
        made->copyright[i] = (char)fuzz_take(from, 1);
    made->glb.copyright = made->copyright;
}

static float take_coordinate(fuzz_reader *from, bool fine) {
    return fine ? (float)(int16_t)fuzz_take(from, 2) * (1.0f / 16) : (float)(int8_t)fuzz_take(from, 1);
}

static void read_input(fuzz_reader *from, input *made) {
    const unsigned head = (unsigned)fuzz_take(from, 1);
    memset(made, 0, sizeof *made);
    read_styles(from, head, made);
    const size_t count = (size_t)fuzz_take(from, 1);
    made->points = calloc(from->size + 1, 2 * sizeof *made->points);
    REQUIRE(made->points);
    size_t point = 0;
    for (size_t i = 0; i < count; i++) {
        const size_t points = (size_t)fuzz_take(from, 1);
        made->rows[i] = (uint32_t)(fuzz_take(from, 1) % made->glb.stroke_count);
        for (size_t k = 0; k < points && from->size; k++, point++) {
            made->points[2 * point] = take_coordinate(from, head & 16);
            made->points[2 * point + 1] = take_coordinate(from, head & 16);
        }
        made->offsets[i + 1] = (uint32_t)point;
    }
    made->polylines = (camber_polylines_desc){.points = made->points,
                                              .offsets = made->offsets,
                                              .point_count = point,
                                              .polyline_count = count,
                                              .rows = made->rows};
    made->tessellation =
        (camber_tessellation_desc){made->strokes, made->glb.stroke_count, (camber_method)((head & 3) % 3), 0, false};
}

/* ---- A reader ---- */

typedef struct glb {
    json_t *root;
    const uint8_t *binary; /* NULL: none */
    size_t binary_bytes;
} glb;

static uint32_t word_at(const uint8_t *bytes) {
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static float float_at(const uint8_t *bytes) {
    const uint32_t word = word_at(bytes);
    float number;
    memcpy(&number, &word, sizeof number);
    return number;
}

/* The header, a chunk of JSON and at most one of bytes, each of whole words, and nothing behind. */
static glb open_glb(const fuzz_bytes *file) {
    glb made = {0};
    const uint8_t *bytes = file->bytes;
    REQUIRE(file->size >= 20 && memcmp(bytes, "glTF", 4) == 0 && word_at(bytes + 4) == 2);
    REQUIRE(word_at(bytes + 8) == file->size && file->size % 4 == 0);
    const size_t text_bytes = word_at(bytes + 12), behind = 20 + text_bytes;
    REQUIRE(text_bytes % 4 == 0 && text_bytes <= file->size - 20 && memcmp(bytes + 16, "JSON", 4) == 0);
    made.root = json_loadb((const char *)bytes + 20, text_bytes, JSON_REJECT_DUPLICATES, NULL);
    REQUIRE(json_is_object(made.root));
    if (behind == file->size)
        return made;
    REQUIRE(file->size - behind >= 8 && memcmp(bytes + behind + 4, "BIN", 4) == 0);
    made.binary_bytes = word_at(bytes + behind);
    REQUIRE(made.binary_bytes == file->size - behind - 8);
    made.binary = bytes + behind + 8;
    return made;
}

static size_t get_count(const json_t *object, const char *key) {
    const json_t *value = json_object_get(object, key);
    REQUIRE(json_is_integer(value) && json_integer_value(value) >= 0);
    return (size_t)json_integer_value(value);
}

/* The member that an index names. */
static const json_t *follow(const json_t *from, const char *key, const json_t *root, const char *list) {
    const json_t *found = json_array_get(json_object_get(root, list), get_count(from, key));
    REQUIRE(json_is_object(found));
    return found;
}

typedef struct accessor {
    const json_t *json;
    const uint8_t *first;
    size_t count, stride_bytes, component, columns;
} accessor;

static size_t component_bytes(size_t component) {
    REQUIRE(component == 5122 || component == 5123 || component == 5125 || component == 5126);
    return component >= 5125 ? 4 : 2;
}

static size_t columns_of(const char *type) {
    static const char *const types[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    size_t i = 0;
    while (i < 4 && (!type || strcmp(types[i], type) != 0))
        i++;
    REQUIRE(i < 4);
    return i + 1;
}

/* Within its view, which lies within the buffer, and aligned to its components. */
static accessor open_accessor(const glb *file, const json_t *json) {
    const json_t *view = follow(json, "bufferView", file->root, "bufferViews");
    const json_t *buffer = follow(view, "buffer", file->root, "buffers");
    const size_t view_at = json_object_get(view, "byteOffset") ? get_count(view, "byteOffset") : 0;
    const size_t at = json_object_get(json, "byteOffset") ? get_count(json, "byteOffset") : 0;
    const size_t view_bytes = get_count(view, "byteLength");
    accessor made = {.json = json,
                     .count = get_count(json, "count"),
                     .component = get_count(json, "componentType"),
                     .columns = columns_of(json_string_value(json_object_get(json, "type")))};
    const size_t size = component_bytes(made.component), element = size * made.columns;
    made.stride_bytes = json_object_get(view, "byteStride") ? get_count(view, "byteStride") : element;
    REQUIRE(get_count(buffer, "byteLength") == file->binary_bytes && made.count >= 1);
    REQUIRE(view_at <= file->binary_bytes && view_bytes <= file->binary_bytes - view_at);
    REQUIRE(made.stride_bytes >= element && (view_at + at) % size == 0 && made.stride_bytes % size == 0);
    REQUIRE(at + (made.count - 1) * made.stride_bytes + element <= view_bytes);
    made.first = file->binary + view_at + at;
    return made;
}

/* ---- Requirements ---- */

static void check_floats(const accessor *of) {
    float low[4], high[4];
    for (size_t i = 0; of->component == 5126 && i < of->count; i++)
        for (size_t k = 0; k < of->columns; k++) {
            const float number = float_at(of->first + i * of->stride_bytes + 4 * k);
            REQUIRE(isfinite(number));
            low[k] = i ? fminf(low[k], number) : number;
            high[k] = i ? fmaxf(high[k], number) : number;
        }
    const json_t *least = json_object_get(of->json, "min"), *most = json_object_get(of->json, "max");
    REQUIRE(!least == !most);
    for (size_t k = 0; least && k < of->columns; k++) {
        REQUIRE((float)json_number_value(json_array_get(least, k)) == low[k]);
        REQUIRE((float)json_number_value(json_array_get(most, k)) == high[k]);
    }
}

/* Attributes have a value for each vertex, POSITION its bounds, and _ROW a row that there is. */
static size_t check_attributes(const glb *file, const json_t *primitive, const camber_glb_desc *desc) {
    json_t *attributes = json_object_get(primitive, "attributes");
    const char *name;
    json_t *value;
    size_t vertices = 0;
    REQUIRE(!json_object_get(attributes, "COLOR_0") == !desc->paints && json_object_get(attributes, "POSITION"));
    json_object_foreach(attributes, name, value) {
        const accessor one = open_accessor(file, follow(attributes, name, file->root, "accessors"));
        REQUIRE(vertices == 0 || one.count == vertices);
        REQUIRE(strcmp(name, "POSITION") != 0 || json_object_get(one.json, "min"));
        vertices = one.count;
        check_floats(&one);
        for (size_t i = 0; strcmp(name, "_ROW") == 0 && i < one.count; i++)
            REQUIRE(float_at(one.first + i * one.stride_bytes) < (float)desc->stroke_count);
    }
    return vertices;
}

static void check_indices(const glb *file, const json_t *primitive, const camber_mesh_data *mesh) {
    const accessor of = open_accessor(file, follow(primitive, "indices", file->root, "accessors"));
    const size_t mode = get_count(primitive, "mode"), step = mode == 4 ? 3 : 1;
    size_t drawn = 0;
    REQUIRE((mode == 4 || mode == 5) && of.component == 5125 && of.columns == 1 && of.count >= 3);
    REQUIRE(mode == 5 || of.count % 3 == 0);
    for (size_t i = 0; i < of.count; i++)
        REQUIRE(word_at(of.first + 4 * i) < mesh->info.vertex_count);
    for (size_t i = 0; i + 2 < of.count; i += step) {
        const uint32_t a = word_at(of.first + 4 * i), b = word_at(of.first + 4 * i + 4),
                       c = word_at(of.first + 4 * i + 8);
        drawn += a != b && b != c && a != c;
    }
    REQUIRE(drawn == mesh->info.triangle_count);
}

static void check_file(const fuzz_bytes *bytes, const camber_mesh_data *mesh, const camber_glb_desc *desc) {
    const glb file = open_glb(bytes);
    const json_t *asset = json_object_get(file.root, "asset");
    const char *copyright = json_string_value(json_object_get(asset, "copyright"));
    REQUIRE(strcmp(json_string_value(json_object_get(asset, "version")), "2.0") == 0);
    REQUIRE(!copyright == !desc->copyright && (!copyright || strcmp(copyright, desc->copyright) == 0));
    const json_t *scene = follow(file.root, "scene", file.root, "scenes");
    json_t *nodes = json_object_get(scene, "nodes");
    REQUIRE(!nodes == !file.binary && !nodes == (mesh->info.triangle_count == 0));
    if (nodes) {
        const json_t *node =
            json_array_get(json_object_get(file.root, "nodes"), (size_t)json_integer_value(json_array_get(nodes, 0)));
        const json_t *drawn = follow(node, "mesh", file.root, "meshes");
        const json_t *primitive = json_array_get(json_object_get(drawn, "primitives"), 0);
        const json_t *rows = json_object_get(json_object_get(drawn, "extras"), "rows");
        REQUIRE(json_array_size(rows) == desc->stroke_count);
        follow(primitive, "material", file.root, "materials");
        REQUIRE(check_attributes(&file, primitive, desc) == mesh->info.vertex_count);
        check_indices(&file, primitive, mesh);
    }
    json_decref(file.root);
}

/* ---- All of it ---- */

static void use(fuzz_run *run, const uint8_t *bytes, size_t size) {
    fuzz_reader from = {bytes, size};
    input made;
    camber_polylines *polylines = NULL;
    camber_mesh_data mesh = {0};
    fuzz_bytes file = {0};
    read_input(&from, &made);
    if (fuzz_done(run, camber_polylines_create(run->context, &made.polylines, &polylines)) &&
        fuzz_tessellate(run, polylines, &made.tessellation, &mesh)) {
        if (fuzz_done(run, camber_glb_write(run->context, &mesh, &made.glb, fuzz_sink(&file))))
            check_file(&file, &mesh, &made.glb);
        camber_mesh_data_destroy(&mesh);
    }
    camber_polylines_destroy(polylines);
    free(file.bytes);
    free(made.points);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    fuzz_each(bytes, size, use);
    return 0;
}
