/* Writes pages: as PDF and SVG by Cairo, or as rows of pixels with what the sheet adds to the map.
 *
 * Cairo keeps a page in memory until it is complete. Rows of a picture are drawn band by band, so a poster needs no
 * more memory than its bands: the renderer draws the map, and Cairo the rest into each band. */
#include "print/page.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double POINTS_PER_INCH = 72.0, POINTS_PER_MM = 72.0 / 25.4;

/* ---- Vectors ---- */

typedef struct stream {
    camber_sink sink;
    bool refused;
} stream;

static cairo_status_t write_bytes(void *user, const unsigned char *bytes, unsigned size_bytes) {
    stream *s = user;
    s->refused = s->refused || !s->sink.write(s->sink.user, bytes, size_bytes);
    return s->refused ? CAIRO_STATUS_WRITE_ERROR : CAIRO_STATUS_SUCCESS;
}

/* A file must not depend on when it was made, so it always says the same date: Cairo's default is the time of day.
 * SOURCE_DATE_EPOCH is not read. */
static void describe(const camber_page *page, cairo_surface_t *surface) {
    char creator[64];
    snprintf(creator, sizeof creator, "camber %s", camber_version());
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATOR, creator);
    if (page->desc.title)
        cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_TITLE, page->desc.title);
    if (page->credit && camber_page_is_utf8(page->credit, strlen(page->credit)))
        cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_AUTHOR, page->credit);
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
}

static cairo_surface_t *make_surface(const camber_page *page, camber_page_format format, stream *s) {
    const double width = page->desc.width_mm * POINTS_PER_MM, height = page->desc.height_mm * POINTS_PER_MM;
    if (format == CAMBER_PAGE_PDF) {
        cairo_surface_t *made = cairo_pdf_surface_create_for_stream(write_bytes, s, width, height);
        describe(page, made);
        return made;
    }
    cairo_surface_t *made = cairo_svg_surface_create_for_stream(write_bytes, s, width, height);
    cairo_svg_surface_set_document_unit(made, CAIRO_SVG_UNIT_PT); /* Cairo 1.18 would say px */
    return made;
}

/* Lets text have its true size and place. */
static void set_font_options(cairo_t *cr) {
    cairo_font_options_t *options = cairo_font_options_create();
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_set_font_options(cr, options);
    cairo_font_options_destroy(options);
}

static camber_status draw_page(camber_page *page, camber_page_map *map, const camber_page_crop *crop) {
    const camber_page_info *info = &page->info;
    cairo_t *cr = map->cr;
    camber_page_fonts own = {
        .context = page->context, .fonts = page->fonts, .shared = &map->fonts, .as_paths = map->fonts.as_paths};
    /* Only a PDF has a white sheet of its own. */
    if (map->fonts.as_paths && (page->desc.margin_mm > 0.0 || page->desc.title || page->desc.subtitle)) {
        cairo_set_source_rgb(cr, 1.0, 1.0, 1.0);
        cairo_paint(cr);
    }
    cairo_scale(cr, POINTS_PER_INCH / info->dpi, POINTS_PER_INCH / info->dpi);
    set_font_options(cr);
    cairo_save(cr);
    camber_status status = camber_page_clip(page, cr);
    cairo_translate(cr, (double)info->map_x - crop->x, (double)info->map_y - crop->y);
    if (status == CAMBER_OK)
        status = camber_page_draw_map(map);
    cairo_restore(cr);
    if (status == CAMBER_OK)
        status = camber_page_draw_marginalia(page, &map->parts, &own, cr);
    camber_page_fonts_free(&own);
    return status;
}

static camber_status end_page(camber_page *page, cairo_t *cr, cairo_surface_t *surface, const stream *s) {
    cairo_show_page(cr);
    const cairo_status_t drawn = cairo_status(cr);
    cairo_surface_finish(surface);
    const cairo_status_t written = cairo_surface_status(surface);
    const cairo_status_t failed = drawn != CAIRO_STATUS_SUCCESS ? drawn : written;
    if (s->refused)
        return CAMBER_ERROR_IO;
    if (failed == CAIRO_STATUS_SUCCESS)
        return CAMBER_OK;
    const bool misused = failed == CAIRO_STATUS_INVALID_SIZE || failed == CAIRO_STATUS_INVALID_STRING;
    const camber_status status = failed == CAIRO_STATUS_NO_MEMORY ? CAMBER_ERROR_MEMORY
                                 : misused                        ? CAMBER_ERROR_ARGUMENT
                                                                  : CAMBER_ERROR_IO;
    return camber_fail(page->context, status, "page: Cairo cannot write it (%s)", cairo_status_to_string(failed));
}

camber_status camber_page_write(camber_page *page, camber_scene *scene, camber_renderer *renderer, camber_mesh *mesh,
                                camber_page_format format, camber_sink sink) {
    camber_page_crop crop;
    camber_status status = camber_page_crop_of(page, scene, &crop);
    if (status != CAMBER_OK)
        return status;
    const camber_scene_parts parts = camber_scene_get_parts(scene);
    if (parts.zoom->features->polyline_count && !parts.zoom->features->points)
        return camber_fail(page->context, CAMBER_ERROR_ARGUMENT,
                           "page: the scene has released the points of its features; make it by camber_scene_create");
    stream s = {.sink = sink};
    cairo_surface_t *surface = make_surface(page, format, &s);
    cairo_t *cr = cairo_create(surface);
    camber_context *context = page->context;
    camber_page_map map = {.page = page,
                           .context = context,
                           .cr = cr,
                           .scene = scene,
                           .parts = parts,
                           .renderer = renderer,
                           .mesh = mesh,
                           .lines.context = context,
                           .beside.context = context,
                           .part.context = context};
    map.frame.background = map.parts.zoom->plan.background;
    map.frame.pitch_deg = map.parts.view->pitch_deg;
    map.fonts = (camber_page_fonts){
        .context = context, .fonts = map.parts.zoom->features->fonts, .as_paths = format == CAMBER_PAGE_SVG};
    status = draw_page(page, &map, &crop);
    if (status == CAMBER_OK)
        status = end_page(page, cr, surface, &s);
    else
        s.refused = true; /* what Cairo still writes when it ends goes nowhere */
    cairo_destroy(cr);
    cairo_surface_destroy(surface);
    camber_page_map_free(&map);
    return status;
}

/* ---- Pictures ---- */

/* Rows of the sheet, which are sent on as rows of the map arrive. */
typedef struct sheet {
    const camber_page *page;
    const camber_scene_parts *parts;
    camber_page_crop crop;
    cairo_surface_t *drawing; /* a recording of what the page adds */
    camber_rows_fn *rows;
    void *user;
    uint8_t *band; /* in Cairo's order of bytes, then in that of the caller */
    uint32_t next; /* the sheet's next row */
    camber_status status;
} sheet;

enum { BAND_ROWS = 64 };

/* Draws what the page adds into the columns of a band from x on. */
static cairo_status_t draw_columns(const sheet *s, uint32_t x, uint32_t count, uint32_t row_count) {
    cairo_surface_t *surface = cairo_image_surface_create_for_data(
        s->band + 4 * (size_t)x, CAIRO_FORMAT_ARGB32, (int)count, (int)row_count, (int)(4 * s->page->info.width));
    cairo_t *cr = cairo_create(surface);
    cairo_set_source_surface(cr, s->drawing, -(double)x, -(double)s->next);
    cairo_paint(cr);
    const cairo_status_t drawn = cairo_status(cr);
    cairo_destroy(cr);
    cairo_surface_flush(surface);
    cairo_surface_destroy(surface);
    return drawn;
}

/* Draws what the page adds into a band, and sends it on. */
static bool send_band(sheet *s, uint32_t row_count) {
    const uint32_t width = s->page->info.width;
    cairo_status_t drawn = CAIRO_STATUS_SUCCESS;
    for (uint32_t x = 0; x < width && drawn == CAIRO_STATUS_SUCCESS; x += CAMBER_PAGE_TILE_PX)
        drawn = draw_columns(s, x, width - x < CAMBER_PAGE_TILE_PX ? width - x : CAMBER_PAGE_TILE_PX, row_count);
    if (drawn != CAIRO_STATUS_SUCCESS) {
        s->status = camber_fail(s->page->context, CAMBER_ERROR_MEMORY, "page: Cairo cannot draw a band of it (%s)",
                                cairo_status_to_string(drawn));
        return false;
    }
    for (size_t i = 0; i < (size_t)width * row_count; i++) {
        uint32_t argb;
        memcpy(&argb, s->band + 4 * i, sizeof argb);
        s->band[4 * i] = (uint8_t)(argb >> 16);
        s->band[4 * i + 1] = (uint8_t)(argb >> 8);
        s->band[4 * i + 2] = (uint8_t)argb;
        s->band[4 * i + 3] = (uint8_t)(argb >> 24);
    }
    const uint32_t first = s->next;
    s->next += row_count;
    if (s->rows(s->user, s->band, first, row_count))
        return true;
    s->status = CAMBER_ERROR_IO;
    return false;
}

/* Sends rows that have no map, up to this one. */
static bool send_paper(sheet *s, uint32_t end) {
    while (s->next < end) {
        const uint32_t count = end - s->next < BAND_ROWS ? end - s->next : BAND_ROWS;
        memset(s->band, 255, (size_t)4 * s->page->info.width * count);
        if (!send_band(s, count))
            return false;
    }
    return true;
}

/* Puts a row of the map over white paper. */
static void put_row(const sheet *s, const uint8_t *rgba, uint8_t *row) {
    const camber_page_info *info = &s->page->info;
    memset(row, 255, (size_t)4 * info->width);
    rgba += (size_t)4 * s->crop.x;
    row += (size_t)4 * info->map_x;
    for (uint32_t x = 0; x < info->map_width; x++, rgba += 4, row += 4) {
        const uint8_t paper = (uint8_t)(255 - rgba[3]);
        const uint8_t over[4] = {(uint8_t)(rgba[0] + paper), (uint8_t)(rgba[1] + paper), (uint8_t)(rgba[2] + paper),
                                 255};
        const uint32_t argb = camber_page_argb(over);
        memcpy(row, &argb, sizeof argb);
    }
}

static bool take_map(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    sheet *s = user;
    const camber_page_info *info = &s->page->info;
    const size_t stride = (size_t)4 * s->parts->view->width;
    uint32_t filled = 0;
    if (!send_paper(s, info->map_y))
        return false;
    for (uint32_t i = 0; i < row_count; i++) {
        const uint32_t row = first_row + i;
        if (row < s->crop.y || row >= s->crop.y + info->map_height)
            continue;
        put_row(s, rgba + stride * i, s->band + (size_t)4 * info->width * filled++);
        if (filled == BAND_ROWS) {
            if (!send_band(s, filled))
                return false;
            filled = 0;
        }
    }
    return !filled || send_band(s, filled);
}

static camber_status record_marginalia(sheet *s) {
    const camber_page *page = s->page;
    camber_page_fonts fonts = {.context = page->context, .fonts = page->fonts, .as_paths = true};
    const cairo_rectangle_t all = {0.0, 0.0, page->info.width, page->info.height};
    s->drawing = cairo_recording_surface_create(CAIRO_CONTENT_COLOR_ALPHA, &all);
    cairo_t *cr = cairo_create(s->drawing);
    set_font_options(cr);
    camber_status status = camber_page_draw_marginalia(page, s->parts, &fonts, cr);
    if (status == CAMBER_OK && cairo_status(cr) != CAIRO_STATUS_SUCCESS)
        status = camber_fail(page->context, CAMBER_ERROR_MEMORY, "page: Cairo cannot draw its title and signs (%s)",
                             cairo_status_to_string(cairo_status(cr)));
    cairo_destroy(cr);
    camber_page_fonts_free(&fonts);
    return status;
}

camber_status camber_page_render(camber_page *page, camber_scene *scene, camber_renderer *renderer, camber_mesh *mesh,
                                 camber_rows_fn *rows, void *user, camber_frame_stats *stats) {
    const camber_scene_parts parts = camber_scene_get_parts(scene);
    sheet s = {.page = page, .parts = &parts, .rows = rows, .user = user};
    camber_status status = camber_page_crop_of(page, scene, &s.crop);
    if (status != CAMBER_OK)
        return status;
    s.band = camber_alloc(page->context, (size_t)page->info.width * BAND_ROWS, 4);
    status = s.band ? record_marginalia(&s) : CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK) {
        const camber_frame frame = camber_scene_get_frame(scene, mesh);
        status = camber_renderer_render(renderer, &frame, take_map, &s, stats);
    }
    if (s.status != CAMBER_OK)
        status = s.status;
    if (status == CAMBER_OK && !send_paper(&s, page->info.height))
        status = s.status;
    cairo_surface_destroy(s.drawing);
    camber_free(page->context, s.band);
    return status;
}
