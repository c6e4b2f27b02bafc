/* Checks constants of properties against the table: names and ranges. */
#include "style/compiler.h"
#include <math.h>
#include <stdio.h>

camber_typing camber_property_typing(const camber_property *property) {
    if (property->type != CAMBER_TYPE_ARRAY)
        return camber_typing_of(property->type);
    return camber_typing_array(camber_typing_of(property->item),
                               property->length ? property->length : CAMBER_ANY_LENGTH);
}

static bool check_name(camber_compiler *c, const camber_property *property, const char *name) {
    char names[256] = "";
    size_t used = 0;
    for (size_t i = 0; property->values[i]; i++) {
        if (strcmp(property->values[i], name) == 0)
            return true;
        const char *between = i == 0 ? "" : property->values[i + 1] ? ", " : " or ";
        if (used < sizeof names)
            used += (size_t)snprintf(names + used, sizeof names - used, "%s\"%s\"", between, property->values[i]);
    }
    return camber_compiler_fail(c, "\"%.64s\" is not a %s; use %s", name, property->name, names);
}

enum { RANGE_SIZE = 64 };

static const char *write_range(const camber_property *property, char range[RANGE_SIZE]) {
    if (property->high < HUGE_VAL)
        snprintf(range, RANGE_SIZE, "%g to %g", property->low, property->high);
    else
        snprintf(range, RANGE_SIZE, "%g or more", property->low);
    return range;
}

static bool check_range(camber_compiler *c, const camber_property *property, const camber_value *value) {
    const bool ranged = property->low < 0.0 || property->high > 0.0;
    if (value->type == CAMBER_VALUE_NUMBER && !isfinite(value->number))
        return camber_compiler_fail(c, "the number is %s; correct what makes it",
                                    isnan(value->number) ? "none (NaN)" : "infinite");
    if (!ranged || value->type != CAMBER_VALUE_NUMBER ||
        (value->number >= property->low && value->number <= property->high))
        return true;
    char range[RANGE_SIZE];
    return camber_compiler_fail(c, "%g is out of range; use %s", value->number, write_range(property, range));
}

/* Whether a list is of dashes. */
static bool is_dashes(const camber_property *property) {
    return property->type == CAMBER_TYPE_ARRAY && property->item == CAMBER_TYPE_NUMBER && property->length == 0;
}

/* Tells who checks a style what an odd list of dashes means, since SVG has another rule. It is drawn without a word. */
static void warn_of_odd_list(camber_compiler *c, const camber_property *property, size_t count) {
    if (!is_dashes(property) || count % 2 == 0 || !c->checks)
        return;
    if (count == 1)
        camber_compiler_warn(c, "a list of one length is a solid line; add a gap, or leave the list out");
    else
        camber_compiler_warn(c, "of an odd list of lengths the last dash runs on into the first; add a gap at its end "
                                "if they should be apart");
}

static bool check_item(camber_compiler *c, const camber_property *property, const camber_value *item) {
    if (item->type == CAMBER_VALUE_STRING && property->values)
        return check_name(c, property, item->string);
    return check_range(c, property, item);
}

bool camber_property_check(camber_compiler *c, const camber_property *property, const camber_value *value) {
    if (value->type == CAMBER_VALUE_ARRAY && is_dashes(property) && value->count > CAMBER_DASH_LENGTHS_MAX)
        camber_compiler_warn(c, "of %u lengths only the first %d are drawn; write fewer", value->count,
                             CAMBER_DASH_LENGTHS_MAX);
    for (uint32_t i = 0; value->type == CAMBER_VALUE_ARRAY && i < value->count; i++)
        if (!check_item(c, property, &value->items[i]))
            return false;
    if (value->type == CAMBER_VALUE_ARRAY)
        warn_of_odd_list(c, property, value->count);
    return check_item(c, property, value);
}

/* Warns of an output: when evaluated, a number out of range is clamped, and an unknown name becomes the default. */
static void warn_of_output(camber_compiler *c, const camber_property *property, const json_t *json) {
    const bool ranged = property->low < 0.0 || property->high > 0.0;
    const double number = json_number_value(json);
    const char *name = json_string_value(json);
    char range[RANGE_SIZE];
    if (c->held_count >= CAMBER_HELD_LIMIT)
        return;
    if (ranged && json_is_number(json) && (number < property->low || number > property->high)) {
        c->held_count++;
        camber_compiler_warn(c, "%g is out of range and held to it; use %s", number, write_range(property, range));
    }
    if (!name || !property->values)
        return;
    for (size_t i = 0; property->values[i]; i++)
        if (strcmp(property->values[i], name) == 0)
            return;
    c->held_count++;
    camber_compiler_warn(c, "\"%.64s\" is not a %s; features with it are drawn with the default", name, property->name);
}

bool camber_property_check_output(camber_compiler *c, const camber_property *property, const json_t *json) {
    warn_of_output(c, property, json);
    for (size_t i = 0; i < json_array_size(json); i++) {
        const json_t *item = json_array_get(json, i);
        const camber_value number = {.type = CAMBER_VALUE_NUMBER, .number = json_number_value(item)};
        const camber_value name = {.type = CAMBER_VALUE_STRING, .string = json_string_value(item)};
        camber_compiler_enter_index(c, i);
        if ((json_is_number(item) && !check_item(c, property, &number)) ||
            (json_is_string(item) && !check_item(c, property, &name)))
            return false;
        camber_compiler_leave(c);
    }
    warn_of_odd_list(c, property, json_array_size(json));
    return true;
}
