/* The longest lines of a real network, 2,217 points in five lines, under the same judge as the torture set. */
#include "torture_judge.h"

#include <cpl_conv.h>
#include <cpl_vsi.h>
#include <ogr_api.h>

static const char FILE_NAME[] = "data/mergelines_1759_point_line.wkb.gz";
enum { SIDE_PX = 1200, LEAST_POINTS = 2000 };

/* One gzipped WKB geometry; NULL: not there. */
static OGRGeometryH read_geometry(const char *folder) {
    char path[1024];
    vsi_l_offset size = 0;
    OGRGeometryH geometry = NULL;
    snprintf(path, sizeof path, "/vsigzip/%s/%s", folder, FILE_NAME);
    GByte *bytes = NULL;
    if (!VSIIngestFile(NULL, path, &bytes, &size, 1 << 24))
        return NULL;
    assert_int_equal(OGR_G_CreateFromWkb(bytes, NULL, &geometry, (int)size), OGRERR_NONE);
    CPLFree(bytes);
    return geometry;
}

/* The lines as figures of their own, in the geometry's own proportions, north up; drawn at several scales, since what
 * is tight at one is plain at another. */
static size_t add_lines(camber_torture_set *set, OGRGeometryH geometry, double side_px) {
    OGREnvelope box;
    OGR_G_GetEnvelope(geometry, &box);
    const double scale = side_px / fmax(box.MaxX - box.MinX, box.MaxY - box.MinY);
    size_t points = 0;
    for (int i = 0; i < OGR_G_GetGeometryCount(geometry); i++) {
        const OGRGeometryH line = OGR_G_GetGeometryRef(geometry, i);
        const int count = OGR_G_GetPointCount(line);
        for (int k = 0; k < count; k++)
            camber_made_scene_point(&set->lines, (OGR_G_GetX(line, k) - box.MinX) * scale,
                                    (box.MaxY - OGR_G_GetY(line, k)) * scale);
        char name[32];
        snprintf(name, sizeof name, "line %d, %d points", i, count);
        camber_torture_end_figure(set, name, 12);
        points += (size_t)count;
    }
    return points;
}

typedef struct overlap_test {
    fixture fixture;
    camber_torture_set set;
} overlap_test;

static void test_strips_are_uniform(void **state) {
    overlap_test *b = *state;
    torture_check(&b->fixture, &b->set, CAMBER_METHOD_STRIP, (torture_known){0, 0, 2});
}

static void test_kites_are_uniform(void **state) {
    overlap_test *b = *state;
    torture_check(&b->fixture, &b->set, CAMBER_METHOD_KITE, (torture_known){1, 20, 2});
}

static int set_up(void **state) {
    static overlap_test b;
    OGRGeometryH geometry = read_geometry(getenv("CAMBER_DATA"));
    assert_non_null(geometry);
    b.set = camber_torture_begin(SIDE_PX + 32);
    assert_true(add_lines(&b.set, geometry, SIDE_PX) >= LEAST_POINTS);
    add_lines(&b.set, geometry, SIDE_PX / 4.0);
    OGR_G_DestroyGeometry(geometry);
    *state = &b;
    return fixture_open(&b.fixture) ? 0 : -1;
}

static int tear_down(void **state) {
    overlap_test *b = *state;
    camber_torture_free(&b->set);
    fixture_close(&b->fixture);
    return 0;
}

int main(void) {
    char path[1024];
    const char *data = getenv("CAMBER_DATA");
    snprintf(path, sizeof path, "%s/%s", data ? data : "", FILE_NAME);
    if (!data || access(path, R_OK) != 0) {
        printf("no %s; set CAMBER_DATA\n", data ? path : FILE_NAME);
        return 77;
    }
    if (!fixture_begin())
        return 77;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_strips_are_uniform),
        cmocka_unit_test(test_kites_are_uniform),
    };
    const int failed = cmocka_run_group_tests(tests, set_up, tear_down);
    return failed;
}
