/* Evaluates a symbol layer for a feature: its layout and paint by the table of properties, the sections of its text,
 * and values that follow from several properties, such as "auto".
 *
 * Input: a layer at a zoom, a feature. Output: camber_symbol. Properties are evaluated in memory of the evaluation, and
 * texts are copied from there. */
#include "style/symbol.h"

#include "style/properties.h"
#include "style/section.h"
#include "style/text.h"

#include <math.h>
#include <stddef.h>

/* The case that texts are written in. */
typedef enum transform {
    TRANSFORM_NONE = 0,
    TRANSFORM_UPPER,
    TRANSFORM_LOWER,
} transform;

/* "auto" comes after the alignments that text and icons may have. */
enum { AUTO_ALIGNMENT = 2, AUTO_TEXT_ALIGNMENT = 3, NO_OVERLAP = -1 };

/* The symbol, and values from which parts of it follow. */
typedef struct evaluated {
    camber_symbol symbol;
    int icon_rotation, icon_pitch, text_rotation, text_pitch;
    int icon_overlap, text_overlap; /* NO_OVERLAP: not given */
    bool icon_allow_overlap, text_allow_overlap;
    double text_padding_px;
    transform transform;
} evaluated;

#define BLACK                                                                                                          \
    { 0.0f, 0.0f, 0.0f, 1.0f }

static const evaluated defaults = {
    .symbol = {.spacing_px = 250.0,
               .icon_size = 1.0,
               .icon = {.padding_px = {2.0, 2.0, 2.0, 2.0}, .color = BLACK, .opacity = 1.0},
               .text_size_px = 16.0,
               .max_width_em = 10.0,
               .line_height_em = 1.2,
               .max_angle_deg = 45.0,
               .text = {.keep_upright = true, .color = BLACK, .opacity = 1.0}},
    .icon_rotation = AUTO_ALIGNMENT,
    .icon_pitch = AUTO_ALIGNMENT,
    .text_rotation = AUTO_TEXT_ALIGNMENT,
    .text_pitch = AUTO_ALIGNMENT,
    .icon_overlap = NO_OVERLAP,
    .text_overlap = NO_OVERLAP,
    .text_padding_px = 2.0,
};

#define AT(member) offsetof(evaluated, member)

/* The properties whose values are stored unchanged, and where. */
static const struct {
    camber_property_id id;
    size_t offset;
} fields[] = {
    {CAMBER_SYMBOL_PLACEMENT, AT(symbol.placement)},
    {CAMBER_SYMBOL_SPACING, AT(symbol.spacing_px)},
    {CAMBER_SYMBOL_AVOID_EDGES, AT(symbol.avoid_edges)},
    {CAMBER_SYMBOL_Z_ORDER, AT(symbol.order)},
    {CAMBER_ICON_ALLOW_OVERLAP, AT(icon_allow_overlap)},
    {CAMBER_ICON_OVERLAP, AT(icon_overlap)},
    {CAMBER_ICON_IGNORE_PLACEMENT, AT(symbol.icon.ignore_placement)},
    {CAMBER_ICON_OPTIONAL, AT(symbol.icon.optional)},
    {CAMBER_ICON_ROTATION_ALIGNMENT, AT(icon_rotation)},
    {CAMBER_ICON_SIZE, AT(symbol.icon_size)},
    {CAMBER_ICON_TEXT_FIT, AT(symbol.text_fit)},
    {CAMBER_ICON_TEXT_FIT_PADDING, AT(symbol.text_fit_padding_px)},
    {CAMBER_ICON_ROTATE, AT(symbol.icon.rotate_deg)},
    {CAMBER_ICON_PADDING, AT(symbol.icon.padding_px)},
    {CAMBER_ICON_KEEP_UPRIGHT, AT(symbol.icon.keep_upright)},
    {CAMBER_ICON_OFFSET, AT(symbol.icon_offset_px)},
    {CAMBER_ICON_ANCHOR, AT(symbol.icon_anchor)},
    {CAMBER_ICON_PITCH_ALIGNMENT, AT(icon_pitch)},
    {CAMBER_TEXT_PITCH_ALIGNMENT, AT(text_pitch)},
    {CAMBER_TEXT_ROTATION_ALIGNMENT, AT(text_rotation)},
    {CAMBER_TEXT_SIZE, AT(symbol.text_size_px)},
    {CAMBER_TEXT_MAX_WIDTH, AT(symbol.max_width_em)},
    {CAMBER_TEXT_LINE_HEIGHT, AT(symbol.line_height_em)},
    {CAMBER_TEXT_LETTER_SPACING, AT(symbol.letter_spacing_em)},
    {CAMBER_TEXT_JUSTIFY, AT(symbol.justify)},
    {CAMBER_TEXT_RADIAL_OFFSET, AT(symbol.radial_offset_em)},
    {CAMBER_TEXT_ANCHOR, AT(symbol.text_anchor)},
    {CAMBER_TEXT_MAX_ANGLE, AT(symbol.max_angle_deg)},
    {CAMBER_TEXT_ROTATE, AT(symbol.text.rotate_deg)},
    {CAMBER_TEXT_PADDING, AT(text_padding_px)},
    {CAMBER_TEXT_KEEP_UPRIGHT, AT(symbol.text.keep_upright)},
    {CAMBER_TEXT_TRANSFORM, AT(transform)},
    {CAMBER_TEXT_OFFSET, AT(symbol.text_offset_em)},
    {CAMBER_TEXT_ALLOW_OVERLAP, AT(text_allow_overlap)},
    {CAMBER_TEXT_OVERLAP, AT(text_overlap)},
    {CAMBER_TEXT_IGNORE_PLACEMENT, AT(symbol.text.ignore_placement)},
    {CAMBER_TEXT_OPTIONAL, AT(symbol.text.optional)},
    {CAMBER_ICON_OPACITY, AT(symbol.icon.opacity)},
    {CAMBER_ICON_COLOR, AT(symbol.icon.color)},
    {CAMBER_ICON_HALO_COLOR, AT(symbol.icon.halo_color)},
    {CAMBER_ICON_HALO_WIDTH, AT(symbol.icon.halo_width_px)},
    {CAMBER_ICON_HALO_BLUR, AT(symbol.icon.halo_blur_px)},
    {CAMBER_ICON_TRANSLATE, AT(symbol.icon.translate_px)},
    {CAMBER_ICON_TRANSLATE_ANCHOR, AT(symbol.icon.translate_anchor)},
    {CAMBER_TEXT_OPACITY, AT(symbol.text.opacity)},
    {CAMBER_TEXT_COLOR, AT(symbol.text.color)},
    {CAMBER_TEXT_HALO_COLOR, AT(symbol.text.halo_color)},
    {CAMBER_TEXT_HALO_WIDTH, AT(symbol.text.halo_width_px)},
    {CAMBER_TEXT_HALO_BLUR, AT(symbol.text.halo_blur_px)},
    {CAMBER_TEXT_TRANSLATE, AT(symbol.text.translate_px)},
    {CAMBER_TEXT_TRANSLATE_ANCHOR, AT(symbol.text.translate_anchor)},
};

/* A layer that is being evaluated for a feature. */
typedef struct reader {
    const camber_style_layer *layer;
    camber_evaluation *evaluation;
    camber_arena *arena; /* the caller's */
    evaluated *to;
} reader;

/* false: the layer does not have the property, or it cannot be evaluated. */
static bool evaluate(const reader *r, camber_property_id id, camber_value *value) {
    const camber_expression *expression = r->layer->properties[id];
    return expression && camber_expression_evaluate(expression, r->evaluation, value);
}

static void read_fields(const reader *r) {
    camber_value value;
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++)
        if (evaluate(r, fields[i].id, &value))
            camber_property_store(camber_property_rows + fields[i].id, &value, (char *)r->to + fields[i].offset);
    if (evaluate(r, CAMBER_SYMBOL_SORT_KEY, &value) && value.type == CAMBER_VALUE_NUMBER && isfinite(value.number)) {
        r->to->symbol.has_sort_key = true;
        r->to->symbol.sort_key = value.number;
    }
}

/* ---- Values that follow from several properties ---- */

static camber_symbol_overlap overlap_of(int overlap, bool allowed) {
    return overlap != NO_OVERLAP ? (camber_symbol_overlap)overlap
           : allowed             ? CAMBER_OVERLAP_ALWAYS
                                 : CAMBER_OVERLAP_NEVER;
}

/* Along a line, text and icons turn with the map. If they turn with the map, they are also flat on it. */
static void resolve_alignments(evaluated *e) {
    camber_symbol *symbol = &e->symbol;
    const camber_symbol_alignment automatic =
        symbol->placement == CAMBER_SYMBOL_POINT ? CAMBER_ALIGN_VIEWPORT : CAMBER_ALIGN_MAP;
    symbol->icon.rotation_alignment =
        e->icon_rotation == AUTO_ALIGNMENT ? automatic : (camber_symbol_alignment)e->icon_rotation;
    symbol->text.rotation_alignment =
        e->text_rotation == AUTO_TEXT_ALIGNMENT ? automatic : (camber_symbol_alignment)e->text_rotation;
    symbol->icon.pitch_alignment =
        e->icon_pitch == AUTO_ALIGNMENT ? symbol->icon.rotation_alignment : (camber_symbol_alignment)e->icon_pitch;
    symbol->text.pitch_alignment = e->text_pitch != AUTO_ALIGNMENT ? (camber_symbol_alignment)e->text_pitch
                                   : symbol->text.rotation_alignment == CAMBER_ALIGN_MAP ? CAMBER_ALIGN_MAP
                                                                                         : CAMBER_ALIGN_VIEWPORT;
}

static void resolve_part(camber_symbol_part *part) {
    part->color.a *= (float)part->opacity;
    part->halo_color.a *= (float)part->opacity;
}

static void resolve(evaluated *e) {
    camber_symbol *symbol = &e->symbol;
    symbol->icon.overlap = overlap_of(e->icon_overlap, e->icon_allow_overlap);
    symbol->text.overlap = overlap_of(e->text_overlap, e->text_allow_overlap);
    for (size_t i = 0; i < 4; i++)
        symbol->text.padding_px[i] = e->text_padding_px;
    resolve_alignments(e);
    resolve_part(&symbol->icon);
    resolve_part(&symbol->text);
    if (symbol->placement != CAMBER_SYMBOL_POINT)
        symbol->max_width_em = 0.0;
}

/* ---- Writing modes ---- */

static bool is_name(const camber_value *value, const char *name) {
    return value->type == CAMBER_VALUE_STRING && strcmp(value->string, name) == 0;
}

/* Without the property, text at points is horizontal, and text along lines may be horizontal or vertical. */
static void read_writing_modes(const reader *r) {
    camber_symbol *symbol = &r->to->symbol;
    camber_value modes;
    symbol->horizontal = true;
    symbol->vertical = symbol->placement != CAMBER_SYMBOL_POINT;
    if (!evaluate(r, CAMBER_TEXT_WRITING_MODE, &modes) || modes.type != CAMBER_VALUE_ARRAY || modes.count == 0)
        return;
    bool horizontal = false, vertical = false;
    for (uint32_t i = 0; i < modes.count; i++) {
        horizontal |= is_name(modes.items + i, "horizontal");
        vertical |= is_name(modes.items + i, "vertical");
    }
    if (!horizontal && !vertical)
        return;
    symbol->horizontal = horizontal;
    symbol->vertical = vertical;
    symbol->vertical_first = is_name(modes.items, "vertical");
}

/* ---- Variable anchors ---- */

static bool find_anchor(const camber_value *value, camber_text_anchor *anchor) {
    const char *const *names = camber_property_rows[CAMBER_TEXT_ANCHOR].property.values;
    for (int i = 0; names[i]; i++)
        if (is_name(value, names[i])) {
            *anchor = (camber_text_anchor)i;
            return true;
        }
    return false;
}

/* Whether the anchor is at the text's left (-1), right (1) or neither, and at its top (-1), bottom (1) or neither. */
static void side_of(camber_text_anchor anchor, int *x, int *y) {
    static const int sides[CAMBER_SYMBOL_ANCHORS_MAX][2] = {
        [CAMBER_ANCHOR_LEFT] = {-1, 0},        [CAMBER_ANCHOR_RIGHT] = {1, 0},
        [CAMBER_ANCHOR_TOP] = {0, -1},         [CAMBER_ANCHOR_BOTTOM] = {0, 1},
        [CAMBER_ANCHOR_TOP_LEFT] = {-1, -1},   [CAMBER_ANCHOR_TOP_RIGHT] = {1, -1},
        [CAMBER_ANCHOR_BOTTOM_LEFT] = {-1, 1}, [CAMBER_ANCHOR_BOTTOM_RIGHT] = {1, 1}};
    *x = sides[anchor][0];
    *y = sides[anchor][1];
}

/* Computes the offset of a variable anchor, which is away from the anchor: the radial offset or, without it, the text's
 * offset without its signs. */
static void offset_of(const camber_symbol *symbol, camber_text_anchor anchor, double offset[2]) {
    int x, y;
    side_of(anchor, &x, &y);
    const double radial = fmax(symbol->radial_offset_em, 0.0) * (x && y ? sqrt(0.5) : 1.0);
    offset[0] = -x * (symbol->has_radial_offset ? radial : fabs(symbol->text_offset_em[0]));
    offset[1] = -y * (symbol->has_radial_offset ? radial : fabs(symbol->text_offset_em[1]));
}

static bool add_anchor(camber_symbol *symbol, const camber_value *name) {
    camber_text_anchor *anchor = symbol->variable_anchors + symbol->variable_anchor_count;
    if (symbol->variable_anchor_count == CAMBER_SYMBOL_ANCHORS_MAX || !find_anchor(name, anchor))
        return false;
    offset_of(symbol, *anchor, symbol->variable_offsets_em[symbol->variable_anchor_count++]);
    return true;
}

static void read_anchors_with_offsets(const reader *r, const camber_value *value) {
    camber_symbol *symbol = &r->to->symbol;
    for (uint32_t i = 0; value->type == CAMBER_VALUE_ARRAY && i + 1 < value->count; i += 2) {
        const camber_value *offset = value->items + i + 1;
        if (!isfinite(offset->items[0].number) || !isfinite(offset->items[1].number) ||
            !add_anchor(symbol, value->items + i))
            break;
        symbol->variable_offsets_em[symbol->variable_anchor_count - 1][0] = offset->items[0].number;
        symbol->variable_offsets_em[symbol->variable_anchor_count - 1][1] = offset->items[1].number;
    }
    symbol->has_variable_offsets = symbol->variable_anchor_count > 0;
}

static void read_anchors(const reader *r) {
    camber_symbol *symbol = &r->to->symbol;
    camber_value value;
    symbol->has_radial_offset = r->layer->properties[CAMBER_TEXT_RADIAL_OFFSET] != NULL;
    if (evaluate(r, CAMBER_TEXT_VARIABLE_ANCHOR_OFFSET, &value))
        read_anchors_with_offsets(r, &value);
    else if (evaluate(r, CAMBER_TEXT_VARIABLE_ANCHOR, &value) && value.type == CAMBER_VALUE_ARRAY)
        for (uint32_t i = 0; i < value.count; i++)
            if (!add_anchor(symbol, value.items + i))
                break;
    /* With a single anchor, a radial offset of 0 means that the text's offset is used. */
    if (symbol->variable_anchor_count == 0 && fabs(symbol->radial_offset_em) <= 0.0)
        symbol->has_radial_offset = false;
}

/* ---- Texts and images ---- */

static bool keep_text(const reader *r, const char *text, const char **kept) {
    return (*kept = camber_arena_text(r->arena, text, strlen(text))) != NULL;
}

typedef struct fonts {
    const char **names;
    size_t count;
} fonts;

static bool keep_fonts(const reader *r, const camber_value *array, fonts *kept) {
    *kept = (fonts){camber_arena_alloc(r->arena, array->count * sizeof *kept->names), 0};
    for (uint32_t i = 0; kept->names && i < array->count; i++)
        if (array->items[i].type == CAMBER_VALUE_STRING &&
            !keep_text(r, array->items[i].string, kept->names + kept->count++))
            return false;
    return kept->names != NULL;
}

/* Reads the fonts of the layer. */
static bool read_fonts(const reader *r, fonts *kept) {
    static const camber_value names[] = {{.type = CAMBER_VALUE_STRING, .string = "Open Sans Regular"},
                                         {.type = CAMBER_VALUE_STRING, .string = "Arial Unicode MS Regular"}};
    camber_value value;
    if (!evaluate(r, CAMBER_TEXT_FONT, &value) || value.type != CAMBER_VALUE_ARRAY)
        value = (camber_value){.type = CAMBER_VALUE_ARRAY, .count = 2, .items = names};
    return keep_fonts(r, &value, kept);
}

/* Keeps the text in the case that the layer asks for. If the evaluation has no memory left to change it, it is kept
 * unchanged. */
static bool keep_transformed(const reader *r, const char *text, const char **kept) {
    camber_string changed = {.e = r->evaluation};
    camber_value value;
    if (r->to->transform != TRANSFORM_NONE &&
        camber_string_add_cased(&changed, text,
                                r->to->transform == TRANSFORM_UPPER ? camber_unicode_upper : camber_unicode_lower) &&
        camber_string_end(&changed, &value))
        text = value.string;
    return keep_text(r, text, kept);
}

/* An option whose type is not the expected one is treated as absent. */
static bool keep_section(const reader *r, const camber_text_section *from, const fonts *layer,
                         camber_symbol_section *to) {
    const camber_symbol_part *text = &r->to->symbol.text;
    fonts own = *layer;
    *to = (camber_symbol_section){.scale = 1.0};
    if (from->scale.type == CAMBER_VALUE_NUMBER && isfinite(from->scale.number) && from->scale.number >= 0.0)
        to->scale = from->scale.number;
    if (from->color.type == CAMBER_VALUE_COLOR) {
        to->has_color = true;
        to->color = from->color.color;
        to->color.a *= (float)text->opacity;
    }
    to->align = is_name(&from->align, "center") ? CAMBER_ALIGN_CENTER
                : is_name(&from->align, "top")  ? CAMBER_ALIGN_TOP
                                                : CAMBER_ALIGN_BOTTOM;
    if (from->fonts.type == CAMBER_VALUE_ARRAY && from->fonts.count > 0 && !keep_fonts(r, &from->fonts, &own))
        return false;
    to->fonts = own.names;
    to->font_count = own.count;
    return from->image ? keep_text(r, from->image, &to->image) : keep_transformed(r, from->text, &to->text);
}

/* Whether a section shows something. */
static bool is_shown(const camber_text_section *section) {
    return section->image ? section->image[0] != 0 : section->text[0] != 0;
}

static bool read_text(const reader *r) {
    camber_symbol *symbol = &r->to->symbol;
    camber_value value;
    fonts layer;
    size_t count = 0;
    if (!evaluate(r, CAMBER_TEXT_FIELD, &value) || value.type != CAMBER_VALUE_FORMATTED)
        return true;
    for (uint32_t i = 0; i < value.count; i++)
        count += is_shown(value.sections + i);
    if (count == 0)
        return true;
    const camber_text_section *sections = value.sections;
    const uint32_t given = value.count;
    symbol->sections = camber_arena_alloc(r->arena, count * sizeof *symbol->sections);
    if (!symbol->sections || !read_fonts(r, &layer))
        return false;
    for (uint32_t i = 0; i < given; i++)
        if (is_shown(sections + i) &&
            !keep_section(r, sections + i, &layer, symbol->sections + symbol->section_count++))
            return false;
    return true;
}

/* Reads the size of text that decides where labels are along lines: the same at all zooms, so that labels do not move
 * along their lines while a map zooms. */
static void read_anchor_size(const reader *r) {
    static const double zoom = 18.0;
    camber_symbol *symbol = &r->to->symbol;
    const camber_expression *expression = r->layer->properties[CAMBER_TEXT_SIZE];
    const double zoom_of_view = r->evaluation->zoom;
    camber_value value;
    symbol->anchor_text_px = symbol->text_size_px;
    if (symbol->placement == CAMBER_SYMBOL_POINT || !expression || !expression->reads_zoom)
        return;
    r->evaluation->zoom = zoom;
    if (evaluate(r, CAMBER_TEXT_SIZE, &value) && value.type == CAMBER_VALUE_NUMBER && value.number >= 0.0 &&
        isfinite(value.number))
        symbol->anchor_text_px = value.number;
    r->evaluation->zoom = zoom_of_view;
}

static bool read_icon(const reader *r) {
    camber_value value;
    if (!evaluate(r, CAMBER_ICON_IMAGE, &value) || value.type != CAMBER_VALUE_STRING || !value.string[0])
        return true;
    return keep_text(r, value.string, &r->to->symbol.icon_image);
}

camber_status camber_layer_look_symbol(const camber_layer_look *look, const camber_feature_view *feature,
                                       const camber_style_images *images, camber_arena *arena, camber_symbol *symbol) {
    camber_evaluation evaluation;
    evaluated made;
    memcpy(&made, &defaults, sizeof made); /* copies the padding, too, because symbols are compared byte by byte */
    const reader r = {look->layer, &evaluation, arena, &made};
    camber_evaluation_begin(&evaluation, look->zoom, feature);
    evaluation.images = images;
    read_fields(&r);
    read_writing_modes(&r);
    read_anchors(&r);
    read_anchor_size(&r);
    const bool done = read_icon(&r) && read_text(&r);
    camber_evaluation_end(&evaluation);
    if (!done)
        return camber_fail(arena->context, CAMBER_ERROR_MEMORY,
                           "layer \"%.64s\": its labels take too much memory; give it more, or shorten them",
                           look->layer->id);
    resolve(&made);
    made.symbol.repeat_px = look->layer->repeat_px;
    if (made.symbol.repeat_px < 0.0)
        made.symbol.repeat_px =
            made.symbol.placement == CAMBER_SYMBOL_LINE ? fmax(0.5 * made.symbol.spacing_px, 0.0) : 0.0;
    memcpy(symbol, &made.symbol, sizeof *symbol);
    return CAMBER_OK;
}

/* ---- Layers ---- */

/* Whether a value shows something: it names an image, or is a text. */
static bool shows(const camber_value *value) {
    if (value->type == CAMBER_VALUE_STRING)
        return value->string[0] != 0;
    for (uint32_t i = 0; value->type == CAMBER_VALUE_FORMATTED && i < value->count; i++)
        if (is_shown(value->sections + i))
            return true;
    return false;
}

static bool may_show(const camber_style_layer *layer, camber_property_id id, const camber_feature_view *feature) {
    const camber_expression *expression = layer->properties[id];
    camber_evaluation evaluation;
    camber_value value;
    if (!expression || expression->reads_zoom)
        return expression != NULL;
    camber_evaluation_begin(&evaluation, layer->min_zoom, feature);
    const bool shown = camber_expression_evaluate(expression, &evaluation, &value) && shows(&value);
    camber_evaluation_end(&evaluation);
    return shown;
}

bool camber_style_layer_may_label(const camber_style_layer *layer, const camber_feature_view *feature) {
    return layer->kind == CAMBER_LAYER_SYMBOL &&
           (may_show(layer, CAMBER_TEXT_FIELD, feature) || may_show(layer, CAMBER_ICON_IMAGE, feature));
}

/* Whether a property has this value for all features at all zooms. */
static bool is_always(const camber_style_layer *layer, camber_property_id id, const char *name) {
    const camber_expression *expression = layer->properties[id];
    camber_evaluation evaluation;
    camber_value value;
    if (!expression || expression->reads_zoom || expression->reads_feature)
        return false;
    camber_evaluation_begin(&evaluation, layer->min_zoom, NULL);
    const bool always = camber_expression_evaluate(expression, &evaluation, &value) && is_name(&value, name);
    camber_evaluation_end(&evaluation);
    return always;
}

bool camber_style_layer_turns_icons(const camber_style_layer *layer) {
    return layer->properties[CAMBER_ICON_IMAGE] && layer->properties[CAMBER_SYMBOL_PLACEMENT] &&
           !is_always(layer, CAMBER_SYMBOL_PLACEMENT, "point") &&
           !is_always(layer, CAMBER_ICON_ROTATION_ALIGNMENT, "viewport");
}

static bool has_image(const camber_node *node) {
    if (node->type.type == CAMBER_TYPE_IMAGE)
        return true;
    for (uint32_t i = 0; node->value.type == CAMBER_VALUE_FORMATTED && i < node->value.count; i++)
        if (node->value.sections[i].image)
            return true;
    return false;
}

bool camber_style_layer_names_images(const camber_style_layer *layer) {
    const camber_expression *text = layer->properties[CAMBER_TEXT_FIELD];
    if (layer->properties[CAMBER_ICON_IMAGE])
        return true;
    for (size_t i = 0; text && i < text->node_count; i++)
        if (has_image(text->nodes + i))
            return true;
    return false;
}
