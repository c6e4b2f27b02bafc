/* Turns argv into camber_options: parses each argument with the table of options, and then checks all options together
 * (options_check.c). --help is printed from the same table. */
#include "cli/options_table.h"

#include <jansson.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Moving lines by a tenth of a pixel is not visible, and drops a fifth to a third of a city's points. */
#define DRAWN_SIMPLIFY_PX 0.1

enum { NAME_LETTERS = 32 }; /* longest option name that a mistyped one is compared with */

/* ---- Help ---- */

/* Returns NULL if the verb has no note of its own. */
static const camber_option_note *find_note(const camber_option_spec *spec, camber_verb verb) {
    for (size_t i = 0; verb != CAMBER_VERB_NONE && i < sizeof spec->notes / sizeof *spec->notes; i++)
        if (spec->notes[i].verbs & 1 << verb)
            return &spec->notes[i];
    return NULL;
}

const char *camber_option_help(const camber_option_spec *spec, camber_verb verb) {
    const camber_option_note *note = find_note(spec, verb);
    return note ? note->help : spec->help;
}

const char *camber_option_argument(const camber_option_spec *spec, camber_verb verb) {
    const camber_option_note *note = find_note(spec, verb);
    return note && note->argument ? note->argument : spec->argument;
}

static void print_option(const camber_option_spec *spec, camber_verb verb, FILE *file) {
    char left[64];
    const char letter[] = {'-', spec->letter, ',', ' ', 0};
    const char *argument = camber_option_argument(spec, verb), *help = camber_option_help(spec, verb);
    snprintf(left, sizeof left, "%s--%s%s%s", spec->letter ? letter : "    ", spec->name, argument ? " " : "",
             argument ? argument : "");
    fprintf(file, strlen(left) < 32 ? "  %-32s%s\n" : "  %s\n                                  %s\n", left, help);
}

/* Prints the options of a verb, each group with its title. */
static void print_options(camber_verb verb, FILE *file) {
    const char *title = NULL;
    for (size_t i = 0; i < camber_option_count; i++) {
        const camber_option_spec *spec = &camber_option_specs[i];
        for (size_t k = 0; k < camber_option_group_count; k++)
            if (strcmp(camber_option_groups[k].first, spec->name) == 0)
                title = camber_option_groups[k].title;
        if (!(spec->verbs & 1 << verb) || !*camber_option_help(spec, verb))
            continue;
        if (title)
            fprintf(file, "\n%s:\n", title);
        title = NULL;
        print_option(spec, verb, file);
    }
}

static void print_verbs(camber_verb_group group, const char *title, FILE *file) {
    fprintf(file, "\n%s:\n", title);
    for (size_t i = 0; i < camber_verb_count; i++)
        if (camber_verb_specs[i].group == group)
            fprintf(file, "  %-12s%s\n                %s\n", camber_verb_specs[i].name, camber_verb_specs[i].summary,
                    camber_verb_specs[i].example);
}

static void print_tool_help(FILE *file) {
    fputs("camber VERB [OPTION...] [INPUT...]\nturn maps into anti-aliased pictures\n", file);
#ifdef CAMBER_MAP
    print_verbs(CAMBER_VERBS_DRAW, "Draw", file);
#endif
    print_verbs(CAMBER_VERBS_CHECK, "Check and measure", file);
    print_verbs(CAMBER_VERBS_MACHINE, "This machine, and help", file);
    fprintf(file, "  %-12s%s\n                %s\n", "help [VERB]", "print this text, or a verb's options",
            camber_verb_specs[0].verb == CAMBER_VERB_RENDER ? "camber help render" : "camber help bench");
    fprintf(file, "  %-12s%s\n", "version", "print the version");
#ifdef CAMBER_MAP
    fputs("\nINPUT: any file that GDAL reads (OSM PBF and XML, GeoJSON, Shapefile, GeoPackage, ...), or - for standard "
          "input.\n",
          file);
#endif
    fputs("\nOptions of most verbs (`camber help VERB` lists all of one verb):\n", file);
    for (size_t i = 0; i < camber_option_count; i++) {
        const camber_option_spec *spec = &camber_option_specs[i];
        const bool common = spec->verbs & 1 << CAMBER_VERB_NONE || (spec->verbs & 1 << CAMBER_VERB_STYLE);
        if (common && *spec->help)
            print_option(spec, CAMBER_VERB_NONE, file);
    }
    fputs("\nExit status: 0 done, 1 a check failed, 2 usage, 65 bad data, 66 no such input, 69 no device,\n"
          "70 internal error, 73 OUT exists or cannot be created, 74 input or output error, 128 + N signal N.\n",
          file);
}

void camber_options_help(camber_verb verb, FILE *file) {
    for (size_t i = 0; i < camber_verb_count; i++)
        if (camber_verb_specs[i].verb == verb) {
            fprintf(file, "camber %s %s\n%s\n\nExample:\n  %s\n", camber_verb_specs[i].name,
                    camber_verb_specs[i].operands, camber_verb_specs[i].summary, camber_verb_specs[i].example);
            print_options(verb, file);
            fputs("\n`man camber` has more examples and the exit statuses.\n", file);
            return;
        }
    print_tool_help(file);
}

/* ---- Values ---- */

/* Parses finite decimal numbers only: strtod also accepts blanks, hexadecimal, inf and nan. *text moves past the
 * number. */
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

/* Parses exactly count numbers, separated by commas. */
static bool parse_numbers(const char *text, size_t count, double *values) {
    for (size_t i = 0; i < count; i++) {
        if (i > 0 && *text++ != ',')
            return false;
        if (!parse_number(&text, &values[i]))
            return false;
    }
    return *text == 0;
}

/* Parses up to nine digits: enough to recognise a number that is too large. */
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

static int parse_choice(const camber_option_reader *p, const camber_option_spec *spec, const char *text, int *value) {
    const size_t size = strlen(text);
    int index = 0;
    for (const char *word = spec->argument ? spec->argument : ""; *word; index++) {
        const size_t length = strcspn(word, "|");
        if (length == size && strncmp(word, text, size) == 0) {
            *value = index;
            return CAMBER_EXIT_DONE;
        }
        word += length + (word[length] == '|');
    }
    return camber_options_refuse(p, "--%s %s: not one of %s; choose one of them", spec->name, text, spec->argument);
}

static int parse_view(const camber_option_reader *p, const camber_option_spec *spec, const char *text) {
    camber_options *options = p->options;
    double n[4];
    if (spec->kind == CAMBER_OPTION_BBOX) {
        if (!parse_numbers(text, 4, n) || fabs(n[0]) > 180 || fabs(n[2]) > 180 || fabs(n[1]) > 90 || fabs(n[3]) > 90 ||
            n[1] >= n[3] || n[0] == n[2])
            return camber_options_refuse(
                p, "--bbox %s: not a box; give west,south,east,north in degrees, south below north", text);
        options->has_bbox = true;
        options->view.west = n[0];
        options->view.south = n[1];
        options->view.east = n[2];
        options->view.north = n[3];
        return CAMBER_EXIT_DONE;
    }
    if (spec->kind == CAMBER_OPTION_CENTER) {
        if (!parse_numbers(text, 2, n) || fabs(n[0]) > 180 || fabs(n[1]) > 90)
            return camber_options_refuse(p, "--center %s: not a place; give longitude,latitude in degrees", text);
        options->has_center = true;
        options->view.longitude = n[0];
        options->view.latitude = n[1];
        return CAMBER_EXIT_DONE;
    }
    const char *rest = text;
    if (!parse_count(&rest, &options->view.width) || (*rest != 'x' && *rest != 'X') ||
        (rest++, !parse_count(&rest, &options->view.height)) || *rest != 0)
        return camber_options_refuse(p, "--size %s: not a size; give WIDTHxHEIGHT in CSS px, as in 1024x768", text);
    if (options->view.width < 1 || options->view.height < 1)
        return camber_options_refuse(p, "--size %s: a side is 0; both sides must be 1 or more", text);
    return CAMBER_EXIT_DONE;
}

static int parse_place(const camber_option_reader *p, const char *text) {
    camber_tiles_place place;
    if (!camber_options_parse_place(text, &place))
        return camber_options_refuse(p, "--tile %s: not a tile; give zoom/column/row, as in 12/1950/1533", text);
    p->options->places[p->options->place_count++] = place;
    return CAMBER_EXIT_DONE;
}

bool camber_options_parse_place(const char *text, camber_tiles_place *place) {
    uint32_t n[3];
    for (int i = 0; i < 3; i++) {
        if ((i > 0 && *text++ != '/') || !parse_count(&text, &n[i]))
            return false;
    }
    if (*text || n[0] > 24 || n[1] >> n[0] || n[2] >> n[0])
        return false;
    *place = (camber_tiles_place){(int)n[0], n[1], n[2]};
    return true;
}

/* The text is stored in files, which use UTF-8. */
static int parse_words(const camber_option_reader *p, const camber_option_spec *spec, const char *text,
                       const char **value) {
    json_t *checked = json_string(text);
    json_decref(checked);
    if (!checked)
        return camber_options_refuse(p, "--%s: is not UTF-8; write it in a terminal whose locale is", spec->name);
    *value = text;
    return CAMBER_EXIT_DONE;
}

/* If two outputs were given, only one would be written; of two files or boxes to read, only one would be read. */
static int refuse_second(const camber_option_reader *p, const camber_option_spec *spec, const char *text) {
    if (spec->offset == offsetof(camber_options, output) && spec->letter == 'o')
        return camber_options_refuse(p, "-o %s: is the second output, after -o %s; give one of them", text,
                                     p->options->output);
    return camber_options_refuse(p, "--%s %s: is the second --%s; give one of them", spec->name, text, spec->name);
}

static int parse_value(const camber_option_reader *p, const camber_option_spec *spec, const char *text) {
    if (p->options->given[spec - camber_option_specs] && camber_option_once(spec))
        return refuse_second(p, spec, text);
    p->options->given[spec - camber_option_specs] = true;
    char *field = (char *)p->options + spec->offset;
    switch (spec->kind) {
    case CAMBER_OPTION_FLAG: *(bool *)(void *)field = true; return CAMBER_EXIT_DONE;
    case CAMBER_OPTION_TEXT:
    case CAMBER_OPTION_FILE:
    case CAMBER_OPTION_FOLDER:
    case CAMBER_OPTION_STYLE:
    case CAMBER_OPTION_DEVICE:
    case CAMBER_OPTION_WHERES:
    case CAMBER_OPTION_FONTS:
        if (*text == 0)
            return camber_options_refuse(p, "--%s: empty; give %s", spec->name, spec->argument);
        if (spec->kind == CAMBER_OPTION_WHERES)
            p->options->wheres[p->options->where_count++] = text;
        else if (spec->kind == CAMBER_OPTION_FONTS)
            p->options->fonts[p->options->font_count++] = text;
        else
            *(const char **)(void *)field = text;
        return CAMBER_EXIT_DONE;
    case CAMBER_OPTION_PLACES: return parse_place(p, text);
    case CAMBER_OPTION_NUMBER: {
        double number;
        const bool is_number = parse_numbers(text, 1, &number);
        if (!is_number || number < spec->least || number > spec->most)
            return camber_options_refuse(p, "--%s %s: %s; give a number from %g to %g", spec->name, text,
                                         is_number ? "out of range" : "not a number", spec->least, spec->most);
        *(double *)(void *)field = number;
        return CAMBER_EXIT_DONE;
    }
    case CAMBER_OPTION_WORDS: return parse_words(p, spec, text, (const char **)(void *)field);
    case CAMBER_OPTION_COUNT: {
        uint32_t count;
        const char *rest = text;
        if (!parse_count(&rest, &count) || *rest || count < spec->least || count > spec->most)
            return camber_options_refuse(p, "--%s %s: out of range; give a whole number from %g to %g", spec->name,
                                         text, spec->least, spec->most);
        *(uint32_t *)(void *)field = count;
        return CAMBER_EXIT_DONE;
    }
    case CAMBER_OPTION_BYTES:
        if (!parse_bytes(text, spec->least, spec->most, (uint64_t *)(void *)field))
            return camber_options_refuse(
                p, "--%s %s: not a size in bytes from 256K to 1024G; give one, as in 100000000, 512M or 2G", spec->name,
                text);
        return CAMBER_EXIT_DONE;
    case CAMBER_OPTION_CHOICE: return parse_choice(p, spec, text, (int *)(void *)field);
    case CAMBER_OPTION_SIZE:
    case CAMBER_OPTION_BBOX:
    case CAMBER_OPTION_CENTER: break;
    }
    return parse_view(p, spec, text);
}

/* ---- Arguments ---- */

static const char *verb_name(camber_verb verb) {
    for (size_t i = 0; i < camber_verb_count; i++)
        if (camber_verb_specs[i].verb == verb)
            return camber_verb_specs[i].name;
    return "";
}

static bool takes(const camber_option_spec *spec, camber_verb verb) {
    return spec->verbs & 1 << verb;
}

/* Returns how many letters of a name were added, left out, changed or swapped with their neighbour. */
static size_t count_slips(const char *typed, size_t length, const char *name) {
    size_t rows[3][NAME_LETTERS + 1], *above = rows[0], *row = rows[1], *spare = rows[2];
    const size_t width = strlen(name);
    if (length > NAME_LETTERS || width > NAME_LETTERS)
        return SIZE_MAX;
    for (size_t k = 0; k <= width; k++)
        row[k] = k;
    for (size_t i = 1; i <= length; i++) {
        size_t *const twice_above = above;
        above = row;
        row = spare;
        spare = twice_above;
        row[0] = i;
        for (size_t k = 1; k <= width; k++) {
            size_t least = above[k - 1] + (typed[i - 1] != name[k - 1]);
            least = above[k] + 1 < least ? above[k] + 1 : least;
            least = row[k - 1] + 1 < least ? row[k - 1] + 1 : least;
            if (i > 1 && k > 1 && typed[i - 1] == name[k - 2] && typed[i - 2] == name[k - 1])
                least = twice_above[k - 2] + 1 < least ? twice_above[k - 2] + 1 : least;
            row[k] = least;
        }
    }
    return row[width];
}

/* Returns the verb's option that was most likely meant; NULL if none is close. */
static const char *find_meant(camber_verb verb, const char *typed, size_t length) {
    const char *meant = NULL;
    size_t least = length / 3 + 1;
    for (size_t i = 0; i < camber_option_count; i++) {
        const size_t slips = count_slips(typed, length, camber_option_specs[i].name);
        if (!takes(&camber_option_specs[i], verb) || slips >= least)
            continue;
        least = slips;
        meant = camber_option_specs[i].name;
    }
    return meant;
}

static int unknown_option(const camber_option_reader *p, const char *name) {
    const camber_verb verb = p->options->verb;
    const char *gap = verb == CAMBER_VERB_NONE ? "" : " ", *letters = name + strspn(name, "-");
    const char *meant = find_meant(verb, letters, strcspn(letters, "="));
    return camber_options_refuse(p, "%s: no such option of camber%s%s; %s%s%s`camber%s%s --help` lists them", name, gap,
                                 verb_name(verb), meant ? "did you mean --" : "", meant ? meant : "", meant ? "? " : "",
                                 gap, verb_name(verb));
}

/* Parses --name, --name=value or --name value. *at moves past a value in an argument of its own. */
static int parse_long(const camber_option_reader *p, int argc, char **argv, int *at) {
    const char *name = argv[*at] + 2;
    const size_t length = strcspn(name, "=");
    for (size_t i = 0; i < camber_option_count; i++) {
        const camber_option_spec *spec = &camber_option_specs[i];
        if (strlen(spec->name) != length || strncmp(spec->name, name, length) != 0 || !takes(spec, p->options->verb))
            continue;
        if (!spec->argument && name[length])
            return camber_options_refuse(p, "--%s: takes no value; leave out the rest", spec->name);
        if (!spec->argument || name[length])
            return parse_value(p, spec, name + length + (name[length] == '='));
        if (*at + 1 >= argc)
            return camber_options_refuse(p, "--%s: no value; give %s", spec->name, spec->argument);
        return parse_value(p, spec, argv[++*at]);
    }
    return unknown_option(p, argv[*at]);
}

/* Parses -q, -qf, -o OUT or -oOUT. */
static int parse_short(const camber_option_reader *p, int argc, char **argv, int *at) {
    for (const char *letter = argv[*at] + 1; *letter; letter++) {
        const camber_option_spec *spec = NULL;
        for (size_t i = 0; i < camber_option_count && !spec; i++)
            if (camber_option_specs[i].letter == *letter && takes(&camber_option_specs[i], p->options->verb))
                spec = &camber_option_specs[i];
        if (!spec)
            return unknown_option(p, argv[*at]);
        if (spec->argument && letter[1])
            return parse_value(p, spec, letter + 1);
        if (spec->argument && *at + 1 >= argc)
            return camber_options_refuse(p, "-%c: no value; give %s", spec->letter, spec->argument);
        if (spec->argument)
            return parse_value(p, spec, argv[++*at]);
        const int status = parse_value(p, spec, "");
        if (status != CAMBER_EXIT_DONE)
            return status;
    }
    return CAMBER_EXIT_DONE;
}

/* "help" and "version" mean the same as --help and --version; "help" may be followed by a verb. */
static int parse_verb(const camber_option_reader *p, const char *text) {
    camber_options *options = p->options;
    if (strcmp(text, "help") == 0) {
        options->help = true;
        return CAMBER_EXIT_DONE;
    }
    if (strcmp(text, "version") == 0) {
        options->version = true;
        return CAMBER_EXIT_DONE;
    }
    for (size_t i = 0; i < camber_verb_count; i++)
        if (strcmp(camber_verb_specs[i].name, text) == 0) {
            options->verb = camber_verb_specs[i].verb;
            return CAMBER_EXIT_DONE;
        }
    char names[160] = "";
    for (size_t i = 0; i < camber_verb_count; i++)
        snprintf(names + strlen(names), sizeof names - strlen(names), "%s, ", camber_verb_specs[i].name);
    snprintf(names + strlen(names), sizeof names - strlen(names), "help, version");
#ifndef CAMBER_MAP
    if (!strcmp(text, "render") || !strcmp(text, "tessellate") || !strcmp(text, "style") || !strcmp(text, "tiles") ||
        !strcmp(text, "serve"))
        return camber_options_refuse(p, "%s: this build has no map (CAMBER_MAP=OFF); its verbs are %s", text, names);
#endif
    return camber_options_refuse(p, "%s: no such verb; it is one of %s", text, names);
}

int camber_options_parse(int argc, char **argv, camber_options *options, char *message, size_t message_size) {
    *options = (camber_options){.completion = -1,
                                .format = -1,
                                .theme = -1,
                                .method = -1,
                                .view = {.ratio = 1},
                                .zoom = NAN,
                                .dpi = NAN,
                                .margin_mm = NAN,
                                .fit = -1,
                                .bearing_deg = NAN,
                                .pitch_deg = NAN,
                                .simplify_px = NAN,
                                .runs = 9,
                                .min_zoom = UINT32_MAX,
                                .max_zoom = UINT32_MAX,
                                .windows = 24};
    const camber_option_reader p = {options, message, message_size, NULL};
    options->inputs = calloc((size_t)argc + 1, sizeof *options->inputs);
    options->wheres = calloc((size_t)argc + 1, sizeof *options->wheres);
    options->fonts = calloc((size_t)argc + 1, sizeof *options->fonts);
    options->places = calloc((size_t)argc + 1, sizeof *options->places);
    if (!options->inputs || !options->wheres || !options->fonts || !options->places) {
        (void)camber_options_refuse(&p, "out of memory for %d arguments; give fewer", argc);
        return CAMBER_EXIT_INTERNAL;
    }
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
        const bool drawn = options->verb == CAMBER_VERB_RENDER || options->verb == CAMBER_VERB_BENCH ||
                           options->verb == CAMBER_VERB_TILES || options->verb == CAMBER_VERB_SERVE;
        options->simplify_px = drawn && !options->polylines ? DRAWN_SIMPLIFY_PX : 0;
    }
    if (status == CAMBER_EXIT_DONE && !options->help && !options->version && options->completion < 0)
        status = camber_options_check(options, verb_name(options->verb), message, message_size);
    return status;
}

void camber_options_free(camber_options *options) {
    free(options->inputs);
    free(options->wheres);
    free(options->fonts);
    free(options->places);
}
