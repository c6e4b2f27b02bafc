/* Writes clustered PMTiles 3: header, root directory, tiles from byte 16384 on, metadata, leaf directories.
 *
 * Contents are stored in the order in which tiles first use them. If the writer's own file already has them in this
 * order, this file becomes the archive, and no tile is copied. Runs become entries. If a root directory with all
 * entries does not fit into the first 16 KB, entries move to leaves, which grow until the root directory of the leaves
 * fits. */
#define _XOPEN_SOURCE 700 /* pread, pwrite */
#define _FILE_OFFSET_BITS 64

#include "archive/output_file.h"
#include "archive/pmtiles.h"
#include "archive/writer.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

enum {
    ROOT_BYTES = CAMBER_STORE_BEGIN - CAMBER_PMTILES_HEADER_BYTES,
    LEAST_LEAF = 4096,
    USUAL_LEAVES = 3500,
    COPY_BYTES = 1 << 20
};

typedef struct packed {
    camber_bytes root, leaves, metadata;
    camber_bytes plain; /* a directory before it is compressed */
    uint64_t *offsets;  /* by content */
    uint32_t *order;    /* the contents, sorted by offset */
    size_t content_count;
    uint64_t tiles_bytes;
    camber_pmtiles_entry *entries;
    camber_pmtiles_entry *leaf_entries;
    size_t leaf_count;
} packed;

/* ---- Directories ---- */

static unsigned char *put_varint(unsigned char *at, uint64_t value) {
    for (; value > 127; value >>= 7)
        *at++ = (unsigned char)(value | 128);
    *at++ = (unsigned char)value;
    return at;
}

/* Equal input gives equal bytes, because the gzip header that zlib writes contains no time. */
camber_status camber_archive_gzip(const char *name, const void *bytes, size_t size_bytes, camber_bytes *to) {
    z_stream stream = {.next_in = (Bytef *)(uintptr_t)bytes, .avail_in = (uInt)size_bytes};
    const size_t before = to->size_bytes;
    if (deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) != Z_OK)
        return camber_fail(to->context, CAMBER_ERROR_MEMORY, "%s: not enough memory to compress it; allow more", name);
    if (!camber_bytes_resize(to, before + deflateBound(&stream, (uLong)size_bytes))) {
        deflateEnd(&stream);
        return CAMBER_ERROR_MEMORY;
    }
    stream.next_out = to->data + before;
    stream.avail_out = (uInt)(to->size_bytes - before);
    deflate(&stream, Z_FINISH);
    to->size_bytes -= stream.avail_out;
    deflateEnd(&stream);
    return CAMBER_OK;
}

static camber_status append_directory(const camber_archive_plan *plan, packed *p, const camber_pmtiles_entry *entries,
                                      size_t count, camber_bytes *to) {
    if (!camber_bytes_resize(&p->plain, 10 + 40 * count))
        return CAMBER_ERROR_MEMORY;
    unsigned char *at = put_varint(p->plain.data, count);
    for (size_t i = 0; i < count; i++)
        at = put_varint(at, entries[i].number - (i ? entries[i - 1].number : 0));
    for (size_t i = 0; i < count; i++)
        at = put_varint(at, entries[i].run_length);
    for (size_t i = 0; i < count; i++)
        at = put_varint(at, entries[i].size);
    for (size_t i = 0; i < count; i++) {
        const bool follows = i && entries[i].offset == entries[i - 1].offset + entries[i - 1].size;
        at = put_varint(at, follows ? 0 : entries[i].offset + 1);
    }
    return camber_archive_gzip(plan->desc->path, p->plain.data, (size_t)(at - p->plain.data), to);
}

static camber_status write_leaves(const camber_archive_plan *plan, packed *p, size_t leaf_size) {
    p->leaf_count = 0;
    p->leaves.size_bytes = p->root.size_bytes = 0;
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < plan->run_count && status == CAMBER_OK; i += leaf_size) {
        const size_t count = plan->run_count - i < leaf_size ? plan->run_count - i : leaf_size;
        const size_t before = p->leaves.size_bytes;
        status = append_directory(plan, p, p->entries + i, count, &p->leaves);
        p->leaf_entries[p->leaf_count++] =
            (camber_pmtiles_entry){p->entries[i].number, 0, before, p->leaves.size_bytes - before};
    }
    return status == CAMBER_OK ? append_directory(plan, p, p->leaf_entries, p->leaf_count, &p->root) : status;
}

static camber_status write_directories(const camber_archive_plan *plan, packed *p) {
    /* A reader decompresses the root directory before its first tile, so the root is kept small even if many entries
     * would fit. */
    if (plan->run_count <= ROOT_BYTES) {
        const camber_status status = append_directory(plan, p, p->entries, plan->run_count, &p->root);
        if (status != CAMBER_OK || p->root.size_bytes <= ROOT_BYTES)
            return status;
    }
    size_t leaf_size = plan->run_count / USUAL_LEAVES > LEAST_LEAF ? plan->run_count / USUAL_LEAVES : LEAST_LEAF;
    p->leaf_entries = camber_alloc(plan->context, plan->run_count / leaf_size + 1, sizeof *p->leaf_entries);
    if (!p->leaf_entries)
        return CAMBER_ERROR_MEMORY;
    for (;; leaf_size += leaf_size / 5) {
        const camber_status status = write_leaves(plan, p, leaf_size);
        if (status != CAMBER_OK || p->root.size_bytes <= ROOT_BYTES)
            return status;
    }
}

/* Assigns offsets to the contents, in the order in which tiles first use them. */
static camber_status place(const camber_archive_plan *plan, packed *p) {
    const size_t count = plan->contents->count;
    p->offsets = camber_alloc(plan->context, count, sizeof *p->offsets);
    p->order = camber_alloc(plan->context, count, sizeof *p->order);
    p->entries = camber_alloc(plan->context, plan->run_count, sizeof *p->entries);
    if (!p->offsets || !p->order || !p->entries)
        return CAMBER_ERROR_MEMORY;
    memset(p->offsets, 0xff, count * sizeof *p->offsets);
    for (size_t i = 0; i < plan->run_count; i++) {
        const camber_archive_run *run = &plan->runs[i];
        const camber_content *content = &plan->contents->items[run->content];
        if (p->offsets[run->content] == UINT64_MAX) {
            p->offsets[run->content] = p->tiles_bytes;
            p->order[p->content_count++] = run->content;
            p->tiles_bytes += content->size_bytes;
        }
        p->entries[i] = (camber_pmtiles_entry){run->number, run->length, p->offsets[run->content], content->size_bytes};
    }
    return CAMBER_OK;
}

/* ---- Header ---- */

static unsigned char *put_number(unsigned char *at, uint64_t number, int size) {
    for (int i = 0; i < size; i++)
        *at++ = (unsigned char)(number >> 8 * i);
    return at;
}

static unsigned char *put_degrees(unsigned char *at, double degrees) {
    return put_number(at, (uint32_t)(int32_t)lround(degrees * 1e7), 4);
}

static void write_header(const camber_archive_plan *plan, const packed *p, unsigned char *header) {
    const camber_tile_type type = plan->desc->type <= CAMBER_TILE_MLT ? plan->desc->type : CAMBER_TILE_OTHER;
    const uint64_t range_end = CAMBER_STORE_BEGIN + p->tiles_bytes;
    const camber_pmtiles_range sections[] = {{CAMBER_PMTILES_HEADER_BYTES, p->root.size_bytes},
                                             {range_end, p->metadata.size_bytes},
                                             {range_end + p->metadata.size_bytes, p->leaves.size_bytes},
                                             {CAMBER_STORE_BEGIN, p->tiles_bytes}};
    memcpy(header, "PMTiles\3", 8);
    unsigned char *at = header + 8;
    for (size_t i = 0; i < sizeof sections / sizeof *sections; i++) {
        at = put_number(at, sections[i].offset, 8);
        at = put_number(at, sections[i].size, 8);
    }
    at = put_number(at, plan->tile_count, 8);
    at = put_number(at, plan->run_count, 8);
    at = put_number(at, p->content_count, 8);
    at = put_number(at, 1, 1); /* clustered */
    at = put_number(at, CAMBER_PMTILES_GZIP, 1);
    at = put_number(at, plan->desc->gzipped ? CAMBER_PMTILES_GZIP : CAMBER_PMTILES_PLAIN, 1);
    at = put_number(at, (uint64_t)type, 1);
    at = put_number(at, (uint64_t)plan->min_zoom, 1);
    at = put_number(at, (uint64_t)plan->max_zoom, 1);
    for (size_t i = 0; i < 4; i++)
        at = put_degrees(at, plan->bounds[i]);
    at = put_number(at, (uint64_t)plan->center.zoom, 1);
    at = put_degrees(at, plan->center.longitude);
    put_degrees(at, plan->center.latitude);
}

/* ---- Tiles ---- */

/* The state of copying ranges of a store through a buffer, which is written whenever it is full. */
typedef struct copying {
    const camber_archive_plan *plan;
    int file;
    unsigned char *buffer;
    size_t held_bytes;
    uint64_t offset; /* the buffer's offset in the file */
} copying;

static camber_status drain(copying *c) {
    const camber_status status =
        camber_write_at(c->plan->context, c->plan->whole, c->file, c->buffer, c->held_bytes, c->offset);
    c->offset += c->held_bytes;
    c->held_bytes = 0;
    return status;
}

static camber_status copy_range(copying *c, uint32_t store, uint64_t offset, uint64_t size) {
    while (size) {
        const size_t room = COPY_BYTES - c->held_bytes, piece = size < room ? (size_t)size : room;
        camber_status status = camber_contents_read(c->plan->contents, store, offset, c->buffer + c->held_bytes, piece);
        c->held_bytes += piece;
        if (status == CAMBER_OK && c->held_bytes == COPY_BYTES)
            status = drain(c);
        if (status != CAMBER_OK)
            return status;
        offset += piece;
        size -= piece;
    }
    return CAMBER_OK;
}

/* Copies the contents to the archive. Contents that follow each other directly in a store are copied as one range. */
static camber_status copy_tiles(const camber_archive_plan *plan, const packed *p, int file) {
    copying c = {.plan = plan, .file = file, .offset = CAMBER_STORE_BEGIN};
    const camber_content *items = plan->contents->items;
    camber_status status = CAMBER_OK;
    if (!(c.buffer = camber_alloc(plan->context, COPY_BYTES, 1)))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < p->content_count && status == CAMBER_OK;) {
        const camber_content *first = &items[p->order[i]];
        uint64_t size = first->size_bytes;
        for (i++; i < p->content_count; i++) {
            const camber_content *next = &items[p->order[i]];
            if (next->store != first->store || next->offset != first->offset + size)
                break;
            size += next->size_bytes;
        }
        status = copy_range(&c, first->store, first->offset, size);
        camber_progress_count(plan->context, "copying tiles", "tiles", i, p->content_count);
    }
    if (status == CAMBER_OK)
        status = drain(&c);
    camber_free(plan->context, c.buffer);
    return status;
}

/* Whether the writer's own file contains exactly the contents of the archive, at the same offsets. */
static bool has_order(const camber_archive_plan *plan, const packed *p) {
    const camber_contents *contents = plan->contents;
    for (size_t i = 0; i < p->content_count; i++) {
        const camber_content *item = &contents->items[p->order[i]];
        if (item->store != 0 || item->offset != p->offsets[p->order[i]])
            return false;
    }
    return p->tiles_bytes > 0 && p->tiles_bytes == contents->written_bytes;
}

/* ---- The file ---- */

/* Writes everything but the tiles, which are in the middle. */
static camber_status write_around(const camber_archive_plan *plan, const packed *p, int file) {
    unsigned char head[CAMBER_STORE_BEGIN] = {0};
    uint64_t offset = sizeof head + p->tiles_bytes;
    write_header(plan, p, head);
    memcpy(head + CAMBER_PMTILES_HEADER_BYTES, p->root.data, p->root.size_bytes);
    camber_status status = camber_write_at(plan->context, plan->whole, file, head, sizeof head, 0);
    const camber_bytes *const parts[] = {&p->metadata, &p->leaves};
    for (size_t i = 0; i < sizeof parts / sizeof *parts && status == CAMBER_OK; i++) {
        status = camber_write_at(plan->context, plan->whole, file, parts[i]->data, parts[i]->size_bytes, offset);
        offset += parts[i]->size_bytes;
    }
    if (status == CAMBER_OK && ftruncate(file, (off_t)offset) != 0)
        status = camber_output_fail(plan->context, plan->whole, errno);
    return status;
}

static camber_status write_copy(const camber_archive_plan *plan, const packed *p) {
    const int file = open(plan->whole, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0)
        return camber_output_fail(plan->context, plan->whole, errno);
    camber_status status = copy_tiles(plan, p, file);
    if (status == CAMBER_OK)
        status = write_around(plan, p, file);
    if (status == CAMBER_OK)
        return camber_sync_and_close(plan->context, plan->whole, file);
    close(file);
    return status;
}

/* Gives the file of tiles a second name. The first name stays, so that an interrupted run finds the file by it. Returns
 * false if the file system does not support this, or if the first name is a link that leads to another folder. */
static bool give_second_name(const camber_archive_plan *plan) {
    const camber_content_store *own = &plan->contents->stores[0];
    struct stat first, second;
    (void)link(own->name, plan->whole);
    if (lstat(plan->whole, &second) != 0)
        return false;
    if (fstat(own->descriptor, &first) == 0 && first.st_ino == second.st_ino && first.st_dev == second.st_dev)
        return true;
    (void)unlink(plan->whole);
    return false;
}

static camber_status finish_in_place(const camber_archive_plan *plan, const packed *p) {
    const int file = plan->contents->stores[0].descriptor;
    const camber_status status = write_around(plan, p, file);
    return status == CAMBER_OK ? camber_sync(plan->context, plan->whole, file) : status;
}

static camber_status write_file(const camber_archive_plan *plan, const packed *p) {
    return has_order(plan, p) && give_second_name(plan) ? finish_in_place(plan, p) : write_copy(plan, p);
}

static camber_status pack_metadata(const camber_archive_plan *plan, packed *p) {
    char *text = json_dumps(plan->metadata, JSON_COMPACT | JSON_SORT_KEYS);
    if (!text)
        return camber_fail(plan->context, CAMBER_ERROR_MEMORY, "%s: not enough memory for the metadata; allow more",
                           plan->desc->path);
    const camber_status status = camber_archive_gzip(plan->desc->path, text, strlen(text), &p->metadata);
    free(text);
    return status;
}

camber_status camber_archive_write_pmtiles(const camber_archive_plan *plan) {
    packed p = {.root.context = plan->context,
                .leaves.context = plan->context,
                .metadata.context = plan->context,
                .plain.context = plan->context};
    camber_status status = place(plan, &p);
    if (status == CAMBER_OK)
        status = pack_metadata(plan, &p);
    if (status == CAMBER_OK)
        status = write_directories(plan, &p);
    if (status == CAMBER_OK)
        status = write_file(plan, &p);
    camber_free(plan->context, p.offsets);
    camber_free(plan->context, p.order);
    camber_free(plan->context, p.entries);
    camber_free(plan->context, p.leaf_entries);
    camber_bytes_free(&p.root);
    camber_bytes_free(&p.leaves);
    camber_bytes_free(&p.metadata);
    camber_bytes_free(&p.plain);
    return status;
}
