/* A PBF file of OpenStreetMap: a whole one; or the content of a blob, which needs no packing to be reached; or, behind
 * a byte that no content begins with, that of a packed one. The same bytes are also a coast:
 *
 *     box: i16 left, right, bottom, top; ways: u8 places, % 16; places: i16 longitude, i16 latitude
 *
 * and ways of a multipolygon: u8 places, role; places: u8 of a grid.
 */
#include "fuzz_scene.h"

#include "osm/coast.h"
#include "osm/node_set.h"
#include "osm/osm.h"
#include "style/style.h"

#include "pbf_file.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const char style_text[] =
    "{\"version\": 8, \"layers\": [{\"id\": \"all\", \"type\": \"line\", \"filter\": [\"has\", \"highway\"]}, "
    "{\"id\": \"water\", \"type\": \"fill\", \"filter\": [\"has\", \"natural\"]}]}";
/* 10^-9 degrees */
static const int64_t box[4] = {-1000000000, 2000000000, 3000000000, -4000000000};

/* Bytes that tell how the others are packed, the fields of a blob that have them, and the size that it says. */
static const struct {
    uint8_t first;
    unsigned field;
    uint64_t size_bytes;
} packings[] = {{0xf3, PBF_ZLIB, 0}, {0xf4, PBF_LZMA, 0},   {0xf6, PBF_LZ4, 0},
                {0xf7, PBF_ZSTD, 0}, {0xfe, PBF_LZ4, 1000}, {0xff, PBF_ZSTD, 1000}};

static void write_file(const char *path, const uint8_t *bytes, size_t size, bool content) {
    static pbf_file made;
    if (content) {
        pbf_bytes blob = {.size = 0};
        unsigned field = PBF_RAW;
        uint64_t size_bytes = 0;
        for (size_t i = 0; i < sizeof packings / sizeof *packings; i++)
            if (bytes[0] == packings[i].first) {
                field = packings[i].field;
                size_bytes = packings[i].size_bytes;
            }
        if (size_bytes)
            pbf_number(&blob, 2, size_bytes);
        pbf_header_of(&made, "DenseNodes", box);
        pbf_field(&blob, field, bytes + (field != PBF_RAW), size - (field != PBF_RAW));
        pbf_blob(&made, "OSMData", &blob);
        bytes = made.bytes;
        size = made.size;
    }
    FILE *file = fopen(path, "wb");
    REQUIRE(file && fwrite(bytes, 1, size, file) == size && fclose(file) == 0);
}

static int32_t take_degrees(fuzz_reader *from) {
    return (int16_t)fuzz_take(from, 2);
}

/* Rings are closed, have a role, and outer ones come first, whatever ways they are made of. */
static void use_rings(fuzz_run *run, const uint8_t *bytes, size_t size) {
    enum { MOST_WAYS = 32, MOST_PLACES = 16 };
    fuzz_reader from = {bytes, size};
    camber_osm_assembly rings = {.context = run->context};
    uint64_t places[MOST_WAYS * MOST_PLACES];
    camber_osm_piece pieces[MOST_WAYS];
    size_t count = 0;
    while (from.size > 0 && count < MOST_WAYS) {
        const uint8_t about = (uint8_t)fuzz_take(&from, 1);
        camber_osm_piece *piece = &pieces[count];
        uint64_t *at = places + count * MOST_PLACES;
        *piece = (camber_osm_piece){at, 2 + about % (MOST_PLACES - 2), (camber_osm_role)(about / 16 % 3)};
        for (uint32_t i = 0; i < piece->count; i++) {
            const uint8_t place = (uint8_t)fuzz_take(&from, 1); /* on a grid, so that ways meet */
            at[i] = camber_osm_place(place % 16 * 1000, place / 16 * 1000);
        }
        count++;
    }
    if (count && fuzz_done(run, camber_osm_assemble(&rings, pieces, count, size & 1)))
        for (size_t i = 0; i < rings.ring_count; i++) {
            const camber_osm_ring *ring = rings.rings + i;
            REQUIRE(ring->count > 0 && ring->first + ring->count <= rings.place_count);
            REQUIRE(rings.places[ring->first] == rings.places[ring->first + ring->count - 1]);
            REQUIRE(ring->role != CAMBER_OSM_ROLE_UNKNOWN && (i == 0 || rings.rings[i - 1].role <= ring->role));
        }
    camber_osm_assembly_free(&rings);
}

/* Rings are closed, and outer ones come first, whatever a coast is. */
static void use_coast(fuzz_run *run, const uint8_t *bytes, size_t size) {
    fuzz_reader from = {bytes, size};
    camber_osm_coast coast = {.context = run->context};
    camber_osm_assembly sea = {.context = run->context};
    camber_osm_box within = {.left = take_degrees(&from)};
    within.right = take_degrees(&from);
    within.bottom = take_degrees(&from);
    within.top = take_degrees(&from);
    coast.box = within;
    bool added = true;
    while (from.size > 0 && added) {
        uint64_t places[16];
        const size_t count = fuzz_take(&from, 1) % 16;
        for (size_t i = 0; i < count; i++) {
            const int32_t longitude = take_degrees(&from);
            places[i] = camber_osm_place(longitude, take_degrees(&from));
        }
        added = fuzz_done(run, camber_osm_coast_add(&coast, places, count, size & 1));
    }
    if (added && fuzz_done(run, camber_osm_coast_fill(&coast, &sea))) {
        REQUIRE(!sea.open || sea.ring_count == 0);
        for (size_t i = 0; i < sea.ring_count; i++) {
            const camber_osm_ring *ring = sea.rings + i;
            REQUIRE(ring->count > 0 && ring->first + ring->count <= sea.place_count);
            REQUIRE(sea.places[ring->first] == sea.places[ring->first + ring->count - 1]);
            REQUIRE(i == 0 || sea.rings[i - 1].role <= ring->role);
            for (size_t k = ring->first; k < ring->first + ring->count; k++) {
                const int32_t x = camber_osm_longitude(sea.places[k]), y = camber_osm_latitude(sea.places[k]);
                REQUIRE(x >= within.left && x <= within.right && y >= within.bottom && y <= within.top);
            }
        }
    }
    camber_osm_coast_free(&coast);
    camber_osm_assembly_free(&sea);
}

static void use(fuzz_run *run, const uint8_t *bytes, size_t size) {
    char path[64];
    camber_style *style = NULL;
    camber_features *features = NULL;
    const bool content = size > 0 && size < 8192 && bytes[0] != 0;
    use_coast(run, bytes, size);
    use_rings(run, bytes, size);
    snprintf(path, sizeof path, "/tmp/camber-fuzz-%ld.osm.pbf", (long)getpid());
    write_file(path, bytes, size, content);
    const camber_source_desc desc = {.path = path, .threads = 2};
    REQUIRE(!content || camber_reader_takes(&camber_osm_reader, &desc));
    if (camber_reader_takes(&camber_osm_reader, &desc) &&
        fuzz_done(run, camber_style_parse(run->context, style_text, strlen(style_text), "fuzz", &style)) &&
        fuzz_done(run, camber_features_create(run->context, style, &features))) {
        bool declined = false;
        style->schema.wants_areas = run->hash & 1;
        style->schema.wants_points = run->hash >> 1 & 1;
        if (run->hash >> 3 & 1)
            fuzz_want_labels(features, style);
        const bool read = fuzz_done(run, camber_osm_reader.read(features, &desc, &declined));
        const camber_features_stats stats = camber_features_get_stats(features);
        REQUIRE((read && !declined) || stats.points == 0);
        REQUIRE(stats.points >= stats.polylines);
        if (declined || run->hash & 2)
            (void)fuzz_done(run, camber_osm_reader.leave(run->context, &desc));
        fuzz_check_areas(features);
    }
    camber_features_destroy(features);
    camber_style_destroy(style);
    unlink(path);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    fuzz_each(bytes, size, use);
    return 0;
}
