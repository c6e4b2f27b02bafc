/* Collects findings about archives, and checks each tile: its address and its bytes. */
#include "archive/contents.h"
#include "archive/pmtiles.h"
#include "archive/tile_check.h"
#include "archive/verify.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

enum { TOLD_OF_A_KIND = 8, CHECKED_OF_A_RUN = 4096 };

static void add_finding(camber_verify *v, bool error, const char *text) {
    char *copy = camber_copy_string(v->context, text);
    if (!copy || !camber_grow(v->context, &v->findings, &v->capacity, v->count + 1, sizeof *v->findings)) {
        camber_free(v->context, copy);
        v->out_of_memory = true;
        return;
    }
    v->findings[v->count++] = (camber_tiles_finding){error, copy};
}

void camber_verify_tell(camber_verify *v, camber_verify_kind kind, bool error, const char *format, ...) {
    char text[1024];
    va_list list;
    if (kind != CAMBER_VERIFY_ARCHIVE && v->told[kind]++ >= TOLD_OF_A_KIND) {
        v->left_out++;
        return;
    }
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    add_finding(v, error, text);
}

void camber_verify_name(uint64_t number, char text[40]) {
    const int zoom = camber_archive_zoom(number);
    uint32_t column, row;
    camber_pmtiles_locate(number - camber_archive_first(zoom), zoom, &column, &row);
    snprintf(text, 40, "%d/%u/%u", zoom, column, row);
}

static double row_of(double latitude) {
    const double most = 85.0511287798066, clamped = fmin(fmax(latitude, -most), most);
    const double sine = sin(clamped * 0.017453292519943295);
    return 0.5 - log((1 + sine) / (1 - sine)) / (4 * 3.141592653589793);
}

static bool is_within(const camber_verify_box *box, uint32_t column, double row) {
    return column >= box->low_column && column <= box->high_column && row >= box->low_row && row <= box->high_row;
}

static void check_place(camber_verify *v, uint64_t number) {
    const int zoom = camber_archive_zoom(number);
    uint32_t column, row;
    char name[40];
    if (zoom < v->archive->min_zoom || zoom > v->archive->max_zoom || zoom > CAMBER_LARGEST_TILE_ZOOM)
        return; /* zooms are reported once for the whole archive */
    camber_pmtiles_locate(number - camber_archive_first(zoom), zoom, &column, &row);
    if (is_within(&v->boxes[zoom], column, row))
        return;
    v->outside++;
    v->flipped += is_within(&v->boxes[zoom], column, ldexp(1, zoom) - 1 - row);
    camber_verify_name(number, name);
    camber_verify_tell(v, CAMBER_VERIFY_BOUNDS, true, "tile %s is outside the bounds", name);
}

/* In a long run, only the first tiles and the last one are checked, because most long runs are seas. */
void camber_verify_bounds(camber_verify *v, const camber_archive_tile *tile) {
    if (!v->archive->has_bounds || tile->outside)
        return;
    for (uint64_t i = 0; i < tile->run_length && i < CHECKED_OF_A_RUN; i++)
        check_place(v, tile->number + i);
    if (tile->run_length > CHECKED_OF_A_RUN)
        check_place(v, tile->number + tile->run_length - 1);
}

static void check_size(camber_verify *v, const char *name, uint32_t width, uint32_t height) {
    if (width == 0)
        return;
    if (v->width == 0) {
        v->width = width;
        v->height = height;
        if (width != height)
            camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true, "tile %s is not square: %u x %u px", name, width,
                               height);
    }
    if (width != v->width || height != v->height)
        camber_verify_tell(v, CAMBER_VERIFY_BYTES, true, "tile %s has %u x %u px, and others %u x %u", name, width,
                           height, v->width, v->height);
}

camber_status camber_verify_bytes(camber_verify *v, const char *name, const camber_bytes *bytes) {
    const camber_bytes *plain = bytes;
    const char *why = NULL;
    uint32_t width, height;
    if (v->archive->checksum[0] &&
        !camber_checksum_add(&v->checksum, camber_content_hash(bytes->data, bytes->size_bytes)))
        return CAMBER_ERROR_MEMORY;
    const bool packed = bytes->size_bytes > 1 && bytes->data[0] == 0x1f && bytes->data[1] == 0x8b;
    if (bytes->size_bytes == 0) {
        camber_verify_tell(v, CAMBER_VERIFY_BYTES, true, "tile %s is empty", name);
        return CAMBER_OK;
    }
    if (packed != v->archive->gzipped)
        camber_verify_tell(v, CAMBER_VERIFY_BYTES, true,
                           "tile %s is%s compressed with gzip, although the archive says otherwise", name,
                           packed ? "" : " not");
    if (packed) {
        camber_tile_set naming = {.context = v->context, .name = v->archive->path};
        const camber_status status =
            camber_tile_set_gunzip(&naming, bytes, CAMBER_ARCHIVE_LARGEST_TILE_BYTES, &v->unpacked, &why);
        if (status != CAMBER_OK)
            return status;
        plain = &v->unpacked;
    }
    if (why) {
        camber_verify_tell(v, CAMBER_VERIFY_BYTES, true, "tile %s: %s", name, why);
        return CAMBER_OK;
    }
    why = camber_tile_check(v->archive->type, plain->data, plain->size_bytes, &width, &height);
    if (why)
        camber_verify_tell(v, CAMBER_VERIFY_BYTES, true, "tile %s %s", name, why);
    else
        check_size(v, name, width, height);
    return CAMBER_OK;
}

/* The slack is for bounds that are rounded to 10^-7 degrees. */
void camber_verify_find_boxes(camber_verify *v) {
    const double *b = v->archive->bounds;
    for (int zoom = 0; zoom <= CAMBER_LARGEST_TILE_ZOOM; zoom++) {
        const double side = ldexp(1, zoom), slack = 1e-9 * side + 1e-6;
        v->boxes[zoom] =
            (camber_verify_box){floor((b[0] + 180) / 360 * side - slack), floor((b[2] + 180) / 360 * side + slack),
                                floor(row_of(b[3]) * side - slack), floor(row_of(b[1]) * side + slack)};
    }
}
