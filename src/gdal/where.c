/* Attribute filters: finds the words of a filter that may be keys, and a key that no feature has, so that nothing
 * passes the filter. */
#include "gdal/vector_file.h"

#include <cpl_string.h>
#include <ctype.h>
#include <stdio.h>
#include <string.h>

const char *camber_where_next(const char **at, size_t *length) {
    bool quoted = false;
    for (const char *c = *at; *c; c++) {
        if (*c == '\'')
            quoted = !quoted;
        if (quoted || !camber_osm_is_key_character(*c))
            continue;
        *length = 0;
        while (camber_osm_is_key_character(c[*length]))
            ++*length;
        *at = c + *length;
        return c;
    }
    return NULL;
}

/* ---- A key that no feature has ---- */

/* Whether a word is a keyword of SQL, a type of CAST, or a number, none of which is a key. */
static bool is_sql(const char *word, size_t length) {
    static const char *const words[] = {"and",     "or",      "not",      "in",    "is",        "null", "like",
                                        "ilike",   "between", "escape",   "cast",  "as",        "true", "false",
                                        "integer", "bigint",  "smallint", "float", "character", "date", "timestamp"};
    if (isdigit((unsigned char)*word) || *word == '-' || *word == '.')
        return true;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strlen(words[i]) == length && EQUALN(words[i], word, length))
            return true;
    return false;
}

enum { MOST_KEYS = 32 };

typedef struct named_keys {
    int fields[MOST_KEYS];
    size_t count;
} named_keys;

/* Lists the fields of the layer that the filter names. Those that a feature has are removed later. */
static void list_keys(const char *where, OGRFeatureDefnH schema, named_keys *keys) {
    size_t length;
    const char *word;
    while (keys->count < MOST_KEYS && (word = camber_where_next(&where, &length)) != NULL) {
        char key[256];
        if (length >= sizeof key || is_sql(word, length))
            continue;
        snprintf(key, sizeof key, "%.*s", (int)length, word);
        const int field = OGR_FD_GetFieldIndex(schema, key);
        if (field >= 0)
            keys->fields[keys->count++] = field;
    }
}

/* Removes the keys that the feature has. */
static void cross_out(named_keys *keys, OGRFeatureH feature) {
    size_t left = 0;
    for (size_t i = 0; i < keys->count; i++)
        if (!OGR_F_IsFieldSetAndNotNull(feature, keys->fields[i]))
            keys->fields[left++] = keys->fields[i];
    keys->count = left;
}

bool camber_where_find_unknown(const camber_dataset *dataset, OGRLayerH layer, char *key, size_t size) {
    OGRFeatureDefnH schema = OGR_L_GetLayerDefn(layer);
    named_keys keys = {.count = 0};
    list_keys(dataset->desc->where, schema, &keys);
    OGR_L_SetAttributeFilter(layer, NULL);
    GDALDatasetResetReading(dataset->handle);
    OGRFeatureH feature;
    while (keys.count && (feature = GDALDatasetGetNextFeature(dataset->handle, NULL, NULL, NULL, NULL)) != NULL) {
        if (OGR_F_GetDefnRef(feature) == schema)
            cross_out(&keys, feature);
        OGR_F_Destroy(feature);
    }
    if (keys.count)
        snprintf(key, size, "%s", OGR_Fld_GetNameRef(OGR_FD_GetFieldDefn(schema, keys.fields[0])));
    return keys.count > 0;
}

/* ---- Fields ---- */

void camber_where_list_fields(OGRLayerH layer, char *text, size_t size) {
    OGRFeatureDefnH schema = OGR_L_GetLayerDefn(layer);
    const int count = OGR_FD_GetFieldCount(schema);
    size_t used = 0;
    snprintf(text, size, "(none)");
    for (int i = 0; i < count; i++) {
        const char *name = OGR_Fld_GetNameRef(OGR_FD_GetFieldDefn(schema, i)), *gap = used ? ", " : "";
        const size_t length = strlen(gap) + strlen(name);
        const bool fits = used + length + sizeof ", ..." <= size;
        used += (size_t)snprintf(text + used, size - used, "%s%s", fits ? gap : ", ", fits ? name : "...");
        if (!fits)
            return;
    }
}
