/* Labels: a labelled picture of a map that moves, glyphs with halos alone, and placement alone.
 *
 * Glyphs are drawn from placed labels to pixels in memory, in OpenCL, and by Mapnik from the same texts at the same
 * points, in turn in one run. Times are wall times, and the time of the process on all cores ("CPU"), which is what one
 * core would need. */
#define _POSIX_C_SOURCE 200809L /* clock_gettime */

#include "bench.h"

#include "base/base.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

#ifdef CAMBER_MAP

#include "camber_map.h"
#include "features/features.h"
#include "lines/lines.h"
#include "map/label_shapes.h"
#include "peers/labels.h"

#include <math.h>

/* ---- Clocks ---- */

typedef struct clocks {
    double wall_ms, cpu_ms;
} clocks;

static clocks read_clocks(void) {
    struct timespec cpu;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
    return (clocks){camber_now_ms(), 1e3 * (double)cpu.tv_sec + 1e-6 * (double)cpu.tv_nsec};
}

typedef struct clock_series {
    bench_series wall, cpu;
} clock_series;

static void add_since(clock_series *series, clocks begin, double count) {
    const clocks end = read_clocks();
    bench_series_add(&series->wall, (end.wall_ms - begin.wall_ms) / count);
    bench_series_add(&series->cpu, (end.cpu_ms - begin.cpu_ms) / count);
}

/* ---- Maps ---- */

typedef struct city {
    const char *key, *name, *file;
    double longitude, latitude;
    bool own; /* the file is in the repository */
} city;

static const city cities[] = {
    {"monaco", "Monaco", CAMBER_MONACO, 7.4246, 43.7385, true},
    {"nyc", "New York", "nyc.osm.pbf", -73.9905, 40.7195, false},
};

/* The memory of a context, in bytes. */
typedef struct counted_memory {
    size_t held, most;
} counted_memory;

/* The size of a block is stored before it. */
static void *reallocate(void *user, void *block, size_t size_bytes) {
    enum { HEAD = 16 };
    counted_memory *h = user;
    char *old = block ? (char *)block - HEAD : NULL;
    size_t old_size = 0;
    if (old)
        memcpy(&old_size, old, sizeof old_size);
    if (size_bytes == 0) {
        h->held -= old_size;
        free(old);
        return NULL;
    }
    char *made = realloc(old, size_bytes + HEAD);
    if (!made)
        return NULL;
    memcpy(made, &size_bytes, sizeof size_bytes);
    h->held += size_bytes - old_size;
    h->most = h->held > h->most ? h->held : h->most;
    return made + HEAD;
}

typedef struct labelled_map {
    camber_style *style;
    camber_features *features;
} labelled_map;

static camber_status open_map(const bench *b, camber_context *context, const city *c, labelled_map *m) {
    char path[1024];
    const camber_fonts_desc fonts = {.no_system = true}; /* the same on every machine */
    snprintf(path, sizeof path, "%s%s%s", c->own ? "" : b->data, c->own ? "" : "/data/", c->file);
    camber_status status = camber_style_create_builtin(context, CAMBER_THEME_LIGHT, &m->style);
    if (status == CAMBER_OK)
        status = camber_features_create(context, m->style, &m->features);
    if (status == CAMBER_OK)
        status = camber_features_read_fonts(m->features, &fonts, NULL);
    if (status == CAMBER_OK)
        status = camber_features_read(m->features, &(camber_source_desc){.path = path});
    return status;
}

static void close_map(labelled_map *m) {
    camber_features_destroy(m->features);
    camber_style_destroy(m->style);
}

/* ---- A labelled picture ---- */

enum { PICTURE_WIDTH = 500, PICTURE_HEIGHT = 200, MOVES = 8 };

typedef struct moving_picture {
    bench *b;
    camber_scene *scene;
    clock_series frame, scenes, tessellate, draw;
} moving_picture;

static camber_view_desc view_of(const city *c, size_t move) {
    return (camber_view_desc){.kind = CAMBER_VIEW_CENTER,
                              .longitude = c->longitude + 0.0002 * (double)move,
                              .latitude = c->latitude + 0.0001 * (double)move,
                              .zoom = 15,
                              .width = PICTURE_WIDTH,
                              .height = PICTURE_HEIGHT};
}

static bool ignore_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    (void)user;
    (void)rgba;
    (void)first_row;
    (void)row_count;
    return true;
}

/* Draws pictures of a map that moves; times are of one of them. */
static camber_status draw_pictures(moving_picture *p, const city *c, bool counts) {
    camber_status status = CAMBER_OK;
    clock_series parts[3] = {0};
    const clocks begin = read_clocks();
    for (size_t move = 0; move < MOVES && status == CAMBER_OK; move++) {
        const camber_view_desc view = view_of(c, move);
        clocks start = read_clocks();
        status = camber_scene_move(p->scene, &view);
        add_since(parts, start, 1);
        start = read_clocks();
        if (status == CAMBER_OK)
            status = camber_scene_tessellate(p->scene, p->b->cl_mesh, CAMBER_METHOD_STRIP);
        add_since(parts + 1, start, 1);
        start = read_clocks();
        const camber_frame frame = camber_scene_get_frame(p->scene, p->b->cl_mesh);
        if (status == CAMBER_OK)
            status = camber_renderer_render(p->b->cl_renderer, &frame, ignore_rows, NULL, NULL);
        add_since(parts + 2, start, 1);
    }
    if (!counts || status != CAMBER_OK)
        return status;
    clock_series *const sums[] = {&p->scenes, &p->tessellate, &p->draw};
    for (size_t i = 0; i < 3; i++) {
        bench_series_add(&sums[i]->wall, bench_series_median(&parts[i].wall));
        bench_series_add(&sums[i]->cpu, bench_series_median(&parts[i].cpu));
    }
    add_since(&p->frame, begin, MOVES);
    return status;
}

static camber_status measure_picture(bench *b, const city *c, json_t *result) {
    labelled_map m = {0};
    moving_picture p = {.b = b};
    camber_scene_desc desc = {.view = view_of(c, 0), .simplify_px = BENCH_SIMPLIFY_PX};
    camber_status status = open_map(b, b->context, c, &m);
    if (status == CAMBER_OK)
        status = camber_scene_create(m.features, &desc, &p.scene);
    for (size_t run = 0; run < b->warm_ups + b->runs && status == CAMBER_OK; run++)
        status = draw_pictures(&p, c, run >= b->warm_ups);
    if (status == CAMBER_OK) {
        const camber_scene_info info = camber_scene_get_info(p.scene);
        bench_result_add_row(result, json_pack("{s:s, s:s, s:I, s:o, s:o, s:o, s:o, s:o}", "key", c->key, "picture",
                                               c->name, "labels", (json_int_t)info.labels, "frame_ms",
                                               bench_ms(bench_series_median(&p.frame.wall)), "cpu_ms",
                                               bench_ms(bench_series_median(&p.frame.cpu)), "scene_ms",
                                               bench_ms(bench_series_median(&p.scenes.cpu)), "tessellate_ms",
                                               bench_ms(bench_series_median(&p.tessellate.cpu)), "draw_ms",
                                               bench_ms(bench_series_median(&p.draw.cpu))));
    }
    camber_scene_destroy(p.scene);
    close_map(&m);
    return status;
}

/* ---- Placement ---- */

/* The size of a view at a zoom that shows everything. */
static void size_view(const double bounds[4], camber_view_desc *desc) {
    const double world = 512.0 * exp2(desc->zoom), latitude = 0.5 * (bounds[1] + bounds[3]);
    desc->longitude = 0.5 * (bounds[0] + bounds[2]);
    desc->latitude = latitude;
    desc->width = (uint32_t)fmin(world * (bounds[2] - bounds[0]) / 360.0 + 1.0, 16384.0);
    desc->height = (uint32_t)fmin(
        world * (bounds[3] - bounds[1]) / 360.0 / cos(latitude * 3.14159265358979323846 / 180.0) + 1.0, 16384.0);
}

static camber_status measure_placement(bench *b, const city *c, json_t *result) {
    counted_memory h = {0};
    labelled_map m = {0};
    camber_context *context = NULL;
    const camber_context_desc desc = {.reallocate = reallocate, .allocator_user = &h};
    double bounds[4];
    camber_view view;
    camber_labels labels = {0};
    clock_series series = {0};
    size_t most = 0;
    camber_view_desc whole = {.kind = CAMBER_VIEW_CENTER, .zoom = 15};
    camber_status status = camber_context_create(&desc, &context);
    labels.context = context;
    if (status == CAMBER_OK)
        status = open_map(b, context, c, &m);
    if (status == CAMBER_OK && camber_features_get_bounds(m.features, bounds))
        size_view(bounds, &whole);
    if (status == CAMBER_OK)
        status = camber_view_create(context, &whole, &view);
    for (size_t run = 0; run < b->warm_ups + b->runs && status == CAMBER_OK; run++) {
        camber_labels_free(&labels);
        const size_t held = h.most = h.held;
        const clocks begin = read_clocks();
        status = camber_labels_place(m.features, &view, m.features->fonts, NULL, &labels);
        if (run >= b->warm_ups)
            add_since(&series, begin, 1);
        most = h.most - held > most ? h.most - held : most;
    }
    if (status == CAMBER_OK)
        bench_result_add_row(result, json_pack("{s:s, s:s, s:I, s:I, s:I, s:I, s:o, s:I}", "key", c->key, "placement",
                                               c->name, "width", (json_int_t)view.width, "height",
                                               (json_int_t)view.height, "labels", (json_int_t)labels.label_count,
                                               "glyphs", (json_int_t)labels.item_count, "cpu_ms",
                                               bench_ms(bench_series_median(&series.cpu)), "bytes", (json_int_t)most));
    if (status == CAMBER_OK)
        bench_result_add_figure(result, &(bench_figure){c->key, "bytes of placement", NULL, (double)most, true});
    if (context)
        camber_labels_free(&labels);
    close_map(&m);
    camber_context_destroy(context);
    return status;
}

/* ---- Glyphs ---- */

enum { GLYPHS = 10000, LABEL_COLUMNS = 20, LABEL_STEP_X = 102, LABEL_STEP_Y = 22, LABELS_MAX = 1800, TEXT_PX = 12 };

static const char font[] = "Noto Sans Regular";
static const char *const words[] = {
    "Broadway",      "Canal Street",  "Rua das Flores", "Bowery",       "Kaivopuisto",   "Houston Street",
    "Boulevard",     "Mannerheim",    "Prince Street",  "Via Appia",    "Großer Stern",  "Gran Vía",
    "Lafayette",     "Rue de Rivoli", "Spring Street",  "Kongens Gade", "Mercer Street", "Avenida Sul",
    "Leonard Place", "Ulica Długa",   "West Side",      "Plaça Reial",  "Grand Parade",  "Åboulevarden"};
enum { WORDS = sizeof words / sizeof *words };

/* 10,000 glyphs with halos, as text that is drawn and as texts for a peer. */
typedef struct sheet {
    bench *b;
    camber_fonts *fonts;
    camber_text *texts[WORDS];
    camber_labels labels;
    camber_label_item *items;
    bench_label *points;
    size_t point_count;
    clock_series frame, shapes, tessellate, draw, mapnik;
    size_t edges;                     /* of the glyphs */
    double darkness, mapnik_darkness; /* share of the ink that is black */
} sheet;

static camber_status shape_words(sheet *s) {
    static const char *const fonts[] = {font};
    const camber_fonts_desc desc = {.no_system = true};
    camber_status status = camber_fonts_create(s->b->context, &desc, &s->fonts);
    for (size_t i = 0; i < WORDS && status == CAMBER_OK; i++) {
        const camber_text_run run = {.text = words[i], .size_bytes = strlen(words[i]), .fonts = fonts, .font_count = 1};
        status = camber_text_shape(s->fonts, &(camber_text_desc){.runs = &run, .run_count = 1}, s->texts + i);
    }
    return status;
}

static camber_status add_label(sheet *s, size_t number) {
    const bench_label at = {words[number % WORDS], LABEL_STEP_X * (0.5 + (double)(number % LABEL_COLUMNS)) + 4.0,
                            LABEL_STEP_Y * (0.5 + (double)(number / LABEL_COLUMNS)) + 4.0};
    const camber_text *text = s->texts[number % WORDS];
    s->points[s->point_count++] = at;
    for (size_t i = 0; i < text->glyph_count && s->labels.item_count < GLYPHS; i++) {
        const camber_text_glyph *g = text->glyphs + i;
        camber_outline outline;
        const camber_status status = camber_fonts_get_outline(s->fonts, g->glyph, 0, &outline);
        if (status != CAMBER_OK)
            return status;
        if (outline.ring_count == 0)
            continue;
        s->items[s->labels.item_count++] = (camber_label_item){.glyph = g->glyph,
                                                               .x = (float)at.x + g->x * TEXT_PX,
                                                               .y = (float)at.y + g->y * TEXT_PX,
                                                               .xx = TEXT_PX,
                                                               .yy = TEXT_PX};
    }
    return CAMBER_OK;
}

static camber_status make_sheet(sheet *s) {
    static camber_label_look look = {.color = {0, 0, 0, 1}, .halo_color = {1, 1, 1, 1}, .halo_width_px = 1};
    static camber_label_layer layer = {.glyph_count = GLYPHS};
    s->items = calloc(GLYPHS, sizeof *s->items);
    s->points = calloc(LABELS_MAX, sizeof *s->points);
    s->labels = (camber_labels){.context = s->b->context,
                                .layers = &layer,
                                .layer_count = 1,
                                .items = s->items,
                                .looks = &look,
                                .look_count = 1};
    camber_status status = s->items && s->points ? shape_words(s) : CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < LABELS_MAX && s->labels.item_count < GLYPHS && status == CAMBER_OK; i++)
        status = add_label(s, i);
    return status;
}

static camber_status draw_shapes(sheet *s, const camber_label_shapes *shapes) {
    bench_taking taking = {.picture = s->b->picture};
    camber_pass passes[CAMBER_LABEL_PASSES];
    camber_label_mesh meshes[CAMBER_LABEL_PASSES];
    camber_frame frame = {.width = BENCH_SIDE_PX, .height = BENCH_SIDE_PX, .passes = passes};
    frame.background = (camber_color){128 / 255.0f, 128 / 255.0f, 128 / 255.0f, 1};
    camber_mesh *texts = NULL;
    const camber_status status = camber_mesh_get_companion(s->b->cl_mesh, &texts);
    frame.pass_count = camber_label_shapes_passes(shapes, shapes->ranges, passes, meshes);
    for (size_t i = 0; i < frame.pass_count; i++)
        passes[i].mesh = texts;
    return status == CAMBER_OK ? camber_renderer_render(s->b->cl_renderer, &frame, bench_take_rows, &taking, NULL)
                               : status;
}

static camber_status draw_sheet(sheet *s, bool counts) {
    camber_label_shapes shapes = {0};
    clocks start = read_clocks();
    const clocks begin = start;
    sheet unused = {0}, *to = counts ? s : &unused;
    camber_status status = camber_label_shapes_make(&s->labels, s->fonts, &shapes);
    add_since(&to->shapes, start, 1);
    start = read_clocks();
    if (status == CAMBER_OK)
        s->edges = shapes.texts->stats.kept_segments;
    if (status == CAMBER_OK)
        status = camber_label_shapes_tessellate(&shapes, s->b->cl_mesh, CAMBER_METHOD_STRIP);
    add_since(&to->tessellate, start, 1);
    start = read_clocks();
    if (status == CAMBER_OK)
        status = draw_shapes(s, &shapes);
    add_since(&to->draw, start, 1);
    add_since(&to->frame, begin, 1);
    camber_label_shapes_free(&shapes);
    return status;
}

/* How much of a picture on grey is darker than the grey, and how much is lighter: the texts and the halos. */
static double darkness_of(const uint8_t *rgba) {
    double dark = 0, light = 0;
    for (size_t i = 0; i < (size_t)BENCH_SIDE_PX * BENCH_SIDE_PX; i++) {
        const double level = rgba[4 * i];
        dark += level < 128 ? 128 - level : 0;
        light += level > 128 ? level - 128 : 0;
    }
    return light > 0 ? dark / light : 0;
}

static void draw_peer(sheet *s, bool counts) {
#ifdef CAMBER_BENCH_MAPNIK
    const bench_labels labels = {.labels = s->points,
                                 .count = s->point_count,
                                 .font_file = CAMBER_BENCH_FONT,
                                 .font = font,
                                 .size_px = TEXT_PX,
                                 .halo_px = 1};
    const double ms = bench_mapnik_labels(&labels, s->b->pictured);
    if (counts && ms > 0)
        bench_series_add(&s->mapnik.wall, ms);
    s->mapnik_darkness = darkness_of(s->b->pictured);
#else
    (void)counts;
    (void)s;
#endif
}

static void report_sheet(const sheet *s, json_t *result) {
    const double ms = bench_series_median(&s->frame.wall), mapnik = bench_series_median(&s->mapnik.wall);
    bench_result_add_row(result,
                         json_pack("{s:s, s:s, s:I, s:I, s:o, s:o, s:o, s:o, s:o, s:o, s:f, s:f}", "key", "glyphs",
                                   "glyphs_of", font, "glyphs", (json_int_t)GLYPHS, "edges", (json_int_t)s->edges,
                                   "frame_ms", bench_ms(ms), "cpu_ms", bench_ms(bench_series_median(&s->frame.cpu)),
                                   "shapes_ms", bench_ms(bench_series_median(&s->shapes.cpu)), "tessellate_ms",
                                   bench_ms(bench_series_median(&s->tessellate.cpu)), "draw_ms",
                                   bench_ms(bench_series_median(&s->draw.cpu)), "mapnik_ms", bench_ms(mapnik), "dark",
                                   s->darkness, "mapnik_dark", s->mapnik_darkness));
    bench_result_add_figure(result,
                            &(bench_figure){"glyphs", "glyphs with halos in OpenCL", "Mapnik", mapnik / ms, false});
}

static camber_status measure_sheet(bench *b, json_t *result) {
    sheet s = {.b = b};
    camber_status status = make_sheet(&s);
    for (size_t run = 0; run < b->warm_ups + b->runs && status == CAMBER_OK; run++) {
        status = draw_sheet(&s, run >= b->warm_ups);
        draw_peer(&s, run >= b->warm_ups);
    }
    s.darkness = darkness_of(b->picture);
    if (status == CAMBER_OK)
        report_sheet(&s, result);
    for (size_t i = 0; i < WORDS; i++)
        camber_text_destroy(s.texts[i]);
    camber_fonts_destroy(s.fonts);
    free(s.items);
    free(s.points);
    return status;
}

/* ---- The section ---- */

static camber_status measure_all(bench *b, const char *only, json_t *result) {
    camber_status status = CAMBER_OK;
    if (!only || strcmp(only, "glyphs") == 0)
        status = measure_sheet(b, result);
    for (size_t i = 0; i < sizeof cities / sizeof *cities && status == CAMBER_OK; i++) {
        const bool here = cities[i].own || (b->data && b->size != BENCH_TINY);
        if (!here || (only && strcmp(only, cities[i].key) != 0))
            continue;
        status = measure_picture(b, cities + i, result);
        if (status == CAMBER_OK)
            status = measure_placement(b, cities + i, result);
    }
    return status;
}

static json_t *measure(bench *b, const char *only) {
    json_t *result = bench_result_new();
    if (measure_all(b, only, result) == CAMBER_OK)
        return result;
    json_decref(result);
    return NULL;
}

#else
#define measure NULL
#endif

static void print_row(const json_t *row, FILE *to) {
    if (*bench_text(row, "glyphs_of"))
        fprintf(to,
                "%.0f glyphs of 12 px with halos (%.0f edges), %d x %d px: %.1f ms, CPU %.1f (shapes %.1f, tessellate "
                "%.1f, draw "
                "%.1f); Mapnik %.1f\n    ms, %.2f times as long (text by halo: %.3f, Mapnik %.3f)\n",
                bench_number(row, "glyphs"), bench_number(row, "edges"), BENCH_SIDE_PX, BENCH_SIDE_PX,
                bench_number(row, "frame_ms"), bench_number(row, "cpu_ms"), bench_number(row, "shapes_ms"),
                bench_number(row, "tessellate_ms"), bench_number(row, "draw_ms"), bench_number(row, "mapnik_ms"),
                bench_number(row, "mapnik_ms") / bench_number(row, "frame_ms"), bench_number(row, "dark"),
                bench_number(row, "mapnik_dark"));
    if (*bench_text(row, "picture"))
        fprintf(to,
                "%s, 500 x 200 px at zoom 15, style city, %.0f labels: %.2f ms, CPU %.2f (scene %.2f, tessellate %.2f, "
                "draw %.2f)\n",
                bench_text(row, "picture"), bench_number(row, "labels"), bench_number(row, "frame_ms"),
                bench_number(row, "cpu_ms"), bench_number(row, "scene_ms"), bench_number(row, "tessellate_ms"),
                bench_number(row, "draw_ms"));
    if (*bench_text(row, "placement"))
        fprintf(to,
                "%s, all names at zoom 15 (%.0f x %.0f px): %.0f labels, %.0f glyphs and icons: CPU %.1f ms, %.1f MB\n",
                bench_text(row, "placement"), bench_number(row, "width"), bench_number(row, "height"),
                bench_number(row, "labels"), bench_number(row, "glyphs"), bench_number(row, "cpu_ms"),
                bench_number(row, "bytes") / 1e6);
}

static void print(const json_t *result, FILE *to) {
    size_t i;
    const json_t *row;
    fprintf(to, "Labels in OpenCL: wall time, and the time of the process on all cores (CPU).\n\n");
    json_array_foreach(bench_result_rows(result), i, row) print_row(row, to);
}

const bench_section bench_section_labels = {"labels", measure, print};
