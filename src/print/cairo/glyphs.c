/* Draws glyphs by Cairo: as text whose fonts a PDF embeds, or as outlines.
 *
 * Input: glyphs of the text layer, by their numbers in a set of fonts. Main idea: Cairo gets the very font files that
 * the text was shaped with. Glyphs that come from a style's ranges of distances, and named instances of variable fonts,
 * have no such file; they become a font of Cairo's own kind, made of their outlines. */
#include "print/page.h"

#include "text/fonts.h"

#include <cairo-ft.h>
#include <hb-ot.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Cairo's own glyphs are flattened this finely, which is enough for a headline. */
static const float TOLERANCE_EM = 1.0f / 1024.0f;

/* ---- Fonts from files ---- */

/* A font file as FreeType reads it, from HarfBuzz's bytes. Cairo keeps fonts in a cache for longer than the
 * camber_fonts live, so nothing here may belong to a context. */
typedef struct font_file {
    hb_blob_t *bytes;
    FT_Library library;
    FT_Face face;
} font_file;

static const cairo_user_data_key_t file_key, outlines_key;

static void close_file(void *user) {
    font_file *file = user;
    if (file->face)
        FT_Done_Face(file->face);
    if (file->library)
        FT_Done_FreeType(file->library);
    hb_blob_destroy(file->bytes);
    free(file);
}

/* Makes Cairo's face of a file. Leaves it NULL if FreeType does not read the font.
 * Returns CAMBER_ERROR_MEMORY, which is not logged. */
static camber_status open_file(hb_face_t *face, cairo_font_face_t **made) {
    font_file *file = calloc(1, sizeof *file);
    if (!file)
        return CAMBER_ERROR_MEMORY;
    file->bytes = hb_face_reference_blob(face);
    unsigned size = 0;
    const char *bytes = hb_blob_get_data(file->bytes, &size);
    FT_Error error = FT_Init_FreeType(&file->library);
    if (!error)
        error = FT_New_Memory_Face(file->library, (const FT_Byte *)bytes, (FT_Long)size,
                                   (FT_Long)hb_face_get_index(face), &file->face);
    if (error) {
        close_file(file);
        return FT_ERROR_BASE(error) == FT_Err_Out_Of_Memory ? CAMBER_ERROR_MEMORY : CAMBER_OK;
    }
    cairo_font_face_t *opened =
        cairo_ft_font_face_create_for_ft_face(file->face, FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP);
    if (cairo_font_face_set_user_data(opened, &file_key, file, close_file) != CAIRO_STATUS_SUCCESS) {
        cairo_font_face_destroy(opened);
        close_file(file);
        return CAMBER_ERROR_MEMORY;
    }
    *made = opened; /* which owns the file */
    return CAMBER_OK;
}

/* ---- Fonts from outlines ---- */

static void add_outline(cairo_t *cr, const camber_outline *outline) {
    for (size_t r = 0; r < outline->ring_count; r++) {
        cairo_new_sub_path(cr); /* else Cairo draws on from the start of the last ring */
        for (uint32_t i = outline->offsets[r]; i < outline->offsets[r + 1]; i++)
            cairo_line_to(cr, (double)outline->points[2 * i], (double)outline->points[2 * i + 1]);
        cairo_close_path(cr);
    }
}

static cairo_status_t draw_glyph(cairo_scaled_font_t *scaled, unsigned long glyph, cairo_t *cr,
                                 cairo_text_extents_t *extents) {
    camber_fonts *fonts = cairo_font_face_get_user_data(cairo_scaled_font_get_font_face(scaled), &outlines_key);
    camber_outline outline;
    if (!fonts || camber_fonts_get_outline(fonts, (uint32_t)glyph, TOLERANCE_EM, &outline) != CAMBER_OK)
        return CAIRO_STATUS_USER_FONT_ERROR;
    /* Readers find words by advances; each glyph has a place of its own anyway. */
    extents->x_advance = outline.ring_count ? fmax((double)outline.right, 0.0) : 0.25;
    add_outline(cr, &outline);
    cairo_fill(cr);
    return CAIRO_STATUS_SUCCESS;
}

/* The fonts are alive as long as glyphs are drawn; a font in Cairo's cache does not draw any more. */
static cairo_font_face_t *make_outlines(camber_fonts *fonts) {
    cairo_font_face_t *made = cairo_user_font_face_create();
    cairo_user_font_face_set_render_glyph_func(made, draw_glyph);
    if (cairo_font_face_set_user_data(made, &outlines_key, fonts, NULL) == CAIRO_STATUS_SUCCESS)
        return made;
    cairo_font_face_destroy(made);
    return NULL;
}

/* ---- Faces ---- */

static bool is_instance(hb_font_t *font) {
    unsigned count = 0;
    const int *coordinates = hb_font_get_var_coords_normalized(font, &count);
    for (unsigned i = 0; i < count; i++)
        if (coordinates[i] != 0)
            return true;
    return false;
}

static bool is_same_file(hb_face_t *a, hb_face_t *b) {
    hb_blob_t *bytes_a = hb_face_reference_blob(a), *bytes_b = hb_face_reference_blob(b);
    unsigned size_a = 0, size_b = 0;
    const char *data_a = hb_blob_get_data(bytes_a, &size_a), *data_b = hb_blob_get_data(bytes_b, &size_b);
    const bool same = size_a > 0 && size_a == size_b && hb_face_get_index(a) == hb_face_get_index(b) &&
                      (data_a == data_b || memcmp(data_a, data_b, size_a) == 0);
    hb_blob_destroy(bytes_a);
    hb_blob_destroy(bytes_b);
    return same;
}

/* Finds a face of the same file among the page's other fonts. NULL: there is none. */
static cairo_font_face_t *find_shared(const camber_page_fonts *f, hb_face_t *file) {
    for (size_t i = 0; f->shared && i < f->shared->face_count; i++) {
        cairo_font_face_t *face = f->shared->faces[i];
        if (face && cairo_font_face_get_type(face) == CAIRO_FONT_TYPE_FT &&
            is_same_file(file, hb_font_get_face(f->shared->fonts->sources[i].face->font)))
            return cairo_font_face_reference(face);
    }
    return NULL;
}

/* Finds the face of a source of glyphs, or makes it. */
static camber_status find_face(camber_page_fonts *f, uint32_t source, cairo_font_face_t **face) {
    if (source >= f->face_count) {
        size_t capacity = f->face_count;
        const size_t count = f->fonts->source_count;
        if (!camber_grow(f->context, &f->faces, &capacity, count, sizeof(void *)))
            return CAMBER_ERROR_MEMORY;
        for (; f->face_count < count; f->face_count++)
            f->faces[f->face_count] = NULL;
    }
    const camber_face *file = f->fonts->sources[source].face;
    cairo_font_face_t **found = f->faces + source;
    camber_status status = CAMBER_OK;
    if (!*found && file && !is_instance(file->font)) {
        *found = find_shared(f, hb_font_get_face(file->font));
        if (!*found)
            status = open_file(hb_font_get_face(file->font), found);
    }
    if (!*found && status == CAMBER_OK)
        *found = make_outlines(f->fonts);
    *face = *found;
    return *found ? CAMBER_OK : camber_fail(f->context, CAMBER_ERROR_MEMORY, "page: no memory for a font");
}

void camber_page_fonts_free(camber_page_fonts *f) {
    for (size_t i = 0; i < f->face_count; i++)
        if (f->faces[i])
            cairo_font_face_destroy(f->faces[i]);
    if (f->context) {
        camber_free(f->context, f->faces);
        camber_free(f->context, f->cairo_glyphs);
        camber_free(f->context, f->clusters);
    }
    *f = (camber_page_fonts){0};
}

/* ---- Runs ---- */

/* Whether bytes are text that a page can say: whole characters, and none that control. */
static bool is_text(const char *text, size_t size) {
    for (size_t i = 0; i < size; i++)
        if ((unsigned char)text[i] < 0x20)
            return false;
    return camber_page_is_utf8(text, size);
}

/* The glyphs of a run that have one face, and whose characters follow each other in the text: forwards or backwards. */
typedef struct stretch {
    size_t first, end;
    cairo_font_face_t *face;
    bool as_outlines; /* the face is made of outlines */
    bool backward;
} stretch;

static uint32_t source_of(const camber_page_fonts *f, const camber_page_glyph *glyph) {
    return f->fonts->glyphs[glyph->glyph].source;
}

static camber_status find_stretch(camber_page_fonts *f, const camber_page_run *run, size_t first, stretch *s) {
    const camber_page_glyph *glyphs = run->glyphs;
    const uint32_t source = source_of(f, glyphs + first);
    *s = (stretch){.first = first, .end = first + 1};
    const camber_status status = find_face(f, source, &s->face);
    s->as_outlines = status == CAMBER_OK && cairo_font_face_get_type(s->face) == CAIRO_FONT_TYPE_USER;
    int direction = 0;
    for (; s->end < run->count && source_of(f, glyphs + s->end) == source; s->end++) {
        const camber_page_glyph *before = glyphs + s->end - 1, *next = glyphs + s->end;
        if (next->first_byte == before->first_byte)
            continue;
        const int step = next->first_byte == before->end_byte ? 1 : next->end_byte == before->first_byte ? -1 : 0;
        if (step == 0 || (direction && step != direction))
            break;
        direction = step;
    }
    s->backward = direction < 0;
    return status;
}

/* Sets the font, and the glyphs of a stretch. */
static camber_status set_glyphs(camber_page_fonts *f, cairo_t *cr, const camber_page_run *run, const stretch *s) {
    const size_t count = s->end - s->first;
    if (!camber_grow(f->context, &f->cairo_glyphs, &f->glyph_capacity, count, sizeof *f->cairo_glyphs) ||
        !camber_grow(f->context, &f->clusters, &f->cluster_capacity, count, sizeof *f->clusters))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < count; i++) {
        const camber_page_glyph *g = run->glyphs + s->first + i;
        const uint32_t number = s->as_outlines ? g->glyph : f->fonts->glyphs[g->glyph].number;
        f->cairo_glyphs[i] = (cairo_glyph_t){number, g->x, g->y};
    }
    cairo_matrix_t matrix;
    cairo_matrix_init(&matrix, run->xx, run->yx, run->xy, run->yy, 0.0, 0.0);
    cairo_set_font_face(cr, s->face);
    cairo_set_font_matrix(cr, &matrix);
    return CAMBER_OK;
}

/* Groups the glyphs of a stretch that share characters. *first_byte and *end_byte receive the range of the text. */
static size_t make_clusters(camber_page_fonts *f, const camber_page_run *run, const stretch *s, uint32_t *first_byte,
                            uint32_t *end_byte) {
    size_t count = 0;
    *first_byte = UINT32_MAX;
    *end_byte = 0;
    for (size_t i = s->first; i < s->end; i++) {
        const camber_page_glyph *g = run->glyphs + i;
        if (i > s->first && g->first_byte == g[-1].first_byte) {
            f->clusters[count - 1].num_glyphs++;
            continue;
        }
        f->clusters[count++] = (cairo_text_cluster_t){(int)(g->end_byte - g->first_byte), 1};
        *first_byte = g->first_byte < *first_byte ? g->first_byte : *first_byte;
        *end_byte = g->end_byte > *end_byte ? g->end_byte : *end_byte;
    }
    /* Cairo lists clusters in the order of the text; the glyphs stay as they are. */
    for (size_t i = 0; s->backward && i < count / 2; i++) {
        const cairo_text_cluster_t other = f->clusters[i];
        f->clusters[i] = f->clusters[count - 1 - i];
        f->clusters[count - 1 - i] = other;
    }
    return count;
}

static bool can_draw(const camber_page_run *run) {
    const double area = run->xx * run->yy - run->xy * run->yx;
    return run->count > 0 && run->count <= INT32_MAX && isfinite(area) && fabs(area) > 1e-6;
}

camber_status camber_page_show(camber_page_fonts *f, cairo_t *cr, const camber_page_run *run) {
    camber_status status = CAMBER_OK;
    if (f->as_paths) {
        cairo_new_path(cr);
        status = camber_page_add_outlines(f, cr, run);
        cairo_set_fill_rule(cr, CAIRO_FILL_RULE_WINDING);
        cairo_fill(cr);
        return status;
    }
    stretch s;
    for (size_t i = 0; can_draw(run) && i < run->count && status == CAMBER_OK; i = s.end) {
        uint32_t first_byte, end_byte;
        status = find_stretch(f, run, i, &s);
        if (status == CAMBER_OK)
            status = set_glyphs(f, cr, run, &s);
        if (status != CAMBER_OK)
            break;
        const size_t clusters = make_clusters(f, run, &s, &first_byte, &end_byte);
        const char *text = run->text + first_byte;
        const size_t size = end_byte - first_byte;
        bool whole = size <= INT32_MAX && is_text(text, size);
        for (size_t k = 0, at = 0; k < clusters && whole; at += (size_t)f->clusters[k++].num_bytes)
            whole = is_text(text + at, (size_t)f->clusters[k].num_bytes);
        if (whole)
            cairo_show_text_glyphs(cr, text, (int)size, f->cairo_glyphs, (int)(s.end - s.first), f->clusters,
                                   (int)clusters, s.backward ? CAIRO_TEXT_CLUSTER_FLAG_BACKWARD : 0);
        else
            cairo_show_glyphs(cr, f->cairo_glyphs, (int)(s.end - s.first));
    }
    return status;
}

/* Outlines of a font that is made of them are added as they are; Cairo would trace pictures of them. */
static camber_status add_made(camber_page_fonts *f, cairo_t *cr, const camber_page_run *run, const stretch *s) {
    camber_status status = CAMBER_OK;
    for (size_t i = s->first; i < s->end && status == CAMBER_OK; i++) {
        const camber_page_glyph *g = run->glyphs + i;
        camber_outline outline;
        cairo_matrix_t matrix;
        cairo_matrix_init(&matrix, run->xx, run->yx, run->xy, run->yy, g->x, g->y);
        status = camber_fonts_get_outline(f->fonts, g->glyph, TOLERANCE_EM, &outline);
        cairo_save(cr);
        cairo_transform(cr, &matrix);
        if (status == CAMBER_OK)
            add_outline(cr, &outline);
        cairo_restore(cr);
    }
    return status;
}

camber_status camber_page_add_outlines(camber_page_fonts *f, cairo_t *cr, const camber_page_run *run) {
    camber_status status = CAMBER_OK;
    stretch s;
    for (size_t i = 0; can_draw(run) && i < run->count && status == CAMBER_OK; i = s.end) {
        status = find_stretch(f, run, i, &s);
        if (status == CAMBER_OK && s.as_outlines) {
            status = add_made(f, cr, run, &s);
        } else if (status == CAMBER_OK) {
            status = set_glyphs(f, cr, run, &s);
            if (status == CAMBER_OK)
                cairo_glyph_path(cr, f->cairo_glyphs, (int)(s.end - s.first));
        }
    }
    return status;
}
