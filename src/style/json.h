/* JSON to values and back. */
#ifndef CAMBER_STYLE_JSON_H
#define CAMBER_STYLE_JSON_H

#include "features/value.h"
#include "style/arena.h"

#include <jansson.h>

/* Deepest nesting of a value: jansson reads no deeper documents. */
#define CAMBER_VALUE_DEPTH 2048

/* Parses with jansson's flags, after a byte order mark. is_data: not written for camber, and read as GDAL reads it: NaN
 * is null, and numbers beyond a double are +-CAMBER_JSON_INFINITE. Returns CAMBER_ERROR_INPUT (*error says why, and
 * nothing is logged), CAMBER_ERROR_MEMORY. */
camber_status camber_json_load(camber_context *context, const char *bytes, size_t size_bytes, size_t flags,
                               bool is_data, json_t **json, json_error_t *error);
/* Removes quotes of the document from jansson's message: a style may name any file, and any file may be named as
 * one. */
void camber_json_unquote(json_error_t *error);
/* The cure for an error in a document that the user writes. */
const char *camber_json_cure(const json_error_t *error);
/* Reads a document, all of whose numbers are doubles. Returns CAMBER_ERROR_INPUT (line and column are said),
 * CAMBER_ERROR_MEMORY. */
camber_status camber_json_read(camber_context *context, const char *bytes, size_t size_bytes, const char *name,
                               json_t **json);
/* Strings and keys stay the document's. false: no memory. */
bool camber_json_to_value(camber_arena *arena, const json_t *json, camber_value *value);
/* "a string": what the JSON value is. */
const char *camber_json_name(const json_t *json);

#endif
