/* The scenes: roads of real cities and random walks that turn like roads, as polylines in pixels of one square; areas
 * of such places, and made ones. */
#include "bench.h"

#include "base/base.h"
#include "validate/scenes.h"
#include "validate/statistics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Random walks ---- */

/* In the context's memory, as those of cities are. */
static bool take_made(camber_context *context, const camber_made_scene *scene, camber_lines *lines) {
    camber_lines made = {
        .context = context, .point_count = scene->point_count, .polyline_count = scene->polyline_count};
    made.offsets = camber_alloc(context, made.polyline_count + 1, sizeof *made.offsets);
    made.points = camber_alloc(context, made.point_count, 2 * sizeof *made.points);
    const bool done = made.offsets && made.points;
    if (done) {
        memcpy(made.offsets, scene->offsets, (made.polyline_count + 1) * sizeof *made.offsets);
        memcpy(made.points, scene->points, made.point_count * 2 * sizeof *made.points);
        *lines = made;
    } else {
        camber_lines_destroy(&made);
    }
    return done;
}

static bool make_walks(camber_context *context, size_t polyline_count, double step_px, camber_lines *lines) {
    camber_made_scene scene;
    bool done = camber_road_walks_make(polyline_count, BENCH_SIDE_PX, step_px, &scene);
    if (done)
        done = take_made(context, &scene, lines);
    camber_made_scene_free(&scene);
    return done;
}

/* ---- Cities ---- */

#ifdef CAMBER_MAP

#include <gdal.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>

/* World coordinates, 0 to 1, y down. */
typedef struct city {
    camber_context *context;
    double *points;
    uint32_t *offsets; /* polyline_count + 1 */
    size_t point_count, polyline_count, point_capacity, offset_capacity;
    OGRCoordinateTransformationH to_degrees; /* NULL: they are */
    bool of_areas;                           /* else of lines */
    const char *where;                       /* which areas of OpenStreetMap; NULL: all */
    uint32_t *areas;                         /* area_count + 1 */
    size_t area_count, area_capacity;
} city;

static bool add_line(city *c, OGRGeometryH line) {
    const double degrees_to_world = 1.0 / 360, pi = 3.14159265358979323846;
    const size_t count = (size_t)OGR_G_GetPointCount(line);
    if (!camber_grow(c->context, &c->points, &c->point_capacity, c->point_count + count, 2 * sizeof *c->points) ||
        !camber_grow(c->context, &c->offsets, &c->offset_capacity, c->polyline_count + 2, sizeof *c->offsets))
        return false;
    for (size_t i = 0; i < count; i++) {
        double longitude = OGR_G_GetX(line, (int)i), latitude = OGR_G_GetY(line, (int)i);
        if (c->to_degrees)
            OCTTransform(c->to_degrees, 1, &longitude, &latitude, NULL);
        double *point = c->points + 2 * c->point_count++;
        point[0] = (longitude + 180) * degrees_to_world;
        point[1] = (1 - asinh(tan(latitude * pi / 180)) / pi) / 2;
    }
    c->offsets[0] = 0;
    c->offsets[++c->polyline_count] = (uint32_t)c->point_count;
    return true;
}

/* Turns the last polyline, a ring, clockwise as seen, or the other way. */
static void turn_ring(city *c, bool clockwise) {
    const size_t first = c->offsets[c->polyline_count - 1], end = c->offsets[c->polyline_count];
    double area = 0;
    for (size_t i = first; i + 1 < end; i++)
        area += (c->points[2 * i] - c->points[2 * i + 2]) * (c->points[2 * i + 1] + c->points[2 * i + 3]);
    for (size_t i = first, k = end; (area > 0) != clockwise && i + 1 < k; i++) {
        k--;
        for (size_t axis = 0; axis < 2; axis++) {
            const double kept = c->points[2 * i + axis];
            c->points[2 * i + axis] = c->points[2 * k + axis];
            c->points[2 * k + axis] = kept;
        }
    }
}

static bool add_area(city *c, OGRGeometryH polygon) {
    if (!camber_grow(c->context, &c->areas, &c->area_capacity, c->area_count + 2, sizeof *c->areas))
        return false;
    for (int i = 0; i < OGR_G_GetGeometryCount(polygon); i++) {
        if (!add_line(c, OGR_G_GetGeometryRef(polygon, i)))
            return false;
        turn_ring(c, i == 0);
    }
    c->areas[0] = 0;
    c->areas[++c->area_count] = (uint32_t)c->polyline_count;
    return true;
}

static bool add_geometry(city *c, OGRGeometryH geometry) {
    if (!geometry)
        return true;
    const OGRwkbGeometryType type = wkbFlatten(OGR_G_GetGeometryType(geometry));
    const bool many = type == (c->of_areas ? wkbMultiPolygon : wkbMultiLineString);
    bool done = true;
    if (type == (c->of_areas ? wkbPolygon : wkbLineString))
        done = c->of_areas ? add_area(c, geometry) : add_line(c, geometry);
    for (int i = 0; many && done && i < OGR_G_GetGeometryCount(geometry); i++)
        done = add_geometry(c, OGR_G_GetGeometryRef(geometry, i));
    return done;
}

static bool add_layer(city *c, OGRLayerH layer) {
    OGRSpatialReferenceH from = OGR_L_GetSpatialRef(layer), degrees = OSRNewSpatialReference(NULL);
    OSRImportFromEPSG(degrees, 4326);
    OSRSetAxisMappingStrategy(degrees, OAMS_TRADITIONAL_GIS_ORDER);
    c->to_degrees = from && OSRIsProjected(from) ? OCTNewCoordinateTransformation(from, degrees) : NULL;
    bool done = true;
    OGRFeatureH feature;
    while (done && (feature = OGR_L_GetNextFeature(layer))) {
        done = add_geometry(c, OGR_F_GetGeometryRef(feature));
        OGR_F_Destroy(feature);
    }
    if (c->to_degrees)
        OCTDestroyCoordinateTransformation(c->to_degrees);
    OSRDestroySpatialReference(degrees);
    return done;
}

/* Takes OpenStreetMap's highways, the roads of vector tiles, and every line of anything else. */
static bool read_city(city *c, const char *path) {
    GDALAllRegister();
    const char *const options[] = {"USE_CUSTOM_INDEXING=NO", NULL}; /* reads files that are not sorted by id as well */
    CPLPushErrorHandler(CPLQuietErrorHandler);
    GDALDatasetH file = GDALOpenEx(path, GDAL_OF_VECTOR, NULL, options, NULL);
    bool done = file != NULL;
    if (file && strcmp(GDALGetDriverShortName(GDALGetDatasetDriver(file)), "OSM") == 0) {
        OGRLayerH layer = GDALDatasetGetLayerByName(file, c->of_areas ? "multipolygons" : "lines");
        OGR_L_SetAttributeFilter(layer, c->of_areas ? c->where : "highway IS NOT NULL");
        done = add_layer(c, layer);
    } else if (file && GDALDatasetGetLayerByName(file, "roads")) {
        done = add_layer(c, GDALDatasetGetLayerByName(file, "roads"));
    } else {
        for (int i = 0; file && done && i < GDALDatasetGetLayerCount(file); i++)
            done = add_layer(c, GDALDatasetGetLayer(file, i));
    }
    if (file)
        GDALClose(file);
    CPLPopErrorHandler();
    return done && c->point_count > 0;
}

/* The middle 99 % of the points of an axis: the least of them, and how far they reach. */
static double middle_of(const city *c, size_t axis, double *sorted, double *low) {
    for (size_t i = 0; i < c->point_count; i++)
        sorted[i] = c->points[2 * i + axis];
    camber_statistics_sort(sorted, c->point_count);
    *low = sorted[(size_t)((double)c->point_count * 0.005)];
    return sorted[(size_t)((double)c->point_count * 0.995)] - *low;
}

/* The middle 99 % of the points on each axis span the square; the rest lies outside. */
static bool fit(const city *c, camber_lines *lines) {
    double *sorted = camber_alloc(c->context, c->point_count, sizeof *sorted);
    camber_lines made = {.context = c->context, .point_count = c->point_count, .polyline_count = c->polyline_count};
    made.points = camber_alloc(c->context, c->point_count, 2 * sizeof *made.points);
    made.offsets = camber_alloc(c->context, c->polyline_count + 1, sizeof *made.offsets);
    const bool done = sorted && made.points && made.offsets;
    if (done) {
        double low[2];
        const double across = middle_of(c, 0, sorted, low), down = middle_of(c, 1, sorted, low + 1);
        const double scale = BENCH_SIDE_PX / (across > down ? across : down);
        for (size_t i = 0; i < 2 * c->point_count; i++)
            made.points[i] = (float)((c->points[i] - low[i % 2]) * scale);
        memcpy(made.offsets, c->offsets, (c->polyline_count + 1) * sizeof *made.offsets);
        *lines = made;
    } else {
        camber_lines_destroy(&made);
    }
    camber_free(c->context, sorted);
    return done;
}

static bool make_city(camber_context *context, const char *path, camber_lines *lines) {
    city c = {.context = context};
    const bool done = read_city(&c, path) && fit(&c, lines);
    camber_free(context, c.points);
    camber_free(context, c.offsets);
    return done;
}

static bool make_city_areas(camber_context *context, const char *path, const char *where, bench_scene *scene) {
    city c = {.context = context, .of_areas = true, .where = where};
    const bool done = read_city(&c, path) && fit(&c, &scene->lines);
    scene->areas = c.areas;
    scene->area_count = c.area_count;
    camber_free(context, c.points);
    camber_free(context, c.offsets);
    return done;
}

#else

static bool make_city(camber_context *context, const char *path, camber_lines *lines) {
    (void)context;
    (void)path;
    (void)lines;
    return false;
}

static bool make_city_areas(camber_context *context, const char *path, const char *where, bench_scene *scene) {
    (void)where;
    return make_city(context, path, &scene->lines);
}

#endif

/* ---- The list ---- */

typedef struct scene_source {
    const char *key, *name, *file; /* NULL: walks */
    float width_px;
    size_t walks;
    double step_px;
    bool own;  /* the file lies in the repository */
    bool slow; /* left out of a quick run */
} scene_source;

static const scene_source sources[] = {
    {.key = "santa_cruz", .name = "Santa Cruz", .file = CAMBER_DEMO_CITY, .width_px = 2, .own = true},
    {.key = "porto", .name = "Porto", .file = "porto_portugal.osm.pbf", .width_px = 2},
    {.key = "nyc", .name = "New York", .file = "nyc.osm.pbf", .width_px = 4},
    {.key = "columbus", .name = "Columbus", .file = "columbus.osm.pbf", .width_px = 2, .slow = true},
    {.key = "beijing", .name = "Beijing", .file = "beijing-2013.geojson", .width_px = 4, .slow = true},
    {.key = "zoom", .name = "long walks", .walks = 10000, .step_px = 32, .width_px = 8},
    {.key = "synth", .name = "short walks", .walks = 200000, .step_px = 3.2, .width_px = 2, .slow = true},
};

static bool path_of(const bench *b, const scene_source *from, char *path, size_t size) {
    if (!from->file || (!from->own && !b->data))
        return false;
    snprintf(path, size, "%s%s%s", from->own ? "" : b->data, from->own ? "" : "/data/", from->file);
    return true;
}

static bool make_scene(bench *b, const scene_source *from, bench_scene *scene) {
    char path[1024];
    *scene = (bench_scene){.key = from->key, .name = from->name, .width_px = from->width_px};
    if (!from->file)
        return make_walks(b->context, b->size == BENCH_TINY ? from->walks / 100 : from->walks, from->step_px,
                          &scene->lines);
    if (!path_of(b, from, path, sizeof path))
        return false;
    const bool done = make_city(b->context, path, &scene->lines);
    if (!done)
        fprintf(stderr, "camber_bench: %s is left out: %s cannot be read\n", from->name, path);
    return done;
}

static bool is_wanted(const bench *b, const scene_source *from, const char *key) {
    if (key)
        return strcmp(key, from->key) == 0 && (b->size != BENCH_TINY || !from->file);
    return b->size == BENCH_FULL || (b->size == BENCH_QUICK && !from->slow) || (b->size == BENCH_TINY && !from->file);
}

bool bench_scenes_make(bench *b, const char *key) {
    if (!b->data && !key && b->size != BENCH_TINY)
        fprintf(stderr, "camber_bench: CAMBER_DATA is unset: the larger cities are left out\n");
    for (size_t i = 0; i < sizeof sources / sizeof *sources; i++) {
        bench_scene *scene = b->scenes + b->scene_count;
        if (!is_wanted(b, sources + i, key) || !make_scene(b, sources + i, scene))
            continue;
        for (size_t k = 0; k < scene->lines.polyline_count; k++) {
            const uint32_t count = scene->lines.offsets[k + 1] - scene->lines.offsets[k];
            scene->segments += count > 1 ? count - 1 : 0;
        }
        b->scene_count++;
    }
    return b->scene_count > 0;
}

bool bench_scene_path(const bench *b, const char *key, char *path, size_t size) {
    for (size_t i = 0; i < sizeof sources / sizeof *sources; i++)
        if (strcmp(sources[i].key, key) == 0)
            return path_of(b, sources + i, path, size);
    return false;
}

const bench_scene *bench_scene_find(const bench *b, const char *key) {
    for (size_t i = 0; i < b->scene_count; i++)
        if (strcmp(b->scenes[i].key, key) == 0)
            return b->scenes + i;
    return NULL;
}

void bench_scenes_free(bench *b) {
    for (size_t i = 0; i < b->scene_count; i++)
        camber_lines_destroy(&b->scenes[i].lines);
    b->scene_count = 0;
}

/* ---- Areas ---- */

/* Ends the ring that has been added, which is an area. */
static void end_area(camber_made_scene *made) {
    const size_t first = made->polyline_count ? made->offsets[made->polyline_count] : 0;
    if (!made->failed && made->point_count > first)
        camber_made_scene_point(made, (double)made->points[2 * first], (double)made->points[2 * first + 1]);
    camber_made_scene_end(made, 0);
}

/* Houses of 3 to 6 px, each turned its own way, a cell of a grid each. */
static void add_houses(camber_made_scene *made, size_t count) {
    const size_t across = (size_t)ceil(sqrt((double)count));
    const double cell = (double)BENCH_SIDE_PX / (double)across;
    for (size_t i = 0; i < count; i++) {
        const double x = cell * ((double)(i % across) + 0.5), y = cell * ((double)(i / across) + 0.5);
        const double angle = 0.7 * (double)(i % 101), radius = cell * (0.33 + 0.0017 * (double)(i % 97));
        for (int corner = 0; corner < 4; corner++) {
            const double turn = angle + corner * 1.5707963267948966 + (corner % 2 ? 0.3 : 0);
            camber_made_scene_point(made, x + radius * cos(turn), y + radius * sin(turn));
        }
        end_area(made);
    }
}

/* Letters like a C, 12 px high, each turned its own way, a cell of a grid each: 20 points outside and 20 inside. */
static void add_glyphs(camber_made_scene *made, size_t count) {
    enum { POINTS = 20 };
    const size_t across = (size_t)ceil(sqrt((double)count));
    const double cell = (double)BENCH_SIDE_PX / (double)across;
    for (size_t i = 0; i < count; i++) {
        const double x = cell * ((double)(i % across) + 0.5), y = cell * ((double)(i / across) + 0.5);
        const double gap = 0.3 + 0.005 * (double)(i % 97), first = 0.7 * (double)(i % 101) + gap;
        const double step = (6.283185307179586 - 2 * gap) / (POINTS - 1), inside = 4 + 0.01 * (double)(i % 53);
        for (int k = 0; k < 2 * POINTS; k++) {
            const double turn = first + step * (k < POINTS ? k : 2 * POINTS - 1 - k), radius = k < POINTS ? 6 : inside;
            camber_made_scene_point(made, x + radius * cos(turn), y + radius * sin(turn));
        }
        end_area(made);
    }
}

/* One island whose shore has waves of all lengths. */
static void add_island(camber_made_scene *made, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const double turn = 6.283185307179586 * (double)i / (double)count;
        double radius = 700;
        for (double wave = 5; wave < (double)count / 8; wave *= 2.7)
            radius += 700 / (wave + 3) * sin(floor(wave) * turn + wave);
        camber_made_scene_point(made, 1024 + radius * cos(turn), 1024 + radius * sin(turn));
    }
    end_area(made);
}

typedef struct area_source {
    const char *key, *name, *file; /* NULL: made */
    const char *where;             /* an OGR filter; NULL: all areas */
    void (*add)(camber_made_scene *made, size_t count);
    size_t count;
    bool apart; /* made only by its key */
} area_source;

static const area_source area_sources[] = {
    {.key = "nyc", .name = "New York", .file = "nyc.osm.pbf"},
    {.key = "helsinki", .name = "Helsinki", .file = "Helsinki-1327152.osm.pbf"},
    {.key = "liechtenstein",
     .name = "Liechtenstein's land use",
     .file = "liechtenstein-latest.osm.pbf",
     .where = "landuse IS NOT NULL"},
    {.key = "houses", .name = "100,000 houses", .add = add_houses, .count = 100000},
    {.key = "island", .name = "an island", .add = add_island, .count = 1000000},
    {.key = "glyphs", .name = "21,316 glyphs", .add = add_glyphs, .count = 21316, .apart = true},
};

static bool make_areas(const bench *b, const area_source *from, bench_scene *scene) {
    camber_made_scene made = {.name = from->name};
    from->add(&made, b->size == BENCH_TINY ? from->count / 100 : from->count);
    scene->area_count = made.polyline_count;
    scene->areas = camber_alloc(b->context, made.polyline_count + 1, sizeof *scene->areas);
    for (size_t i = 0; scene->areas && i <= scene->area_count; i++)
        scene->areas[i] = (uint32_t)i;
    const bool done = !made.failed && scene->areas && take_made(b->context, &made, &scene->lines);
    camber_made_scene_free(&made);
    return done;
}

static bool make_area_scene(const bench *b, const area_source *from, bench_scene *scene) {
    char path[1024];
    *scene = (bench_scene){.key = from->key, .name = from->name};
    snprintf(path, sizeof path, "%s/data/%s", b->data ? b->data : "", from->file ? from->file : "");
    const bool done = from->file ? make_city_areas(b->context, path, from->where, scene) : make_areas(b, from, scene);
    if (!done)
        fprintf(stderr, "camber_bench: areas of %s are left out\n", from->name);
    scene->segments = done ? scene->lines.point_count - scene->lines.polyline_count : 0;
    return done;
}

size_t bench_areas_make(const bench *b, const char *key, bench_scene scenes[BENCH_SCENES_MAX]) {
    size_t count = 0;
    for (size_t i = 0; i < sizeof area_sources / sizeof *area_sources; i++) {
        const area_source *from = area_sources + i;
        const bool here = from->file ? b->data && b->size != BENCH_TINY : b->size != BENCH_QUICK || from->apart;
        if (here && (key ? strcmp(key, from->key) == 0 : !from->apart) && make_area_scene(b, from, scenes + count))
            count++;
    }
    return count;
}

void bench_areas_free(bench_scene *scenes, size_t count) {
    for (size_t i = 0; i < count; i++) {
        camber_free(scenes[i].lines.context, scenes[i].areas);
        camber_lines_destroy(&scenes[i].lines);
    }
}
