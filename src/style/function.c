/* Functions of zoom as styles had them before expressions. */
#include "style/compiler.h"

#include <math.h>
#include <string.h>

typedef enum shape {
    SHAPE_EXPONENTIAL,
    SHAPE_INTERVAL,
} shape;

static bool read_shape(camber_compiler *c, const json_t *object, const camber_property *property, shape *made) {
    *made = property->interpolated ? SHAPE_EXPONENTIAL : SHAPE_INTERVAL;
    if (json_object_get(object, "property"))
        return camber_compiler_fail(c, "functions of a feature's property are not supported; write the expression "
                                       "[\"interpolate\", ...], [\"step\", ...] or [\"match\", ...]");
    const json_t *type = json_object_get(object, "type");
    if (!type)
        return true;
    const char *name = json_is_string(type) ? json_string_value(type) : "";
    if (strcmp(name, "interval") == 0)
        *made = SHAPE_INTERVAL;
    else if (strcmp(name, "exponential") != 0 || !property->interpolated)
        return camber_compiler_fail(c, "the function's type is wrong for %s; use %s\"interval\" with stops on zoom",
                                    property->name, property->interpolated ? "\"exponential\" or " : "");
    return true;
}

static bool read_base(camber_compiler *c, const json_t *object, double *base) {
    const json_t *json = json_object_get(object, "base");
    *base = 1.0;
    if (!json)
        return true;
    if (!json_is_number(json) || !(json_number_value(json) > 0.0))
        return camber_compiler_fail(c, "base: expected a number above 0; write e.g. 1.5");
    *base = json_number_value(json);
    return true;
}

/* Reads [zoom, value] into *node and *zoom, which was that of the stop before. */
static bool compile_stop(camber_compiler *c, const json_t *stop, camber_type type, double *zoom, uint32_t *node) {
    if (!json_is_array(stop) || json_array_size(stop) != 2 || !json_is_number(json_array_get(stop, 0)))
        return camber_compiler_fail(c, "expected a stop [zoom, value], found %s; correct it", camber_json_name(stop));
    const double at = json_number_value(json_array_get(stop, 0));
    if (at < *zoom)
        return camber_compiler_fail(c, "the stop's zoom %g is below the one before; sort the stops", at);
    *zoom = at;
    const json_t *value = json_array_get(stop, 1);
    if (json_is_array(value) || json_is_object(value))
        return camber_compiler_fail(c, "a function's value must be a constant, found %s; use an expression instead",
                                    camber_json_name(value));
    return camber_compile_element(c, stop, 1, type, node);
}

/* Pushes the stops and the nodes of their values. Of stops at the same zoom the first counts, as ever. */
static bool compile_stops(camber_compiler *c, const json_t *stops, camber_type type, bool step) {
    double zoom = -HUGE_VAL;
    camber_compiler_enter_key(c, "stops");
    for (size_t i = 0; i < json_array_size(stops); i++) {
        const double before = zoom;
        uint32_t node = 0;
        camber_compiler_enter_index(c, i);
        if (!compile_stop(c, json_array_get(stops, i), type, &zoom, &node))
            return false;
        camber_compiler_leave(c);
        if (!(zoom > before))
            continue;
        /* Below its first stop a step has the first stop's value. */
        if (!camber_push_operand(c, node) || ((i > 0 || !step) && !camber_push_stop(c, zoom)))
            return false;
    }
    camber_compiler_leave(c);
    return true;
}

bool camber_compile_function(camber_compiler *c, json_t *object, const camber_property *property, uint32_t *node) {
    shape made;
    double base;
    if (!read_shape(c, object, property, &made) || !read_base(c, object, &base))
        return false;
    const json_t *stops = json_object_get(object, "stops");
    if (!json_is_array(stops) || json_array_size(stops) == 0)
        return camber_compiler_fail(c, "expected a constant, an expression, or a function with a list of stops; write "
                                       "e.g. {\"stops\": [[10, 1], [16, 8]]}");
    const bool step = made == SHAPE_INTERVAL;
    const size_t first_operand = c->operand_count;
    const camber_node input = {.op = CAMBER_OP_ZOOM, .type = CAMBER_TYPE_NUMBER, .reads_zoom = true};
    if (!camber_make_node(c, &input, first_operand, node) || !camber_push_operand(c, *node))
        return false;
    camber_node prototype = {.op = step ? CAMBER_OP_STEP : CAMBER_OP_INTERPOLATE,
                             .type = property->type,
                             .index = (uint32_t)c->expression->stop_count,
                             .value = {.type = CAMBER_VALUE_NUMBER, .number = base}};
    if (!compile_stops(c, stops, property->type, step))
        return false;
    prototype.index_count = (uint32_t)c->expression->stop_count - prototype.index;
    return camber_make_node(c, &prototype, first_operand, node);
}
