/* The labels of a whole zoom: they have fixed places on the map, so pictures that are parts of a larger one have parts
 * of the same labels.
 *
 * Labels are placed in blocks, squares of the map that are divided until few things are in each. A block is placed
 * together with its surroundings, as far as labels there may matter to those in the block (label_layout.h,
 * placement.c). So the result depends neither on the blocks nor on their order. What is settled on the way is kept: if
 * a block needs much of its surroundings, the largest square around it that is settled takes its place. Labels are
 * placed in CSS px, so pictures of any ratio have the same ones. */
#ifndef CAMBER_MAP_ZOOM_LABELS_H
#define CAMBER_MAP_ZOOM_LABELS_H

#include "map/label_things.h"
#include "map/labels.h"

/* The blocks that are kept, of all zooms that use the shelf. Zeroed but for the limit it is empty; it is empty again
 * when the labels of all zooms are destroyed. */
typedef struct camber_label_block camber_label_block;
typedef struct camber_label_shelf {
    camber_label_block *blocks; /* the most recently used one first */
    size_t held_bytes;          /* that they take */
    size_t placed;              /* how many have been placed so far */
    size_t limit_bytes;         /* about how much memory they may take before the least recently used one is dropped */
} camber_label_shelf;

typedef struct camber_zoom_labels_desc {
    const camber_features *features; /* with fonts */
    camber_label_things *things;
    camber_label_shelf *shelf; /* NULL: nothing is kept, and only camber_zoom_labels_place_view may do that */
    double zoom;               /* as in MapLibre; below 0 the style is evaluated at 0, and the world is smaller */
    double least_importance;   /* of points, world coordinates: lines of labels are simplified at least as much */
    int finest_level;          /* the smallest blocks are 1 / 2^finest_level of the world wide */
    size_t block_things;       /* a block with more things is divided */
} camber_zoom_labels_desc;

typedef struct camber_zoom_labels camber_zoom_labels;

/* The features, the things and the shelf must outlive the labels. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_zoom_labels_create(const camber_zoom_labels_desc *desc, camber_zoom_labels **labels);
void camber_zoom_labels_destroy(camber_zoom_labels *labels);

/* Makes the items of the labels in a picture. square: of the finest level; it contains the picture. Call
 * camber_labels_free even after a failure. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT. */
camber_status camber_zoom_labels_draw(camber_zoom_labels *z, const camber_label_square *square,
                                      const camber_view *picture, camber_labels *drawn);

/* Whether a picture has the labels of its zoom: the zoom is whole, the picture is neither turned nor tilted, nor wider
 * than the world, and no layer keeps its labels off the picture's edges. */
bool camber_view_has_zoom_labels(const camber_style *style, const camber_view *view);
/* Makes the items of the labels in such a picture, as far as the features around it are known. Call camber_labels_free
 * even after a failure. Returns the errors of camber_zoom_labels_draw. */
camber_status camber_zoom_labels_place_view(const camber_features *features, const camber_view *view,
                                            double simplify_px, camber_labels *drawn);

/* A label that is shown. */
typedef struct camber_shown_label {
    camber_box box;      /* around its pixels and their halos, or a little larger; world coordinates */
    uint64_t appearance; /* a hash of its place, its words and how it is drawn */
} camber_shown_label;

/* Called for each label of a block that touches the block. Returns CAMBER_OK to go on. */
typedef camber_status camber_shown_label_fn(void *user, const camber_label_square *block,
                                            const camber_shown_label *label);

/* Lists the labels in all blocks that an area (world coordinates; it may extend beyond x = 1) touches. A label that
 * touches several blocks is listed for each. Returns the errors of camber_zoom_labels_draw and of the function. */
camber_status camber_zoom_labels_list(camber_zoom_labels *labels, const camber_box *area, camber_shown_label_fn *take,
                                      void *user);

#endif
