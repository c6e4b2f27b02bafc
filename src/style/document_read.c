/* Reads strings and numbers of a style document's root and layers, and tracks which warnings were given. */
#include "style/document.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>

bool camber_document_first_time(camber_document *d, const char *what) {
    for (size_t i = 0; i < d->warned_count; i++)
        if (strcmp(d->warned[i], what) == 0)
            return false;
    if (d->warned_count == CAMBER_WARNING_LIMIT)
        return false;
    d->warned[d->warned_count++] = what;
    if (d->warned_count == CAMBER_WARNING_LIMIT)
        camber_compiler_warn(&d->compiler, "there are more problems; further warnings are left out");
    return d->warned_count < CAMBER_WARNING_LIMIT;
}

bool camber_document_fail_memory(camber_document *d) {
    d->compiler.status = CAMBER_ERROR_MEMORY;
    return false;
}

bool camber_document_copy_string(camber_document *d, const json_t *json, char **copy) {
    *copy = camber_copy_string(d->compiler.context, json_string_value(json));
    return *copy || camber_document_fail_memory(d);
}

bool camber_document_continues(camber_document *d, size_t path_length) {
    if (!d->collects_errors || d->compiler.status != CAMBER_ERROR_INPUT)
        return false;
    d->compiler.path_length = path_length;
    d->compiler.status = CAMBER_OK;
    return true;
}

bool camber_document_read_string(camber_document *d, const json_t *object, const char *key, char **string) {
    camber_compiler *c = &d->compiler;
    const json_t *json = json_object_get(object, key);
    const size_t depth = c->path_length;
    if (!json)
        return true;
    camber_compiler_enter_key(c, key);
    if (!json_is_string(json))
        return camber_compiler_fail(c, "expected a string, found %s; write a name", camber_json_name(json)) ||
               camber_document_continues(d, depth);
    camber_compiler_leave(c);
    return camber_document_copy_string(d, json, string);
}

bool camber_document_read_number(camber_document *d, const json_t *object, const char *key, double low, double high,
                                 double *number) {
    camber_compiler *c = &d->compiler;
    const json_t *json = json_object_get(object, key);
    const size_t depth = c->path_length;
    if (!json)
        return true;
    camber_compiler_enter_key(c, key);
    if (!json_is_number(json))
        return camber_compiler_fail(c, "expected a number, found %s; use %g to %g", camber_json_name(json), low,
                                    high) ||
               camber_document_continues(d, depth);
    if (!(json_number_value(json) >= low && json_number_value(json) <= high))
        return camber_compiler_fail(c, "%g is out of range; use %g to %g", json_number_value(json), low, high) ||
               camber_document_continues(d, depth);
    *number = json_number_value(json);
    camber_compiler_leave(c);
    return true;
}

void camber_document_warn_unknown(camber_document *d, const json_t *object, const char *const *known,
                                  const char *what) {
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)object, key, value) {
        size_t i = 0;
        while (known[i] && strcmp(known[i], key) != 0)
            i++;
        if (known[i] || !camber_document_first_time(d, key))
            continue;
        camber_compiler_enter_key(&d->compiler, key);
        camber_compiler_warn(&d->compiler, "the specification does not have this in a %s; it is ignored", what);
        camber_compiler_leave(&d->compiler);
    }
}
