/* Images that rows and fills are drawn with: each at about the size it is drawn in, side by side in one texture, with
 * what lies beyond its edges around it, so that no filter reaches into a neighbour. */
#include "draw/renderer.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum { TEXTURE_WIDTH = 2048, FIRST_HEIGHT = 256, LAST_HEIGHT = 4096, SIDE_MAX = TEXTURE_WIDTH - 2 };

bool camber_image_is_valid(const camber_image *image) {
    return image->rgba && image->width >= 1 && image->width <= CAMBER_IMAGE_SIDE_MAX && image->height >= 1 &&
           image->height <= CAMBER_IMAGE_SIDE_MAX &&
           (image->stride_bytes == 0 || image->stride_bytes >= 4 * (size_t)image->width);
}

/* ---- Sizes ---- */

/* An image at a size in the picture. */
typedef struct pattern_use {
    uint32_t pattern; /* of the pass, from 1 */
    double width_px, height_px;
    bool tiled; /* downwards, too */
} pattern_use;

static pattern_use use_of_fill(const camber_pass *pass) {
    const camber_fill *fill = &pass->fill;
    const camber_image *image = pass->images + fill->pattern - 1;
    return (pattern_use){fill->pattern, fill->width_px > 0.0f ? (double)fill->width_px : image->width,
                         fill->height_px > 0.0f ? (double)fill->height_px : image->height, true};
}

static pattern_use mean_of_fill(const camber_pass *pass) {
    return (pattern_use){pass->fill.pattern, 0.0, 0.0, true};
}

/* Texels for a side that is drawn so long: all there are, unless they are finer than pixels by far. Sizes in steps of
 * sqrt(2) keep a zoom from filling the texture. */
static uint32_t texels_for(uint32_t side_px, double drawn_px) {
    const double most = (double)(side_px < SIDE_MAX ? side_px : SIDE_MAX), step = 1.4142135623730951;
    if (!(drawn_px * step < most))
        return (uint32_t)most;
    const double exponent = ceil(log2(fmax(drawn_px, 1.0)) * 2.0);
    return (uint32_t)fmax(fmin(ceil(exp2(0.5 * exponent)), most), 1.0);
}

static const uint8_t *image_row(const camber_image *image, uint32_t y) {
    return image->rgba + y * (image->stride_bytes ? image->stride_bytes : 4 * (size_t)image->width);
}

/* Averages of as many px of a row as fall on each texel, by their share. */
static void shrink_row(const camber_image *image, uint32_t y, float *texels, uint32_t count) {
    const uint8_t *row = image_row(image, y);
    const double share = (double)image->width / count;
    for (uint32_t i = 0; i < count; i++) {
        const double from = i * share, to = fmin((i + 1) * share, image->width);
        double sums[4] = {0};
        for (uint32_t k = (uint32_t)from; k < to; k++)
            for (size_t c = 0; c < 4; c++)
                sums[c] += (fmin(to, k + 1.0) - fmax(from, k)) * row[4 * (size_t)k + c];
        for (size_t c = 0; c < 4; c++)
            texels[4 * (size_t)i + c] = (float)(sums[c] / (to - from));
    }
}

/* The same down the columns, a row of texels after the other. line and sums: a row each. */
static void shrink(const camber_image *image, const camber_placed *placed, float *line, float *sums, uint8_t *texels) {
    const size_t floats = 4 * (size_t)placed->width, stride = floats + 8;
    const double share = (double)image->height / placed->height;
    uint32_t row = 0;
    memset(sums, 0, floats * sizeof *sums);
    for (uint32_t y = 0; y < image->height; y++) {
        shrink_row(image, y, line, placed->width);
        while (row < placed->height && row * share < y + 1.0) {
            const double from = row * share, to = fmin((row + 1) * share, image->height);
            const float part = (float)((fmin(to, y + 1.0) - fmax(from, y)) / (to - from));
            for (size_t i = 0; i < floats; i++)
                sums[i] += part * line[i];
            if (to > y + 1.0)
                break;
            for (size_t i = 0; i < floats; i++)
                texels[stride * row + i] = (uint8_t)fminf(sums[i] + 0.5f, 255.0f);
            memset(sums, 0, floats * sizeof *sums);
            row++;
        }
    }
}

/* ---- The texture ---- */

/* What lies beyond the edges: the other edge; above and below of what is not tiled the same edge. */
static void add_border(const camber_placed *placed, uint8_t *texels) {
    const size_t width = placed->width, height = placed->height, stride = 4 * (width + 2);
    for (size_t y = 1; y <= height; y++) {
        memcpy(texels + stride * y, texels + stride * y + 4 * width, 4);
        memcpy(texels + stride * y + 4 * (width + 1), texels + stride * y + 4, 4);
    }
    memcpy(texels, texels + stride * (placed->tiled ? height : 1), stride);
    memcpy(texels + stride * (height + 1), texels + stride * (placed->tiled ? 1 : height), stride);
}

static camber_status upload(camber_renderer *renderer, const camber_image *image, const camber_placed *placed) {
    camber_context *context = renderer->share.device->context;
    const camber_gl *gl = &renderer->share.surface->gl;
    const size_t width = (size_t)placed->width + 2, height = (size_t)placed->height + 2;
    uint8_t *texels = camber_alloc(context, width * height, 4);
    float *rows = texels ? camber_alloc(context, 2 * width, 4 * sizeof *rows) : NULL;
    const bool held = rows != NULL;
    if (held) {
        shrink(image, placed, rows, rows + 4 * width, texels + 4 * width + 4);
        add_border(placed, texels);
        gl->BindTexture(GL_TEXTURE_2D, renderer->patterns.texture);
        gl->TexSubImage2D(GL_TEXTURE_2D, 0, placed->x - 1, placed->y - 1, (GLsizei)width, (GLsizei)height, GL_RGBA,
                          GL_UNSIGNED_BYTE, texels);
    }
    camber_free(context, rows);
    camber_free(context, texels);
    return held ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}

static GLsizei most_height(const camber_renderer *renderer) {
    const uint32_t side = renderer->share.surface->info.largest_target_px;
    return side < LAST_HEIGHT ? (GLsizei)side : LAST_HEIGHT;
}

/* An empty one, larger than the one there is where that can be. */
static camber_status make_room(camber_renderer *renderer) {
    camber_patterns *patterns = &renderer->patterns;
    const camber_gl *gl = &renderer->share.surface->gl;
    const GLsizei most = most_height(renderer), twice = 2 * patterns->height;
    const GLsizei height = !patterns->texture ? FIRST_HEIGHT : twice < most ? twice : most;
    patterns->count = 0;
    patterns->shelf_x = patterns->shelf_y = patterns->shelf_height = 0;
    if (patterns->texture && patterns->height == height)
        return CAMBER_OK;
    gl->DeleteTextures(1, &patterns->texture);
    gl->GenTextures(1, &patterns->texture);
    gl->BindTexture(GL_TEXTURE_2D, patterns->texture);
    gl->TexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, TEXTURE_WIDTH, height);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    patterns->height = height;
    const camber_status status = camber_renderer_check(renderer, "the texture of patterns");
    if (status != CAMBER_OK) {
        gl->DeleteTextures(1, &patterns->texture);
        patterns->texture = 0;
    }
    return status;
}

/* Next to the last one, or on a shelf above; false where neither has room. */
static bool find_room(camber_patterns *patterns, camber_placed *placed) {
    const GLint width = (GLint)placed->width + 2, height = (GLint)placed->height + 2;
    if (patterns->shelf_x + width > TEXTURE_WIDTH) {
        patterns->shelf_y += patterns->shelf_height;
        patterns->shelf_x = patterns->shelf_height = 0;
    }
    if (!patterns->texture || patterns->shelf_y + height > patterns->height)
        return false;
    placed->x = patterns->shelf_x + 1;
    placed->y = patterns->shelf_y + 1;
    patterns->shelf_x += width;
    patterns->shelf_height = height > patterns->shelf_height ? height : patterns->shelf_height;
    return true;
}

/* ---- Images ---- */

/* Of what the image shows: pointers may come again with other images behind them. */
static uint64_t hash_of(const camber_image *image) {
    uint64_t hash = camber_hash(CAMBER_HASH_START, &image->width, sizeof image->width);
    for (uint32_t y = 0; y < image->height; y++)
        hash = camber_hash(hash, image_row(image, y), 4 * (size_t)image->width);
    return hash;
}

/* A frame's passes mostly share their images, which are looked at once a piece. */
static camber_status hash_once(camber_renderer *renderer, const camber_pass *pass, uint32_t image, uint64_t *hash) {
    camber_patterns *patterns = &renderer->patterns;
    if (patterns->hashed != pass->images || patterns->hashed_count < pass->image_count) {
        if (!camber_grow(renderer->share.device->context, &patterns->hashes, &patterns->hash_capacity,
                         pass->image_count, sizeof *patterns->hashes))
            return CAMBER_ERROR_MEMORY;
        memset(patterns->hashes, 0, pass->image_count * sizeof *patterns->hashes);
        patterns->hashed = pass->images;
        patterns->hashed_count = pass->image_count;
    }
    if (!patterns->hashes[image])
        patterns->hashes[image] = hash_of(pass->images + image) | 1;
    *hash = patterns->hashes[image];
    return CAMBER_OK;
}

static const camber_placed *find(const camber_patterns *patterns, const camber_placed *wanted) {
    for (size_t i = 0; i < patterns->count; i++) {
        const camber_placed *placed = patterns->placed + i;
        if (placed->hash == wanted->hash && placed->width == wanted->width && placed->height == wanted->height &&
            placed->tiled == wanted->tiled)
            return placed;
    }
    return NULL;
}

static camber_status place(camber_renderer *renderer, const camber_image *image, camber_placed *placed, bool *full) {
    camber_patterns *patterns = &renderer->patterns;
    if (!patterns->texture) {
        const camber_status status = make_room(renderer);
        if (status != CAMBER_OK)
            return status;
    }
    if (!find_room(patterns, placed)) {
        *full = true;
        return CAMBER_OK;
    }
    if (!camber_grow(renderer->share.device->context, &patterns->placed, &patterns->capacity, patterns->count + 1,
                     sizeof *patterns->placed))
        return CAMBER_ERROR_MEMORY;
    const camber_status status = upload(renderer, image, placed);
    if (status == CAMBER_OK)
        patterns->placed[patterns->count++] = *placed;
    return status;
}

/* Where in the texture the image is, as coordinates there: from where, how far. */
static camber_status find_place(camber_renderer *renderer, const camber_pass *pass, pattern_use use, float texel[4],
                                bool *full) {
    const camber_image *image = pass->images + use.pattern - 1;
    camber_placed wanted = {.width = texels_for(image->width, use.width_px * renderer->patterns.nearest),
                            .height = texels_for(image->height, use.height_px * renderer->patterns.nearest),
                            .tiled = use.tiled};
    camber_status status = hash_once(renderer, pass, use.pattern - 1, &wanted.hash);
    if (status != CAMBER_OK)
        return status;
    const camber_placed *found = find(&renderer->patterns, &wanted);
    if (!found) {
        status = place(renderer, image, &wanted, full);
        found = &wanted;
    }
    if (status != CAMBER_OK || *full)
        return status;
    const float width = (float)TEXTURE_WIDTH, height = (float)renderer->patterns.height;
    texel[0] = (float)found->x / width;
    texel[1] = (float)found->y / height;
    texel[2] = (float)found->width / width;
    texel[3] = (float)found->height / height;
    return CAMBER_OK;
}

/* ---- Rows and fills ---- */

static camber_status put_row(camber_renderer *renderer, const camber_pass *pass, const camber_paint *paint,
                             float texels[8], bool *full) {
    const camber_image *image = pass->images + paint->pattern - 1;
    const double whole_px = 2.0 * (double)camber_paint_half_width(paint);
    const double length_px =
        paint->pattern_px > 0.0f ? (double)paint->pattern_px : whole_px * image->width / image->height;
    const pattern_use use = {paint->pattern, fmin(fmax(length_px, 1e-3), 1e9), whole_px, false};
    texels[4] = (float)use.width_px;
    return find_place(renderer, pass, use, texels, full);
}

camber_status camber_patterns_put(camber_renderer *renderer, const camber_pass *pass, const camber_paint *paint,
                                  float texels[8]) {
    bool full = false;
    const camber_status status = put_row(renderer, pass, paint, texels, &full);
    assert(!full);
    return status;
}

/* All that a pass draws. */
static camber_status try_to_hold(camber_renderer *renderer, const camber_pass *pass, bool *full) {
    float texels[8];
    camber_status status = CAMBER_OK;
    *full = false;
    if (!pass->mesh) {
        status = find_place(renderer, pass, use_of_fill(pass), texels, full);
        return status == CAMBER_OK && !*full ? find_place(renderer, pass, mean_of_fill(pass), texels, full) : status;
    }
    for (uint32_t i = 0; i < pass->mesh->row_count && status == CAMBER_OK && !*full; i++)
        if (camber_pass_draws(pass, i) && pass->paints[i].pattern)
            status = put_row(renderer, pass, pass->paints + i, texels, full);
    return status;
}

camber_status camber_patterns_hold(camber_renderer *renderer, const camber_pass *pass, const camber_piece *piece) {
    bool full;
    camber_status status = try_to_hold(renderer, pass, &full);
    if (status == CAMBER_OK && full)
        status = camber_batch_draw(renderer, 0, piece); /* what waits is drawn with what is there */
    while (status == CAMBER_OK && full) {
        const bool last = renderer->patterns.height == most_height(renderer);
        status = make_room(renderer);
        if (status == CAMBER_OK)
            status = try_to_hold(renderer, pass, &full);
        if (status == CAMBER_OK && full && last)
            return camber_fail(renderer->share.device->context, CAMBER_ERROR_LIMIT,
                               "the patterns of a pass take more than %d x %d px; draw fewer images in fewer sizes",
                               (int)TEXTURE_WIDTH, (int)renderer->patterns.height);
    }
    return status;
}

camber_status camber_patterns_put_fill(camber_renderer *renderer, const camber_pass *pass, camber_fill_place *place) {
    const pattern_use use = use_of_fill(pass);
    bool full = false;
    place->size_px[0] = (float)use.width_px;
    place->size_px[1] = (float)use.height_px;
    camber_status status = find_place(renderer, pass, use, place->place, &full);
    if (status == CAMBER_OK)
        status = find_place(renderer, pass, mean_of_fill(pass), place->mean, &full);
    assert(!full);
    return status;
}

void camber_patterns_bind(camber_renderer *renderer) {
    const camber_gl *gl = &renderer->share.surface->gl;
    gl->ActiveTexture(GL_TEXTURE0 + CAMBER_PATTERNS_UNIT);
    gl->BindTexture(GL_TEXTURE_2D, renderer->patterns.texture);
    gl->ActiveTexture(GL_TEXTURE0);
}

void camber_patterns_begin(camber_renderer *renderer, const camber_piece *piece) {
    const double cosine = (double)piece->eye[2], fall = (double)piece->eye[3];
    renderer->patterns.hashed = NULL;
    renderer->patterns.hashed_count = 0;
    renderer->patterns.nearest = piece->pitched ? (cosine + fall * (double)piece->eye[1]) / cosine : 1.0;
}

void camber_patterns_release(camber_renderer *renderer, bool is_current) {
    camber_context *context = renderer->share.device->context;
    if (is_current)
        renderer->share.surface->gl.DeleteTextures(1, &renderer->patterns.texture);
    camber_free(context, renderer->patterns.hashes);
    camber_free(context, renderer->patterns.placed);
    renderer->patterns = (camber_patterns){0};
}
