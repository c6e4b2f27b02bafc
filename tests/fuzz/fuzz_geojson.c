/* GeoJSON through the whole reader, from a file in memory, and on to a scene. */
#include "fuzz_scene.h"

#include "gdal/vector_file.h"
#include "style/style.h"

#include <cpl_conv.h>
#include <cpl_vsi.h>

#include <math.h>
#include <string.h>

static const char path[] = "/vsimem/fuzzed.geojson";

/* Reads properties of every type, and asks for the outlines of polygons. */
static const char style_text[] =
    "{\"version\": 8, \"layers\": ["
    "{\"id\": \"back\", \"type\": \"background\", \"paint\": {\"background-color\": \"#123\"}},"
    "{\"id\": \"areas\", \"type\": \"line\", \"filter\": [\"==\", \"$type\", \"Polygon\"], \"paint\": "
    "  {\"line-color\": \"rgba(1, 2, 3, 0.5)\", \"line-width\": 3}},"
    "{\"id\": \"all\", \"type\": \"line\", \"layout\": {\"line-join\": \"round\", \"line-cap\": \"round\"}, \"paint\": "
    "  {\"line-width\": [\"case\", [\"==\", [\"get\", \"highway\"], \"primary\"], 8, [\"has\", \"level\"], "
    "    [\"to-number\", [\"get\", \"level\"], 1], 2], \"line-color\": [\"to-color\", [\"get\", \"name\"], \"red\"]}},"
    "{\"id\": \"above\", \"type\": \"line\", \"filter\": [\"!=\", [\"get\", \"bridge\"], true], \"paint\": "
    "  {\"line-opacity\": 0.4, \"line-width\": [\"interpolate\", [\"linear\"], [\"zoom\"], 5, 1, 15, 40]}}]}";

/* A point of a place on earth is one of the unit square; a polyline has points. */
static void check_features(const camber_features *features) {
    const camber_features_stats stats = camber_features_get_stats(features);
    const bool labels = features->wants_labels;
    REQUIRE(stats.features == camber_features_count_drawn(features));
    REQUIRE(labels || (stats.points == features->point_count && stats.polylines == features->polyline_count));
    REQUIRE(stats.points <= features->point_count && stats.polylines <= features->polyline_count);
    size_t counted = 0;
    for (size_t i = 0; i < features->polyline_count; i++) {
        counted += features->feature_counts[i];
        REQUIRE(features->offsets[i] < features->offsets[i + 1]);
        REQUIRE(features->polyline_feature[i] < features->feature_count);
    }
    REQUIRE(features->polyline_count == 0 || features->offsets[features->polyline_count] == features->point_count);
    /* Areas go on beyond the edges of the world. */
    for (size_t i = 0; i < 2 * features->point_count; i++)
        REQUIRE((features->points[i] >= 0.0 && features->points[i] <= 1.0) ||
                ((labels || features->style->schema.wants_areas) && i % 2 == 0 && fabs(features->points[i]) <= 2.0));
    fuzz_check_areas(features);
    REQUIRE(counted == features->feature_count);
    for (size_t i = 0; i < features->point_count; i++)
        REQUIRE(features->importance[i] >= 0.0f);
    for (size_t i = 0; i < features->feature_count; i++)
        REQUIRE(features->feature_class[i] < features->class_count);
}

static void use_features(fuzz_run *run, const camber_features *features) {
    const camber_view_desc fitted = {.width = 200, .height = 100, .bearing_deg = run->hash & 1 ? 30.0 : 0.0};
    const camber_view_desc centred = {
        .kind = CAMBER_VIEW_CENTER, .longitude = 179.9, .latitude = 10, .zoom = 6, .ratio = 2};
    const camber_view_desc boxed = {.kind = CAMBER_VIEW_BBOX, .west = 170, .east = -170, .south = -80, .north = 80};
    check_features(features);
    fuzz_scene(run, features, &(camber_scene_desc){.view = fitted});
    fuzz_scene(run, features, &(camber_scene_desc){.view = run->hash & 2 ? centred : boxed, .simplify_px = 0.5});
}

static void use(fuzz_run *run, const uint8_t *bytes, size_t size) {
    camber_style *style = NULL;
    camber_features *features = NULL;
    VSILFILE *file = VSIFileFromMemBuffer(path, (GByte *)(uintptr_t)bytes, size, FALSE);
    REQUIRE(file);
    VSIFCloseL(file);
    if (fuzz_done(run, camber_style_parse(run->context, style_text, strlen(style_text), "fuzz", &style)) &&
        fuzz_done(run, camber_features_create(run->context, style, &features))) {
        style->schema.wants_areas = run->hash >> 5 & 1;
        style->schema.wants_points = run->hash >> 6 & 1;
        if (run->hash >> 7 & 1)
            fuzz_want_labels(features, style);
        const camber_source_desc desc = {.path = path, .where = run->hash % 16 == 1 ? "level > 1" : NULL};
        const bool read = fuzz_done(run, camber_features_read(features, &desc));
        REQUIRE(read || features->point_count == 0);
        if (read)
            use_features(run, features);
    }
    camber_features_destroy(features);
    camber_style_destroy(style);
    VSIUnlink(path);
}

void RegisterOGRGeoJSON(void); /* libgdal's */

/* In the place of GDAL's own, which the reader calls: the other drivers are not camber's, and two hundred of them would
 * look at every input. */
void CPL_STDCALL GDALAllRegister(void) {
    RegisterOGRGeoJSON();
}

int LLVMFuzzerInitialize(int *argument_count, char ***arguments) {
    (void)argument_count;
    (void)arguments;
    CPLSetErrorHandler(CPLQuietErrorHandler);
    return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    fuzz_each(bytes, size, use);
    return 0;
}
