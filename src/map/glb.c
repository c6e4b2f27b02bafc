/* Writes a mesh as binary glTF 2.0.
 *
 * The file has one node with one mesh. Its lines are one primitive: TRIANGLES, or a TRIANGLE_STRIP in which degenerate
 * triangles replace the restarts (glTF has no restart index, and as a list of triangles the indices would take three
 * times the space). x points right, y up, z is 0, one unit is a device pixel, and the origin is the picture's top left:
 * everything is camber_vertex mirrored at y = 0. The formulas of camber.h hold unchanged in the mirrored frame.
 *
 * Areas, if there are any, are another primitive before it, of TRIANGLES, with POSITION and COLOR_0. Layers of areas
 * are at z = -1, -2 and so on, so that viewers show the first one lowest and the lines above all of them. The
 * primitive's extras.fills has {layer, color: straight sRGB RGBA, indices: [first, count]} in drawing order. The
 * triangles of a fill do not overlap.
 *
 * Attributes of lines, interleaved:
 *     POSITION  VEC3 float      the stroke's true outline: the formula of camber_vertex with g = half the stroke's
 *                               width. Vertices at a butt end are on the normal of the end point, because the limit
 *                               that they carry is padding for anti-aliasing, which an outline does not have. Round
 *                               caps and joins are the boxes and kites that the arcs are drawn in.
 *     _CENTER   VEC2 float      P, the end of the segment that the vertex belongs to
 *     _SEGMENT  VEC2 float      B - A; 0, 0 for a dot
 *     _EXTRUDE  VEC3 float      along and across in units of g, and the limit of along * g in pixels (3e38: none)
 *     _TURN     VEC2 short, normalised   tan(turn angle / 4) at A and at B, positive counter-clockwise as seen
 *     _ROW      SCALAR float    row of the style table. Rows are below 2^24, so a float holds them exactly (glTF
 *                               allows no 32-bit integers here)
 *     _FLAGS    SCALAR unsigned short    camber_vertex.flags: bits 0-2 the end at A, 3-5 at B (camber_end), 6: P is B,
 *                               7, 8: the line begins or ends one segment further
 *     COLOR_0   VEC4 unsigned short, normalised   the row's paint, linear as glTF requires; absent without paints
 *
 * In both modes the last (provoking) vertex of a triangle carries the segment that the triangle draws. mesh.extras.rows
 * is the style table: {width, join, cap, miterLimit, paint: {width, color: straight sRGB RGBA}}. A mesh without
 * vertices becomes a file with an empty scene, because glTF allows no empty accessors. */
#include "base/base.h"
#include "base/maths.h"
#include "camber_map.h"
#include "camber_proof.h"

#include <assert.h>
#include <float.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* glTF's constants, which are the same as OpenGL's. */
enum {
    GLTF_SHORT = 5122,
    GLTF_UNSIGNED_SHORT = 5123,
    GLTF_UNSIGNED_INT = 5125,
    GLTF_FLOAT = 5126,
    GLTF_ARRAY_BUFFER = 34962,
    GLTF_ELEMENT_ARRAY_BUFFER = 34963,
    AREA_STRIDE = 20, /* POSITION and COLOR_0 of areas */
    GLTF_TRIANGLES = 4,
    GLTF_TRIANGLE_STRIP = 5,
};

typedef struct attribute {
    const char *name, *type;
    int component, offset_bytes;
    bool normalized;
} attribute;

static const attribute ATTRIBUTES[] = {
    {"POSITION", "VEC3", GLTF_FLOAT, 0, false},
    {"_CENTER", "VEC2", GLTF_FLOAT, 12, false},
    {"_SEGMENT", "VEC2", GLTF_FLOAT, 20, false},
    {"_EXTRUDE", "VEC3", GLTF_FLOAT, 28, false},
    {"_TURN", "VEC2", GLTF_SHORT, 40, true},
    {"_ROW", "SCALAR", GLTF_FLOAT, 44, false},
    {"_FLAGS", "SCALAR", GLTF_UNSIGNED_SHORT, 48, false},
    {"COLOR_0", "VEC4", GLTF_UNSIGNED_SHORT, 52, true},
};
#define ATTRIBUTE_COUNT (sizeof ATTRIBUTES / sizeof *ATTRIBUTES)
#define PLAIN_STRIDE 52 /* without COLOR_0, which is last */
#define COLORED_STRIDE 60

#define BLOCK_BYTES 65536
#define AT_END 64u /* camber_vertex.flags */

typedef struct writer {
    camber_context *context;
    const camber_mesh_data *mesh;
    const camber_glb_desc *desc;
    camber_sink sink;
    unsigned char *block; /* BLOCK_BYTES */
    size_t used;
    uint64_t taken, total; /* bytes */
    bool refused;
    float low[3], high[3];                 /* bounds of POSITION */
    uint64_t index_count;                  /* as written, with restarts replaced */
    uint64_t line_bytes[2], area_bytes[2]; /* of vertices and indices */
} writer;

/* ---- Bytes ---- */

static void flush(writer *w) {
    if (w->used && !w->refused)
        w->refused = !w->sink.write(w->sink.user, w->block, w->used);
    w->taken += w->used;
    w->used = 0;
    if (w->total)
        camber_progress(w->context, "writing", (double)w->taken / (double)w->total);
}

/* Makes room in the block for size_bytes, which is at most BLOCK_BYTES. */
static void want(writer *w, size_t size_bytes) {
    if (w->used + size_bytes > BLOCK_BYTES)
        flush(w);
}

static void put_u16(writer *w, uint16_t value) {
    w->block[w->used++] = (unsigned char)(value & 0xff);
    w->block[w->used++] = (unsigned char)(value >> 8);
}

static void put_u32(writer *w, uint32_t value) {
    put_u16(w, (uint16_t)(value & 0xffff));
    put_u16(w, (uint16_t)(value >> 16));
}

static void put_f32(writer *w, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_u32(w, bits);
}

/* ---- Vertices ---- */

/* Mirrors y, and returns 0 rather than -0. */
static float up(float y) {
    return 0.0f - y;
}

static void position_of(const writer *w, const camber_vertex *v, float *position) {
    assert(v->row < w->desc->stroke_count);
    const double h = 0.5 * (double)w->desc->strokes[v->row].width_px;
    const double length = camber_length((double)v->dx, (double)v->dy);
    const double ux = length > 0.0 ? (double)v->dx / length : 1.0, uy = length > 0.0 ? (double)v->dy / length : 0.0;
    const double limit = (double)v->limit_px;
    const unsigned end = (v->flags & AT_END ? v->flags >> 3 : v->flags) & 7u;
    const double along = end == CAMBER_END_BUTT ? 0.0 : fmin(fmax((double)v->along * h, -limit), limit);
    const double across = (double)v->across / 16384.0 * h;
    position[0] = (float)((double)v->x + ux * along - uy * across);
    position[1] = up((float)((double)v->y + uy * along + ux * across));
    position[2] = 0.0f;
}

static void measure(writer *w) {
    for (int k = 0; k < 3; k++) {
        w->low[k] = FLT_MAX;
        w->high[k] = -FLT_MAX;
    }
    for (size_t i = 0; i < w->mesh->info.vertex_count; i++) {
        float position[3];
        position_of(w, w->mesh->vertices + i, position);
        for (int k = 0; k < 3; k++) {
            w->low[k] = fminf(w->low[k], position[k]);
            w->high[k] = fmaxf(w->high[k], position[k]);
        }
    }
}

/* sRGB's transfer function, IEC 61966-2-1. */
static double linear_of(double c) {
    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

static uint16_t normalized_of(double c) {
    return (uint16_t)(fmin(fmax(c, 0.0), 1.0) * 65535.0 + 0.5);
}

static void make_color(camber_color c, uint16_t *color) {
    color[0] = normalized_of(linear_of((double)c.r));
    color[1] = normalized_of(linear_of((double)c.g));
    color[2] = normalized_of(linear_of((double)c.b));
    color[3] = normalized_of((double)c.a);
}

/* Converts the paints to COLOR_0. NULL: out of memory. */
static uint16_t *make_colors(const writer *w) {
    uint16_t *colors = camber_alloc(w->context, w->desc->stroke_count, 4 * sizeof *colors);
    for (size_t i = 0; colors && i < w->desc->stroke_count; i++)
        make_color(w->desc->paints[i].color, colors + 4 * i);
    return colors;
}

static void put_vertices(writer *w, const uint16_t *colors) {
    for (size_t i = 0; i < w->mesh->info.vertex_count && !w->refused; i++) {
        const camber_vertex *v = w->mesh->vertices + i;
        float position[3];
        position_of(w, v, position);
        want(w, COLORED_STRIDE);
        for (int k = 0; k < 3; k++)
            put_f32(w, position[k]);
        put_f32(w, v->x);
        put_f32(w, up(v->y));
        put_f32(w, v->dx);
        put_f32(w, up(v->dy));
        put_f32(w, v->along);
        put_f32(w, up((float)v->across / 16384.0f));
        put_f32(w, v->limit_px);
        put_u16(w, (uint16_t)-v->turn_a);
        put_u16(w, (uint16_t)-v->turn_b);
        put_f32(w, (float)v->row);
        put_u16(w, v->flags);
        put_u16(w, 0);
        for (size_t k = 0; colors && k < 4; k++)
            put_u16(w, colors[4 * v->row + k]);
    }
}

/* ---- Areas ---- */

/* Returns the height of a fill. The topmost layer is at -1. */
static float height_of(const camber_area_data *areas, const camber_area_fill *fill) {
    return (float)fill->level - (float)areas->fills[areas->fill_count - 1].level - 1.0f;
}

static void put_areas(writer *w) {
    const camber_area_data *areas = w->desc->areas;
    for (size_t i = 0; i < areas->fill_count && !w->refused; i++) {
        const camber_area_fill *fill = areas->fills + i;
        uint16_t color[4];
        make_color(fill->color, color);
        for (size_t k = fill->first_point; k < fill->first_point + fill->point_count && !w->refused; k++) {
            want(w, AREA_STRIDE);
            put_f32(w, areas->points[2 * k]);
            put_f32(w, up(areas->points[2 * k + 1]));
            put_f32(w, height_of(areas, fill));
            for (size_t c = 0; c < 4; c++)
                put_u16(w, color[c]);
        }
    }
    for (size_t i = 0; i < areas->index_count && !w->refused; i++) {
        want(w, 4);
        put_u32(w, areas->indices[i]);
    }
}

/* ---- Indices ---- */

static void put_index(writer *w, uint32_t index, bool count_only) {
    w->index_count++;
    if (count_only)
        return;
    want(w, 4);
    put_u32(w, index);
}

/* Finds the end of the strip that begins at an index: a restart, or the position where the start of a tight join
 * follows its end. */
static size_t strip_end(const camber_mesh_data *mesh, size_t first) {
    const size_t count = mesh->info.index_count;
    size_t end = first;
    if (!mesh->info.strips)
        return count;
    for (; end < count && mesh->indices[end] != CAMBER_RESTART_INDEX; end++) {
        const uint32_t *pair = mesh->indices + end;
        const bool has_before = end % 2 == 0 && end >= first + 2;
        if (has_before && (pair[-2] == pair[0] || (end + 1 < count && pair[-1] == pair[1])))
            break;
    }
    return end;
}

/* Joins two strips a and b into one without drawing anything between them, by repeating the last index of a and the
 * first of b. The first of b is repeated twice if b's triangles would otherwise move from even to odd positions, which
 * would reverse their winding. */
static void put_indices(writer *w, bool count_only) {
    const uint32_t *indices = w->mesh->indices;
    const size_t count = w->mesh->info.index_count;
    uint32_t last = 0; /* written */
    w->index_count = 0;
    for (size_t first = 0, end; first < count && !w->refused; first = end) {
        end = strip_end(w->mesh, first);
        if (end == first)
            end++;
        if (end - first < 3)
            continue;
        if (w->index_count) {
            put_index(w, last, count_only);
            if (w->index_count % 2 == 0)
                put_index(w, indices[first], count_only);
            put_index(w, indices[first], count_only);
        }
        for (size_t i = first; i < end; i++)
            put_index(w, indices[i], count_only);
        last = indices[end - 1];
    }
}

/* ---- JSON ---- */

/* Sets ok to false if memory runs out. value may be NULL, because jansson passes NULL on. */
static void set(json_t *object, const char *key, json_t *value, bool *ok) {
    *ok &= json_object_set_new(object, key, value) == 0;
}

static void append(json_t *array, json_t *value, bool *ok) {
    *ok &= json_array_append_new(array, value) == 0;
}

static const char *join_name(camber_join join) {
    return join == CAMBER_JOIN_MITER ? "miter" : join == CAMBER_JOIN_BEVEL ? "bevel" : "round";
}

static const char *cap_name(camber_cap cap) {
    return cap == CAMBER_CAP_ROUND ? "round" : cap == CAMBER_CAP_SQUARE ? "square" : "butt";
}

static json_t *style_table(const camber_glb_desc *desc, bool *ok) {
    json_t *rows = json_array();
    for (size_t i = 0; i < desc->stroke_count; i++) {
        const camber_stroke *stroke = desc->strokes + i;
        /* JSON has no infinity. */
        const double limit = stroke->miter_limit > 0.0f ? fmin((double)stroke->miter_limit, (double)FLT_MAX) : 2.0;
        json_t *row = json_pack("{s:f, s:s, s:s, s:f}", "width", (double)stroke->width_px, "join",
                                join_name(stroke->join), "cap", cap_name(stroke->cap), "miterLimit", limit);
        if (row && stroke->round_limit > 0.0f)
            set(row, "roundLimit", json_real(fmin((double)stroke->round_limit, (double)FLT_MAX)), ok);
        if (desc->paints) {
            const camber_color c = desc->paints[i].color;
            set(row, "paint",
                json_pack("{s:f, s:[f,f,f,f]}", "width", (double)desc->paints[i].width_px, "color", (double)c.r,
                          (double)c.g, (double)c.b, (double)c.a),
                ok);
        }
        append(rows, row, ok);
    }
    return rows;
}

static bool is_translucent(const camber_glb_desc *desc, bool areas) {
    bool translucent = false;
    for (size_t i = 0; areas && i < desc->areas->fill_count; i++)
        translucent |= desc->areas->fills[i].color.a < 1.0f;
    for (size_t i = 0; !areas && desc->paints && i < desc->stroke_count; i++)
        translucent |= desc->paints[i].color.a < 1.0f;
    return translucent;
}

/* The material is unlit and seen from both sides. */
static json_t *material(const camber_glb_desc *desc, bool areas, bool *ok) {
    json_t *pbr = json_pack("{s:f, s:f}", "metallicFactor", 0.0, "roughnessFactor", 1.0);
    if (!areas && !desc->paints) /* grey is visible both on a viewer's black and on its white */
        set(pbr, "baseColorFactor", json_pack("[f,f,f,f]", 0.5, 0.5, 0.5, 1.0), ok);
    return json_pack("{s:s, s:b, s:s, s:o, s:{s:{}}}", "name", areas ? "areas" : "lines", "doubleSided", 1, "alphaMode",
                     is_translucent(desc, areas) ? "BLEND" : "OPAQUE", "pbrMetallicRoughness", pbr, "extensions",
                     "KHR_materials_unlit");
}

/* Adds an accessor of a bufferView, and returns its number. */
static int add_accessor(json_t *root, size_t view, const attribute *a, uint64_t count, bool *ok) {
    json_t *list = json_object_get(root, "accessors");
    json_t *accessor = json_pack("{s:I, s:i, s:I, s:s}", "bufferView", (json_int_t)view, "componentType", a->component,
                                 "count", (json_int_t)count, "type", a->type);
    if (a->name) /* indices have a bufferView of their own */
        set(accessor, "byteOffset", json_integer(a->offset_bytes), ok);
    if (a->normalized)
        set(accessor, "normalized", json_true(), ok);
    append(list, accessor, ok);
    return (int)json_array_size(list) - 1;
}

static void set_bounds(json_t *root, int accessor, const float low[3], const float high[3], bool *ok) {
    json_t *it = json_array_get(json_object_get(root, "accessors"), (size_t)accessor);
    set(it, "min", json_pack("[f,f,f]", (double)low[0], (double)low[1], (double)low[2]), ok);
    set(it, "max", json_pack("[f,f,f]", (double)high[0], (double)high[1], (double)high[2]), ok);
}

/* Adds a bufferView after the existing ones, and returns its number. stride is 0 for indices. */
static size_t add_view(json_t *root, uint64_t start, uint64_t size_bytes, int stride, bool *ok) {
    json_t *views = json_object_get(root, "bufferViews");
    json_t *view = json_pack("{s:i, s:I, s:I, s:i}", "buffer", 0, "byteOffset", (json_int_t)start, "byteLength",
                             (json_int_t)size_bytes, "target", stride ? GLTF_ARRAY_BUFFER : GLTF_ELEMENT_ARRAY_BUFFER);
    if (stride)
        set(view, "byteStride", json_integer(stride), ok);
    append(views, view, ok);
    return json_array_size(views) - 1;
}

static const attribute INDEX = {NULL, "SCALAR", GLTF_UNSIGNED_INT, 0, false};

/* Adds the primitive of the lines. Their bytes come first. */
static void describe_lines(json_t *root, json_t *primitives, const writer *w, bool *ok) {
    const size_t attribute_count = w->desc->paints ? ATTRIBUTE_COUNT : ATTRIBUTE_COUNT - 1;
    const size_t vertices = add_view(root, 0, w->line_bytes[0], w->desc->paints ? COLORED_STRIDE : PLAIN_STRIDE, ok);
    const size_t indices = add_view(root, w->line_bytes[0], w->line_bytes[1], 0, ok);
    json_t *attributes = json_object(), *materials = json_object_get(root, "materials");
    for (size_t i = 0; i < attribute_count; i++) {
        const int made = add_accessor(root, vertices, ATTRIBUTES + i, w->mesh->info.vertex_count, ok);
        if (i == 0)
            set_bounds(root, made, w->low, w->high, ok);
        set(attributes, ATTRIBUTES[i].name, json_integer(made), ok);
    }
    append(primitives,
           json_pack("{s:i, s:o, s:i, s:i}", "mode", w->mesh->info.strips ? GLTF_TRIANGLE_STRIP : GLTF_TRIANGLES,
                     "attributes", attributes, "indices", add_accessor(root, indices, &INDEX, w->index_count, ok),
                     "material", (int)json_array_size(materials)),
           ok);
    append(materials, material(w->desc, false, ok), ok);
}

/* Adds the primitive of the areas. Their bytes follow the bytes of the lines. */
static void describe_areas(json_t *root, json_t *primitives, const writer *w, bool *ok) {
    static const attribute position = {"POSITION", "VEC3", GLTF_FLOAT, 0, false},
                           color = {"COLOR_0", "VEC4", GLTF_UNSIGNED_SHORT, 12, true};
    const camber_area_data *areas = w->desc->areas;
    const uint64_t start = w->line_bytes[0] + w->line_bytes[1];
    const size_t vertices = add_view(root, start, w->area_bytes[0], AREA_STRIDE, ok);
    const size_t indices = add_view(root, start + w->area_bytes[0], w->area_bytes[1], 0, ok);
    const int positions = add_accessor(root, vertices, &position, areas->point_count, ok),
              colors = add_accessor(root, vertices, &color, areas->point_count, ok);
    float low[3] = {FLT_MAX, FLT_MAX, height_of(areas, areas->fills)}, high[3] = {-FLT_MAX, -FLT_MAX, -1.0f};
    for (size_t i = 0; i < areas->point_count; i++) {
        const float xy[2] = {areas->points[2 * i], up(areas->points[2 * i + 1])};
        for (int k = 0; k < 2; k++) {
            low[k] = fminf(low[k], xy[k]);
            high[k] = fmaxf(high[k], xy[k]);
        }
    }
    set_bounds(root, positions, low, high, ok);
    json_t *fills = json_array(), *materials = json_object_get(root, "materials");
    for (size_t i = 0; i < areas->fill_count; i++) {
        const camber_area_fill *fill = areas->fills + i;
        const camber_color c = fill->color;
        append(fills,
               json_pack("{s:s, s:[f,f,f,f], s:[I,I]}", "layer", fill->layer, "color", (double)c.r, (double)c.g,
                         (double)c.b, (double)c.a, "indices", (json_int_t)fill->first_index,
                         (json_int_t)fill->index_count),
               ok);
    }
    append(primitives,
           json_pack("{s:i, s:{s:i, s:i}, s:i, s:i, s:{s:o}}", "mode", GLTF_TRIANGLES, "attributes", "POSITION",
                     positions, "COLOR_0", colors, "indices",
                     add_accessor(root, indices, &INDEX, areas->index_count, ok), "material",
                     (int)json_array_size(materials), "extras", "fills", fills),
           ok);
    append(materials, material(w->desc, true, ok), ok);
}

static uint64_t binary_bytes_of(const writer *w) {
    return w->line_bytes[0] + w->line_bytes[1] + w->area_bytes[0] + w->area_bytes[1];
}

static void describe_mesh(json_t *root, const writer *w, bool *ok) {
    json_t *primitives = json_array();
    set(root, "extensionsUsed", json_pack("[s]", "KHR_materials_unlit"), ok);
    set(root, "nodes", json_pack("[{s:s, s:i}]", "name", "lines", "mesh", 0), ok);
    set(root, "materials", json_array(), ok);
    set(root, "accessors", json_array(), ok);
    set(root, "bufferViews", json_array(), ok);
    if (w->area_bytes[0])
        describe_areas(root, primitives, w, ok);
    if (w->line_bytes[0])
        describe_lines(root, primitives, w, ok);
    set(root, "meshes",
        json_pack("[{s:s, s:o, s:{s:s, s:o}}]", "name", "lines", "primitives", primitives, "extras", "method",
                  camber_method_get_name(w->mesh->info.method), "rows", style_table(w->desc, ok)),
        ok);
    set(root, "buffers", json_pack("[{s:I}]", "byteLength", (json_int_t)binary_bytes_of(w)), ok);
}

/* Returns the text of the JSON chunk, to be freed with camber_free. NULL: out of memory, and nothing has been logged.
 */
static char *make_json(const writer *w) {
    bool ok = true;
    char generator[32];
    snprintf(generator, sizeof generator, "camber %s", camber_version());
    json_t *asset = json_pack("{s:s, s:s}", "version", "2.0", "generator", generator);
    if (w->desc->copyright) /* json_pack would silently leave out an optional value if memory runs out */
        set(asset, "copyright", json_string(w->desc->copyright), &ok);
    json_t *scene = binary_bytes_of(w) ? json_pack("{s:[i]}", "nodes", 0) : json_object();
    json_t *root = json_pack("{s:o, s:i, s:[o]}", "asset", asset, "scene", 0, "scenes", scene);
    if (binary_bytes_of(w))
        describe_mesh(root, w, &ok);
    const size_t size = root && ok ? json_dumpb(root, NULL, 0, JSON_COMPACT) : 0;
    char *text = size ? camber_resize_quietly(w->context, NULL, size + 1) : NULL;
    if (text)
        text[size] = 0;
    if (text && json_dumpb(root, text, size, JSON_COMPACT) != size) {
        camber_free(w->context, text);
        text = NULL;
    }
    json_decref(root);
    return text;
}

/* Checks text according to RFC 3629: shortest form, no surrogates, up to U+10FFFF. */
static bool is_utf8(const char *text) {
    static const uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    for (const unsigned char *c = (const unsigned char *)text; *c;) {
        const int length = *c < 0x80 ? 1 : *c >> 5 == 6 ? 2 : *c >> 4 == 14 ? 3 : *c >> 3 == 30 ? 4 : 0;
        if (length == 0)
            return false;
        uint32_t point = length == 1 ? *c : *c & (0x7fu >> length);
        for (int i = 1; i < length; i++) {
            if (c[i] >> 6 != 2)
                return false;
            point = point << 6 | (c[i] & 0x3fu);
        }
        if (point < least[length] || point > 0x10ffff || point >> 11 == 0x1b)
            return false;
        c += length;
    }
    return true;
}

/* ---- The file ---- */

static void put_chunk_head(writer *w, uint64_t size_bytes, uint32_t type) {
    want(w, 8);
    put_u32(w, (uint32_t)size_bytes);
    put_u32(w, type);
}

/* Rejects infinity and NaN, which JSON cannot represent, and a copyright that is not UTF-8. */
static camber_status check_desc(camber_context *context, const camber_glb_desc *desc) {
    if (desc->copyright && !is_utf8(desc->copyright))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "GLB: the copyright is not UTF-8; convert it");
    for (size_t i = 0; desc->paints && i < desc->stroke_count; i++) {
        const camber_paint *paint = desc->paints + i;
        const camber_color c = paint->color;
        if (!isfinite(paint->width_px) || !isfinite(c.r) || !isfinite(c.g) || !isfinite(c.b) || !isfinite(c.a))
            return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                               "GLB: the width or the colour of paint %zu is not a finite number; give one", i);
    }
    for (size_t i = 0; desc->areas && i < desc->areas->fill_count; i++) {
        const camber_color c = desc->areas->fills[i].color;
        if (!isfinite(c.r) || !isfinite(c.g) || !isfinite(c.b) || !isfinite(c.a))
            return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                               "GLB: the colour of fill %zu is not a finite number; give one", i);
    }
    return CAMBER_OK;
}

static camber_status check_size(camber_context *context, uint64_t size_bytes) {
    if (size_bytes <= UINT32_MAX)
        return CAMBER_OK;
    return camber_fail(context, CAMBER_ERROR_LIMIT,
                       "GLB: %llu bytes do not fit its 32-bit length; draw a smaller part or simplify more",
                       (unsigned long long)size_bytes);
}

static camber_status write_file(writer *w, const char *json, const uint16_t *colors) {
    const uint64_t binary_bytes = binary_bytes_of(w);
    const size_t length = strlen(json), padded = (length + 3) / 4 * 4;
    w->total = 12 + 8 + padded + (binary_bytes ? 8 + binary_bytes : 0);
    const camber_status status = check_size(w->context, w->total);
    if (status != CAMBER_OK)
        return status;
    put_u32(w, 0x46546c67u); /* glTF */
    put_u32(w, 2);
    put_u32(w, (uint32_t)w->total);
    put_chunk_head(w, padded, 0x4e4f534au); /* JSON */
    for (size_t i = 0; i < padded && !w->refused; i++) {
        want(w, 1);
        w->block[w->used++] = i < length ? (unsigned char)json[i] : ' ';
    }
    if (binary_bytes) {
        put_chunk_head(w, binary_bytes, 0x004e4942u); /* BIN */
        if (w->line_bytes[0]) {
            put_vertices(w, colors);
            put_indices(w, false);
        }
        if (w->area_bytes[0])
            put_areas(w);
    }
    flush(w);
    return w->refused ? CAMBER_ERROR_IO : CAMBER_OK;
}

camber_status camber_glb_write(camber_context *context, const camber_mesh_data *mesh, const camber_glb_desc *desc,
                               camber_sink sink) {
    writer w = {.context = context, .mesh = mesh, .desc = desc, .sink = sink};
    uint16_t *colors = NULL;
    char *json = NULL;
    camber_status status = check_desc(context, desc);
    if (status != CAMBER_OK)
        return status;
    status = CAMBER_ERROR_MEMORY;
    w.block = camber_alloc(context, BLOCK_BYTES, 1);
    if (!w.block)
        return status;
    put_indices(&w, true);
    if (w.index_count) {
        w.line_bytes[0] = (uint64_t)mesh->info.vertex_count * (desc->paints ? COLORED_STRIDE : PLAIN_STRIDE);
        w.line_bytes[1] = w.index_count * 4;
    }
    if (desc->areas && desc->areas->index_count) {
        w.area_bytes[0] = (uint64_t)desc->areas->point_count * AREA_STRIDE;
        w.area_bytes[1] = (uint64_t)desc->areas->index_count * 4;
    }
    status = check_size(context, binary_bytes_of(&w)); /* fails before any work is done */
    if (status != CAMBER_OK)
        goto done;
    status = CAMBER_ERROR_MEMORY;
    if (w.index_count)
        measure(&w);
    if (w.index_count && desc->paints && !(colors = make_colors(&w)))
        goto done;
    json = make_json(&w);
    if (json)
        status = write_file(&w, json, colors);
    else
        status = camber_fail(context, CAMBER_ERROR_MEMORY,
                             "GLB: no memory for the style table of %zu rows; give it fewer rows or more memory",
                             desc->stroke_count);
done:
    camber_free(context, json);
    camber_free(context, colors);
    camber_free(context, w.block);
    return status;
}
