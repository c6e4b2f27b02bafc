/* One vector tile: its layers, its pieces joined, and on to a scene. */
#include "fuzz_scene.h"

#include "formats/mvt.h"
#include "style/style.h"

#include <math.h>
#include <string.h>

static const char style_text[] =
    "{\"version\": 8, \"layers\": [{\"id\": \"all\", \"type\": \"line\", \"paint\": {\"line-width\": "
    "[\"case\", [\"has\", \"bridge\"], [\"to-number\", [\"get\", \"z_order\"], 1], [\"==\", [\"get\", \"type\"], "
    "\"residential\"], 3, 2]}}]}";

static void check(const camber_features *features, double reach) {
    for (size_t i = 0; i < 2 * features->point_count; i++)
        REQUIRE(features->points[i] >= -reach && features->points[i] <= 1 + reach);
    for (size_t i = 0; i < features->polyline_count; i++)
        REQUIRE(features->offsets[i] < features->offsets[i + 1]);
    fuzz_check_areas(features);
    for (size_t i = 0; i < features->class_count; i++) {
        const camber_feature_class *one = &features->classes[i];
        REQUIRE(!one->all || one->all->type == CAMBER_VALUE_OBJECT);
        for (size_t k = 0; k < features->style->schema.property_count; k++)
            REQUIRE(!isnan(features->values[one->first_value + k].number));
    }
}

static void read_tile(fuzz_run *run, camber_features *features, const uint8_t *bytes, size_t size) {
    static const char *const layers[] = {"roads", "", "a"};
    /* The first row: there is no north of it. */
    const unsigned sides = run->hash % 3 ? CAMBER_SIDE_WEST | CAMBER_SIDE_EAST | CAMBER_SIDE_SOUTH : 0;
    const camber_tile_address place = {.zoom = (int)(run->hash % 3) * 7,
                                       .open_sides = (unsigned)(run->hash >> 8) & sides};
    camber_mvt_desc desc = {.features = features,
                            .layers = run->hash >> 12 & 7 ? layers : NULL,
                            .layer_count = 3,
                            .wants_polygons = run->hash >> 16 & 1,
                            .wants_areas = run->hash >> 18 & 1,
                            .wants_points = run->hash >> 19 & 1,
                            .unsorted = run->hash >> 17 & 1};
    camber_mvt *mvt = NULL;
    bool done = fuzz_done(run, camber_tile_stitcher_create(run->context, place.zoom, &desc.stitcher)) &&
                (!features->wants_labels ||
                 fuzz_done(run, camber_tile_stitcher_create(run->context, place.zoom, &desc.labels))) &&
                fuzz_done(run, camber_mvt_create(run->context, &desc, &mvt));
    /* Twice, so that pieces of equal features meet. */
    for (uint32_t column = 0; column < 2 && done && column < 1u << place.zoom; column++) {
        camber_tile_address at = place;
        at.column = column;
        done = fuzz_done(run, camber_mvt_read(mvt, &at, bytes, size));
    }
    if (done && fuzz_done(run, camber_tile_stitcher_finish(desc.stitcher, features)) &&
        (!desc.labels || fuzz_done(run, camber_tile_stitcher_finish_labels(desc.labels, features))) &&
        fuzz_done(run, camber_features_set_importance(features, 0))) {
        const camber_view_desc view = {.width = 100, .height = 100};
        camber_features_pin_borders(features, 0, place.zoom);
        check(features, ldexp(1.0, -place.zoom) + 1e-9);
        fuzz_scene(run, features, &(camber_scene_desc){.view = view});
    }
    camber_mvt_destroy(mvt);
    camber_tile_stitcher_destroy(desc.labels);
    camber_tile_stitcher_destroy(desc.stitcher);
}

static void use(fuzz_run *run, const uint8_t *bytes, size_t size) {
    camber_style *style = NULL;
    camber_features *features = NULL;
    if (fuzz_done(run, camber_style_parse(run->context, style_text, strlen(style_text), "fuzz", &style))) {
        style->schema.wants_id = run->hash >> 20 & 1;
        style->schema.wants_all_properties = run->hash >> 21 & 1;
        if (fuzz_done(run, camber_features_create(run->context, style, &features))) {
            if (run->hash >> 22 & 1)
                fuzz_want_labels(features, style);
            read_tile(run, features, bytes, size);
        }
    }
    camber_features_destroy(features);
    camber_style_destroy(style);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    fuzz_each(bytes, size, use);
    return 0;
}
