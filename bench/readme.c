/* The numbers of README.md and docs/performance.md, so that nobody types them.
 *
 * Input: JSON documents of benchmarks, each of another kind of processor. Output: a text file, rewritten between pairs
 * of markers. There are three blocks: "frames" is the one table of README.md, "areas" that of docs/areas.md, "measured"
 * is everything else. A file may hold any of them. What depends most on the processor stands side by side, a group of
 * columns a document; all else is the first document's. Prose is wrapped at LINE_COLUMNS columns, as all documents are.
 */
#include "bench.h"

#include "base/base.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LIBRARIES_MAX = 8, RUNS_MAX = 4, WAYS_MAX = 8, LINE_COLUMNS = 118 };

typedef struct run {
    json_t *document;
    const json_t *sections, *peers, *machine, *device;
    char results[512]; /* path of the document without its ending, from the repository's root */
} run;

typedef struct page {
    run runs[RUNS_MAX];
    size_t run_count;
    const char *libraries[LIBRARIES_MAX]; /* keys of peers, the first of each library */
    size_t library_count;
    FILE *to;
} page;

static const json_t *rows_of(const run *r, const char *section) {
    return bench_result_rows(json_object_get(r->sections, section));
}

static const json_t *find_row(const run *r, const char *section, const char *scene) {
    size_t i;
    const json_t *row;
    json_array_foreach(rows_of(r, section), i, row) {
        if (strcmp(bench_text(row, "key"), scene) == 0)
            return row;
    }
    return NULL;
}

/* From culling to emit: the row of a scene with every point. */
static const json_t *find_network(const run *r, const char *scene) {
    size_t i;
    const json_t *row;
    json_array_foreach(rows_of(r, "network"), i, row) {
        if (strcmp(bench_text(row, "key"), scene) == 0 && bench_number(row, "simplify_px") <= 0)
            return row;
    }
    return NULL;
}

/* The row of a scene's strip at a width. */
static const json_t *find_stages(const run *r, const char *scene, double width_px) {
    size_t i;
    const json_t *row;
    json_array_foreach(rows_of(r, "stages"), i, row) {
        const bool strip = strcmp(bench_text(row, "method"), "strip") == 0 && bench_number(row, "width_px") == width_px;
        if (strip && strcmp(bench_text(row, "key"), scene) == 0)
            return row;
    }
    return NULL;
}

/* The instructions that a run is of: "AVX2". */
static const char *code_of(const run *r) {
    return bench_text(r->machine, "code");
}

/* A dash where nothing was measured. */
static void put_number(double value, int digits, FILE *to) {
    if (value > 0)
        fprintf(to, " %.*f |", digits, value);
    else
        fputs(" - |", to);
}

/* The line under a table's head. */
static void put_rule(size_t columns, FILE *to) {
    fputs("\n|", to);
    for (size_t i = 0; i < columns; i++)
        fputs("---|", to);
    fputs("\n", to);
}

/* The frames' day, which may be later than the document's. */
static const char *frames_date(const run *r) {
    const char *own = bench_text(json_object_get(r->sections, "frames"), "date");
    return *own ? own : bench_text(r->document, "date");
}

/* A run with fewer scenes, or fewer frames of each, is not shown as a full one. */
static const char *size_of(const run *r) {
    return strcmp(bench_text(r->document, "size"), "full") == 0 ? "" : ", not a full run";
}

/* "AVX2: AVX2 code (haswell) on that processor, ...": never as if it were a processor that has no more. */
static void put_machine(const page *p, const run *r) {
    const char *processor = bench_text(r->machine, "processor"), *compiler = bench_text(r->machine, "compiler");
    fprintf(p->to, "%s: ", code_of(r));
    if (strcmp(code_of(r), bench_text(r->machine, "vectors")) != 0)
        fprintf(p->to, "%s code (%s) on ", code_of(r), bench_text(r->machine, "kernels_for"));
    if (r != p->runs && strcmp(processor, bench_text(p->runs->machine, "processor")) == 0)
        fputs("that processor", p->to);
    else
        fprintf(p->to, "%s, %.0f cores", processor, bench_number(r->machine, "cores"));
    if (strncmp(bench_text(r->device, "name"), "camber ", strlen("camber ")) == 0)
        fprintf(p->to, ", back end cpu by %s", bench_text(r->device, "version"));
    else
        fprintf(p->to, ", PoCL %s", bench_text(r->device, "driver"));
    fprintf(p->to, "%s%s", *compiler ? ", " : "", compiler);
}

static void put_head(const page *p, const run *r) {
    const json_t *gl = json_object_get(r->document, "gl");
    put_machine(p, r);
    if (r == p->runs)
        fprintf(p->to, "; %s, %s; buffers: %s", bench_text(gl, "renderer"), bench_text(gl, "version"),
                bench_text(r->document, "sharing"));
    fprintf(p->to, "; one run of `./dev bench` on %.10s, medians of %.0f in turn, of three where frames take long%s.",
            bench_text(r->document, "date"), bench_number(r->document, "runs"), size_of(r));
}

/* A document may be put together: says which sections were measured on another day. */
static void put_dates(const page *p, const run *r) {
    const size_t day = strlen("2026-01-01");
    const char *date = bench_text(r->document, "date");
    const char *key, *before = " Measured on another day: ";
    json_t *section;
    json_object_foreach((json_t *)r->sections, key, section) {
        const char *own = bench_text(section, "date");
        const bool elsewhere = strcmp(key, "areas") == 0 || strcmp(key, "city") == 0; /* in a block with its own date */
        if (!*own || strncmp(own, date, day) == 0 || elsewhere)
            continue;
        fprintf(p->to, "%s`%s` (%.10s)", before, key, own);
        before = ", ";
    }
    fputs(*before == ',' ? ".\n\n" : "\n\n", p->to);
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

/* ---- Frames: the table of README.md ---- */

/* Puts camber's milliseconds in a scene: a number per run. */
static void put_times(const page *p, const char *section, const char *scene) {
    for (size_t k = 0; k < p->run_count; k++)
        fprintf(p->to, "%s%.1f", k ? "/" : " ", bench_number(find_row(p->runs + k, section, scene), "cl_frame_ms"));
}

/* Puts how many times that a library takes in its best way: a number per run. */
static void put_ratios(const page *p, const char *section, const char *scene, const char *library) {
    for (size_t k = 0; k < p->run_count; k++) {
        const json_t *row = find_row(p->runs + k, section, scene);
        const double ms = bench_best_peer(json_object_get(row, "peers"), library);
        const double ratio = ms / bench_number(row, "cl_frame_ms");
        fputs(k ? "/" : " ", p->to);
        if (ms > 0)
            fprintf(p->to, "%.*f", ratio < 2 ? 2 : 1, ratio);
        else
            fputs("-", p->to);
    }
}

static void put_frame(const page *p, const char *section, const json_t *row) {
    put_times(p, section, bench_text(row, "key"));
    for (size_t k = 0; k < p->library_count; k++) {
        fputs(" |", p->to);
        put_ratios(p, section, bench_text(row, "key"), p->libraries[k]);
    }
    fputs(" |\n", p->to);
}

/* A peer's name and version, and how it was built where the next was built otherwise. */
static void put_peer(const page *p, const run *r, size_t k) {
    const json_t *peer = json_object_get(r->peers, p->libraries[k]);
    const json_t *next = k + 1 < p->library_count ? json_object_get(r->peers, p->libraries[k + 1]) : NULL;
    if (!peer)
        return;
    fprintf(p->to, " %s %s", bench_text(peer, "name"), bench_text(peer, "version"));
    if (*bench_text(peer, "build") && strcmp(bench_text(peer, "build"), bench_text(next, "build")) != 0)
        fprintf(p->to, " (%s)", bench_text(peer, "build"));
    fputs(next ? "," : ".", p->to);
}

/* ---- Best ways ---- */

typedef struct way {
    const char *key;
    size_t scenes; /* that it is the fastest on */
} way;

/* A library's ways that are the fastest on some scene; gives how many. The first is so on the most scenes. */
static size_t find_ways(const run *r, const char *section, const char *library, way *ways) {
    size_t i, count = 0;
    const json_t *row;
    json_array_foreach(rows_of(r, section), i, row) {
        const char *key = bench_best_way(json_object_get(row, "peers"), library);
        size_t k = 0;
        while (k < count && strcmp(ways[k].key, key) != 0)
            k++;
        if (!*key || k == WAYS_MAX)
            continue;
        if (k == count)
            ways[count++] = (way){key, 0};
        if (++ways[k].scenes > ways[0].scenes) {
            const way most = ways[k];
            ways[k] = ways[0];
            ways[0] = most;
        }
    }
    return count;
}

static void put_scenes(const page *p, const run *r, const char *section, const char *library, const char *key) {
    const char *before = " on ";
    size_t i;
    const json_t *row;
    json_array_foreach(rows_of(r, section), i, row) {
        if (strcmp(bench_best_way(json_object_get(row, "peers"), library), key) != 0)
            continue;
        fprintf(p->to, "%s%s", before, bench_text(row, "scene"));
        before = ", ";
    }
}

/* "Blend2D: threads, one path, but one thread, one path on New York." false: it has one way. */
static bool put_ways(const page *p, const run *r, const char *section, const char *library, const char *before) {
    way ways[WAYS_MAX];
    const size_t count = find_ways(r, section, library, ways);
    if (count == 0 || !*bench_text(json_object_get(r->peers, ways[0].key), "way"))
        return false;
    fprintf(p->to, "%s%s: ", before, bench_text(json_object_get(r->peers, library), "name"));
    for (size_t k = 0; k < count; k++) {
        fprintf(p->to, "%s%s", k ? ", but " : "", bench_text(json_object_get(r->peers, ways[k].key), "way"));
        if (k > 0)
            put_scenes(p, r, section, library, ways[k].key);
    }
    return true;
}

static void put_best_ways(const page *p, const run *r, const char *section, const char *of) {
    const char *before = of;
    for (size_t k = 0; k < p->library_count; k++)
        if (put_ways(p, r, section, p->libraries[k], before))
            before = "; ";
    fputs(*before == ';' ? "." : "", p->to);
}

/* Puts the columns of a table whose first one is of scenes. */
static void put_columns(const page *p, const char *first) {
    fputs(first, p->to);
    for (size_t k = 0; k < p->library_count; k++)
        fprintf(p->to, " %s |", bench_text(json_object_get(p->runs->peers, p->libraries[k]), "name"));
    put_rule(2 + p->library_count, p->to);
}

/* Explains "3.1/2.4". */
static void put_codes(const page *p) {
    for (size_t k = 0; k < p->run_count && p->run_count > 1; k++)
        fprintf(p->to, "%s%s", k ? "/" : " Pairs: ", code_of(p->runs + k));
    fputs(p->run_count > 1 ? " code." : "", p->to);
}

/* Whether a run has the peers of the first one, built alike. */
static bool has_same_peers(const page *p, const run *r) {
    return r != p->runs && json_equal(r->peers, p->runs->peers);
}

static void put_frames(const page *p) {
    size_t i;
    const json_t *row;
    put_columns(p, "| scene | camber: ms |");
    json_array_foreach(rows_of(p->runs, "frames"), i, row) {
        fprintf(p->to, "| %s, %g px |", bench_text(row, "scene"), bench_number(row, "width_px"));
        put_frame(p, "frames", row);
    }
    json_array_foreach(rows_of(p->runs, "areas"), i, row) {
        fprintf(p->to, "| areas: %s |", bench_text(row, "scene"));
        put_frame(p, "areas", row);
    }
    fprintf(p->to,
            "\nFrames of %d x %d px on all cores, every point, from lines or rings in memory to pixels in memory. "
            "Others: time relative to camber, below 1 if they are faster, each in its [best way](docs/performance.md).",
            BENCH_SIDE_PX, BENCH_SIDE_PX);
    put_codes(p);
    fputs("\n", p->to);
    for (i = 0; i < p->run_count; i++) {
        const run *r = p->runs + i;
        fputs("\n", p->to);
        put_machine(p, r);
        fprintf(p->to, ", %.10s%s.", frames_date(r), size_of(r));
        for (size_t k = 0; k < p->library_count && !has_same_peers(p, r); k++)
            put_peer(p, r, k);
        fputs("\n", p->to);
    }
}

/* ---- Against each library ---- */

/* Puts the least, the greatest and the geometric mean of how many times that a library takes in a section's scenes. */
static void put_mean(const page *p, const run *r, const char *section, const char *library) {
    double logarithms = 0, least = INFINITY, most = 0;
    size_t i, count = 0;
    const json_t *row;
    json_array_foreach(rows_of(r, section), i, row) {
        const double ratio = bench_best_peer(json_object_get(row, "peers"), library) / bench_number(row, "cl_frame_ms");
        if (!(ratio > 0))
            continue;
        logarithms += log(ratio);
        least = fmin(least, ratio);
        most = fmax(most, ratio);
        count++;
    }
    if (count > 0)
        fprintf(p->to, " %.2f to %.2f, %.2f |", least, most, exp(logarithms / (double)count));
    else
        fputs(" - |", p->to);
}

static void put_means(const page *p) {
    static const char *const sections[] = {"frames", "areas"}, *const names[] = {"lines", "areas"};
    fputs("### Against each library\n\n| times as long as camber |", p->to);
    for (size_t k = 0; k < p->run_count; k++)
        for (size_t s = 0; s < 2; s++)
            fprintf(p->to, " %s: %s |", code_of(p->runs + k), names[s]);
    put_rule(1 + 2 * p->run_count, p->to);
    for (size_t i = 0; i < p->library_count; i++) {
        fprintf(p->to, "| %s |", bench_text(json_object_get(p->runs->peers, p->libraries[i]), "name"));
        for (size_t k = 0; k < p->run_count; k++)
            for (size_t s = 0; s < 2; s++)
                put_mean(p, p->runs + k, sections[s], p->libraries[i]);
        fputs("\n", p->to);
    }
    fputs("\nWhole frames, each library in its best way in each scene: the least, the greatest, and the geometric "
          "mean.\n\n",
          p->to);
}

/* ---- Frames with fewer points ---- */

static void put_pair(const page *p, const json_t *row, const char *all, const char *simple) {
    put_number(bench_number(row, all), 1, p->to);
    put_number(bench_number(row, simple), 1, p->to);
}

static void put_simplified(const page *p) {
    size_t i;
    const json_t *row;
    fputs("### Frames with fewer points\n\n| whole frames, ms |", p->to);
    for (size_t k = 0; k < p->run_count; k++)
        fprintf(p->to, " %s: kernels | at 0.1 px |", code_of(p->runs + k));
    fprintf(p->to, " %s: GL | at 0.1 px |", code_of(p->runs));
    put_rule(2 * p->run_count + 3, p->to);
    json_array_foreach(rows_of(p->runs, "frames"), i, row) {
        fprintf(p->to, "| %s, %g px |", bench_text(row, "scene"), bench_number(row, "width_px"));
        for (size_t k = 0; k < p->run_count; k++)
            put_pair(p, find_row(p->runs + k, "frames", bench_text(row, "key")), "cl_frame_ms", "cl_simple_frame_ms");
        put_pair(p, row, "frame_ms", "simple_frame_ms");
        fputs("\n", p->to);
    }
    fprintf(p->to,
            "\nEvery point, and what is left when points that lie closer than %g px to the line are dropped, which is "
            "the tool's default. %d x %d px, round joins, butt caps, black on white.\n\n",
            BENCH_SIMPLIFY_PX, BENCH_SIDE_PX, BENCH_SIDE_PX);
}

/* ---- Tessellation ---- */

/* Segments, the share of memcpy's bytes, and points from culling to emit: of a scene in a run. */
static void put_speeds(const page *p, const run *r, const char *scene) {
    const json_t *wide = find_stages(r, scene, 8), *all = json_object_get(wide, "all");
    put_number(bench_number(wide, "m_segments_s"), 0, p->to);
    fprintf(p->to, " %.1f, %.0f %% |", bench_number(all, "gb_s"), 100 * bench_number(all, "share"));
    put_number(bench_number(find_network(r, scene), "m_points_s"), 0, p->to);
}

static void put_tessellation(const page *p) {
    size_t i;
    const json_t *row;
    fputs("### Tessellation\n\n| strip, 8 px | bytes a segment | at 2 px |", p->to);
    for (size_t k = 0; k < p->run_count; k++)
        fprintf(p->to, " %s: M/s | GB/s | cull to emit |", code_of(p->runs + k));
    put_rule(3 * p->run_count + 3, p->to);
    json_array_foreach(rows_of(p->runs, "frames"), i, row) {
        const char *scene = bench_text(row, "key");
        fprintf(p->to, "| %s |", bench_text(row, "scene"));
        put_number(bench_number(find_stages(p->runs, scene, 8), "bytes_a_segment"), 1, p->to);
        put_number(bench_number(find_stages(p->runs, scene, 2), "bytes_a_segment"), 1, p->to);
        for (size_t k = 0; k < p->run_count; k++)
            put_speeds(p, p->runs + k, scene);
        fputs("\n", p->to);
    }
    fputs("\nclassify, scan and emit with input and output on the device. M/s: million segments a second. GB/s: bytes "
          "read and written, and their "
          "share of what memcpy of 16 MB on as many threads reaches in the same run,",
          p->to);
    for (size_t k = 0; k < p->run_count; k++)
        fprintf(p->to, "%s %.1f", k ? " and" : "",
                bench_number(json_array_get(rows_of(p->runs + k, "stages"), 0), "memcpy_gb_s"));
    fputs(". Bytes: the whole mesh. Cull to emit: million points a second of the network, every point kept, at the "
          "scene's width, "
          "the host's work included.\n\n",
          p->to);
}

/* ---- The rest ---- */

static double median_of(const json_t *row, const char *step) {
    return bench_number(json_object_get(row, step), "p50_ms");
}

static void put_fly(const page *p) {
    size_t i;
    const json_t *row;
    if (json_array_size(rows_of(p->runs, "fly")) == 0)
        return;
    fputs("### A fly-through\n\n| drawn by | median, ms | 99 of 100 within | scene | tessellate | draw | read "
          "back |\n"
          "|---|---|---|---|---|---|---|\n",
          p->to);
    json_array_foreach(rows_of(p->runs, "fly"), i, row) {
        const json_t *frame = json_object_get(row, "frame");
        fprintf(p->to, "| %s | %.1f | %.1f | %.1f | %.1f | %.1f | %.1f |\n",
                strcmp(bench_text(row, "by"), "cl") == 0 ? "kernels" : "GL", bench_number(frame, "p50_ms"),
                bench_number(frame, "p99_ms"), median_of(row, "scene"), median_of(row, "tessellate"),
                median_of(row, "draw"), median_of(row, "read"));
    }
    row = json_array_get(rows_of(p->runs, "fly"), 0);
    fprintf(
        p->to,
        "\n%s in the built-in style, %.0f frames of %.0f x %.0f px, pan and zoom. The last four columns are medians "
        "of the steps.\n\n",
        bench_text(row, "city"), bench_number(row, "frames"), bench_number(row, "width"), bench_number(row, "height"));
}

/* ---- Areas: the table of docs/areas.md ---- */

static void put_errors(const page *p, const json_t *row) {
    const json_t *peers = json_object_get(row, "peers");
    fprintf(p->to, "| %s | %.3f |", bench_text(row, "scene"), bench_number(row, "error"));
    for (size_t k = 0; k < p->library_count; k++)
        fprintf(p->to, " %.3f |",
                bench_number(json_object_get(peers, bench_best_way(peers, p->libraries[k])), "error"));
    fputs("\n", p->to);
}

static void put_cities(const page *p) {
    size_t i;
    const json_t *row;
    json_array_foreach(rows_of(p->runs, "city"), i, row)
        fprintf(p->to, "%s %s in %.1f ms, Mapnik in %.1f times that",
                i ? ";" : " The style city, areas and lines, beside Mapnik by stripes:", bench_text(row, "scene"),
                bench_number(row, "cl_frame_ms"), bench_number(row, "mapnik_ms") / bench_number(row, "cl_frame_ms"));
    fputs(i > 0 ? "." : "", p->to);
}

static void put_glyphs(const page *p) {
    const char *before = " A million rings of 40 edges, 12 px high, as glyphs are, by one thread:";
    for (size_t k = 0; k < p->run_count; k++) {
        const json_t *row = json_array_get(rows_of(p->runs + k, "glyphs"), 0);
        const double ms = bench_number(row, "million_ms"), theirs = bench_number(row, "freetype_ms");
        if (!row)
            continue;
        fprintf(p->to, "%s %s code %.0f ms, FreeType's smooth rasterizer (%s) %.0f, which is %.2f times as long",
                before, code_of(p->runs + k), ms, bench_text(row, "version"), theirs, theirs / ms);
        before = ";";
    }
    fputs(*before == ';' ? "." : "", p->to);
}

static void put_areas(const page *p) {
    size_t i;
    const json_t *row;
    put_columns(p, "| areas | camber: ms |");
    json_array_foreach(rows_of(p->runs, "areas"), i, row) {
        fprintf(p->to, "| %s, %.0f edges |", bench_text(row, "scene"), bench_number(row, "edges"));
        put_frame(p, "areas", row);
    }
    put_columns(p, "\n| error | camber |");
    json_array_foreach(rows_of(p->runs, "areas"), i, row) put_errors(p, row);
    fputs("\nFrames of 2048 x 2048 px, all areas black, from rings in memory to pixels in memory. Other columns: time "
          "relative to camber, below 1 if they are faster, each library in its best way. Errors: the mean beside "
          "16 x 16 samples a pixel, of 255.",
          p->to);
    put_codes(p);
    put_cities(p);
    put_glyphs(p);
    for (size_t k = 0; k < p->run_count; k++) {
        fputs("\n\n", p->to);
        put_machine(p, p->runs + k);
        fprintf(p->to, ", %.10s.", bench_text(json_object_get(p->runs[k].sections, "areas"), "date"));
    }
    fputs("\n", p->to);
}

static void put_textures(const page *p) {
    size_t i;
    const json_t *row;
    if (json_array_size(rows_of(p->runs, "textures")) == 0)
        return;
    fputs("### Frames into textures\n\n| ms | rows, no GL | texture, zero copy | texture, copy | drawn by GL |\n"
          "|---|---|---|---|---|\n",
          p->to);
    json_array_foreach(rows_of(p->runs, "textures"), i, row)
        fprintf(p->to, "| %s, %g px | %.1f | %.1f | %.1f | %.1f |\n", bench_text(row, "scene"),
                bench_number(row, "width_px"), bench_number(row, "rows_ms"), bench_number(row, "zero_copy_ms"),
                bench_number(row, "copy_ms"), bench_number(row, "gl_ms"));
    fputs("\nThe same scenes, every point: rows of pixels handed over; a frame in a texture of the caller's GL "
          "context, by "
          "either sharing path; and a frame that GL draws into it.\n\n",
          p->to);
}

static const char *growth_of(const char *key) {
    static const char *const names[][2] = {{"points", "points of a walk"},
                                           {"pixels", "the picture"},
                                           {"tile", "lines in one tile"},
                                           {"line", "points of one line"}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(key, names[i][0]) == 0)
            return names[i][1];
    return key;
}

static void put_growth(const page *p) {
    size_t i;
    const json_t *row;
    if (json_array_size(rows_of(p->runs, "growth")) == 0)
        return;
    fputs("### Growth\n\n| what grows | points | side, px | ms a frame | ns each | cores at work |\n"
          "|---|---|---|---|---|---|\n",
          p->to);
    json_array_foreach(rows_of(p->runs, "growth"), i, row) {
        fprintf(p->to, "| %s |", growth_of(bench_text(row, "key")));
        put_count(bench_number(row, "points"), p->to);
        fprintf(p->to, " %.0f | %.1f | %.1f | %.1f |\n", bench_number(row, "side_px"), bench_number(row, "frame_ms"),
                bench_number(row, "ns"), bench_number(row, "cores"));
    }
    fputs("\nWalks 2 px wide, drawn by kernels. ns each: of a point, or of a pixel where the picture grows.\n\n",
          p->to);
}

static void put_mosaic(const page *p) {
    const json_t *result = json_object_get(p->runs->sections, "mosaic"), *rows = bench_result_rows(result);
    const json_t *last = json_array_get(rows, json_array_size(rows) - 1);
    if (!last)
        return;
    fprintf(p->to,
            "### A mosaic, and starting\n\nA mosaic of %.3g million points (copies of %s): %.2f s a frame, %.2f s with "
            "every "
            "point; peak memory %.2f "
            "and %.2f GB. From %.0f points on, a point costs at most %.2f times (every point drawn: %.2f times) what "
            "it costs "
            "in any smaller mosaic:\n\n"
            "![What a point costs, by the number of points](../%s.svg)\n\n",
            bench_number(last, "points") / 1e6, bench_text(last, "city"),
            bench_number(json_object_get(last, "simple"), "frame_ms") / 1e3,
            bench_number(json_object_get(last, "everything"), "frame_ms") / 1e3, bench_number(last, "peak_bytes") / 1e9,
            bench_number(last, "everything_peak_bytes") / 1e9, bench_number(json_array_get(rows, 0), "points"),
            bench_number(result, "simple_growth"), bench_number(result, "everything_growth"), p->runs->results);
}

static void put_start(const page *p) {
    size_t i;
    const json_t *row;
    const char *before = "Wall time of the whole program, first with empty caches and then with warm ones: ";
    json_array_foreach(rows_of(p->runs, "start"), i, row) {
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
    before = ".\n\nRows and figures: ";
    for (i = 0; i < p->run_count; i++, before = ", ")
        fprintf(p->to, "%s[`%s.json`](../%s.json)", before, p->runs[i].results, p->runs[i].results);
    fputs(".\n", p->to);
}

static void put_measured(const page *p) {
    for (size_t i = 0; i < p->run_count; i++) {
        put_head(p, p->runs + i);
        put_best_ways(p, p->runs + i, "frames", " Best ways of ");
        put_best_ways(p, p->runs + i, "areas", " For areas, ");
        put_dates(p, p->runs + i);
    }
    put_means(p);
    put_simplified(p);
    put_tessellation(p);
    if (p->run_count > 1)
        fprintf(p->to, "All that follows: %s.\n\n", code_of(p->runs));
    put_fly(p);
    put_textures(p);
    put_growth(p);
    put_mosaic(p);
    put_start(p);
}

/* Libraries of the first run, whose peers' columns the others share. */
static void read_libraries(page *p) {
    const char *key;
    json_t *peer;
    json_object_foreach((json_t *)p->runs->peers, key, peer) if (!strchr(key, '_') && p->library_count < LIBRARIES_MAX)
        p->libraries[p->library_count++] = key;
}

/* ---- Between the markers ---- */

static const struct block {
    const char *begin, *end;
    void (*put)(const page *p);
} blocks[] = {
    {"<!-- frames: made by ./dev bench --readme -->\n", "<!-- /frames -->\n", put_frames},
    {"<!-- areas: made by ./dev bench --readme -->\n", "<!-- /areas -->\n", put_areas},
    {"<!-- measured: made by ./dev bench --readme -->\n", "<!-- /measured -->\n", put_measured},
};

enum { BLOCKS = sizeof blocks / sizeof *blocks };

/* Writes a line of prose as lines of at most LINE_COLUMNS, broken at spaces. */
static void wrap_prose(const char *line, size_t size, FILE *to) {
    while (size > LINE_COLUMNS) {
        size_t cut = LINE_COLUMNS;
        while (cut > 0 && line[cut] != ' ')
            cut--;
        if (cut == 0)
            break;
        fprintf(to, "%.*s\n", (int)cut, line);
        line += cut + 1;
        size -= cut + 1;
    }
    fprintf(to, "%.*s\n", (int)size, line);
}

/* Tables, headings and pictures keep their lines. */
static void wrap_text(const char *text, FILE *to) {
    for (const char *end; *text && (end = strchr(text, '\n')) != NULL; text = end + 1) {
        if (strchr("|#!", *text))
            fprintf(to, "%.*s\n", (int)(end - text), text);
        else
            wrap_prose(text, (size_t)(end - text), to);
    }
}

/* Writes the block's text as it is now. false: memory ran out. */
static bool put_block(const struct block *block, page *p, FILE *to) {
    char *text = NULL;
    size_t size = 0;
    p->to = open_memstream(&text, &size);
    if (!p->to)
        return false;
    block->put(p);
    const bool done = fclose(p->to) == 0;
    if (done)
        wrap_text(text, to);
    free(text);
    return done;
}

/* Writes text with what lies between markers made anew. Gives how many blocks it has; below 0: memory ran out. */
static int put_file(const char *text, page *p, FILE *to) {
    int found = 0;
    for (size_t i = 0; i < BLOCKS; i++) {
        const struct block *block = blocks + i;
        const char *begin = strstr(text, block->begin), *end = begin ? strstr(begin, block->end) : NULL;
        if (!end)
            continue;
        begin += strlen(block->begin);
        fwrite(text, 1, (size_t)(begin - text), to);
        if (!put_block(block, p, to))
            return -1;
        text = end;
        found++;
    }
    fputs(text, to);
    return found;
}

/* text: the file as it was. */
static bool rewrite(page *p, const char *text, const char *path) {
    char *made = NULL;
    size_t size = 0;
    FILE *to = open_memstream(&made, &size);
    if (!to)
        return false;
    const int found = put_file(text, p, to);
    bool done = fclose(to) == 0 && found > 0;
    FILE *file = done ? fopen(path, "w") : NULL;
    if (file) {
        done = fwrite(made, 1, size, file) == size;
        done = fclose(file) == 0 && done;
    }
    free(made);
    return file && done;
}

/* false: a document cannot be read. */
static bool read_runs(page *p, char *const *results, size_t count) {
    for (; p->run_count < count && p->run_count < RUNS_MAX; p->run_count++) {
        run *r = p->runs + p->run_count;
        if (!(r->document = bench_document_load(results[p->run_count])))
            return false;
        r->sections = json_object_get(r->document, "sections");
        r->peers = json_object_get(r->document, "peers");
        r->machine = json_object_get(r->document, "machine");
        r->device = json_object_get(r->document, "device");
        snprintf(r->results, sizeof r->results, "%s", results[p->run_count]);
        char *ending = strstr(r->results, ".json");
        if (ending)
            *ending = 0;
    }
    read_libraries(p);
    return true;
}

static bool rewrite_file(page *p, const char *path) {
    camber_context *context = NULL;
    char *text = NULL;
    size_t size = 0;
    const bool done = camber_context_create(NULL, &context) == CAMBER_OK &&
                      camber_read_file(context, path, CAMBER_NAMED_BY_CALLER, &text, &size) == CAMBER_OK &&
                      rewrite(p, text, path);
    if (!done)
        fprintf(stderr, "camber_bench: %s: cannot be written, or lacks one of the lines\n%s%s%s", path, blocks[0].begin,
                blocks[1].begin, blocks[2].begin);
    if (context)
        camber_free(context, text);
    camber_context_destroy(context);
    return done;
}

bool bench_readme_write(char *const *results, size_t count, const char *path) {
    page p = {.run_count = 0};
    const bool done = read_runs(&p, results, count) && rewrite_file(&p, path);
    for (size_t i = 0; i < RUNS_MAX; i++)
        json_decref(p.runs[i].document);
    return done;
}
