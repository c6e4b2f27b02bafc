/* How icons are drawn: as images with a border, or as rings if they are distances. */
#ifndef CAMBER_MAP_LABEL_ICONS_H
#define CAMBER_MAP_LABEL_ICONS_H

#include "map/labels.h"

/* An icon in one size: as it is drawn for some items. Its frame is what the item's matrix maps, from 0 to 1. */
typedef struct camber_icon_form {
    const camber_sprite_image *icon;
    uint32_t width, height; /* of the image, without the border; a stretched one is larger or smaller than the icon */
    camber_image image;     /* with a transparent border of one px, so that its edges do not show its other side */
    camber_outline outline; /* of an icon of distances, in shares of the frame; then there is no image */
    void *outline_block;
} camber_icon_form;

typedef struct camber_icon_forms {
    camber_context *context;
    camber_icon_form *forms; /* count of them */
    size_t count, capacity;
} camber_icon_forms;

/* Finds the form that an item needs, or makes it; *index is its number. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT
 * (stretched to more than 4096 px). */
camber_status camber_icon_forms_find(camber_icon_forms *forms, const camber_label_item *item, size_t *index);
void camber_icon_forms_free(camber_icon_forms *forms);

#endif
