#include "cli/options.h"

#include <jansson.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* A tenth of a pixel does not show, and drops a fifth to a third of a city's points. */
#define DRAWN_SIMPLIFY_PX 0.1

enum {
    RENDER = 1 << CAMBER_VERB_RENDER,
    TESSELLATE = 1 << CAMBER_VERB_TESSELLATE,
    COMPARE = 1 << CAMBER_VERB_COMPARE,
    VALIDATE = 1 << CAMBER_VERB_VALIDATE,
    BENCH = 1 << CAMBER_VERB_BENCH,
    INFO = 1 << CAMBER_VERB_INFO,
    WRITING = RENDER | TESSELLATE | BENCH,
    TILTING = RENDER | BENCH,
    READING = RENDER | TESSELLATE | COMPARE | VALIDATE | BENCH,
    EVERY = READING | INFO,
    STYLE = 1 << CAMBER_VERB_STYLE,
    TALKING = EVERY | STYLE,
#ifdef CAMBER_MAP
    MAPS = READING,
#else
    MAPS = 0,
#endif
    STYLED = MAPS & ~COMPARE,
    SIGNED = MAPS & (RENDER | TESSELLATE),
};

typedef struct verb_spec {
    const char *name;
    camber_verb verb;
    const char *operands;
    const char *summary;
} verb_spec;

static const verb_spec verbs[] = {
#ifdef CAMBER_MAP
    {"render", CAMBER_VERB_RENDER, "INPUT... | --style FILE -o OUT.png", "draws a map"},
    {"tessellate", CAMBER_VERB_TESSELLATE, "INPUT... -o OUT.glb", "writes the GPU-ready mesh"},
    {"compare", CAMBER_VERB_COMPARE, "INPUT... | --polylines FILE",
     "the paper's experiment: fan, kite, strip side by side"},
    {"validate", CAMBER_VERB_VALIDATE, "[INPUT... | --polylines FILE]",
     "checks kernels and pixels on every device here"},
    {"bench", CAMBER_VERB_BENCH, "INPUT... | --polylines FILE", "times every stage"},
    {"style", CAMBER_VERB_STYLE, "check NAME|FILE | eval FILE", "checks a style; evaluates an expression over inputs"},
#else
    {"compare", CAMBER_VERB_COMPARE, "--polylines FILE", "the paper's experiment: fan, kite, strip side by side"},
    {"validate", CAMBER_VERB_VALIDATE, "[--polylines FILE]", "checks kernels and pixels on every device here"},
    {"bench", CAMBER_VERB_BENCH, "--polylines FILE", "times every stage"},
#endif
    {"info", CAMBER_VERB_INFO, "", "OpenCL devices, GL back ends, buffer sharing, versions, readable formats"},
};

typedef enum option_kind {
    KIND_FLAG,   /* bool */
    KIND_TEXT,   /* const char * */
    KIND_WORDS,  /* const char *, UTF-8; may be empty */
    KIND_TEXTS,  /* wheres */
    KIND_NUMBER, /* double, least to most */
    KIND_COUNT,  /* uint32_t, least to most */
    KIND_BYTES,  /* uint64_t, least to most: a number, and K, M or G where it is not in bytes */
    KIND_CHOICE, /* int: the place in argument, whose words are parted by | */
    KIND_SIZE,
    KIND_BBOX,
    KIND_CENTER,
} option_kind;

/* What --help of some verbs says of an option, where it is not what it says of all. "": nothing. */
typedef struct option_note {
    int verbs; /* 0: no more notes */
    const char *help;
} option_note;

typedef struct option_spec {
    const char *name;
    char letter; /* 0: none */
    option_kind kind;
    int verbs; /* 1 << camber_verb of those that take it */
    size_t offset;
    const char *argument;
    const char *help; /* of the tool */
    double least, most;
    option_note notes[3];
} option_spec;

#define FIELD(member) offsetof(camber_options, member)

/* Parsing, --help and the check of the man page all read this table. */
static const option_spec specs[] = {
    {"output", 'o', KIND_TEXT, WRITING, FIELD(output), "OUT", "the file to write; -: standard output", 0, 0},
    {"force", 'f', KIND_FLAG, WRITING | COMPARE | VALIDATE, FIELD(force), NULL,
     "replace the file to write where it exists", 0, 0},
    {"format", 0, KIND_CHOICE, WRITING, FIELD(format), "png|glb", "of OUT, where its extension does not tell", 0, 0},
    {"size",
     0,
     KIND_SIZE,
     READING,
     0,
     "WxH",
     "of the picture in CSS px (1024x1024; 2048x2048 with --polylines)",
     0,
     0,
     {{RENDER | TESSELLATE, "of the picture in CSS px (1024x1024)"}}},
    {"ratio", 0, KIND_NUMBER, READING, FIELD(view.ratio), "R", "device pixels a CSS px (1)", 1e-3, 1e3},
    {"bbox", 0, KIND_BBOX, MAPS, 0, "W,S,E,N", "show this box, degrees; W > E crosses the antimeridian", 0, 0},
    {"center", 0, KIND_CENTER, MAPS, 0, "LON,LAT", "show what lies around this place, with --zoom", 0, 0},
    {"zoom", 0, KIND_NUMBER, MAPS, FIELD(zoom), "Z", "MapLibre's: the world is 512 CSS px wide at 0", -2, 30},
    {"bearing", 0, KIND_NUMBER, MAPS, FIELD(bearing_deg), "DEG", "the direction that is up, clockwise (0)", -1e6, 1e6},
    {"pitch",
     0,
     KIND_NUMBER,
     MAPS,
     FIELD(pitch_deg),
     "DEG",
     "how far the camera is tilted, to 85; render, bench (0)",
     0,
     85,
     {{TILTING, "how far the camera is tilted, to 85 (0)"}, {MAPS & ~TILTING, ""}}},
    {"attribution", 0, KIND_WORDS, SIGNED, FIELD(attribution), "TEXT",
     "sign OUT with this instead of what INPUT says of itself; '': not at all", 0, 0},
    {"style", 0, KIND_TEXT, STYLED, FIELD(style), "NAME|FILE", "a style that ships, or a MapLibre style (roads)", 0, 0},
    {"theme", 0, KIND_CHOICE, STYLED, FIELD(theme), "light|dark", "of a style that ships (light)", 0, 0},
    {"layer", 0, KIND_TEXT, MAPS, FIELD(layer), "NAME", "read this layer of INPUT only", 0, 0},
    {"where",
     0,
     KIND_TEXTS,
     MAPS,
     0,
     "SQL",
     "an OGR attribute filter; compare: one a network",
     0,
     0,
     {{COMPARE, "an OGR attribute filter; several: one a network"}, {MAPS, "an OGR attribute filter"}}},
    {"polylines", 0, KIND_TEXT, COMPARE | BENCH | VALIDATE, FIELD(polylines), "FILE",
     "polylines in pixels instead of a map", 0, 0},
    {"width-px",
     0,
     KIND_NUMBER,
     COMPARE | BENCH | VALIDATE,
     FIELD(width_px),
     "W",
     "of the lines, device pixels (2; compare: 8)",
     1e-3,
     16384,
     {{COMPARE, "of the lines, device pixels (8)"}, {BENCH | VALIDATE, "of the lines, device pixels (2)"}}},
    {"dump", 0, KIND_TEXT, BENCH, FIELD(dump), "FILE", "write the polylines in pixels, as --polylines reads them", 0,
     0},
    {"plot", 0, KIND_TEXT, COMPARE, FIELD(plot), "FILE", "bars of the averages, .svg or .png, drawn by gnuplot", 0, 0},
    {"runs", 0, KIND_COUNT, COMPARE | BENCH, FIELD(runs), "N", "timed runs, after 3 that are not (9)", 1, 100000},
    {"method",
     0,
     KIND_CHOICE,
     READING,
     FIELD(method),
     "strip|kite|fan",
     "how lines become triangles (strip; compare, validate: all)",
     0,
     0,
     {{COMPARE | VALIDATE, "how lines become triangles (all)"}, {READING, "how lines become triangles (strip)"}}},
    {"fan-tolerance-px", 0, KIND_NUMBER, COMPARE, FIELD(fan_tolerance_px), "T",
     "farthest that a fan's chord lies from its arc (0.25)", 1e-6, 16384},
    {"coverage", 0, KIND_CHOICE, READING, FIELD(coverage), "exact|linear", "how edges are smoothed (exact)", 0, 0},
    {"simplify-px",
     0,
     KIND_NUMBER,
     READING,
     FIELD(simplify_px),
     "T",
     "drop points that the line stays this close to (render, bench: 0.1, else 0: none)",
     0,
     1e6,
     {{RENDER, "drop points that the line stays this close to (0.1; 0: none)"},
      {BENCH, "drop points that the line stays this close to (0.1; with --polylines 0: none)"},
      {READING, "drop points that the line stays this close to (0: none)"}}},
    {"device", 0, KIND_TEXT, EVERY, FIELD(device), "TEXT", "OpenCL: cpu, gpu, or part of a device's name", 0, 0},
    {"backend", 0, KIND_CHOICE, EVERY, FIELD(backend), "auto|egl|osmesa", "where GL comes from (auto)", 0, 0},
    {"sharing", 0, KIND_CHOICE, RENDER | COMPARE | BENCH | INFO, FIELD(sharing), "auto|gl|zero-copy|copy",
     "how OpenCL's buffers reach GL (auto)", 0, 0},
    {"draw", 0, KIND_CHOICE, RENDER | COMPARE | VALIDATE | BENCH | INFO, FIELD(draw), "auto|gl|cl",
     "what draws: GLES shaders, or OpenCL kernels without any GL (auto)", 0, 0},
    {"threads", 0, KIND_COUNT, EVERY, FIELD(threads), "N", "of OpenCL and GL on a CPU (all cores)", 1, 1024},
    {"memory", 0, KIND_BYTES, READING, FIELD(memory_bytes), "SIZE",
     "that a run may take, as in 512M: meshes are made in pieces to stay below; above it and 128M data is refused",
     262144, 1099511627776.0},
    {"allow-remote", 0, KIND_FLAG, READING, FIELD(allow_remote), NULL, "INPUT may lead to the network, or be there", 0,
     0},
    {"allow-vrt", 0, KIND_FLAG, READING, FIELD(allow_vrt), NULL, "INPUT may name other files (VRT)", 0, 0},
    {"root", 0, KIND_TEXT, READING, FIELD(root), "FOLDER", "beyond which a style reaches no file", 0, 0},
    {"warm", 0, KIND_FLAG, INFO, FIELD(warm), NULL,
     "compile every kernel into the cache, for all users of this machine where it may be written", 0, 0},
    {"junit", 0, KIND_TEXT, VALIDATE, FIELD(junit), "FILE", "write the results as JUnit's XML", 0, 0},
    {"pictures", 0, KIND_TEXT, VALIDATE, FIELD(pictures), "FOLDER", "write PNGs of what differs", 0, 0},
    {"full", 0, KIND_FLAG, VALIDATE, FIELD(full), NULL,
     "draw by every method, with every join and cap, and as GPUs draw, too; three minutes", 0, 0},
    {"windows", 0, KIND_COUNT, VALIDATE, FIELD(windows), "N", "of each picture, held against the oracle (24)", 8,
     100000},
    {"json", 0, KIND_FLAG, TALKING, FIELD(json), NULL, "one JSON object on standard output", 0, 0},
    {"quiet", 'q', KIND_FLAG, TALKING, FIELD(quiet), NULL, "errors only", 0, 0},
    {"verbose", 'v', KIND_FLAG, TALKING, FIELD(verbose), NULL, "say what is chosen and how long it takes", 0, 0},
    {"help", 'h', KIND_FLAG, TALKING, FIELD(help), NULL, "this text", 0, 0},
    {"version", 'V', KIND_FLAG, TALKING, FIELD(version), NULL, "the version", 0, 0},
};

#define SPEC_COUNT (sizeof specs / sizeof *specs)
#define VERB_COUNT (sizeof verbs / sizeof *verbs)

/* ---- Help ---- */

/* mask: of one verb, or TALKING. */
static const char *help_of(const option_spec *spec, int mask) {
    for (size_t i = 0; mask != TALKING && i < sizeof spec->notes / sizeof *spec->notes; i++)
        if (spec->notes[i].verbs & mask)
            return spec->notes[i].help;
    return spec->help;
}

static void print_options(int mask, FILE *file) {
    for (size_t i = 0; i < SPEC_COUNT; i++) {
        const option_spec *spec = &specs[i];
        const char *help = help_of(spec, mask);
        if (!(spec->verbs & mask) || !*help)
            continue;
        char left[64];
        const char letter[] = {'-', spec->letter, ',', ' ', 0};
        snprintf(left, sizeof left, "%s--%s%s%s", spec->letter ? letter : "    ", spec->name, spec->argument ? " " : "",
                 spec->argument ? spec->argument : "");
        fprintf(file, strlen(left) < 32 ? "  %-32s%s\n" : "  %s\n                                  %s\n", left, help);
    }
}

void camber_options_help(camber_verb verb, FILE *file) {
    for (size_t i = 0; i < VERB_COUNT; i++)
        if (verbs[i].verb == verb) {
            fprintf(file, "camber %s %s\n%s\n\n", verbs[i].name, verbs[i].operands, verbs[i].summary);
            print_options(1 << verb, file);
            fputs("\n`man camber` has examples and the exit statuses.\n", file);
            return;
        }
    fputs("camber VERB [OPTION...] [INPUT...]\nturns map lines into anti-aliased pictures\n\n", file);
    for (size_t i = 0; i < VERB_COUNT; i++)
        fprintf(file, "  %-12s%s\n", verbs[i].name, verbs[i].summary);
    fprintf(file, "  %-12s%s\n", "help [VERB]", "this text, or a verb's own");
    fprintf(file, "  %-12s%s\n", "version", "the version");
#ifdef CAMBER_MAP
    fputs("\nINPUT: what OGR reads (OSM PBF and XML, GeoJSON, Shapefile, GeoPackage, ...); -: standard input.\n", file);
#endif
    fputs("\nOptions of the verbs (`camber VERB --help` lists a verb's own):\n", file);
    print_options(TALKING, file);
    fputs("\nExit status: 0 done, 1 a check failed, 2 usage, 65 bad data, 66 no such input, 69 no device,\n"
          "70 internal error, 73 OUT exists or cannot be created, 74 input or output error, 128 + N signal N.\n",
          file);
}

/* ---- Values ---- */

typedef struct parser {
    camber_options *options;
    char *message;
    size_t message_size;
} parser;

static int usage(const parser *p, const char *format, ...) {
    va_list list;
    va_start(list, format);
    vsnprintf(p->message, p->message_size, format, list);
    va_end(list);
    return CAMBER_EXIT_USAGE;
}

/* Finite decimal numbers only: strtod alone also takes blanks, hexadecimal, inf and nan. *text moves behind. */
static bool parse_number(const char **text, double *value) {
    const size_t span = strspn(*text, "0123456789+-.eE");
    char *end;
    const double number = strtod(*text, &end);
    if (span == 0 || end == *text || end > *text + span || !isfinite(number))
        return false;
    *text = end;
    *value = number;
    return true;
}

/* Exactly count numbers with commas between. */
static bool parse_numbers(const char *text, size_t count, double *values) {
    for (size_t i = 0; i < count; i++) {
        if (i > 0 && *text++ != ',')
            return false;
        if (!parse_number(&text, &values[i]))
            return false;
    }
    return *text == 0;
}

/* Up to nine digits: enough to tell that it is too large. */
static bool parse_count(const char **text, uint32_t *value) {
    const size_t digits = strspn(*text, "0123456789");
    if (digits < 1 || digits > 9)
        return false;
    *value = (uint32_t)strtoul(*text, NULL, 10);
    *text += digits;
    return true;
}

static bool parse_bytes(const char *text, double least, double most, uint64_t *bytes) {
    static const char units[] = "KMG";
    const size_t digits = strspn(text, "0123456789");
    if (digits < 1 || digits > 15)
        return false;
    uint64_t size = strtoull(text, NULL, 10);
    const char *rest = text + digits, *unit = *rest ? strchr(units, *rest) : NULL;
    if (unit)
        rest++;
    if (*rest)
        return false;
    for (const char *at = units; unit && at <= unit && (double)size <= most; at++)
        size *= 1024;
    if ((double)size < least || (double)size > most)
        return false;
    *bytes = size;
    return true;
}

static int parse_choice(const parser *p, const option_spec *spec, const char *text, int *value) {
    const size_t size = strlen(text);
    int place = 0;
    for (const char *word = spec->argument ? spec->argument : ""; *word; place++) {
        const size_t length = strcspn(word, "|");
        if (length == size && strncmp(word, text, size) == 0) {
            *value = place;
            return CAMBER_EXIT_DONE;
        }
        word += length + (word[length] == '|');
    }
    return usage(p, "--%s %s: not one of %s; choose one of them", spec->name, text, spec->argument);
}

static int parse_view(const parser *p, const option_spec *spec, const char *text) {
    camber_options *options = p->options;
    double n[4];
    if (spec->kind == KIND_BBOX) {
        if (!parse_numbers(text, 4, n) || fabs(n[0]) > 180 || fabs(n[2]) > 180 || fabs(n[1]) > 90 || fabs(n[3]) > 90 ||
            n[1] >= n[3] || n[0] == n[2])
            return usage(p, "--bbox %s: not a box; give west,south,east,north in degrees, south below north", text);
        options->has_bbox = true;
        options->view.west = n[0];
        options->view.south = n[1];
        options->view.east = n[2];
        options->view.north = n[3];
        return CAMBER_EXIT_DONE;
    }
    if (spec->kind == KIND_CENTER) {
        if (!parse_numbers(text, 2, n) || fabs(n[0]) > 180 || fabs(n[1]) > 90)
            return usage(p, "--center %s: not a place; give longitude,latitude in degrees", text);
        options->has_center = true;
        options->view.longitude = n[0];
        options->view.latitude = n[1];
        return CAMBER_EXIT_DONE;
    }
    const char *rest = text;
    if (!parse_count(&rest, &options->view.width) || (*rest != 'x' && *rest != 'X') ||
        (rest++, !parse_count(&rest, &options->view.height)) || *rest != 0)
        return usage(p, "--size %s: not a size; give WIDTHxHEIGHT in CSS px, as in 1024x768", text);
    if (options->view.width < 1 || options->view.height < 1)
        return usage(p, "--size %s: a side of 0; both sides are 1 or more", text);
    return CAMBER_EXIT_DONE;
}

/* Files have it as UTF-8. */
static int parse_words(const parser *p, const option_spec *spec, const char *text, const char **value) {
    json_t *checked = json_string(text);
    json_decref(checked);
    if (!checked)
        return usage(p, "--%s: is not UTF-8; write it in a terminal whose locale is", spec->name);
    *value = text;
    return CAMBER_EXIT_DONE;
}

static int parse_value(const parser *p, const option_spec *spec, const char *text) {
    char *field = (char *)p->options + spec->offset;
    switch (spec->kind) {
    case KIND_FLAG: *(bool *)(void *)field = true; return CAMBER_EXIT_DONE;
    case KIND_TEXT:
    case KIND_TEXTS:
        if (*text == 0)
            return usage(p, "--%s: empty; give %s", spec->name, spec->argument);
        if (spec->kind == KIND_TEXTS)
            p->options->wheres[p->options->where_count++] = text;
        else
            *(const char **)(void *)field = text;
        return CAMBER_EXIT_DONE;
    case KIND_NUMBER: {
        double number;
        if (!parse_numbers(text, 1, &number) || number < spec->least || number > spec->most)
            return usage(p, "--%s %s: out of range; give a number from %g to %g", spec->name, text, spec->least,
                         spec->most);
        *(double *)(void *)field = number;
        return CAMBER_EXIT_DONE;
    }
    case KIND_WORDS: return parse_words(p, spec, text, (const char **)(void *)field);
    case KIND_COUNT: {
        uint32_t count;
        const char *rest = text;
        if (!parse_count(&rest, &count) || *rest || count < spec->least || count > spec->most)
            return usage(p, "--%s %s: out of range; give a whole number from %g to %g", spec->name, text, spec->least,
                         spec->most);
        *(uint32_t *)(void *)field = count;
        return CAMBER_EXIT_DONE;
    }
    case KIND_BYTES:
        if (!parse_bytes(text, spec->least, spec->most, (uint64_t *)(void *)field))
            return usage(p, "--%s %s: no such size; give bytes from 256K to 1024G, as in 100000000, 512M or 2G",
                         spec->name, text);
        return CAMBER_EXIT_DONE;
    case KIND_CHOICE: return parse_choice(p, spec, text, (int *)(void *)field);
    case KIND_SIZE:
    case KIND_BBOX:
    case KIND_CENTER: break;
    }
    return parse_view(p, spec, text);
}

/* ---- Arguments ---- */

static const char *verb_name(camber_verb verb) {
    for (size_t i = 0; i < VERB_COUNT; i++)
        if (verbs[i].verb == verb)
            return verbs[i].name;
    return "";
}

static bool takes(const option_spec *spec, camber_verb verb) {
    if (verb == CAMBER_VERB_NONE)
        return strcmp(spec->name, "help") == 0 || strcmp(spec->name, "version") == 0;
    return spec->verbs & 1 << verb;
}

static int unknown_option(const parser *p, const char *name) {
    const camber_verb verb = p->options->verb;
    const char *gap = verb == CAMBER_VERB_NONE ? "" : " ";
    return usage(p, "%s: no such option of camber%s%s; `camber%s%s --help` lists them", name, gap, verb_name(verb), gap,
                 verb_name(verb));
}

/* --name, --name=value, --name value. *at moves over a value in an argument of its own. */
static int parse_long(const parser *p, int argc, char **argv, int *at) {
    const char *name = argv[*at] + 2;
    const size_t length = strcspn(name, "=");
    for (size_t i = 0; i < SPEC_COUNT; i++) {
        const option_spec *spec = &specs[i];
        if (strlen(spec->name) != length || strncmp(spec->name, name, length) != 0 || !takes(spec, p->options->verb))
            continue;
        if (!spec->argument && name[length])
            return usage(p, "--%s: takes no value; leave out the rest", spec->name);
        if (!spec->argument || name[length])
            return parse_value(p, spec, name + length + (name[length] == '='));
        if (*at + 1 >= argc)
            return usage(p, "--%s: no value; give %s", spec->name, spec->argument);
        return parse_value(p, spec, argv[++*at]);
    }
    return unknown_option(p, argv[*at]);
}

/* -q, -qf, -o OUT, -oOUT. */
static int parse_short(const parser *p, int argc, char **argv, int *at) {
    for (const char *letter = argv[*at] + 1; *letter; letter++) {
        const option_spec *spec = NULL;
        for (size_t i = 0; i < SPEC_COUNT && !spec; i++)
            if (specs[i].letter == *letter && takes(&specs[i], p->options->verb))
                spec = &specs[i];
        if (!spec)
            return unknown_option(p, argv[*at]);
        if (spec->argument && letter[1])
            return parse_value(p, spec, letter + 1);
        if (spec->argument && *at + 1 >= argc)
            return usage(p, "-%c: no value; give %s", spec->letter, spec->argument);
        if (spec->argument)
            return parse_value(p, spec, argv[++*at]);
        const int status = parse_value(p, spec, "");
        if (status != CAMBER_EXIT_DONE)
            return status;
    }
    return CAMBER_EXIT_DONE;
}

/* "help" and "version" are what --help and --version are; a verb may stand behind the first. */
static int parse_verb(const parser *p, const char *text) {
    camber_options *options = p->options;
    if (strcmp(text, "help") == 0) {
        options->help = true;
        return CAMBER_EXIT_DONE;
    }
    if (strcmp(text, "version") == 0) {
        options->version = true;
        return CAMBER_EXIT_DONE;
    }
    for (size_t i = 0; i < VERB_COUNT; i++)
        if (strcmp(verbs[i].name, text) == 0) {
            options->verb = verbs[i].verb;
            return CAMBER_EXIT_DONE;
        }
    char names[160] = "";
    for (size_t i = 0; i < VERB_COUNT; i++)
        snprintf(names + strlen(names), sizeof names - strlen(names), "%s, ", verbs[i].name);
    snprintf(names + strlen(names), sizeof names - strlen(names), "help, version");
#ifndef CAMBER_MAP
    if (!strcmp(text, "render") || !strcmp(text, "tessellate") || !strcmp(text, "style"))
        return usage(p, "%s: this build has no map (CAMBER_MAP=OFF); its verbs are %s", text, names);
#endif
    return usage(p, "%s: no such verb; it is one of %s", text, names);
}

int camber_options_parse(int argc, char **argv, camber_options *options, char *message, size_t message_size) {
    *options = (camber_options){.format = -1,
                                .theme = -1,
                                .method = -1,
                                .view = {.ratio = 1},
                                .zoom = NAN,
                                .bearing_deg = NAN,
                                .pitch_deg = NAN,
                                .simplify_px = NAN,
                                .runs = 9,
                                .windows = 24};
    const parser p = {options, message, message_size};
    options->inputs = calloc((size_t)argc + 1, sizeof *options->inputs);
    options->wheres = calloc((size_t)argc + 1, sizeof *options->wheres);
    if (!options->inputs || !options->wheres)
        return usage(&p, "out of memory for %d arguments; give fewer", argc);
    int status = CAMBER_EXIT_DONE;
    bool only_operands = false;
    for (int at = 1; at < argc && status == CAMBER_EXIT_DONE; at++) {
        const char *text = argv[at];
        const bool dashed = !only_operands && text[0] == '-' && text[1];
        if (dashed && strcmp(text, "--") == 0)
            only_operands = true;
        else if (dashed && text[1] == '-')
            status = parse_long(&p, argc, argv, &at);
        else if (dashed)
            status = parse_short(&p, argc, argv, &at);
        else if (options->verb == CAMBER_VERB_NONE)
            status = parse_verb(&p, text);
        else
            options->inputs[options->input_count++] = text;
    }
    options->where = options->wheres[0];
    if (isnan(options->simplify_px)) {
        const bool drawn = options->verb == CAMBER_VERB_RENDER || options->verb == CAMBER_VERB_BENCH;
        options->simplify_px = drawn && !options->polylines ? DRAWN_SIMPLIFY_PX : 0;
    }
    if (status == CAMBER_EXIT_DONE && !options->help && !options->version)
        status = camber_options_check(options, verb_name(options->verb), message, message_size);
    return status;
}

void camber_options_free(camber_options *options) {
    free(options->inputs);
    free(options->wheres);
}
