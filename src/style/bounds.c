/* Bounds the values of a layer's numeric properties before any feature is known.
 *
 * Input: a layer's property and a zoom. Output: its value, if features do not change it. Otherwise the document is
 * walked: an expression that chooses among outputs is bounded by the largest bound of an output, and a sum or product
 * by the sum or product of its operands' bounds. A value read from a feature has no bound. */
#include "style/bounds.h"

#include "style/properties.h"

#include <math.h>

/* Documents nested more deeply have no bound. */
enum { DEEPEST = 64 };

static double bound_of(const json_t *json, int depth);

/* Returns the largest bound of every step-th item, starting with first, and of the last item if and_last is set. */
static double largest(const json_t *array, size_t first, size_t step, bool and_last, int depth) {
    double most = 0.0;
    for (size_t i = first; i < json_array_size(array); i += step)
        most = fmax(most, bound_of(json_array_get(array, i), depth));
    if (and_last)
        most = fmax(most, bound_of(json_array_get(array, json_array_size(array) - 1), depth));
    return most;
}

static double bound_of_product(const json_t *array, int depth) {
    double product = 1.0;
    for (size_t i = 1; i < json_array_size(array); i++)
        product *= bound_of(json_array_get(array, i), depth);
    return isnan(product) ? INFINITY : product;
}

static double bound_of_sum(const json_t *array, int depth) {
    double sum = 0.0;
    for (size_t i = 1; i < json_array_size(array); i++)
        sum += bound_of(json_array_get(array, i), depth);
    return sum;
}

static bool is_operator(const json_t *array, const char *name) {
    const char *own = json_string_value(json_array_get(array, 0));
    return own && strcmp(own, name) == 0;
}

/* Bounds an item of a list: by the largest number of the list, if the document has it as a literal. */
static double bound_of_item(const json_t *array, int depth) {
    const json_t *literal = json_array_get(array, 2), *list = json_array_get(literal, 1);
    return is_operator(literal, "literal") && json_is_array(list) ? largest(list, 0, 1, false, depth) : INFINITY;
}

static double bound_of_expression(const json_t *array, int depth) {
    if (is_operator(array, "let"))
        return bound_of(json_array_get(array, json_array_size(array) - 1), depth);
    if (is_operator(array, "at"))
        return bound_of_item(array, depth);
    if (is_operator(array, "match"))
        return largest(array, 3, 2, true, depth);
    if (is_operator(array, "case"))
        return largest(array, 2, 2, true, depth);
    if (is_operator(array, "step"))
        return largest(array, 2, 2, false, depth);
    if (is_operator(array, "interpolate"))
        return largest(array, 4, 2, false, depth); /* a curve of any kind stays between its outputs */
    if (is_operator(array, "coalesce") || is_operator(array, "max") || is_operator(array, "abs"))
        return largest(array, 1, 1, false, depth);
    if (is_operator(array, "+") || is_operator(array, "-"))
        return bound_of_sum(array, depth);
    if (is_operator(array, "*"))
        return bound_of_product(array, depth);
    return is_operator(array, "zoom") ? 24.0 : INFINITY;
}

/* Bounds an older function. An identity function returns a feature's own value, so it has no bound. */
static double bound_of_function(const json_t *function, int depth) {
    const char *type = json_string_value(json_object_get(function, "type"));
    const json_t *stops = json_object_get(function, "stops"), *other = json_object_get(function, "default");
    if ((type && strcmp(type, "identity") == 0) || !json_is_array(stops))
        return INFINITY;
    double most = other ? bound_of(other, depth) : 0.0;
    for (size_t i = 0; i < json_array_size(stops); i++)
        most = fmax(most, bound_of(json_array_get(json_array_get(stops, i), 1), depth));
    return most;
}

static double bound_of(const json_t *json, int depth) {
    if (depth > DEEPEST || !json)
        return INFINITY;
    if (json_is_number(json))
        return fabs(json_number_value(json));
    if (json_is_array(json))
        return bound_of_expression(json, depth + 1);
    return json_is_object(json) ? bound_of_function(json, depth + 1) : INFINITY;
}

double camber_style_layer_bound(const camber_style_layer *layer, camber_property_id property, double zoom) {
    const camber_layer_look look = camber_style_layer_look(layer, zoom);
    const camber_property_row *row = camber_property_rows + property;
    double value;
    memcpy(&value, (const char *)&look.paint + row->offset, sizeof value);
    if (!camber_property_set_has(&look.by_feature, property))
        return fabs(value);
    /* If an expression fails, the default is used, which look.paint has. */
    return fmax(fabs(value), bound_of(layer->properties[property]->document, 0));
}
