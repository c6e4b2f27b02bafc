/* The benchmark: sections that measure, each into rows and figures of one JSON document, from which tables, plots,
 * comparisons and the numbers of the documents are made. */
#ifndef CAMBER_BENCH_BENCH_H
#define CAMBER_BENCH_BENCH_H

#include "camber_files.h"
#include "camber_network.h"
#include "peers/peer.h"
#include "validate/fixture.h"

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

enum { BENCH_SCENES_MAX = 8, BENCH_RUNS_MAX = 16 };

/* Simplified frames leave out detail that they cannot show: points this close to the line without them. */
#define BENCH_SIMPLIFY_PX 0.1

typedef enum bench_size {
    BENCH_FULL = 0,
    BENCH_QUICK, /* about a minute */
    BENCH_TINY,  /* seconds: scenes too small to mean anything, to see that it runs */
} bench_size;

/* Polylines in pixels of a BENCH_SIDE_PX square, as every renderer gets them. */
typedef struct bench_scene {
    const char *key, *name; /* "porto", "Porto" */
    camber_lines lines;
    size_t segments;
    float width_px;
    uint32_t *areas; /* as bench_peer_frame has them. NULL: lines */
    size_t area_count;
} bench_scene;

typedef struct bench {
    camber_context *context;
    camber_fixture opened; /* which has the next four */
    camber_surface *surface;
    camber_device *device;
    camber_renderer *renderer; /* GL */
    camber_renderer *cl_renderer;
    camber_mesh *mesh;    /* that GL draws */
    camber_mesh *cl_mesh; /* that kernels draw */
    bench_size size;
    size_t warm_ups, runs;          /* up to BENCH_RUNS_MAX */
    const char *data;               /* the folder that has data/ with the larger cities, or NULL */
    const char *program, *tool;     /* paths of camber_bench and camber */
    uint32_t fly_width, fly_height; /* px, of the fly-through */
    bool avx2_only;                 /* nothing that is compiled as it runs may need more than AVX2 */
    double country_millions;        /* points of the country that is read; 0: by the size */
    uint8_t *picture, *pictured;    /* a square each, RGBA: camber's, a peer's */
    bench_scene scenes[BENCH_SCENES_MAX];
    size_t scene_count;
} bench;

/* ---- frame.c: camber at work ---- */

bool bench_open(bench *b);
void bench_close(bench *b);

typedef struct bench_frame_desc {
    const camber_lines *lines; /* everything is drawn; or else */
    const bench_scene *areas;  /* all of them; or else */
    camber_network *network;   /* what the camera sees of it */
    camber_camera camera;
    float width_px;
    camber_overlap overlap;
    bool in_cl;       /* drawn by kernels, else by GL */
    uint8_t *picture; /* NULL: not read back */
} bench_frame_desc;

typedef struct bench_frame_times {
    double frame_ms; /* from lines in memory, or the network on the device, to pixels in memory */
    double tessellate_ms;
    double draw_ms; /* clear, draw, finish */
    double cpu_ms;  /* of the frame, on all threads */
} bench_frame_times;

camber_status bench_frame(bench *b, const bench_frame_desc *desc, bench_frame_times *times);

/* Takes the rows of a picture of BENCH_SIDE_PX. Rows that are handed over are pixels in memory: to keep them is the
 * bench's own business, so the time of that is told, and left out. */
typedef struct bench_taking {
    uint8_t *picture;
    double kept_ms, kept_cpu_ms;
} bench_taking;

bool bench_take_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count);

/* Polylines in world coordinates, pixels of the square: polyline i has the points [offsets[i], offsets[i + 1]). */
typedef struct bench_plane {
    double *points;
    size_t *offsets; /* polyline_count + 1 */
    size_t polyline_count;
} bench_plane;

void bench_plane_free(bench_plane *plane);
/* With the importance of each point weighed, as a map has it once it is read. */
camber_status bench_network_make(bench *b, const bench_plane *plane, camber_network **network);
camber_status bench_network_of_lines(bench *b, const camber_lines *lines, camber_network **network);
/* That sees the square. */
camber_camera bench_camera(double simplify_px);

/* A series of measurements. */
typedef struct bench_series {
    double values[BENCH_RUNS_MAX];
    size_t count;
} bench_series;

void bench_series_add(bench_series *series, double value);
/* 0 of none. */
double bench_series_median(const bench_series *series);

/* GB/s of memcpy at best, bytes read and written: of 16 MB, what a city's mesh comes to, shared out over as many
 * threads as the kernels run on. 0 where it cannot be measured. */
double bench_copy_gb_s(const bench *b);

/* Frames that no peer draws are compared with this: a scene that is the same everywhere, drawn by the first peer that
 * is built in, or else a copy in memory. */
typedef struct bench_yardstick {
    const char *name; /* "Cairo's long walks" */
    double ms;
} bench_yardstick;

bench_yardstick bench_yardstick_measure(bench *b);

/* The peer's frame in b->pictured: milliseconds, below 0 where it failed. */
double bench_peer_draw(const bench *b, const bench_peer *peer, const bench_scene *scene);

enum { BENCH_PEERS_MAX = 24 };

/* Every peer's frames of a scene. */
typedef struct bench_peers_trial {
    bench_series ms[BENCH_PEERS_MAX];
    double warm_ms[BENCH_PEERS_MAX];     /* the last of the frames that do not count; below 0: it failed */
    double differences[BENCH_PEERS_MAX]; /* from the truth, or from camber's picture, of 255; below 0: it failed */
} bench_peers_trial;

/* How far b->pictured is from what a trial compares with. */
typedef double bench_difference_fn(const bench *b, const void *user);

/* Whether a scene's frames go on with that run, the first of which only warm up: b->runs of them, but only three once
 * they have taken BENCH_PATIENCE_MS. */
#define BENCH_PATIENCE_MS 45e3
bool bench_goes_on(const bench *b, size_t run, double begin_ms);

/* Every peer draws a frame. Before frames count, their pictures are compared. Later, a way that took more than 1.3
 * times as long as its library's best one is left out, and that frame is its figure. */
void bench_peers_draw(const bench *b, bench_peers_trial *trial, const bench_scene *scene, bool counts,
                      bench_difference_fn *difference, const void *user);
/* {"cairo": {"ms", what: how far its picture is, "alike"}, ...}. A peer whose picture is farther off than
 * BENCH_DIFFERENCE_MAX draws something else and counts for nothing, which is printed. */
json_t *bench_peers_report(const bench_peers_trial *trial, const bench_scene *scene, const char *what);

/* Mean difference, of 255, over the pixels that either draws on. On Porto those that draw line over line come to 1.3,
 * those that unite all lines to 3.9; an empty picture, of lines 2 px wide or more, comes to more than 100. */
#define BENCH_DIFFERENCE_MAX 20.0

/* ---- machine.c ---- */

/* Whether the kernels are compiled for a processor with AVX2 and no more; says it where they are not. */
bool bench_is_avx2_only(const bench *b);
/* Processor, cores, instructions, compiler, and what of the environment changes them. */
json_t *bench_machine_describe(const bench *b);

/* ---- scenes.c ---- */

/* All that can be made here, or the one of that key. false: none. */
bool bench_scenes_make(bench *b, const char *key);
void bench_scenes_free(bench *b);
/* NULL: not here. */
const bench_scene *bench_scene_find(const bench *b, const char *key);
/* As bench_scenes_make, of areas, for a section of their own. Gives how many there are. */
size_t bench_areas_make(const bench *b, const char *key, bench_scene scenes[BENCH_SCENES_MAX]);
void bench_areas_free(bench_scene *scenes, size_t count);
/* Where the scene's map lies. false: it has none here. */
bool bench_scene_path(const bench *b, const char *key, char *path, size_t size);
/* Lays cities side by side to so many million points, in a file of its own at path, which the caller removes. ending:
 * .osm.pbf or .fgb. false: it cannot be made here. */
bool bench_country_make(const bench *b, double millions, const char *ending, char *path, size_t size);

/* ---- child.c: other processes ---- */

typedef struct bench_child {
    double wall_ms;
    int status;   /* as it exited; -1: it could not be started, or a signal ended it */
    char *output; /* what it printed; free it */
} bench_child;

/* arguments end with NULL; the first is the program. cache_dir is its XDG_CACHE_HOME; NULL: as it is here. input goes
 * to its standard input; NULL: none. */
bench_child bench_child_run(const char *const *arguments, const char *cache_dir, const char *input);

/* ---- Sections ---- */

/* A section's result is {"rows": [...], "figures": [...]}. only: the item to measure, NULL for all. */
typedef struct bench_section {
    const char *name;
    json_t *(*measure)(bench *b, const char *only); /* NULL: the build lacks what it needs, so it has no rows */
    void (*print)(const json_t *result, FILE *to);
} bench_section;

extern const bench_section *const bench_sections[]; /* NULL behind the last */

extern const bench_section bench_section_stages, bench_section_network, bench_section_frames, bench_section_zooms,
    bench_section_mosaic, bench_section_fly, bench_section_textures, bench_section_growth, bench_section_start,
    bench_section_encode, bench_section_read, bench_section_tiles, bench_section_serve, bench_section_areas,
    bench_section_city, bench_section_labels, bench_section_many, bench_section_outside, bench_section_devices,
    bench_section_glyphs;

json_t *bench_result_new(void);
typedef camber_status bench_scene_fn(bench *b, const bench_scene *scene, void *user, json_t *result);
/* Each scene, or the one that only names, into one result. NULL: a scene failed, and the log has told. */
json_t *bench_measure_scenes(bench *b, const char *only, bench_scene_fn *measure, void *user);
/* Takes row. */
void bench_result_add_row(json_t *result, json_t *row);
json_t *bench_result_rows(const json_t *result);

/* A number that two runs can be compared by: never a time, which belongs to its machine, but a ratio to something
 * measured in the same run, or a count of bytes. item: what of the section to measure again. */
typedef struct bench_figure {
    const char *item, *what, *against; /* "porto", "draw at 0.1 px", "Cairo"; against NULL: a count */
    double value;
    bool less; /* is better */
} bench_figure;

/* Left out where the value is not a number above 0. */
void bench_result_add_figure(json_t *result, const bench_figure *figure);

/* Times of a row are kept to a microsecond. */
json_t *bench_ms(double ms);
/* A row's value by its key: 0 or "" where it is not there. */
double bench_number(const json_t *row, const char *key);
const char *bench_text(const json_t *row, const char *key);

/* The key of the fastest of a library's ways to draw, by the row's "peers", of those whose picture is like camber's;
 * "": none. */
const char *bench_best_way(const json_t *peers, const char *library);
/* Its milliseconds; 0: none. */
double bench_best_peer(const json_t *peers, const char *library);

/* One child's part of the mosaic; prints its row. Gives the exit status. */
int bench_mosaic_child(bench *b, size_t points);

/* ---- The document ---- */

/* NULL: it cannot be read; the reason is printed. */
json_t *bench_document_load(const char *path);
/* Copies of a document the rows that tables show and all figures. The document may be such a copy. */
json_t *bench_document_keep(const json_t *document);
bool bench_document_write(const json_t *document, const char *path);
/* Every section measured, or those of a list, "frames,areas:houses", and what on; each is printed as it comes. */
json_t *bench_document_make(bench *b, const char *list);
void bench_document_print(const json_t *document, FILE *to);
/* SVG of the mosaic's curve; false: there is none, or gnuplot is not there, which is said. */
bool bench_plot_mosaic(const json_t *document, const char *path);
/* Measures again what looks like a loss against old, a document that was kept. Gives the losses that stay; -1: the two
 * cannot be compared. */
int bench_compare(bench *b, const json_t *document, const json_t *old, FILE *to);
/* Rewrites the numbers between the markers of a document at path: README.md has the table of frames,
 * docs/performance.md the rest. results: JSON files, each of one kind of processor. false: the document has no such
 * markers, or something cannot be read or written; the reason is printed. */
bool bench_readme_write(char *const *results, size_t count, const char *path);

#endif
