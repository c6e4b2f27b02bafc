/* The numbers of README.md and docs/performance.md, so that nobody types them.
 *
 * Input: the JSON document of a benchmark. Output: a text file, rewritten between pairs of markers. There are two
 * blocks: "frames" is the one table of README.md, "measured" is everything else. A file may hold either or both. Prose
 * is wrapped at LINE_COLUMNS columns, as all documents are. */
#include "bench.h"

#include "base/base.h"

#include <stdlib.h>
#include <string.h>

enum { LIBRARIES_MAX = 8, LINE_COLUMNS = 118 };

typedef struct page {
    const json_t *document, *sections, *peers;
    const char *libraries[LIBRARIES_MAX]; /* keys of peers, the first of each library */
    size_t library_count;
    const char *results; /* path of the document without its ending, from the repository's root */
    FILE *to;
} page;

static const json_t *rows_of(const page *p, const char *section) {
    return bench_result_rows(json_object_get(p->sections, section));
}

/* From culling to emit: the row of a scene with every point. */
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

static void put_head(const page *p) {
    const json_t *device = json_object_get(p->document, "device"), *gl = json_object_get(p->document, "gl");
    fprintf(p->to,
            "One run of `./dev bench` on %.10s: %s, %.0f units, %s %s; %s, %s; buffers: %s. Medians of %.0f runs in "
            "turn.\n\n",
            bench_text(p->document, "date"), bench_text(device, "name"), bench_number(device, "units"),
            bench_text(device, "platform"), bench_text(device, "driver"), bench_text(gl, "renderer"),
            bench_text(gl, "version"), bench_text(p->document, "sharing"), bench_number(p->document, "runs"));
}

/* A document may be put together: says which sections were measured on another day. */
static void put_dates(const page *p) {
    const size_t day = strlen("2026-01-01");
    const char *date = bench_text(p->document, "date");
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

/* ---- Frames: the table of README.md ---- */

/* The day on which the frames were measured, which may be later than the document's. */
static const char *frames_date(const page *p) {
    const char *own = bench_text(json_object_get(p->sections, "frames"), "date");
    return *own ? own : bench_text(p->document, "date");
}

static void put_frame(const page *p, const json_t *row) {
    const double frame_ms = bench_number(row, "cl_frame_ms");
    fprintf(p->to, "| %s, %g px |", bench_text(row, "scene"), bench_number(row, "width_px"));
    put_count(bench_number(row, "segments"), p->to);
    fprintf(p->to, " %.1f | %.1f |", frame_ms, bench_number(row, "frame_ms"));
    for (size_t k = 0; k < p->library_count; k++) {
        const double ms = bench_best_peer(json_object_get(row, "peers"), p->libraries[k]);
        if (ms > 0)
            fprintf(p->to, " %.*f (%.1f) |", ms < 1000 ? 1 : 0, ms, ms / frame_ms);
        else
            fputs(" - |", p->to);
    }
    fputs("\n", p->to);
}

static void put_frames(const page *p) {
    const json_t *device = json_object_get(p->document, "device");
    size_t i;
    const json_t *row;
    fputs("| scene | segments | camber | in GL |", p->to);
    for (size_t k = 0; k < p->library_count; k++)
        fprintf(p->to, " %s |", bench_text(json_object_get(p->peers, p->libraries[k]), "name"));
    fputs("\n|---|---|---|---|", p->to);
    for (size_t k = 0; k < p->library_count; k++)
        fputs("---|", p->to);
    fputs("\n", p->to);
    json_array_foreach(rows_of(p, "frames"), i, row) put_frame(p, row);
    fprintf(
        p->to,
        "\nMilliseconds a frame of %d x %d px, from lines in memory to pixels in memory; in brackets how many times "
        "camber's first figure. camber: OpenCL kernels on a CPU; in GL: GLES on %s. Peers:",
        BENCH_SIDE_PX, BENCH_SIDE_PX, bench_text(json_object_get(p->document, "gl"), "renderer"));
    for (size_t k = 0; k < p->library_count; k++) {
        const json_t *peer = json_object_get(p->peers, p->libraries[k]);
        fprintf(p->to, "%s %s %s", k ? "," : "", bench_text(peer, "name"), bench_text(peer, "version"));
    }
    fprintf(
        p->to,
        "; one thread each, but where it says threads. Measured on %.10s: %s, %.0f units, %s %s, medians of %.0f runs "
        "in turn.\n",
        frames_date(p), bench_text(device, "name"), bench_number(device, "units"), bench_text(device, "platform"),
        bench_text(device, "driver"), bench_number(p->document, "runs"));
}

/* ---- Frames with fewer points ---- */

static void put_simplified(const page *p) {
    size_t i;
    const json_t *row;
    fputs("### Frames with fewer points\n\n| whole frames, ms | OpenCL | at 0.1 px | GL | at 0.1 px "
          "|\n|---|---|---|---|---|\n",
          p->to);
    json_array_foreach(rows_of(p, "frames"), i, row) fprintf(
        p->to, "| %s, %g px | %.1f | %.1f | %.1f | %.1f |\n", bench_text(row, "scene"), bench_number(row, "width_px"),
        bench_number(row, "cl_frame_ms"), bench_number(row, "cl_simple_frame_ms"), bench_number(row, "frame_ms"),
        bench_number(row, "simple_frame_ms"));
    fprintf(p->to,
            "\nEvery point, and what is left when points that lie closer than %g px to the line are dropped, which is "
            "the tool's default. %d x %d px, round joins, butt caps, black on white.\n\n",
            BENCH_SIMPLIFY_PX, BENCH_SIDE_PX, BENCH_SIDE_PX);
}

/* ---- Tessellation ---- */

static void put_tessellation(const page *p) {
    size_t i;
    const json_t *row;
    fputs(
        "### Tessellation\n\n| strip, 8 px wide | M segments/s | GB/s | share of memcpy's | bytes a segment | at 2 px "
        "| cull to emit, M points/s |\n|---|---|---|---|---|---|---|\n",
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
    fprintf(
        p->to,
        "\nclassify, scan and emit with input and output on the device. GB/s: bytes read and written; memcpy of 16 "
        "MB on as many threads reaches %.1f GB/s in the same run. Bytes: the whole mesh. Cull to emit: points of the "
        "network, every point kept, at the scene's width, the host's work included.\n\n",
        bench_number(json_array_get(rows_of(p, "stages"), 0), "memcpy_gb_s"));
}

/* ---- The rest ---- */

static double median_of(const json_t *row, const char *step) {
    return bench_number(json_object_get(row, step), "p50_ms");
}

static void put_fly(const page *p) {
    size_t i;
    const json_t *row;
    if (json_array_size(rows_of(p, "fly")) == 0)
        return;
    fputs("### A fly-through\n\n| drawn by | median, ms | 99 of 100 within | scene | tessellate | draw | read "
          "back |\n"
          "|---|---|---|---|---|---|---|\n",
          p->to);
    json_array_foreach(rows_of(p, "fly"), i, row) {
        const json_t *frame = json_object_get(row, "frame");
        fprintf(p->to, "| %s | %.1f | %.1f | %.1f | %.1f | %.1f | %.1f |\n",
                strcmp(bench_text(row, "by"), "cl") == 0 ? "OpenCL" : "GL", bench_number(frame, "p50_ms"),
                bench_number(frame, "p99_ms"), median_of(row, "scene"), median_of(row, "tessellate"),
                median_of(row, "draw"), median_of(row, "read"));
    }
    row = json_array_get(rows_of(p, "fly"), 0);
    fprintf(
        p->to,
        "\n%s in the built-in style, %.0f frames of %.0f x %.0f px, pan and zoom. The last four columns are medians "
        "of the steps.\n\n",
        bench_text(row, "city"), bench_number(row, "frames"), bench_number(row, "width"), bench_number(row, "height"));
}

static void put_textures(const page *p) {
    size_t i;
    const json_t *row;
    if (json_array_size(rows_of(p, "textures")) == 0)
        return;
    fputs("### Frames into textures\n\n| ms | rows, no GL | texture, zero copy | texture, copy | drawn by GL |\n"
          "|---|---|---|---|---|\n",
          p->to);
    json_array_foreach(rows_of(p, "textures"), i, row)
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
    if (json_array_size(rows_of(p, "growth")) == 0)
        return;
    fputs("### Growth in OpenCL\n\n| what grows | points | side, px | ms a frame | ns each | cores at work |\n"
          "|---|---|---|---|---|---|\n",
          p->to);
    json_array_foreach(rows_of(p, "growth"), i, row) {
        fprintf(p->to, "| %s |", growth_of(bench_text(row, "key")));
        put_count(bench_number(row, "points"), p->to);
        fprintf(p->to, " %.0f | %.1f | %.1f | %.1f |\n", bench_number(row, "side_px"), bench_number(row, "frame_ms"),
                bench_number(row, "ns"), bench_number(row, "cores"));
    }
    fputs("\nWalks 2 px wide, drawn by kernels. ns each: of a point, or of a pixel where the picture grows.\n\n",
          p->to);
}

static void put_mosaic(const page *p) {
    const json_t *result = json_object_get(p->sections, "mosaic"), *rows = bench_result_rows(result);
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
    fprintf(p->to, ".\n\nEverything measured: [`%s.json`](../%s.json).\n", p->results, p->results);
}

static void put_measured(const page *p) {
    put_head(p);
    put_dates(p);
    put_simplified(p);
    put_tessellation(p);
    put_fly(p);
    put_textures(p);
    put_growth(p);
    put_mosaic(p);
    put_start(p);
}

static void read_peers(page *p) {
    const char *key;
    json_t *peer;
    json_object_foreach((json_t *)p->peers, key, peer) if (!strchr(key, '_') && p->library_count < LIBRARIES_MAX)
        p->libraries[p->library_count++] = key;
}

/* ---- Between the markers ---- */

static const struct block {
    const char *begin, *end;
    void (*put)(const page *p);
} blocks[] = {
    {"<!-- frames: made by ./dev bench --readme -->\n", "<!-- /frames -->\n", put_frames},
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

bool bench_readme_write(const json_t *document, const char *json_path, const char *path) {
    camber_context *context = NULL;
    char results[512], *text = NULL;
    size_t size = 0;
    snprintf(results, sizeof results, "%s", json_path);
    char *ending = strstr(results, ".json");
    if (ending)
        *ending = 0;
    page p = {.document = document,
              .sections = json_object_get(document, "sections"),
              .peers = json_object_get(document, "peers"),
              .results = results};
    read_peers(&p);
    const bool done = camber_context_create(NULL, &context) == CAMBER_OK &&
                      camber_read_file(context, path, CAMBER_NAMED_BY_CALLER, &text, &size) == CAMBER_OK &&
                      rewrite(&p, text, path);
    if (!done)
        fprintf(stderr, "camber_bench: %s: cannot be written, or lacks one of the lines\n%s%s", path, blocks[0].begin,
                blocks[1].begin);
    if (context)
        camber_free(context, text);
    camber_context_destroy(context);
    return done;
}
