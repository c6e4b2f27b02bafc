/* Pictures of files that were read for their view: with an index the same bytes as without. Near the region's border
 * lines are merged with others outside, their dashes begin outside, and nodes outside keep points. */
#include "map_picture.h"

#include "features/features.h"
#include "indexed_files.h"

static const char *const styles[] = {
    ("{\"version\":8,\"sources\":{},\"layers\":[{\"id\":\"a\",\"type\":\"line\",\"layout\":{\"line-join\":\"round\"},"
     "\"paint\":{\"line-color\":[\"match\",[\"get\",\"highway\"],\"primary\",\"#c00\",\"#00c\"],"
     "\"line-width\":[\"match\",[\"get\",\"highway\"],\"motorway\",14,3]}}]}"),
    ("{\"version\":8,\"sources\":{},\"layers\":[{\"id\":\"a\",\"type\":\"line\",\"layout\":{\"line-join\":\"miter\"},"
     "\"paint\":{\"line-color\":\"#060\",\"line-width\":5,\"line-opacity\":0.6,\"line-dasharray\":[3,2],"
     "\"line-offset\":[\"case\",[\"==\",[\"get\",\"highway\"],\"primary\"],30,-4],\"line-blur\":2}}]}"),
    ("{\"version\":8,\"sources\":{},\"layers\":[{\"id\":\"a\",\"type\":\"line\",\"filter\":[\"has\",\"highway\"],"
     "\"paint\":{\"line-color\":\"#a0a\",\"line-width\":2,\"line-gap-width\":40,\"line-translate\":[60,-50]}}]}"),
    ("{\"version\":8,\"sources\":{},\"layers\":[{\"id\":\"a\",\"type\":\"line\",\"metadata\":{\"camber:tuck\":true},"
     "\"layout\":{\"line-cap\":\"round\",\"line-sort-key\":[\"match\",[\"get\",\"highway\"],\"primary\",1,0]},"
     "\"paint\":{\"line-color\":[\"match\",[\"get\",\"highway\"],\"primary\",\"#c00\",\"#00c\"],\"line-width\":18}}]"
     "}")};
enum { STYLES = sizeof styles / sizeof *styles };

static map open_for(fixture *f, const char *style, const char *path, const camber_scene_desc *desc) {
    map m = {.style = NULL};
    assert_int_equal(camber_style_parse(f->context, style, strlen(style), "style", &m.style), CAMBER_OK);
    assert_int_equal(camber_features_create(f->context, m.style, &m.features), CAMBER_OK);
    assert_int_equal(camber_features_read_for(m.features, desc), CAMBER_OK);
    if (camber_features_read(m.features, &(camber_source_desc){.path = path}) != CAMBER_OK)
        fail_msg("%s", f->h.last);
    assert_int_equal(camber_scene_create(m.features, desc, &m.scene), CAMBER_OK);
    return m;
}

/* Returns how many pixels are drawn. */
static size_t expect_same_picture(fixture *f, const char *const paths[2], const char *style,
                                  const camber_scene_desc *desc) {
    map maps[2];
    picture pictures[2];
    size_t drawn = 0;
    for (int i = 0; i < 2; i++) {
        maps[i] = open_for(f, style, paths[i], desc);
        pictures[i] = map_draw(f, &maps[i]);
    }
    const size_t pixels = (size_t)pictures[0].width * pictures[0].height;
    if (memcmp(pictures[0].rgba, pictures[1].rgba, 4 * pixels) != 0)
        fail_msg("%s at zoom %g, bearing %g, pitch %g: %s differs", style, desc->view.zoom, desc->view.bearing_deg,
                 desc->view.pitch_deg, paths[0]);
    for (size_t i = 0; i < pixels; i++)
        drawn += pictures[0].rgba[4 * i + 3] > 0;
    for (int i = 0; i < 2; i++) {
        picture_free(&pictures[i]);
        map_close(&maps[i]);
    }
    return drawn;
}

static void expect_same_pictures(fixture *f, const char *const paths[2], double longitude, double latitude) {
    size_t drawn = 0;
    for (int i = 0; i < 18; i++) {
        const camber_scene_desc desc = {.view = {.kind = CAMBER_VIEW_CENTER,
                                                 .longitude = longitude + 0.37 * (i % 4),
                                                 .latitude = latitude + 0.2 * (i % 5),
                                                 .zoom = 8.0 + 0.4 * (i % 7),
                                                 .bearing_deg = i % 2 ? 0 : 25.0 * i,
                                                 .pitch_deg = i % 3 == 2 ? 50 : 0,
                                                 .width = 300,
                                                 .height = 200},
                                        .simplify_px = i % 4 ? 0.25 : 4.0};
        drawn += expect_same_picture(f, paths, styles[i % STYLES], &desc);
    }
    print_message("%s: %zu pixels are drawn\n", paths[0], drawn);
    assert_true(drawn > 20000);
}

static void test_indexed(void **state) {
    fixture *f = *state;
    char folder[64], source[128], indexed[128], plain[128];
    folder_make(folder);
    snprintf(source, sizeof source, "%s/source.json", folder);
    snprintf(plain, sizeof plain, "%s/plain.geojson", folder);
    network_write(source, 7.0, 46.0, 40, 1000, false);
    for (size_t i = 0; i < INDEXED_FILES; i++) {
        snprintf(indexed, sizeof indexed, "%s/%s", folder, indexed_files[i].name);
        indexed_file_write(&indexed_files[i], source, indexed, plain);
        expect_same_pictures(f, (const char *const[]){indexed, plain}, 8.5, 47.5);
        expect_same_pictures(f, (const char *const[]){indexed, plain}, 6.5, 45.7);
    }
    folder_remove(folder);
}

static void test_antimeridian(void **state) {
    fixture *f = *state;
    char folder[64], source[128], indexed[128], plain[128];
    folder_make(folder);
    snprintf(source, sizeof source, "%s/source.json", folder);
    snprintf(plain, sizeof plain, "%s/plain.geojson", folder);
    snprintf(indexed, sizeof indexed, "%s/degrees.fgb", folder);
    network_write(source, 178.0, -2.0, 40, 1000, false);
    indexed_file_write(&indexed_files[0], source, indexed, plain);
    expect_same_pictures(f, (const char *const[]){indexed, plain}, 179.4, -0.5);
    expect_same_pictures(f, (const char *const[]){indexed, plain}, -180.6, -0.5);
    folder_remove(folder);
}

/* The picture of a whole file, which is all the same but for what 31 bits round: the region is wide enough. */
static void test_whole(void **state) {
    fixture *f = *state;
    char folder[64], source[128];
    size_t past_2 = 0, drawn = 0;
    folder_make(folder);
    snprintf(source, sizeof source, "%s/source.geojson", folder);
    network_write(source, 7.0, 46.0, 40, 2000, false);
    for (int i = 0; i < 9; i++) {
        const camber_scene_desc desc = {.view = {.kind = CAMBER_VIEW_CENTER,
                                                 .longitude = 8.1 + 0.2 * i,
                                                 .latitude = 47.3,
                                                 .zoom = 8.0 + 0.7 * i,
                                                 .bearing_deg = 40.0 * i,
                                                 .pitch_deg = i % 3 == 2 ? 60 : 0,
                                                 .width = 300,
                                                 .height = 200},
                                        .simplify_px = 0.25};
        map seen = open_for(f, styles[i % STYLES], source, &desc), whole = {.style = seen.style};
        assert_int_equal(camber_features_create(f->context, whole.style, &whole.features), CAMBER_OK);
        assert_int_equal(camber_features_read(whole.features, &(camber_source_desc){.path = source}), CAMBER_OK);
        assert_int_equal(camber_scene_create(whole.features, &desc, &whole.scene), CAMBER_OK);
        assert_true(camber_features_get_stats(seen.features).polylines <
                    camber_features_get_stats(whole.features).polylines);
        picture a = map_draw(f, &seen), b = map_draw(f, &whole);
        for (size_t k = 0; k < 4 * (size_t)a.width * a.height; k++) {
            past_2 += abs(a.rgba[k] - b.rgba[k]) > 2;
            drawn += a.rgba[k] > 0;
        }
        picture_free(&a);
        picture_free(&b);
        whole.style = NULL;
        map_close(&whole);
        map_close(&seen);
    }
    folder_remove(folder);
    print_message("%zu of %zu bytes differ by more than 2\n", past_2, drawn);
    assert_true(drawn > 20000 && past_2 <= drawn / 10000);
}

/* One picture of features whose points are released, once the scene has its network. */
static void test_released_points(void **state) {
    fixture *f = *state;
    char folder[64], source[128];
    folder_make(folder);
    snprintf(source, sizeof source, "%s/source.geojson", folder);
    network_write(source, 7.0, 46.0, 40, 2000, false);
    for (int i = 0; i < STYLES; i++) {
        camber_scene_desc desc = {.view = {.width = 300, .height = 200, .bearing_deg = 20.0 * i}, .simplify_px = 3.0};
        desc.use = CAMBER_SCENE_ONE_VIEW;
        map whole = open_for(f, styles[i], source, &desc);
        map once = open_for(f, styles[i], source, &desc);
        camber_features_release_points(once.features);
        picture a = map_draw(f, &whole), b = map_draw(f, &once);
        assert_memory_equal(a.rgba, b.rgba, 4 * (size_t)a.width * a.height);
        camber_scene *none = NULL;
        assert_int_equal(camber_scene_create(once.features, &desc, &none), CAMBER_ERROR_ARGUMENT);
        assert_story(&f->h, "released");
        picture_free(&a);
        picture_free(&b);
        map_close(&once);
        map_close(&whole);
    }
    folder_remove(folder);
}

/* The same where the scene itself drops what it leaves out, before it makes its network. */
static void test_spent_points(void **state) {
    fixture *f = *state;
    char folder[64], source[128];
    folder_make(folder);
    snprintf(source, sizeof source, "%s/source.geojson", folder);
    network_write(source, 7.0, 46.0, 40, 2000, false);
    for (int i = 0; i < STYLES; i++) {
        camber_scene_desc desc = {.view = {.width = 300, .height = 200, .bearing_deg = 20.0 * i}, .simplify_px = 3.0};
        desc.use = CAMBER_SCENE_ONE_VIEW;
        map whole = open_for(f, styles[i], source, &desc), spent = {.style = whole.style};
        assert_int_equal(camber_features_create(f->context, spent.style, &spent.features), CAMBER_OK);
        assert_int_equal(camber_features_read(spent.features, &(camber_source_desc){.path = source}), CAMBER_OK);
        assert_int_equal(camber_scene_create_last(spent.features, &desc, &spent.scene), CAMBER_OK);
        assert_int_equal(camber_scene_project(spent.scene), CAMBER_OK);
        assert_int_equal(camber_scene_project(whole.scene), CAMBER_OK);
        const camber_scene_info a_info = camber_scene_get_info(whole.scene),
                                b_info = camber_scene_get_info(spent.scene);
        assert_true(a_info.points > 0);
        assert_int_equal(a_info.points, b_info.points);
        assert_int_equal(a_info.points_in, b_info.points_in);
        picture a = map_draw(f, &whole), b = map_draw(f, &spent);
        assert_memory_equal(a.rgba, b.rgba, 4 * (size_t)a.width * a.height);
        camber_scene *none = NULL;
        assert_int_equal(camber_scene_create_last(spent.features, &desc, &none), CAMBER_ERROR_ARGUMENT);
        assert_story(&f->h, "released");
        picture_free(&a);
        picture_free(&b);
        spent.style = NULL;
        map_close(&spent);
        map_close(&whole);
    }
    folder_remove(folder);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_indexed),         cmocka_unit_test(test_antimeridian), cmocka_unit_test(test_whole),
        cmocka_unit_test(test_released_points), cmocka_unit_test(test_spent_points),
    };
    return cmocka_run_group_tests(tests, fixture_set_up, fixture_tear_down);
}
