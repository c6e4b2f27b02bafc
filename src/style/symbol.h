/* How a symbol layer labels a feature: the text, the icon, where they are placed, and how they are drawn. */
#ifndef CAMBER_STYLE_SYMBOL_H
#define CAMBER_STYLE_SYMBOL_H

#include "camber_text.h"
#include "style/arena.h"
#include "style/style.h"

typedef enum camber_symbol_placement {
    CAMBER_SYMBOL_POINT = 0,
    CAMBER_SYMBOL_LINE,
    CAMBER_SYMBOL_LINE_CENTER,
} camber_symbol_placement;

typedef enum camber_symbol_order {
    CAMBER_SYMBOL_ORDER_AUTO = 0,   /* by sort key if there is one, otherwise by the position on the screen */
    CAMBER_SYMBOL_ORDER_VIEWPORT_Y, /* by the position on the screen if labels may overlap */
    CAMBER_SYMBOL_ORDER_SOURCE,
} camber_symbol_order;

typedef enum camber_symbol_overlap {
    CAMBER_OVERLAP_NEVER = 0,
    CAMBER_OVERLAP_ALWAYS,
    CAMBER_OVERLAP_COOPERATIVE, /* it may overlap labels that are cooperative or always overlap */
} camber_symbol_overlap;

/* Text or an icon turns and tilts with the map or with the viewport. The specification's "auto" is replaced by a value
 * that depends on the placement. */
typedef enum camber_symbol_alignment {
    CAMBER_ALIGN_MAP = 0,
    CAMBER_ALIGN_VIEWPORT,
    CAMBER_ALIGN_VIEWPORT_GLYPH, /* for text along lines: each glyph is upright, and the glyphs follow the line */
} camber_symbol_alignment;

typedef enum camber_icon_text_fit {
    CAMBER_FIT_NONE = 0,
    CAMBER_FIT_WIDTH = 1,
    CAMBER_FIT_HEIGHT = 2,
    CAMBER_FIT_BOTH = 3,
} camber_icon_text_fit;

/* Properties that both text and icons have. Lengths are CSS px unless the name says otherwise. */
typedef struct camber_symbol_part {
    camber_symbol_overlap overlap;
    bool ignore_placement; /* other labels may be placed over it */
    bool optional;         /* the other part may be shown without it */
    camber_symbol_alignment rotation_alignment, pitch_alignment;
    double rotate_deg;
    bool keep_upright;
    double padding_px[4]; /* top, right, bottom, left */
    camber_color color;   /* the alpha includes the opacity, as does the halo's */
    camber_color halo_color;
    double halo_width_px, halo_blur_px;
    double translate_px[2];
    camber_translate_anchor translate_anchor;
    double opacity;
} camber_symbol_part;

/* A part of a text, or an image in it: one section of "format". */
typedef struct camber_symbol_section {
    const char *text;         /* after text-transform. NULL: an image */
    const char *image;        /* its name. NULL: text */
    const char *const *fonts; /* font_count names */
    size_t font_count;
    double scale;
    bool has_color;
    camber_color color; /* with has_color: replaces the text's colour; the alpha includes the opacity */
    camber_text_align align;
} camber_symbol_section;

#define CAMBER_SYMBOL_ANCHORS_MAX 9

typedef struct camber_symbol {
    camber_symbol_placement placement;
    camber_symbol_order order;
    double spacing_px;
    double repeat_px; /* the same words are not shown nearer than that */
    bool avoid_edges;
    bool has_sort_key;
    double sort_key;

    const char *icon_image; /* NULL: no icon */
    double icon_size;
    double icon_offset_px[2]; /* in px of the icon before icon_size */
    camber_text_anchor icon_anchor;
    camber_icon_text_fit text_fit;
    double text_fit_padding_px[4]; /* top, right, bottom, left */
    camber_symbol_part icon;

    camber_symbol_section *sections; /* section_count of them. 0: no text */
    size_t section_count;
    double text_size_px;
    double anchor_text_px; /* the text's size at zoom 18, which decides where labels are along lines at all zooms */
    double max_width_em;   /* 0 along lines, where text does not break */
    double line_height_em, letter_spacing_em;
    camber_text_justify justify;
    camber_text_anchor text_anchor;
    double text_offset_em[2];
    bool has_radial_offset;
    double radial_offset_em;
    /* Anchors to try in turn, each with its offset. If there are none, text_anchor is used, with text_offset_em or the
     * radial offset. */
    camber_text_anchor variable_anchors[CAMBER_SYMBOL_ANCHORS_MAX];
    double variable_offsets_em[CAMBER_SYMBOL_ANCHORS_MAX][2];
    bool has_variable_offsets; /* the style gives them; otherwise they follow from the text's offset or radius */
    size_t variable_anchor_count;
    double max_angle_deg;
    bool horizontal, vertical; /* allowed writing modes */
    bool vertical_first;       /* if both are allowed, vertical is preferred */
    camber_symbol_part text;
} camber_symbol;

/* Evaluates the layout and paint of a symbol layer for a feature at the look's zoom. images: which images exist, for
 * "image" and "coalesce"; NULL: any. Strings and sections are in the arena, or in the style. A property that cannot be
 * evaluated has its default. Symbols with equal values are equal byte by byte, except for their pointers.
 * Returns CAMBER_ERROR_MEMORY. */
camber_status camber_layer_look_symbol(const camber_layer_look *look, const camber_feature_view *feature,
                                       const camber_style_images *images, camber_arena *arena, camber_symbol *symbol);
/* Whether a symbol layer may have a text or an icon for a feature at any zoom. */
bool camber_style_layer_may_label(const camber_style_layer *layer, const camber_feature_view *feature);
/* Whether a symbol layer may have icons that turn with lines. */
bool camber_style_layer_turns_icons(const camber_style_layer *layer);
/* Whether a symbol layer may name images: icons, or images within text. */
bool camber_style_layer_names_images(const camber_style_layer *layer);

#endif
