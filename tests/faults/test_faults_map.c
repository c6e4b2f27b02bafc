/* The n-th allocation fails, for every n, in libcamber-map: styles, files of every kind, scenes, GLB, mesh tiles. The
 * status says so in one line, nothing is kept, what failed works afterwards. jansson allocates by itself, with
 * functions that belong to the process: the library leaves them alone, and here they fail too. GDAL's cannot be
 * replaced. */
#include "core.h"

#include "camber_map.h"
#include "features/features.h"
#include "kernels/layout.h"
#include "style/style.h"
#include "tiles/mesh_tile.h"

#include <cpl_conv.h>
#include <errno.h>
#include <gdal_utils.h>
#include <jansson.h>

/* Every operator, the older filters and functions, what is folded to text, and what is warned of. */
static const char STYLE[] =
    "{\"version\": 8, \"sources\": {\"s\": {\"type\": \"geojson\"}}, \"layers\": ["
    "{\"id\": \"ground\", \"type\": \"background\", \"paint\": {\"background-color\": \"#eee\"}},"
    "{\"id\": \"areas\", \"type\": \"fill\", \"source\": \"s\"},"
    "{\"id\": \"edges\", \"type\": \"line\", \"source\": \"s\", \"filter\": [\"==\", \"$type\", \"Polygon\"]},"
    "{\"id\": \"old\", \"type\": \"line\", \"source\": \"s\", \"filter\": [\"all\", [\"in\", \"kind\", \"a\", \"b\"],"
    " [\"!has\", \"hidden\"], [\"none\", [\"<\", \"rank\", 0], [\"!in\", \"kind\", \"a\", \"b\", \"c\"]]],"
    " \"layout\": {\"line-cap\": \"round\", \"line-join\": \"bevel\", \"line-miter-limit\": 3, \"line-sort-key\": 1},"
    " \"paint\": {\"line-width\": {\"base\": 1.5, \"stops\": [[4, 2], [16, 9]]}, \"line-color\": \"rgb(10, 20, 30)\"}},"
    "{\"id\": \"new\", \"type\": \"line\", \"source\": \"s\", \"minzoom\": 1,"
    " \"filter\": [\"any\", [\"in\", [\"get\", \"kind\"], [\"literal\", [\"a\", \"c\"]]],"
    "  [\">=\", [\"to-number\", [\"get\", \"rank\"]], 2], [\"==\", [\"geometry-type\"], \"LineString\"]],"
    " \"paint\": {\"line-opacity\": [\"step\", [\"zoom\"], 0.5, 6, 0.7, 12, 0.9],"
    "  \"line-width\": [\"interpolate\", [\"exponential\", 1.3], [\"zoom\"], 2, [\"+\", 1, [\"*\", 2, 0.5]], 14,"
    "   [\"case\", [\"boolean\", [\"get\", \"wide\"], false], 9, [\"match\", [\"get\", \"rank\"], [1, 2], 6, 3, 4, "
    "2]]],"
    "  \"line-color\": [\"match\", [\"coalesce\", [\"get\", \"kind\"], \"none\"], \"a\", \"#f00\", [\"b\", \"c\"],"
    "   [\"to-color\", [\"get\", \"colour\"], \"#0a0\"],"
    "   [\"case\", [\"==\", [\"to-string\", 5], [\"to-string\", [\"get\", \"rank\"]]], \"#00f\", \"#123456\"]],"
    "  \"line-blur\": 2}}]}";

static const char GEOJSON[] =
    "{\"type\":\"FeatureCollection\",\"features\":["
    "{\"type\":\"Feature\",\"properties\":{\"kind\":\"a\",\"rank\":1,\"wide\":true},\"geometry\":"
    "{\"type\":\"LineString\",\"coordinates\":[[10,50],[10.1,50.1],[10.3,50],[10.5,50.2]]}},"
    "{\"type\":\"Feature\",\"properties\":{\"kind\":\"b\",\"rank\":2.5,\"colour\":\"teal\"},\"geometry\":"
    "{\"type\":\"MultiLineString\",\"coordinates\":[[[10,50.2],[10.4,50.3]],[[10.2,50],[10.2,50.4],[10.3,50.4]]]}},"
    "{\"type\":\"Feature\",\"properties\":{\"kind\":\"c\",\"rank\":\"3\"},\"geometry\":"
    "{\"type\":\"GeometryCollection\",\"geometries\":[{\"type\":\"LineString\",\"coordinates\":[[10.1,50],[10.1,50.3]]}"
    "]}},"
    "{\"type\":\"Feature\",\"properties\":{\"kind\":\"edge\",\"rank\":4},\"geometry\":"
    "{\"type\":\"Polygon\",\"coordinates\":[[[10,50],[10.5,50],[10.5,50.4],[10,50]]]}},"
    "{\"type\":\"Feature\",\"properties\":{\"kind\":\"far\"},\"geometry\":"
    "{\"type\":\"LineString\",\"coordinates\":[[179,51],[-179,51.5]]}}]}";

static const char OSM[] =
    "<osm version='0.6'><node id='1' lat='50' lon='10'/><node id='2' lat='50.1' lon='10.2'/>"
    "<node id='3' lat='50.3' lon='10.1'/><way id='1'><nd ref='1'/><nd ref='2'/><tag k='kind' v='a'/></way>"
    "<way id='2'><nd ref='1'/><nd ref='2'/><nd ref='3'/><nd ref='1'/><tag k='highway' v='path'/></way>"
    "<way id='3'><nd ref='2'/><nd ref='3'/><nd ref='1'/><nd ref='2'/><tag k='building' v='yes'/></way></osm>";

enum { FILES = 4 };
static const char *const FILE_NAMES[FILES] = {"lines.geojson", "ways.osm", "tiles.mbtiles", "shapes.shp"};

typedef struct desk {
    host h;
    camber_context *context;
    char folder[64];
    char paths[FILES][128];
    size_t which;
    camber_style *style;
    camber_features *features; /* of all files */
    uint64_t hashes[FILES];    /* of each file's features */
    camber_scene *scene;
    uint64_t scene_hash;
    camber_mesh_data mesh;
    byte_list glb;
    uint64_t mesh_tile; /* hash of its bytes. 0: it was not made yet */
} desk;

/* ---- The result as a number ---- */

static uint64_t hash_features(const camber_features *f) {
    uint64_t hash = camber_hash(CAMBER_HASH_START, f->points, 2 * f->point_count * sizeof *f->points);
    hash = camber_hash(hash, f->importance, f->point_count * sizeof *f->importance);
    hash = camber_hash(hash, f->offsets, (f->polyline_count + 1) * sizeof *f->offsets);
    hash = camber_hash(hash, f->polyline_feature, f->polyline_count * sizeof *f->polyline_feature);
    hash = camber_hash(hash, &f->stats, sizeof f->stats);
    for (size_t i = 0; i < f->feature_count; i++) {
        const camber_feature_class *class = f->classes + f->feature_class[i];
        hash = camber_hash(hash, f->layer_names[class->layer], strlen(f->layer_names[class->layer]));
        hash = camber_hash(hash, &class->geometry, sizeof class->geometry);
        for (size_t k = 0; k < f->style->schema.property_count; k++) {
            const camber_value *value = f->values + class->first_value + k;
            hash = camber_hash(hash, &value->type, sizeof value->type);
            if (value->type == CAMBER_VALUE_STRING)
                hash = camber_hash(hash, value->string, strlen(value->string));
            if (value->type == CAMBER_VALUE_NUMBER)
                hash = camber_hash(hash, &value->number, sizeof value->number);
        }
    }
    return hash;
}

/* A fill by its colour: where it lies differs from scene to scene. */
static uint64_t hash_paint(uint64_t hash, const camber_paint *paint) {
    camber_paint own;
    memcpy(&own, paint, sizeof own);
    own.fill = NULL;
    hash = camber_hash(hash, &own, sizeof own);
    return paint->fill ? camber_hash(hash, &paint->fill->color, sizeof paint->fill->color) : hash;
}

static uint64_t hash_scene(camber_scene *scene) {
    size_t count = 0;
    const camber_lines *lines = camber_scene_get_lines(scene);
    const camber_stroke *strokes = camber_scene_get_strokes(scene, &count);
    const camber_frame frame = camber_scene_get_frame(scene, NULL);
    uint64_t hash = camber_hash(CAMBER_HASH_START, lines->points, 2 * lines->point_count * sizeof *lines->points);
    hash = camber_hash(hash, lines->offsets, (lines->polyline_count + 1) * sizeof *lines->offsets);
    hash = camber_hash(hash, camber_scene_get_rows(scene), lines->polyline_count * sizeof(uint32_t));
    hash = camber_hash(hash, strokes, count * sizeof *strokes);
    hash = camber_hash(hash, &frame.background, sizeof frame.background);
    for (size_t i = 0; i < frame.pass_count; i++) {
        const camber_pass *pass = frame.passes + i;
        const size_t range[] = {pass->first_polyline, pass->polyline_count};
        hash = camber_hash(hash, range, sizeof range);
        for (size_t k = 0; k < pass->paint_count; k++)
            hash = hash_paint(hash, pass->paints + k);
    }
    return hash;
}

/* ---- Attempts ---- */

static camber_status try_style(camber_context *context, void *user) {
    desk *d = user;
    camber_style *const untouched = (camber_style *)(void *)d;
    camber_style *style = untouched;
    const camber_status status = camber_style_parse(context, STYLE, sizeof STYLE - 1, "style", &style);
    if (status != CAMBER_OK) {
        assert_ptr_equal(style, untouched);
        return status;
    }
    assert_int_equal(style->layer_count, d->style->layer_count);
    assert_int_equal(style->schema.property_count, d->style->schema.property_count);
    for (size_t i = 0; i < style->schema.property_count; i++)
        assert_string_equal(style->schema.properties[i], d->style->schema.properties[i]);
    for (size_t i = 0; i < style->layer_count; i++)
        assert_string_equal(style->layers[i].filter_key, d->style->layers[i].filter_key);
    camber_style_destroy(style);
    return status;
}

/* The built-in style is much larger than this one, and has no other kinds of expressions. */
static camber_status try_shipped(camber_context *context, void *user) {
    (void)user;
    camber_style *style = NULL;
    size_t size_bytes;
    const char *text = camber_style_get_text("roads", CAMBER_THEME_LIGHT, &size_bytes);
    const camber_status status = camber_style_parse(context, text, size_bytes, "roads", &style);
    assert_true((status == CAMBER_OK) == (style != NULL));
    camber_style_destroy(style);
    return status;
}

static camber_status read_file(camber_features *features, const desk *d, size_t which) {
    const camber_source_desc desc = {.path = d->paths[which]};
    return camber_features_read(features, &desc);
}

static camber_status try_read(camber_context *context, void *user) {
    desk *d = user;
    camber_features *features = NULL;
    camber_status status = camber_features_create(context, d->style, &features);
    if (status == CAMBER_OK)
        status = read_file(features, d, d->which);
    if (status == CAMBER_OK)
        assert_true(hash_features(features) == d->hashes[d->which]);
    camber_features_destroy(features);
    return status;
}

static camber_status try_scene(camber_context *context, void *user) {
    (void)context;
    desk *d = user;
    const camber_scene_desc descs[] = {
        {.view = {.width = 300, .height = 200}, .simplify_px = 0.5},
        {.view = {CAMBER_VIEW_BBOX, 9.9, 49.9, 10.3, 50.3, .width = 200, .height = 200, .ratio = 2}},
        {.view = {CAMBER_VIEW_CENTER, .longitude = 10.2, .latitude = 50.1, .zoom = 12, .bearing_deg = 30}}};
    uint64_t hash = CAMBER_HASH_START;
    for (size_t i = 0; i < sizeof descs / sizeof *descs; i++) {
        camber_scene *scene = NULL;
        camber_status status = camber_scene_create(d->features, descs + i, &scene);
        if (status != CAMBER_OK) {
            assert_null(scene);
            return status;
        }
        status = camber_scene_project(scene);
        if (status != CAMBER_OK) {
            camber_scene_destroy(scene);
            return status;
        }
        const uint64_t one = hash_scene(scene);
        hash = camber_hash(hash, &one, sizeof one);
        camber_scene_destroy(scene);
    }
    if (d->scene_hash == 0)
        d->scene_hash = hash;
    assert_true(hash == d->scene_hash);
    return CAMBER_OK;
}

static camber_status write_glb(camber_context *context, desk *d, byte_list *file) {
    size_t count = 0;
    const camber_stroke *strokes = camber_scene_get_strokes(d->scene, &count);
    camber_paint *paints = calloc(count, sizeof *paints);
    assert_non_null(paints);
    for (size_t i = 0; i < count; i++)
        paints[i] = (camber_paint){.width_px = strokes[i].width_px, .color = {0.1f, 0.2f, 0.3f, 0.5f}};
    const camber_glb_desc desc = {strokes, paints, count, "\xc2\xa9 nobody"};
    const camber_status status = camber_glb_write(context, &d->mesh, &desc, (camber_sink){byte_list_write, file});
    free(paints);
    return status;
}

static camber_status try_glb(camber_context *context, void *user) {
    desk *d = user;
    byte_list file = {.refuse_at = SIZE_MAX};
    const camber_status status = write_glb(context, d, &file);
    if (status == CAMBER_OK) {
        assert_int_equal(file.size, d->glb.size);
        assert_memory_equal(file.bytes, d->glb.bytes, file.size);
    }
    free(file.bytes);
    return status;
}

/* ---- Files ---- */

/* A zigzag through the tile for each pair that has lines, drawn or not. */
enum { ZIGZAG = 40, PAIRS_MOST = 64 };
static void make_lines(const camber_mesh_plan *plan, camber_mesh_point *points, camber_mesh_picture *picture) {
    const camber_plan *p = &plan->zoom->plan;
    *picture = (camber_mesh_picture){.plan = plan, .lines = calloc(PAIRS_MOST, sizeof *picture->lines)};
    picture->points = points;
    assert_non_null(picture->lines);
    for (size_t set = 0; set < p->set_count; set++)
        for (size_t k = 0; k < p->sets[set].pair_count && !camber_plan_is_area(p, p->sets + set); k++) {
            const size_t first = ZIGZAG * picture->line_count;
            assert_true(picture->line_count < PAIRS_MOST);
            picture->lines[picture->line_count++] = (camber_mesh_line){.first = first,
                                                                       .count = ZIGZAG,
                                                                       .pair = (uint32_t)(p->sets[set].first_pair + k),
                                                                       .x0 = 0,
                                                                       .y0 = 0,
                                                                       .x1 = 20 * ZIGZAG,
                                                                       .y1 = 100};
            for (size_t i = 0; i < ZIGZAG; i++)
                points[first + i] = (camber_mesh_point){.x = 20.0f * (float)i,
                                                        .y = i % 2 ? 100.0f : 0.0f,
                                                        .info = CAMBER_POINT_REAL | (i ? 0u : CAMBER_POINT_FIRST) |
                                                                (i + 1 < ZIGZAG ? 0u : CAMBER_POINT_LAST)};
        }
    picture->point_count = ZIGZAG * picture->line_count;
}

/* Plans, cuts and encodes a mesh tile. What a device draws for it is made by hand, and free of the context. */
static camber_status try_mesh_tile(camber_context *context, void *user) {
    desk *d = user;
    static camber_mesh_point points[ZIGZAG * PAIRS_MOST];
    const camber_zoom_desc desc = {.zoom = 10, .scale_px = 512 << 10, .ratio = 1, .simplify_px = 0.1};
    const camber_mesh_place place = {10, 540, 350, 1};
    camber_mesh_plan *plan = NULL;
    camber_mesh_tile tile = {0};
    uint8_t *bytes = NULL;
    size_t size_bytes = 0;
    camber_status status = camber_mesh_plan_create(d->features, &desc, &plan);
    if (status == CAMBER_OK) {
        camber_mesh_picture picture;
        make_lines(plan, points, &picture);
        assert_true(picture.line_count > 2);
        status = camber_mesh_tile_cut(context, &picture, 512, 0, 0, &tile);
        free(picture.lines);
    }
    if (status == CAMBER_OK) {
        assert_true(tile.record_count > ZIGZAG && tile.range_count > 1);
        status = camber_mesh_tile_encode(&tile, plan, &place, &bytes, &size_bytes);
    }
    if (status == CAMBER_OK) {
        const uint64_t hash = camber_hash(CAMBER_HASH_START, bytes, size_bytes);
        assert_true(size_bytes > 500 && (!d->mesh_tile || d->mesh_tile == hash));
        d->mesh_tile = hash;
    }
    camber_free(context, bytes);
    camber_mesh_tile_free(&tile);
    camber_mesh_plan_destroy(plan);
    return status;
}

static void write_text(const char *path, const char *text) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fputs(text, file) >= 0, 1);
    assert_int_equal(fclose(file), 0);
}

static void translate(const char *from, const char *to, char **options) {
    GDALVectorTranslateOptions *parsed = GDALVectorTranslateOptionsNew(options, NULL);
    GDALDatasetH source = GDALOpenEx(from, GDAL_OF_VECTOR, NULL, NULL, NULL);
    assert_non_null(source);
    GDALDatasetH target = GDALVectorTranslate(to, NULL, 1, &source, parsed, NULL);
    assert_non_null(target);
    GDALClose(target);
    GDALClose(source);
    GDALVectorTranslateOptionsFree(parsed);
}

static void make_files(desk *d) {
    folder_make(d->folder);
    for (size_t i = 0; i < FILES; i++)
        snprintf(d->paths[i], sizeof d->paths[i], "%s/%s", d->folder, FILE_NAMES[i]);
    write_text(d->paths[0], GEOJSON);
    write_text(d->paths[1], OSM);
    GDALAllRegister();
    char *tiles[] = {(char[]){"-f"},
                     (char[]){"MBTiles"},
                     (char[]){"-nln"},
                     (char[]){"roads"},
                     (char[]){"-dsco"},
                     (char[]){"MINZOOM=9"},
                     (char[]){"-dsco"},
                     (char[]){"MAXZOOM=9"},
                     (char[]){"-where"},
                     (char[]){"kind IN ('a', 'b', 'c')"},
                     NULL};
    translate(d->paths[0], d->paths[2], tiles);
    char *shapes[] = {(char[]){"-f"},
                      (char[]){"ESRI Shapefile"},
                      (char[]){"-nlt"},
                      (char[]){"MULTILINESTRING"},
                      (char[]){"-where"},
                      (char[]){"kind IN ('a', 'b', 'far')"},
                      NULL};
    translate(d->paths[0], d->paths[3], shapes);
}

static int set_up(void **state) {
    desk *d = calloc(1, sizeof *d);
    assert_non_null(d);
    d->context = host_context(&d->h);
    make_files(d);
    assert_int_equal(camber_style_parse(d->context, STYLE, sizeof STYLE - 1, "style", &d->style), CAMBER_OK);
    assert_int_equal(camber_features_create(d->context, d->style, &d->features), CAMBER_OK);
    for (size_t i = 0; i < FILES; i++) {
        camber_features *alone = NULL;
        assert_int_equal(camber_features_create(d->context, d->style, &alone), CAMBER_OK);
        if (read_file(alone, d, i) != CAMBER_OK || read_file(d->features, d, i) != CAMBER_OK)
            fail_msg("%s: %s", FILE_NAMES[i], d->h.last);
        d->hashes[i] = hash_features(alone);
        assert_true(camber_features_get_stats(alone).features >= 2);
        camber_features_destroy(alone);
    }
    const camber_scene_desc desc = {.view = {CAMBER_VIEW_BBOX, 9.9, 49.9, 10.6, 50.5}};
    assert_int_equal(camber_scene_create(d->features, &desc, &d->scene), CAMBER_OK);
    assert_int_equal(camber_scene_project(d->scene), CAMBER_OK);
    size_t count = 0;
    const camber_stroke *strokes = camber_scene_get_strokes(d->scene, &count);
    assert_true(count >= 4 && camber_scene_get_info(d->scene).layers >= 3);
    const camber_tessellation_desc strips = {strokes, count, CAMBER_METHOD_STRIP, 0, false};
    assert_int_equal(camber_mesh_data_tessellate(d->context, camber_scene_get_polylines(d->scene), &strips, &d->mesh),
                     CAMBER_OK);
    d->glb.refuse_at = SIZE_MAX;
    assert_int_equal(write_glb(d->context, d, &d->glb), CAMBER_OK);
    *state = d;
    return 0;
}

static int tear_down(void **state) {
    desk *d = *state;
    free(d->glb.bytes);
    camber_mesh_data_destroy(&d->mesh);
    camber_scene_destroy(d->scene);
    camber_features_destroy(d->features);
    camber_style_destroy(d->style);
    host_done(&d->h, d->context);
    folder_remove(d->folder);
    free(d);
    return 0;
}

/* ---- The context's allocations ---- */

static void each_fails(desk *d, camber_status (*attempt)(camber_context *context, void *user)) {
    const uint64_t features = hash_features(d->features);
    assert_int_equal(attempt(d->context, d), CAMBER_OK);
    each_allocation_fails(&d->h, attempt, d->context, d);
    assert_true(hash_features(d->features) == features);
}

static void test_styles(void **state) {
    each_fails(*state, try_style);
    each_fails(*state, try_shipped);
}

static void test_files(void **state) {
    desk *d = *state;
    for (d->which = 0; d->which < FILES; d->which++)
        each_fails(d, try_read);
}

static void test_scenes(void **state) {
    each_fails(*state, try_scene);
}

static void test_glb(void **state) {
    each_fails(*state, try_glb);
}

static void test_mesh_tiles(void **state) {
    if (!camber_mesh_is_built())
        skip();
    each_fails(*state, try_mesh_tile);
}

/* A set that has a file already keeps it whole through every failure to read another, and takes that one afterwards.
 * Five arrays shrink at the end: one that cannot stays as it is, and the file is read. */
static void test_set_stays(void **state) {
    desk *d = *state;
    for (size_t which = 1; which < FILES; which++) {
        uint64_t both = 0;
        size_t n = 0, kept = 0;
        for (bool reached = true; reached; n++) {
            camber_features *features = NULL;
            assert_int_equal(camber_features_create(d->context, d->style, &features), CAMBER_OK);
            assert_int_equal(read_file(features, d, 0), CAMBER_OK);
            camber_status status = CAMBER_ERROR_MEMORY;
            if (n > 0) {
                d->h.refuse_first = d->h.calls + n;
                d->h.refuse_count = 1;
                status = read_file(features, d, which);
                reached = d->h.calls >= d->h.refuse_first;
                d->h.refuse_first = 0;
                kept += reached && status == CAMBER_OK;
                if (status != CAMBER_OK) {
                    assert_true(reached);
                    assert_int_equal(status, CAMBER_ERROR_MEMORY);
                    assert_story(&d->h, "memory");
                    assert_true(hash_features(features) == d->hashes[0]);
                }
            }
            if (status != CAMBER_OK)
                assert_int_equal(read_file(features, d, which), CAMBER_OK);
            both = n == 0 ? hash_features(features) : both;
            assert_true(hash_features(features) == both);
            camber_features_destroy(features);
        }
        assert_true(n > 5);
        assert_true(kept <= 5);
    }
}

/* GDAL's settings of the thread are put back, whatever fails. */
static camber_status try_settings(camber_context *context, void *user) {
    static const char name[] = "CPL_VSIL_GZIP_WRITE_PROPERTIES";
    CPLSetThreadLocalConfigOption(name, "YES");
    const camber_status status = try_read(context, user);
    assert_string_equal(CPLGetThreadLocalConfigOption(name, "lost"), "YES");
    CPLSetThreadLocalConfigOption(name, NULL);
    return status;
}

static void test_settings(void **state) {
    desk *d = *state;
    d->which = 0;
    each_fails(d, try_settings);
}

/* ---- jansson's ---- */

/* One for the process, as jansson's functions are. */
static struct { size_t live_blocks, calls, refuse_at; } json;

static void *json_allocate(size_t size) {
    if (++json.calls == json.refuse_at) {
        errno = ENOMEM; /* as malloc does */
        return NULL;
    }
    void *block = malloc(size);
    json.live_blocks += block != NULL;
    return block;
}

static void json_release(void *block) {
    json.live_blocks -= block != NULL;
    free(block);
}

static void each_json_fails(desk *d, camber_status (*attempt)(camber_context *context, void *user)) {
    const size_t live = d->h.live_blocks;
    json_set_alloc_funcs(json_allocate, json_release);
    size_t n = 1;
    for (bool reached = true; reached; n++) {
        json.refuse_at = json.calls + n;
        const camber_status status = attempt(d->context, d);
        reached = json.calls >= json.refuse_at;
        assert_int_equal(json.live_blocks, 0);
        assert_int_equal(d->h.live_blocks, live);
        if (status == CAMBER_OK) {
            assert_int_equal(d->h.errors, 0);
            continue;
        }
        if (status != CAMBER_ERROR_MEMORY)
            fail_msg("allocation %zu: %s", n, d->h.last);
        assert_story(&d->h, "memory");
    }
    assert_true(n > 20);
    json_set_alloc_funcs(malloc, free);
}

static void test_json(void **state) {
    each_json_fails(*state, try_style);
    each_json_fails(*state, try_glb);
    if (camber_mesh_is_built())
        each_json_fails(*state, try_mesh_tile);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_styles),   cmocka_unit_test(test_files),      cmocka_unit_test(test_scenes),
        cmocka_unit_test(test_glb),      cmocka_unit_test(test_mesh_tiles), cmocka_unit_test(test_set_stays),
        cmocka_unit_test(test_settings), cmocka_unit_test(test_json),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
