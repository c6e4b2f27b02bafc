/* Parses an attribute filter into steps, and evaluates them.
 *
 * Input: a filter in OGR's SQL. Output: whether a way's tags pass it. As in GDAL, a comparison with a missing key
 * fails, strings are compared without regard to case, and AND binds more tightly than OR. NOT is left to GDAL, because
 * its versions differ in how NOT treats missing keys. */
#include "osm/where.h"

#include "features/osm_keys.h"

#include <ctype.h>
#include <string.h>
#include <strings.h>

enum { MOST_DEPTH = 32 };

typedef struct parser {
    camber_osm_where *where;
    const char *at;
    int depth;
} parser;

static bool parse_or(parser *self);

static void skip_space(parser *self) {
    while (isspace((unsigned char)*self->at))
        self->at++;
}

static bool take_sign(parser *self, const char *sign) {
    skip_space(self);
    const size_t length = strlen(sign);
    if (strncmp(self->at, sign, length) != 0)
        return false;
    self->at += length;
    return true;
}

/* A bare word must begin with a letter. */
static camber_osm_text see_word(parser *self) {
    skip_space(self);
    camber_osm_text word = {self->at, 0};
    if (isalpha((unsigned char)*self->at) || *self->at == '_')
        while (isalnum((unsigned char)word.at[word.length]) || word.at[word.length] == '_')
            word.length++;
    return word;
}

static bool take_word(parser *self, const char *wanted) {
    const camber_osm_text word = see_word(self);
    if (word.length != strlen(wanted) || strncasecmp(word.at, wanted, word.length) != 0)
        return false;
    self->at += word.length;
    return true;
}

/* Takes a string in quotes that has no escapes. */
static bool take_string(parser *self, char quote, camber_osm_text *text) {
    const char begin[] = {quote, 0};
    if (!take_sign(self, begin))
        return false;
    const char *end = strchr(self->at, quote);
    if (!end || end[1] == quote || memchr(self->at, '\\', (size_t)(end - self->at)))
        return false;
    *text = (camber_osm_text){self->at, (size_t)(end - self->at)};
    self->at = end + 1;
    return true;
}

/* Whether the word is a keyword of SQL, or one of GDAL's own columns. */
static bool is_reserved(camber_osm_text word) {
    static const char *const words[] = {
        "and",    "or",      "not",    "in",       "is",    "null",  "like",  "ilike",      "cast",
        "escape", "between", "select", "distinct", "where", "order", "case",  "from",       "join",
        "union",  "limit",   "offset", "as",       "on",    "by",    "asc",   "desc",       "exclude",
        "except", "hidden",  "all",    "left",     "fid",   "true",  "false", "other_tags", "all_tags"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strlen(words[i]) == word.length && strncasecmp(words[i], word.at, word.length) == 0)
            return true;
    return word.length >= 4 && (strncasecmp(word.at, "osm_", 4) == 0 || strncasecmp(word.at, "ogr_", 4) == 0);
}

static bool take_key(parser *self, uint32_t *key) {
    camber_osm_where *where = self->where;
    camber_osm_text name = see_word(self);
    if (name.length)
        self->at += name.length;
    else if (!take_string(self, '"', &name))
        return false;
    if (!camber_osm_is_key(name.at, name.length) || is_reserved(name))
        return false;
    for (*key = 0; *key < where->key_count; ++*key) {
        const camber_osm_text *known = &where->keys[*key];
        if (known->length == name.length && strncasecmp(known->at, name.at, name.length) == 0)
            return memcmp(known->at, name.at, name.length) == 0; /* keys that differ only in case are left to GDAL */
    }
    if (where->key_count == CAMBER_OSM_WHERE_KEYS)
        return false;
    where->keys[where->key_count++] = name;
    return true;
}

static bool add_step(parser *self, camber_osm_step step) {
    camber_osm_where *where = self->where;
    if (where->step_count == CAMBER_OSM_WHERE_STEPS)
        return false;
    where->steps[where->step_count++] = step;
    return true;
}

/* key IN ('a', 'b') */
static bool parse_in(parser *self, uint32_t key) {
    camber_osm_text text;
    if (!take_sign(self, "(") || !take_string(self, '\'', &text) ||
        !add_step(self, (camber_osm_step){CAMBER_OSM_STEP_EQUAL, key, text}))
        return false;
    while (take_sign(self, ","))
        if (!take_string(self, '\'', &text) || !add_step(self, (camber_osm_step){CAMBER_OSM_STEP_EQUAL, key, text}) ||
            !add_step(self, (camber_osm_step){.kind = CAMBER_OSM_STEP_OR}))
            return false;
    return take_sign(self, ")");
}

static bool parse_comparison(parser *self) {
    camber_osm_step step = {.kind = CAMBER_OSM_STEP_EQUAL};
    if (take_sign(self, "(")) {
        const bool parsed = ++self->depth < MOST_DEPTH && parse_or(self) && take_sign(self, ")");
        self->depth--;
        return parsed;
    }
    if (!take_key(self, &step.key))
        return false;
    if (take_word(self, "in"))
        return parse_in(self, step.key);
    if (take_word(self, "is")) {
        step.kind = take_word(self, "not") ? CAMBER_OSM_STEP_PRESENT : CAMBER_OSM_STEP_MISSING;
        return take_word(self, "null") && add_step(self, step);
    }
    if (take_sign(self, "<>") || take_sign(self, "!="))
        step.kind = CAMBER_OSM_STEP_DIFFERENT;
    else if (!take_sign(self, "="))
        return false;
    return take_string(self, '\'', &step.text) && add_step(self, step);
}

static bool parse_and(parser *self) {
    bool parsed = parse_comparison(self);
    while (parsed && take_word(self, "and"))
        parsed = parse_comparison(self) && add_step(self, (camber_osm_step){.kind = CAMBER_OSM_STEP_AND});
    return parsed;
}

static bool parse_or(parser *self) {
    bool parsed = parse_and(self);
    while (parsed && take_word(self, "or"))
        parsed = parse_and(self) && add_step(self, (camber_osm_step){.kind = CAMBER_OSM_STEP_OR});
    return parsed;
}

bool camber_osm_where_parse(const char *text, camber_osm_where *where) {
    parser self = {.where = where, .at = text};
    where->key_count = 0;
    where->step_count = 0;
    const bool parsed = parse_or(&self);
    skip_space(&self);
    return parsed && *self.at == 0;
}

static bool is_equal(camber_osm_text value, camber_osm_text text) {
    return value.at && value.length == text.length && strncasecmp(value.at, text.at, text.length) == 0;
}

bool camber_osm_where_passes(const camber_osm_where *where, const camber_osm_text *values) {
    bool results[CAMBER_OSM_WHERE_STEPS] = {false};
    size_t count = 0;
    for (size_t i = 0; i < where->step_count; i++) {
        const camber_osm_step *step = &where->steps[i];
        const camber_osm_text value = values[step->key];
        switch (step->kind) {
        case CAMBER_OSM_STEP_EQUAL: results[count++] = is_equal(value, step->text); break;
        case CAMBER_OSM_STEP_DIFFERENT: results[count++] = value.at && !is_equal(value, step->text); break;
        case CAMBER_OSM_STEP_MISSING: results[count++] = !value.at; break;
        case CAMBER_OSM_STEP_PRESENT: results[count++] = value.at; break;
        case CAMBER_OSM_STEP_AND: count--, results[count - 1] = results[count - 1] && results[count]; break;
        case CAMBER_OSM_STEP_OR: count--, results[count - 1] = results[count - 1] || results[count]; break;
        }
    }
    return results[0];
}
