/* Draws what a sheet shows besides its map: title, frame, grid, scale bar, north arrow, credit.
 *
 * Input: the page and the view. Output: Cairo's paths and texts, in device px of the sheet. Everything on the map has a
 * light halo, so that it can be read on any style. */
#include "print/page.h"

#include "features/mercator.h"

#include <math.h>
#include <stdio.h>

static const double PI = 3.14159265358979323846;
static const double EARTH_M = 40075016.68557849; /* circumference at the equator, as in Web Mercator */
static const double INK = 0.13;
static const char *const REGULAR = "Noto Sans Regular", *const BOLD = "Noto Sans Bold";

typedef struct marginalia {
    const camber_page *page;
    const camber_view *view;
    camber_page_fonts *fonts;
    cairo_t *cr;
    double text_px, mm;      /* the height of small texts; px per mm */
    double x0, y0, x1, y1;   /* the map */
    double shift_x, shift_y; /* from the view's px to the sheet's */
} marginalia;

/* ---- Texts ---- */

typedef struct words {
    const char *text, *font;
    double x, y; /* of the anchor */
    camber_text_anchor anchor;
    double size_px, most_px; /* a longer text is made smaller; 0: it may have any length */
    bool halo;
} words;

static camber_status draw_shaped(const marginalia *m, const words *w, const camber_text *text) {
    const double length = (double)(text->right - text->left) * w->size_px;
    const double size = w->most_px > 0.0 && length > w->most_px ? w->size_px * w->most_px / length : w->size_px;
    camber_page_glyph *glyphs = camber_alloc_zero(m->page->context, text->glyph_count, sizeof *glyphs);
    if (!glyphs)
        return CAMBER_ERROR_MEMORY;
    const uint32_t text_size = (uint32_t)strlen(w->text);
    for (size_t i = 0; i < text->glyph_count; i++) {
        const camber_text_glyph *g = text->glyphs + i;
        uint32_t end = text_size;
        for (size_t k = 0; k < text->glyph_count && text->glyph_count < 4096; k++)
            if (text->glyphs[k].byte > g->byte && text->glyphs[k].byte < end)
                end = text->glyphs[k].byte;
        glyphs[i] = (camber_page_glyph){.glyph = g->glyph,
                                        .first_byte = g->byte,
                                        .end_byte = end,
                                        .x = w->x + (double)g->x * size,
                                        .y = w->y + (double)g->y * size};
    }
    const camber_page_run run = {.glyphs = glyphs, .count = text->glyph_count, .xx = size, .yy = size, .text = w->text};
    camber_status status = CAMBER_OK;
    if (w->halo) {
        cairo_new_path(m->cr);
        status = camber_page_add_outlines(m->fonts, m->cr, &run);
        cairo_set_source_rgb(m->cr, 1.0, 1.0, 1.0);
        cairo_set_line_join(m->cr, CAIRO_LINE_JOIN_ROUND);
        cairo_set_line_width(m->cr, 0.3 * size);
        cairo_stroke(m->cr);
    }
    cairo_set_source_rgb(m->cr, INK, INK, INK);
    if (status == CAMBER_OK)
        status = camber_page_show(m->fonts, m->cr, &run);
    camber_free(m->page->context, glyphs);
    return status;
}

static camber_status draw_words(const marginalia *m, const words *w) {
    const camber_text_run run = {.text = w->text, .size_bytes = strlen(w->text), .fonts = &w->font, .font_count = 1};
    const camber_text_desc desc = {.runs = &run, .run_count = 1, .anchor = w->anchor};
    camber_text *text = NULL;
    camber_status status = camber_text_shape(m->page->fonts, &desc, &text);
    if (status == CAMBER_OK && text->glyph_count)
        status = draw_shaped(m, w, text);
    camber_text_destroy(text);
    return status;
}

static camber_status draw_titles(const marginalia *m) {
    const camber_page *page = m->page;
    const double x = 0.5 * (m->x0 + m->x1), most = m->x1 - m->x0;
    double y = m->y1 + 0.95 * page->title_px;
    const words title = {page->desc.title, BOLD, x, y, CAMBER_ANCHOR_CENTER, page->title_px, most, false};
    camber_status status = CAMBER_OK;
    if (page->desc.title)
        status = draw_words(m, &title);
    y = m->y1 + 1.7 * page->title_px + 0.6 * page->subtitle_px;
    const words subtitle = {page->desc.subtitle, REGULAR, x, y, CAMBER_ANCHOR_CENTER, page->subtitle_px, most, false};
    return status == CAMBER_OK && page->desc.subtitle ? draw_words(m, &subtitle) : status;
}

/* ---- Grid ---- */

/* Steps in seconds of arc. */
static double choose_step(double wanted) {
    static const double steps[] = {1,   2,    5,    10,   20,   30,    60,    120,   300,
                                   600, 1200, 1800, 3600, 7200, 18000, 36000, 72000, 108000};
    const size_t count = sizeof steps / sizeof *steps;
    for (size_t i = 0; i < count; i++)
        if (steps[i] >= wanted)
            return steps[i];
    return steps[count - 1];
}

/* Writes an angle of whole seconds of arc, as 8°36′30″W. */
static void write_angle(long seconds, const char *signs, char *text, size_t size) {
    const long whole = labs(seconds);
    const char sign[2] = {whole ? signs[seconds < 0] : 0, 0};
    if (whole % 3600 == 0)
        snprintf(text, size, "%ld\u00b0%s", whole / 3600, sign);
    else if (whole % 60 == 0)
        snprintf(text, size, "%ld\u00b0%02ld\u2032%s", whole / 3600, whole / 60 % 60, sign);
    else
        snprintf(text, size, "%ld\u00b0%02ld\u2032%02ld\u2033%s", whole / 3600, whole / 60 % 60, whole % 60, sign);
}

static void to_sheet(const marginalia *m, double x, double y, double px[2]) {
    camber_view_project(m->view, x, y, px);
    px[0] += m->shift_x;
    px[1] += m->shift_y;
}

/* Draws a line of the grid between two points of the world, and its label where the line leaves the map: a meridian at
 * the top, a parallel on the left. */
static camber_status draw_grid_line(const marginalia *m, const double ends[4], const char *label, bool meridian) {
    double a[2], b[2];
    to_sheet(m, ends[0], ends[1], a);
    to_sheet(m, ends[2], ends[3], b);
    cairo_set_source_rgba(m->cr, INK, INK, INK, 0.45);
    cairo_set_line_width(m->cr, 0.15 * m->mm);
    cairo_move_to(m->cr, a[0], a[1]);
    cairo_line_to(m->cr, b[0], b[1]);
    cairo_stroke(m->cr);
    const int along = meridian ? 1 : 0, across = !along;
    const double edge = meridian ? m->y0 : m->x0, step = b[along] - a[along];
    const double t = step != 0.0 ? (edge - a[along]) / step : -1.0;
    const double at = a[across] + t * (b[across] - a[across]);
    const double low = meridian ? m->x0 : m->y0, high = meridian ? m->x1 : m->y1;
    if (!(t >= 0.0 && t <= 1.0 && at > low + 2.0 * m->text_px && at < high - 2.0 * m->text_px))
        return CAMBER_OK;
    const double gap = 0.3 * m->text_px;
    const words w = {label,
                     REGULAR,
                     meridian ? at : edge + gap,
                     meridian ? edge + gap : at,
                     meridian ? CAMBER_ANCHOR_TOP : CAMBER_ANCHOR_LEFT,
                     0.8 * m->text_px,
                     0.0,
                     true};
    return draw_words(m, &w);
}

static camber_status draw_grid(const marginalia *m) {
    double corners[8], west = INFINITY, east = -INFINITY, top = INFINITY, bottom = -INFINITY;
    camber_view_corners(m->view, corners);
    for (int i = 0; i < 4; i++) {
        west = fmin(west, corners[2 * i]);
        east = fmax(east, corners[2 * i]);
        top = fmin(top, corners[2 * i + 1]);
        bottom = fmax(bottom, corners[2 * i + 1]);
    }
    top = fmin(fmax(top, 0.0), 1.0);
    bottom = fmin(fmax(bottom, 0.0), 1.0);
    double longitude, north, south;
    camber_mercator_unproject(0.5, top, &longitude, &north);
    camber_mercator_unproject(0.5, bottom, &longitude, &south);
    const double wide = (east - west) * 1296000.0, high = (north - south) * 3600.0;
    const double step = choose_step(fmax(wide, high) / 6.0);
    char label[64];
    camber_status status = CAMBER_OK;
    for (double s = ceil(((west - 0.5) * 1296000.0) / step);
         s * step <= (east - 0.5) * 1296000.0 && status == CAMBER_OK; s += 1.0) {
        const double x = 0.5 + s * step / 1296000.0, ends[4] = {x, top, x, bottom};
        write_angle((long)remainder(s * step, 1296000.0), "EW", label, sizeof label);
        status = draw_grid_line(m, ends, label, true);
    }
    for (double s = ceil(south * 3600.0 / step); s * step <= north * 3600.0 && status == CAMBER_OK; s += 1.0) {
        double x, y;
        camber_mercator_project(0.0, s * step / 3600.0, &x, &y);
        const double ends[4] = {west, y, east, y};
        write_angle((long)(s * step), "NS", label, sizeof label);
        status = draw_grid_line(m, ends, label, false);
    }
    return status;
}

/* ---- Scale bar ---- */

/* Returns the largest of 1, 2, 5, 10, ... that is not above a length. */
static double round_down(double length) {
    const double power = pow(10.0, floor(log10(length)));
    const double part = length / power;
    return (part >= 5.0 ? 5.0 : part >= 2.0 ? 2.0 : 1.0) * power;
}

/* Writes a whole number with commas between its thousands. */
static void write_thousands(double number, char *text, size_t size) {
    char digits[40];
    const int count = snprintf(digits, sizeof digits, "%.0f", number);
    size_t at = 0;
    for (int i = 0; i < count && at + 2 < size; i++) {
        if (i > 0 && (count - i) % 3 == 0)
            text[at++] = ',';
        text[at++] = digits[i];
    }
    text[at] = 0;
}

static camber_status draw_scale_bar(const marginalia *m) {
    double longitude, latitude;
    camber_view_center(m->view, &longitude, &latitude);
    const double metres = EARTH_M * cos(latitude * PI / 180.0) / m->view->scale_px;
    const double most = fmin(0.25 * (m->x1 - m->x0), 80.0 * m->mm);
    if (!(metres > 0.0 && isfinite(metres) && most > 4.0 * m->text_px))
        return CAMBER_OK;
    const double length = round_down(most * metres), length_px = length / metres, height = 0.22 * m->text_px;
    const double x = m->x0 + 0.9 * m->text_px, y = m->y1 - 0.9 * m->text_px - height;
    /* The fraction has three digits: more would pretend to a precision that paper does not have. */
    const double fraction = metres * m->mm * 1000.0;
    const double unit = pow(10.0, fmax(floor(log10(fraction)) - 2.0, 0.0));
    char text[128], thousands[48];
    write_thousands(round(fraction / unit) * unit, thousands, sizeof thousands);
    snprintf(text, sizeof text, "%g %s  \u00b7  1 : %s", length >= 1000.0 ? length / 1000.0 : length,
             length >= 1000.0 ? "km" : "m", thousands);
    cairo_t *cr = m->cr;
    cairo_rectangle(cr, x, y, length_px, height);
    cairo_set_source_rgb(cr, 1.0, 1.0, 1.0);
    cairo_set_line_width(cr, 0.3 * m->text_px);
    cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
    cairo_stroke_preserve(cr);
    cairo_fill_preserve(cr);
    cairo_set_source_rgb(cr, INK, INK, INK);
    cairo_set_line_width(cr, 0.06 * m->text_px);
    cairo_stroke(cr);
    for (int i = 0; i < 4; i += 2)
        cairo_rectangle(cr, x + 0.25 * i * length_px, y, 0.25 * length_px, height);
    cairo_fill(cr);
    const words w = {text, REGULAR, x, y - 0.25 * m->text_px, CAMBER_ANCHOR_BOTTOM_LEFT, m->text_px, 0.0, true};
    return draw_words(m, &w);
}

/* ---- North arrow, credit, frame ---- */

static camber_status draw_north_arrow(const marginalia *m) {
    const double size = 2.2 * m->text_px, x = m->x1 - 1.4 * size, y = m->y0 + 1.6 * size;
    const double angle = -m->view->bearing_deg * PI / 180.0;
    cairo_t *cr = m->cr;
    cairo_save(cr);
    cairo_translate(cr, x, y);
    cairo_rotate(cr, fmod(angle, 2.0 * PI));
    cairo_move_to(cr, 0.0, -size);
    cairo_line_to(cr, 0.42 * size, 0.6 * size);
    cairo_line_to(cr, 0.0, 0.3 * size);
    cairo_line_to(cr, -0.42 * size, 0.6 * size);
    cairo_close_path(cr);
    cairo_set_source_rgb(cr, 1.0, 1.0, 1.0);
    cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_width(cr, 0.3 * m->text_px);
    cairo_stroke_preserve(cr);
    cairo_fill_preserve(cr);
    cairo_set_source_rgb(cr, INK, INK, INK);
    cairo_set_line_width(cr, 0.06 * m->text_px);
    cairo_stroke(cr);
    cairo_move_to(cr, 0.0, -size);
    cairo_line_to(cr, 0.42 * size, 0.6 * size);
    cairo_line_to(cr, 0.0, 0.3 * size);
    cairo_close_path(cr);
    cairo_fill(cr);
    cairo_restore(cr);
    const words w = {
        "N", BOLD, x + 1.1 * size * sin(angle), y + 1.1 * size * cos(angle), CAMBER_ANCHOR_CENTER, m->text_px,
        0.0, true};
    return draw_words(m, &w);
}

static camber_status draw_credit(const marginalia *m) {
    const char *credit = m->page->credit;
    const bool spelt = strncmp(credit, "(c)", 3) == 0;
    const size_t size = strlen(credit) + 4;
    char *text = camber_alloc(m->page->context, size, 1);
    if (!text)
        return CAMBER_ERROR_MEMORY;
    snprintf(text, size, "%s%s", spelt ? "\u00a9" : "", spelt ? credit + 3 : credit);
    const double gap = 0.35 * m->text_px;
    const words w = {
        text, REGULAR, m->x1 - gap, m->y1 - gap, CAMBER_ANCHOR_BOTTOM_RIGHT, 0.75 * m->text_px, 0.6 * (m->x1 - m->x0),
        true};
    const camber_status status = draw_words(m, &w);
    camber_free(m->page->context, text);
    return status;
}

static void draw_frame(const marginalia *m) {
    if (!(m->page->desc.margin_mm > 0.0))
        return;
    cairo_rectangle(m->cr, m->x0, m->y0, m->x1 - m->x0, m->y1 - m->y0);
    cairo_set_source_rgb(m->cr, INK, INK, INK);
    cairo_set_line_join(m->cr, CAIRO_LINE_JOIN_MITER);
    cairo_set_line_width(m->cr, 0.2 * m->mm);
    cairo_stroke(m->cr);
}

camber_status camber_page_clip(const camber_page *page, cairo_t *cr) {
    const camber_page_info *info = &page->info;
    double x0, y0, x1, y1;
    cairo_rectangle(cr, info->map_x, info->map_y, info->map_width, info->map_height);
    cairo_clip(cr);
    /* If Cairo has no memory for a clip, it clips everything, and its status stays the same. */
    cairo_clip_extents(cr, &x0, &y0, &x1, &y1);
    if (cairo_status(cr) != CAIRO_STATUS_SUCCESS || (x0 < x1 && y0 < y1))
        return CAMBER_OK; /* a status is told at the end of the page */
    return camber_fail(page->context, CAMBER_ERROR_MEMORY, "page: Cairo has no memory to clip the map");
}

camber_status camber_page_draw_marginalia(const camber_page *page, const camber_scene_parts *parts,
                                          camber_page_fonts *fonts, cairo_t *cr) {
    const camber_page_info *info = &page->info;
    const double crop_x = (parts->view->width - info->map_width) / 2,
                 crop_y = (parts->view->height - info->map_height) / 2;
    marginalia m = {.page = page,
                    .view = parts->view,
                    .fonts = fonts,
                    .cr = cr,
                    .mm = page->px_per_mm,
                    .x0 = info->map_x,
                    .y0 = info->map_y,
                    .x1 = (double)info->map_x + info->map_width,
                    .y1 = (double)info->map_y + info->map_height,
                    .shift_x = info->map_x - crop_x,
                    .shift_y = info->map_y - crop_y};
    m.text_px = fmin(fmax(0.013 * fmin(info->width, info->height), 1.8 * m.mm), 9.0 * m.mm);
    const bool flat = parts->view->pitch_deg == 0.0; /* a tilted map has no one scale */
    cairo_save(cr);
    camber_status status = camber_page_clip(page, cr);
    if (status == CAMBER_OK && page->desc.grid && flat)
        status = draw_grid(&m);
    if (status == CAMBER_OK && page->desc.scale_bar && flat)
        status = draw_scale_bar(&m);
    if (status == CAMBER_OK && page->desc.north_arrow)
        status = draw_north_arrow(&m);
    if (status == CAMBER_OK && page->credit)
        status = draw_credit(&m);
    cairo_restore(cr);
    draw_frame(&m);
    return status == CAMBER_OK ? draw_titles(&m) : status;
}
