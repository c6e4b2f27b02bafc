/* camber_print.h draws scenes on sheets of paper: as PDF and SVG with true vectors, or as pictures.
 *
 *     page (paper, margin, title) -> its view -> scene -> camber_page_write: PDF or SVG
 *                                                      -> camber_page_render: rows of RGBA8
 *
 * It is part of libcamber-map, if that was built with Cairo. The rules of camber.h (errors, ownership, descriptions,
 * threads) apply here too. Memory that Cairo allocates is not counted against a budget.
 *
 * A map of Porto on a sheet of A3, without the checks of each status:
 *
 *     camber_page_desc sheet = {.title = "Porto", .scale_bar = true};
 *     camber_paper_find("A3", &sheet.width_mm, &sheet.height_mm);
 *     camber_page_create(context, &sheet, &page);
 *     camber_scene_desc desc = {.view = {.kind = CAMBER_VIEW_FIT, .cover = true}};
 *     camber_page_set_view(page, &desc.view);
 *     camber_scene_create(features, &desc, &scene);
 *     camber_page_write(page, scene, renderer, mesh, CAMBER_PAGE_PDF, sink);
 */
#ifndef CAMBER_PRINT_H
#define CAMBER_PRINT_H

#include "camber_map.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Whether this build can print, which needs Cairo. */
CAMBER_API bool camber_page_is_built(void);

/* Finds a size of paper by its name: "A0" to "A6", "B0" to "B6" (ISO 216), "Letter", "Legal", "Tabloid"; case is
 * ignored. The sheet is upright. false: there is no such size, and the numbers are unchanged. */
CAMBER_API bool camber_paper_find(const char *name, double *width_mm, double *height_mm);

typedef struct camber_page_desc {
    double width_mm, height_mm; /* of the sheet, 10 to 20000 each. 0: A4 upright */
    double margin_mm;           /* white paper on all four sides of the map. 0: none */
    double dpi;                 /* device px per inch, 10 to 4800. 0: 300 */
    /* Device px per CSS px: how large a style's widths and texts are on paper. 0: dpi / 96, so that a CSS px is 1/96
     * inch or 0.26 mm. */
    double ratio;
    const char *title, *subtitle; /* below the map, UTF-8. NULL: none */
    bool scale_bar;               /* in the lower left corner; its length is true at the map's centre */
    bool north_arrow;             /* in the upper right corner */
    bool grid;                    /* meridians and parallels with their degrees */
    /* Fonts for all of these. NULL: the shipped font, and the system's for characters that it lacks */
    const camber_fonts_desc *fonts;
} camber_page_desc;

typedef struct camber_page camber_page;

/* Makes a page. The fonts' glyph function, if there is one, must outlive it.
 * Returns CAMBER_ERROR_ARGUMENT (a size, a margin or a resolution out of range; no room left for the map; more than
 * 65535 px on a side or 2^31 px in all; a title or subtitle that is not UTF-8; this build has no Cairo),
 * CAMBER_ERROR_NOT_FOUND (a folder of fonts), CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_page_create(camber_context *context, const camber_page_desc *desc, camber_page **page);
CAMBER_API void camber_page_destroy(camber_page *page);

/* Sets the credit of the data, which is shown in the map's lower right corner. The text is copied. NULL: none.
 * Bytes that are not UTF-8 are shown as U+FFFD, and then the metadata of a PDF has no credit.
 * Returns CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_page_set_credit(camber_page *page, const char *credit);

/* Sets the width, the height and the ratio of a view, so that its scene fits into the page, and whole_labels. What the
 * view shows is left as it is. */
CAMBER_API void camber_page_set_view(const camber_page *page, camber_view_desc *view);

typedef struct camber_page_info {
    uint32_t width, height;                       /* of the sheet, device px */
    uint32_t map_x, map_y, map_width, map_height; /* the part of it that shows the map, device px */
    double dpi;
} camber_page_info;

CAMBER_API camber_page_info camber_page_get_info(const camber_page *page);

typedef enum camber_page_format {
    CAMBER_PAGE_PDF = 0, /* text can be searched and copied, and its fonts are embedded */
    CAMBER_PAGE_SVG,     /* text is shapes, so that every reader shows the same */
} camber_page_format;

/* Writes a scene as a page. Lines, areas, texts and their halos are vectors. Icons and patterns are images. What a page
 * cannot say is drawn by the renderer as an image of its layer at the page's dpi: lines with a blur or an image, and
 * everything in a view with a pitch. A warning says so. Halos are drawn with a sharp edge instead of their blur.
 *
 * scene must have been made with the page's view, and not by camber_scene_create_last.
 * mesh was created for the renderer. The scene is tessellated into it if something is drawn as an image. Both NULL:
 * that is left out, with a warning. Returns CAMBER_ERROR_ARGUMENT (a scene of another size), CAMBER_ERROR_IO (the sink
 * returned false), CAMBER_ERROR_MEMORY, and the errors of camber_scene_tessellate and camber_renderer_render. Cost:
 * linear in the points of all polylines that the style draws. */
CAMBER_API camber_status camber_page_write(camber_page *page, camber_scene *scene, camber_renderer *renderer,
                                           camber_mesh *mesh, camber_page_format format, camber_sink sink);

/* Draws a scene as a picture of a whole sheet: white paper, the map, and what the page adds. mesh must hold the scene
 * from camber_scene_tessellate. stats may be NULL. The rows are those of camber_page_info's width and height.
 * Returns CAMBER_ERROR_ARGUMENT (a scene of another size), and the errors of camber_renderer_render. */
CAMBER_API camber_status camber_page_render(camber_page *page, camber_scene *scene, camber_renderer *renderer,
                                            camber_mesh *mesh, camber_rows_fn *rows, void *user,
                                            camber_frame_stats *stats);

#ifdef __cplusplus
}
#endif

#endif
