/* Reads the wire format of Protocol Buffers: keys, varints, and fields with a length. A reader never reads outside its
 * bytes, whatever they contain. If they are inconsistent, it becomes bad and returns zeros from then on. */
#ifndef CAMBER_OSM_WIRE_H
#define CAMBER_OSM_WIRE_H

#include <stdbool.h>
#include <stdint.h>

typedef struct camber_wire {
    const uint8_t *at, *end;
    bool bad;
} camber_wire;

/* The types of fields in OpenStreetMap's messages. */
enum { CAMBER_WIRE_VARINT = 0, CAMBER_WIRE_BYTES = 2 };

/* The key of a field, which is stored before the field: its number and its type. */
#define CAMBER_WIRE_KEY(number, type) ((uint64_t)(number) << 3 | (uint64_t)(type))

static inline uint64_t camber_wire_fail(camber_wire *wire) {
    wire->bad = true;
    wire->at = wire->end;
    return 0;
}

static inline uint64_t camber_wire_varint(camber_wire *wire) {
    if (wire->at < wire->end && *wire->at < 128)
        return *wire->at++;
    uint64_t value = 0;
    for (unsigned shift = 0; shift < 64 && wire->at < wire->end; shift += 7) {
        const uint8_t byte = *wire->at++;
        value |= (uint64_t)(byte & 127) << shift;
        if (byte < 128)
            return value;
    }
    return camber_wire_fail(wire);
}

/* Reads a number in zigzag coding. */
static inline int64_t camber_wire_signed(camber_wire *wire) {
    const uint64_t value = camber_wire_varint(wire);
    return (int64_t)(value >> 1 ^ (0 - (value & 1)));
}

/* Writes a number in zigzag coding, and returns the position after it. */
static inline uint8_t *camber_wire_put_signed(uint8_t *at, int64_t number) {
    uint64_t value = (uint64_t)number << 1 ^ (number < 0 ? UINT64_MAX : 0);
    for (; value >= 128; value >>= 7)
        *at++ = (uint8_t)(value | 128);
    *at++ = (uint8_t)value;
    return at;
}

/* Returns the content of a field that has a length. */
static inline camber_wire camber_wire_bytes(camber_wire *wire) {
    const uint64_t size = camber_wire_varint(wire);
    if (size > (uint64_t)(wire->end - wire->at)) {
        camber_wire_fail(wire);
        return (camber_wire){wire->end, wire->end, true};
    }
    const uint8_t *start = wire->at;
    wire->at += size;
    return (camber_wire){start, wire->at, false};
}

/* Reads the key of the next field. Returns false at the end, or if the bytes are bad. */
static inline bool camber_wire_next(camber_wire *wire, uint64_t *key) {
    if (wire->at == wire->end)
        return false;
    *key = camber_wire_varint(wire);
    return !wire->bad;
}

/* Skips the content of a field. */
static inline void camber_wire_skip(camber_wire *wire, uint64_t key) {
    static const unsigned sizes[] = {0, 8, 0, 0, 0, 4, 0, 0};
    const unsigned type = key & 7, size = sizes[type];
    if (type == CAMBER_WIRE_VARINT)
        camber_wire_varint(wire);
    else if (type == CAMBER_WIRE_BYTES)
        camber_wire_bytes(wire);
    else if (size && (uint64_t)(wire->end - wire->at) >= size)
        wire->at += size;
    else
        camber_wire_fail(wire);
}

/* Returns how many varints the bytes contain: each ends with a byte without the high bit. */
static inline uint64_t camber_wire_count(const camber_wire *wire) {
    uint64_t count = 0;
    for (const uint8_t *at = wire->at; at < wire->end; at++)
        count += *at < 128;
    return count;
}

#endif
