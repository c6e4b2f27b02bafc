/* A view's labels, or those of a part of the map at a whole zoom, before they are placed.
 *
 *     features -> things -> for each layer and class a form (rule, texts, icon)
 *     form, geometry -> candidates: a form at an anchor */
#ifndef CAMBER_MAP_LABEL_LAYOUT_H
#define CAMBER_MAP_LABEL_LAYOUT_H

#include "map/label_anchors.h"
#include "map/label_things.h"
#include "map/labels.h"
#include "style/symbol.h"
#include "text/number_map.h"

#define CAMBER_NO_PATH UINT32_MAX
#define CAMBER_NO_FORM UINT32_MAX
/* Labels collide up to this far outside the picture, in CSS px, so that they seldom change while a map moves. */
#define CAMBER_LABEL_MARGIN_PX 100.0

/* How a layer shows labels. Labels that differ only in words and icons share a rule. Lengths are device px or em. */
typedef struct camber_label_rule {
    camber_symbol symbol; /* without text, icon and sort key */
    uint32_t text_look, icon_look;
    bool text_along, icon_along; /* they turn with a line */
    bool text_flat, icon_flat;
    double text_px; /* size of the text */
    double text_translate_px[2], icon_translate_px[2];
    double text_turn, icon_turn; /* radians, as the style says */
    bool text_by_map, icon_by_map;
    /* The anchors of a text, in the order in which they are tried, and their offsets. */
    camber_text_anchor anchors[CAMBER_SYMBOL_ANCHORS_MAX];
    double offsets_em[CAMBER_SYMBOL_ANCHORS_MAX][2];
    size_t anchor_count;
    bool variable; /* texts are shaped about their centres */
    uint64_t hash; /* the last member, which the others decide: of the symbol, without the sections of its text */
} camber_label_rule;

/* How a run of a text is drawn. */
typedef struct camber_label_run {
    uint32_t look;
    const camber_sprite_image *image; /* NULL: it is text, or its image is missing */
    float image_scale;
} camber_label_run;

/* The texts and the icon that a layer's labels of a class show. */
typedef struct camber_label_form {
    uint32_t rule;
    uint32_t first_run;    /* of the text */
    camber_text *text;     /* NULL: none */
    camber_text *vertical; /* the same text, written downwards. NULL: none */
    const char *words;     /* the characters of its runs, each with a 0 at its end. NULL: there is no text */
    uint32_t run_count;
    const camber_sprite_image *icon;
    double sort_key;
    double weight;                         /* of two labels with equal sort keys, the lighter is placed first */
    uint64_t hash;                         /* of its words and its icon */
    uint64_t look_hash;                    /* of its rule, and of how each section of its text looks */
    double text_margin_px, icon_margin_px; /* for camber_label_margin. Negative: not known yet */
} camber_label_form;

/* A line that labels follow. Its points are px of the map's plane, relative to its first point. */
typedef struct camber_label_line {
    size_t first, count; /* range of line_points */
    bool reversed;       /* it runs from its last point to its first */
} camber_label_line;

/* The part of the map for which labels are placed, whatever view may show them. Then px are counted from the world's
 * north-west corner. Anchors and shapes are multiples of CAMBER_LABEL_STEP_PX, and whatever else is computed for a
 * label is relative to its anchor. So a label is the same in every part of the map, and in every copy of the world. */
typedef struct camber_label_domain {
    camber_box known; /* px: all anchors inside it are known; outside there may be others */
    bool whole;       /* there are no others: known is the world, whose eastern edge is next to its western one */
    double world_px;  /* the world's width */
} camber_label_domain;

/* A picture of a part of a domain. */
typedef struct camber_label_window {
    double scale;        /* its px per px of the domain */
    double origin_px[2]; /* its top left corner, in its own px from the world's north-west corner */
} camber_label_window;

#define CAMBER_LABEL_STEP_PX (1.0 / 4096.0)
/* In a domain, no label is shown whose shapes or pixels reach farther than this from its anchor. */
#define CAMBER_LABEL_REACH_PX 512.0
/* The tolerance to which lines that labels follow are simplified: device px of a view, CSS px of a domain. */
#define CAMBER_LABEL_SIMPLIFY_PX 0.25

static inline double camber_label_snap(double px) {
    return floor(px / CAMBER_LABEL_STEP_PX + 0.5) * CAMBER_LABEL_STEP_PX;
}

/* A form at an anchor. */
typedef struct camber_label_candidate {
    uint32_t form, feature;
    uint32_t line, segment; /* CAMBER_NO_PATH, or the line and the segment that it is on */
    double x, y;            /* of the anchor, px of the plane */
    double line_x, line_y;  /* of the line's first point, relative to the anchor */
    uint64_t rank; /* decides between equal candidates: its turn on its line, then a hash of its position and words */
    /* Placement fills these in. */
    bool shows_text, shows_icon, vertical;
    bool unsettled; /* in a domain: what is shown may depend on labels outside it */
    uint8_t anchor; /* which of the rule's anchors */
    camber_box box; /* around what is shown; if the candidate is unsettled, around all that it may show */
} camber_label_candidate;

typedef struct camber_layout_layer {
    size_t layer; /* of the style */
    size_t first_candidate, candidate_count;
} camber_layout_layer;

/* Rules, forms, runs, looks and words depend on the features and on the view's zoom, ratio, bearing and pitch, but not
 * on its place. So a layout can be made again for another place. */
typedef struct camber_label_layout {
    camber_context *context;
    const camber_features *features;
    const camber_view *view;
    const camber_label_things *things;
    const camber_label_domain *domain; /* NULL: labels are placed for the view */
    const camber_label_window *window; /* for items of a domain */
    double least_importance;           /* points of lines that matter less are left out, world coordinates */
    camber_fonts *fonts;
    camber_sprites *sprites; /* NULL: none */
    camber_view_lens lens;
    camber_layout_layer *layers; /* in drawing order */
    size_t layer_count, layer_capacity;
    camber_label_rule *rules;
    size_t rule_count, rule_capacity;
    camber_label_form *forms;
    size_t form_count, form_capacity;
    camber_label_run *runs;
    size_t run_count, run_capacity;
    camber_label_look *looks;
    size_t look_count, look_capacity;
    camber_label_candidate *candidates; /* layer by layer */
    size_t candidate_count, candidate_capacity;
    camber_label_line *lines;
    size_t line_count, line_capacity;
    float *line_points; /* pairs, relative to their lines' points */
    size_t line_point_count, line_point_capacity;
    uint32_t too_far; /* in a domain: the form of a label that is left out because it reaches too far; CAMBER_NO_FORM */
    size_t too_far_layer;             /* of the style */
    struct camber_label_words *words; /* texts that were shaped (label_text.c) */
    bool keeps_forms;                 /* it is made for several views, so that it keeps the following */
    uint32_t **known_forms; /* known_count tables by layer of the style: the forms of classes, NULL: none yet */
    size_t known_count;
    uint8_t *class_states; /* by class (label_layout.c); NULL: none yet */
    double *poles;         /* of areas: pole_count pairs, px from an area's first point */
    size_t pole_count, pole_capacity;
    camber_number_map pole_numbers; /* the number of an area's first polyline -> its pole's number + 1 */
} camber_label_layout;

/* Call it even after a failure. */
void camber_label_layout_free(camber_label_layout *layout);
/* Returns how many device px a CSS px of the last whole zoom has in the view: from 1 to less than 2 times the ratio. */
double camber_label_whole_zoom_px(const camber_view *view);
/* Finds the candidates of a view or of a domain, and forgets those that were found before. The caller has set the
 * members from context to sprites. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT. */
camber_status camber_label_layout_make(camber_label_layout *layout);
/* Returns the part of the world in which things may have labels that reach into a view. */
camber_box camber_label_seen(const camber_view *view);

/* ---- Forms (label_forms.c, label_text.c) ---- */

/* Makes the form that a layer's labels of a class have. *form is CAMBER_NO_FORM if they show nothing. */
camber_status camber_label_form_make(camber_label_layout *layout, const camber_layer_look *look,
                                     const camber_feature_class *class, uint32_t *form);
/* Shapes a form's texts, or takes them from the table if they were shaped before. */
camber_status camber_label_text_make(camber_label_layout *layout, const camber_symbol *symbol, camber_label_form *form);
void camber_label_words_free(camber_label_layout *layout);
/* Frees all texts but those of the layout's forms. No other form can then be made. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_label_words_keep(camber_label_layout *layout);
/* Finds an image. NULL: it is missing, and a warning says so. */
const camber_sprite_image *camber_label_find_image(const camber_label_layout *layout, const char *name);

/* Sets the point from which the parts of a candidate's label are computed: its anchor, or in a domain 0, 0. */
static inline void camber_label_base(const camber_label_layout *layout, const camber_label_candidate *c,
                                     double base[2]) {
    base[0] = layout->domain ? 0.0 : c->x;
    base[1] = layout->domain ? 0.0 : c->y;
}

static inline const camber_label_rule *camber_label_rule_of(const camber_label_layout *layout,
                                                            const camber_label_candidate *c) {
    return layout->rules + layout->forms[c->form].rule;
}

/* ---- Parts of labels about their anchors (label_parts.c) ---- */

/* Where a part of a label is drawn: a point (u, v) of the part, in px from the candidate's anchor, is drawn at
 * (x + xx * u + xy * v, y + yx * u + yy * v). */
typedef struct camber_label_frame {
    double x, y, xx, xy, yx, yy;
    bool flat; /* that point is in px of the plane; otherwise of the picture */
} camber_label_frame;

/* Returns how near the camera is to a candidate's anchor: 1 at the picture's centre. 0: no label is shown there. */
double camber_label_nearness(const camber_label_layout *layout, const camber_label_candidate *c);
camber_label_frame camber_label_text_frame(const camber_label_layout *layout, const camber_label_candidate *c);
camber_label_frame camber_label_icon_frame(const camber_label_layout *layout, const camber_label_candidate *c);
/* Returns the box of a text that is placed by this one of its rule's anchors, in px from the candidate's anchor. */
camber_box camber_label_text_box(const camber_label_layout *layout, const camber_label_candidate *c, bool vertical,
                                 size_t anchor);
/* Computes how far this text is moved from the position in which it was shaped, in px. */
void camber_label_text_shift(const camber_label_layout *layout, const camber_label_candidate *c, bool vertical,
                             size_t anchor, double shift_px[2]);
/* Returns the box of the icon, without padding. vertical and anchor describe the text that the icon is fitted to. */
camber_box camber_label_icon_box(const camber_label_layout *layout, const camber_label_candidate *c, bool vertical,
                                 size_t anchor);
/* Returns how far the pixels of a form's text or icon may be from the shapes that it takes up when labels collide, px.
 */
double camber_label_margin(camber_label_layout *layout, uint32_t form, bool of_text);
/* Computes the bounds in the picture of a box in a frame. false: the box is not in front of the camera. */
bool camber_label_bounds(const camber_label_layout *layout, const camber_label_frame *frame, const camber_box *box,
                         camber_box *bounds);

/* ---- Texts along lines (label_along.c) ---- */

/* The part of a line that a text covers, in the order of the text, in px of the plane or the picture. */
typedef struct camber_label_track {
    camber_context *context;
    double *points; /* triples: x, y and the distance from the anchor, which is negative before it */
    size_t count, capacity;
    double side; /* 1: the text runs with the line; -1: against it */
    bool vertical, flat;
    double first, last; /* distances of the first and the last glyph */
    double across;      /* how far to the line's right the text is */
    double shift;       /* how far along the line the text is moved */
    double size;        /* px per em */
} camber_label_track;

typedef struct camber_track_point {
    double x, y, cosine, sine; /* a point, and the direction of the line there */
} camber_track_point;

/* Finds the track of a candidate's text. *fits is false if the line is too short. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_label_track_find(const camber_label_layout *layout, const camber_label_candidate *c,
                                      camber_label_track *track, bool *fits);
/* Returns the point at a distance. */
camber_track_point camber_label_track_point(const camber_label_track *track, double distance);

/* ---- Placement and items ---- */

/* Decides which candidates are shown. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_label_place_all(camber_label_layout *layout);
/* Makes the items of the labels that are shown. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT. */
camber_status camber_label_items_make(camber_label_layout *layout, camber_labels *labels);

#endif
