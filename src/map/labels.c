/* Places the labels of a view: layout, placement, items. */
#include "map/label_layout.h"

camber_status camber_labels_place(const camber_features *features, const camber_view *view, camber_fonts *fonts,
                                  camber_sprites *sprites, camber_labels *labels) {
    camber_label_layout layout = {
        .context = features->context, .features = features, .view = view, .fonts = fonts, .sprites = sprites};
    *labels = (camber_labels){.context = features->context};
    camber_status status = camber_label_layout_make(&layout);
    if (status == CAMBER_OK)
        status = camber_label_place_all(&layout);
    if (status == CAMBER_OK)
        status = camber_label_items_make(&layout, labels);
    camber_label_layout_free(&layout);
    return status;
}

void camber_labels_free(camber_labels *labels) {
    camber_free(labels->context, labels->layers);
    camber_free(labels->context, labels->items);
    camber_free(labels->context, labels->looks);
    camber_free(labels->context, labels->labels);
    camber_free(labels->context, labels->words);
    *labels = (camber_labels){.context = labels->context};
}
