/* Records which labels are in each tile of an archive.
 *
 * Input: the labels of some zooms. Output: for each tile that labels touch, a hash of how they look; as a file, these
 * pairs of numbers behind a magic number, and a checksum. Main idea: new data may move labels far from what has
 * changed, and a label that has moved touches tiles whose lines are the same as before. Two records show which tiles
 * these are. */
#include "tiles/label_record.h"

#include "archive/contents.h"
#include "archive/output_file.h"
#include "archive/pmtiles.h"
#include "base/open_file.h"

#include <math.h>
#include <stdlib.h>

/* The words before the entries, and after them: the checksum. */
static const uint64_t MAGIC = UINT64_C(0x316c6562616c6d63);

/* ---- Making ---- */

typedef struct recording {
    camber_label_record *record;
    int zoom;
} recording;

/* Adds a label to the tiles of a block that it touches: one entry for each label and tile. */
static camber_status take(void *user, const camber_label_square *block, const camber_shown_label *label) {
    const recording *r = user;
    camber_label_record *record = r->record;
    const double tiles = exp2(r->zoom), size = exp2(r->zoom - block->level);
    const double first[2] = {block->column * size, block->row * size};
    const double x0 = fmax(floor(label->box.x0 * tiles), first[0]), y0 = fmax(floor(label->box.y0 * tiles), first[1]);
    const double x1 = fmin(ceil(label->box.x1 * tiles), first[0] + size);
    const double y1 = fmin(ceil(label->box.y1 * tiles), first[1] + size);
    for (double y = y0; y < y1; y += 1.0)
        for (double x = x0; x < x1; x += 1.0) {
            if (!camber_grow(record->context, &record->entries, &record->capacity, record->count + 1,
                             sizeof *record->entries))
                return CAMBER_ERROR_MEMORY;
            record->entries[record->count++] = (camber_label_entry){
                camber_pmtiles_number(r->zoom, (uint32_t)x, (uint32_t)y), camber_mix(0, label->appearance)};
        }
    return CAMBER_OK;
}

static int compare(const void *left, const void *right) {
    const camber_label_entry *a = left, *b = right;
    return a->tile < b->tile ? -1 : a->tile > b->tile;
}

/* Sums the hashes of each tile up, whose order does not matter. */
static void sum_up(camber_label_record *record, size_t first) {
    size_t kept = first;
    if (record->count > first)
        qsort(record->entries + first, record->count - first, sizeof *record->entries, compare);
    for (size_t i = first; i < record->count; i++) {
        if (kept > first && record->entries[kept - 1].tile == record->entries[i].tile)
            record->entries[kept - 1].hash += record->entries[i].hash;
        else
            record->entries[kept++] = record->entries[i];
    }
    record->count = kept;
}

camber_status camber_label_record_make(camber_tiles_engine *engine, int min_zoom, int max_zoom,
                                       camber_label_record *record) {
    static const camber_box world = {0.0, 0.0, 1.0, 1.0};
    camber_status status = CAMBER_OK;
    *record = (camber_label_record){.context = engine->context};
    for (int zoom = min_zoom; zoom <= max_zoom && status == CAMBER_OK; zoom++) {
        camber_engine_zoom *planned;
        camber_zoom_labels *labels = NULL;
        const size_t first = record->count;
        recording r = {record, zoom};
        status = camber_engine_plan_zoom(engine, zoom, &planned);
        if (status == CAMBER_OK)
            status = camber_engine_get_labels(engine, zoom, &labels);
        if (status == CAMBER_OK && labels)
            status = camber_zoom_labels_list(labels, &world, take, &r);
        sum_up(record, first);
    }
    return status;
}

void camber_label_record_free(camber_label_record *record) {
    if (!record->context)
        return;
    camber_free(record->context, record->entries);
    *record = (camber_label_record){0};
}

/* ---- Files ---- */

static uint64_t check_of(const camber_label_entry *entries, size_t count) {
    return count ? camber_content_hash((const uint8_t *)entries, count * sizeof *entries) : 0;
}

camber_status camber_label_record_write(const camber_label_record *record, const char *path) {
    camber_context *context = record->context;
    const uint64_t head[2] = {MAGIC, record->count}, check = check_of(record->entries, record->count);
    const size_t size_bytes = record->count * sizeof *record->entries;
    camber_whole_file output;
    camber_status status = camber_output_begin(context, path, &output);
    if (status != CAMBER_OK)
        return status;
    status = camber_write_at(context, path, output.file, head, sizeof head, 0);
    if (status == CAMBER_OK && size_bytes)
        status = camber_write_at(context, path, output.file, record->entries, size_bytes, sizeof head);
    if (status == CAMBER_OK)
        status = camber_write_at(context, path, output.file, &check, sizeof check, sizeof head + size_bytes);
    return camber_output_end(context, &output, status, true);
}

/* Takes the entries from the bytes of a file. false: it is not a record, or it is damaged. */
static bool parse(camber_label_record *record, const char *bytes, size_t size_bytes) {
    uint64_t head[2], check;
    if (size_bytes < sizeof head + sizeof check)
        return false;
    memcpy(head, bytes, sizeof head);
    memcpy(&check, bytes + size_bytes - sizeof check, sizeof check);
    const size_t rest = size_bytes - sizeof head - sizeof check;
    if (head[0] != MAGIC || rest % sizeof *record->entries || head[1] != rest / sizeof *record->entries)
        return false;
    memcpy(record->entries, bytes + sizeof head, rest);
    record->count = (size_t)head[1];
    bool good = check_of(record->entries, record->count) == check;
    for (size_t i = 1; i < record->count && good; i++)
        good = record->entries[i - 1].tile < record->entries[i].tile;
    return good;
}

camber_status camber_label_record_read(camber_context *context, const char *path, camber_label_record *record) {
    char *bytes = NULL;
    size_t size_bytes = 0;
    *record = (camber_label_record){.context = context};
    camber_status status = camber_read_file(context, path, CAMBER_NAMED_BY_CALLER, &bytes, &size_bytes);
    if (status != CAMBER_OK)
        return status;
    if (!(record->entries = camber_alloc(context, size_bytes, 1)))
        status = CAMBER_ERROR_MEMORY;
    else if (!parse(record, bytes, size_bytes))
        status =
            camber_fail(context, CAMBER_ERROR_INPUT,
                        "%s: not a record of labels, or damaged; draw the archive again with --label-record", path);
    camber_free(context, bytes);
    return status;
}

/* ---- Comparing ---- */

static int compare_numbers(const void *left, const void *right) {
    uint64_t a, b;
    memcpy(&a, left, sizeof a);
    memcpy(&b, right, sizeof b);
    return a < b ? -1 : a > b;
}

camber_status camber_label_record_add_changed(const camber_label_record *before, const camber_label_record *now,
                                              camber_tiles_area *area, uint64_t *added) {
    size_t count = area->tile_count, kept = 0;
    uint64_t *all = camber_alloc(area->context, count + before->count + now->count, sizeof *all);
    if (!all)
        return CAMBER_ERROR_MEMORY;
    if (count)
        memcpy(all, area->tiles, count * sizeof *all);
    for (size_t i = 0, k = 0; i < before->count || k < now->count;) {
        static const camber_label_entry last = {.tile = UINT64_MAX};
        const camber_label_entry *a = i < before->count ? before->entries + i : &last;
        const camber_label_entry *b = k < now->count ? now->entries + k : &last;
        if (a->tile != b->tile || a->hash != b->hash)
            all[count++] = a->tile < b->tile ? a->tile : b->tile;
        i += a->tile <= b->tile;
        k += b->tile <= a->tile;
    }
    if (count)
        qsort(all, count, sizeof *all, compare_numbers);
    for (size_t i = 0; i < count; i++)
        if (kept == 0 || all[kept - 1] != all[i])
            all[kept++] = all[i];
    *added = kept - area->tile_count;
    camber_free(area->context, area->tiles);
    area->tiles = all;
    area->tile_count = kept;
    return CAMBER_OK;
}
