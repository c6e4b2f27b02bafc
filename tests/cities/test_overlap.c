/* Neighbouring segments of real streets draw each pixel once where their join has room: counted on the GPU, and shown,
 * with the pixels that a line draws again elsewhere. */
#include "pictures.h"

#include "camber_map.h"
#include "validate/mesh_joins.h"

enum { SIDE_PX = 1024 };

/* ---- Streets ---- */

typedef struct network {
    const char *name, *path; /* below CAMBER_DATA/data; NULL: shipped with the tests */
    double longitude, latitude;
} network;

static const network NETWORKS[] = {
    {"santa_cruz", NULL, -122.0261, 36.9741},
    {"nyc", "nyc.osm.pbf", -73.9965, 40.7185},
    {"porto", "porto_portugal.osm.pbf", -8.6110, 41.1480},
    {"helsinki", "Helsinki-1327152.osm.pbf", 24.9414, 60.1690},
    {"beijing", "beijing-2013.geojson", 116.3970, 39.9170},
};

typedef struct street_view {
    double zoom;
    float width_px;
} street_view;

/* Streets as wide as they are, wider, and a district with all its curves. */
static const street_view VIEWS[] = {{16, 8}, {17, 20}, {14, 4}};
enum { VIEW_COUNT = 3, SHOWN_VIEW = 0 };

typedef struct streets {
    camber_style *style;
    camber_features *features;
} streets;

/* As wide as the widest view, so that what reaches into a picture is not culled. */
#define STREET_STYLE                                                                                                   \
    "{\"version\":8,\"sources\":{},\"layers\":[{\"id\":\"streets\",\"type\":\"line\",\"source\":\"s\",%s\"paint\":"    \
    "{\"line-width\":20}}]}"

/* false: its file is not here. */
static bool streets_read(streets *it, camber_context *context, const network *n) {
    char path[4096], json[512];
    const char *data = getenv("CAMBER_DATA");
    if (n->path && (!data || !data[0]))
        return false;
    snprintf(path, sizeof path, "%s/%s%s", n->path ? data : CAMBER_TEST_DATA, n->path ? "data/" : "santa_cruz/",
             n->path ? n->path : "osm.mbtiles");
    const int length = snprintf(json, sizeof json, STREET_STYLE, n->path ? "\"filter\":[\"has\",\"highway\"]," : "");
    assert_int_equal(camber_style_parse(context, json, (size_t)length, "streets", &it->style), CAMBER_OK);
    assert_int_equal(camber_features_create(context, it->style, &it->features), CAMBER_OK);
    const camber_source_desc source = {.path = path};
    const camber_status status = camber_features_read(it->features, &source);
    if (status == CAMBER_OK)
        return true;
    assert_int_equal(status, CAMBER_ERROR_NOT_FOUND);
    assert_non_null(n->path);
    camber_features_destroy(it->features);
    camber_style_destroy(it->style);
    return false;
}

static camber_scene *streets_look(const streets *it, const network *n, double zoom) {
    const camber_scene_desc desc = {.view = {.kind = CAMBER_VIEW_CENTER,
                                             .longitude = n->longitude,
                                             .latitude = n->latitude,
                                             .zoom = zoom,
                                             .width = SIDE_PX,
                                             .height = SIDE_PX}};
    camber_scene *made = NULL;
    size_t rows;
    assert_int_equal(camber_scene_create(it->features, &desc, &made), CAMBER_OK);
    assert_int_equal(camber_scene_project(made), CAMBER_OK);
    camber_scene_get_strokes(made, &rows);
    assert_int_equal(rows, 1);
    return made;
}

static void streets_forget(streets *it) {
    camber_features_destroy(it->features);
    camber_style_destroy(it->style);
}

/* ---- Counting ---- */

/* Lines of one width as a mesh, with its joins. */
typedef struct drawing {
    camber_renderer *renderer;
    camber_mesh *mesh;
    camber_mesh_joins joins;
    float width_px;
} drawing;

static drawing drawing_make(fixture *s, const camber_polylines *polylines, float width_px, camber_method method) {
    const camber_stroke stroke = {width_px, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0};
    const camber_tessellation_desc desc = {&stroke, 1, method, 0, false};
    drawing d = {.renderer = fixture_any(s), .width_px = width_px};
    camber_mesh_data data;
    assert_int_equal(camber_mesh_create(s->on.device, d.renderer, &d.mesh), CAMBER_OK);
    assert_int_equal(camber_mesh_tessellate(d.mesh, polylines, &desc), CAMBER_OK);
    assert_int_equal(camber_mesh_read(d.mesh, &data), CAMBER_OK);
    assert_true(camber_mesh_joins_find(&data, &stroke, &d.joins));
    camber_mesh_data_destroy(&data);
    return d;
}

static void drawing_free(drawing *d) {
    camber_mesh_joins_free(&d->joins);
    camber_mesh_destroy(d->mesh);
}

/* ranges NULL: polylines. */
static camber_overdraw count_ranges(const drawing *d, const camber_index_range *ranges, size_t count, uint8_t *map) {
    const camber_paint paint = {.width_px = d->width_px};
    const camber_overdraw_desc desc = {.width = SIDE_PX,
                                       .height = SIDE_PX,
                                       .mesh = d->mesh,
                                       .paints = &paint,
                                       .paint_count = 1,
                                       .ranges = ranges,
                                       .range_count = count,
                                       .map = map};
    camber_overdraw sum;
    assert_int_equal(camber_renderer_count_overdraw(d->renderer, &desc, &sum), CAMBER_OK);
    return sum;
}

/* The joins of one kind, each by itself. */
static camber_overdraw count_joins(const drawing *d, camber_join_room room, uint8_t *map, size_t *count) {
    camber_index_range *ranges = malloc((d->joins.count + 1) * sizeof *ranges);
    assert_non_null(ranges);
    *count = 0;
    for (size_t i = 0; i < d->joins.count; i++)
        if (d->joins.items[i].room == room)
            ranges[(*count)++] = d->joins.items[i].range;
    const camber_overdraw sum = count_ranges(d, ranges, *count, map);
    free(ranges);
    return sum;
}

/* The plain join that draws most pixels again, found one by one. */
static void tell_worst(const drawing *d) {
    const camber_found_join *worst = NULL;
    uint64_t most = 0;
    for (size_t i = 0; i < d->joins.count; i++) {
        const camber_found_join *join = d->joins.items + i;
        const uint64_t repeated =
            join->room == CAMBER_JOIN_PLAIN ? count_ranges(d, &join->range, 1, NULL).repeated_pixels : 0;
        if (repeated > most) {
            most = repeated;
            worst = join;
        }
    }
    if (worst)
        printf("  a plain join draws %llu px again: at %.9g, %.9g, turn %.4f degrees, indices %llu + %llu\n",
               (unsigned long long)most, (double)worst->x, (double)worst->y, worst->turn_deg,
               (unsigned long long)worst->range.first_index, (unsigned long long)worst->range.index_count);
}

/* Counts apart from each other: the joins by their room, then whole polylines. */
enum { POLYLINES = CAMBER_JOIN_ROOMS, KINDS };

typedef struct overlap {
    size_t joins[CAMBER_JOIN_ROOMS];
    uint64_t repeated[KINDS], drawn; /* once a range */
    uint8_t *maps[KINDS];
    /* Pixels of the picture that joins of a kind draw again; that a polyline does, and none of its joins. */
    size_t pixels[CAMBER_JOIN_ROOMS], elsewhere;
} overlap;

static overlap count_overlap(const drawing *d) {
    overlap o = {0};
    for (int kind = 0; kind < KINDS; kind++) {
        o.maps[kind] = malloc((size_t)SIDE_PX * SIDE_PX);
        assert_non_null(o.maps[kind]);
        const camber_overdraw sum = kind == POLYLINES
                                        ? count_ranges(d, NULL, 0, o.maps[kind])
                                        : count_joins(d, (camber_join_room)kind, o.maps[kind], o.joins + kind);
        o.repeated[kind] = sum.repeated_pixels;
        o.drawn = sum.drawn_pixels;
    }
    for (size_t i = 0; i < (size_t)SIDE_PX * SIDE_PX; i++) {
        bool at_join = false;
        for (int kind = 0; kind < POLYLINES; kind++) {
            o.pixels[kind] += o.maps[kind][i] > 0;
            at_join = at_join || o.maps[kind][i] > 0;
        }
        o.elsewhere += o.maps[POLYLINES][i] > 0 && !at_join;
    }
    return o;
}

static void overlap_free(overlap *o) {
    for (int i = 0; i < KINDS; i++)
        free(o->maps[i]);
}

/* ---- Showing ---- */

/* The streets in grey; what is drawn again in red at plain joins, orange at tight ones, violet at split ones, blue
 * elsewhere in a polyline. */
static void paint_overlap(picture *p, const overlap *o) {
    static const uint8_t colors[KINDS][3] = {{255, 0, 0}, {255, 140, 0}, {160, 0, 200}, {0, 80, 255}};
    for (size_t i = 0; i < (size_t)p->width * p->height; i++)
        for (int kind = POLYLINES; kind >= 0; kind--)
            if (o->maps[kind][i] > 0)
                memcpy(p->rgba + 4 * i, colors[kind], 3);
}

static bool write_file(void *user, const void *bytes, size_t size_bytes) {
    return fwrite(bytes, 1, size_bytes, user) == size_bytes;
}

static void show(camber_context *context, const drawing *d, const overlap *o, const char *name) {
    char path[4096];
    const camber_paint paint = {.width_px = d->width_px, .color = {0.75f, 0.75f, 0.75f, 1}};
    const camber_pass pass = {.mesh = d->mesh, .paints = &paint, .paint_count = 1};
    const camber_frame frame = {
        .width = SIDE_PX, .height = SIDE_PX, .background = {1, 1, 1, 1}, .passes = &pass, .pass_count = 1};
    picture p = picture_draw(d->renderer, &frame);
    paint_overlap(&p, o);
    snprintf(path, sizeof path, "%s/%s.png", CAMBER_OVERLAP_FOLDER, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    camber_png *png = NULL;
    const camber_png_desc desc = {.width = p.width, .height = p.height, .opaque = true};
    assert_int_equal(camber_png_create(context, &desc, (camber_sink){write_file, file}, &png), CAMBER_OK);
    assert_int_equal(camber_png_write_rows(png, p.rgba, p.height), CAMBER_OK);
    assert_int_equal(camber_png_finish(png), CAMBER_OK);
    camber_png_destroy(png);
    assert_int_equal(fclose(file), 0);
    picture_free(&p);
}

/* ---- Tests ---- */

/* One view with one method; what its plain joins draw again, at the mesh's width and at half of it. */
static uint64_t check_view(fixture *s, const camber_scene *town, const network *n, const street_view *view,
                           camber_method method) {
    drawing d = drawing_make(s, camber_scene_get_polylines(town), view->width_px, method);
    overlap o = count_overlap(&d);
    uint64_t broken = o.repeated[CAMBER_JOIN_PLAIN];
    printf("%-10s %4g %5g %-5s %8zu %6zu %6zu %9llu %6zu %6zu %6zu %9zu\n", n->name, view->zoom, (double)view->width_px,
           camber_method_get_name(method), o.joins[CAMBER_JOIN_PLAIN], o.joins[CAMBER_JOIN_TIGHT],
           o.joins[CAMBER_JOIN_SPLIT], (unsigned long long)o.drawn, o.pixels[CAMBER_JOIN_PLAIN],
           o.pixels[CAMBER_JOIN_TIGHT], o.pixels[CAMBER_JOIN_SPLIT], o.elsewhere);
    assert_true(o.joins[CAMBER_JOIN_PLAIN] > 20 && o.drawn > 10000);
    if (method == CAMBER_METHOD_STRIP && view == VIEWS + SHOWN_VIEW)
        show(s->context, &d, &o, n->name);
    if (method == CAMBER_METHOD_FAN) {
        assert_true(broken > o.joins[CAMBER_JOIN_PLAIN] / 20); /* the counts can see what they look for */
        broken = 0;
    } else {
        size_t joins;
        if (broken > 0)
            tell_worst(&d);
        d.width_px /= 2;
        broken += count_joins(&d, CAMBER_JOIN_PLAIN, NULL, &joins).repeated_pixels;
    }
    overlap_free(&o);
    drawing_free(&d);
    return broken;
}

static void test_streets(void **state) {
    fixture *s = *state;
    uint64_t broken = 0;
    size_t seen = 0;
    printf("                              joins                          pixels drawn again\n"
           "network    zoom width method    plain  tight  split     drawn  plain  tight  split elsewhere\n");
    for (size_t i = 0; i < sizeof NETWORKS / sizeof *NETWORKS; i++) {
        streets it;
        if (!streets_read(&it, s->context, NETWORKS + i))
            continue;
        for (size_t v = 0; v < VIEW_COUNT; v++) {
            camber_scene *town = streets_look(&it, NETWORKS + i, VIEWS[v].zoom);
            for (int method = 0; method < 3; method++)
                broken += check_view(s, town, NETWORKS + i, VIEWS + v, (camber_method)method);
            camber_scene_destroy(town);
        }
        streets_forget(&it);
        seen++;
    }
    if (seen < sizeof NETWORKS / sizeof *NETWORKS)
        printf("%zu of %zu networks: CAMBER_DATA has the others\n", seen, sizeof NETWORKS / sizeof *NETWORKS);
    assert_true(seen >= 1);
    assert_int_equal(broken, 0);
}

/* Zigzags and spirals whose joins have hardly more room than they need. */
static camber_made_scene cramped_scene(double width_px) {
    camber_made_scene lines = {0};
    uint64_t seed = 41;
    for (int i = 0; i < 400; i++) {
        double x = camber_random_between(&seed, 0, SIDE_PX), y = camber_random_between(&seed, 0, SIDE_PX);
        double direction = camber_random_between(&seed, -SCENE_PI, SCENE_PI);
        const double turn = camber_random_between(&seed, 0.02, 2.2);
        const double needed = 2 * (width_px / 2 + (double)CAMBER_PAD_PX) * tan(turn / 2);
        for (int k = 0; k < 30; k++) {
            const double length = needed * camber_random_between(&seed, 1.00005, 1.01);
            camber_made_scene_point(&lines, x, y);
            x += length * cos(direction);
            y += length * sin(direction);
            direction += i % 2 && k % 2 ? -turn : turn;
        }
        camber_made_scene_end(&lines, 0);
    }
    return lines;
}

/* Where the cuts of a segment's two ends meet, nothing is drawn twice either. */
static void test_least_room(void **state) {
    fixture *s = *state;
    static const float widths[] = {2, 8, 20};
    for (size_t i = 0; i < sizeof widths / sizeof *widths; i++) {
        camber_made_scene lines = cramped_scene((double)widths[i]);
        camber_polylines *polylines = scene_polylines(s->context, &lines);
        for (int method = 0; method < 2; method++) {
            drawing d = drawing_make(s, polylines, widths[i], (camber_method)method);
            overlap o = count_overlap(&d);
            assert_true(o.joins[CAMBER_JOIN_PLAIN] > 10000);
            assert_true(o.repeated[POLYLINES] > 0);
            assert_int_equal(o.repeated[CAMBER_JOIN_PLAIN], 0);
            overlap_free(&o);
            drawing_free(&d);
        }
        camber_polylines_destroy(polylines);
        camber_made_scene_free(&lines);
    }
}

/* Rings that turn one way, with room at every join. */
static camber_made_scene ring_scene(void) {
    camber_made_scene lines = {0};
    uint64_t seed = 31;
    for (int i = 0; i < 400; i++) {
        const double x = camber_random_between(&seed, 100, 900), y = camber_random_between(&seed, 100, 900);
        const double start = camber_random_between(&seed, 0, 6.3), radius = camber_random_between(&seed, 60, 95);
        const int sides = 3 + i % 12;
        const size_t first = lines.point_count;
        for (int k = 0; k < sides; k++) {
            const double angle = start + 2 * SCENE_PI * k / sides * (i % 2 ? 1 : -1);
            camber_made_scene_point(&lines, x + radius * cos(angle), y + radius * sin(angle));
        }
        camber_made_scene_point(&lines, (double)lines.points[2 * first], (double)lines.points[2 * first + 1]);
        camber_made_scene_end(&lines, 0);
    }
    return lines;
}

/* A ring's seam is in no range of two neighbours: whole rings are counted. */
static void test_seams(void **state) {
    fixture *s = *state;
    camber_made_scene lines = ring_scene();
    camber_polylines *polylines = scene_polylines(s->context, &lines);
    for (int method = 0; method < 2; method++) {
        drawing d = drawing_make(s, polylines, 12, (camber_method)method);
        assert_int_equal(camber_mesh_count_joins(d.mesh), CAMBER_OK);
        const camber_mesh_info info = camber_mesh_get_info(d.mesh);
        assert_int_equal(info.tight_joins + info.split_joins, 0);
        const camber_overdraw sum = count_ranges(&d, NULL, 0, NULL);
        assert_true(sum.drawn_pixels > 400 * 300 * 12);
        assert_int_equal(sum.repeated_pixels, 0);
        drawing_free(&d);
    }
    camber_polylines_destroy(polylines);
    camber_made_scene_free(&lines);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_streets),
        cmocka_unit_test(test_least_room),
        cmocka_unit_test(test_seams),
    };
    return FIXTURE_RUN(tests);
}
