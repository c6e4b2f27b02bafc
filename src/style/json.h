/* Reads JSON and converts it to expression values. */
#ifndef CAMBER_STYLE_JSON_H
#define CAMBER_STYLE_JSON_H

#include "features/value.h"
#include "style/arena.h"

#include <jansson.h>

/* Deepest nesting of a value. jansson reads no deeper documents. */
#define CAMBER_VALUE_DEPTH 2048

/* Parses a document with jansson's flags, and skips a byte order mark. is_data: the document was not written for
 * camber, and is read as GDAL reads it: NaN becomes null, and numbers beyond a double become +-CAMBER_JSON_INFINITE.
 * Returns CAMBER_ERROR_INPUT (nothing is logged; *error has the reason), CAMBER_ERROR_MEMORY. */
camber_status camber_json_load(camber_context *context, const char *bytes, size_t size_bytes, size_t flags,
                               bool is_data, json_t **json, json_error_t *error);
/* Removes quotations of the document from jansson's message, because a style may name any file, and could show its
 * contents in this way. */
void camber_json_unquote(json_error_t *error);
/* Returns what to do about an error in a document that the user writes. */
const char *camber_json_cure(const json_error_t *error);
/* Reads a document. All of its numbers become doubles. Returns CAMBER_ERROR_INPUT (the message has line and column),
 * CAMBER_ERROR_MEMORY. */
camber_status camber_json_read(camber_context *context, const char *bytes, size_t size_bytes, const char *name,
                               json_t **json);
/* Converts JSON to a value. Strings and keys still belong to the document. false: out of memory. */
bool camber_json_to_value(camber_arena *arena, const json_t *json, camber_value *value);
/* Names the type of the JSON value: "a string". value is. */
const char *camber_json_name(const json_t *json);

#endif
