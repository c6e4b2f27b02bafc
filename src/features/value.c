#include "features/value.h"

#include <stdlib.h>

static int compare_key(const void *key, const void *member) {
    return strcmp(key, ((const camber_member *)member)->key);
}

const camber_value *camber_object_get(const camber_value *object, const char *key) {
    if (object->type != CAMBER_VALUE_OBJECT || object->count == 0)
        return NULL;
    const camber_member *found = bsearch(key, object->members, object->count, sizeof *object->members, compare_key);
    return found ? &found->value : NULL;
}
