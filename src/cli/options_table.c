/* The table of verbs and options. A line of it is an option: which verbs take it, what it takes, where its value goes
 * in camber_options, and what --help says. Parsing, --help, completion and the check of the man page read nothing else.
 */
#include "cli/options_table.h"

enum {
    TOOL = 1 << CAMBER_VERB_NONE, /* camber itself, without a verb */
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

const camber_verb_spec camber_verb_specs[] = {
#ifdef CAMBER_MAP
    {"render", CAMBER_VERB_RENDER, "INPUT... | --style FILE -o OUT.png", "draw a map"},
    {"tessellate", CAMBER_VERB_TESSELLATE, "INPUT... -o OUT.glb", "write the mesh that the GPU draws"},
    {"compare", CAMBER_VERB_COMPARE, "INPUT... | --polylines FILE", "compare the methods fan, kite and strip"},
    {"validate", CAMBER_VERB_VALIDATE, "[INPUT... | --polylines FILE]", "check kernels and pixels on every device"},
    {"bench", CAMBER_VERB_BENCH, "INPUT... | --polylines FILE", "time every stage"},
    {"style", CAMBER_VERB_STYLE, "check NAME|FILE | eval FILE", "check a style; evaluate an expression"},
#else
    {"compare", CAMBER_VERB_COMPARE, "--polylines FILE", "compare the methods fan, kite and strip"},
    {"validate", CAMBER_VERB_VALIDATE, "[--polylines FILE]", "check kernels and pixels on every device"},
    {"bench", CAMBER_VERB_BENCH, "--polylines FILE", "time every stage"},
#endif
    {"info", CAMBER_VERB_INFO, "", "list devices, GL back ends, versions and readable formats"},
};

#define FIELD(member) offsetof(camber_options, member)

const camber_option_spec camber_option_specs[] = {
    {"output", 'o', CAMBER_OPTION_FILE, WRITING, FIELD(output), "OUT", "file to write; - is standard output"},
    {"force", 'f', CAMBER_OPTION_FLAG, WRITING | COMPARE | VALIDATE, FIELD(force), NULL, "replace existing files"},
    {"format", 0, CAMBER_OPTION_CHOICE, WRITING, FIELD(format), "png|glb", "format of OUT (by its extension)"},
    {"size", 0, CAMBER_OPTION_SIZE, READING, 0, "WxH",
     "size of the picture in CSS px (1024x1024; 2048x2048 with --polylines)",
     .notes = {{RENDER | TESSELLATE, "size of the picture in CSS px (1024x1024)"}}},
    {"ratio", 0, CAMBER_OPTION_NUMBER, READING, FIELD(view.ratio), "R", "device pixels per CSS px (1)", 1e-3, 1e3},
    {"bbox", 0, CAMBER_OPTION_BBOX, MAPS, 0, "W,S,E,N", "show this box, in degrees; W > E crosses the antimeridian"},
    {"center", 0, CAMBER_OPTION_CENTER, MAPS, 0, "LON,LAT", "show the surroundings of this point, with --zoom"},
    {"zoom", 0, CAMBER_OPTION_NUMBER, MAPS, FIELD(zoom), "Z", "MapLibre zoom: at 0 the world is 512 CSS px wide", -2,
     30},
    {"bearing", 0, CAMBER_OPTION_NUMBER, MAPS, FIELD(bearing_deg), "DEG",
     "direction that points up, clockwise from north (0)", -1e6, 1e6},
    {"pitch", 0, CAMBER_OPTION_NUMBER, MAPS, FIELD(pitch_deg), "DEG",
     "tilt of the camera, 0 to 85; render and bench only (0)", 0, 85,
     .notes = {{TILTING, "tilt of the camera, 0 to 85 (0)"}, {MAPS & ~TILTING, ""}}},
    {"attribution", 0, CAMBER_OPTION_WORDS, SIGNED, FIELD(attribution), "TEXT",
     "name this as the source of the data in OUT, in place of what INPUT names; '': name none"},
    {"style", 0, CAMBER_OPTION_STYLE, STYLED, FIELD(style), "NAME|FILE",
     "a built-in style, or a MapLibre style document (roads)"},
    {"theme", 0, CAMBER_OPTION_CHOICE, STYLED, FIELD(theme), "light|dark", "theme of a built-in style (light)"},
    {"layer", 0, CAMBER_OPTION_TEXT, MAPS, FIELD(layer), "NAME", "read only this layer of INPUT"},
    {"where", 0, CAMBER_OPTION_WHERES, MAPS, 0, "SQL", "OGR attribute filter; compare: each makes a network",
     .notes = {{COMPARE, "OGR attribute filter; several filters make several networks"},
               {MAPS, "OGR attribute filter"}}},
    {"polylines", 0, CAMBER_OPTION_FILE, COMPARE | BENCH | VALIDATE, FIELD(polylines), "FILE",
     "read polylines in pixels, not a map"},
    {"width-px", 0, CAMBER_OPTION_NUMBER, COMPARE | BENCH | VALIDATE, FIELD(width_px), "W",
     "width of the lines in device pixels (2; compare: 8)", 1e-3, 16384,
     .notes = {{COMPARE, "width of the lines in device pixels (8)"},
               {BENCH | VALIDATE, "width of the lines in device pixels (2)"}}},
    {"dump", 0, CAMBER_OPTION_FILE, BENCH, FIELD(dump), "FILE",
     "write the polylines in pixels, in the form that --polylines reads"},
    {"plot", 0, CAMBER_OPTION_FILE, COMPARE, FIELD(plot), "FILE",
     "draw the averages as bars: .svg or .png; needs gnuplot"},
    {"runs", 0, CAMBER_OPTION_COUNT, COMPARE | BENCH, FIELD(runs), "N", "timed runs, after 3 untimed ones (9)", 1,
     100000},
    {"method", 0, CAMBER_OPTION_CHOICE, READING, FIELD(method), "strip|kite|fan",
     "how lines become triangles (strip; compare, validate: all)",
     .notes = {{COMPARE | VALIDATE, "how lines become triangles (all)"},
               {READING, "how lines become triangles (strip)"}}},
    {"fan-tolerance-px", 0, CAMBER_OPTION_NUMBER, COMPARE, FIELD(fan_tolerance_px), "T",
     "greatest distance of a fan's chord from its arc (0.25)", 1e-6, 16384},
    {"coverage", 0, CAMBER_OPTION_CHOICE, READING, FIELD(coverage), "exact|linear", "how edges are smoothed (exact)"},
    {"simplify-px", 0, CAMBER_OPTION_NUMBER, READING, FIELD(simplify_px), "T",
     "drop points if the line moves by no more than this (render, bench: 0.1; else 0: none)", 0, 1e6,
     .notes = {{RENDER, "drop points if the line moves by no more than this (0.1; 0: none)"},
               {BENCH, "drop points if the line moves by no more than this (0.1; with --polylines 0: none)"},
               {READING, "drop points if the line moves by no more than this (0: none)"}}},
    {"device", 0, CAMBER_OPTION_DEVICE, EVERY, FIELD(device), "TEXT",
     "OpenCL device: cpu, gpu, or part of a device's name"},
    {"backend", 0, CAMBER_OPTION_CHOICE, EVERY, FIELD(backend), "auto|egl|osmesa", "where GL comes from (auto)"},
    {"sharing", 0, CAMBER_OPTION_CHOICE, RENDER | COMPARE | BENCH | INFO, FIELD(sharing), "auto|gl|zero-copy|copy",
     "how OpenCL's buffers reach GL (auto)"},
    {"draw", 0, CAMBER_OPTION_CHOICE, RENDER | COMPARE | VALIDATE | BENCH | INFO, FIELD(draw), "auto|gl|cl",
     "draw with GLES shaders, or with OpenCL kernels and no GL (auto)"},
    {"threads", 0, CAMBER_OPTION_COUNT, EVERY, FIELD(threads), "N", "threads of OpenCL and GL on a CPU (one per core)",
     1, 1024},
    {"memory", 0, CAMBER_OPTION_BYTES, READING, FIELD(memory_bytes), "SIZE",
     "memory limit of the run, as in 512M; above it and 128M, data is refused", 262144, 1099511627776.0},
    {"allow-remote", 0, CAMBER_OPTION_FLAG, READING, FIELD(allow_remote), NULL,
     "allow INPUT to be on the network or to lead there"},
    {"allow-vrt", 0, CAMBER_OPTION_FLAG, READING, FIELD(allow_vrt), NULL, "allow INPUT to name other files (VRT)"},
    {"root", 0, CAMBER_OPTION_FOLDER, READING, FIELD(root), "FOLDER", "a style reads no file outside this folder"},
    {"warm", 0, CAMBER_OPTION_FLAG, INFO, FIELD(warm), NULL,
     "compile every kernel into the cache, for all users of this machine if possible"},
    {"junit", 0, CAMBER_OPTION_FILE, VALIDATE, FIELD(junit), "FILE", "write the results as JUnit XML"},
    {"pictures", 0, CAMBER_OPTION_FOLDER, VALIDATE, FIELD(pictures), "FOLDER", "write a PNG of each failure"},
    {"full", 0, CAMBER_OPTION_FLAG, VALIDATE, FIELD(full), NULL,
     "also draw with every method, join and cap, and with the kernels for GPUs; three minutes"},
    {"windows", 0, CAMBER_OPTION_COUNT, VALIDATE, FIELD(windows), "N",
     "windows of each picture to compare with exact coverage (24)", 8, 100000},
    {"json", 0, CAMBER_OPTION_FLAG, TALKING, FIELD(json), NULL, "print one JSON object to standard output"},
    {"quiet", 'q', CAMBER_OPTION_FLAG, TALKING, FIELD(quiet), NULL, "print errors only"},
    {"verbose", 'v', CAMBER_OPTION_FLAG, TALKING, FIELD(verbose), NULL, "print what is chosen and how long it takes"},
    {"help", 'h', CAMBER_OPTION_FLAG, TALKING | TOOL, FIELD(help), NULL, "print this text"},
    {"version", 'V', CAMBER_OPTION_FLAG, TALKING | TOOL, FIELD(version), NULL, "print the version"},
    {"completion", 0, CAMBER_OPTION_CHOICE, TOOL, FIELD(completion), "bash|zsh", "print the completion for this shell"},
};

const size_t camber_verb_count = sizeof camber_verb_specs / sizeof *camber_verb_specs;
const size_t camber_option_count = sizeof camber_option_specs / sizeof *camber_option_specs;
