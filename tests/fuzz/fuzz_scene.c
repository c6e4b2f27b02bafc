#include "fuzz_scene.h"

#include "features/rings.h"
#include "style/style.h"

#include <math.h>
#include <string.h>

void fuzz_check_areas(const camber_features *features) {
    for (size_t i = 0; i < features->polyline_count; i++) {
        const size_t first = features->offsets[i], count = features->offsets[i + 1] - first;
        const double *ring = features->points + 2 * first;
        if (!camber_geometry_is_area(camber_features_kind(features, i)))
            continue;
        REQUIRE(count >= 4 && memcmp(ring, ring + 2 * (count - 1), 2 * sizeof *ring) == 0);
        REQUIRE(!camber_ring_is_flat(ring, count));
    }
}

static bool takes_all(const camber_style *style, camber_geometry_kind kind, const char *source_layer,
                      const camber_feature_view *feature) {
    REQUIRE(style && source_layer && strcmp(feature->geometry_type, camber_geometry_type(kind)) == 0);
    return true;
}

void fuzz_want_labels(camber_features *features, camber_style *style) {
    camber_schema *schema = &style->schema;
    schema->wants_label_lines = schema->wants_label_areas = schema->wants_label_points = true;
    schema->takes = takes_all;
    camber_features_want_labels(features);
}

static void check_color(camber_color c) {
    REQUIRE(c.r >= 0.0f && c.r <= 1.0f && c.g >= 0.0f && c.g <= 1.0f && c.b >= 0.0f && c.b <= 1.0f);
    REQUIRE(c.a >= 0.0f && c.a <= 1.0f);
}

/* Passes draw polylines that there are, with paints that the strokes are wide enough for. */
static void check_frame(camber_scene *scene) {
    size_t stroke_count;
    const camber_stroke *strokes = camber_scene_get_strokes(scene, &stroke_count);
    const camber_frame frame = camber_scene_get_frame(scene, NULL);
    const camber_lines *lines = camber_scene_get_lines(scene);
    fuzz_check_lines(lines);
    for (size_t i = 0; i < lines->polyline_count; i++)
        REQUIRE(camber_scene_get_rows(scene)[i] < stroke_count);
    for (size_t i = 0; i < lines->point_count; i++)
        REQUIRE(fabsf(lines->points[2 * i]) < 1e6f && fabsf(lines->points[2 * i + 1]) < 1e6f);
    check_color(frame.background);
    for (size_t i = 0; i < frame.pass_count; i++) {
        const camber_pass *pass = frame.passes + i;
        if (pass->kind == CAMBER_PASS_FILL) {
            REQUIRE(pass->paint_count == 0);
            check_color(pass->fill.color);
            continue;
        }
        REQUIRE(pass->first_polyline + pass->polyline_count <= lines->polyline_count);
        REQUIRE(pass->polyline_count > 0 && pass->paint_count <= stroke_count);
        for (size_t row = 0; row < pass->paint_count; row++) {
            check_color(pass->paints[row].color);
            REQUIRE(pass->paints[row].width_px >= 0.0f && pass->paints[row].width_px <= strokes[row].width_px);
        }
    }
}

void fuzz_scene(fuzz_run *run, const camber_features *features, const camber_scene_desc *desc) {
    camber_scene *scene = NULL;
    if (!fuzz_done(run, camber_scene_create(features, desc, &scene)))
        return;
    if (!fuzz_done(run, camber_scene_project(scene))) {
        camber_scene_destroy(scene);
        return;
    }
    check_frame(scene);
    const camber_scene_info info = camber_scene_get_info(scene);
    REQUIRE(isfinite(info.longitude) && fabs(info.longitude) <= 180.0 && fabs(info.latitude) <= 85.06);
    REQUIRE(isfinite(info.zoom) && info.zoom <= 24.0);
    camber_tessellation_desc tessellation = {.method = (camber_method)(run->hash >> 20 & 0xff) % 3};
    tessellation.strokes = camber_scene_get_strokes(scene, &tessellation.stroke_count);
    /* A tessellation never refuses what a style says. */
    REQUIRE(fuzz_tessellate(run, camber_scene_get_polylines(scene), &tessellation, NULL) || run->refused);
    camber_scene_destroy(scene);
}
