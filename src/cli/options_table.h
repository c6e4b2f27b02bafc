/* The table of verbs and options, for all that read it. */
#ifndef CAMBER_CLI_OPTIONS_TABLE_H
#define CAMBER_CLI_OPTIONS_TABLE_H

#include "cli/options.h"

typedef struct camber_verb_spec {
    const char *name;
    camber_verb verb;
    const char *operands; /* as --help shows them */
    const char *summary;
} camber_verb_spec;

/* The type of an option's field in camber_options, and what its value may be. */
typedef enum camber_option_kind {
    CAMBER_OPTION_FLAG,   /* bool; the option takes no value */
    CAMBER_OPTION_TEXT,   /* const char * */
    CAMBER_OPTION_FILE,   /* const char *, a path */
    CAMBER_OPTION_FOLDER, /* const char *, a path */
    CAMBER_OPTION_FONTS,  /* camber_options.fonts: folders, several times */
    CAMBER_OPTION_STYLE,  /* const char *, the name of a style that ships, or a path */
    CAMBER_OPTION_DEVICE, /* const char *, cpu, gpu, or part of a name */
    CAMBER_OPTION_WORDS,  /* const char *, UTF-8; may be empty */
    CAMBER_OPTION_WHERES, /* camber_options.wheres: the option may be given several times */
    CAMBER_OPTION_PLACES, /* camber_options.places: z/x/y, several times */
    CAMBER_OPTION_NUMBER, /* double, least to most */
    CAMBER_OPTION_COUNT,  /* uint32_t, least to most */
    CAMBER_OPTION_BYTES,  /* uint64_t, least to most: a number, and K, M or G behind it where it is not in bytes */
    CAMBER_OPTION_CHOICE, /* int: which word of argument it is, from 0; the words are parted by | */
    CAMBER_OPTION_SIZE,   /* these three: several fields of camber_options */
    CAMBER_OPTION_BBOX,
    CAMBER_OPTION_CENTER,
} camber_option_kind;

/* Help that some verbs have of their own. "": they take the option, and their help leaves it out. */
typedef struct camber_option_note {
    int verbs; /* 0: no more notes */
    const char *help;
    const char *argument; /* NULL: the option's */
} camber_option_note;

typedef struct camber_option_spec {
    const char *name; /* without its -- */
    char letter;      /* 0: none */
    camber_option_kind kind;
    int verbs; /* 1 << camber_verb of those that take it; CAMBER_VERB_NONE: the tool itself */
    size_t offset;
    const char *argument; /* NULL: the option takes no value */
    const char *help;     /* in the tool's help, and in that of verbs without a note. "": neither has it, since the
                           * option is the former name of another, which scripts may still use */
    double least, most;
    camber_option_note notes[4];
} camber_option_spec;

extern const camber_verb_spec camber_verb_specs[];
extern const size_t camber_verb_count;
extern const camber_option_spec camber_option_specs[];
extern const size_t camber_option_count;

/* Whether the option may be given several times. */
static inline bool camber_option_repeats(const camber_option_spec *spec) {
    return spec->kind == CAMBER_OPTION_WHERES || spec->kind == CAMBER_OPTION_PLACES ||
           spec->kind == CAMBER_OPTION_FONTS;
}
/* An option's help in that of a verb, or in the tool's (CAMBER_VERB_NONE). "": the verb's help leaves it out. */
const char *camber_option_help(const camber_option_spec *spec, camber_verb verb);
/* An option's argument as that help shows it: the words that the verb takes. */
const char *camber_option_argument(const camber_option_spec *spec, camber_verb verb);

/* ---- Reading and checking ---- */

typedef struct camber_option_reader {
    camber_options *options;
    char *message; /* why they are refused: one line */
    size_t message_size;
    const char *verb; /* its name; NULL: not known yet */
} camber_option_reader;

/* Writes the message, and returns CAMBER_EXIT_USAGE. */
int camber_options_refuse(const camber_option_reader *reader, const char *format, ...);
/* Whether a path ends so, in small or large letters, and has something before it. */
bool camber_path_ends_with(const char *path, const char *end);
/* Writes what is wrong with the extension of a path whose format cannot be told: "unknown extension .xyz", or "no
 * extension". */
void camber_path_blame_extension(const char *path, char blame[64]);

#endif
