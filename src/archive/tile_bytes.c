/* Functions for the readers of all tile sets: growing buffers, decompression, and the metadata of a set. */
#include "archive/tile_set.h"
#include <errno.h>
#include <math.h>
#include <strings.h>
#include <unistd.h>
#include <zlib.h>

void camber_bytes_free(camber_bytes *bytes) {
    camber_free(bytes->context, bytes->data);
    bytes->data = NULL;
    bytes->size_bytes = bytes->capacity = 0;
}

bool camber_bytes_resize(camber_bytes *bytes, size_t size_bytes) {
    if (!camber_grow(bytes->context, &bytes->data, &bytes->capacity, size_bytes + 1, 1))
        return false;
    bytes->size_bytes = size_bytes;
    return true;
}

static const char TOO_MUCH[] = "it decompresses to too much";

static const char *inflate_all(z_stream *stream, size_t limit_bytes, camber_bytes *out, camber_status *status) {
    size_t done = 0;
    for (;;) {
        if (done == out->size_bytes) {
            if (done >= limit_bytes)
                return TOO_MUCH;
            const size_t wanted = done ? 2 * done : 65536;
            if (!camber_bytes_resize(out, wanted < limit_bytes ? wanted : limit_bytes)) {
                *status = CAMBER_ERROR_MEMORY;
                return NULL;
            }
        }
        stream->next_out = out->data + done;
        stream->avail_out = (uInt)(out->size_bytes - done);
        const int result = inflate(stream, Z_NO_FLUSH);
        done = out->size_bytes - stream->avail_out;
        if (result == Z_STREAM_END)
            break;
        if (result == Z_BUF_ERROR && stream->avail_out == 0)
            continue;
        if (result != Z_OK)
            return result == Z_BUF_ERROR ? "its compression is cut off" : "its compression is damaged";
        if (stream->avail_in == 0 && stream->avail_out)
            return "its compression is cut off";
    }
    out->size_bytes = done;
    return NULL;
}

static const char *gunzip(const camber_bytes *packed, size_t limit_bytes, camber_bytes *out, camber_status *status) {
    z_stream stream = {.next_in = packed->data, .avail_in = (uInt)packed->size_bytes};
    if (packed->size_bytes > UINT32_MAX / 2)
        return "it is larger than 2 GB";
    /* + 32: zlib detects gzip or zlib by the header. */
    if (inflateInit2(&stream, 15 + 32) != Z_OK)
        return "out of memory";
    out->size_bytes = 0;
    if (out->capacity > 1)
        out->size_bytes = out->capacity - 1 < limit_bytes ? out->capacity - 1 : limit_bytes;
    const char *why = inflate_all(&stream, limit_bytes, out, status);
    inflateEnd(&stream);
    return why;
}

camber_status camber_tile_set_gunzip(camber_tile_set *set, const camber_bytes *packed, size_t limit_bytes,
                                     camber_bytes *out, const char **why) {
    const uint64_t left = camber_budget_unfolds(set->context);
    camber_status status = CAMBER_OK;
    *why = gunzip(packed, left < limit_bytes ? (size_t)left : limit_bytes, out, &status);
    if (*why == TOO_MUCH && left < limit_bytes)
        return camber_budget_unfold(set->context, set->name, left + 1);
    if (status == CAMBER_OK && !*why)
        status = camber_budget_unfold(set->context, set->name, out->size_bytes);
    return status;
}

static bool read_number(const json_t *json, double *number) {
    /* MBTiles stores only texts. */
    char *end = NULL;
    const char *text = json_string_value(json);
    *number = text ? strtod(text, &end) : json_number_value(json);
    return json_is_number(json) || (end && end != text && *end == 0);
}

static void read_zoom(const json_t *about, const char *key, int *zoom) {
    double number;
    if (read_number(json_object_get(about, key), &number) && number >= 0 && number <= 30)
        *zoom = (int)fmin(number, CAMBER_LARGEST_TILE_ZOOM);
}

static bool read_bounds(const json_t *json, double bounds[4]) {
    const char *text = json_string_value(json);
    for (int i = 0; i < 4; i++) {
        if (!text) {
            if (!read_number(json_array_get(json, (size_t)i), &bounds[i]))
                return false;
            continue;
        }
        char *end;
        bounds[i] = strtod(text, &end);
        if (end == text || *end != (i < 3 ? ',' : 0))
            return false;
        text = end + 1;
    }
    return bounds[0] >= -360 && bounds[2] <= 360 && bounds[0] < bounds[2] && bounds[1] >= -90 && bounds[3] <= 90 &&
           bounds[1] < bounds[3];
}

/* If a set is described again, the new attribution replaces the old one. */
static camber_status take_attribution(camber_tile_set *set, const json_t *about) {
    const char *text = json_string_value(json_object_get(about, "attribution"));
    char *copy = text ? camber_copy_string(set->context, text) : NULL;
    if (!text)
        return CAMBER_OK;
    if (!copy)
        return CAMBER_ERROR_MEMORY;
    camber_free(set->context, set->attribution);
    set->attribution = copy;
    return CAMBER_OK;
}

camber_status camber_tile_set_describe(camber_tile_set *set, const json_t *about) {
    double bounds[4];
    read_zoom(about, "minzoom", &set->min_zoom);
    read_zoom(about, "maxzoom", &set->max_zoom);
    if (read_bounds(json_object_get(about, "bounds"), bounds)) {
        memcpy(set->bounds, bounds, sizeof bounds);
        set->has_bounds = true;
    }
    json_t *layers = json_object_get(about, "vector_layers");
    if (json_is_array(layers) && json_array_size(layers)) {
        json_decref(set->layers);
        set->layers = json_incref(layers);
    }
    return take_attribution(set, about);
}
