/* Reads and writes the interchange format for polylines in pixels: little-endian uint32 magic, n polylines, p points; n
 * + 1 uint32 offsets; p pairs of float32. The whole file is checked before any of it is used. */
#include "lines/lines.h"

#include <string.h>

#define MAGIC 0x4c594c50u

static uint32_t get_u32(const unsigned char *bytes) {
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static void put_u32(unsigned char *bytes, uint32_t value) {
    for (int i = 0; i < 4; i++)
        bytes[i] = (unsigned char)(value >> 8 * i);
}

static camber_status check_file(camber_context *context, const unsigned char *bytes, size_t size_bytes,
                                const char *name) {
    if (size_bytes < 12 || get_u32(bytes) != MAGIC)
        return camber_fail(context, CAMBER_ERROR_INPUT,
                           "%s: not a polyline file: it does not begin with 'PLYL'; write one with bench --dump", name);
    const uint64_t n = get_u32(bytes + 4), p = get_u32(bytes + 8);
    const uint64_t wanted = 12 + 4 * (n + 1) + 8 * p;
    if (size_bytes != wanted)
        return camber_fail(
            context, CAMBER_ERROR_INPUT,
            "%s: has %zu bytes, but its header announces %llu; it is cut off or damaged, so write it again", name,
            size_bytes, (unsigned long long)wanted);
    uint32_t before = 0;
    for (uint64_t i = 0; i <= n; i++) {
        const uint32_t offset = get_u32(bytes + 12 + 4 * i);
        if (offset < before || offset > p || (i == 0 && offset != 0) || (i == n && offset != p))
            return camber_fail(
                context, CAMBER_ERROR_INPUT,
                "%s: offset %llu is %u, but offsets must ascend from 0 to %llu; it is damaged, so write it again", name,
                (unsigned long long)i, offset, (unsigned long long)p);
        before = offset;
    }
    return CAMBER_OK;
}

camber_status camber_lines_parse(camber_context *context, const void *bytes, size_t size_bytes, const char *name,
                                 camber_lines *lines) {
    const unsigned char *file = bytes;
    const camber_status status = check_file(context, file, size_bytes, name);
    if (status != CAMBER_OK)
        return status;
    camber_lines made = {.context = context, .polyline_count = get_u32(file + 4), .point_count = get_u32(file + 8)};
    made.offsets = camber_alloc(context, made.polyline_count + 1, sizeof *made.offsets);
    if (made.offsets)
        made.points = camber_alloc(context, made.point_count, 2 * sizeof *made.points);
    if (!made.points) {
        camber_lines_destroy(&made);
        return CAMBER_ERROR_MEMORY;
    }
    for (size_t i = 0; i <= made.polyline_count; i++)
        made.offsets[i] = get_u32(file + 12 + 4 * i);
    const unsigned char *points = file + 12 + 4 * (made.polyline_count + 1);
    for (size_t i = 0; i < 2 * made.point_count; i++) {
        const uint32_t word = get_u32(points + 4 * i);
        memcpy(made.points + i, &word, 4);
    }
    *lines = made;
    return CAMBER_OK;
}

/* Writes words in little-endian order on any host, one block at a time. */
static bool write_words(camber_sink sink, const void *words, size_t count) {
    unsigned char block[4096];
    const char *from = words;
    for (size_t done = 0; done < count;) {
        const size_t some = count - done < sizeof block / 4 ? count - done : sizeof block / 4;
        for (size_t i = 0; i < some; i++) {
            uint32_t word;
            memcpy(&word, from + 4 * (done + i), 4);
            put_u32(block + 4 * i, word);
        }
        if (!sink.write(sink.user, block, 4 * some))
            return false;
        done += some;
    }
    return true;
}

camber_status camber_lines_write(camber_context *context, const camber_lines *lines, camber_sink sink) {
    if (lines->polyline_count >= UINT32_MAX || lines->point_count > UINT32_MAX)
        return camber_fail(context, CAMBER_ERROR_LIMIT,
                           "%zu points do not fit a polyline file's 32-bit counts; write parts", lines->point_count);
    const uint32_t zero = 0;
    const uint32_t head[3] = {MAGIC, (uint32_t)lines->polyline_count, (uint32_t)lines->point_count};
    const bool whole = write_words(sink, head, 3) &&
                       (lines->polyline_count ? write_words(sink, lines->offsets, lines->polyline_count + 1)
                                              : write_words(sink, &zero, 1)) &&
                       write_words(sink, lines->points, 2 * lines->point_count);
    return whole ? CAMBER_OK : CAMBER_ERROR_IO;
}
