/* The scenes: roads of real cities and random walks that turn like roads, as polylines in pixels of one square. */
#include "bench.h"

#include "base/base.h"
#include "validate/scenes.h"
#include "validate/statistics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Random walks ---- */

/* In the context's memory, as those of cities are. */
static bool make_walks(camber_context *context, size_t polyline_count, double step_px, camber_lines *lines) {
    camber_made_scene scene;
    bool done = camber_road_walks_make(polyline_count, BENCH_SIDE_PX, step_px, &scene);
    if (done) {
        camber_lines made = {
            .context = context, .point_count = scene.point_count, .polyline_count = scene.polyline_count};
        made.offsets = camber_alloc(context, made.polyline_count + 1, sizeof *made.offsets);
        made.points = camber_alloc(context, made.point_count, 2 * sizeof *made.points);
        done = made.offsets && made.points;
        if (done) {
            memcpy(made.offsets, scene.offsets, (made.polyline_count + 1) * sizeof *made.offsets);
            memcpy(made.points, scene.points, made.point_count * 2 * sizeof *made.points);
            *lines = made;
        } else {
            camber_lines_destroy(&made);
        }
    }
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

static bool add_geometry(city *c, OGRGeometryH geometry) {
    if (!geometry)
        return true;
    const OGRwkbGeometryType type = wkbFlatten(OGR_G_GetGeometryType(geometry));
    bool done = true;
    if (type == wkbLineString)
        done = add_line(c, geometry);
    for (int i = 0; type == wkbMultiLineString && done && i < OGR_G_GetGeometryCount(geometry); i++)
        done = add_line(c, OGR_G_GetGeometryRef(geometry, i));
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
        OGRLayerH layer = GDALDatasetGetLayerByName(file, "lines");
        OGR_L_SetAttributeFilter(layer, "highway IS NOT NULL");
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

#else

static bool make_city(camber_context *context, const char *path, camber_lines *lines) {
    (void)context;
    (void)path;
    (void)lines;
    return false;
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
