#include "io/encoder.h"

#ifdef CAMBER_WEBP

#include "io/png_chunks.h"

#include <webp/encode.h>

/* Measured on maps of Porto: higher methods cost more time than the saved bytes are worth. */
enum { QUALITY_USUAL = 80, METHOD = 2, LOSSLESS_LEVEL = 1 };

bool camber_webp_is_built(void) {
    return true;
}

static int take_bytes(const uint8_t *bytes, size_t size_bytes, const WebPPicture *picture) {
    return camber_file_bytes_add(picture->custom_ptr, bytes, size_bytes);
}

static bool configure(const camber_encoder_desc *desc, WebPConfig *config) {
    const int quality = desc->quality ? desc->quality : QUALITY_USUAL;
    if (!WebPConfigInit(config))
        return false;
    config->quality = (float)quality;
    config->method = METHOD;
    return quality < 100 || WebPConfigLosslessPreset(config, LOSSLESS_LEVEL);
}

static bool import(WebPPicture *picture, const camber_pixels *pixels, uint8_t *straight, bool opaque) {
    const size_t stride = pixels->stride_bytes ? pixels->stride_bytes : 4 * (size_t)pixels->width;
    const int straight_stride = 4 * (int)pixels->width;
    for (size_t y = 0; y < pixels->height; y++) {
        uint8_t *row = straight + (size_t)straight_stride * y;
        if (opaque)
            memcpy(row, pixels->rgba + stride * y, (size_t)straight_stride);
        else
            camber_unpremultiply(pixels->rgba + stride * y, pixels->width, row);
    }
    return opaque ? WebPPictureImportRGBX(picture, straight, straight_stride)
                  : WebPPictureImportRGBA(picture, straight, straight_stride);
}

/* The picture was checked before, so libwebp fails only if there is no memory. */
static camber_status fail(camber_context *context, const camber_pixels *pixels) {
    return camber_fail(context, CAMBER_ERROR_MEMORY,
                       "WebP: out of memory for %u x %u px; draw a smaller picture, or write it as png", pixels->width,
                       pixels->height);
}

camber_status camber_webp_encode(const camber_encoder_desc *desc, const camber_pixels *pixels, uint8_t *straight,
                                 camber_file_bytes *file) {
    WebPConfig config;
    WebPPicture picture;
    if (!configure(desc, &config) || !WebPPictureInit(&picture))
        return camber_fail(file->context, CAMBER_ERROR_DEVICE,
                           "WebP: libwebp is older than the one camber was built with; reinstall camber");
    picture.use_argb = config.lossless;
    picture.width = (int)pixels->width;
    picture.height = (int)pixels->height;
    picture.writer = take_bytes;
    picture.custom_ptr = file;
    const bool imported = import(&picture, pixels, straight, desc->opaque);
    const bool encoded = imported && WebPEncode(&config, &picture);
    WebPPictureFree(&picture);
    if (encoded && !file->refused)
        return CAMBER_OK;
    return file->refused ? CAMBER_ERROR_MEMORY : fail(file->context, pixels);
}

#else

bool camber_webp_is_built(void) {
    return false;
}

camber_status camber_webp_encode(const camber_encoder_desc *desc, const camber_pixels *pixels, uint8_t *straight,
                                 camber_file_bytes *file) {
    (void)desc, (void)pixels, (void)straight; /* encoders for WebP cannot be created in this build */
    return camber_fail(file->context, CAMBER_ERROR_ARGUMENT, "this build has no webp; write a PNG");
}

#endif
