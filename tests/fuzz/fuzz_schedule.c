/* The files that parts of one run share: a schedule of tiles, which is JSON, or the features beside it. */
#include "fuzz.h"
#include "fuzz_scene.h"

#include "tiles/features_file.h"
#include "tiles/schedule_file.h"

#include "camber_tiles.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { SHARDS = 3 };

static const char style_text[] =
    "{\"version\": 8, \"layers\": [{\"id\": \"all\", \"type\": \"line\", \"filter\": [\"has\", \"highway\"]}]}";

static void read_for_parts(fuzz_run *run, camber_tiles_schedule *schedule, camber_features *features) {
    const camber_tiles_engine_desc desc = {.tile_size = 256, .ratio = 1, .simplify_px = 0.1};
    for (uint32_t shard = 1; shard <= SHARDS; shard++)
        (void)fuzz_done(run, camber_tiles_schedule_read_for(schedule, features, &desc, shard, SHARDS));
}

static void use_schedule(fuzz_run *run, const char *path, camber_features *features) {
    camber_tiles_schedule *schedule = NULL;
    const char *const inputs[] = {path};
    if (fuzz_done(run, camber_tiles_schedule_read(run->context, path, inputs, run->hash >> 8 & 1, &schedule)))
        read_for_parts(run, schedule, features);
    camber_tiles_schedule_destroy(schedule);
}

/* The file says itself of which input it is. */
static void use_features(fuzz_run *run, const char *path, camber_features *features, const uint8_t *bytes,
                         size_t size) {
    uint64_t input = 0;
    if (size >= 2 * sizeof input)
        memcpy(&input, bytes + sizeof input, sizeof input);
    if (!fuzz_done(run, camber_features_load(features, NULL, 0, input, path)))
        return;
    const camber_features_stats stats = camber_features_get_stats(features);
    REQUIRE(stats.points >= stats.polylines);
    fuzz_scene(run, features, &(camber_scene_desc){.view = {.width = 200, .height = 100}});
}

static void use(fuzz_run *run, const uint8_t *bytes, size_t size) {
    char path[64];
    camber_style *style = NULL;
    camber_features *features = NULL;
    snprintf(path, sizeof path, "/tmp/camber-fuzz-%ld.schedule", (long)getpid());
    FILE *file = fopen(path, "wb");
    REQUIRE(file && fwrite(bytes, 1, size, file) == size && fclose(file) == 0);
    if (fuzz_done(run, camber_style_parse(run->context, style_text, strlen(style_text), "fuzz", &style)) &&
        fuzz_done(run, camber_features_create(run->context, style, &features))) {
        if (size && bytes[0] == '{')
            use_schedule(run, path, features);
        else
            use_features(run, path, features, bytes, size);
    }
    camber_features_destroy(features);
    camber_style_destroy(style);
    unlink(path);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    fuzz_each(bytes, size, use);
    return 0;
}
