/* Verifies PMTiles files: the header and the directories, with all rules of the specification and its reference tool,
 * and every content that a directory refers to. */
#include "archive/pmtiles.h"
#include "archive/verify.h"

#include <inttypes.h>

typedef struct entry_walk {
    camber_verify *v;
    camber_pmtiles_header header;
    bool any;
    uint64_t next;        /* the number after the tiles of the last entry */
    uint64_t placed;      /* the end of the contents of all entries so far */
    uint64_t leaf_number; /* the lowest tile number that the leaf may contain */
    uint64_t leaf_bytes;
    bool in_leaf, unordered, deep;
} entry_walk;

/* ---- Sections ---- */

static void check_sections(camber_verify *v, const camber_pmtiles_file *file) {
    const camber_pmtiles_header *h = &file->header;
    const struct {
        const char *name;
        camber_pmtiles_range at;
    } sections[] = {{"root directory", h->root},
                    {"metadata section", h->metadata},
                    {"section of leaf directories", h->leaves},
                    {"section of tiles", h->tiles}};
    uint64_t sum = 0;
    for (size_t i = 0; i < sizeof sections / sizeof *sections; i++) {
        const camber_pmtiles_range at = sections[i].at;
        if (at.offset == 0)
            camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true, "the %s begins at 0, where the header is",
                               sections[i].name);
        else if (at.offset > file->size_bytes || at.size > file->size_bytes - at.offset)
            camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true, "the %s ends past the end of the file",
                               sections[i].name);
        sum += at.size;
    }
    for (size_t i = 0; i < 4; i++)
        for (size_t k = 0; k < i; k++) {
            const camber_pmtiles_range a = sections[i].at, b = sections[k].at;
            if (a.size && b.size && a.offset < b.offset + b.size && b.offset < a.offset + a.size)
                camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true, "the %s and the %s overlap", sections[k].name,
                                   sections[i].name);
        }
    const uint64_t packed = CAMBER_PMTILES_HEADER_BYTES + sum, spaced = 16384 + sum - h->root.size;
    if (file->size_bytes != packed && file->size_bytes != spaced)
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true,
                           "the file has %" PRIu64 " bytes, but its sections add up to %" PRIu64, file->size_bytes,
                           packed);
    if (h->root.offset + h->root.size > 16384)
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true, "the root directory ends past the first 16384 bytes");
    if (h->tile_type > CAMBER_TILE_MLT)
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true, "type %d of tiles does not exist", h->tile_type);
    if (h->clustered > 1)
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true, "clustered is %d, neither 0 nor 1", h->clustered);
    if (!v->archive->set->about)
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true, "the metadata are not JSON");
    else if (!json_is_object(v->archive->set->about))
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true, "the metadata are not a JSON object");
}

/* ---- Entries ---- */

static camber_status take_leaf(void *user, const camber_pmtiles_entry *entry, int depth) {
    entry_walk *walk = user;
    camber_verify *v = walk->v;
    const camber_pmtiles_range leaves = walk->header.leaves;
    walk->leaf_number = entry->number;
    walk->in_leaf = true;
    walk->leaf_bytes += entry->size;
    if (entry->offset > leaves.size || entry->size > leaves.size - entry->offset)
        camber_verify_tell(v, CAMBER_VERIFY_PLACE, true, "a leaf directory is outside the section of leaf directories");
    if (depth > 1 && !walk->deep)
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, false,
                           "leaf directories lead to others, which takes more requests");
    walk->deep = walk->deep || depth > 1;
    return CAMBER_OK;
}

/* Checks the order of contents. In a clustered archive, each content comes after all earlier ones, or is one of
 * them. */
static void check_order(entry_walk *walk, const camber_archive_tile *tile, const char *name) {
    if (tile->offset == walk->placed)
        walk->placed += tile->size_bytes;
    else if (tile->offset > walk->placed && walk->header.clustered == 1)
        camber_verify_tell(walk->v, CAMBER_VERIFY_ORDER, true,
                           "tile %s is out of order, although the archive says that it is clustered", name);
    if (tile->offset > walk->placed)
        walk->placed = tile->offset + tile->size_bytes;
}

static camber_status take_tile(entry_walk *walk, const camber_archive_tile *tile) {
    camber_verify *v = walk->v;
    char name[40];
    camber_verify_name(tile->number, name);
    const uint64_t end = camber_archive_first(CAMBER_LARGEST_TILE_ZOOM + 1);
    if (tile->number >= end || tile->run_length > end - tile->number) {
        camber_verify_tell(v, CAMBER_VERIFY_PLACE, true, "tile number %" PRIu64 " is beyond zoom 24", tile->number);
        return CAMBER_OK;
    }
    if (walk->any && tile->number < walk->next)
        camber_verify_tell(v, CAMBER_VERIFY_ORDER, true, "tile %s occurs twice, or after a later one", name);
    if (walk->in_leaf && tile->number < walk->leaf_number)
        camber_verify_tell(v, CAMBER_VERIFY_ORDER, true, "tile %s is in a leaf directory that begins after it", name);
    walk->any = true;
    walk->next = tile->number + tile->run_length;
    if (tile->size_bytes == 0)
        camber_verify_tell(v, CAMBER_VERIFY_PLACE, true, "tile %s has no bytes", name);
    const uint64_t room = walk->header.tiles.size;
    if (tile->offset > room || tile->size_bytes > room - tile->offset)
        camber_verify_tell(v, CAMBER_VERIFY_PLACE, true, "tile %s ends past the section of tiles", name);
    check_order(walk, tile, name);
    camber_verify_bounds(v, tile);
    return camber_tally_take(&v->tally, tile);
}

static camber_status take_entry(void *user, const camber_pmtiles_entry *entry) {
    const camber_archive_tile tile = {
        .number = entry->number, .run_length = entry->run_length, .offset = entry->offset, .size_bytes = entry->size};
    return take_tile(user, &tile);
}

/* ---- Contents ---- */

/* Compares a count in the header with the real one. 0 in the header means that the count is unknown. */
static void check_count(camber_verify *v, const char *name, uint64_t told, uint64_t counted) {
    if (told && told != counted)
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true, "%s: the header says %" PRIu64 ", but there are %" PRIu64,
                           name, told, counted);
}

/* Checks the ranges of contents, which must leave no gaps and must not overlap. */
static void check_places(camber_verify *v, uint64_t tiles_bytes) {
    uint64_t end = 0, unused = 0;
    size_t overlaps = 0;
    for (size_t i = 0; i < v->tally.place_count; i++) {
        const camber_tally_place *place = &v->tally.places[i];
        const uint64_t range_end = place->offset + place->size_bytes;
        unused += place->offset > end ? place->offset - end : 0;
        overlaps += place->offset < end && place->size_bytes;
        end = range_end > end ? range_end : end;
    }
    unused += tiles_bytes > end ? tiles_bytes - end : 0;
    if (overlaps)
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, false, "%zu contents overlap others", overlaps);
    if (unused)
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, false,
                           "%" PRIu64 " bytes of the section of tiles belong to no tile", unused);
}

static camber_status check_contents(camber_verify *v) {
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < v->tally.place_count && status == CAMBER_OK; i++) {
        const camber_tally_place *place = &v->tally.places[i];
        const camber_archive_tile tile = {
            .number = place->number, .offset = place->offset, .size_bytes = place->size_bytes};
        const char *why;
        char name[40];
        camber_verify_name(place->number, name);
        status = camber_archive_read(v->archive, &tile, &v->bytes, &why);
        if (status == CAMBER_OK && why)
            camber_verify_tell(v, CAMBER_VERIFY_BYTES, true, "tile %s: %s", name, why);
        else if (status == CAMBER_OK && place->size_bytes)
            status = camber_verify_bytes(v, name, &v->bytes);
        camber_progress_count(v->context, "verifying", "tiles", i + 1, v->tally.place_count);
    }
    return status;
}

camber_status camber_verify_pmtiles(camber_verify *v) {
    const camber_pmtiles_file file = camber_pmtiles_get_file(v->archive->set);
    entry_walk walk = {.v = v, .header = file.header};
    const camber_pmtiles_visitor visitor = {0, UINT64_MAX, take_entry, take_leaf, &walk};
    check_sections(v, &file);
    const camber_status status = camber_pmtiles_walk(v->archive->set, &visitor);
    if (status != CAMBER_OK)
        return status;
    camber_tally_sum(&v->tally, CAMBER_ARCHIVE_PMTILES);
    check_count(v, "addressed tiles", file.header.addressed, v->tally.tiles);
    check_count(v, "entries", file.header.entries, v->tally.entries);
    check_count(v, "contents", file.header.contents, v->tally.contents);
    if (walk.leaf_bytes < file.header.leaves.size)
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, false, "%" PRIu64 " bytes of leaf directories belong to none",
                           file.header.leaves.size - walk.leaf_bytes);
    check_places(v, file.header.tiles.size);
    return check_contents(v);
}
