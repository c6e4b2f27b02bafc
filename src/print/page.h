/* A page: the sheet of paper that a map is drawn on, in device px from its upper left corner. */
#ifndef CAMBER_PRINT_PAGE_H
#define CAMBER_PRINT_PAGE_H

#include "camber_print.h"
#include "map/scene.h"

#include <cairo.h>

struct camber_page {
    camber_context *context;
    camber_page_desc desc; /* without its fonts; its strings are copies */
    camber_page_info info;
    double px_per_mm;
    uint32_t view_width, view_height; /* CSS px */
    double title_px, subtitle_px;     /* heights of their texts */
    camber_fonts *fonts;
    char *credit; /* NULL: none */
};

/* Device px of the view that are left of, and above, the map: a view has whole CSS px, so it may be larger. */
typedef struct camber_page_crop {
    uint32_t x, y;
} camber_page_crop;

/* Checks that a scene has the size of the page's view. Returns CAMBER_ERROR_ARGUMENT. */
camber_status camber_page_crop_of(const camber_page *page, const camber_scene *scene, camber_page_crop *crop);

/* Whether bytes are whole characters of UTF-8, as Cairo requires: without surrogates and noncharacters. */
bool camber_page_is_utf8(const char *text, size_t size);

/* ---- Glyphs (cairo/glyphs.c) ---- */

/* Fonts as Cairo uses them. */
typedef struct camber_page_fonts {
    camber_context *context;
    camber_fonts *fonts;
    /* other fonts of the page, whose faces of the same files are used again, so that a PDF has a file once. NULL: none
     */
    const struct camber_page_fonts *shared;
    cairo_font_face_t **faces; /* by source of the fonts; NULL: not needed so far */
    size_t face_count;
    bool as_paths; /* texts are drawn as shapes */
    cairo_glyph_t *cairo_glyphs;
    cairo_text_cluster_t *clusters;
    size_t glyph_capacity, cluster_capacity;
} camber_page_fonts;

/* A glyph, and its characters in a text. */
typedef struct camber_page_glyph {
    uint32_t glyph;
    uint32_t first_byte, end_byte; /* equal: its characters belong to another glyph */
    double x, y;                   /* device px */
} camber_page_glyph;

/* Glyphs of one label that have one size and direction. */
typedef struct camber_page_run {
    const camber_page_glyph *glyphs;
    size_t count;
    double xx, yx, xy, yy; /* maps em to device px */
    const char *text;      /* bytes of glyphs are counted from here */
} camber_page_run;

void camber_page_fonts_free(camber_page_fonts *fonts);
/* Draws glyphs with the current source. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT. */
camber_status camber_page_show(camber_page_fonts *fonts, cairo_t *cr, const camber_page_run *run);
/* Adds their outlines to the current path. */
camber_status camber_page_add_outlines(camber_page_fonts *fonts, cairo_t *cr, const camber_page_run *run);

/* ---- Marginalia (cairo/marginalia.c) ---- */

/* Clips to the part of the sheet that shows the map. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_page_clip(const camber_page *page, cairo_t *cr);
/* Draws title, grid, scale bar, north arrow, credit and the map's frame. */
camber_status camber_page_draw_marginalia(const camber_page *page, const camber_scene_parts *parts,
                                          camber_page_fonts *fonts, cairo_t *cr);

/* ---- Lines (cairo/lines.c) ---- */

/* Stretches of lines, or rings, in device px of the view. */
typedef struct camber_page_lines {
    camber_context *context;
    float *points;
    uint32_t *offsets; /* count + 1 */
    float *arcs;       /* pairs by line: how far its first point is along the whole line, and the whole line's length */
    bool *closed;
    size_t count, point_count, point_capacity, offset_capacity, arc_capacity, closed_capacity;
    double *scratch[2]; /* of one polyline */
    size_t scratch_capacity[2];
} camber_page_lines;

void camber_page_lines_clear(camber_page_lines *lines);
void camber_page_lines_free(camber_page_lines *lines);
/* Adds what a window shows of an entry's polyline. reach_px: how far the window goes beyond the picture. has_arcs:
 * lines are kept in one direction from their beginnings, so that rings that are cut are not joined at their ends. */
camber_status camber_page_lines_add(camber_page_lines *lines, const camber_scene_parts *parts, size_t entry,
                                    double reach_px, bool has_arcs);
/* Adds an entry's ring, cut at the window for filling. */
camber_status camber_page_lines_add_ring(camber_page_lines *lines, const camber_scene_parts *parts, size_t entry,
                                         double reach_px);
/* Adds the points of an entry that is drawn as dots, as lines of one point. */
camber_status camber_page_lines_add_dots(camber_page_lines *lines, const camber_scene_parts *parts, size_t entry,
                                         double reach_px);
/* Adds the part of another set's line between two distances along the whole line. */
camber_status camber_page_lines_add_part(camber_page_lines *lines, const camber_page_lines *from, size_t line,
                                         double first_px, double end_px);
/* Replaces lines by lines beside them, by the twin of the kernels. */
camber_status camber_page_lines_offset(camber_page_lines *lines, const camber_stroke *stroke, float offset_px,
                                       camber_page_lines *beside);

/* ---- The map (cairo/passes.c, cairo/labels.c, cairo/images.c) ---- */

/* Cairo's images have at most 32767 px on a side; larger ones are drawn in tiles of this size. */
enum { CAMBER_PAGE_TILE_PX = 16384 };

/* Converts a pixel of camber's to Cairo's. */
static inline uint32_t camber_page_argb(const uint8_t *rgba) {
    return (uint32_t)rgba[3] << 24 | (uint32_t)rgba[0] << 16 | (uint32_t)rgba[1] << 8 | (uint32_t)rgba[2];
}

/* The drawing of a map. */
typedef struct camber_page_map {
    camber_page *page;
    camber_context *context;
    cairo_t *cr; /* in device px of the view */
    camber_scene *scene;
    camber_scene_parts parts;
    camber_renderer *renderer; /* NULL: none */
    camber_mesh *mesh;         /* the renderer's, for what is drawn as an image */
    bool is_tessellated;       /* the mesh holds the scene */
    camber_frame frame;
    camber_page_fonts fonts;
    struct {
        const uint8_t *key;
        cairo_surface_t *surface;
    } * images; /* image_count of them: one surface for each of the style's images, so that a file has it once */
    size_t image_count, image_capacity;
    camber_page_lines lines, beside, part;
    camber_page_glyph *glyphs;
    size_t glyph_capacity;
    uint32_t *bytes;
    size_t byte_capacity;
    bool told_images, told_left_out, told_halos;
} camber_page_map;

camber_status camber_page_draw_map(camber_page_map *map);
/* Draws the labels of a pass. */
camber_status camber_page_draw_labels(camber_page_map *map, size_t pass);
/* Draws some passes as one image. Returns the errors of camber_renderer_render. */
camber_status camber_page_draw_image(camber_page_map *map, size_t first_pass, size_t pass_count);
/* Returns the surface of an image, which the map owns. NULL: no memory. */
cairo_surface_t *camber_page_image(camber_page_map *map, const camber_image *image);
void camber_page_map_free(camber_page_map *map);

#endif
