/* Finds where the text and the icon of a label are, relative to its anchor.
 *
 * Input: a candidate. Output: boxes in px from the anchor, as if nothing were turned, and the frame that turns them,
 * moves them to the anchor, and makes them smaller with their distance from the camera. */
#include "base/maths.h"
#include "map/label_layout.h"

#include <math.h>

/* Anchors that are nearer the horizon than this have no labels, as in MapLibre. */
static const double LEAST_NEARNESS = 0.6;
/* How much larger a halo is than its blur, and the border of an icon's image, px. */
static const double BLUR_SCALE = 1.19, BORDER_PX = 2.0;

static double depth_of(const camber_label_layout *layout, const double plane[2], double seen[2]) {
    return camber_lens_see(&layout->lens, plane, seen);
}

double camber_label_nearness(const camber_label_layout *layout, const camber_label_candidate *c) {
    const double plane[2] = {c->x, c->y};
    double seen[2];
    const double depth = depth_of(layout, plane, seen);
    const double nearness = depth > 0.0 ? 0.5 + 0.5 / depth : 0.0;
    return nearness < LEAST_NEARNESS ? 0.0 : nearness;
}

/* ---- Frames ---- */

/* Makes the frame at a point of the plane. Its u axis runs along a direction of the plane, turned by an angle.
 * direction NULL: the u axis is only turned by the angle. */
static camber_label_frame make_frame(const camber_label_layout *layout, const double plane[2], const double *direction,
                                     double turn, bool flat) {
    camber_label_frame frame = {.x = plane[0], .y = plane[1], .flat = flat};
    double seen[2] = {plane[0], plane[1]}, scale = 1.0, cosine = 1.0, sine = 0.0;
    const double depth = depth_of(layout, plane, seen);
    if (layout->lens.pitched && depth > 0.0)
        scale = flat ? 0.5 + 0.5 * depth : 0.5 + 0.5 / depth;
    if (!flat) {
        frame.x = seen[0];
        frame.y = seen[1];
    }
    if (direction) {
        double ahead[2] = {plane[0] + direction[0], plane[1] + direction[1]}, to[2] = {ahead[0], ahead[1]};
        if (!flat)
            (void)depth_of(layout, ahead, to);
        const double length = camber_length(to[0] - frame.x, to[1] - frame.y);
        cosine = length > 0.0 ? (to[0] - frame.x) / length : 1.0;
        sine = length > 0.0 ? (to[1] - frame.y) / length : 0.0;
    }
    if (turn != 0.0)
        camber_rotate(turn, &sine, &cosine);
    frame.xx = scale * cosine;
    frame.yx = scale * sine;
    frame.xy = -frame.yx;
    frame.yy = frame.xx;
    return frame;
}

camber_label_frame camber_label_text_frame(const camber_label_layout *layout, const camber_label_candidate *c) {
    const camber_label_rule *rule = camber_label_rule_of(layout, c);
    double base[2];
    camber_label_base(layout, c, base);
    const double plane[2] = {base[0] + rule->text_translate_px[0], base[1] + rule->text_translate_px[1]};
    const double east[2] = {layout->view->cosine, -layout->view->sine};
    return make_frame(layout, plane, rule->text_by_map ? east : NULL, rule->text_turn, rule->text_flat);
}

camber_label_frame camber_label_icon_frame(const camber_label_layout *layout, const camber_label_candidate *c) {
    const camber_label_rule *rule = camber_label_rule_of(layout, c);
    double base[2];
    camber_label_base(layout, c, base);
    const double plane[2] = {base[0] + rule->icon_translate_px[0], base[1] + rule->icon_translate_px[1]};
    const double east[2] = {layout->view->cosine, -layout->view->sine};
    double turn = rule->icon_turn;
    if (!rule->icon_along || c->line == CAMBER_NO_PATH)
        return make_frame(layout, plane, rule->icon_by_map ? east : NULL, turn, rule->icon_flat);
    const camber_label_line *line = layout->lines + c->line;
    const float *a = layout->line_points + 2 * (line->first + c->segment);
    double ahead[2] = {(double)a[2] - (double)a[0], (double)a[3] - (double)a[1]};
    const double length = camber_length(ahead[0], ahead[1]);
    const bool turns = line->reversed != (rule->symbol.icon.keep_upright && (ahead[0] < 0.0) != line->reversed);
    for (int i = 0; i < 2 && length > 0.0; i++)
        ahead[i] *= (turns ? -1.0 : 1.0) / length;
    return make_frame(layout, plane, ahead, turn, rule->icon_flat);
}

bool camber_label_bounds(const camber_label_layout *layout, const camber_label_frame *frame, const camber_box *box,
                         camber_box *bounds) {
    *bounds = CAMBER_BOX_EMPTY;
    for (int i = 0; i < 9; i++) {
        const double u = i % 3 == 0 ? box->x0 : i % 3 == 1 ? 0.5 * (box->x0 + box->x1) : box->x1;
        const double v = i / 3 == 0 ? box->y0 : i / 3 == 1 ? 0.5 * (box->y0 + box->y1) : box->y1;
        double at[2] = {frame->x + frame->xx * u + frame->xy * v, frame->y + frame->yx * u + frame->yy * v};
        if (frame->flat && !(depth_of(layout, at, at) > 0.0))
            return false;
        camber_box_add(bounds, at[0], at[1]);
    }
    return isfinite(bounds->x0) && isfinite(bounds->y0) && isfinite(bounds->x1) && isfinite(bounds->y1);
}

/* ---- Text ---- */

/* Finds where in a text's box the anchor is, along each axis: 0 at the left or the top, 0.5 in the middle, 1 at the
 * right or the bottom. */
static void find_share(camber_text_anchor anchor, double share[2]) {
    share[0] = share[1] = 0.5;
    switch (anchor) {
    case CAMBER_ANCHOR_TOP_LEFT:
    case CAMBER_ANCHOR_LEFT:
    case CAMBER_ANCHOR_BOTTOM_LEFT: share[0] = 0.0; break;
    case CAMBER_ANCHOR_TOP_RIGHT:
    case CAMBER_ANCHOR_RIGHT:
    case CAMBER_ANCHOR_BOTTOM_RIGHT: share[0] = 1.0; break;
    default: break;
    }
    switch (anchor) {
    case CAMBER_ANCHOR_TOP_LEFT:
    case CAMBER_ANCHOR_TOP:
    case CAMBER_ANCHOR_TOP_RIGHT: share[1] = 0.0; break;
    case CAMBER_ANCHOR_BOTTOM_LEFT:
    case CAMBER_ANCHOR_BOTTOM:
    case CAMBER_ANCHOR_BOTTOM_RIGHT: share[1] = 1.0; break;
    default: break;
    }
}

static const camber_text *text_of(const camber_label_layout *layout, const camber_label_candidate *c, bool vertical) {
    const camber_label_form *form = layout->forms + c->form;
    return vertical ? form->vertical : form->text;
}

static camber_box shaped_box(const camber_text *text, double em) {
    return (camber_box){(double)text->left * em, (double)text->top * em, (double)text->right * em,
                        (double)text->bottom * em};
}

void camber_label_text_shift(const camber_label_layout *layout, const camber_label_candidate *c, bool vertical,
                             size_t anchor, double shift_px[2]) {
    const camber_label_rule *rule = camber_label_rule_of(layout, c);
    const double *offset = rule->offsets_em[anchor], em = rule->text_px, ratio = layout->view->ratio;
    shift_px[0] = (vertical && !rule->variable ? -offset[1] : offset[0]) * em;
    shift_px[1] = (vertical && !rule->variable ? offset[0] : offset[1]) * em;
    if (!rule->variable)
        return;
    /* The padding is between the anchor and the text. */
    const camber_box box = shaped_box(text_of(layout, c, vertical), em);
    const double *padding = rule->symbol.text.padding_px;
    double share[2];
    find_share(rule->anchors[anchor], share);
    shift_px[0] -= (share[0] - 0.5) * (box.x1 - box.x0 + (padding[1] + padding[3]) * ratio);
    shift_px[1] -= (share[1] - 0.5) * (box.y1 - box.y0 + (padding[0] + padding[2]) * ratio);
}

camber_box camber_label_text_box(const camber_label_layout *layout, const camber_label_candidate *c, bool vertical,
                                 size_t anchor) {
    const camber_label_rule *rule = camber_label_rule_of(layout, c);
    double shift[2];
    camber_label_text_shift(layout, c, vertical, anchor, shift);
    const camber_box box = shaped_box(text_of(layout, c, vertical), rule->text_px);
    return (camber_box){box.x0 + shift[0], box.y0 + shift[1], box.x1 + shift[0], box.y1 + shift[1]};
}

/* ---- Icons ---- */

/* Returns the length of the ranges between two positions on an axis of an image. */
static double sum_ranges(float (*ranges)[2], size_t count, double low, double high, double size) {
    if (count == 0)
        return fmin(fmax(high, 0.0), size) - fmin(fmax(low, 0.0), size);
    double sum = 0.0;
    for (size_t i = 0; i < count; i++)
        sum += fmin(fmax((double)ranges[i][1], low), high) - fmin(fmax((double)ranges[i][0], low), high);
    return sum;
}

/* One axis of an image that is fitted to a label's text. fit turns the edges of its content into the edges of the whole
 * image.
 */
typedef struct fit_axis {
    float (*ranges)[2];
    size_t count;
    double size, content[2], pixel_ratio;
} fit_axis;

static void fit(const fit_axis *axis, double scale, double ratio, double edges[2]) {
    const double stretched = sum_ranges(axis->ranges, axis->count, 0.0, axis->size, axis->size);
    const double before = sum_ranges(axis->ranges, axis->count, 0.0, axis->content[0], axis->size);
    const double within = sum_ranges(axis->ranges, axis->count, axis->content[0], axis->content[1], axis->size);
    const double fixed = axis->size - stretched, fixed_before = axis->content[0] - before;
    const double fixed_within = axis->content[1] - axis->content[0] - within;
    const double low = edges[0], length = edges[1] - edges[0];
    const double wide = within > 0.0 ? length / within : 0.0;
    edges[0] = (low - before * wide) * scale - fixed_before / axis->pixel_ratio * ratio;
    edges[1] =
        (low + (stretched - before) * wide) * scale + (fixed - fixed_before - fixed_within) / axis->pixel_ratio * ratio;
}

static camber_box fitted_box(const camber_label_layout *layout, const camber_label_candidate *c, bool vertical,
                             size_t anchor) {
    const camber_label_rule *rule = camber_label_rule_of(layout, c);
    const camber_symbol *s = &rule->symbol;
    const camber_sprite_image *image = layout->forms[c->form].icon;
    const double ratio = layout->view->ratio, scale = s->icon_size;
    const double width = image->width / image->pixel_ratio * ratio, height = image->height / image->pixel_ratio * ratio;
    /* If a text may have one of several anchors, the icon moves with it. */
    double moved[2] = {0.0, 0.0};
    camber_box text = camber_label_text_box(layout, c, vertical, anchor);
    if (rule->variable) {
        camber_label_text_shift(layout, c, vertical, anchor, moved);
        text = shaped_box(text_of(layout, c, vertical), rule->text_px);
    }
    double x[2] = {0.5 * (text.x0 + text.x1 - width), 0.5 * (text.x0 + text.x1 + width)};
    double y[2] = {0.5 * (text.y0 + text.y1 - height), 0.5 * (text.y0 + text.y1 + height)};
    if (s->text_fit & CAMBER_FIT_WIDTH) {
        x[0] = text.x0 - s->text_fit_padding_px[3] * ratio;
        x[1] = text.x1 + s->text_fit_padding_px[1] * ratio;
    }
    if (s->text_fit & CAMBER_FIT_HEIGHT) {
        y[0] = text.y0 - s->text_fit_padding_px[0] * ratio;
        y[1] = text.y1 + s->text_fit_padding_px[2] * ratio;
    }
    for (int i = 0; i < 2; i++) {
        x[i] += s->icon_offset_px[0] * ratio;
        y[i] += s->icon_offset_px[1] * ratio;
    }
    const bool has = image->has_content;
    const fit_axis across = {image->stretch_x,
                             image->stretch_x_count,
                             image->width,
                             {has ? (double)image->content[0] : 0.0, has ? (double)image->content[2] : image->width},
                             image->pixel_ratio};
    const fit_axis down = {image->stretch_y,
                           image->stretch_y_count,
                           image->height,
                           {has ? (double)image->content[1] : 0.0, has ? (double)image->content[3] : image->height},
                           image->pixel_ratio};
    fit(&across, scale, ratio, x);
    fit(&down, scale, ratio, y);
    return (camber_box){x[0] + moved[0], y[0] + moved[1], x[1] + moved[0], y[1] + moved[1]};
}

camber_box camber_label_icon_box(const camber_label_layout *layout, const camber_label_candidate *c, bool vertical,
                                 size_t anchor) {
    const camber_symbol *s = &camber_label_rule_of(layout, c)->symbol;
    const camber_label_form *form = layout->forms + c->form;
    if (s->text_fit != CAMBER_FIT_NONE && form->text)
        return fitted_box(layout, c, vertical, anchor);
    const double scale = s->icon_size * layout->view->ratio;
    const double width = form->icon->width / form->icon->pixel_ratio * scale;
    const double height = form->icon->height / form->icon->pixel_ratio * scale;
    double share[2];
    find_share(s->icon_anchor, share);
    const double x = s->icon_offset_px[0] * scale - share[0] * width;
    const double y = s->icon_offset_px[1] * scale - share[1] * height;
    return (camber_box){x, y, x + width, y + height};
}

/* ---- Pixels ---- */

/* Returns how far a text's pixels may be from what it takes up when labels collide, em. */
static double find_overhang(camber_fonts *fonts, const camber_text *text, bool along) {
    double most = 0.0;
    for (size_t i = 0; text && i < text->glyph_count; i++) {
        const camber_text_glyph *g = text->glyphs + i;
        camber_outline o;
        if (g->glyph == CAMBER_NO_GLYPH || camber_fonts_get_outline(fonts, g->glyph, 0.0f, &o) != CAMBER_OK)
            continue;
        const double s = (double)g->scale, x = (double)g->x, y = (double)g->y;
        const double left = x + s * (double)(g->turned ? -o.bottom : o.left);
        const double right = x + s * (double)(g->turned ? -o.top : o.right);
        const double top = y + s * (double)(g->turned ? o.left : o.top);
        const double bottom = y + s * (double)(g->turned ? o.right : o.bottom);
        if (along)
            most = fmax(most, fmax(fmax(fabs(top), fabs(bottom)), fmax(right - left, (double)g->advance)));
        else
            most = fmax(most, fmax(fmax((double)text->left - left, right - (double)text->right),
                                   fmax((double)text->top - top, bottom - (double)text->bottom)));
    }
    return most;
}

static double find_halo(const camber_symbol_part *part) {
    const bool drawn = part->halo_width_px > 0.0 && part->halo_color.a > 0.0f;
    return (drawn ? part->halo_width_px + BLUR_SCALE * fmax(part->halo_blur_px, 0.0) : 0.0) -
           fmin(fmin(part->padding_px[0], part->padding_px[1]),
                fmin(fmin(part->padding_px[2], part->padding_px[3]), 0.0));
}

double camber_label_margin(camber_label_layout *layout, uint32_t form, bool of_text) {
    camber_label_form *f = layout->forms + form;
    const camber_label_rule *rule = layout->rules + f->rule;
    double *margin = of_text ? &f->text_margin_px : &f->icon_margin_px;
    if (*margin >= 0.0)
        return *margin;
    *margin = BORDER_PX + find_halo(of_text ? &rule->symbol.text : &rule->symbol.icon);
    if (of_text)
        *margin += rule->text_px * fmax(find_overhang(layout->fonts, f->text, rule->text_along),
                                        find_overhang(layout->fonts, f->vertical, rule->text_along));
    return *margin;
}
