/* JSON to values and back. */
#ifndef CAMBER_STYLE_JSON_H
#define CAMBER_STYLE_JSON_H

#include "style/arena.h"
#include "style/value.h"

#include <jansson.h>

/* Deepest nesting of a value: jansson reads no deeper documents. */
#define CAMBER_VALUE_DEPTH 2048

/* Reads a document, all of whose numbers are doubles. Returns CAMBER_ERROR_INPUT (line and column are said),
 * CAMBER_ERROR_MEMORY. */
camber_status camber_json_read(camber_context *context, const char *bytes, size_t size_bytes, const char *name,
                               json_t **json);
/* Strings and keys stay the document's. false: no memory. */
bool camber_json_to_value(camber_arena *arena, const json_t *json, camber_value *value);
/* "a string": what the JSON value is. */
const char *camber_json_name(const json_t *json);

#endif
