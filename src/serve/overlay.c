/* Makes a style document from a query and from GeoJSON, with the data in its sources, and reads the sources.
 *
 *     query, body -> paths, marks, texts (points in degrees) -> the view -> style document -> features
 *
 * A pin is an area whose size is known only in pixels, so that marks become areas of the map once the view is known. */
#include "serve/overlay.h"

#include <jansson.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    MOST_PATHS = 100,
    MOST_MARKS = 1000,
    MOST_POINTS = 100000,
    MOST_FEATURES = 10000,
    DEEPEST = 8,
    MOST_WORDS = 500
};
enum { WORLD_PX = 512, POINT_ZOOM = 16, ARC_POINTS = 32, MOST_ZOOM = CAMBER_ROUTE_MOST_ZOOM };

static const double PI = 3.14159265358979323846, MOST_LATITUDE = 85.051129, FARTHEST_DEG = 540.0;
static const double PIN_HEIGHT_PX = 21, PIN_RADIUS_PX = 9.5, EDGE_PX = 1.25, EYE_PX = 3.6, DOT_RADIUS_PX = 6;
static const double MOST_WIDTH_PX = 500, MOST_SCALE = 20, MOST_OFFSET_PX = 1000, MOST_TEXT_PX = 200;

struct camber_overlay {
    camber_overlay_icons *icons; /* NULL: it has none of them */
    camber_context *context;
    camber_style *style;
    camber_features *features;
};

/* A part of a parameter, between two bars. */
typedef struct piece {
    const char *at;
    size_t length;
} piece;

/* The look of a path. A colour without text is not drawn. */
typedef struct path_look {
    piece fill, stroke, border;
    double width_px, border_px; /* border_px NAN: a tenth of the width */
} path_look;

/* A marker. icon: the name of an operator's own; without text it is a pin or a dot. */
typedef struct mark {
    double longitude, latitude, scale, x_px, y_px;
    bool is_dot, has_label;
    piece color, icon;
} mark;

typedef struct maker {
    camber_route_request *request;
    camber_overlay_icons *icons;
    char *reason; /* of the first failure */
    bool failed, is_latlng, has_icons;
    camber_context *context;
    path_look look; /* of paths that do not say otherwise */
    const char *cap, *join;
    double padding, most_zoom; /* most_zoom NAN: not given */
    json_t *sources, *layers, *texts;
    mark *marks; /* MOST_MARKS of them */
    size_t mark_count, path_count, point_count, feature_count, text_count;
    double box[4]; /* x0, y0, x1, y1 in world coordinates; x0 > x1: empty */
    piece last_color;
    const char *what; /* the parameter that is being read, and its number */
    size_t number;
} maker;

/* Notes why the request is refused. Always returns false. */
static bool refuse(maker *m, const char *format, ...) {
    char text[CAMBER_OVERLAY_REASON_SIZE - 64];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    if (!m->failed && m->number)
        snprintf(m->reason, CAMBER_OVERLAY_REASON_SIZE, "%s %zu: %s", m->what, m->number, text);
    else if (!m->failed)
        snprintf(m->reason, CAMBER_OVERLAY_REASON_SIZE, "%s: %s", m->what, text);
    m->failed = true;
    return false;
}

/* ---- Parsing values ---- */

static bool is_word(piece p, const char *word) {
    return p.length == strlen(word) && memcmp(p.at, word, p.length) == 0;
}

/* Takes the next piece of a list. Returns false if none is left. */
static bool next_piece(const char **rest, char separator, piece *p) {
    if (!*rest)
        return false;
    const char *end = strchr(*rest, separator);
    *p = (piece){*rest, end ? (size_t)(end - *rest) : strlen(*rest)};
    *rest = end ? end + 1 : NULL;
    return true;
}

/* Reads a decimal number, which is the whole piece. */
static bool read_number(piece p, double least, double most, double *number) {
    char copy[40], *end;
    if (p.length < 1 || p.length >= sizeof copy)
        return false;
    memcpy(copy, p.at, p.length);
    copy[p.length] = 0;
    if (strspn(copy, "0123456789.-+eE") != p.length)
        return false;
    const double made = strtod(copy, &end);
    if (end != copy + p.length || !(made >= least && made <= most))
        return false;
    *number = made;
    return true;
}

static bool read_pair(piece p, double most_first, double most_second, double pair[2]) {
    const char *comma = memchr(p.at, ',', p.length);
    if (!comma)
        return false;
    const piece first = {p.at, (size_t)(comma - p.at)}, second = {comma + 1, p.length - first.length - 1};
    return read_number(first, -most_first, most_first, pair) &&
           read_number(second, -most_second, most_second, pair + 1);
}

/* The first number is the latitude if the request says so. Metres become degrees. */
static bool read_position(const maker *m, piece p, double position[2]) {
    double pair[2];
    const bool is_raw = m->request->is_raw;
    const double most[] = {is_raw ? 3.0 * CAMBER_ROUTE_MOST_METRES : FARTHEST_DEG,
                           is_raw ? CAMBER_ROUTE_MOST_METRES : 90.0};
    if (!read_pair(p, most[m->is_latlng], most[!m->is_latlng], pair))
        return false;
    for (int axis = 0; axis < 2; axis++) {
        position[axis] = pair[axis ^ m->is_latlng];
        if (is_raw)
            position[axis] = camber_route_find_degrees(axis, position[axis]);
    }
    return true;
}

static const char *name_position(const maker *m) {
    if (m->request->is_raw)
        return m->is_latlng ? "Y,X in metres of Web Mercator" : "X,Y in metres of Web Mercator";
    return m->is_latlng ? "LAT,LON in degrees" : "LON,LAT in degrees";
}

/* Parses a style whose background has this colour, as the map's own colours are parsed. */
static bool is_color(maker *m, piece p) {
    camber_style *style = NULL;
    if (p.length == m->last_color.length && p.length && memcmp(p.at, m->last_color.at, p.length) == 0)
        return true;
    json_t *color = json_stringn(p.at, p.length);
    json_t *document = color ? json_pack("{s:i, s:{}, s:[{s:s, s:s, s:{s:o}}]}", "version", 8, "sources", "layers",
                                         "id", "b", "type", "background", "paint", "background-color", color)
                             : NULL;
    char *text = document ? json_dumps(document, JSON_COMPACT) : NULL;
    const bool fits = text && camber_style_parse(m->context, text, strlen(text), "a colour", &style) == CAMBER_OK;
    camber_style_destroy(style);
    json_decref(document);
    free(text);
    if (fits)
        m->last_color = p;
    return fits;
}

/* Reads a colour. "none" is one that is not drawn. */
static bool read_color(maker *m, const char *name, piece p, piece *color) {
    *color = is_word(p, "none") ? (piece){0} : p;
    return !color->at || is_color(m, p) ||
           refuse(m, "%s is not a CSS colour, such as red, %%23d33 or rgba(0,64,255,0.7)", name);
}

static bool read_width(maker *m, const char *name, piece p, double *width_px) {
    return read_number(p, 0, MOST_WIDTH_PX, width_px) ||
           refuse(m, "%s is not a number of px from 0 to %.0f", name, MOST_WIDTH_PX);
}

/* Splits NAME:VALUE. */
static bool split_option(piece p, piece *name, piece *value) {
    const char *colon = memchr(p.at, ':', p.length);
    if (!colon)
        return false;
    *name = (piece){p.at, (size_t)(colon - p.at)};
    *value = (piece){colon + 1, p.length - name->length - 1};
    return true;
}

/* ---- The box of everything ---- */

static double project_y(double latitude) {
    const double limited = fmax(-MOST_LATITUDE, fmin(MOST_LATITUDE, latitude));
    return 0.5 - asinh(tan(limited * PI / 180.0)) / (2.0 * PI);
}

static double find_latitude(double y) {
    return atan(sinh(PI * (1.0 - 2.0 * y))) * 180.0 / PI;
}

static void extend(maker *m, const double position[2]) {
    const double x = position[0] / 360.0 + 0.5, y = project_y(position[1]);
    m->box[0] = fmin(m->box[0], x);
    m->box[1] = fmin(m->box[1], y);
    m->box[2] = fmax(m->box[2], x);
    m->box[3] = fmax(m->box[3], y);
}

/* Adds a point to an array of positions. */
static bool add_point(maker *m, json_t *points, const double position[2]) {
    if (++m->point_count > MOST_POINTS)
        return refuse(m, "the picture has more than %d points", MOST_POINTS);
    extend(m, position);
    return json_array_append_new(points, json_pack("[f, f]", position[0], position[1])) == 0 || refuse(m, "no memory");
}

/* ---- Layers ---- */

/* Adds a source with one geometry or collection, which it takes. */
static bool add_source(maker *m, const char *name, json_t *data) {
    return json_object_set_new(m->sources, name, json_pack("{s:s, s:o}", "type", "geojson", "data", data)) == 0;
}

static bool add_layer(maker *m, const char *type, const char *source, json_t *layout, json_t *paint) {
    char id[32];
    snprintf(id, sizeof id, "%zu", json_array_size(m->layers));
    return json_array_append_new(m->layers, json_pack("{s:s, s:s, s:s, s:o, s:o}", "id", id, "type", type, "source",
                                                      source, "layout", layout, "paint", paint)) == 0;
}

static json_t *make_geometry(const char *type, json_t *coordinates) {
    return json_pack("{s:s, s:{}, s:{s:s, s:o}}", "type", "Feature", "properties", "geometry", "type", type,
                     "coordinates", coordinates);
}

static bool add_stroke(maker *m, const char *source, piece color, double width_px) {
    if (!color.at || !(width_px > 0.0))
        return true;
    return add_layer(m, "line", source, json_pack("{s:s, s:s}", "line-cap", m->cap, "line-join", m->join),
                     json_pack("{s:s%, s:f}", "line-color", color.at, color.length, "line-width", width_px));
}

/* ---- Paths ---- */

/* Reads points in Google's format: differences of latitude, then longitude, in 1e-5 degrees. */
static bool read_polyline(maker *m, const char *text, json_t *points) {
    double sums[2] = {0};
    for (int axis = 0; *text; axis = !axis) {
        uint32_t value = 0;
        int shift = 0, digit;
        do {
            digit = (unsigned char)*text++ - 63;
            if (digit < 0 || digit > 63 || shift > 25)
                return refuse(m, "the text after enc: is not an encoded polyline; escape it as a URL's component");
            value |= (uint32_t)(digit & 31) << shift;
            shift += 5;
        } while (digit & 32);
        sums[axis] += (value & 1 ? -1.0 : 1.0) * ((value >> 1) + (value & 1));
        const double position[] = {1e-5 * sums[1], 1e-5 * sums[0]};
        if (axis && (fabs(position[0]) > FARTHEST_DEG || fabs(position[1]) > 90.0))
            return refuse(m, "its encoded polyline leaves the earth; it has five decimals, latitudes first");
        if (axis && !add_point(m, points, position))
            return false;
        if (!axis && !*text)
            return refuse(m, "its encoded polyline ends with half a point");
    }
    return true;
}

static bool read_path_option(maker *m, piece name, piece value, path_look *look) {
    if (is_word(name, "fill"))
        return read_color(m, "fill", value, &look->fill);
    if (is_word(name, "stroke"))
        return read_color(m, "stroke", value, &look->stroke);
    if (is_word(name, "border"))
        return read_color(m, "border", value, &look->border);
    if (is_word(name, "width"))
        return read_width(m, "width", value, &look->width_px);
    if (is_word(name, "borderwidth"))
        return read_width(m, "borderwidth", value, &look->border_px);
    return refuse(m, "its options are fill, stroke, width, border and borderwidth");
}

static bool read_path_parts(maker *m, const char *value, path_look *look, json_t *points) {
    const char *rest = value;
    piece p, name, content;
    for (size_t i = 0; next_piece(&rest, '|', &p);) {
        if (p.length >= 4 && memcmp(p.at, "enc:", 4) == 0)
            return read_polyline(m, p.at + 4, points);
        if (split_option(p, &name, &content)) {
            if (!read_path_option(m, name, content, look))
                return false;
            continue;
        }
        double position[2];
        i++;
        if (!read_position(m, p, position))
            return refuse(m, "point %zu is not %s", i, name_position(m));
        if (!add_point(m, points, position))
            return false;
    }
    return true;
}

/* Adds the layers of a path: fill, border and stroke. */
static bool add_path_layers(maker *m, const path_look *look, json_t *points) {
    const size_t count = json_array_size(points), index = m->path_count;
    const bool closed = count > 3 && json_equal(json_array_get(points, 0), json_array_get(points, count - 1));
    const double border_px = isnan(look->border_px) ? 0.1 * look->width_px : look->border_px;
    char line[32], area[32];
    snprintf(line, sizeof line, "line%zu", index);
    snprintf(area, sizeof area, "area%zu", index);
    json_t *ring = json_copy(points);
    bool made = ring != NULL;
    if (made && !closed)
        made = json_array_append(ring, json_array_get(points, 0)) == 0;
    made = made && add_source(m, area, make_geometry("Polygon", json_pack("[O]", ring)));
    if (made && look->fill.at && count > 2)
        made = add_layer(m, "fill", area, json_object(),
                         json_pack("{s:s%}", "fill-color", look->fill.at, look->fill.length));
    json_decref(ring);
    made = made && (closed || add_source(m, line, make_geometry("LineString", json_incref(points))));
    const char *source = closed ? area : line;
    return (made && add_stroke(m, source, look->border, look->width_px + 2.0 * border_px) &&
            add_stroke(m, source, look->stroke, look->width_px)) ||
           refuse(m, "no memory");
}

static bool read_path(maker *m, const char *value) {
    path_look look = m->look;
    json_t *points = json_array();
    bool made = points && read_path_parts(m, value, &look, points);
    if (made && json_array_size(points) < 2)
        made = refuse(m, "a path has two or more points");
    if (made && ++m->path_count > MOST_PATHS)
        made = refuse(m, "a picture has at most %d paths; give more as GeoJSON, by POST", MOST_PATHS);
    made = made && add_path_layers(m, &look, points);
    json_decref(points);
    return made;
}

/* ---- Markers and texts ---- */

/* The look of a text, whose position is known when it is drawn. */
typedef struct text_look {
    piece words, color, halo, anchor;
    double size_px, halo_px, offset_px[2];
    bool is_bold;
} text_look;

static const text_look TEXT_LOOK = {.color = {"#222222", 7}, .halo = {"#ffffff", 7}, .size_px = 16, .halo_px = 1.5};

/* Adds a text's layer. Its source is named by its number. */
static bool add_text(maker *m, const double position[2], const text_look *look) {
    char name[32];
    if (++m->text_count > MOST_MARKS)
        return refuse(m, "a picture has at most %d texts and icons", MOST_MARKS);
    if (!look->words.length || !look->color.at)
        return true;
    if (look->words.length > MOST_WORDS)
        return refuse(m, "a text has at most %d bytes", MOST_WORDS);
    snprintf(name, sizeof name, "text%zu", m->text_count);
    json_t *words = json_stringn(look->words.at, look->words.length);
    if (!words)
        return refuse(m, "its text is not UTF-8");
    /* As a literal, braces in it are not names of properties. */
    json_t *layout = json_pack("{s:[s, o], s:[s], s:f, s:b, s:b, s:[f, f], s:s%, s:i}", "text-field", "to-string",
                               words, "text-font", look->is_bold ? "Noto Sans Bold" : "Noto Sans Regular", "text-size",
                               look->size_px, "text-allow-overlap", 1, "text-ignore-placement", 1, "text-offset",
                               look->offset_px[0] / look->size_px, look->offset_px[1] / look->size_px, "text-anchor",
                               look->anchor.at ? look->anchor.at : "center", look->anchor.at ? look->anchor.length : 6,
                               "text-max-width", 100);
    json_t *paint = json_pack("{s:s%, s:s%, s:f}", "text-color", look->color.at, look->color.length, "text-halo-color",
                              look->halo.at ? look->halo.at : "transparent", look->halo.at ? look->halo.length : 11,
                              "text-halo-width", look->halo.at ? look->halo_px : 0.0);
    json_t *layer = json_pack("{s:s, s:s, s:s, s:o, s:o}", "id", name, "type", "symbol", "source", name, "layout",
                              layout, "paint", paint);
    return (add_source(m, name, make_geometry("Point", json_pack("[f, f]", position[0], position[1]))) &&
            json_array_append_new(m->texts, layer) == 0) ||
           refuse(m, "no memory");
}

static bool is_anchor(piece p) {
    static const char *const names[] = {"center",   "left",      "right",       "top",         "bottom",
                                        "top-left", "top-right", "bottom-left", "bottom-right"};
    bool found = false;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        found = found || is_word(p, names[i]);
    return found;
}

static bool read_text_option(maker *m, piece name, piece value, text_look *look) {
    if (is_word(name, "color"))
        return read_color(m, "color", value, &look->color);
    if (is_word(name, "halo"))
        return read_color(m, "halo", value, &look->halo);
    if (is_word(name, "halowidth"))
        return read_number(value, 0, 20, &look->halo_px) || refuse(m, "halowidth is not a number of px from 0 to 20");
    if (is_word(name, "size"))
        return read_number(value, 4, MOST_TEXT_PX, &look->size_px) ||
               refuse(m, "size is not a number of px from 4 to %.0f", MOST_TEXT_PX);
    if (is_word(name, "offset"))
        return read_pair(value, MOST_OFFSET_PX, MOST_OFFSET_PX, look->offset_px) ||
               refuse(m, "offset is not X,Y in px");
    if (is_word(name, "anchor")) {
        look->anchor = value;
        return is_anchor(value) || refuse(m, "anchor is not center, left, right, top, bottom, top-left, ...");
    }
    return refuse(m, "its options are size, color, halo, halowidth, anchor and offset");
}

static bool read_text(maker *m, const char *value) {
    text_look look = TEXT_LOOK;
    const char *rest = value;
    double position[2];
    piece p, name, content;
    if (!next_piece(&rest, '|', &p) || !read_position(m, p, position))
        return refuse(m, "it does not begin with %s", name_position(m));
    if (!next_piece(&rest, '|', &look.words) || !look.words.length)
        return refuse(m, "no words follow its position; give a bar and the words");
    while (next_piece(&rest, '|', &p))
        if (!split_option(p, &name, &content) ? !refuse(m, "its options have the form NAME:VALUE")
                                              : !read_text_option(m, name, content, &look))
            return false;
    extend(m, position);
    return add_text(m, position, &look);
}

static bool add_mark(maker *m, const mark *made) {
    const double position[] = {made->longitude, made->latitude};
    if (m->mark_count == MOST_MARKS)
        return refuse(m, "a picture has at most %d markers", MOST_MARKS);
    m->marks[m->mark_count++] = *made;
    extend(m, position);
    return true;
}

/* Adds a marker of an operator's icon, whose foot is its point. Its name is one of those that the operator gave. */
static bool add_icon(maker *m, const mark *made) {
    char name[32];
    const double position[] = {made->longitude, made->latitude};
    if (++m->text_count > MOST_MARKS)
        return refuse(m, "a picture has at most %d texts and icons", MOST_MARKS);
    snprintf(name, sizeof name, "text%zu", m->text_count);
    m->has_icons = true;
    extend(m, position);
    json_t *layout = json_pack("{s:[s, s%], s:f, s:s, s:[f, f], s:b, s:b}", "icon-image", "image", made->icon.at,
                               made->icon.length, "icon-size", made->scale, "icon-anchor", "bottom", "icon-offset",
                               made->x_px, made->y_px, "icon-allow-overlap", 1, "icon-ignore-placement", 1);
    json_t *layer = json_pack("{s:s, s:s, s:s, s:o}", "id", name, "type", "symbol", "source", name, "layout", layout);
    return (add_source(m, name, make_geometry("Point", json_pack("[f, f]", position[0], position[1]))) &&
            json_array_append_new(m->texts, layer) == 0) ||
           refuse(m, "no memory");
}

/* Reads a marker's icon: one that is built in, or an operator's own. */
static bool read_icon(maker *m, piece p, mark *made) {
    char name[64];
    made->is_dot = is_word(p, "dot");
    if (made->is_dot || is_word(p, "pin"))
        return true;
    if (!m->icons)
        return refuse(m, "its icon is not one of those that are built in: pin and dot");
    made->icon = p;
    snprintf(name, sizeof name, "%.*s", (int)(p.length < sizeof name ? p.length : 0), p.at);
    return camber_overlay_icons_has(m->icons, name) ||
           refuse(m, "its icon is neither pin nor dot, nor in the server's sprite");
}

static const mark MARK = {.scale = 1, .color = {"#d8382f", 7}};

/* A label is a text whose anchor is the marker's head. */
static bool add_label(maker *m, const mark *made, piece words) {
    text_look look = TEXT_LOOK;
    look.words = words;
    look.is_bold = true;
    look.color = (piece){"#ffffff", 7};
    look.halo = (piece){0};
    look.size_px = (words.length > 1 ? 9.5 : 12) * made->scale;
    look.offset_px[0] = made->x_px * made->scale;
    look.offset_px[1] = (made->y_px - (made->is_dot ? 0.0 : PIN_HEIGHT_PX)) * made->scale;
    return add_text(m, (const double[]){made->longitude, made->latitude}, &look);
}

static bool read_marker_option(maker *m, piece name, piece value, mark *made, piece *label) {
    double pair[2];
    if (is_word(name, "scale"))
        return read_number(value, 0.1, MOST_SCALE, &made->scale) ||
               refuse(m, "scale is not a number from 0.1 to %.0f", MOST_SCALE);
    if (is_word(name, "color"))
        return read_color(m, "color", value, &made->color);
    if (is_word(name, "offset")) {
        if (!read_pair(value, MOST_OFFSET_PX, MOST_OFFSET_PX, pair))
            return refuse(m, "offset is not X,Y in px");
        made->x_px = pair[0];
        made->y_px = pair[1];
        return true;
    }
    *label = value;
    return is_word(name, "label") || refuse(m, "its options are scale, offset, color and label");
}

static bool read_marker(maker *m, const char *value) {
    mark made = MARK;
    piece p, name, content, label = {0};
    double position[2];
    const char *rest = value;
    if (!next_piece(&rest, '|', &p) || !read_position(m, p, position))
        return refuse(m, "it does not begin with %s", name_position(m));
    made.longitude = position[0];
    made.latitude = position[1];
    for (bool first = true; next_piece(&rest, '|', &p); first = false) {
        if (split_option(p, &name, &content)) {
            if (!read_marker_option(m, name, content, &made, &label))
                return false;
            continue;
        }
        if (!first)
            return refuse(m,
                          "its icon comes first, right after its position; then come scale, offset, color and label");
        if (!read_icon(m, p, &made))
            return false;
    }
    if (made.icon.length && label.length)
        return refuse(m, "only a pin or a dot has a label");
    if (made.icon.length)
        return add_icon(m, &made);
    made.has_label = label.length > 0;
    return add_mark(m, &made) && (!label.length || add_label(m, &made, label));
}

/* ---- GeoJSON ---- */

static piece text_of(const json_t *value) {
    return json_is_string(value) ? (piece){json_string_value(value), json_string_length(value)} : (piece){0};
}

static bool add_position(maker *m, const json_t *json, double position[2]) {
    const json_t *x = json_array_get(json, 0), *y = json_array_get(json, 1);
    if (!json_is_number(x) || !json_is_number(y))
        return refuse(m, "a position is not two numbers");
    position[0] = json_number_value(x);
    position[1] = json_number_value(y);
    if (!(fabs(position[0]) <= FARTHEST_DEG && fabs(position[1]) <= 90.0))
        return refuse(m, "a position is not on the earth; GeoJSON has longitudes first, in degrees");
    if (++m->point_count > MOST_POINTS)
        return refuse(m, "the picture has more than %d points", MOST_POINTS);
    extend(m, position);
    return true;
}

/* Whether a property, if it is there, is a colour. */
static bool check_color(maker *m, const json_t *properties, const char *name) {
    const json_t *value = json_object_get(properties, name);
    return !value || json_is_null(value) || (json_is_string(value) && is_color(m, text_of(value))) ||
           refuse(m, "%s is not a CSS colour", name);
}

static bool add_geojson_point(maker *m, const json_t *json, const json_t *properties) {
    double position[2] = {0};
    mark made = MARK;
    text_look look = TEXT_LOOK;
    if (!add_position(m, json, position))
        return false;
    made.longitude = position[0];
    made.latitude = position[1];
    look.words = text_of(json_object_get(properties, "text"));
    if (look.words.length) {
        const json_t *size = json_object_get(properties, "text-size");
        const piece color = text_of(json_object_get(properties, "text-color"));
        look.color = color.at ? color : look.color;
        look.size_px = fmax(4, fmin(MOST_TEXT_PX, json_is_number(size) ? json_number_value(size) : look.size_px));
        return add_text(m, position, &look);
    }
    const piece color = text_of(json_object_get(properties, "marker-color"));
    const piece size = text_of(json_object_get(properties, "marker-size"));
    const piece label = text_of(json_object_get(properties, "marker-symbol"));
    made.color = color.at ? color : made.color;
    made.scale = is_word(size, "small") ? 0.75 : is_word(size, "large") ? 1.35 : 1.0;
    made.has_label = label.length > 0 && label.length < 3; /* a letter or a number, not the name of an icon */
    return add_mark(m, &made) && (!made.has_label || add_label(m, &made, label));
}

/* Walks through coordinates, whatever their depth. properties: of points, which become markers. NULL: lines or areas.
 */
static bool walk_coordinates(maker *m, const json_t *json, const json_t *properties, int depth) {
    double position[2];
    if (!json_is_array(json) || depth > DEEPEST)
        return refuse(m, "its coordinates are not those of a geometry");
    if (json_is_number(json_array_get(json, 0)))
        return properties ? add_geojson_point(m, json, properties) : add_position(m, json, position);
    for (size_t i = 0; i < json_array_size(json); i++)
        if (!walk_coordinates(m, json_array_get(json, i), properties, depth + 1))
            return false;
    return true;
}

static bool walk_geometry(maker *m, const json_t *geometry, const json_t *properties, int depth) {
    const piece type = text_of(json_object_get(geometry, "type"));
    if (json_is_null(geometry))
        return true;
    if (is_word(type, "GeometryCollection")) {
        const json_t *parts = json_object_get(geometry, "geometries");
        bool fine = depth < DEEPEST || refuse(m, "collections are nested too deeply");
        for (size_t i = 0; fine && i < json_array_size(parts); i++)
            fine = walk_geometry(m, json_array_get(parts, i), properties, depth + 1);
        return fine;
    }
    const bool points = is_word(type, "Point") || is_word(type, "MultiPoint");
    if (!points && !is_word(type, "LineString") && !is_word(type, "MultiLineString") && !is_word(type, "Polygon") &&
        !is_word(type, "MultiPolygon"))
        return refuse(m, "it has no geometry of GeoJSON");
    return walk_coordinates(m, json_object_get(geometry, "coordinates"), points ? properties : NULL, 0);
}

static bool walk_feature(maker *m, const json_t *feature) {
    static const char *const colors[] = {"stroke", "fill", "marker-color", "text-color"};
    json_t *nothing = json_object();
    const json_t *given = json_object_get(feature, "properties"), *properties = json_is_object(given) ? given : nothing;
    m->number = ++m->feature_count;
    bool fine =
        nothing && (m->feature_count <= MOST_FEATURES || refuse(m, "there are more than %d features", MOST_FEATURES));
    for (size_t i = 0; fine && i < sizeof colors / sizeof *colors; i++)
        fine = check_color(m, properties, colors[i]);
    fine = fine && walk_geometry(m, json_object_get(feature, "geometry"), properties, 0);
    json_decref(nothing);
    return fine;
}

/* A property as a number, or a value where it is not one. */
static json_t *number_of(const char *name, double otherwise) {
    return json_pack("[s, [s, [s, s], f], f]", "to-number", "coalesce", "get", name, otherwise, otherwise);
}

static json_t *color_of(const char *name, piece otherwise) {
    const piece value = otherwise.at ? otherwise : (piece){"transparent", 11};
    return json_pack("[s, [s, [s, s], s%], s]", "to-color", "coalesce", "get", name, value.at, value.length, "#000000");
}

static bool add_geojson_layers(maker *m, json_t *root) {
    static const char name[] = "geojson";
    const piece grey = {"#555555", 7}, fill = m->look.fill.at ? m->look.fill : grey;
    const bool strokes = m->look.stroke.at != NULL;
    json_t *fills = json_pack("{s:o, s:o}", "fill-color", color_of("fill", fill), "fill-opacity",
                              number_of("fill-opacity", m->look.fill.at ? 1.0 : 0.6));
    json_t *lines = json_pack("{s:o, s:o, s:o}", "line-color", color_of("stroke", strokes ? m->look.stroke : grey),
                              "line-opacity", number_of("stroke-opacity", 1.0), "line-width",
                              number_of("stroke-width", m->look.width_px > 0 ? m->look.width_px : 2.0));
    return (add_source(m, name, json_incref(root)) && add_layer(m, "fill", name, json_object(), fills) &&
            add_layer(m, "line", name, json_pack("{s:s, s:s}", "line-cap", m->cap, "line-join", m->join), lines)) ||
           refuse(m, "no memory");
}

/* Reads the body. Its root is an object, so that it cannot be the name of a file. */
static bool read_geojson(maker *m, const char *body, size_t size_bytes, json_t **document) {
    json_error_t error;
    m->what = "GeoJSON";
    m->number = 0;
    json_t *root = *document = json_loadb(body, size_bytes, 0, &error);
    if (!root)
        return refuse(m, "the body is not JSON, at line %d, column %d", error.line, error.column);
    if (!json_is_object(root))
        return refuse(m, "the body is not an object");
    const piece type = text_of(json_object_get(root, "type"));
    const json_t *features = json_object_get(root, "features");
    bool fine = true;
    if (is_word(type, "FeatureCollection")) {
        fine = json_is_array(features) || refuse(m, "its features are not an array");
        m->what = "GeoJSON, feature";
        for (size_t i = 0; fine && i < json_array_size(features); i++)
            fine = walk_feature(m, json_array_get(features, i));
    } else if (is_word(type, "Feature")) {
        m->what = "GeoJSON, feature";
        fine = walk_feature(m, root);
    } else {
        json_t *nothing = json_object();
        fine = nothing && walk_geometry(m, root, nothing, 0);
        json_decref(nothing);
    }
    return fine && add_geojson_layers(m, root);
}

/* ---- The query ---- */

static bool find_word(maker *m, const char *value, const char *const words[3], const char **found) {
    for (int i = 0; i < 3; i++)
        if (strcmp(value, words[i]) == 0) {
            *found = words[i];
            return true;
        }
    return refuse(m, "it is not %s, %s or %s", words[0], words[1], words[2]);
}

/* Reads a parameter for all paths, or for the view. */
static bool read_common(maker *m, const char *name, const char *value) {
    static const char *const caps[] = {"butt", "round", "square"}, *const joins[] = {"miter", "round", "bevel"};
    static const char *const looks[] = {"fill", "stroke", "width", "border", "borderwidth"};
    const piece p = {value, strlen(value)};
    for (size_t i = 0; i < sizeof looks / sizeof *looks; i++)
        if (strcmp(name, looks[i]) == 0)
            return read_path_option(m, (piece){name, strlen(name)}, p, &m->look);
    if (strcmp(name, "latlng") == 0)
        m->is_latlng = strcmp(value, "0") != 0 && strcmp(value, "false") != 0;
    if (strcmp(name, "linecap") == 0)
        return find_word(m, value, caps, &m->cap);
    if (strcmp(name, "linejoin") == 0)
        return find_word(m, value, joins, &m->join);
    if (strcmp(name, "padding") == 0)
        return read_number(p, 0, 10, &m->padding) || refuse(m, "it is not a part of the size, from 0 to 10");
    if (strcmp(name, "maxzoom") == 0)
        return read_number(p, 0, MOST_ZOOM, &m->most_zoom) || refuse(m, "it is not a zoom from 0 to %d", MOST_ZOOM);
    return true;
}

static bool read_params(maker *m, const camber_overlay_desc *desc) {
    static const struct {
        const char *name;
        bool (*read)(maker *m, const char *value);
    } drawn[] = {{"path", read_path}, {"marker", read_marker}, {"text", read_text}};
    size_t numbers[3] = {0};
    for (size_t i = 0; i < desc->param_count; i++) {
        m->what = desc->params[i].name;
        if (!read_common(m, desc->params[i].name, desc->params[i].value))
            return false;
    }
    for (size_t i = 0; i < desc->param_count; i++)
        for (size_t k = 0; k < sizeof drawn / sizeof *drawn; k++)
            if (strcmp(desc->params[i].name, drawn[k].name) == 0) {
                m->what = drawn[k].name;
                m->number = ++numbers[k];
                if (!drawn[k].read(m, desc->params[i].value))
                    return false;
            }
    return true;
}

/* ---- The view ---- */

/* Finds centre and zoom at which a box fits, with some space around it. */
static void fit(maker *m, const double box[4]) {
    camber_route_request *r = m->request;
    const double part = 1.0 + 2.0 * m->padding;
    const double across = (box[2] - box[0]) * part * WORLD_PX, down = (box[3] - box[1]) * part * WORLD_PX;
    double zoom = log2(fmin(r->width / fmax(across, 1e-12), r->height / fmax(down, 1e-12)));
    if (box[2] <= box[0] && box[3] <= box[1])
        zoom = POINT_ZOOM;
    if (r->view == CAMBER_ROUTE_AUTO && !isnan(m->most_zoom))
        zoom = fmin(zoom, m->most_zoom);
    const double longitude = (0.5 * (box[0] + box[2]) - 0.5) * 360.0;
    r->longitude = longitude - 360.0 * floor((longitude + 180.0) / 360.0);
    r->latitude = find_latitude(fmax(0.0, fmin(1.0, 0.5 * (box[1] + box[3]))));
    r->map_zoom = fmax(0.0, fmin(MOST_ZOOM, zoom));
    r->view = CAMBER_ROUTE_CENTER;
}

static bool find_view(maker *m) {
    const camber_route_request *r = m->request;
    if (r->view == CAMBER_ROUTE_BOUNDS) {
        const double east = r->bounds[2] < r->bounds[0] ? r->bounds[2] + 360.0 : r->bounds[2];
        fit(m, (const double[]){r->bounds[0] / 360.0 + 0.5, project_y(r->bounds[3]), east / 360.0 + 0.5,
                                project_y(r->bounds[1])});
    } else if (r->view == CAMBER_ROUTE_AUTO) {
        m->what = "auto";
        m->number = 0;
        if (m->box[0] > m->box[2])
            return refuse(m, "there is nothing to fit; give a path, a marker, a text, or GeoJSON by POST");
        fit(m, m->box);
    }
    return true;
}

/* ---- Marks as areas ---- */

/* Adds a point that is some px beside the mark's position, on the screen, to a ring. */
static void add_beside(const maker *m, const mark *made, double x_px, double y_px, json_t *ring) {
    const camber_route_request *r = m->request;
    const double world_px = WORLD_PX * exp2(r->map_zoom), turn = r->bearing_deg * PI / 180.0;
    const double right = (x_px + made->x_px) * made->scale;
    const double down =
        (y_px + made->y_px) * made->scale / cos(r->pitch_deg * PI / 180.0); /* so that it looks upright */
    const double x = (right * cos(turn) - down * sin(turn)) / world_px;
    const double y = project_y(made->latitude) + (right * sin(turn) + down * cos(turn)) / world_px;
    json_array_append_new(ring, json_pack("[f, f]", made->longitude + 360.0 * x, find_latitude(y)));
}

/* Adds an arc around the mark's head. 0 is down; angles grow counter-clockwise as seen. */
static void add_arc(const maker *m, const mark *made, double radius_px, const double angles[2], json_t *ring) {
    const double head = made->is_dot ? 0.0 : -PIN_HEIGHT_PX;
    for (int i = 0; i <= ARC_POINTS; i++) {
        const double angle = angles[0] + (angles[1] - angles[0]) * i / ARC_POINTS;
        add_beside(m, made, radius_px * sin(angle), head + radius_px * cos(angle), ring);
    }
}

/* Makes the outline of a mark, grown by some px: a circle, or a circle and its tangents from the tip. */
static json_t *make_outline(const maker *m, const mark *made, double grown_px) {
    json_t *ring = json_array();
    const double radius = grown_px + (made->is_dot ? DOT_RADIUS_PX : PIN_RADIUS_PX);
    const double begin = made->is_dot ? 0.0 : acos(PIN_RADIUS_PX / PIN_HEIGHT_PX);
    if (!made->is_dot)
        add_beside(m, made, 0.0, PIN_HEIGHT_PX * (radius / PIN_RADIUS_PX - 1.0), ring);
    add_arc(m, made, radius, (const double[]){begin, 2.0 * PI - begin}, ring);
    json_array_append(ring, json_array_get(ring, 0));
    return ring;
}

/* Adds an area in one colour. */
static bool add_area(maker *m, size_t index, const char *kind, piece color, json_t *rings) {
    char name[32];
    snprintf(name, sizeof name, "%s%zu", kind, index);
    return add_source(m, name, make_geometry("Polygon", rings)) &&
           (!color.at ||
            add_layer(m, "fill", name, json_object(), json_pack("{s:s%}", "fill-color", color.at, color.length)));
}

/* A mark has a white edge, and a pin without a label has a white eye. */
static bool add_mark_layers(maker *m, size_t index) {
    const mark *made = m->marks + index;
    const piece white = {"#ffffff", 7};
    json_t *rings = json_pack("[o]", make_outline(m, made, 0.0));
    if (rings && !made->is_dot && !made->has_label) {
        json_t *eye = json_array();
        add_arc(m, made, EYE_PX, (const double[]){2.0 * PI, 0.0}, eye); /* the other way round */
        json_array_append(eye, json_array_get(eye, 0));
        json_array_append_new(rings, eye);
    }
    return (add_area(m, index, "edge", white, json_pack("[o]", make_outline(m, made, EDGE_PX))) &&
            add_area(m, index, "mark", made->color, rings)) ||
           refuse(m, "no memory");
}

/* ---- The overlay ---- */

static bool read_all(maker *m, const camber_overlay_desc *desc, json_t **document) {
    bool fine =
        read_params(m, desc) && (!desc->body || read_geojson(m, desc->body, desc->body_size, document)) && find_view(m);
    for (size_t i = 0; fine && i < m->mark_count; i++)
        fine = add_mark_layers(m, i);
    return fine && (json_array_extend(m->layers, m->texts) == 0 || refuse(m, "no memory"));
}

/* *is_ours: what fails is the operator's icons, and not the request. */
static camber_status read_features(const maker *m, const camber_overlay_desc *desc, camber_overlay *made,
                                   bool *is_ours) {
    const camber_route_request *r = m->request;
    const camber_view_desc view = {.kind = CAMBER_VIEW_CENTER,
                                   .longitude = r->longitude,
                                   .latitude = r->latitude,
                                   .zoom = r->map_zoom,
                                   .width = r->width,
                                   .height = r->height};
    const camber_fonts_desc fonts = {.folders = desc->fonts, .folder_count = desc->font_count};
    json_t *document = json_pack("{s:i, s:O, s:O}", "version", 8, "sources", m->sources, "layers", m->layers);
    if (document && m->has_icons)
        json_object_set_new(document, "sprite", json_string(camber_overlay_icons_get_sprite(m->icons)));
    char *text = document ? json_dumps(document, JSON_COMPACT) : NULL;
    camber_status status =
        text ? camber_style_parse(made->context, text, strlen(text), "overlay", &made->style) : CAMBER_ERROR_MEMORY;
    free(text);
    json_decref(document);
    if (status == CAMBER_OK)
        status = camber_features_create(made->context, made->style, &made->features);
    if (status == CAMBER_OK && json_array_size(m->texts))
        status = camber_features_read_fonts(made->features, &fonts, NULL);
    *is_ours = status == CAMBER_OK && m->has_icons;
    if (*is_ours)
        status = camber_features_read_sprites(made->features, r->ratio, NULL);
    if (status == CAMBER_OK) {
        *is_ours = false;
        status = camber_features_read_sources(made->features, &view, NULL);
    }
    return status;
}

int camber_overlay_create(const camber_overlay_desc *desc, camber_route_request *request, camber_overlay **overlay,
                          char reason[CAMBER_OVERLAY_REASON_SIZE]) {
    const camber_context_desc context = {.cache_dir = ""};
    camber_overlay *made = calloc(1, sizeof *made);
    maker m = {.request = request,
               .icons = desc->icons,
               .reason = reason,
               .look = {.stroke = {"rgba(0,64,255,0.7)", 18}, .width_px = 1, .border_px = NAN},
               .cap = "butt",
               .join = "miter",
               .padding = 0.1,
               .most_zoom = NAN,
               .sources = json_object(),
               .layers = json_array(),
               .texts = json_array(),
               .marks = calloc(MOST_MARKS, sizeof(mark)),
               .box = {INFINITY, INFINITY, -INFINITY, -INFINITY}};
    json_t *document = NULL;
    int result = 500;
    *overlay = NULL;
    if (made && m.sources && m.layers && m.texts && m.marks &&
        camber_context_create(&context, &made->context) == CAMBER_OK) {
        m.context = made->context;
        result = read_all(&m, desc, &document) ? 200 : 400;
    }
    if (result == 200 && m.has_icons && !(made->icons = camber_overlay_icons_hold(desc->icons)))
        result = 503;
    if (result == 200 && json_array_size(m.layers)) {
        bool is_ours = false;
        const camber_status status = read_features(&m, desc, made, &is_ours);
        result = status == CAMBER_OK ? 200 : status == CAMBER_ERROR_MEMORY || is_ours ? 500 : 400;
        snprintf(reason, CAMBER_OVERLAY_REASON_SIZE, "the overlay cannot be drawn: %s", camber_status_get_name(status));
    }
    json_decref(document);
    json_decref(m.sources);
    json_decref(m.layers);
    json_decref(m.texts);
    free(m.marks);
    if (result == 200 && made->features)
        *overlay = made;
    else
        camber_overlay_destroy(made);
    return result;
}

void camber_overlay_destroy(camber_overlay *overlay) {
    if (!overlay)
        return;
    camber_features_destroy(overlay->features);
    camber_style_destroy(overlay->style);
    camber_context_destroy(overlay->context);
    if (overlay->icons)
        camber_overlay_icons_release(overlay->icons);
    free(overlay);
}

const camber_features *camber_overlay_get_features(const camber_overlay *overlay) {
    return overlay->features;
}
