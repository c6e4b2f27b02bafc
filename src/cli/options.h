/* The command line as values. */
#ifndef CAMBER_CLI_OPTIONS_H
#define CAMBER_CLI_OPTIONS_H

#include "camber.h"
#include "camber_files.h"
#include "camber_tiles.h"

#include <stdio.h>

/* Exit statuses. Their values come from sysexits.h, which is not in POSIX, so they are defined here. */
enum {
    CAMBER_EXIT_DONE = 0,
    CAMBER_EXIT_CHECK = 1, /* a check of validate or of tiles verify failed */
    CAMBER_EXIT_USAGE = 2,
    CAMBER_EXIT_DATA = 65,
    CAMBER_EXIT_NO_INPUT = 66,
    CAMBER_EXIT_UNAVAILABLE = 69, /* no usable device or GL back end */
    CAMBER_EXIT_INTERNAL = 70,
    CAMBER_EXIT_CREATE = 73, /* OUT exists or cannot be created */
    CAMBER_EXIT_IO = 74,
};

typedef enum camber_verb {
    CAMBER_VERB_NONE = 0,
    CAMBER_VERB_RENDER,
    CAMBER_VERB_TESSELLATE,
    CAMBER_VERB_COMPARE,
    CAMBER_VERB_VALIDATE,
    CAMBER_VERB_BENCH,
    CAMBER_VERB_INFO,
    CAMBER_VERB_STYLE,
    CAMBER_VERB_TILES,
    CAMBER_VERB_SERVE,
} camber_verb;

/* Formats of OUT, in the order of --help. */
typedef enum camber_format {
    CAMBER_FORMAT_PNG = 0,
    CAMBER_FORMAT_PNG8,
    CAMBER_FORMAT_WEBP,
    CAMBER_FORMAT_GLB,
    CAMBER_FORMAT_PDF,
    CAMBER_FORMAT_SVG,
} camber_format;

static inline bool camber_format_is_vector(int format) {
    return format == CAMBER_FORMAT_PDF || format == CAMBER_FORMAT_SVG;
}

/* Only pictures have an encoding. */
static inline camber_encoding camber_format_encoding(int format) {
    return format == CAMBER_FORMAT_WEBP   ? CAMBER_ENCODING_WEBP
           : format == CAMBER_FORMAT_PNG8 ? CAMBER_ENCODING_PNG8
                                          : CAMBER_ENCODING_PNG;
}

enum { CAMBER_OPTIONS_MOST = 128 };

/* A choice is the index of the word in the list that --help shows, which is also the value of the enum in camber.h; -1:
 * not given. Strings point into argv; NULL: not given. */
typedef struct camber_options {
    camber_verb verb;
    const char **inputs; /* input_count of them */
    size_t input_count;
    const char **wheres; /* where_count of them: the value of each --where */
    size_t where_count;
    bool help, version, json, quiet, verbose, force, warm, full;
    const char *output, *dump, *polylines, *plot, *junit, *pictures, *style, *layer, *device;
    const char *attribution; /* "": none */
    const char *where;       /* the first --where */
    const char **fonts;      /* font_count folders, one for each --fonts */
    size_t font_count;
    const char *language; /* of names; NULL: the local ones */
    bool no_labels;
    const char *root; /* a style reads only files inside this folder; NULL: any file */
    bool allow_remote, allow_vrt;
    int completion; /* camber_shell whose completion is printed; -1: none */
    int format;     /* camber_format; -1: nothing is written */
    int theme, method, coverage, backend, sharing, draw;
    camber_view_desc view; /* width and height are set by camber_options_parse */
    bool has_bbox, has_center;
    double zoom, bearing_deg, pitch_deg; /* NAN: not given */
    double simplify_px, width_px, fan_tolerance_px;
    const char *color, *fill; /* colours of features that no rule of a built-in style matches; NULL: the style's own */
    double width;             /* width of such lines, CSS px; 0: the style's own */
    /* Print: */
    const char *paper; /* a size by its name, or WxHmm */
    const char *title, *subtitle;
    bool landscape, scale_bar, north_arrow, grid;
    double dpi, margin_mm;                  /* NAN: not given */
    int fit;                                /* 0: contain, 1: cover; -1: not given */
    double paper_width_mm, paper_height_mm; /* of the sheet, by camber_options_check_page; 0: there is no sheet */
    uint32_t threads;                       /* 0: one per core */
    uint64_t memory_bytes; /* memory limit of the run, without its libraries; 0: the library's default */
    uint32_t quality;      /* of WebP, 1 to 100; 0: the library's default */
    uint32_t runs;
    uint32_t windows; /* number of windows of each picture that are compared with exact coverage */
    const char *only; /* only groups of checks whose name contains this text are run; NULL: all */
    /* Tiles: */
    uint32_t min_zoom, max_zoom;
    bool has_zooms;             /* at least one of the two was given */
    int tile_size;              /* 0: 256, 1: 512 */
    camber_tiles_place *places; /* place_count of them: the value of each --tile */
    size_t place_count;
    const char *renewed; /* a file with tiles to redraw */
    const char *region, *name, *description, *shard;
    const char *schedule;     /* a file that a dry run writes and other runs read */
    const char *label_record; /* a file that says which labels are in which tile */
    uint32_t shards;
    bool resume, keep_empty, dry_run;
    /* Serving: */
    const char *listen, *metrics, *public_url, *cors, *icons;
    const char *renderd, *cache_dir;
    const char *edit; /* the style's file, which is watched for changes; style has the same value then */
    uint64_t cache_bytes;
    uint32_t most_px, most_ratio;
    bool given[CAMBER_OPTIONS_MOST]; /* indexed by the option's position in the table */
} camber_options;

/* Parses argv. Returns CAMBER_EXIT_DONE, or CAMBER_EXIT_USAGE with a one-line message. With --help, --version or
 * --completion, the other arguments may be incomplete. Free the options with camber_options_free in any case. */
int camber_options_parse(int argc, char **argv, camber_options *options, char *message, size_t message_size);
/* Checks options against each other; called by camber_options_parse. verb is the name of the verb. */
int camber_options_check(camber_options *options, const char *verb, char *message, size_t message_size);
/* Parses a tile of the form zoom/column/row. */
bool camber_options_parse_place(const char *text, camber_tiles_place *place);
/* Returns the action of the verb tiles: "show", "verify" or "merge"; NULL: it draws. */
const char *camber_options_tiles_action(const camber_options *options);
/* Checks the options of serve; called by camber_options_check. */
int camber_options_check_serve(camber_options *options, char *message, size_t message_size);

enum { CAMBER_MAP_NAME_SIZE = 64 };

/* A CSS px is 1/96 inch. */
enum { CAMBER_CSS_PX_PER_INCH = 96 };

/* Splits an input of serve of the form NAME=PATH, where NAME has letters, digits, - and _, and may end in /dark.
 * Returns the path. name_length receives 0 if there is no name: "./a=b.pbf" is a path. */
const char *camber_options_split_input(const char *input, size_t *name_length);
/* Checks the options of tiles; called by camber_options_check. */
int camber_options_check_tiles(camber_options *options, char *message, size_t message_size);
/* Checks the options of print, and sets the sheet, after the format of OUT is known; called by camber_options_check. */
int camber_options_check_page(camber_options *options, char *message, size_t message_size);
void camber_options_free(camber_options *options);

/* Prints the help for the tool (CAMBER_VERB_NONE) or for a verb. */
void camber_options_help(camber_verb verb, FILE *file);

#endif
