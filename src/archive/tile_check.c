/* Checks the structure of tiles: signatures, lengths, checksums. Pixels are not decoded: in a PNG, a checksum covers
 * them, and in a WebP, their length must match the length of the file. */
#include "archive/tile_check.h"

#include <zlib.h>

static uint32_t big_endian(const unsigned char *at) {
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

static uint32_t little_endian(const unsigned char *at, size_t size) {
    uint32_t number = 0;
    for (size_t i = 0; i < size; i++)
        number |= (uint32_t)at[i] << 8 * i;
    return number;
}

/* A PNG consists of chunks: a length, a name of four letters, that many bytes, and their CRC. */
static const char *check_png(const unsigned char *bytes, size_t size, uint32_t *width, uint32_t *height) {
    bool has_pixels = false;
    if (size < 8 || memcmp(bytes, "\x89PNG\r\n\x1a\n", 8) != 0)
        return "is not a PNG";
    for (size_t at = 8; size - at >= 12;) {
        const uint32_t length = big_endian(bytes + at);
        const unsigned char *name = bytes + at + 4;
        if (length > size - at - 12)
            break;
        if (big_endian(name + 4 + length) != (uint32_t)crc32(crc32(0, NULL, 0), name, length + 4))
            return "is a damaged PNG: a checksum does not match";
        if (at == 8 && (memcmp(name, "IHDR", 4) != 0 || length != 13))
            return "is a PNG without a header";
        if (at == 8) {
            *width = big_endian(name + 4);
            *height = big_endian(name + 8);
        }
        has_pixels = has_pixels || memcmp(name, "IDAT", 4) == 0;
        at += 12 + (size_t)length;
        if (memcmp(name, "IEND", 4) != 0)
            continue;
        if (!has_pixels)
            return "is a PNG without pixels";
        return at == size ? NULL : "is a PNG with bytes after its end";
    }
    return "is a PNG that is cut off";
}

/* A WebP is a RIFF file: a length, WEBP, and a first chunk that states the size in one of three ways. */
static const char *check_webp(const unsigned char *bytes, size_t size, uint32_t *width, uint32_t *height) {
    if (size < 12 || memcmp(bytes, "RIFF", 4) != 0 || memcmp(bytes + 8, "WEBP", 4) != 0)
        return "is not a WebP";
    if (size < 30)
        return "is a WebP that is cut off";
    const uint64_t told = (uint64_t)little_endian(bytes + 4, 4) + 8;
    if (told != size)
        return told > size ? "is a WebP that is cut off" : "is a WebP with bytes after its end";
    const unsigned char *chunk = bytes + 12, *data = bytes + 20;
    if (memcmp(chunk, "VP8X", 4) == 0) {
        *width = little_endian(data + 4, 3) + 1;
        *height = little_endian(data + 7, 3) + 1;
    } else if (memcmp(chunk, "VP8L", 4) == 0 && data[0] == 0x2f) {
        const uint32_t bits = little_endian(data + 1, 4);
        *width = (bits & 0x3fff) + 1;
        *height = (bits >> 14 & 0x3fff) + 1;
    } else if (memcmp(chunk, "VP8 ", 4) == 0 && memcmp(data + 3, "\x9d\x01\x2a", 3) == 0) {
        *width = little_endian(data + 6, 2) & 0x3fff;
        *height = little_endian(data + 8, 2) & 0x3fff;
    } else {
        return "is a damaged WebP: it has no picture";
    }
    return NULL;
}

static bool take_varint(const unsigned char **at, const unsigned char *end, uint64_t *value) {
    *value = 0;
    for (int shift = 0; shift < 64 && *at < end; shift += 7) {
        const unsigned char byte = *(*at)++;
        *value |= (uint64_t)(byte & 127) << shift;
        if (byte < 128)
            return true;
    }
    return false;
}

/* A vector tile is a message whose fields are layers: field 3, with a length. */
static const char *check_vector(const unsigned char *bytes, size_t size) {
    const unsigned char *at = bytes, *end = bytes + size;
    while (at < end) {
        uint64_t key, length;
        if (!take_varint(&at, end, &key) || (key & 7) != 2 || key >> 3 == 0)
            return "is not a vector tile";
        if (!take_varint(&at, end, &length) || length > (uint64_t)(end - at))
            return "is a vector tile that is cut off";
        at += length;
    }
    return NULL;
}

static const char *check_glb(const unsigned char *bytes, size_t size) {
    if (size < 12 || memcmp(bytes, "glTF", 4) != 0 || little_endian(bytes + 4, 4) != 2)
        return "is not a GLB";
    return little_endian(bytes + 8, 4) == size ? NULL : "is a GLB that is cut off";
}

static const char *check_jpeg(const unsigned char *bytes, size_t size) {
    if (size < 4 || bytes[0] != 0xff || bytes[1] != 0xd8)
        return "is not a JPEG";
    return bytes[size - 2] == 0xff && bytes[size - 1] == 0xd9 ? NULL : "is a JPEG that is cut off";
}

const char *camber_tile_check(camber_tile_type type, const unsigned char *bytes, size_t size_bytes, uint32_t *width,
                              uint32_t *height) {
    *width = *height = 0;
    switch (type) {
    case CAMBER_TILE_PNG: return check_png(bytes, size_bytes, width, height);
    case CAMBER_TILE_WEBP: return check_webp(bytes, size_bytes, width, height);
    case CAMBER_TILE_JPEG: return check_jpeg(bytes, size_bytes);
    case CAMBER_TILE_MVT: return check_vector(bytes, size_bytes);
    case CAMBER_TILE_GLB: return check_glb(bytes, size_bytes);
    case CAMBER_TILE_AVIF: return size_bytes < 12 || memcmp(bytes + 4, "ftypavi", 7) != 0 ? "is not an AVIF" : NULL;
    case CAMBER_TILE_MLT:
    case CAMBER_TILE_OTHER: break;
    }
    return NULL;
}

camber_tile_type camber_tile_sniff(const unsigned char *bytes, size_t size_bytes) {
    enum { LAYERS = 0x1a }; /* the key of a layer */
    if (size_bytes < 12)
        return CAMBER_TILE_OTHER;
    if (memcmp(bytes, "\x89PNG", 4) == 0)
        return CAMBER_TILE_PNG;
    if (memcmp(bytes, "RIFF", 4) == 0 && memcmp(bytes + 8, "WEBP", 4) == 0)
        return CAMBER_TILE_WEBP;
    if (bytes[0] == 0xff && bytes[1] == 0xd8)
        return CAMBER_TILE_JPEG;
    if (memcmp(bytes + 4, "ftypavi", 7) == 0)
        return CAMBER_TILE_AVIF;
    if (memcmp(bytes, "glTF", 4) == 0)
        return CAMBER_TILE_GLB;
    const bool packed = (bytes[0] == 0x1f && bytes[1] == 0x8b) || bytes[0] == 0x78;
    return packed || (bytes[0] == LAYERS && !check_vector(bytes, size_bytes)) ? CAMBER_TILE_MVT : CAMBER_TILE_OTHER;
}
