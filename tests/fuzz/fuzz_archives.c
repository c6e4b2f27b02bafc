/* A PMTiles archive whose header is right and whose directories say what they like: deep, in circles, with runs and
 * ranges of any size. Read as a file and through a style's source, within libFuzzer's -timeout.
 *
 *     u8 lowest zoom % 4 | layers named << 2 | gzip << 3 | wrong compression of tiles << 4, u8 highest zoom, u8
 * directories directories, the first is the root: u8 entries | announced wrongly << 7; an entry is u8 step's form |
 * run's form << 2 | size's form << 4 | offset's form << 6, and for each the bytes of its form: 0: a small number of its
 * own, none; 1: u8; 2: u16; 3: u64 tiles: the rest, behind one tile that there is always
 *
 * A number of form 0 is what a good archive has: a step of 1, a run of 1, the tile, a range behind the last; of a leaf
 * (a run of 0) the next directory's range.
 */
#include "base/base.h"
#include "fuzz_tile_file.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { HEADER_BYTES = 127, DIRECTORIES_MAX = 16, ENTRIES_MAX = 64, HIGHEST_ZOOM = 24 };

static const uint8_t one_tile[] = {0x1a, 0x18, 0x78, 0x02, 0x0a, 0x05, 'r',  'o',  'a',  'd',  's',  0x12, 0x0a,
                                   0x18, 0x02, 0x22, 0x06, 0x09, 0x02, 0x02, 0x0a, 0x64, 0x64, 0x28, 0x80, 0x20};
static const char layers[] = "{\"vector_layers\":[{\"id\":\"roads\"}]}";

/* ---- Making ---- */

static void append(fuzz_bytes *to, const void *bytes, size_t size) {
    const camber_sink sink = fuzz_sink(to);
    sink.write(sink.user, bytes, size);
}

typedef struct entry {
    uint64_t step, run, size, offset;
    bool to_tile, to_next; /* size and offset are the tile's, or the next directory's */
} entry;

typedef struct archive {
    unsigned head;
    int highest_zoom;
    entry entries[DIRECTORIES_MAX][ENTRIES_MAX];
    size_t counts[DIRECTORIES_MAX], announced[DIRECTORIES_MAX], directory_count;
    fuzz_bytes directories[DIRECTORIES_MAX], tiles, file;
} archive;

static uint64_t take_number(fuzz_reader *from, unsigned form, uint64_t usual) {
    static const size_t sizes[] = {0, 1, 2, 8};
    return form & 3 ? fuzz_take(from, sizes[form & 3]) : usual;
}

static void read_entry(fuzz_reader *from, entry *made) {
    const unsigned forms = (unsigned)fuzz_take(from, 1);
    *made = (entry){.step = take_number(from, forms, 1), .run = take_number(from, forms >> 2, 1)};
    made->to_tile = made->run && !(forms >> 4);
    made->to_next = !made->run && !(forms >> 4);
    made->size = take_number(from, forms >> 4, sizeof one_tile);
    made->offset = take_number(from, forms >> 6, 0);
}

static void read_input(fuzz_reader *from, archive *made) {
    made->head = (unsigned)fuzz_take(from, 1);
    made->highest_zoom = (int)(fuzz_take(from, 1) % (HIGHEST_ZOOM + 1));
    made->directory_count = 1 + fuzz_take(from, 1) % DIRECTORIES_MAX;
    for (size_t i = 0; i < made->directory_count; i++) {
        const size_t counted = fuzz_take(from, 1);
        made->counts[i] = (counted & 127) % (ENTRIES_MAX + 1);
        made->announced[i] = counted & 128 ? counted << (counted & 31) : made->counts[i];
        for (size_t k = 0; k < made->counts[i]; k++)
            read_entry(from, &made->entries[i][k]);
    }
    append(&made->tiles, one_tile, sizeof one_tile);
    append(&made->tiles, from->bytes, from->size);
}

static void put_varint(fuzz_bytes *to, uint64_t number) {
    for (bool more = true; more; number >>= 7) {
        more = number > 127;
        append(to, &(uint8_t){(uint8_t)((number & 127) | (more ? 128 : 0))}, 1);
    }
}

static void pack(fuzz_bytes *bytes) {
    z_stream stream = {.next_in = bytes->bytes, .avail_in = (uInt)bytes->size};
    fuzz_bytes packed = {.capacity = 64 + 2 * bytes->size};
    REQUIRE(packed.bytes = malloc(packed.capacity));
    REQUIRE(deflateInit2(&stream, 1, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) == Z_OK);
    stream.next_out = packed.bytes;
    stream.avail_out = (uInt)packed.capacity;
    REQUIRE(deflate(&stream, Z_FINISH) == Z_STREAM_END);
    packed.size = packed.capacity - stream.avail_out;
    deflateEnd(&stream);
    free(bytes->bytes);
    *bytes = packed;
}

/* Leaves lie behind each other from the last one on, so that each knows where the next is, and how long. */
static void write_directories(archive *made) {
    uint64_t next_offset = 0, next_bytes = 0;
    for (size_t i = made->directory_count; i-- > 0;) {
        fuzz_bytes *to = &made->directories[i];
        const entry *entries = made->entries[i];
        const size_t count = made->counts[i];
        put_varint(to, made->announced[i]);
        for (size_t k = 0; k < count; k++)
            put_varint(to, entries[k].step - (k == 0));
        for (size_t k = 0; k < count; k++)
            put_varint(to, entries[k].run);
        for (size_t k = 0; k < count; k++)
            put_varint(to, entries[k].to_next ? next_bytes : entries[k].size);
        for (size_t k = 0; k < count; k++)
            put_varint(to, 1 + (entries[k].to_next ? next_offset : entries[k].to_tile ? 0 : entries[k].offset));
        if (made->head & 8)
            pack(to);
        next_offset += next_bytes;
        next_bytes = to->size;
    }
}

static void put_range(uint8_t *to, uint64_t offset, uint64_t size) {
    for (int i = 0; i < 8; i++) {
        to[i] = (uint8_t)(offset >> 8 * i);
        to[8 + i] = (uint8_t)(size >> 8 * i);
    }
}

static void write_file(archive *made) {
    uint8_t header[HEADER_BYTES] = "PMTiles\3";
    fuzz_bytes metadata = {0}, leaves = {0};
    append(&metadata, layers, made->head & 4 ? sizeof layers - 1 : 0);
    if (made->head & 8 && metadata.size)
        pack(&metadata);
    for (size_t i = made->directory_count; i-- > 1;)
        append(&leaves, made->directories[i].bytes, made->directories[i].size);
    const uint64_t behind_root = HEADER_BYTES + made->directories[0].size,
                   behind_metadata = behind_root + metadata.size, behind_leaves = behind_metadata + leaves.size;
    put_range(header + 8, HEADER_BYTES, made->directories[0].size);
    put_range(header + 24, behind_root, metadata.size);
    put_range(header + 40, behind_metadata, leaves.size);
    put_range(header + 56, behind_leaves, made->tiles.size);
    header[97] = made->head & 8 ? 2 : 1;
    header[98] = (uint8_t)(1 + (made->head >> 4));
    header[99] = 1;
    header[100] = (uint8_t)(made->head & 3);
    header[101] = (uint8_t)made->highest_zoom;
    append(&made->file, header, sizeof header);
    append(&made->file, made->directories[0].bytes, made->directories[0].size);
    append(&made->file, metadata.bytes, metadata.size);
    append(&made->file, leaves.bytes, leaves.size);
    append(&made->file, made->tiles.bytes, made->tiles.size);
    free(metadata.bytes);
    free(leaves.bytes);
}

static void free_archive(archive *made) {
    for (size_t i = 0; i < made->directory_count; i++)
        free(made->directories[i].bytes);
    free(made->tiles.bytes);
    free(made->file.bytes);
    free(made);
}

/* ---- All of it ---- */

static void use(fuzz_run *run, const uint8_t *bytes, size_t size) {
    fuzz_reader from = {bytes, size};
    archive *made = calloc(1, sizeof *made);
    REQUIRE(made);
    read_input(&from, made);
    write_directories(made);
    write_file(made);
    /* Instrumented code on two busy cores needs the whole timeout for what usually takes seconds. */
    run->context->budget->desc.tiles /= 16;
    run->context->budget->desc.steps /= 16;
    fuzz_read_tiles(run, made->file.bytes, made->file.size, "pmtiles");
    free_archive(made);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    fuzz_each(bytes, size, use);
    return 0;
}
