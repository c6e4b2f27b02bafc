/* Decides what a layer's labels of a class show, and how.
 *
 * Input: a layer at a zoom, a class. Output: a form, with the rule that it shares with others. */
#include "map/label_layout.h"

#include <math.h>
#include <stddef.h>

static const double PI = 3.14159265358979323846;
/* In MapLibre, text has its baseline this far above the middle of its line, em. */
static const double BASELINE_EM = 7.0 / 24.0;
/* The most memory for the texts of an evaluation. */
#define ARENA_LIMIT ((size_t)16 << 20)
/* The first memory of an arena; and how many rules and looks are compared with a new one. */
enum { ARENA_ROOM = 4096, RULES_COMPARED = 4, LOOKS_COMPARED = 64 };

/* ---- Images ---- */

static uint32_t find_number(void *user, const char *name) {
    const camber_sprites *sprites = user;
    const camber_sprite_image *image = sprites ? camber_sprites_find(sprites, name) : NULL;
    return image ? (uint32_t)(image - sprites->images) + 1 : 0;
}

static void note_missing(void *user, const char *name) {
    if (user)
        (void)camber_sprites_warn_missing(user, name);
}

/* ---- Looks ---- */

/* Finds an equal look, or adds this one. */
static camber_status add_look(camber_label_layout *layout, const camber_label_look *look, uint32_t *index) {
    const size_t first = layout->look_count > LOOKS_COMPARED ? layout->look_count - LOOKS_COMPARED : 0;
    for (size_t i = layout->look_count; i-- > first;) {
        const camber_label_look *other = layout->looks + i;
        if (memcmp(&other->color, &look->color, sizeof look->color) == 0 &&
            memcmp(&other->halo_color, &look->halo_color, sizeof look->halo_color) == 0 &&
            memcmp(&other->halo_width_px, &look->halo_width_px, 2 * sizeof(float)) == 0 && other->flat == look->flat) {
            *index = (uint32_t)i;
            return CAMBER_OK;
        }
    }
    if (!camber_grow(layout->context, &layout->looks, &layout->look_capacity, layout->look_count + 1,
                     sizeof *layout->looks))
        return CAMBER_ERROR_MEMORY;
    *index = (uint32_t)layout->look_count;
    layout->looks[layout->look_count++] = *look;
    return CAMBER_OK;
}

static camber_label_look look_of(const camber_symbol_part *part, bool flat, double ratio) {
    return (camber_label_look){.color = part->color,
                               .halo_color = part->halo_color,
                               .halo_width_px = (float)(part->halo_width_px * ratio),
                               .halo_blur_px = (float)(part->halo_blur_px * ratio),
                               .flat = flat};
}

/* An image that is not a distance field is drawn unchanged. */
static camber_label_look plain_look(const camber_symbol_part *part, bool flat) {
    return (camber_label_look){.color = {1.0f, 1.0f, 1.0f, (float)part->opacity}, .flat = flat};
}

/* ---- Anchors of text ---- */

static bool is_top(camber_text_anchor a) {
    return a == CAMBER_ANCHOR_TOP || a == CAMBER_ANCHOR_TOP_LEFT || a == CAMBER_ANCHOR_TOP_RIGHT;
}
static bool is_bottom(camber_text_anchor a) {
    return a == CAMBER_ANCHOR_BOTTOM || a == CAMBER_ANCHOR_BOTTOM_LEFT || a == CAMBER_ANCHOR_BOTTOM_RIGHT;
}
static bool is_left(camber_text_anchor a) {
    return a == CAMBER_ANCHOR_LEFT || a == CAMBER_ANCHOR_TOP_LEFT || a == CAMBER_ANCHOR_BOTTOM_LEFT;
}
static bool is_right(camber_text_anchor a) {
    return a == CAMBER_ANCHOR_RIGHT || a == CAMBER_ANCHOR_TOP_RIGHT || a == CAMBER_ANCHOR_BOTTOM_RIGHT;
}

/* Computes the offset that moves a text away from its anchor by a distance along each axis. */
static void move_away(camber_text_anchor anchor, double right, double down, double offset_em[2]) {
    offset_em[0] = is_left(anchor) ? right : is_right(anchor) ? -right : 0.0;
    offset_em[1] = is_top(anchor) ? down - BASELINE_EM : is_bottom(anchor) ? BASELINE_EM - down : 0.0;
}

static void move_radially(camber_text_anchor anchor, double distance, double offset_em[2]) {
    const double away = fmax(distance, 0.0);
    const bool corner = (is_top(anchor) || is_bottom(anchor)) && (is_left(anchor) || is_right(anchor));
    const double share = corner ? away / sqrt(2.0) : away;
    move_away(anchor, share, share, offset_em);
}

static void find_anchors(const camber_symbol *s, camber_label_rule *rule) {
    rule->variable = s->variable_anchor_count > 0 && !rule->text_along;
    rule->anchor_count = rule->variable ? s->variable_anchor_count : 1;
    if (!rule->variable) {
        rule->anchors[0] = s->text_anchor;
        memcpy(rule->offsets_em[0], s->text_offset_em, sizeof rule->offsets_em[0]);
        if (s->has_radial_offset && s->radial_offset_em != 0.0)
            move_radially(s->text_anchor, s->radial_offset_em, rule->offsets_em[0]);
        return;
    }
    for (size_t i = 0; i < rule->anchor_count; i++) {
        const camber_text_anchor anchor = rule->anchors[i] = s->variable_anchors[i];
        double *offset = rule->offsets_em[i];
        if (s->has_variable_offsets) {
            offset[0] = s->variable_offsets_em[i][0];
            offset[1] = s->variable_offsets_em[i][1] + (is_top(anchor)      ? -BASELINE_EM
                                                        : is_bottom(anchor) ? BASELINE_EM
                                                                            : 0.0);
        } else if (s->has_radial_offset) {
            move_radially(anchor, s->radial_offset_em, offset);
        } else {
            move_away(anchor, fabs(s->text_offset_em[0]), fabs(s->text_offset_em[1]), offset);
        }
    }
}

/* ---- Rules ---- */

static void find_translation(const camber_view *view, const camber_symbol_part *part, double translate_px[2]) {
    const bool turns = part->translate_anchor == CAMBER_TRANSLATE_MAP;
    const double cosine = turns ? view->cosine : 1.0, sine = turns ? view->sine : 0.0;
    const double x = part->translate_px[0] * view->ratio, y = part->translate_px[1] * view->ratio;
    translate_px[0] = x * cosine + y * sine;
    translate_px[1] = y * cosine - x * sine;
}

static camber_status make_rule(camber_label_layout *layout, const camber_symbol *s, camber_label_rule *rule) {
    const camber_view *view = layout->view;
    const bool on_line = s->placement != CAMBER_SYMBOL_POINT;
    rule->text_along = on_line && s->text.rotation_alignment != CAMBER_ALIGN_VIEWPORT;
    rule->icon_along = on_line && s->icon.rotation_alignment == CAMBER_ALIGN_MAP;
    rule->text_by_map = !on_line && s->text.rotation_alignment == CAMBER_ALIGN_MAP;
    rule->icon_by_map = !on_line && s->icon.rotation_alignment == CAMBER_ALIGN_MAP;
    rule->text_flat = layout->lens.pitched && s->text.pitch_alignment == CAMBER_ALIGN_MAP;
    rule->icon_flat = layout->lens.pitched && s->icon.pitch_alignment == CAMBER_ALIGN_MAP;
    rule->text_px = s->text_size_px * view->ratio;
    rule->text_turn = s->text.rotate_deg * (PI / 180.0);
    rule->icon_turn = s->icon.rotate_deg * (PI / 180.0);
    find_translation(view, &s->text, rule->text_translate_px);
    find_translation(view, &s->icon, rule->icon_translate_px);
    find_anchors(s, rule);
    const camber_label_look text = look_of(&s->text, rule->text_flat, view->ratio);
    return add_look(layout, &text, &rule->text_look);
}

/* Finds a rule for the symbol among the last ones, or adds one. icon: the symbol's icon, on which the look depends. */
static camber_status find_rule(camber_label_layout *layout, const camber_symbol *symbol,
                               const camber_sprite_image *icon, uint32_t *index) {
    camber_label_rule made;
    memset(&made, 0, sizeof made);
    memcpy(&made.symbol, symbol, sizeof *symbol);
    made.symbol.sections = NULL;
    made.symbol.icon_image = NULL;
    made.symbol.section_count = 0;
    made.symbol.sort_key = 0.0;
    camber_status status = make_rule(layout, symbol, &made);
    const camber_label_look look = icon && icon->sdf ? look_of(&symbol->icon, made.icon_flat, layout->view->ratio)
                                                     : plain_look(&symbol->icon, made.icon_flat);
    if (status == CAMBER_OK)
        status = add_look(layout, &look, &made.icon_look);
    if (status != CAMBER_OK)
        return status;
    for (size_t i = layout->rule_count; i-- > 0 && i + RULES_COMPARED >= layout->rule_count;) {
        if (memcmp(layout->rules + i, &made, offsetof(camber_label_rule, hash)) == 0) {
            *index = (uint32_t)i;
            return CAMBER_OK;
        }
    }
    if (!camber_grow(layout->context, &layout->rules, &layout->rule_capacity, layout->rule_count + 1,
                     sizeof *layout->rules))
        return CAMBER_ERROR_MEMORY;
    made.hash = camber_hash(CAMBER_HASH_START, &made.symbol, sizeof made.symbol);
    memcpy(layout->rules + layout->rule_count, &made, sizeof made);
    *index = (uint32_t)layout->rule_count++;
    return CAMBER_OK;
}

/* ---- Forms ---- */

/* Returns how much less a feature matters than others, if its tile or file says so. A style may order labels itself,
 * but many styles rely on the order of features in tiles, which is also the order of their ranks. */
static double weight_of(const camber_features *features, const camber_feature_view *feature) {
    static const struct {
        const char *name;
        double sign;
    } ranks[] = {{"rank", 1.0}, {"scalerank", 1.0}, {"localrank", 1.0}, {"population", -1.0}};
    for (size_t r = 0; r < sizeof ranks / sizeof *ranks; r++)
        for (size_t i = 0; i < features->schema->property_count; i++)
            if (strcmp(features->schema->properties[i], ranks[r].name) == 0 &&
                feature->values[i].type == CAMBER_VALUE_NUMBER && isfinite(feature->values[i].number))
                return ranks[r].sign * feature->values[i].number;
    return 0.0;
}

static camber_status add_runs(camber_label_layout *layout, const camber_symbol *symbol, camber_label_form *form) {
    const camber_label_rule *rule = layout->rules + form->rule;
    form->first_run = (uint32_t)layout->run_count;
    form->run_count = (uint32_t)symbol->section_count;
    for (size_t i = 0; i < symbol->section_count; i++) {
        const camber_symbol_section *section = symbol->sections + i;
        camber_label_run run = {.look = rule->text_look,
                                .image = section->image ? camber_label_find_image(layout, section->image) : NULL,
                                .image_scale = (float)section->scale};
        camber_label_look look = layout->looks[rule->text_look];
        if (section->has_color)
            look.color = section->color;
        if (run.image && !run.image->sdf)
            look = plain_look(&symbol->text, rule->text_flat);
        if (add_look(layout, &look, &run.look) != CAMBER_OK ||
            !camber_grow(layout->context, &layout->runs, &layout->run_capacity, layout->run_count + 1,
                         sizeof *layout->runs))
            return CAMBER_ERROR_MEMORY;
        layout->runs[layout->run_count++] = run;
    }
    return CAMBER_OK;
}

static camber_status add_form(camber_label_layout *layout, const camber_symbol *symbol, uint32_t *index) {
    camber_label_form form = {.icon = symbol->icon_image ? camber_label_find_image(layout, symbol->icon_image) : NULL,
                              .sort_key = symbol->has_sort_key ? symbol->sort_key : 0.0,
                              .text_margin_px = -1.0,
                              .icon_margin_px = -1.0};
    if (form.icon)
        form.hash = camber_hash(CAMBER_HASH_START, symbol->icon_image, strlen(symbol->icon_image));
    camber_status status = find_rule(layout, symbol, form.icon, &form.rule);
    if (status == CAMBER_OK)
        form.look_hash = layout->rules[form.rule].hash;
    if (status == CAMBER_OK && symbol->section_count && symbol->text_size_px > 0.0)
        status = camber_label_text_make(layout, symbol, &form);
    if (status != CAMBER_OK || (!form.text && !form.icon))
        return status;
    if (form.text)
        status = add_runs(layout, symbol, &form);
    if (status == CAMBER_OK && !camber_grow(layout->context, &layout->forms, &layout->form_capacity,
                                            layout->form_count + 1, sizeof *layout->forms))
        status = CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK) {
        *index = (uint32_t)layout->form_count;
        layout->forms[layout->form_count++] = form;
    }
    return status;
}

camber_status camber_label_form_make(camber_label_layout *layout, const camber_layer_look *look,
                                     const camber_feature_class *class, uint32_t *form) {
    _Alignas(8) char room[ARENA_ROOM];
    camber_arena arena = {.context = layout->context, .at = room, .left = sizeof room, .limit = ARENA_LIMIT};
    const camber_feature_view feature = camber_plan_view_of(layout->features, class);
    const camber_style_images images = {find_number, note_missing, layout->sprites};
    camber_symbol symbol;
    memset(&symbol, 0, sizeof symbol); /* rules are compared byte by byte */
    *form = CAMBER_NO_FORM;
    camber_status status = camber_layer_look_symbol(look, &feature, layout->sprites ? &images : NULL, &arena, &symbol);
    if (status == CAMBER_OK)
        status = add_form(layout, &symbol, form);
    if (status == CAMBER_OK && *form != CAMBER_NO_FORM)
        layout->forms[*form].weight = weight_of(layout->features, &feature);
    camber_arena_free(&arena);
    return status;
}
