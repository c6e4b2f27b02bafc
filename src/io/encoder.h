/* Declarations that the encoder's files share. */
#ifndef CAMBER_IO_ENCODER_H
#define CAMBER_IO_ENCODER_H

#include "base/base.h"

enum { CAMBER_WEBP_LONGEST_SIDE = 16383 };

/* A file in memory. Its buffer is reused. */
typedef struct camber_file_bytes {
    camber_context *context;
    uint8_t *bytes;
    size_t size, capacity;
    bool refused; /* there was no memory for some bytes, which has been logged */
} camber_file_bytes;

bool camber_file_bytes_add(camber_file_bytes *file, const void *bytes, size_t size_bytes);

/* Checks the parameters of a PNG. Returns CAMBER_ERROR_ARGUMENT. */
camber_status camber_png_check(camber_context *context, int compression, const camber_png_text *texts,
                               size_t text_count);

bool camber_webp_is_built(void);
/* Appends the picture to file as WebP. straight: scratch with room for all pixels. */
camber_status camber_webp_encode(const camber_encoder_desc *desc, const camber_pixels *pixels, uint8_t *straight,
                                 camber_file_bytes *file);

#endif
