/* Formatted texts, images, and the conversions to types that only symbol layers have.
 *
 * A formatted text consists of sections. A section is text with its own font, size and colour, or an image. The table
 * at the end has each operator's row. */
#include "style/evaluation.h"
#include "style/operators.h"
#include "style/section.h"
#include "style/text.h"

#include <string.h>

static const camber_value nothing = {.type = CAMBER_VALUE_NULL};

static bool fail(camber_evaluation *e, const char *cause) {
    return camber_evaluate_fail(e, cause);
}

/* ---- Images ---- */

bool camber_evaluate_to_image(camber_evaluation *e, const camber_node *node, camber_value *value) {
    for (uint32_t i = 0; i < node->count; i++) {
        if (!camber_evaluate_operand(e, node, i, value))
            return false;
        if (value->type != CAMBER_VALUE_NULL)
            break;
    }
    camber_string text = {.e = e};
    if (value->type != CAMBER_VALUE_STRING &&
        (!camber_string_add_value(&text, value) || !camber_string_end(&text, value)))
        return false;
    value->boolean = true;
    return true;
}

/* ---- Formatted texts ---- */

static bool write_text(camber_evaluation *e, const camber_value *value, const char **string) {
    camber_string text = {.e = e};
    camber_value made = *value;
    if (value->type != CAMBER_VALUE_STRING &&
        (!camber_string_add_value(&text, value) || !camber_string_end(&text, &made)))
        return false;
    *string = made.string;
    return true;
}

static camber_text_section *add_sections(camber_evaluation *e, uint32_t count, camber_value *value) {
    camber_text_section *sections = camber_arena_alloc(e->arena, count * sizeof *sections);
    if (!sections) {
        camber_evaluate_no_memory(e);
        return NULL;
    }
    memset(sections, 0, count * sizeof *sections);
    *value = (camber_value){.type = CAMBER_VALUE_FORMATTED, .count = count, .sections = sections};
    return sections;
}

/* Uses the first operand that is not null. */
bool camber_evaluate_to_formatted(camber_evaluation *e, const camber_node *node, camber_value *value) {
    for (uint32_t i = 0; i < node->count; i++) {
        if (!camber_evaluate_operand(e, node, i, value))
            return false;
        if (value->type != CAMBER_VALUE_NULL)
            break;
    }
    if (value->type == CAMBER_VALUE_FORMATTED)
        return true;
    const char *text;
    if (!write_text(e, value, &text))
        return false;
    camber_text_section *section = add_sections(e, 1, value);
    if (section)
        section->text = text;
    return section != NULL;
}

/* The operands that each section has. */
enum { SECTION_CONTENT, SECTION_SCALE, SECTION_FONTS, SECTION_COLOR, SECTION_ALIGN, SECTION_OPERANDS };

static bool evaluate_section(camber_evaluation *e, const camber_node *node, uint32_t first,
                             camber_text_section *section) {
    camber_value content;
    if (!camber_evaluate_operand(e, node, first + SECTION_CONTENT, &content) ||
        !camber_evaluate_operand(e, node, first + SECTION_ALIGN, &section->align))
        return false;
    if (content.type == CAMBER_VALUE_STRING && content.boolean) {
        section->text = "";
        section->image = content.string;
        return true;
    }
    return write_text(e, &content, &section->text) &&
           camber_evaluate_operand(e, node, first + SECTION_SCALE, &section->scale) &&
           camber_evaluate_operand(e, node, first + SECTION_FONTS, &section->fonts) &&
           camber_evaluate_operand(e, node, first + SECTION_COLOR, &section->color);
}

static bool evaluate_format(camber_evaluation *e, const camber_node *node, camber_value *value) {
    const uint32_t count = node->count / SECTION_OPERANDS;
    camber_text_section *sections = add_sections(e, count, value);
    for (uint32_t i = 0; sections && i < count; i++)
        if (!evaluate_section(e, node, i * SECTION_OPERANDS, sections + i))
            return false;
    return sections && camber_evaluate_work(e, count);
}

static bool push_nothing(camber_compiler *c) {
    uint32_t node = 0;
    return camber_make_constant(c, &nothing, camber_typing_of(CAMBER_TYPE_NULL), &node) && camber_push_operand(c, node);
}

static bool compile_content(camber_compiler *c, const json_t *array, size_t index) {
    uint32_t node = 0;
    char name[CAMBER_TYPING_TEXT_SIZE];
    if (!camber_compile_element(c, array, index, camber_typing_of(CAMBER_TYPE_VALUE), &node))
        return false;
    const camber_typing type = camber_node_at(c, node)->type;
    if (type.type == CAMBER_TYPE_STRING || type.type == CAMBER_TYPE_VALUE || type.type == CAMBER_TYPE_NULL ||
        type.type == CAMBER_TYPE_IMAGE)
        return camber_push_operand(c, node);
    camber_compiler_enter_index(c, index);
    return camber_compiler_fail(c, "a section is a string or an image, found %s; write [\"to-string\", ...]",
                                camber_typing_name(type, name));
}

static bool check_align(camber_compiler *c, const json_t *json) {
    const char *name = json_string_value(json);
    return !name || strcmp(name, "bottom") == 0 || strcmp(name, "center") == 0 || strcmp(name, "top") == 0 ||
           camber_compiler_fail(c, "\"%.64s\" is not a vertical-align; use \"bottom\", \"center\" or \"top\"", name);
}

/* Pushes the options of a section, which are an object. Null is pushed for each option that is missing. */
static bool compile_options(camber_compiler *c, const json_t *options) {
    const struct {
        const char *name;
        camber_typing type;
    } rows[] = {{"font-scale", camber_typing_of(CAMBER_TYPE_NUMBER)},
                {"text-font", camber_typing_array(camber_typing_of(CAMBER_TYPE_STRING), CAMBER_ANY_LENGTH)},
                {"text-color", camber_typing_of(CAMBER_TYPE_COLOR)},
                {"vertical-align", camber_typing_of(CAMBER_TYPE_STRING)}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        json_t *option = json_object_get(options, rows[i].name);
        uint32_t node = 0;
        if (!option || json_is_null(option)) {
            if (!push_nothing(c))
                return false;
            continue;
        }
        camber_compiler_enter_key(c, rows[i].name);
        if ((i == 3 && !check_align(c, option)) || !camber_compile(c, option, rows[i].type, &node) ||
            !camber_push_operand(c, node))
            return false;
        camber_compiler_leave(c);
    }
    return true;
}

/* Compiles ["format", content, options, content, ...]. options is an object, and may be missing. */
static bool compile_format(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                           uint32_t *node) {
    (void)expected;
    const size_t size = json_array_size(array), first_operand = c->operand_count;
    for (size_t i = 1; i < size; i++) {
        if (json_is_object(json_array_get(array, i))) {
            camber_compiler_enter_index(c, i);
            return camber_compiler_fail(c, "options follow a text or an image; write that before");
        }
        const json_t *options = json_array_get(array, i + 1);
        if (!compile_content(c, array, i))
            return false;
        if (json_is_object(options))
            camber_compiler_enter_index(c, ++i);
        if (!compile_options(c, options))
            return false;
        if (json_is_object(options))
            camber_compiler_leave(c);
    }
    return camber_make_node(c, &(camber_node){.evaluate = row->evaluate, .type = camber_typing_of(row->result)},
                            first_operand, node);
}

/* ---- Paddings, anchors with offsets ---- */

static bool are_numbers(const camber_value *array) {
    for (uint32_t i = 0; i < array->count; i++)
        if (array->items[i].type != CAMBER_VALUE_NUMBER)
            return false;
    return true;
}

/* As in CSS, a single number applies to all sides; the first of two numbers applies to top and bottom, and the second
 * of two or three to left and right. */
static bool to_padding(camber_evaluation *e, camber_value *value) {
    static const uint32_t sides[4][4] = {{0, 0, 0, 0}, {0, 1, 0, 1}, {0, 1, 2, 1}, {0, 1, 2, 3}};
    const camber_value number = *value;
    const camber_value given = number.type == CAMBER_VALUE_NUMBER
                                   ? (camber_value){.type = CAMBER_VALUE_ARRAY, .count = 1, .items = &number}
                                   : number;
    if (given.type != CAMBER_VALUE_ARRAY || given.count < 1 || given.count > 4 || !are_numbers(&given))
        return fail(e, "expected a padding: a number, or an array of one to four");
    camber_value *items = camber_arena_alloc(e->arena, 4 * sizeof *items);
    if (!items)
        return camber_evaluate_no_memory(e);
    for (uint32_t i = 0; i < 4; i++)
        items[i] = given.items[sides[given.count - 1][i]];
    *value = (camber_value){.type = CAMBER_VALUE_ARRAY, .count = 4, .items = items};
    return true;
}

/* Uses the first operand that is a padding. */
bool camber_evaluate_to_padding(camber_evaluation *e, const camber_node *node, camber_value *value) {
    for (uint32_t i = 0; i < node->count; i++) {
        if (!camber_evaluate_operand(e, node, i, value))
            return false;
        if (to_padding(e, value))
            return true;
    }
    return false;
}

static bool is_anchor(const camber_value *value) {
    static const char *const names[] = {"center",   "left",      "right",       "top",         "bottom",
                                        "top-left", "top-right", "bottom-left", "bottom-right"};
    for (size_t i = 0; value->type == CAMBER_VALUE_STRING && i < sizeof names / sizeof *names; i++)
        if (strcmp(value->string, names[i]) == 0)
            return true;
    return false;
}

static bool are_anchors(const camber_value *value) {
    if (value->type != CAMBER_VALUE_ARRAY || value->count < 1 || value->count % 2)
        return false;
    for (uint32_t i = 0; i < value->count; i += 2) {
        const camber_value *offset = value->items + i + 1;
        if (!is_anchor(value->items + i) || offset->type != CAMBER_VALUE_ARRAY || offset->count != 2 ||
            !are_numbers(offset))
            return false;
    }
    return true;
}

bool camber_evaluate_to_anchors(camber_evaluation *e, const camber_node *node, camber_value *value) {
    for (uint32_t i = 0; i < node->count; i++) {
        if (!camber_evaluate_operand(e, node, i, value))
            return false;
        if (are_anchors(value))
            return true;
    }
    return fail(e, "expected anchors, each with its offset, such as [\"top\", [0, 1], \"left\", [1, 0]]");
}

/* ---- Scripts ---- */

/* The result is always true, because all scripts are shaped. */
static bool evaluate_is_supported_script(camber_evaluation *e, const camber_node *node, camber_value *value) {
    const char *text;
    if (!camber_evaluate_string(e, node, 0, &text))
        return false;
    *value = camber_value_bool(true);
    return true;
}

static const camber_operator rows[] = {
    {"image", camber_compile_uniform, camber_evaluate_to_image, STRING, CAMBER_TYPE_IMAGE, 1, 1},
    {"format", compile_format, evaluate_format, VALUE, CAMBER_TYPE_FORMATTED, 1, ANY_COUNT},
    {"is-supported-script", camber_compile_uniform, evaluate_is_supported_script, STRING, BOOL, 1, 1},
};

const camber_operator_table camber_format_operators = {rows, sizeof rows / sizeof *rows};
