/* Reads JSON with jansson, and converts it to values of expressions.
 *
 * Input: bytes of a style or of data. Output: jansson's document, or values in an arena. Data may contain numbers that
 * jansson rejects (NaN, infinities, numbers beyond a double). They are replaced in a copy, so that it parses. */
#include "style/json.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <strings.h>

/* ---- Parsing ---- */

/* Words that GDAL reads as numbers and jansson rejects. */
static const struct {
    const char *word, *instead;
} words[] = {{"NaN", "null"}, {"Infinity", "1e308   "}, {"-Infinity", "-1e308   "}};

static bool is_beyond(const char *number, size_t size) {
    json_error_t error;
    /* Whether the number is beyond a double. Short numbers without an exponent are not, so most need no further test.
     */
    if (size < 300 && !memchr(number, 'e', size) && !memchr(number, 'E', size))
        return false;
    json_t *json = json_loadb(number, size, JSON_DECODE_ANY | JSON_DECODE_INT_AS_REAL, &error);
    json_decref(json);
    return !json && json_error_code(&error) == json_error_numeric_overflow;
}

/* Copies a token that is not a string, or one character of it, in a form that jansson accepts. Returns its size, and
 * the copy's size in *copied. */
static size_t copy_token(char *to, const char *from, size_t size, size_t *copied) {
    size_t length = 0;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        length = strlen(words[i].word);
        if (size < length || strncasecmp(from, words[i].word, length) != 0)
            continue;
        *copied = strlen(words[i].instead);
        memcpy(to, words[i].instead, *copied);
        return length;
    }
    for (length = 0; length < size && from[length] && strchr("+-.0123456789eE", from[length]);)
        length++;
    length = length ? length : 1;
    *copied = length;
    memcpy(to, from, length);
    if (is_beyond(from, length)) {
        const char *instead = *from == '-' ? "-1e308" : "1e308";
        memset(to, ' ', length);
        memcpy(to, instead, strlen(instead));
    }
    return length;
}

/* Copies a document and replaces numbers that jansson rejects. Lines and columns stay the same, except after a NaN. */
static size_t replace_refused(char *to, const char *from, size_t size) {
    size_t written = 0, copied;
    bool in_string = false;
    for (size_t at = 0; at < size; written += copied) {
        if (!in_string && from[at] != '"') {
            at += copy_token(to + written, from + at, size - at, &copied);
            continue;
        }
        copied = in_string && from[at] == '\\' && at + 1 < size ? 2 : 1;
        in_string = !in_string || from[at] != '"';
        memcpy(to + written, from + at, copied);
        at += copied;
    }
    return written;
}

camber_status camber_json_load(camber_context *context, const char *bytes, size_t size_bytes, size_t flags,
                               bool is_data, json_t **json, json_error_t *error) {
    if (size_bytes >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0) {
        bytes += 3;
        size_bytes -= 3;
    }
    *json = json_loadb(bytes, size_bytes, flags, error);
    const enum json_error_code code = *json ? json_error_unknown : json_error_code(error);
    if (is_data && (code == json_error_numeric_overflow || code == json_error_invalid_syntax)) {
        char *mended = camber_alloc(context, size_bytes + size_bytes / 3 + 1, 1); /* null is longer than NaN */
        if (!mended)
            return CAMBER_ERROR_MEMORY;
        *json = json_loadb(mended, replace_refused(mended, bytes, size_bytes), flags, error);
        camber_free(context, mended);
    }
    return *json ? CAMBER_OK : CAMBER_ERROR_INPUT;
}

const char *camber_json_cure(const json_error_t *error) {
    return json_error_code(error) == json_error_invalid_utf8 ? "save it as UTF-8" : "correct the JSON there";
}

void camber_json_unquote(json_error_t *error) {
    char *quoted = strstr(error->text, " near '");
    if (json_error_code(error) == json_error_invalid_utf8)
        snprintf(error->text, JSON_ERROR_TEXT_LENGTH - 1, "not UTF-8"); /* the last byte is the error's code */
    else if (quoted)
        *quoted = 0;
}

static camber_status fail(camber_context *context, const char *name, json_error_t *error) {
    camber_json_unquote(error);
    /* If jansson runs out of memory, it usually reports a wrong character. */
    if (json_error_code(error) == json_error_out_of_memory || errno == ENOMEM)
        return camber_fail(context, CAMBER_ERROR_MEMORY, "%s: out of memory; make the document shorter", name);
    return camber_fail(context, CAMBER_ERROR_INPUT, "%s: line %d, column %d: %s; %s", name, error->line, error->column,
                       error->text, camber_json_cure(error));
}

camber_status camber_json_read(camber_context *context, const char *bytes, size_t size_bytes, const char *name,
                               json_t **json) {
    json_error_t error;
    errno = 0;
    const camber_status status =
        camber_json_load(context, bytes, size_bytes, JSON_DECODE_ANY | JSON_DECODE_INT_AS_REAL, false, json, &error);
    return status == CAMBER_ERROR_INPUT ? fail(context, name, &error) : status;
}

/* ---- Values ---- */

const char *camber_json_name(const json_t *json) {
    if (!json)
        return "nothing";
    switch (json_typeof(json)) {
    case JSON_OBJECT: return "an object";
    case JSON_ARRAY: return "an array";
    case JSON_STRING: return "a string";
    case JSON_INTEGER:
    case JSON_REAL: return "a number";
    case JSON_TRUE:
    case JSON_FALSE: return "a boolean";
    case JSON_NULL: break;
    }
    return "null";
}

static int compare_members(const void *left, const void *right) {
    return strcmp(((const camber_member *)left)->key, ((const camber_member *)right)->key);
}

static bool read_value(camber_arena *arena, const json_t *json, unsigned depth, camber_value *value);

static bool read_array(camber_arena *arena, const json_t *json, unsigned depth, camber_value *value) {
    const size_t count = json_array_size(json);
    camber_value *items = camber_arena_alloc(arena, count * sizeof *items);
    if (!items || count > UINT32_MAX)
        return false;
    for (size_t i = 0; i < count; i++)
        if (!read_value(arena, json_array_get(json, i), depth, &items[i]))
            return false;
    *value = (camber_value){.type = CAMBER_VALUE_ARRAY, .count = (uint32_t)count, .items = items};
    return true;
}

static bool read_object(camber_arena *arena, const json_t *json, unsigned depth, camber_value *value) {
    const size_t count = json_object_size(json);
    camber_member *members = camber_arena_alloc(arena, count * sizeof *members);
    if (!members || count > UINT32_MAX)
        return false;
    uint32_t place = 0;
    const char *key;
    json_t *item;
    json_object_foreach((json_t *)(uintptr_t)json, key, item) {
        members[place] = (camber_member){.key = key, .position = place};
        if (!read_value(arena, item, depth, &members[place].value))
            return false;
        place++;
    }
    qsort(members, count, sizeof *members, compare_members);
    *value = (camber_value){.type = CAMBER_VALUE_OBJECT, .count = (uint32_t)count, .members = members};
    return true;
}

static bool read_value(camber_arena *arena, const json_t *json, unsigned depth, camber_value *value) {
    *value = (camber_value){.type = CAMBER_VALUE_NULL, .boolean = true};
    if (json_is_boolean(json))
        *value = (camber_value){.type = CAMBER_VALUE_BOOL, .boolean = json_is_true(json)};
    else if (json_is_number(json))
        *value = (camber_value){.type = CAMBER_VALUE_NUMBER, .number = json_number_value(json)};
    else if (json_is_string(json))
        *value = (camber_value){.type = CAMBER_VALUE_STRING, .string = json_string_value(json)};
    else if (depth >= CAMBER_VALUE_DEPTH)
        return json_is_null(json);
    else if (json_is_array(json))
        return read_array(arena, json, depth + 1, value);
    else if (json_is_object(json))
        return read_object(arena, json, depth + 1, value);
    return true;
}

bool camber_json_to_value(camber_arena *arena, const json_t *json, camber_value *value) {
    return read_value(arena, json, 0, value);
}
