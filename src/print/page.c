/* Pages: which part of a sheet shows the map, and how large its view is.
 *
 *     +------------------ sheet ------------------+
 *     |  margin                                   |
 *     |   +------------- map -----------------+   |
 *     |   |                                   |   |
 *     |   +-----------------------------------+   |
 *     |                  Title                    |
 *     |                 subtitle                  |
 *     |  margin                                   |
 *     +-------------------------------------------+
 */
#include "camber_print.h"

#include "base/base.h"

#include <math.h>
#include <string.h>
#include <strings.h>

bool camber_paper_find(const char *name, double *width_mm, double *height_mm) {
    static const struct {
        const char *name;
        double width, height;
    } papers[] = {{"A0", 841, 1189},        {"A1", 594, 841}, {"A2", 420, 594},         {"A3", 297, 420},
                  {"A4", 210, 297},         {"A5", 148, 210}, {"A6", 105, 148},         {"B0", 1000, 1414},
                  {"B1", 707, 1000},        {"B2", 500, 707}, {"B3", 353, 500},         {"B4", 250, 353},
                  {"B5", 176, 250},         {"B6", 125, 176}, {"Letter", 215.9, 279.4}, {"Legal", 215.9, 355.6},
                  {"Tabloid", 279.4, 431.8}};
    for (size_t i = 0; i < sizeof papers / sizeof *papers; i++)
        if (strcasecmp(papers[i].name, name) == 0) {
            *width_mm = papers[i].width;
            *height_mm = papers[i].height;
            return true;
        }
    return false;
}

#ifdef CAMBER_CAIRO

#include "print/page.h"

static const double MM_PER_INCH = 25.4, CSS_PX_PER_INCH = 96.0;
/* The title's height is this part of the sheet's shorter side; the subtitle's is a part of the title's. */
static const double TITLE_SHARE = 0.05, SUBTITLE_SHARE = 0.42;
/* Heights of the lines of text below the map, in heights of the text. */
static const double TITLE_LINE = 1.7, SUBTITLE_LINE = 1.6;

bool camber_page_is_built(void) {
    return true;
}

static camber_status check(camber_context *context, const char *what, double value, double low, double high) {
    if (value >= low && value <= high) /* false for NaN */
        return CAMBER_OK;
    return camber_fail(context, CAMBER_ERROR_ARGUMENT, "page: %s is %g; choose %g to %g", what, value, low, high);
}

static camber_status check_desc(camber_context *context, const camber_page_desc *desc) {
    camber_status status = check(context, "the width in mm", desc->width_mm, 10, 20000);
    if (status == CAMBER_OK)
        status = check(context, "the height in mm", desc->height_mm, 10, 20000);
    if (status == CAMBER_OK)
        status = check(context, "the margin in mm", desc->margin_mm, 0, 20000);
    if (status == CAMBER_OK)
        status = check(context, "the resolution in dpi", desc->dpi, 10, 4800);
    if (status == CAMBER_OK)
        status = check(context, "the ratio", desc->ratio, 1e-3, 1e3);
    return status;
}

/* Finds the smallest number of CSS px that covers the map's px. */
static uint32_t cover_px(uint32_t map_px, double ratio) {
    return (uint32_t)fmax(ceil((double)map_px / ratio - 1e-9), 1.0);
}

static camber_status lay_out(camber_page *page) {
    const camber_page_desc *desc = &page->desc;
    camber_page_info *info = &page->info;
    page->px_per_mm = desc->dpi / MM_PER_INCH;
    const double width = round(desc->width_mm * page->px_per_mm), height = round(desc->height_mm * page->px_per_mm);
    if (!(width >= 1.0 && height >= 1.0 && width <= 65535.0 && height <= 65535.0 && width * height <= 2147483648.0))
        return camber_fail(page->context, CAMBER_ERROR_ARGUMENT,
                           "page: %g x %g mm at %g dpi are %.0f x %.0f px; each side may have 1 to 65535, and the page "
                           "2^31 in all: choose fewer dpi",
                           desc->width_mm, desc->height_mm, desc->dpi, width, height);
    const double margin = round(desc->margin_mm * page->px_per_mm);
    page->title_px = desc->title ? TITLE_SHARE * fmin(width, height) : 0.0;
    page->subtitle_px = desc->subtitle ? SUBTITLE_SHARE * TITLE_SHARE * fmin(width, height) : 0.0;
    const double below = round(TITLE_LINE * page->title_px + SUBTITLE_LINE * page->subtitle_px);
    const double map_width = width - 2.0 * margin, map_height = height - 2.0 * margin - below;
    if (!(map_width >= 1.0 && map_height >= 1.0))
        return camber_fail(page->context, CAMBER_ERROR_ARGUMENT,
                           "page: a margin of %g mm leaves no room for the map on %g x %g mm; choose a smaller one",
                           desc->margin_mm, desc->width_mm, desc->height_mm);
    info->width = (uint32_t)width;
    info->height = (uint32_t)height;
    info->map_x = info->map_y = (uint32_t)margin;
    info->map_width = (uint32_t)map_width;
    info->map_height = (uint32_t)map_height;
    info->dpi = desc->dpi;
    page->view_width = cover_px(info->map_width, desc->ratio);
    page->view_height = cover_px(info->map_height, desc->ratio);
    return CAMBER_OK;
}

bool camber_page_is_utf8(const char *text, size_t size) {
    for (size_t i = 0; i < size;) {
        const unsigned char c = (unsigned char)text[i];
        const size_t length = c < 0x80 ? 1 : c >= 0xc2 && c < 0xe0 ? 2 : c >= 0xe0 && c < 0xf0 ? 3 : c < 0xf5 ? 4 : 0;
        if ((c >= 0x80 && c < 0xc2) || !length || i + length > size)
            return false;
        uint32_t code = length == 1 ? c : c & (0x7fu >> length);
        for (size_t k = 1; k < length; k++) {
            if (((unsigned char)text[i + k] & 0xc0) != 0x80)
                return false;
            code = code << 6 | ((unsigned char)text[i + k] & 0x3f);
        }
        const uint32_t least = length == 3 ? 0x800 : length == 4 ? 0x10000 : 0;
        if (code < least || code > 0x10ffff || (code >= 0xd800 && code < 0xe000) ||
            (code >= 0xfdd0 && code <= 0xfdef) || (code & 0xfffe) == 0xfffe)
            return false;
        i += length;
    }
    return true;
}

static camber_status check_text(camber_context *context, const char *what, const char *text) {
    if (!text || camber_page_is_utf8(text, strlen(text)))
        return CAMBER_OK;
    return camber_fail(context, CAMBER_ERROR_ARGUMENT, "page: the %s is not text in UTF-8; convert it", what);
}

static bool copy_text(camber_page *page, const char **text) {
    if (*text && !**text)
        *text = NULL;
    return !*text || (*text = camber_copy_string(page->context, *text));
}

camber_status camber_page_create(camber_context *context, const camber_page_desc *desc, camber_page **page) {
    camber_page_desc own = *desc;
    const char *texts[] = {desc->title, desc->subtitle};
    own.title = own.subtitle = NULL;
    own.fonts = NULL;
    if (own.width_mm == 0.0 && own.height_mm == 0.0)
        (void)camber_paper_find("A4", &own.width_mm, &own.height_mm);
    own.dpi = own.dpi != 0.0 ? own.dpi : 300.0;
    own.ratio = own.ratio != 0.0 ? own.ratio : own.dpi / CSS_PX_PER_INCH;
    camber_status status = check_desc(context, &own);
    if (status == CAMBER_OK)
        status = check_text(context, "title", desc->title);
    if (status == CAMBER_OK)
        status = check_text(context, "subtitle", desc->subtitle);
    if (status != CAMBER_OK)
        return status;
    camber_page *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = context;
    made->desc = own;
    const char **copies[] = {&made->desc.title, &made->desc.subtitle};
    for (size_t i = 0; i < 2 && status == CAMBER_OK; i++) {
        const char *text = texts[i];
        status = copy_text(made, &text) ? CAMBER_OK : CAMBER_ERROR_MEMORY;
        *copies[i] = status == CAMBER_OK ? text : NULL;
    }
    if (status == CAMBER_OK)
        status = lay_out(made);
    if (status == CAMBER_OK)
        status = camber_fonts_create(context, desc->fonts, &made->fonts);
    if (status == CAMBER_OK)
        *page = made;
    else
        camber_page_destroy(made);
    return status;
}

void camber_page_destroy(camber_page *page) {
    if (!page)
        return;
    camber_fonts_destroy(page->fonts);
    camber_free(page->context, (void *)(uintptr_t)page->desc.title);
    camber_free(page->context, (void *)(uintptr_t)page->desc.subtitle);
    camber_free(page->context, page->credit);
    camber_free(page->context, page);
}

camber_status camber_page_set_credit(camber_page *page, const char *credit) {
    char *copy = credit && *credit ? camber_copy_string(page->context, credit) : NULL;
    if (credit && *credit && !copy)
        return CAMBER_ERROR_MEMORY;
    camber_free(page->context, page->credit);
    page->credit = copy;
    return CAMBER_OK;
}

void camber_page_set_view(const camber_page *page, camber_view_desc *view) {
    view->width = page->view_width;
    view->height = page->view_height;
    view->ratio = page->desc.ratio;
    view->whole_labels = true;
}

camber_page_info camber_page_get_info(const camber_page *page) {
    return page->info;
}

camber_status camber_page_crop_of(const camber_page *page, const camber_scene *scene, camber_page_crop *crop) {
    const camber_scene_info info = camber_scene_get_info(scene);
    const camber_page_info *own = &page->info;
    const double width = floor(page->view_width * page->desc.ratio + 0.5);
    const double height = floor(page->view_height * page->desc.ratio + 0.5);
    if ((double)info.width != width || (double)info.height != height || info.width < own->map_width ||
        info.height < own->map_height)
        return camber_fail(page->context, CAMBER_ERROR_ARGUMENT,
                           "page: a scene of %u x %u px, but the page's view has %.0f x %.0f; set its size by "
                           "camber_page_set_view",
                           info.width, info.height, width, height);
    *crop = (camber_page_crop){(info.width - own->map_width) / 2, (info.height - own->map_height) / 2};
    return CAMBER_OK;
}

#else

bool camber_page_is_built(void) {
    return false;
}

camber_status camber_page_create(camber_context *context, const camber_page_desc *desc, camber_page **page) {
    (void)desc;
    (void)page;
    return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                       "page: this build cannot print (CAMBER_CAIRO); build it with Cairo (Debian: libcairo2-dev)");
}

/* Without pages, nothing calls these. */
void camber_page_destroy(camber_page *page) {
    (void)page;
}

camber_status camber_page_set_credit(camber_page *page, const char *credit) {
    (void)page;
    (void)credit;
    return CAMBER_ERROR_ARGUMENT;
}

void camber_page_set_view(const camber_page *page, camber_view_desc *view) {
    (void)page;
    (void)view;
}

camber_page_info camber_page_get_info(const camber_page *page) {
    (void)page;
    return (camber_page_info){0};
}

camber_status camber_page_write(camber_page *page, camber_scene *scene, camber_renderer *renderer, camber_mesh *mesh,
                                camber_page_format format, camber_sink sink) {
    (void)page;
    (void)scene;
    (void)renderer;
    (void)mesh;
    (void)format;
    (void)sink;
    return CAMBER_ERROR_ARGUMENT;
}

camber_status camber_page_render(camber_page *page, camber_scene *scene, camber_renderer *renderer, camber_mesh *mesh,
                                 camber_rows_fn *rows, void *user, camber_frame_stats *stats) {
    (void)page;
    (void)scene;
    (void)renderer;
    (void)mesh;
    (void)rows;
    (void)user;
    (void)stats;
    return CAMBER_ERROR_ARGUMENT;
}

#endif
