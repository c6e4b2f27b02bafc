/* How icons are drawn: as images with a border, or as rings if their pixels are distances. */
#ifndef CAMBER_MAP_LABEL_ICONS_H
#define CAMBER_MAP_LABEL_ICONS_H

#include "map/labels.h"

/* An icon at one size, as some items draw it. Its frame is the unit square, which the item's matrix maps. */
typedef struct camber_icon_form {
    const camber_sprite_image *icon;
    uint32_t width, height; /* of the image without the border; a stretched image is larger or smaller than the icon */
    camber_image image;     /* with a transparent border of one px, so that an edge does not show the opposite edge */
    camber_outline outline; /* of an icon of distances, in fractions of the frame; such an icon has no image */
    void *outline_block;
} camber_icon_form;

typedef struct camber_icon_forms {
    camber_context *context;
    camber_icon_form *forms; /* count of them */
    size_t count, capacity;
    uint32_t *slots; /* a hash table of their numbers + 1; slot_count is a power of two */
    size_t slot_count;
} camber_icon_forms;

/* Finds the form that an item needs, or makes it; *index is its number. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT
 * (stretched to more than 4096 px). */
camber_status camber_icon_forms_find(camber_icon_forms *forms, const camber_label_item *item, size_t *index);
void camber_icon_forms_free(camber_icon_forms *forms);

#endif
