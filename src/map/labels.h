/* Labels: which texts and icons are shown in a view, and where each of their glyphs is.
 *
 *     features, view -> label_layout (texts and icons, anchors) -> placement (what is shown) -> items
 *     items -> label_shapes: rings and passes */
#ifndef CAMBER_MAP_LABELS_H
#define CAMBER_MAP_LABELS_H

#include "camber_text.h"
#include "map/plan.h"
#include "style/sprite.h"

/* How items are drawn: the same for all glyphs of a label's section. */
typedef struct camber_label_look {
    camber_color color; /* straight; alpha includes all opacities. Of an icon without sdf: white, with its opacity */
    camber_color halo_color;
    float halo_width_px, halo_blur_px; /* device px */
    bool flat;                         /* it is flat on the map, so a pitch tilts it */
} camber_label_look;

/* A glyph or an icon of a label that is shown. */
typedef struct camber_label_item {
    uint32_t glyph; /* its number in the fonts; CAMBER_NO_GLYPH: an icon */
    const camber_sprite_image *icon;
    uint32_t look; /* index into the labels' looks */
    uint32_t label;
    uint32_t byte; /* of a glyph: where its characters begin in the labels' words */
    /* Maps em (for an icon: fractions of its width and height) to device px of the picture:
     * px = (x + xx * u + xy * v, y + yx * u + yy * v). If the look is flat, these are px of the map's plane; otherwise
     * of the picture as it is seen, whatever the pitch. */
    float x, y, xx, xy, yx, yy;
    /* For an icon that is fitted to a text: how many px of the picture a px of its image takes up in the parts that
     * must not be stretched. 0: the icon is not fitted. */
    float unstretched_px;
} camber_label_item;

/* A label that is shown. */
typedef struct camber_label {
    uint32_t feature;
    camber_box box;                  /* around its parts with their padding, device px of the picture */
    uint32_t first_byte, byte_count; /* its text, in the labels' words */
} camber_label;

/* The items of a layer of the style, in drawing order: icons, then text. */
typedef struct camber_label_layer {
    size_t layer; /* of the style */
    size_t first_icon, icon_count;
    size_t first_glyph, glyph_count;
} camber_label_layer;

typedef struct camber_labels {
    camber_context *context;
    camber_label_layer *layers; /* layer_count of them, in drawing order */
    size_t layer_count;
    camber_label_item *items;
    size_t item_count;
    camber_label_look *looks;
    size_t look_count;
    camber_label *labels;
    size_t label_count;
    char *words; /* the texts of labels, word_size bytes of UTF-8, for pages whose text can be searched */
    size_t word_size;
} camber_labels;

/* Places the labels of a view. The result depends neither on the number of threads nor on the order of the features.
 * fonts may make new outlines. sprites records missing names, and may be NULL. Call camber_labels_free even after a
 * failure. Returns CAMBER_ERROR_LIMIT, CAMBER_ERROR_MEMORY. */
camber_status camber_labels_place(const camber_features *features, const camber_view *view, camber_fonts *fonts,
                                  camber_sprites *sprites, camber_labels *labels);
void camber_labels_free(camber_labels *labels);

/* A book keeps from view to view what all views of a set of features share: the things that can be labelled, and, as
 * long as only the place of the view changes, texts and icons. */
typedef struct camber_label_book camber_label_book;

/* Returns CAMBER_ERROR_MEMORY. */
camber_status camber_label_book_create(const camber_features *features, camber_label_book **book);
void camber_label_book_destroy(camber_label_book *book);
/* Places the labels of a view with the features' own fonts and sprites, as camber_labels_place does, which gives the
 * same labels. If the features have changed, or the view has another zoom, ratio, bearing or pitch, the book begins
 * again. */
camber_status camber_label_book_place(camber_label_book *book, const camber_view *view, camber_labels *labels);

#endif
