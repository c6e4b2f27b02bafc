/* Explains why a picture is empty: how much was read, what hides it, and what to do.
 *
 * Input: features, and the zooms that were to be drawn. Output: one sentence. It names the first cause that applies to
 * all features: none were read, no layer of the style takes them, the style draws none at this zoom, or none are in the
 * view. */
#include "map/plan.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* At most this many classes are tested at each zoom. */
enum { MOST_CLASSES = 256, LAST_ZOOM = 22 };

typedef struct sentence {
    char *text;
    size_t size, used;
} sentence;

static void CAMBER_PRINTF(2, 3) say(sentence *s, const char *format, ...) {
    va_list list;
    va_start(list, format);
    const int added = vsnprintf(s->text + s->used, s->size - s->used, format, list);
    va_end(list);
    s->used = added < 0 || s->used + (size_t)added >= s->size ? s->size - 1 : s->used + (size_t)added;
}

/* ---- The features that were read ---- */

static void say_count(sentence *s, size_t count, const char *noun, bool *any) {
    if (count)
        say(s, "%s%zu %s%s", *any ? ", " : "", count, noun, count == 1 ? "" : "s");
    *any = *any || count;
}

static size_t most(size_t a, size_t b) {
    return a > b ? a : b;
}

/* Writes, for example, "2 lines, 1 area of 0.3 MB read". An area whose outline is also drawn, or which is labelled,
 * counts once. */
static void say_read(sentence *s, const camber_features *features) {
    size_t kinds[CAMBER_GEOMETRY_KINDS] = {0};
    bool any = false;
    for (size_t i = 0; i < features->feature_count; i++)
        kinds[features->classes[features->feature_class[i]].geometry] +=
            !features->classes[features->feature_class[i]].is_ends;
    const size_t outlines = kinds[CAMBER_GEOMETRY_POLYGON], areas = kinds[CAMBER_GEOMETRY_AREA];
    say_count(s, most(kinds[CAMBER_GEOMETRY_LINE], kinds[CAMBER_GEOMETRY_LABEL_LINE]), "line", &any);
    say_count(s, most(most(areas, outlines), kinds[CAMBER_GEOMETRY_LABEL_AREA]), "area", &any);
    say_count(s, most(kinds[CAMBER_GEOMETRY_POINT], kinds[CAMBER_GEOMETRY_LABEL_POINT]), "point", &any);
    say(s, "%s", any ? "" : "no feature");
    const double bytes = (double)features->stats.input_bytes;
    if (bytes >= 1e6)
        say(s, " of %.1f MB", 1e-6 * bytes);
    else if (bytes > 0.0)
        say(s, bytes >= 1e4 ? " of %.0f kB" : " of %.0f bytes", bytes >= 1e4 ? 1e-3 * bytes : bytes);
    say(s, any ? " read" : " read that the style could draw");
}

/* ---- Why none of it shows ---- */

static void say_unread(sentence *s, const camber_features *features) {
    const camber_features_stats *stats = &features->stats;
    if (stats->missing_nodes)
        say(s,
            ": its ways refer to %zu nodes that are not in the file; make the extract with them (osmium extract "
            "--strategy=complete_ways, osmium getid --add-referenced)",
            stats->missing_nodes);
    else if (features->has_region)
        say(s, ": nothing is in the view; leave out --bbox and --center to show everything");
    else if (stats->skipped_features)
        say(s, ": the style does not draw the geometry of %zu features; choose another style with --style",
            stats->skipped_features);
    else
        say(s, "; check that this is the file you mean, or choose another style with --style");
}

static bool is_labelled(const camber_features *features, const camber_feature_class *class, double zoom) {
    for (size_t i = 0; i < features->style->layer_count; i++)
        if (camber_plan_labels(features, features->style->layers + i, zoom, class))
            return true;
    return false;
}

/* Whether anything is drawn at the zoom, or labelled. */
static bool any_at(const camber_features *features, double zoom) {
    size_t asked[2] = {0};
    for (size_t c = 0; c < features->class_count; c++) {
        const camber_feature_class *class = features->classes + c;
        const bool label = camber_geometry_is_label(class->geometry);
        if (asked[label]++ < MOST_CLASSES &&
            (label ? is_labelled(features, class, zoom) : camber_plan_draws(features, class, zoom, zoom)))
            return true;
    }
    return false;
}

/* Lists up to eight of the keys that the style reads: "highway, MTFCC, ...", or nothing. Keys that lines and circles of
 * any source layer use come first. */
static void list_properties(const camber_style *style, sentence *s) {
    const size_t count = style->schema.property_count;
    size_t listed = 0;
    for (size_t k = 0; k < 2 * count && listed <= 8; k++) {
        const size_t i = k < count ? k : k - count;
        const camber_property_readers *readers = style->schema.property_readers;
        const bool is_first = readers && readers[i].kinds & CAMBER_KIND_LINE;
        if (is_first != (k < count))
            continue;
        say(s, "%s%.64s", listed ? ", " : ": it reads ", listed == 8 ? "..." : style->schema.properties[i]);
        listed++;
    }
}

static bool any_between(const camber_features *features, double min_zoom, double max_zoom) {
    bool any = any_at(features, max_zoom);
    for (double zoom = min_zoom; zoom < max_zoom && !any; zoom += 1.0)
        any = any_at(features, zoom);
    return any;
}

/* Says that the style draws none of the features at these zooms. */
static void say_hidden(sentence *s, const camber_features *features, double min_zoom, double max_zoom) {
    int first = 0, last = LAST_ZOOM;
    char zooms[64];
    snprintf(zooms, sizeof zooms, min_zoom < max_zoom ? "zooms %.4g to %.4g" : "zoom %.4g", min_zoom, max_zoom);
    while (first <= LAST_ZOOM && !any_at(features, first))
        first++;
    while (last > first && !any_at(features, last))
        last--;
    if (first <= LAST_ZOOM && last < LAST_ZOOM)
        say(s, ", but the style draws none of it at %s; it draws some from zoom %d to %d", zooms, first, last);
    else if (first <= LAST_ZOOM)
        say(s, ", but the style draws none of it at %s; it draws some from zoom %d on", zooms, first);
    else {
        say(s, ", but no layer of the style draws any of it");
        list_properties(features->style, s);
        say(s, "; choose a style that does with --style");
    }
}

static camber_status say_elsewhere(sentence *s, const camber_features *features, double min_zoom, double max_zoom) {
    camber_box box = CAMBER_BOX_EMPTY;
    double bounds[4];
    const camber_status status = camber_plan_drawn_box(features, min_zoom, max_zoom, &box);
    if (camber_plan_unproject_box(&box, bounds))
        say(s, ", but none of it is in the view; --bbox %.6g,%.6g,%.6g,%.6g shows it", bounds[0], bounds[1], bounds[2],
            bounds[3]);
    else
        say(s, ", but none of it is in the view; leave out --bbox and --center to show everything");
    return status;
}

camber_status camber_plan_explain_nothing(const camber_features *features, double min_zoom, double max_zoom, char *text,
                                          size_t size, bool *draws) {
    sentence s = {text, size, 0};
    *draws = any_between(features, min_zoom, max_zoom);
    say_read(&s, features);
    if (features->feature_count == 0)
        say_unread(&s, features);
    else if (!*draws)
        say_hidden(&s, features, min_zoom, max_zoom);
    else
        return say_elsewhere(&s, features, min_zoom, max_zoom);
    return CAMBER_OK;
}

bool camber_features_explain_nothing(const camber_features *features, double min_zoom, double max_zoom, char *text,
                                     size_t size) {
    bool draws;
    (void)camber_plan_explain_nothing(features, min_zoom, max_zoom, text, size, &draws);
    return draws;
}
