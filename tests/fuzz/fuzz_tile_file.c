/* Files of tiles as input, as a style's source, and as archives.
 *
 * Input: the bytes of a file and its ending. Whatever they are, reading ends with lines that hold together, or with one
 * message, and leaves nothing beside the file. */
#include "fuzz_tile_file.h"

#include "camber_tiles.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const char input_style[] =
    "{\"version\": 8, \"layers\": [{\"id\": \"all\", \"type\": \"line\", \"paint\": {\"line-width\": 2}}]}";
static const char source_style[] =
    "{\"version\": 8, \"sources\": {\"s\": {\"type\": \"vector\", \"url\": \"%s://%s\"}}, \"layers\": [{\"id\": "
    "\"all\", \"type\": \"line\", \"source\": \"s\", \"source-layer\": \"roads\", \"paint\": {\"line-width\": 2}}]}";

static void check(const camber_features *features) {
    const camber_features_stats stats = camber_features_get_stats(features);
    const char *attribution = camber_features_get_attribution(features);
    for (const char *c = attribution; c && *c; c++)
        REQUIRE((unsigned char)*c >= ' ' && *c != 0x7f);
    REQUIRE(stats.points >= stats.polylines);
}

static camber_features *open_features(fuzz_run *run, const char *text, camber_style **style) {
    camber_features *features = NULL;
    if (!fuzz_done(run, camber_style_parse(run->context, text, strlen(text), "fuzz", style)) ||
        !fuzz_done(run, camber_features_create(run->context, *style, &features)))
        return NULL;
    return features;
}

static void read_input(fuzz_run *run, const char *path) {
    camber_style *style = NULL;
    camber_features *features = open_features(run, input_style, &style);
    const camber_source_desc desc = {.path = path, .layer = run->hash >> 8 & 3 ? NULL : "roads"};
    if (features && fuzz_done(run, camber_features_read(features, &desc))) {
        check(features);
        fuzz_scene(run, features, &(camber_scene_desc){.view = {.width = 200, .height = 100}});
    } else if (features) {
        REQUIRE(camber_features_get_stats(features).points == 0);
    }
    camber_features_destroy(features);
    camber_style_destroy(style);
}

static void read_source(fuzz_run *run, const char *path, const char *scheme) {
    char text[512];
    const camber_view_desc view = {
        .kind = CAMBER_VIEW_CENTER, .width = 200, .height = 100, .zoom = (double)(run->hash >> 12 & 3)};
    camber_style *style = NULL;
    snprintf(text, sizeof text, source_style, scheme, path);
    camber_features *features = open_features(run, text, &style);
    if (features && fuzz_done(run, camber_features_read_sources(features, &view, NULL))) {
        check(features);
        fuzz_scene(run, features, &(camber_scene_desc){.view = view});
    }
    camber_features_destroy(features);
    camber_style_destroy(style);
}

/* Whatever an archive is, it is shown, verified and converted, or refused in one line. */
static void look_at_archive(fuzz_run *run, const char *path) {
    camber_tiles_findings *found = NULL;
    camber_tiles_info *info = NULL;
    char out[96], beside[128];
    if (fuzz_done(run, camber_tiles_verify(run->context, path, &found)))
        camber_tiles_findings_destroy(found);
    if (fuzz_done(run, camber_tiles_show(run->context, path, &info))) {
        uint64_t tiles = 0;
        for (size_t i = 0; i < info->zoom_count; i++)
            tiles += info->zooms[i].tiles;
        REQUIRE(tiles <= info->tiles);
        camber_tiles_info_destroy(info);
    }
    snprintf(out, sizeof out, "%s.out.pmtiles", path);
    const camber_tiles_merge_desc merge = {.parts = &path, .part_count = 1, .output = out, .force = true};
    (void)fuzz_done(run, camber_tiles_merge(run->context, &merge));
    unlink(out);
    for (size_t i = 0; camber_tiles_beside(out, i, beside, sizeof beside); i++)
        REQUIRE(access(beside, F_OK) != 0);
}

/* Reading a file leaves nothing beside it. */
static void require_alone(const char *path) {
    static const char *const tails[] = {"-journal", "-wal", "-shm"};
    for (size_t i = 0; i < sizeof tails / sizeof *tails; i++) {
        char beside[96];
        snprintf(beside, sizeof beside, "%s%s", path, tails[i]);
        REQUIRE(access(beside, F_OK) != 0);
    }
}

void fuzz_read_tiles(fuzz_run *run, const void *bytes, size_t size, const char *scheme) {
    char path[64];
    snprintf(path, sizeof path, "/tmp/camber-fuzz-%ld.%s", (long)getpid(), scheme);
    FILE *file = fopen(path, "wb");
    REQUIRE(file && fwrite(bytes, 1, size, file) == size && fclose(file) == 0);
    read_input(run, path);
    read_source(run, path, scheme);
    look_at_archive(run, path);
    require_alone(path);
    unlink(path);
}
