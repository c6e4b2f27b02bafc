/* Converts the geometry of a feature from OGR to polylines in world coordinates.
 *
 * Input: any OGR geometry, and the coordinate system of its layer. Output: world lines (features/world_lines.h). Points
 * that are not numbers split their line.
 */
#include "gdal/vector_file.h"

#include <cpl_conv.h>
#include <math.h>
#include <string.h>

/* No real collection is nested this deeply. A file that exceeds it tries to exhaust the stack. */
enum { MAX_DEPTH = 64 };

/* ---- Projection of a layer ---- */

/* Whether the first ordinate in data with this geographic system is the longitude. *known is false if the axes do not
 * say. */
static bool longitude_first(OGRSpatialReferenceH srs, bool *known) {
    int count = 0;
    const int *mapping = OSRGetDataAxisToSRSAxisMapping(srs, &count);
    OGRAxisOrientation orientation = OAO_Other;
    *known = mapping && count >= 2 && (mapping[0] == 1 || mapping[0] == 2) &&
             OSRGetAxis(srs, NULL, mapping[0] - 1, &orientation) &&
             (orientation == OAO_East || orientation == OAO_North);
    return orientation == OAO_East;
}

static bool is_code(OGRSpatialReferenceH srs, const char *code) {
    const char *authority = OSRGetAuthorityName(srs, NULL), *own = OSRGetAuthorityCode(srs, NULL);
    return authority && own && strcmp(authority, "EPSG") == 0 && strcmp(own, code) == 0;
}

/* Whether this is WGS 84 under any of its names, including CRS84. */
static bool is_wgs84(OGRSpatialReferenceH srs) {
    if (!OSRIsGeographic(srs))
        return false;
    const char *authority = OSRGetAuthorityName(srs, NULL), *code = OSRGetAuthorityCode(srs, NULL);
    if (authority && code)
        return is_code(srs, "4326") || is_code(srs, "4979") ||
               (strcmp(authority, "OGC") == 0 && strcmp(code, "CRS84") == 0);
    OGRSpatialReferenceH wgs84 = OSRNewSpatialReference(NULL);
    OSRImportFromEPSG(wgs84, 4326);
    const char *const options[] = {"IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES", "CRITERION=EQUIVALENT", NULL};
    const bool same = OSRIsSameEx(srs, wgs84, options) != 0;
    OSRDestroySpatialReference(wgs84);
    return same;
}

static bool names_path(OGRSpatialReferenceH srs) {
    static const char *const options[] = {"FORMAT=WKT1_GDAL", NULL};
    char *text = NULL;
    (void)OSRExportToWktEx(srs, &text, options);
    const bool found = text && camber_gdal_names_path(text);
    CPLFree(text);
    return found;
}

static camber_status transform_to_degrees(camber_feature_lines *lines, OGRSpatialReferenceH srs, const char *name) {
    OGRSpatialReferenceH degrees = OSRNewSpatialReference(NULL);
    OSRImportFromEPSG(degrees, 4326);
    OSRSetAxisMappingStrategy(degrees, OAMS_TRADITIONAL_GIS_ORDER);
    lines->transform = OCTNewCoordinateTransformation(srs, degrees);
    OSRDestroySpatialReference(degrees);
    if (!lines->transform)
        return camber_fail(lines->context, CAMBER_ERROR_INPUT,
                           "%s: its coordinate system \"%s\" cannot be converted to longitude and latitude; convert "
                           "the file to EPSG:4326",
                           name, OSRGetName(srs) ? OSRGetName(srs) : "unnamed");
    lines->projection = CAMBER_PROJECTION_TRANSFORM;
    return CAMBER_OK;
}

camber_status camber_feature_lines_set_srs(camber_feature_lines *lines, OGRSpatialReferenceH srs, const char *name) {
    OCTDestroyCoordinateTransformation(lines->transform);
    lines->transform = NULL;
    lines->projection = CAMBER_PROJECTION_DEGREES;
    lines->latitude_first = false;
    if (!srs)
        return CAMBER_OK;
    if (names_path(srs))
        return camber_dataset_fail_elsewhere(lines->context, name);
    int count = 0;
    const int *mapping = OSRGetDataAxisToSRSAxisMapping(srs, &count);
    if (OSRIsProjected(srs) && is_code(srs, "3857") && mapping && count >= 2 && mapping[0] == 1 && mapping[1] == 2) {
        lines->projection = CAMBER_PROJECTION_METRES;
        return CAMBER_OK;
    }
    if (is_wgs84(srs)) {
        bool known;
        lines->latitude_first = !longitude_first(srs, &known);
        if (known)
            return CAMBER_OK;
        lines->latitude_first = false;
    }
    return transform_to_degrees(lines, srs, name);
}

void camber_feature_lines_free(camber_feature_lines *lines) {
    OCTDestroyCoordinateTransformation(lines->transform);
    camber_free(lines->context, lines->raw);
    camber_world_lines_free(&lines->world);
    lines->transform = NULL;
    lines->raw = NULL;
}

/* ---- One line ---- */

/* Adds a point, given by its ordinates in the file. Returns false if one is not a number. */
static bool add_point(camber_feature_lines *lines, double east, double north) {
    if (!isfinite(east) || !isfinite(north))
        return false;
    if (lines->projection == CAMBER_PROJECTION_METRES) {
        camber_world_lines_add_metres(&lines->world, east, north);
        return true;
    }
    const double latitude = lines->latitude_first ? east : north, longitude = lines->latitude_first ? north : east;
    if (fabs(latitude) > 90 || fabs(longitude) > 360)
        lines->strange_points++;
    camber_world_lines_add_degrees(&lines->world, longitude, latitude);
    return true;
}

/* Reads the line's ordinates into `raw`: count x values, then count y values. */
static bool fetch(camber_feature_lines *lines, OGRGeometryH geometry, size_t count) {
    if (!camber_world_lines_reserve(&lines->world, count) ||
        !camber_grow(lines->context, &lines->raw, &lines->raw_capacity, 2 * count, sizeof *lines->raw))
        return false;
    double *x = lines->raw, *y = lines->raw + count;
    OGR_G_GetPoints(geometry, x, sizeof *x, y, sizeof *y, NULL, 0);
    /* PROJ returns infinity for a point that it cannot project. */
    if (lines->projection == CAMBER_PROJECTION_TRANSFORM)
        OCTTransform(lines->transform, (int)count, x, y, NULL);
    return true;
}

/* Whether the closed line that was read goes clockwise on the map. In its coordinates, y grows to the north. */
static bool goes_clockwise(const camber_feature_lines *lines, size_t count) {
    const double *x = lines->raw, *y = lines->raw + count;
    double area = 0.0;
    for (size_t i = 0; i + 1 < count; i++) {
        const double part = (x[i] - x[0]) * (y[i + 1] - y[0]) - (x[i + 1] - x[0]) * (y[i] - y[0]);
        area += isfinite(part) ? part : 0.0;
    }
    return (area < 0.0) != lines->latitude_first;
}

static void turn_back(double *numbers, size_t count) {
    for (size_t i = 0; i < count / 2; i++) {
        const double number = numbers[i];
        numbers[i] = numbers[count - 1 - i];
        numbers[count - 1 - i] = number;
    }
}

/* is_ring: the line ends where it begins, even if the file omits the last point. clockwise: the direction that a ring
 * must have on the map; negative: the line keeps its direction. */
static camber_status add_line(camber_feature_lines *lines, OGRGeometryH geometry, bool is_ring, int clockwise) {
    const int points = OGR_G_GetPointCount(geometry);
    if (points <= 0) {
        lines->left_out = true;
        return CAMBER_OK;
    }
    const size_t count = (size_t)points;
    if (!fetch(lines, geometry, count))
        return CAMBER_ERROR_MEMORY;
    if (clockwise >= 0 && goes_clockwise(lines, count) != (clockwise > 0)) {
        turn_back(lines->raw, count);
        turn_back(lines->raw + count, count);
    }
    lines->raw_points += count;
    for (size_t i = 0; i < count; i++) {
        if (!add_point(lines, lines->raw[i], lines->raw[count + i])) {
            lines->invalid_points++;
            camber_world_lines_end(&lines->world);
        }
    }
    if (is_ring && lines->world.open &&
        (lines->raw[0] != lines->raw[count - 1] || lines->raw[count] != lines->raw[2 * count - 1]))
        (void)add_point(lines, lines->raw[0], lines->raw[count]);
    camber_world_lines_end(&lines->world);
    return CAMBER_OK;
}

static camber_status add_ring(camber_feature_lines *lines, OGRGeometryH geometry, bool hole) {
    camber_world_lines *world = &lines->world;
    const int points = OGR_G_GetPointCount(geometry);
    if (points <= 0) {
        lines->left_out = true;
        return CAMBER_OK;
    }
    const size_t fetched = (size_t)points, first = world->point_count;
    if (!fetch(lines, geometry, fetched))
        return CAMBER_ERROR_MEMORY;
    lines->raw_points += fetched;
    for (size_t i = 0; i < fetched; i++)
        lines->invalid_points += !add_point(lines, lines->raw[i], lines->raw[fetched + i]);
    double *ring = world->points + 2 * first;
    size_t count = world->point_count - first;
    bool crosses = false;
    if (!world->whole)
        count = camber_ring_unroll(ring, count, &crosses);
    world->antimeridian_splits += crosses;
    count = camber_rings_take(&lines->rings, ring, count, hole);
    world->point_count = first + count;
    world->open = count > 0;
    camber_world_lines_end(world);
    return CAMBER_OK;
}

/* ---- Any geometry ---- */

static camber_status collect(camber_feature_lines *lines, OGRGeometryH geometry, camber_geometry_kind kind, int depth);

static camber_status collect_members(camber_feature_lines *lines, OGRGeometryH geometry, camber_geometry_kind kind,
                                     int depth) {
    const int count = OGR_G_GetGeometryCount(geometry);
    for (int i = 0; i < count; i++) {
        const camber_status status = collect(lines, OGR_G_GetGeometryRef(geometry, i), kind, depth + 1);
        if (status != CAMBER_OK)
            return status;
    }
    lines->left_out |= count == 0;
    return CAMBER_OK;
}

static camber_status collect_rings(camber_feature_lines *lines, OGRGeometryH polygon, camber_geometry_kind kind) {
    const int count = OGR_G_GetGeometryCount(polygon);
    for (int i = 0; i < count; i++) {
        OGRGeometryH ring = OGR_G_GetGeometryRef(polygon, i);
        const camber_status status = kind == CAMBER_GEOMETRY_AREA
                                         ? add_ring(lines, ring, i > 0)
                                         : add_line(lines, ring, true, lines->directed ? i == 0 : -1);
        if (status != CAMBER_OK)
            return status;
    }
    lines->left_out |= count == 0;
    return CAMBER_OK;
}

/* Splits arcs into chords of 4 degrees each, which is OGR's default. */
static camber_status collect_curve(camber_feature_lines *lines, OGRGeometryH geometry, camber_geometry_kind kind,
                                   int depth) {
    OGRGeometryH linear = OGR_G_GetLinearGeometry(geometry, 0, NULL);
    camber_status status = CAMBER_OK;
    if (!linear || OGR_GT_IsNonLinear(OGR_G_GetGeometryType(linear)))
        lines->damaged = true;
    else
        status = collect(lines, linear, kind, depth + 1);
    OGR_G_DestroyGeometry(linear);
    return status;
}

static camber_status collect(camber_feature_lines *lines, OGRGeometryH geometry, camber_geometry_kind kind, int depth) {
    if (!geometry || depth > MAX_DEPTH) {
        lines->damaged = true;
        return CAMBER_OK;
    }
    const OGRwkbGeometryType type = wkbFlatten(OGR_G_GetGeometryType(geometry));
    if (OGR_GT_IsNonLinear(type))
        return collect_curve(lines, geometry, kind, depth);
    switch (type) {
    case wkbLineString: return kind == CAMBER_GEOMETRY_LINE ? add_line(lines, geometry, false, -1) : CAMBER_OK;
    case wkbPolygon:
    case wkbTriangle:
        if (kind == CAMBER_GEOMETRY_POLYGON || kind == CAMBER_GEOMETRY_AREA)
            return collect_rings(lines, geometry, kind);
        lines->left_out |= !(lines->kinds & (CAMBER_KIND_POLYGON | CAMBER_KINDS_OF_AREAS));
        return CAMBER_OK;
    case wkbPoint:
        if (kind == CAMBER_GEOMETRY_POINT)
            return add_line(lines, geometry, false, -1);
        lines->left_out |= !(lines->kinds & CAMBER_KINDS_OF_POINTS);
        return CAMBER_OK;
    case wkbMultiPoint:
    case wkbMultiLineString:
    case wkbMultiPolygon:
    case wkbPolyhedralSurface:
    case wkbTIN:
    case wkbGeometryCollection: return collect_members(lines, geometry, kind, depth);
    default: lines->left_out = true; return CAMBER_OK;
    }
}

camber_status camber_feature_lines_collect(camber_feature_lines *lines, OGRGeometryH geometry,
                                           camber_geometry_kind kind) {
    camber_world_lines_begin(&lines->world);
    lines->world.uncut = kind == CAMBER_GEOMETRY_AREA;
    return collect(lines, geometry, kind, 0);
}

camber_status camber_feature_lines_collect_ring(camber_feature_lines *lines, OGRGeometryH line) {
    camber_world_lines_begin(&lines->world);
    lines->world.uncut = true;
    return add_ring(lines, line, false);
}
