/* Networks of real streets: the device against the twin under cameras from a whole city to a doorstep, turned and
 * straight, with points left out and with all of them. */
#include "test_fixture.h"

#include "camber_map.h"

typedef struct city {
    const char *name, *path; /* below CAMBER_DATA/data */
    double longitude, latitude;
} city;

static const city CITIES[] = {
    {"nyc", "nyc.osm.pbf", -73.9965, 40.7185},
    {"porto", "porto_portugal.osm.pbf", -8.6110, 41.1480},
    {"helsinki", "Helsinki-1327152.osm.pbf", 24.9414, 60.1690},
    {"beijing", "beijing-2013.geojson", 116.3970, 39.9170},
    {"tiles", "osm.mbtiles", -122.0261, 36.9741},
};

typedef struct look {
    double zoom, bearing_deg, simplify_px;
} look;

static const look LOOKS[] = {{9.4, 0, 0.1},     {12, 0, 0},      {13.3, 33.7, 0.1}, {15, 90, 1},
                             {16.8, -123, 0.1}, {18, 180, 0.25}, {21, 7, 0},        {24, 45, 0.1}};
enum { LOOK_COUNT = sizeof LOOKS / sizeof *LOOKS };

static const char *data_folder(void) {
    const char *folder = getenv("CAMBER_DATA");
    return folder && folder[0] ? folder : NULL;
}

/* Points and meshes of one look. Gives how many records there are. */
static size_t compare(fixture *b, camber_network *network, const camber_camera *camera,
                      const camber_tessellation_desc *desc) {
    camber_polylines *twin = NULL;
    camber_mesh_data got = {0}, expected = {0};
    camber_stages got_stages = {0}, expected_stages = {0};
    assert_int_equal(camber_network_project(network, camera, desc, &twin), CAMBER_OK);
    assert_int_equal(camber_mesh_tessellate_network(b->mesh, network, camera, desc), CAMBER_OK);
    assert_int_equal(camber_mesh_read(b->mesh, &got), CAMBER_OK);
    assert_int_equal(camber_mesh_read_stages(b->mesh, &got_stages), CAMBER_OK);
    assert_int_equal(camber_mesh_data_tessellate(b->context, twin, desc, &expected), CAMBER_OK);
    assert_int_equal(camber_stages_tessellate(b->context, twin, desc, &expected_stages), CAMBER_OK);
    assert_int_equal(got_stages.point_count, expected_stages.point_count);
    for (size_t i = 0; b->rounds && i < expected_stages.point_count; i++) {
        const camber_point_stages *is = got_stages.points + i, *should = expected_stages.points + i;
        if (is->x != should->x || is->y != should->y || is->join != should->join || is->polyline != should->polyline)
            fail_msg("polyline %u, point %u: %.9g, %.9g, join %08x; the twin's is polyline %u: %.9g, %.9g, join %08x",
                     is->polyline, is->point, (double)is->x, (double)is->y, is->join, should->polyline,
                     (double)should->x, (double)should->y, should->join);
    }
    const size_t records = expected.info.record_count;
    if (b->rounds) {
        assert_int_equal(got.info.record_count, records);
        assert_int_equal(got.info.index_count, expected.info.index_count);
        if (records)
            assert_memory_equal(got.records, expected.records, records * sizeof *got.records);
        if (expected.info.index_count)
            assert_memory_equal(got.indices, expected.indices, expected.info.index_count * sizeof *got.indices);
    }
    camber_stages_destroy(&expected_stages);
    camber_stages_destroy(&got_stages);
    camber_mesh_data_destroy(&expected);
    camber_mesh_data_destroy(&got);
    camber_polylines_destroy(twin);
    return records;
}

static size_t check_city(fixture *b, const camber_features *features, const city *c) {
    camber_scene *streets = NULL;
    size_t records = 0;
    for (size_t i = 0; i < LOOK_COUNT; i++) {
        const camber_view_desc view = {.kind = CAMBER_VIEW_CENTER,
                                       .longitude = c->longitude,
                                       .latitude = c->latitude,
                                       .zoom = LOOKS[i].zoom,
                                       .bearing_deg = LOOKS[i].bearing_deg,
                                       .width = 640,
                                       .height = 400};
        camber_camera camera;
        camber_tessellation_desc desc;
        if (streets)
            assert_int_equal(camber_scene_move(streets, &view), CAMBER_OK);
        else
            assert_int_equal(camber_scene_create(features, &(camber_scene_desc){.view = view}, &streets), CAMBER_OK);
        camber_network *network = camber_scene_get_network(streets, &camera, &desc);
        camera.simplify_px = LOOKS[i].simplify_px;
        desc.method = (camber_method)(i % 3);
        records += compare(b, network, &camera, &desc);
    }
    camber_scene_destroy(streets);
    return records;
}

static void test_cities(void **state) {
    fixture *b = *state;
    camber_style *style = NULL;
    size_t seen = 0;
    assert_int_equal(camber_style_create_builtin(b->context, CAMBER_THEME_LIGHT, &style), CAMBER_OK);
    for (size_t i = 0; i < sizeof CITIES / sizeof *CITIES; i++) {
        char path[4096];
        camber_features *features = NULL;
        snprintf(path, sizeof path, "%s/data/%s", data_folder(), CITIES[i].path);
        assert_int_equal(camber_features_create(b->context, style, &features), CAMBER_OK);
        const camber_status status = camber_features_read(features, &(camber_source_desc){.path = path});
        if (status == CAMBER_OK) {
            const size_t records = check_city(b, features, CITIES + i);
            printf("%s: %zu records under %d cameras\n", CITIES[i].name, records, LOOK_COUNT);
            assert_true(records > 10000);
            seen++;
        } else {
            assert_int_equal(status, CAMBER_ERROR_NOT_FOUND);
            printf("%s is not there\n", path);
        }
        camber_features_destroy(features);
    }
    camber_style_destroy(style);
    assert_true(seen > 0);
}

int main(void) {
    if (!data_folder()) {
        puts("CAMBER_DATA is not set: no cities");
        return 77;
    }
    if (!device_is_there()) {
        puts("no OpenCL device");
        return 77;
    }
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_cities)};
    const int failed = cmocka_run_group_tests(tests, fixture_set_up_mesh, fixture_tear_down);
    return failed;
}
