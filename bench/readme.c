/* The README's numbers, written between two markers from a document, so that nobody types them. */
#include "bench.h"

#include "base/base.h"

#include <stdlib.h>
#include <string.h>

#define BEGIN_MARKER "<!-- measured: made by ./dev bench --readme -->\n"
#define END_MARKER "<!-- /measured -->\n"

enum { LIBRARIES_MAX = 8 };

typedef struct page {
    const json_t *sections, *peers;
    const char *libraries[LIBRARIES_MAX]; /* keys of peers, the first of each library */
    size_t library_count;
    const char *results; /* path of the document without its ending */
    FILE *to;
} page;

static const json_t *rows_of(const page *p, const char *section) {
    return bench_result_rows(json_object_get(p->sections, section));
}

/* "Project to emit" of a scene with every point. */
static const json_t *find_network(const page *p, const char *key) {
    size_t i;
    const json_t *row;
    json_array_foreach(rows_of(p, "network"), i, row) {
        if (strcmp(bench_text(row, "key"), key) == 0 && bench_number(row, "simplify_px") <= 0)
            return row;
    }
    return NULL;
}

/* The row of a scene's strip at a width. */
static const json_t *find_stages(const page *p, const char *key, double width_px) {
    size_t i;
    const json_t *row;
    json_array_foreach(rows_of(p, "stages"), i, row) {
        const bool strip = strcmp(bench_text(row, "method"), "strip") == 0 && bench_number(row, "width_px") == width_px;
        if (strip && strcmp(bench_text(row, "key"), key) == 0)
            return row;
    }
    return NULL;
}

static void put_head(const page *p, const json_t *document) {
    const json_t *device = json_object_get(document, "device"), *gl = json_object_get(document, "gl");
    fprintf(
        p->to,
        "One run of `./dev bench` on %.10s: %s, %.0f units, %s %s; %s, %s; buffers: %s. %d x %d px, round joins, butt "
        "caps, black on white, medians of %.0f runs in turn; peers run in one thread each, but where it says "
        "threads.\n\n",
        bench_text(document, "date"), bench_text(device, "name"), bench_number(device, "units"),
        bench_text(device, "platform"), bench_text(device, "driver"), bench_text(gl, "renderer"),
        bench_text(gl, "version"), bench_text(document, "sharing"), BENCH_SIDE_PX, BENCH_SIDE_PX,
        bench_number(document, "runs"));
}

/* Sections of another day's run, where a document was put together. */
static void put_dates(const page *p, const char *date) {
    const size_t day = strlen("2026-01-01");
    const char *key, *before = "Measured on another day, on the same machine: ";
    json_t *section;
    json_object_foreach((json_t *)p->sections, key, section) {
        const char *own = bench_text(section, "date");
        if (!*own || strncmp(own, date, day) == 0)
            continue;
        fprintf(p->to, "%s`%s` (%.10s)", before, key, own);
        before = ", ";
    }
    fputs(*before == ',' ? ".\n\n" : "", p->to);
}

/* "1,103,969 |" */
static void put_count(double count, FILE *to) {
    const unsigned long whole = (unsigned long)count;
    if (whole >= 1000000)
        fprintf(to, " %lu,%03lu,%03lu |", whole / 1000000, whole / 1000 % 1000, whole % 1000);
    else if (whole >= 1000)
        fprintf(to, " %lu,%03lu |", whole / 1000, whole % 1000);
    else
        fprintf(to, " %lu |", whole);
}

/* ---- Drawing ---- */

static void put_drawing(const page *p) {
    size_t i;
    const json_t *row;
    fputs("| scene | segments | camber, ms | at 0.1 px | through GL | at 0.1 px |", p->to);
    for (size_t k = 0; k < p->library_count; k++) {
        const json_t *peer = json_object_get(p->peers, p->libraries[k]);
        fprintf(p->to, " %s %s, ms | ratio |", bench_text(peer, "name"), bench_text(peer, "version"));
    }
    fputs("\n|---|---|---|---|---|---|", p->to);
    for (size_t k = 0; k < p->library_count; k++)
        fputs("---|---|", p->to);
    fputs("\n", p->to);
    json_array_foreach(rows_of(p, "frames"), i, row) {
        const double frame_ms = bench_number(row, "cl_frame_ms");
        fprintf(p->to, "| %s, %g px |", bench_text(row, "scene"), bench_number(row, "width_px"));
        put_count(bench_number(row, "segments"), p->to);
        fprintf(p->to, " %.1f | %.1f | %.1f | %.1f |", frame_ms, bench_number(row, "cl_simple_frame_ms"),
                bench_number(row, "frame_ms"), bench_number(row, "simple_frame_ms"));
        for (size_t k = 0; k < p->library_count; k++) {
            const double ms = bench_best_peer(json_object_get(row, "peers"), p->libraries[k]);
            if (ms > 0)
                fprintf(p->to, " %.1f | %.2f |", ms, ms / frame_ms);
            else
                fputs(" - | - |", p->to);
        }
        fputs("\n", p->to);
    }
    fprintf(p->to,
            "\nWhole frames, from lines in memory to pixels in memory: drawn by OpenCL kernels, every point; with what "
            "lies closer than %g px left out, as the tool does by default (lines on the device); and the same through "
            "GLES on llvmpipe. Peers draw everything, a line at a time or all as one path, whichever is faster; ratio: "
            "how many times camber's first figure fits into that. The picture of each peer is compared with "
            "camber's.\n\n",
            BENCH_SIMPLIFY_PX);
}

/* ---- Tessellation ---- */

static void put_tessellation(const page *p) {
    size_t i;
    const json_t *row;
    fputs("| strip, 8 px wide | M segments/s | GB/s | share of memcpy's | bytes a segment | at 2 px "
          "| project to emit, M points/s |\n|---|---|---|---|---|---|---|\n",
          p->to);
    json_array_foreach(rows_of(p, "frames"), i, row) {
        const json_t *wide = find_stages(p, bench_text(row, "key"), 8),
                     *thin = find_stages(p, bench_text(row, "key"), 2);
        const json_t *all = json_object_get(wide, "all");
        fprintf(p->to, "| %s | %.0f | %.1f | %.0f %% | %.1f | %.1f | %.0f |\n", bench_text(row, "scene"),
                bench_number(wide, "m_segments_s"), bench_number(all, "gb_s"), 100 * bench_number(all, "share"),
                bench_number(wide, "bytes_a_segment"), bench_number(thin, "bytes_a_segment"),
                bench_number(find_network(p, bench_text(row, "key")), "m_points_s"));
    }
    fprintf(p->to,
            "\nclassify, scan and emit, input and output on the device; bytes read and written, against memcpy's on as "
            "many "
            "threads in the same run (of 16 MB; %.1f GB/s); bytes of the mesh, everything included. Project to emit: "
            "of points "
            "of the network, every point kept, at the scene's width, what the host does included.\n\n",
            bench_number(json_array_get(rows_of(p, "stages"), 0), "memcpy_gb_s"));
}

/* ---- The rest ---- */

static void put_fly(const page *p) {
    size_t i;
    const json_t *row;
    json_array_foreach(rows_of(p, "fly"), i, row) {
        const json_t *frame = json_object_get(row, "frame");
        const bool in_cl = strcmp(bench_text(row, "by"), "cl") == 0;
        fprintf(
            p->to,
            "Fly-through of %s drawn %s, built-in style, %.0f frames of %.0f x %.0f px, pan and zoom: half of the "
            "frames within "
            "%.1f ms, 99 "
            "of 100 within %.1f ms (half within: scene %.1f, tessellation %.1f, drawing %.1f, reading back %.1f ms); "
            "%.1f draw calls a frame.\n\n",
            bench_text(row, "city"), in_cl ? "by kernels" : "through GL", bench_number(row, "frames"),
            bench_number(row, "width"), bench_number(row, "height"), bench_number(frame, "p50_ms"),
            bench_number(frame, "p99_ms"), bench_number(json_object_get(row, "scene"), "p50_ms"),
            bench_number(json_object_get(row, "tessellate"), "p50_ms"),
            bench_number(json_object_get(row, "draw"), "p50_ms"), bench_number(json_object_get(row, "read"), "p50_ms"),
            bench_number(row, "draw_calls"));
    }
}

static void put_mosaic(const page *p) {
    const json_t *result = json_object_get(p->sections, "mosaic"), *rows = bench_result_rows(result);
    const json_t *last = json_array_get(rows, json_array_size(rows) - 1);
    if (!last)
        return;
    fprintf(p->to,
            "A mosaic of %.3g million points (copies of %s): %.2f s a frame, %.2f s with every point; peak memory %.2f "
            "and %.2f "
            "GB. From %.0f points on, a point costs at most %.2f times (every point drawn: %.2f times) what it costs "
            "in any smaller mosaic:\n\n"
            "![What a point costs, by the number of points](%s.svg)\n\n",
            bench_number(last, "points") / 1e6, bench_text(last, "city"),
            bench_number(json_object_get(last, "simple"), "frame_ms") / 1e3,
            bench_number(json_object_get(last, "everything"), "frame_ms") / 1e3, bench_number(last, "peak_bytes") / 1e9,
            bench_number(last, "everything_peak_bytes") / 1e9, bench_number(json_array_get(rows, 0), "points"),
            bench_number(result, "simple_growth"), bench_number(result, "everything_growth"), p->results);
}

static void put_start(const page *p) {
    size_t i;
    const json_t *row;
    const char *before = "Wall time of the whole program, first with empty caches and then with warm ones: ";
    json_array_foreach(rows_of(p, "start"), i, row) {
        const char *name = bench_text(row, "name");
        if (*name)
            fprintf(p->to, "%s%s %.2f s, %.3f s", before, name + strspn(name, " "), bench_number(row, "cold_ms") / 1e3,
                    bench_number(row, "warm_ms") / 1e3);
        else
            fprintf(p->to, ". %s from file to %.0f points: %.3f s (OGR's own copy of the file's lines: %.3f s)",
                    bench_text(row, "reading"), bench_number(row, "points"), bench_number(row, "read_ms") / 1e3,
                    bench_number(row, "ogr_ms") / 1e3);
        before = "; ";
    }
    fprintf(p->to, ".\n\nEverything measured: [`%s.json`](%s.json).\n", p->results, p->results);
}

static void put_page(page *p, const json_t *document) {
    const char *key;
    json_t *peer;
    p->sections = json_object_get(document, "sections");
    p->peers = json_object_get(document, "peers");
    json_object_foreach((json_t *)p->peers, key, peer) if (!strchr(key, '_') && p->library_count < LIBRARIES_MAX)
        p->libraries[p->library_count++] = key;
    put_head(p, document);
    put_dates(p, bench_text(document, "date"));
    put_drawing(p);
    put_tessellation(p);
    put_fly(p);
    put_mosaic(p);
    put_start(p);
}

/* ---- Between the markers ---- */

/* text: the README as it was. */
static bool rewrite(const json_t *document, const char *results, const char *text, const char *path) {
    const char *begin = strstr(text, BEGIN_MARKER), *end = begin ? strstr(begin, END_MARKER) : NULL;
    char *page_text = NULL;
    size_t size = 0;
    page p = {.results = results, .to = end ? open_memstream(&page_text, &size) : NULL};
    if (!p.to)
        return false;
    put_page(&p, document);
    bool done = fclose(p.to) == 0;
    FILE *file = done ? fopen(path, "w") : NULL;
    if (file) {
        fwrite(text, 1, (size_t)(begin - text) + strlen(BEGIN_MARKER), file);
        done = fprintf(file, "%s%s", page_text, end) > 0;
        done = fclose(file) == 0 && done;
    }
    free(page_text);
    return file && done;
}

bool bench_readme_write(const json_t *document, const char *json_path, const char *path) {
    camber_context *context = NULL;
    char results[512], *text = NULL;
    size_t size = 0;
    snprintf(results, sizeof results, "%s", json_path);
    char *ending = strstr(results, ".json");
    if (ending)
        *ending = 0;
    const bool done = camber_context_create(NULL, &context) == CAMBER_OK &&
                      camber_read_file(context, path, CAMBER_NAMED_BY_CALLER, &text, &size) == CAMBER_OK &&
                      rewrite(document, results, text, path);
    if (!done)
        fprintf(stderr, "camber_bench: %s: cannot be written, or lacks one of the lines\n%s%s", path, BEGIN_MARKER,
                END_MARKER);
    if (context)
        camber_free(context, text);
    camber_context_destroy(context);
    return done;
}
