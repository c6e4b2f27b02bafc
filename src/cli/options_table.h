/* The table of verbs and options, shared by all its readers. */
#ifndef CAMBER_CLI_OPTIONS_TABLE_H
#define CAMBER_CLI_OPTIONS_TABLE_H

#include "cli/options.h"

#include <stddef.h>

/* The groups of verbs in --help, in their order there. */
typedef enum camber_verb_group {
    CAMBER_VERBS_DRAW,
    CAMBER_VERBS_CHECK,
    CAMBER_VERBS_MACHINE,
} camber_verb_group;

typedef struct camber_verb_spec {
    const char *name;
    camber_verb verb;
    const char *operands; /* as shown by --help */
    const char *summary;
    camber_verb_group group;
    const char *example; /* a command */
} camber_verb_spec;

/* The type of an option's member in camber_options, and its valid values. */
typedef enum camber_option_kind {
    CAMBER_OPTION_FLAG,   /* bool; the option takes no value */
    CAMBER_OPTION_TEXT,   /* const char * */
    CAMBER_OPTION_FILE,   /* const char *, a path */
    CAMBER_OPTION_FOLDER, /* const char *, a path */
    CAMBER_OPTION_FONTS,  /* camber_options.fonts: a folder; the option may be given several times */
    CAMBER_OPTION_STYLE,  /* const char *, the name of a built-in style, or a path */
    CAMBER_OPTION_DEVICE, /* const char *, cpu, gpu, or part of a name */
    CAMBER_OPTION_WORDS,  /* const char *, UTF-8; may be empty */
    CAMBER_OPTION_WHERES, /* camber_options.wheres: the option may be given several times */
    CAMBER_OPTION_PLACES, /* camber_options.places: z/x/y; the option may be given several times */
    CAMBER_OPTION_NUMBER, /* double, least to most */
    CAMBER_OPTION_COUNT,  /* uint32_t, least to most */
    CAMBER_OPTION_BYTES,  /* uint64_t, least to most: a number of bytes, or a number followed by K, M or G */
    CAMBER_OPTION_CHOICE, /* int: the index of the word in argument, in which words are separated by | */
    CAMBER_OPTION_SIZE,   /* this and the next two set several members of camber_options */
    CAMBER_OPTION_BBOX,
    CAMBER_OPTION_CENTER,
} camber_option_kind;

/* Help text for some verbs. "": they accept the option, but their help does not list it. */
typedef struct camber_option_note {
    int verbs; /* 0: end of the list */
    const char *help;
    const char *argument; /* NULL: the option's */
} camber_option_note;

typedef struct camber_option_spec {
    const char *name; /* without -- */
    char letter;      /* 0: none */
    camber_option_kind kind;
    int verbs; /* 1 << camber_verb for each verb that accepts it; CAMBER_VERB_NONE is the tool itself */
    size_t offset;
    const char *argument; /* NULL: the option takes no value */
    const char *help; /* for the tool's help, and for verbs without a note. "": not listed in either, because the option
                         is the former name of another, which scripts may still use */
    double least, most;
    camber_option_note notes[4];
} camber_option_spec;

/* A group of options in --help: it begins with this option of the table. */
typedef struct camber_option_group {
    const char *first, *title;
} camber_option_group;

extern const camber_verb_spec camber_verb_specs[];
extern const size_t camber_verb_count;
extern const camber_option_group camber_option_groups[];
extern const size_t camber_option_group_count;
extern const camber_option_spec camber_option_specs[];
extern const size_t camber_option_count;

/* Whether the option may be given several times. */
static inline bool camber_option_repeats(const camber_option_spec *spec) {
    return spec->kind == CAMBER_OPTION_WHERES || spec->kind == CAMBER_OPTION_PLACES ||
           spec->kind == CAMBER_OPTION_FONTS;
}
/* Whether giving the option twice is refused, because it says what is read, shown or written, and one of two would be
 * ignored. Of two settings the last one counts, so that a script can set some and let its caller override them. */
static inline bool camber_option_once(const camber_option_spec *spec) {
    return spec->kind == CAMBER_OPTION_FILE || spec->kind == CAMBER_OPTION_FOLDER || spec->kind == CAMBER_OPTION_BBOX ||
           spec->kind == CAMBER_OPTION_CENTER || spec->offset == offsetof(camber_options, layer);
}
/* Returns an option's help text for a verb, or for the tool (CAMBER_VERB_NONE). "": the verb's help does not list
 * it. */
const char *camber_option_help(const camber_option_spec *spec, camber_verb verb);
/* Returns an option's argument as that help shows it: the words that the verb accepts. */
const char *camber_option_argument(const camber_option_spec *spec, camber_verb verb);

/* ---- Reading and checking ---- */

typedef struct camber_option_reader {
    camber_options *options;
    char *message; /* why the options are refused: one line */
    size_t message_size;
    const char *verb; /* name of the verb; NULL: not known yet */
} camber_option_reader;

/* Writes the message, and returns CAMBER_EXIT_USAGE. */
int camber_options_refuse(const camber_option_reader *reader, const char *format, ...);
/* Whether a path ends with `end`, in lower or upper case, and has something before it. */
bool camber_path_ends_with(const char *path, const char *end);
/* If the format of a path cannot be determined, writes what is wrong with its extension: "unknown extension .xyz", or
 * "no extension". */
void camber_path_blame_extension(const char *path, char blame[64]);

#endif
