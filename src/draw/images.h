/* The texels of images, at the size that they have in the picture. */
#ifndef CAMBER_DRAW_IMAGES_H
#define CAMBER_DRAW_IMAGES_H

#include "base/base.h"
#include "camber.h"

enum { CAMBER_IMAGE_TEXELS_MAX = 2046 }; /* along each side */

/* An image at the size that a row or a fill draws it in. */
typedef struct camber_image_use {
    const camber_image *image;  /* the caller's image */
    size_t number;              /* number of the image among all images of the frame */
    double width_px, height_px; /* 0: one texel, the image's mean */
    bool tiled;                 /* it repeats downwards too; else only to the right */
} camber_image_use;

typedef struct camber_image_size {
    uint32_t width, height; /* texels */
    bool tiled;             /* above its upper edge its lower edge is repeated */
} camber_image_size;

/* The images of a frame, each once, numbered in the order in which they are added. */
typedef struct camber_image_set {
    camber_context *context;
    const camber_image **images; /* count of them, owned by the caller */
    size_t count, capacity;
    uint32_t *slots;   /* numbers + 1, hashed by pointer; 0: free */
    size_t slot_count; /* a power of two, above 2 * count */
} camber_image_set;

void camber_image_set_clear(camber_image_set *set);
void camber_image_set_free(camber_image_set *set);
/* Finds the number of an image, after adding the image if the set does not have it. Returns CAMBER_ERROR_ARGUMENT
 * (camber.h does not allow the image), CAMBER_ERROR_MEMORY. */
camber_status camber_image_set_add(camber_image_set *set, const camber_image *image, size_t *number);

/* Returns the use of an image by a line of the given width. length: how much of the line an image takes (0: the length
 * that keeps the image's aspect ratio). */
camber_image_use camber_image_use_on_line(const camber_image *image, size_t number, double stroke_px, double length_px);
/* Returns the use of an image by a fill, in the given size in px (0: the image's own). */
camber_image_use camber_image_use_in_fill(const camber_image *image, size_t number, double width_px, double height_px);
/* Returns the use of an image as its mean colour. */
camber_image_use camber_image_use_as_mean(const camber_image *image, size_t number);

/* Returns the size in texels for a use. nearest: the most px of the picture that one px of the plane takes. */
camber_image_size camber_image_texels(const camber_image_use *use, double nearest);
/* Writes RGBA8 with a border of one texel. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_image_shrink(camber_context *context, const camber_image *image, camber_image_size size,
                                  uint8_t *texels);
const uint8_t *camber_image_row(const camber_image *image, uint32_t y);

#endif
