/* Places the labels of a view: things, layout, placement, items. */
#include "map/label_layout.h"

struct camber_label_book {
    const camber_features *features;
    uint64_t features_key, view_key; /* what things and layout were made for */
    bool has_things;
    camber_label_things things; /* of all features */
    camber_label_layout layout;
};

/* Places labels with a layout that may have forms of the same zoom. */
static camber_status place(camber_label_layout *layout, const camber_view *view, const camber_label_things *things,
                           camber_labels *labels) {
    layout->view = view;
    layout->things = things;
    layout->least_importance = CAMBER_LABEL_SIMPLIFY_PX / view->scale_px;
    *labels = (camber_labels){.context = layout->context};
    camber_status status = camber_label_layout_make(layout);
    if (status == CAMBER_OK)
        status = camber_label_place_all(layout);
    if (status == CAMBER_OK)
        status = camber_label_items_make(layout, labels);
    layout->view = NULL;
    layout->things = NULL;
    return status;
}

camber_status camber_labels_place(const camber_features *features, const camber_view *view, camber_fonts *fonts,
                                  camber_sprites *sprites, camber_labels *labels) {
    camber_label_layout layout = {
        .context = features->context, .features = features, .fonts = fonts, .sprites = sprites};
    camber_label_things things;
    const camber_box seen = camber_label_seen(view);
    *labels = (camber_labels){.context = features->context};
    camber_status status = camber_label_things_find(features, &seen, &things);
    if (status == CAMBER_OK)
        status = place(&layout, view, &things, labels);
    camber_label_layout_free(&layout);
    camber_label_things_free(&things);
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

/* ---- Books ---- */

camber_status camber_label_book_create(const camber_features *features, camber_label_book **book) {
    camber_label_book *made = camber_alloc_zero(features->context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->features = features;
    *book = made;
    return CAMBER_OK;
}

static void forget_forms(camber_label_book *book) {
    if (book->layout.context)
        camber_label_layout_free(&book->layout);
    book->layout = (camber_label_layout){.context = book->features->context,
                                         .features = book->features,
                                         .fonts = book->features->fonts,
                                         .sprites = book->features->sprites,
                                         .keeps_forms = true};
}

void camber_label_book_destroy(camber_label_book *book) {
    if (!book)
        return;
    forget_forms(book);
    camber_label_things_free(&book->things);
    camber_free(book->features->context, book);
}

/* Makes the book fit for a view. */
static camber_status open_book(camber_label_book *book, const camber_view *view) {
    const uint64_t features_key = camber_features_key(book->features), view_key = camber_view_key(view);
    if (book->has_things && book->features_key == features_key && book->view_key == view_key)
        return CAMBER_OK;
    forget_forms(book);
    book->view_key = view_key;
    if (book->has_things && book->features_key == features_key)
        return CAMBER_OK;
    camber_label_things_free(&book->things);
    book->features_key = features_key;
    const camber_status status = camber_label_things_find(book->features, NULL, &book->things);
    book->has_things = status == CAMBER_OK;
    return status;
}

camber_status camber_label_book_place(camber_label_book *book, const camber_view *view, camber_labels *labels) {
    const camber_box seen = camber_label_seen(view);
    camber_label_things things = {0};
    *labels = (camber_labels){.context = book->features->context};
    camber_status status = open_book(book, view);
    if (status == CAMBER_OK)
        status = camber_label_things_select(&book->things, &seen, &things);
    if (status == CAMBER_OK)
        status = place(&book->layout, view, &things, labels);
    camber_label_things_free(&things);
    return status;
}
