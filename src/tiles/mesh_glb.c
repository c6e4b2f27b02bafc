/* Encodes mesh tiles as binary glTF 2.0, quantised and compressed. docs/mesh-tiles.md describes the layout.
 *
 * Input: the records and triangles of a tile. Output: a file with up to two primitives. Lines are one triangle strip
 * with two vertices per record: the line's left and right edge at the tile's zoom, for plain viewers. Both vertices
 * also contain the record itself, for shaders. A sentinel's vertices coincide with one vertex of the line before it and
 * one of the line after it, so that the triangles between the two lines have no area. Areas are indexed triangles. */
#include "tiles/mesh_tile.h"

#include <jansson.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>

#ifdef CAMBER_MESHOPT
#include <meshoptimizer.h>
#endif

bool camber_mesh_is_built(void) {
#ifdef CAMBER_MESHOPT
    return true;
#else
    return false;
#endif
}

#ifdef CAMBER_MESHOPT

enum { GLTF_UNSIGNED_BYTE = 5121, GLTF_SHORT = 5122, GLTF_UNSIGNED_INT = 5125, GLTF_FLOAT = 5126, GLTF_STRIP = 5 };
/* Outlines are in steps of 1/8 px at the tile's zoom. Sets are stacked 1 px above each other, so that plain viewers
 * draw them in order. */
enum { OUTLINE_STEPS = 8 };

/* A vertex as it is stored in the file. */
typedef struct vertex {
    int16_t position[3], padding; /* x, height, y, in eighths of a px */
    int16_t point[4];             /* x and y in units, row, flags */
    uint8_t color[4];             /* linear RGBA */
} vertex;
_Static_assert(sizeof(vertex) == 20, "vertices have no padding between them");

typedef struct along {
    float along_px, total_px;
} along;

enum { VERTICES, ALONGS, INDICES, STREAMS };

typedef struct encoder {
    camber_context *context;
    const camber_mesh_tile *tile;
    const camber_mesh_plan *plan;
    const camber_mesh_place *place;
    vertex *vertices;          /* two per record, then one per corner */
    along *alongs;             /* two per record; NULL: none */
    size_t vertex_count;       /* vertices of lines, then of areas */
    uint8_t *packed;           /* compressed streams, each at a multiple of 4 bytes */
    size_t start[STREAMS + 1]; /* start of each stream, and the end of the last */
    size_t bytes[STREAMS];     /* size of each stream; 0: it is not present */
    bool ok;                   /* no allocation for the JSON has failed */
} encoder;

/* ---- The outline, for plain viewers ---- */

/* How plain viewers draw a row: like the topmost layer that draws it, at the first sample that it draws. */
typedef struct look {
    double half_width, offset; /* eighths of a px */
    int height;
    uint8_t color[4];
} look;

static uint8_t linear_byte(float srgb) {
    const double c = (double)srgb;
    return (uint8_t)(255.0 * (c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4)) + 0.5);
}

static camber_color color_of(const camber_paint *paint) {
    return paint->fill ? paint->fill->color : paint->color;
}

static look look_of(const encoder *e, uint32_t row, size_t set_index) {
    const camber_plan *whole = &e->plan->zoom->plan;
    const camber_plan_set *set = whole->sets + set_index;
    look found = {.height = 0};
    for (size_t n = 0, layer = set->first_layer; n < set->layer_count; n++, layer = whole->layers[layer].next)
        for (size_t s = CAMBER_MESH_SAMPLES; s-- > 0;) {
            const camber_paint paint = camber_mesh_plan_paint(e->plan, layer, row, s);
            const camber_color color = color_of(&paint);
            const double shrunk = OUTLINE_STEPS * exp2(-camber_mesh_sample_zoom(s));
            if (!camber_mesh_plan_draws(&paint))
                continue;
            const float width = paint.gap_px > 0.0f ? paint.gap_px + 2.0f * paint.width_px : paint.width_px;
            found.half_width = 0.5 * (double)width * shrunk;
            found.offset = (double)camber_mesh_plan_offset(e->plan, layer, row, s) * shrunk;
            found.color[0] = linear_byte(color.r);
            found.color[1] = linear_byte(color.g);
            found.color[2] = linear_byte(color.b);
            found.color[3] = (uint8_t)(255.0f * color.a + 0.5f);
        }
    return found;
}

static int16_t to_steps(double value) {
    const double steps = floor(value + 0.5);
    return (int16_t)(steps > 32767.0 ? 32767.0 : steps < -32767.0 ? -32767.0 : steps);
}

/* Computes the direction from one record to another. Returns false if both are at the same point. */
static bool direction(const camber_mesh_record *a, const camber_mesh_record *b, double u[2]) {
    const double x = b->x - a->x, y = b->y - a->y, length = sqrt(x * x + y * y);
    u[0] = length > 0.0 ? x / length : 1.0;
    u[1] = length > 0.0 ? y / length : 0.0;
    return length > 0.0;
}

/* Places both vertices of a record on the bisector of its segments, at most two half widths away. */
static void place(const encoder *e, size_t i, const look *l, vertex *pair) {
    const camber_mesh_record *r = e->tile->records + i;
    const bool is_ring = r->flags & CAMBER_MESH_RING;
    const double steps = (double)(OUTLINE_STEPS * e->tile->tile_px) / e->tile->units, x = r->x * steps,
                 y = r->y * steps;
    double in[2], out[2];
    const bool has_in = (!(r->flags & CAMBER_MESH_FIRST) || is_ring) && direction(r - 1, r, in);
    const bool has_out = (!(r->flags & CAMBER_MESH_LAST) || is_ring) && direction(r, r + 1, out);
    if (!has_in && !has_out)
        in[0] = 1.0, in[1] = 0.0;
    const double *a = has_in || !has_out ? in : out, *b = has_out ? out : a;
    const double cosine = a[0] * b[0] + a[1] * b[1], by = 1.0 / fmax(1.0 + cosine, 0.25);
    const double across[2] = {-(a[1] + b[1]) * by, (a[0] + b[0]) * by};
    for (int side = 0; side < 2; side++) {
        const double away = (side ? 1.0 : -1.0) * l->half_width + l->offset; /* y points down: left, then right */
        pair[side].position[0] = to_steps(x + across[0] * away);
        pair[side].position[1] = (int16_t)l->height;
        pair[side].position[2] = to_steps(y + across[1] * away);
    }
    if (!has_in && !has_out) /* a dot becomes a square */
        for (int side = 0; side < 2; side++)
            pair[side].position[0] = to_steps(x + (r->flags & CAMBER_MESH_FIRST ? -1.0 : 1.0) * l->half_width);
}

/* ---- Vertices ---- */

static void make_pair(encoder *e, size_t i, const look *l) {
    const camber_mesh_record *r = e->tile->records + i;
    vertex *pair = e->vertices + 2 * i;
    if (!(r->flags & CAMBER_MESH_SENTINEL))
        place(e, i, l, pair);
    for (int side = 0; side < 2; side++) {
        const int16_t point[4] = {r->x, r->y, (int16_t)r->row, (int16_t)r->flags};
        memcpy(pair[side].point, point, sizeof point);
        memcpy(pair[side].color, l->color, sizeof l->color);
        if (e->alongs)
            e->alongs[2 * i + (size_t)side] = (along){r->along_px, r->total_px};
    }
}

/* Moves the vertices of sentinels onto neighbouring vertices. */
static void place_sentinels(encoder *e) {
    const camber_mesh_record *records = e->tile->records;
    const size_t count = e->tile->record_count;
    for (size_t i = 0; i < count; i++) {
        if (!(records[i].flags & CAMBER_MESH_SENTINEL))
            continue;
        vertex *pair = e->vertices + 2 * i;
        size_t next = i;
        while (next < count && (records[next].flags & CAMBER_MESH_SENTINEL))
            next++;
        const vertex *before = i > 0 ? pair - 1 : e->vertices + 2 * next;
        /* of two sentinels in a row, the first belongs to the line before */
        const bool is_last = next == count || next > i + 1;
        const vertex *behind = is_last ? before : e->vertices + 2 * next;
        memcpy(pair[0].position, before->position, sizeof before->position);
        memcpy(pair[1].position, behind->position, sizeof behind->position);
    }
}

/* Makes the corners of areas, after the vertices of lines. */
static void make_corners(encoder *e, look *looks) {
    const camber_mesh_tile *tile = e->tile;
    const double steps = (double)(OUTLINE_STEPS * tile->tile_px) / tile->units;
    vertex *corners = e->vertices + 2 * tile->record_count;
    for (size_t i = 0; i < tile->corner_count; i++) {
        const camber_mesh_corner *from = tile->corners + i;
        corners[i] = (vertex){.position = {to_steps(from->x * steps), 0, to_steps(from->y * steps)},
                              .point = {from->x, from->y, (int16_t)from->row, 0}};
    }
    for (size_t fill = 0; fill < tile->fill_count; fill++)
        for (size_t i = tile->fills[fill].first; i < tile->fills[fill].end; i++) {
            vertex *corner = corners + tile->triangles[i];
            if (corner->position[1] != 0)
                continue;
            look *l = looks + corner->point[2];
            if (!l->color[3])
                *l = look_of(e, tile->rows[corner->point[2]], tile->fills[fill].set);
            corner->position[1] = (int16_t)(OUTLINE_STEPS * (tile->fills[fill].set + 1));
            memcpy(corner->color, l->color, sizeof l->color);
        }
}

static camber_status make_vertices(encoder *e) {
    const camber_mesh_tile *tile = e->tile;
    look *looks = camber_alloc_zero(e->context, tile->row_count, sizeof *looks);
    e->vertex_count = 2 * tile->record_count + tile->corner_count;
    if (!looks || !(e->vertices = camber_alloc_zero(e->context, e->vertex_count, sizeof *e->vertices)) ||
        (tile->has_arc_length &&
         !(e->alongs = camber_alloc_zero(e->context, tile->record_count, 2 * sizeof *e->alongs)))) {
        camber_free(e->context, looks);
        return CAMBER_ERROR_MEMORY;
    }
    for (size_t range = 0; range < tile->range_count; range++) {
        for (size_t i = tile->ranges[range].first; i < tile->ranges[range].end; i++) {
            look *l = looks + tile->records[i].row;
            if (!l->color[3])
                *l = look_of(e, tile->rows[tile->records[i].row], tile->ranges[range].set);
            l->height = OUTLINE_STEPS * (int)(tile->ranges[range].set + 1);
            make_pair(e, i, l);
        }
    }
    for (size_t i = 0; i < tile->record_count; i++)
        if (tile->records[i].flags & CAMBER_MESH_SENTINEL)
            make_pair(e, i, looks + tile->records[i].row);
    place_sentinels(e);
    make_corners(e, looks);
    camber_free(e->context, looks);
    return CAMBER_OK;
}

/* Sets the versions of EXT_meshopt_compression. meshoptimizer keeps them for the whole process without a lock, so they
 * must not be set while a tile is encoded. */
static void set_versions(void) {
    meshopt_encodeVertexVersion(0);
    meshopt_encodeIndexVersion(1);
}
static pthread_once_t versions_are_set = PTHREAD_ONCE_INIT;

static camber_status compress(encoder *e) {
    const camber_mesh_tile *tile = e->tile;
    const size_t count = 2 * tile->record_count, corners = tile->corner_count;
    const size_t room[STREAMS] = {
        meshopt_encodeVertexBufferBound(e->vertex_count, sizeof *e->vertices),
        e->alongs ? meshopt_encodeVertexBufferBound(count, sizeof *e->alongs) : 0,
        tile->index_count ? meshopt_encodeIndexBufferBound(tile->index_count, corners) : 0,
    };
    if (!(e->packed = camber_alloc_zero(e->context, room[VERTICES] + room[ALONGS] + room[INDICES] + 4 * STREAMS, 1)))
        return CAMBER_ERROR_MEMORY;
    pthread_once(&versions_are_set, set_versions);
    for (int i = 0; i < STREAMS; i++) {
        uint8_t *to = e->packed + e->start[i];
        if (room[i])
            e->bytes[i] = i == VERTICES ? meshopt_encodeVertexBuffer(to, room[i], e->vertices, e->vertex_count,
                                                                     sizeof *e->vertices)
                          : i == ALONGS ? meshopt_encodeVertexBuffer(to, room[i], e->alongs, count, sizeof *e->alongs)
                                        : meshopt_encodeIndexBuffer(to, room[i], tile->triangles, tile->index_count);
        e->start[i + 1] = e->start[i] + (e->bytes[i] + 3) / 4 * 4;
        memset(to + e->bytes[i], 0, e->start[i + 1] - e->start[i] - e->bytes[i]);
    }
    return CAMBER_OK;
}

/* ---- JSON ---- */

static void set(encoder *e, json_t *object, const char *key, json_t *value) {
    e->ok &= json_object_set_new(object, key, value) == 0;
}

static void append(encoder *e, json_t *array, json_t *value) {
    e->ok &= json_array_append_new(array, value) == 0;
}

/* Rounds numbers below 10 to 1/1000, below 100 to 1/100, and so on: four digits are more than a picture can show. */
static json_t *number(double value) {
    double step = 1e-3;
    for (double most = 10.0; fabs(value) >= most && most < 1e4; most *= 10.0)
        step *= 10.0;
    const double rounded = floor(value / step + 0.5) * step;
    return rounded == floor(rounded) ? json_integer((json_int_t)rounded) : json_real(rounded);
}

/* Stores a list of samples, or a single value if all samples are equal, or nothing if that value is the default. Takes
 * ownership of samples and normal. */
static void set_samples(encoder *e, json_t *object, const char *key, json_t *samples, json_t *normal) {
    bool same = true;
    e->ok &= normal != NULL;
    for (size_t s = 1; s < json_array_size(samples); s++)
        same = same && json_equal(json_array_get(samples, 0), json_array_get(samples, s));
    json_t *first = json_array_get(samples, 0);
    if (!same)
        set(e, object, key, json_incref(samples));
    else if (!json_equal(first, normal))
        set(e, object, key, json_incref(first));
    json_decref(samples);
    json_decref(normal);
}

static unsigned color_byte(float value) {
    return (unsigned)(255.0f * (value < 0.0f ? 0.0f : value > 1.0f ? 1.0f : value) + 0.5f);
}

static json_t *color_text(camber_color color) {
    char text[16];
    snprintf(text, sizeof text, "#%02x%02x%02x", color_byte(color.r), color_byte(color.g), color_byte(color.b));
    return json_string(text);
}

static void set_along(encoder *e, json_t *object, const camber_paint *paint) {
    if (paint->dash) {
        json_t *lengths = json_array();
        for (size_t i = 0; i < paint->dash->count; i++)
            append(e, lengths, number((double)paint->dash->lengths[i]));
        set(e, object, "dash", lengths);
    }
    if (paint->trim_end > paint->trim_start)
        set(e, object, "trim", json_pack("[f, f]", (double)paint->trim_start, (double)paint->trim_end));
    if (paint->ramp) {
        json_t *stops = json_array();
        for (size_t i = 0; i < paint->ramp->count; i++) {
            const camber_ramp_stop *stop = paint->ramp->stops + i;
            append(e, stops,
                   json_pack("[o, o, o]", number((double)stop->place), color_text(stop->color),
                             number((double)stop->color.a)));
        }
        set(e, object, "gradient", stops);
    }
}

/* Returns the paint of a row in a layer; NULL if it is not drawn at any sample. */
static json_t *paint_json(encoder *e, size_t layer, uint32_t row) {
    enum { WIDTH, OPACITY, GAP, BLUR, OFFSET, UNIT, COLOR, MOVE, LISTS };
    static const char *const names[LISTS] = {"width",  "opacity",  "gap",   "blur",
                                             "offset", "dashUnit", "color", "translate"};
    json_t *lists[LISTS], *object = json_object();
    camber_paint seen = {0}, paints[CAMBER_MESH_SAMPLES];
    bool drawn = false;
    for (size_t s = CAMBER_MESH_SAMPLES; s-- > 0;) {
        paints[s] = camber_mesh_plan_paint(e->plan, layer, row, s);
        seen = camber_mesh_plan_draws(paints + s) || !drawn ? paints[s] : seen;
        drawn = drawn || camber_mesh_plan_draws(paints + s);
    }
    for (int k = 0; k < LISTS; k++)
        lists[k] = json_array();
    for (size_t s = 0; s < CAMBER_MESH_SAMPLES; s++) {
        /* At samples where the row is not drawn, the paint of another sample is used, so that shaders can
         * interpolate. */
        const bool is_drawn = camber_mesh_plan_draws(paints + s);
        const camber_paint *p = is_drawn ? paints + s : &seen;
        append(e, lists[WIDTH], number(is_drawn ? (double)p->width_px : 0.0));
        append(e, lists[OPACITY], number(p->fill && !is_drawn ? 0.0 : (double)color_of(p).a));
        append(e, lists[GAP], number((double)p->gap_px));
        append(e, lists[BLUR], number(p->smooth_blur ? -(double)p->blur_px : (double)p->blur_px));
        append(e, lists[OFFSET], number((double)camber_mesh_plan_offset(e->plan, layer, row, s)));
        append(e, lists[UNIT], number(p->dash ? p->dash_unit_px > 0.0f ? (double)p->dash_unit_px : 1.0 : 0.0));
        append(e, lists[COLOR], color_text(color_of(p)));
        append(e, lists[MOVE],
               json_pack("[o, o]", number((double)p->translate_x_px), number((double)p->translate_y_px)));
    }
    for (int k = 0; k < LISTS; k++)
        set_samples(e, object, names[k], lists[k],
                    k == COLOR || (k == WIDTH && !seen.fill) ? json_null()
                    : k == OPACITY                           ? json_integer(1)
                    : k == MOVE                              ? json_pack("[i, i]", 0, 0)
                                                             : json_integer(0));
    set_along(e, object, &seen);
    if (drawn)
        return object;
    json_decref(object);
    return NULL;
}

static json_t *layer_json(encoder *e, size_t layer, const camber_mesh_range *range) {
    static const char *const overlaps[] = {"flatten", "accumulate", "unite"};
    const camber_plan_layer *own = e->plan->zoom->plan.layers + layer;
    const double opacity = own->look.paint.layer_opacity;
    json_t *paints = json_object();
    for (size_t i = 0; i < e->tile->row_count; i++) {
        char key[24];
        if (!camber_mesh_plan_has_row(e->plan, range->set, e->tile->rows[i]))
            continue;
        snprintf(key, sizeof key, "%zu", i);
        json_t *paint = paint_json(e, layer, e->tile->rows[i]);
        if (paint)
            set(e, paints, key, paint);
    }
    if (!json_object_size(paints)) {
        json_decref(paints);
        return NULL;
    }
    json_t *object = json_pack("{s:s, s:[I, I], s:o}", "id", own->look.layer->id,
                               own->part == CAMBER_PLAN_AREA ? "indices" : "range", (json_int_t)range->first,
                               (json_int_t)(range->end - range->first), "paints", paints);
    e->ok &= object != NULL;
    if (opacity < 1.0)
        set(e, object, "opacity", number(opacity));
    if (own->look.layer->overlap != CAMBER_OVERLAP_FLATTEN)
        set(e, object, "overlap", json_string(overlaps[own->look.layer->overlap]));
    if (own->part == CAMBER_PLAN_BORDER)
        set(e, object, "border", json_true());
    return object;
}

static bool is_area_row(const encoder *e, uint32_t row) {
    for (size_t i = 0; i < e->tile->fill_count; i++)
        if (camber_mesh_plan_has_row(e->plan, e->tile->fills[i].set, row))
            return true;
    return false;
}

static json_t *rows_json(encoder *e) {
    static const char *const joins[] = {"round", "miter", "bevel"}, *const caps[] = {"butt", "round", "square"};
    json_t *rows = json_array();
    for (size_t i = 0; i < e->tile->row_count; i++) {
        const uint32_t pair = e->plan->row_pairs[e->tile->rows[i]];
        const camber_stroke *stroke = e->plan->zoom->strokes + pair;
        json_t *row = json_object();
        append(e, rows, row);
        if (is_area_row(e, e->tile->rows[i]))
            continue;
        if (stroke->cap != CAMBER_CAP_ROUND)
            set(e, row, "cap", json_string(caps[stroke->cap]));
        if (stroke->join != CAMBER_JOIN_ROUND)
            set(e, row, "join", json_string(joins[stroke->join]));
        if (stroke->miter_limit < 2.0f || stroke->miter_limit > 2.0f)
            set(e, row, "miterLimit", number((double)stroke->miter_limit));
        if (stroke->join == CAMBER_JOIN_ROUND && stroke->round_limit > 1.0f)
            set(e, row, "roundLimit", number((double)stroke->round_limit));
    }
    return rows;
}

static const camber_mesh_range *find_range(const camber_mesh_range *ranges, size_t count, size_t set_index) {
    for (size_t i = 0; i < count; i++)
        if (ranges[i].set == set_index)
            return ranges + i;
    return NULL;
}

static json_t *extras_json(encoder *e) {
    json_t *layers = json_array(), *background = json_array();
    const camber_plan *whole = &e->plan->zoom->plan;
    for (size_t i = 0; i < whole->layer_count; i++) {
        const camber_mesh_range *range = find_range(e->tile->ranges, e->tile->range_count, whole->layers[i].set);
        range = range ? range : find_range(e->tile->fills, e->tile->fill_count, whole->layers[i].set);
        json_t *layer = range ? layer_json(e, i, range) : NULL;
        if (layer)
            append(e, layers, layer);
    }
    for (size_t s = 0; s < CAMBER_MESH_SAMPLES; s++) {
        const camber_plan *own = s + 1 < CAMBER_MESH_SAMPLES ? e->plan->samples + s : whole;
        append(e, background, own->background.a > 0.0f ? color_text(own->background) : json_null());
    }
    json_t *extras = json_pack("{s:i, s:I, s:I, s:o, s:o}", "z", e->place->zoom, "units", (json_int_t)e->tile->units,
                               "tilePx", (json_int_t)e->tile->tile_px, "rows", rows_json(e), "layers", layers);
    if (e->place->ratio < 1.0 || e->place->ratio > 1.0)
        set(e, extras, "ratio", number(e->place->ratio));
    set_samples(e, extras, "background", background, json_null());
    return extras;
}

/* ---- Parts of the glTF file ---- */

/* An offset of 0 is the default and is omitted. */
static json_t *view_json(encoder *e, size_t *offset, int stream, size_t count, size_t stride) {
    json_t *packed = json_pack("{s:i, s:I, s:I, s:I, s:s}", "buffer", 0, "byteLength", (json_int_t)e->bytes[stream],
                               "byteStride", (json_int_t)stride, "count", (json_int_t)count, "mode",
                               stream == INDICES ? "TRIANGLES" : "ATTRIBUTES");
    if (e->start[stream])
        set(e, packed, "byteOffset", json_integer((json_int_t)e->start[stream]));
    json_t *view = json_pack("{s:i, s:I, s:{s:o}}", "buffer", 1, "byteLength", (json_int_t)(count * stride),
                             "extensions", "EXT_meshopt_compression", packed);
    if (stream != INDICES)
        set(e, view, "byteStride", json_integer((json_int_t)stride));
    if (*offset)
        set(e, view, "byteOffset", json_integer((json_int_t)*offset));
    *offset += count * stride;
    return view;
}

static json_t *accessor_json(int view, size_t offset, int component, size_t count, const char *type) {
    json_t *accessor = json_pack("{s:i, s:i, s:I, s:s}", "bufferView", view, "componentType", component, "count",
                                 (json_int_t)count, "type", type);
    if (offset && json_object_set_new(accessor, "byteOffset", json_integer((json_int_t)offset)) != 0) {
        json_decref(accessor);
        return NULL;
    }
    return accessor;
}

/* Adds the accessors of some vertices, and returns the attributes that refer to them. */
static json_t *add_accessors(encoder *e, json_t *list, size_t first, size_t count) {
    const vertex *vertices = e->vertices + first;
    const size_t start = first * sizeof *vertices;
    int16_t low[3], high[3];
    for (int k = 0; k < 3; k++) {
        low[k] = high[k] = vertices[0].position[k];
        for (size_t i = 1; i < count; i++) {
            low[k] = vertices[i].position[k] < low[k] ? vertices[i].position[k] : low[k];
            high[k] = vertices[i].position[k] > high[k] ? vertices[i].position[k] : high[k];
        }
    }
    const int number_first = (int)json_array_size(list);
    json_t *position = accessor_json(0, start + offsetof(vertex, position), GLTF_SHORT, count, "VEC3");
    json_t *color = accessor_json(0, start + offsetof(vertex, color), GLTF_UNSIGNED_BYTE, count, "VEC4");
    set(e, position, "min", json_pack("[i, i, i]", low[0], low[1], low[2]));
    set(e, position, "max", json_pack("[i, i, i]", high[0], high[1], high[2]));
    set(e, color, "normalized", json_true());
    append(e, list, position);
    append(e, list, accessor_json(0, start + offsetof(vertex, point), GLTF_SHORT, count, "VEC4"));
    append(e, list, color);
    return json_pack("{s:i, s:i, s:i}", "POSITION", number_first, "_POINT", number_first + 1, "COLOR_0",
                     number_first + 2);
}

/* Makes the primitives: the strip of lines and the triangles of areas, if there are any. */
static json_t *primitives_json(encoder *e, json_t *accessors) {
    const size_t count = 2 * e->tile->record_count;
    json_t *primitives = json_array();
    if (count) {
        json_t *attributes = add_accessors(e, accessors, 0, count);
        if (e->alongs) {
            set(e, attributes, "_ALONG", json_integer((json_int_t)json_array_size(accessors)));
            append(e, accessors, accessor_json(1, 0, GLTF_FLOAT, count, "VEC2"));
        }
        append(e, primitives,
               json_pack("{s:i, s:i, s:o}", "mode", GLTF_STRIP, "material", 0, "attributes", attributes));
    }
    if (e->tile->index_count) {
        json_t *attributes = add_accessors(e, accessors, count, e->tile->corner_count);
        const int indices = (int)json_array_size(accessors);
        append(e, accessors, accessor_json(e->alongs ? 2 : 1, 0, GLTF_UNSIGNED_INT, e->tile->index_count, "SCALAR"));
        append(e, primitives,
               json_pack("{s:i, s:o, s:i}", "material", 0, "attributes", attributes, "indices", indices));
    }
    return primitives;
}

static json_t *node_json(const encoder *e) {
    const double world = 40075016.685578488, tile = world / exp2(e->place->zoom),
                 scale = tile / (OUTLINE_STEPS * e->tile->tile_px);
    return json_pack("{s:i, s:[f, i, f], s:[f, f, f]}", "mesh", 0, "translation",
                     ((double)e->place->column + 0.5) * tile - 0.5 * world, 0,
                     ((double)e->place->row + 0.5) * tile - 0.5 * world, "scale", scale, scale, scale);
}

static bool is_translucent(const encoder *e) {
    for (size_t i = 0; i < e->vertex_count; i++)
        if (e->vertices[i].color[3] < 255)
            return true;
    return false;
}

static json_t *root_json(encoder *e) {
    size_t raw_bytes = 0;
    json_t *views = json_array(), *accessors = json_array();
    append(e, views, view_json(e, &raw_bytes, VERTICES, e->vertex_count, sizeof *e->vertices));
    if (e->alongs)
        append(e, views, view_json(e, &raw_bytes, ALONGS, 2 * e->tile->record_count, sizeof *e->alongs));
    if (e->tile->index_count)
        append(e, views, view_json(e, &raw_bytes, INDICES, e->tile->index_count, sizeof *e->tile->triangles));
    json_t *root = json_pack("{s:{s:s}}", "asset", "version", "2.0");
    set(e, root, "extensionsUsed",
        json_pack("[s, s, s]", "KHR_mesh_quantization", "EXT_meshopt_compression", "KHR_materials_unlit"));
    set(e, root, "extensionsRequired", json_pack("[s, s]", "KHR_mesh_quantization", "EXT_meshopt_compression"));
    set(e, root, "scene", json_integer(0));
    set(e, root, "scenes", json_pack("[{s:[i]}]", "nodes", 0));
    set(e, root, "nodes", json_pack("[o]", node_json(e)));
    json_t *material = json_pack("{s:{s:{}}}", "extensions", "KHR_materials_unlit");
    if (is_translucent(e))
        set(e, material, "alphaMode", json_string("BLEND"));
    set(e, root, "materials", json_pack("[o]", material));
    set(e, root, "meshes",
        json_pack("[{s:o, s:o}]", "primitives", primitives_json(e, accessors), "extras", extras_json(e)));
    set(e, root, "accessors", accessors);
    set(e, root, "bufferViews", views);
    set(e, root, "buffers",
        json_pack("[{s:I}, {s:I, s:{s:{s:b}}}]", "byteLength", (json_int_t)e->start[STREAMS], "byteLength",
                  (json_int_t)raw_bytes, "extensions", "EXT_meshopt_compression", "fallback", 1));
    return root;
}

/* ---- The file ---- */

static uint8_t *put_u32(uint8_t *to, size_t value) {
    for (int i = 0; i < 4; i++)
        *to++ = (uint8_t)(value >> (8 * i));
    return to;
}

static camber_status fail_json(const encoder *e) {
    return camber_fail(e->context, CAMBER_ERROR_MEMORY, "tiles: no memory for the style of a mesh tile");
}

/* jansson's allocator belongs to the whole process and may not be ours, so the text is written directly into our
 * buffer. */
static camber_status write_file(encoder *e, const json_t *root, uint8_t **bytes, size_t *size_bytes) {
    enum { AS = JSON_COMPACT | JSON_REAL_PRECISION(10) };
    const size_t length = e->ok ? json_dumpb(root, NULL, 0, AS) : 0, text = (length + 3) / 4 * 4;
    const size_t binary = e->start[STREAMS], total = 12 + 8 + text + 8 + binary;
    uint8_t *file = length ? camber_alloc_zero(e->context, total, 1) : NULL;
    if (!length)
        return fail_json(e);
    if (!file)
        return CAMBER_ERROR_MEMORY;
    uint8_t *to = put_u32(put_u32(put_u32(file, 0x46546c67u), 2), total); /* glTF */
    to = put_u32(put_u32(to, text), 0x4e4f534au);                         /* JSON */
    memset(to, ' ', text);
    if (json_dumpb(root, (char *)to, length, AS) != length) {
        camber_free(e->context, file);
        return fail_json(e);
    }
    to = put_u32(put_u32(to + text, binary), 0x004e4942u); /* BIN */
    memcpy(to, e->packed, binary);
    *bytes = file;
    *size_bytes = total;
    return CAMBER_OK;
}

camber_status camber_mesh_tile_encode(const camber_mesh_tile *tile, const camber_mesh_plan *plan,
                                      const camber_mesh_place *place, uint8_t **bytes, size_t *size_bytes) {
    encoder e = {.context = tile->context, .tile = tile, .plan = plan, .place = place, .ok = true};
    camber_status status = make_vertices(&e);
    if (status == CAMBER_OK)
        status = compress(&e);
    if (status == CAMBER_OK) {
        json_t *root = root_json(&e);
        status = write_file(&e, root, bytes, size_bytes);
        json_decref(root);
    }
    camber_free(e.context, e.packed);
    camber_free(e.context, e.alongs);
    camber_free(e.context, e.vertices);
    return status;
}

#else

camber_status camber_mesh_tile_encode(const camber_mesh_tile *tile, const camber_mesh_plan *plan,
                                      const camber_mesh_place *place, uint8_t **bytes, size_t *size_bytes) {
    (void)plan;
    (void)place;
    (void)bytes;
    (void)size_bytes;
    return camber_fail(tile->context, CAMBER_ERROR_ARGUMENT,
                       "tiles: this build writes no mesh tiles (CAMBER_MESHOPT); build it with meshoptimizer");
}

#endif
