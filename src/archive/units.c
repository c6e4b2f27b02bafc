/* The journal: a header with a key that identifies the archive, then records of 32 bytes.
 *
 * The records of a unit are written when it ends, after its contents. A last record closes the unit with a hash of all
 * records before it. If a process dies, only the end of its journal can be incomplete. A reader accepts a unit only if
 * the hash of its records and the hashes of all its contents match. */
#define _XOPEN_SOURCE 700 /* pread, ftruncate */
#define _FILE_OFFSET_BITS 64

#include "archive/units.h"
#include "archive/archive.h"
#include "archive/output_file.h"

#include <errno.h>
#include <stdlib.h>
#include <unistd.h>

enum { KEY_BYTES = 480, READ_AT_ONCE = 4096 };

typedef struct head {
    char magic[24];
    uint64_t hash; /* of the key */
    char key[KEY_BYTES];
} head;

static const char MAGIC[24] = "camber finished units 2";

/* ---- Writing ---- */

static head head_of(const char *key) {
    head made = {.hash = camber_content_hash(key, strlen(key))};
    memcpy(made.magic, MAGIC, sizeof MAGIC);
    strncpy(made.key, key, KEY_BYTES - 1);
    return made;
}

camber_status camber_units_begin(camber_units *units, const char *key) {
    const head made = head_of(key);
    units->written_bytes = sizeof made;
    units->chain = made.hash;
    if (ftruncate(units->descriptor, 0) != 0)
        return camber_output_fail(units->context, units->name, errno);
    return camber_write_at(units->context, units->name, units->descriptor, &made, sizeof made, 0);
}

camber_status camber_units_add(camber_units *units, const camber_unit_record *record) {
    if (!camber_grow(units->context, &units->pending, &units->pending_capacity, units->pending_count + 1,
                     sizeof *units->pending))
        return CAMBER_ERROR_MEMORY;
    units->pending[units->pending_count++] = *record;
    return CAMBER_OK;
}

camber_status camber_units_end(camber_units *units, uint64_t unit, uint64_t contents_bytes) {
    const uint64_t chain =
        camber_mix(units->chain, camber_content_hash(units->pending, units->pending_count * sizeof *units->pending));
    const camber_unit_record last = {CAMBER_UNIT_END, 0, unit, contents_bytes,
                                     camber_mix(camber_mix(chain, unit), contents_bytes)};
    camber_status status = camber_units_add(units, &last);
    if (status != CAMBER_OK)
        return status;
    const size_t size = units->pending_count * sizeof *units->pending;
    status =
        camber_write_at(units->context, units->name, units->descriptor, units->pending, size, units->written_bytes);
    units->pending_count--; /* the caller may retry after a failure */
    if (status != CAMBER_OK)
        return status;
    units->written_bytes += size;
    units->chain = last.hash;
    units->pending_count = 0;
    return CAMBER_OK;
}

/* ---- Reading ---- */

typedef struct reading {
    camber_units *units;
    camber_contents *contents;
    const camber_unit_taker *taker;
    uint64_t contents_bytes; /* the end of the contents of all complete units */
    unsigned char *bytes;
    size_t capacity;
    uint32_t *found; /* the contents of the pending records */
    size_t found_capacity;
} reading;

/* Reads up to count records from an offset on. Returns how many were read. */
static size_t read_records(const camber_units *units, uint64_t offset, camber_unit_record *records, size_t count) {
    ssize_t got;
    do
        got = pread(units->descriptor, records, count * sizeof *records, (off_t)offset);
    while (got < 0 && errno == EINTR);
    return got > 0 ? (size_t)got / sizeof *records : 0;
}

/* Reads the content of a record, and looks it up or registers it. *whole: the content exists, and its hash matches. */
static camber_status take_content(reading *r, const camber_unit_record *record, uint64_t *end, uint32_t *index,
                                  bool *whole) {
    const uint64_t range_end = record->offset + record->size_bytes;
    if (record->size_bytes == 0 || range_end < record->offset || record->offset > *end ||
        (record->offset < *end && range_end > *end))
        return CAMBER_OK;
    if (!camber_grow(r->units->context, &r->bytes, &r->capacity, record->size_bytes, 1))
        return CAMBER_ERROR_MEMORY;
    if (camber_contents_read(r->contents, 0, record->offset, r->bytes, record->size_bytes) != CAMBER_OK ||
        camber_content_hash(r->bytes, record->size_bytes) != record->hash)
        return CAMBER_OK;
    camber_status status = camber_contents_find(r->contents, r->bytes, record->size_bytes, record->hash, index);
    if (status == CAMBER_OK && *index == CAMBER_NO_CONTENT && record->offset == *end) {
        const camber_content made = {record->hash, record->offset, record->size_bytes, 0};
        status = camber_contents_note(r->contents, &made, index);
        *end = range_end;
    }
    *whole = *index != CAMBER_NO_CONTENT;
    return status;
}

/* Accepts the pending records if they are valid. last: the record that closes their unit. */
static camber_status take_unit(reading *r, const camber_unit_record *last, bool *whole) {
    camber_units *units = r->units;
    const size_t count = units->pending_count;
    uint64_t chain = camber_mix(units->chain, camber_content_hash(units->pending, count * sizeof *units->pending));
    chain = camber_mix(camber_mix(chain, last->number), last->offset);
    *whole = chain == last->hash;
    if (!camber_grow(units->context, &r->found, &r->found_capacity, count, sizeof *r->found))
        return CAMBER_ERROR_MEMORY;
    uint64_t end = r->contents_bytes;
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < count && *whole && status == CAMBER_OK; i++) {
        r->found[i] = CAMBER_NO_CONTENT;
        if (units->pending[i].kind == CAMBER_UNIT_REMOVED)
            continue;
        *whole = false;
        status = take_content(r, &units->pending[i], &end, &r->found[i], whole);
    }
    *whole = *whole && end == last->offset;
    for (size_t i = 0; i < count && *whole && status == CAMBER_OK; i++)
        status = r->taker->take_tile(r->taker->user, units->pending[i].number, r->found[i]);
    if (!*whole || status != CAMBER_OK)
        return status;
    if (!camber_grow(units->context, &units->done, &units->done_capacity, units->done_count + 1, sizeof *units->done))
        return CAMBER_ERROR_MEMORY;
    units->done[units->done_count++] = last->number;
    units->written_bytes += (count + 1) * sizeof *last;
    units->chain = last->hash;
    r->contents_bytes = end;
    return CAMBER_OK;
}

static camber_status read_units(reading *r, camber_unit_record *records) {
    camber_units *units = r->units;
    uint64_t offset = units->written_bytes;
    bool whole = true;
    camber_status status = CAMBER_OK;
    for (size_t count = 1; count && whole && status == CAMBER_OK; offset += count * sizeof *records) {
        count = read_records(units, offset, records, READ_AT_ONCE);
        for (size_t i = 0; i < count && whole && status == CAMBER_OK; i++) {
            if (records[i].kind != CAMBER_UNIT_END) {
                status = camber_units_add(units, &records[i]);
                continue;
            }
            status = take_unit(r, &records[i], &whole);
            units->pending_count = 0;
        }
    }
    units->pending_count = 0;
    return status;
}

static int compare_units(const void *left, const void *right) {
    const uint64_t a = *(const uint64_t *)left, b = *(const uint64_t *)right;
    return a < b ? -1 : a > b;
}

static camber_status cut(reading *r) {
    camber_units *units = r->units;
    camber_contents_cut(r->contents, r->contents_bytes); /* removes contents of units that were not accepted */
    if (ftruncate(units->descriptor, (off_t)units->written_bytes) != 0)
        return camber_output_fail(units->context, units->name, errno);
    const camber_content_store *own = &r->contents->stores[0];
    if (ftruncate(own->descriptor, (off_t)(own->offset + r->contents_bytes)) != 0)
        return camber_output_fail(units->context, own->name, errno);
    if (units->done_count)
        qsort(units->done, units->done_count, sizeof *units->done, compare_units);
    return CAMBER_OK;
}

static camber_status resume(reading *r) {
    camber_unit_record *records = camber_alloc(r->units->context, READ_AT_ONCE, sizeof *records);
    if (!records)
        return CAMBER_ERROR_MEMORY;
    /* It is not known yet how much of the file is valid, so contents are read up to its end. */
    camber_saved_log kept;
    r->contents->written_bytes = INT64_MAX;
    camber_log_demote_errors(r->units->context, &kept);
    camber_status status = read_units(r, records);
    camber_log_restore(r->units->context, &kept);
    if (status == CAMBER_OK)
        status = cut(r);
    camber_free(r->units->context, records);
    camber_free(r->units->context, r->bytes);
    camber_free(r->units->context, r->found);
    return status;
}

camber_status camber_units_resume(camber_units *units, const char *key, camber_contents *contents,
                                  const camber_unit_taker *taker) {
    const head wanted = head_of(key);
    head found;
    const ssize_t got = pread(units->descriptor, &found, sizeof found, 0);
    if (got < 0)
        return camber_file_fail(units->context, units->name, errno);
    if (got != (ssize_t)sizeof found || memcmp(found.magic, MAGIC, sizeof MAGIC) != 0)
        return camber_units_begin(units, key);
    if (found.hash != wanted.hash) {
        char names[256];
        found.key[KEY_BYTES - 1] = 0;
        camber_fingerprint_compare(found.key, key, names, sizeof names);
        return camber_fail(units->context, CAMBER_ERROR_INPUT,
                           "%s: the interrupted run differs in its %s; start again without --resume, or give the same "
                           "input and options",
                           units->name, names);
    }
    units->written_bytes = sizeof found;
    units->chain = found.hash;
    reading r = {.units = units, .contents = contents, .taker = taker};
    return resume(&r);
}

bool camber_units_has(const camber_units *units, uint64_t unit) {
    return units->done_count &&
           bsearch(&unit, units->done, units->done_count, sizeof *units->done, compare_units) != NULL;
}

void camber_units_free(camber_units *units) {
    if (!units->context)
        return;
    camber_free(units->context, units->pending);
    camber_free(units->context, units->done);
}

/* ---- Fingerprints ---- */

static bool has_word(const char *text, const char *word, size_t length) {
    for (const char *at = text; *at;) {
        const size_t size = strcspn(at, " ");
        if (size == length && strncmp(at, word, length) == 0)
            return true;
        at += size + (at[size] == ' ');
    }
    return false;
}

static void put_differing(const char *text, const char *other, char *names, size_t size) {
    for (const char *at = text; *at;) {
        const size_t length = strcspn(at, " ");
        const size_t name = strcspn(at, " =");
        const size_t used = strlen(names);
        char word[64];
        snprintf(word, sizeof word, "%.*s", (int)(name < 60 ? name : 60), at);
        if (length && !has_word(other, at, length) && !strstr(names, word))
            snprintf(names + used, size - used, "%s%s", used ? ", " : "", word);
        at += length + (at[length] == ' ');
    }
}

void camber_fingerprint_compare(const char *one, const char *other, char *names, size_t size) {
    names[0] = 0;
    put_differing(one, other, names, size);
    put_differing(other, one, names, size);
    if (!names[0])
        snprintf(names, size, "fingerprint");
}
