/* The attribution of a set of features: the credits that its files contain, as plain text, each text once. The origin
 * is never guessed from the data, because any road may have a key that OpenStreetMap also uses. */
#include "features/features.h"

#include <ctype.h>

/* A character entity of HTML. TileJSON's attributions are HTML. */
typedef struct entity {
    const char *name, *text;
} entity;

static const entity entities[] = {{"&copy;", "\xc2\xa9"}, {"&#169;", "\xc2\xa9"}, {"&#xa9;", "\xc2\xa9"},
                                  {"&amp;", "&"},         {"&lt;", "<"},          {"&gt;", ">"},
                                  {"&quot;", "\""},       {"&#39;", "'"},         {"&nbsp;", " "}};

static const entity *find_entity(const char *at) {
    for (size_t i = 0; i < sizeof entities / sizeof *entities; i++)
        if (strncmp(at, entities[i].name, strlen(entities[i].name)) == 0)
            return &entities[i];
    return NULL;
}

/* Returns the text after the tag that begins here, or NULL if no tag begins here. A tag has a name; a < without a name
 * is text. */
static const char *skip_tag(const char *at) {
    if (*at != '<' || !(isalpha((unsigned char)at[1]) || at[1] == '/' || at[1] == '!'))
        return NULL;
    for (char quote = 0; *at; at++) {
        if (*at == '>' && !quote)
            return at + 1;
        if (quote ? *at == quote : *at == '"' || *at == '\'')
            quote = quote ? 0 : *at;
    }
    return NULL;
}

/* Copies the text without tags, entities, control characters and superfluous blanks. plain has room for as many bytes
 * as text. Returns the length of the copy. */
static size_t make_plain(const char *text, char *plain) {
    size_t size = 0;
    while (*text) {
        const char *after_tag = skip_tag(text);
        const entity *named = find_entity(text);
        const char *put = named ? named->text : text;
        size_t count = named ? strlen(named->text) : 1;
        if (after_tag) {
            text = after_tag;
            continue;
        }
        text += named ? strlen(named->name) : 1;
        if ((unsigned char)*put <= ' ' || *put == 0x7f) {
            count = size && plain[size - 1] != ' ';
            put = " ";
        }
        memcpy(plain + size, put, count);
        size += count;
    }
    size -= size && plain[size - 1] == ' ';
    plain[size] = 0;
    return size;
}

static camber_status append(camber_features *features, const char *text, size_t size) {
    const size_t gap = features->attribution_size ? 2 : 0;
    if (!camber_grow(features->context, &features->attribution, &features->attribution_capacity,
                     features->attribution_size + gap + size + 1, 1))
        return CAMBER_ERROR_MEMORY;
    memcpy(features->attribution + features->attribution_size, ", ", gap);
    features->attribution_size += gap;
    memcpy(features->attribution + features->attribution_size, text, size + 1);
    features->attribution_size += size;
    return CAMBER_OK;
}

camber_status camber_features_add_attribution(camber_features *features, const char *text) {
    if (!text)
        return CAMBER_OK;
    char *plain = camber_alloc(features->context, strlen(text) + 1, 1);
    if (!plain)
        return CAMBER_ERROR_MEMORY;
    camber_status status = CAMBER_OK;
    const size_t size = make_plain(text, plain);
    const char *known = camber_features_get_attribution(features);
    if (size && !(known && strstr(known, plain)))
        status = append(features, plain, size);
    camber_free(features->context, plain);
    return status;
}

void camber_features_cut_attribution(camber_features *features, size_t size) {
    features->attribution_size = size;
    if (features->attribution)
        features->attribution[size] = 0;
}

const char *camber_features_get_attribution(const camber_features *features) {
    return features->attribution_size ? features->attribution : NULL;
}
