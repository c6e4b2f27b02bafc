/* Names in another language.
 *
 * Input: a style document and the code of a language. Output: the same document, whose symbol layers read a feature's
 * name in that language first: name:de, which OpenStreetMap uses; then name_de, which some tiles use; and then the
 * property that they read before. */
#include "style/json.h"

#include "camber_map.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Whether a property is a name: name, name:latin, name_en, ... */
static bool is_name(const char *key) {
    return strncmp(key, "name", 4) == 0 && (key[4] == 0 || key[4] == ':' || key[4] == '_');
}

/* Makes ["coalesce", ["get", "name:de"], ["get", "name_de"], former]. It takes over the reference to former. */
static json_t *prefer(const char *language, json_t *former) {
    char colon[64], underscore[64];
    snprintf(colon, sizeof colon, "name:%s", language);
    snprintf(underscore, sizeof underscore, "name_%s", language);
    return json_pack("[s, [s, s], [s, s], o]", "coalesce", "get", colon, "get", underscore, former);
}

/* Turns a text of name tokens, such as "{name:latin}", into an expression. Other texts stay as they are. */
static json_t *translate_text(const char *language, const char *text) {
    char key[64];
    const size_t length = strlen(text);
    const char *end = text[0] == '{' ? strchr(text, '}') : NULL;
    if (!end || (size_t)(end - text) >= sizeof key)
        return json_string(text);
    snprintf(key, sizeof key, "%.*s", (int)(end - text - 1), text + 1);
    /* Two tokens, as in "{name:latin}\n{name:nonlatin}", are one name in two scripts. */
    const bool two = end[1] && strstr(end + 1, "{name") && text[length - 1] == '}';
    if (!is_name(key) || (end[1] && !two))
        return json_string(text);
    return prefer(language, json_pack("[s, [s, s], [s, s]]", "coalesce", "get", key, "get", "name"));
}

/* Returns a new reference; NULL: no memory. The reader of the document has limited its depth. */
static json_t *translate(const char *language, json_t *json) {
    size_t i;
    json_t *item;
    const char *op = json_string_value(json_array_get(json, 0)), *key = json_string_value(json_array_get(json, 1));
    if (!json_is_array(json))
        return json_incref(json);
    if (op && key && strcmp(op, "get") == 0 && json_array_size(json) == 2 && is_name(key))
        return prefer(language, json_incref(json));
    json_t *made = json_array();
    json_array_foreach(json, i, item) if (!made || json_array_append_new(made, translate(language, item)) != 0) {
        json_decref(made);
        return NULL;
    }
    return made;
}

static bool translate_layer(const char *language, json_t *layer) {
    json_t *layout = json_object_get(layer, "layout"), *text = json_object_get(layout, "text-field");
    const char *type = json_string_value(json_object_get(layer, "type"));
    if (!text || !type || strcmp(type, "symbol") != 0)
        return true;
    json_t *made = json_is_string(text) ? translate_text(language, json_string_value(text)) : translate(language, text);
    return made && json_object_set_new(layout, "text-field", made) == 0;
}

camber_status camber_style_translate(camber_context *context, const char *json, size_t size_bytes, const char *name,
                                     const char *language, char **translated) {
    json_t *root = NULL, *layer;
    size_t i;
    for (i = 0; language[i]; i++)
        if (!isalnum((unsigned char)language[i]) && language[i] != '-' && language[i] != '_')
            i = 64;
    if (i < 1 || i > 32)
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "language \"%.40s\": write a code such as de, pt or zh-Hant",
                           language);
    camber_status status = camber_json_read(context, json, size_bytes, name, &root);
    if (status != CAMBER_OK)
        return status;
    json_array_foreach(json_object_get(root, "layers"), i, layer) if (!translate_layer(language, layer)) status =
        CAMBER_ERROR_MEMORY;
    char *text = status == CAMBER_OK ? json_dumps(root, JSON_COMPACT) : NULL;
    const size_t size = text ? strlen(text) + 1 : 0;
    json_decref(root);
    if (!text)
        return camber_fail(context, CAMBER_ERROR_MEMORY, "%s: out of memory for its names", name);
    char *made = camber_alloc(context, size, 1);
    if (made)
        memcpy(made, text, size);
    free(text);
    *translated = made;
    return made ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}

void camber_style_free_text(camber_context *context, char *text) {
    camber_free(context, text);
}
