/* Types of expressions: making them, comparing them and naming them.
 *
 * Arrays carry the type of their items and their length, up to three levels deep; deeper ones hold any value.
 */
#include "style/typing.h"

#include <stdio.h>

camber_typing camber_typing_array(camber_typing item, uint32_t length) {
    camber_typing made = {.type = CAMBER_TYPE_ARRAY, .item = item.type, .depth = 1, .lengths = {length}};
    if (item.type != CAMBER_TYPE_ARRAY)
        return made;
    if (item.depth == CAMBER_ARRAY_DEPTH) {
        made.item = CAMBER_TYPE_VALUE;
        return made;
    }
    made.item = item.item;
    made.depth = item.depth + 1;
    memcpy(made.lengths + 1, item.lengths, item.depth * sizeof *item.lengths);
    return made;
}

camber_typing camber_typing_item(camber_typing array) {
    if (array.depth < 2)
        return camber_typing_of(array.depth ? array.item : CAMBER_TYPE_VALUE);
    camber_typing item = {.type = CAMBER_TYPE_ARRAY, .item = array.item, .depth = array.depth - 1};
    memcpy(item.lengths, array.lengths + 1, item.depth * sizeof *item.lengths);
    return item;
}

camber_typing camber_typing_merge(camber_typing a, camber_typing b) {
    return camber_typing_of(a.type == b.type && a.type != CAMBER_TYPE_ARRAY ? a.type : CAMBER_TYPE_VALUE);
}

/* The type of an array. The walk ends at the first item whose type differs, since the items then have no common
 * type. */
static camber_typing typing_of_items(const camber_value *array, unsigned depth) {
    camber_typing item = camber_typing_of(CAMBER_TYPE_VALUE);
    for (uint32_t i = 0; i < array->count; i++) {
        const camber_value *value = &array->items[i];
        camber_typing found;
        if (value->type != CAMBER_VALUE_ARRAY)
            found = camber_typing_of_value(value);
        else if (i == 0 && depth < CAMBER_ARRAY_DEPTH)
            found = typing_of_items(value, depth + 1);
        else
            found = camber_typing_of(CAMBER_TYPE_ARRAY);
        if (i == 0)
            item = found;
        else
            item = camber_typing_merge(item, found);
        if (i > 0 && item.type == CAMBER_TYPE_VALUE)
            break;
    }
    return camber_typing_array(item, array->count);
}

camber_typing camber_typing_of_value(const camber_value *value) {
    switch (value->type) {
    case CAMBER_VALUE_NULL: return camber_typing_of(CAMBER_TYPE_NULL);
    case CAMBER_VALUE_BOOL: return camber_typing_of(CAMBER_TYPE_BOOL);
    case CAMBER_VALUE_NUMBER: return camber_typing_of(CAMBER_TYPE_NUMBER);
    case CAMBER_VALUE_STRING: return camber_typing_of(value->boolean ? CAMBER_TYPE_IMAGE : CAMBER_TYPE_STRING);
    case CAMBER_VALUE_COLOR: return camber_typing_of(CAMBER_TYPE_COLOR);
    case CAMBER_VALUE_ARRAY: return typing_of_items(value, 1);
    case CAMBER_VALUE_FORMATTED: return camber_typing_of(CAMBER_TYPE_FORMATTED);
    case CAMBER_VALUE_OBJECT: break;
    }
    return camber_typing_of(CAMBER_TYPE_OBJECT);
}

bool camber_typing_fits(camber_typing expected, camber_typing actual) {
    for (;;) {
        if (actual.type == CAMBER_TYPE_ERROR)
            return true;
        if (expected.type == CAMBER_TYPE_VALUE)
            return actual.type != CAMBER_TYPE_COLLATOR;
        if (expected.type != actual.type)
            return false;
        if (expected.type != CAMBER_TYPE_ARRAY)
            return true;
        if (expected.lengths[0] != CAMBER_ANY_LENGTH && expected.lengths[0] != actual.lengths[0])
            return false;
        const camber_typing item = camber_typing_item(actual);
        if (actual.lengths[0] == 0 && item.type == CAMBER_TYPE_VALUE)
            return true;
        expected = camber_typing_item(expected);
        actual = item;
    }
}

static const char *name_of(camber_type type) {
    switch (type) {
    case CAMBER_TYPE_VALUE: return "value";
    case CAMBER_TYPE_NULL: return "null";
    case CAMBER_TYPE_BOOL: return "boolean";
    case CAMBER_TYPE_NUMBER: return "number";
    case CAMBER_TYPE_STRING: return "string";
    case CAMBER_TYPE_COLOR: return "color";
    case CAMBER_TYPE_ARRAY: return "array";
    case CAMBER_TYPE_OBJECT: return "object";
    case CAMBER_TYPE_IMAGE: return "resolvedImage";
    case CAMBER_TYPE_FORMATTED: return "formatted";
    case CAMBER_TYPE_PADDING: return "padding";
    case CAMBER_TYPE_ANCHORS: return "variableAnchorOffsetCollection";
    case CAMBER_TYPE_COLLATOR: return "collator";
    case CAMBER_TYPE_ERROR: break;
    }
    return "error";
}

const char *camber_typing_write(camber_typing typing, char text[CAMBER_TYPING_TEXT_SIZE]) {
    if (typing.type != CAMBER_TYPE_ARRAY) {
        snprintf(text, CAMBER_TYPING_TEXT_SIZE, "%s", name_of(typing.type));
        return text;
    }
    char item[CAMBER_TYPING_TEXT_SIZE];
    const camber_typing inner = camber_typing_item(typing);
    /* An item's text is shorter by its brackets, so three nested arrays fit. */
    camber_typing_write(inner, item);
    if (typing.lengths[0] != CAMBER_ANY_LENGTH)
        snprintf(text, CAMBER_TYPING_TEXT_SIZE, "array<%.70s, %u>", item, typing.lengths[0]);
    else if (inner.type == CAMBER_TYPE_VALUE)
        snprintf(text, CAMBER_TYPING_TEXT_SIZE, "array");
    else
        snprintf(text, CAMBER_TYPING_TEXT_SIZE, "array<%.70s>", item);
    return text;
}

const char *camber_typing_name(camber_typing typing, char text[CAMBER_TYPING_TEXT_SIZE]) {
    static const char *const names[] = {
        [CAMBER_TYPE_VALUE] = "any value",   [CAMBER_TYPE_NULL] = "null",
        [CAMBER_TYPE_BOOL] = "a boolean",    [CAMBER_TYPE_NUMBER] = "a number",
        [CAMBER_TYPE_STRING] = "a string",   [CAMBER_TYPE_COLOR] = "a colour",
        [CAMBER_TYPE_OBJECT] = "an object",  [CAMBER_TYPE_IMAGE] = "an image",
        [CAMBER_TYPE_ARRAY] = "an array",    [CAMBER_TYPE_COLLATOR] = "a collator",
        [CAMBER_TYPE_ERROR] = "an error",    [CAMBER_TYPE_FORMATTED] = "a formatted text",
        [CAMBER_TYPE_PADDING] = "a padding", [CAMBER_TYPE_ANCHORS] = "anchors with offsets"};
    if (typing.type != CAMBER_TYPE_ARRAY)
        return names[typing.type];
    char whole[CAMBER_TYPING_TEXT_SIZE];
    camber_typing_write(typing, whole);
    snprintf(text, CAMBER_TYPING_TEXT_SIZE, "an %.90s", whole);
    return text;
}
