/* A PBF file of OpenStreetMap: a whole one, or the content of a blob, which needs no packing to be reached. */
#include "fuzz_scene.h"

#include "osm/osm.h"

#include "pbf_file.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const char style_text[] =
    "{\"version\": 8, \"layers\": [{\"id\": \"all\", \"type\": \"line\", \"filter\": [\"has\", \"highway\"]}]}";

static void write_file(const char *path, const uint8_t *bytes, size_t size, bool content) {
    static pbf_file made;
    if (content) {
        pbf_bytes block = {.size = 0};
        pbf_header(&made, "DenseNodes");
        pbf_put(&block, bytes, size);
        pbf_content(&made, "OSMData", &block, 0);
        bytes = made.bytes;
        size = made.size;
    }
    FILE *file = fopen(path, "wb");
    REQUIRE(file && fwrite(bytes, 1, size, file) == size && fclose(file) == 0);
}

static void use(fuzz_run *run, const uint8_t *bytes, size_t size) {
    char path[64];
    camber_style *style = NULL;
    camber_features *features = NULL;
    const bool content = size > 0 && size < 8192 && bytes[0] != 0;
    snprintf(path, sizeof path, "/tmp/camber-fuzz-%ld.osm.pbf", (long)getpid());
    write_file(path, bytes, size, content);
    const camber_source_desc desc = {.path = path, .threads = 2};
    REQUIRE(!content || camber_osm_reads(&desc));
    if (camber_osm_reads(&desc) &&
        fuzz_done(run, camber_style_parse(run->context, style_text, strlen(style_text), "fuzz", &style)) &&
        fuzz_done(run, camber_features_create(run->context, style, &features))) {
        bool declined = false;
        style->wants_areas = run->hash & 1;
        const bool read = fuzz_done(run, camber_osm_read(features, &desc, &declined));
        const camber_features_stats stats = camber_features_get_stats(features);
        REQUIRE((read && !declined) || stats.points == 0);
        REQUIRE(stats.points >= stats.polylines);
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
