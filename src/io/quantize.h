/* Chooses a palette for a picture that has too many colours. */
#ifndef CAMBER_IO_QUANTIZE_H
#define CAMBER_IO_QUANTIZE_H

#include "io/colors.h"
#include "io/png_chunks.h"

typedef struct camber_quantizer camber_quantizer;

camber_status camber_quantizer_create(camber_context *context, camber_quantizer **quantizer);
void camber_quantizer_destroy(camber_quantizer *quantizer);

typedef struct camber_palette {
    uint8_t colors[CAMBER_PALETTE_MOST][4]; /* premultiplied */
    size_t count;
    uint8_t places[CAMBER_KEYS_MOST]; /* by numbered colour: its index in the palette */
} camber_palette;

/* Chooses a palette and gives each numbered colour its index. Transparent and opaque colours stay so, and colours that
 * many pixels have stay unchanged. */
void camber_quantize(camber_quantizer *quantizer, const camber_colors *colors, camber_palette *palette);
/* Whether most pixels have flat colours, as on a map. In other pictures, the colours are not mixtures of a few. */
bool camber_colors_have_flat(const camber_colors *colors);

#endif
