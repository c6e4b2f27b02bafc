/* A style's source of GeoJSON, as it stands in the document. */
#include "fuzz_scene.h"

#include "features/features.h"
#include "style/style.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char head[] = "{\"version\": 8, \"sources\": {\"s\": {\"type\": \"geojson\", \"data\": ";
static const char tail[] =
    "}}, \"layers\": [{\"id\": \"all\", \"type\": \"line\", \"source\": \"s\", \"paint\": {\"line-width\": [\"case\", "
    "[\"==\", [\"get\", \"highway\"], \"primary\"], 8, [\"has\", \"level\"], [\"to-number\", [\"get\", \"level\"], 1], "
    "2], \"line-color\": [\"to-color\", [\"get\", \"name\"], \"red\"]}}, "
    "{\"id\": \"areas\", \"type\": \"fill\", \"source\": \"s\", \"layout\": {\"fill-sort-key\": [\"get\", \"level\"]}, "
    "\"paint\": {\"fill-color\": [\"to-color\", [\"get\", \"name\"], \"blue\"], \"fill-outline-color\": \"#123\", "
    "\"fill-translate\": [3, -2]}}]}";

static void read_sources(fuzz_run *run, const camber_style *style) {
    const camber_view_desc view = {.width = 200, .height = 100, .bearing_deg = run->hash & 1 ? 30.0 : 0.0};
    camber_features *features = NULL;
    if (!fuzz_done(run, camber_features_create(run->context, style, &features)))
        return;
    if (fuzz_done(run, camber_features_read_sources(features, &view, NULL))) {
        for (size_t i = 0; i < 2 * features->point_count; i++)
            REQUIRE(isfinite(features->points[i]) && fabs(features->points[i]) <= 2.0);
        fuzz_scene(run, features, &(camber_scene_desc){.view = view});
    } else {
        REQUIRE(features->point_count == 0 && features->feature_count == 0);
    }
    camber_features_destroy(features);
}

/* data that is a text would be a path. */
static void use(fuzz_run *run, const uint8_t *bytes, size_t size) {
    if (!memchr(bytes, '{', size) || memchr(bytes, '"', size) < memchr(bytes, '{', size))
        return;
    camber_style *style = NULL;
    char *text = malloc(sizeof head + size + sizeof tail);
    REQUIRE(text);
    memcpy(text, head, sizeof head - 1);
    memcpy(text + sizeof head - 1, bytes, size);
    memcpy(text + sizeof head - 1 + size, tail, sizeof tail);
    const size_t length = sizeof head - 1 + size + sizeof tail - 1;
    if (fuzz_done(run, camber_style_parse(run->context, text, length, "fuzz", &style))) {
        style->schema.wants_id = run->hash >> 20 & 1;
        style->schema.wants_all_properties = run->hash >> 21 & 1;
        read_sources(run, style);
    }
    camber_style_destroy(style);
    free(text);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    if (size)
        fuzz_each(bytes, size, use);
    return 0;
}
