/* Places the labels of a view: layout, placement, items. */
#include "map/label_layout.h"

/* The tolerance to which lines are simplified, as for drawing, device px. */
static const double SIMPLIFY_PX = 0.25;

camber_status camber_labels_place(const camber_features *features, const camber_view *view, camber_fonts *fonts,
                                  camber_sprites *sprites, camber_labels *labels) {
    camber_label_things things;
    camber_label_layout layout = {.context = features->context,
                                  .features = features,
                                  .view = view,
                                  .things = &things,
                                  .least_importance = SIMPLIFY_PX / view->scale_px,
                                  .fonts = fonts,
                                  .sprites = sprites};
    const camber_box seen = camber_label_seen(view);
    *labels = (camber_labels){.context = features->context};
    camber_status status = camber_label_things_find(features, &seen, &things);
    if (status == CAMBER_OK)
        status = camber_label_layout_make(&layout);
    if (status == CAMBER_OK)
        status = camber_label_place_all(&layout);
    if (status == CAMBER_OK)
        status = camber_label_items_make(&layout, labels);
    camber_label_layout_free(&layout);
    camber_label_things_free(&things);
    return status;
}

void camber_labels_free(camber_labels *labels) {
    camber_free(labels->context, labels->layers);
    camber_free(labels->context, labels->items);
    camber_free(labels->context, labels->looks);
    camber_free(labels->context, labels->labels);
    *labels = (camber_labels){.context = labels->context};
}
