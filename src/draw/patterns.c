/* Images that rows and fills are drawn with, side by side in one texture. */
#include "draw/renderer.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum { TEXTURE_WIDTH = 2048, FIRST_HEIGHT = 256, LAST_HEIGHT = 4096 };
_Static_assert(CAMBER_TEXELS_SIDE_MAX + 2 == TEXTURE_WIDTH, "the widest image has a shelf of its own");

/* ---- The texture ---- */

static camber_status upload(camber_renderer *renderer, const camber_image *image, const camber_placed *placed) {
    camber_context *context = renderer->share.device->context;
    const camber_gl *gl = &renderer->share.surface->gl;
    const size_t width = (size_t)placed->width + 2, height = (size_t)placed->height + 2;
    uint8_t *texels = camber_alloc(context, width * height, 4);
    const camber_texels size = {placed->width, placed->height, placed->tiled};
    const camber_status status = texels ? camber_image_shrink(context, image, size, texels) : CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK) {
        gl->BindTexture(GL_TEXTURE_2D, renderer->patterns.texture);
        gl->TexSubImage2D(GL_TEXTURE_2D, 0, placed->x - 1, placed->y - 1, (GLsizei)width, (GLsizei)height, GL_RGBA,
                          GL_UNSIGNED_BYTE, texels);
    }
    camber_free(context, texels);
    return status;
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
        hash = camber_hash(hash, camber_image_row(image, y), 4 * (size_t)image->width);
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
static camber_status find_place(camber_renderer *renderer, const camber_pass *pass, camber_image_use use,
                                float texel[4], bool *full) {
    const camber_image *image = pass->images + use.pattern - 1;
    const camber_texels size = camber_image_texels(image, &use, renderer->patterns.nearest);
    camber_placed wanted = {.width = size.width, .height = size.height, .tiled = size.tiled};
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
    const camber_image_use use = camber_image_use_of_paint(pass, paint);
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
    if (pass->kind == CAMBER_PASS_FILL) {
        status = find_place(renderer, pass, camber_image_use_of_fill(pass), texels, full);
        return status == CAMBER_OK && !*full ? find_place(renderer, pass, camber_image_mean_of_fill(pass), texels, full)
                                             : status;
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
    const camber_image_use use = camber_image_use_of_fill(pass);
    bool full = false;
    place->size_px[0] = (float)use.width_px;
    place->size_px[1] = (float)use.height_px;
    camber_status status = find_place(renderer, pass, use, place->place, &full);
    if (status == CAMBER_OK)
        status = find_place(renderer, pass, camber_image_mean_of_fill(pass), place->mean, &full);
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
