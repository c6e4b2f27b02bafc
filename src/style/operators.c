/* The operators of expressions: where each is found, and how those are compiled whose operands are all of one type. */
#include "style/operators.h"

#include <string.h>

bool camber_compile_uniform(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                            uint32_t *node) {
    (void)expected;
    const size_t first_operand = c->operand_count;
    for (size_t i = 1; i < json_array_size(array); i++)
        if (!camber_compile_operand(c, array, i, camber_typing_of(row->operands)))
            return false;
    const camber_node prototype = {.evaluate = row->evaluate, .op = row, .type = camber_typing_of(row->result)};
    return camber_make_node(c, &prototype, first_operand, node);
}

static bool fail_count(camber_compiler *c, const camber_operator *row, size_t count) {
    return camber_compiler_fail(c, "\"%s\" with %zu operand%s; it takes %zu%s", row->name, count, count == 1 ? "" : "s",
                                row->least,
                                row->most == ANY_COUNT   ? " or more"
                                : row->most > row->least ? " or one more"
                                                         : "");
}

/* NULL: there is none of this name. */
static const camber_operator *find_operator(const char *name) {
    static const camber_operator_table *const tables[] = {
        &camber_input_operators, &camber_type_operators,  &camber_decision_operators, &camber_sequence_operators,
        &camber_curve_operators, &camber_maths_operators, &camber_format_operators,   &camber_number_operators};
    for (size_t t = 0; t < sizeof tables / sizeof *tables; t++)
        for (size_t i = 0; i < tables[t]->count; i++)
            if (tables[t]->rows[i].name[0] == name[0] && strcmp(tables[t]->rows[i].name, name) == 0)
                return &tables[t]->rows[i];
    return NULL;
}

bool camber_operator_exists(const char *name) {
    return find_operator(name) != NULL;
}

bool camber_compile_operator(camber_compiler *c, json_t *array, camber_typing expected, uint32_t *node) {
    const char *name = json_string_value(json_array_get(array, 0));
    if (!name) {
        if (json_array_size(array) > 0)
            camber_compiler_enter_index(c, 0);
        return camber_compiler_fail(
            c, "expected an expression [operator, ...], found an array without an operator's name; "
               "write [\"literal\", [...]] for a list");
    }
    const camber_operator *row = find_operator(name);
    if (row) {
        const size_t count = json_array_size(array) - 1;
        return count < row->least || count > row->most ? fail_count(c, row, count)
                                                       : row->compile(c, row, array, expected, node);
    }
    camber_compiler_enter_index(c, 0);
    return camber_compiler_fail(c, "unknown operator \"%.64s\"; correct it, or write [\"literal\", [...]] for a list",
                                name);
}
