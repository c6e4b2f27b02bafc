/* The atlas: images that lines and fills are drawn with, side by side in one texture. Images are kept from frame to
 * frame, and found again by a hash of their pixels. If there is no room for all images of a command, the atlas is
 * emptied, and enlarged if possible. */
#include "draw/renderer.h"

#include <assert.h>
#include <string.h>

enum { TEXTURE_WIDTH = 2048, FIRST_HEIGHT = 256, LAST_HEIGHT = 4096 };
_Static_assert(CAMBER_IMAGE_TEXELS_MAX + 2 == TEXTURE_WIDTH, "the widest image has a shelf of its own");

/* ---- The texture ---- */

static camber_status upload(camber_renderer *renderer, const camber_image *image, const camber_atlas_image *placed) {
    camber_context *context = renderer->share.device->context;
    const camber_gl *gl = &renderer->share.surface->gl;
    const size_t width = (size_t)placed->size.width + 2, height = (size_t)placed->size.height + 2;
    uint8_t *texels = camber_alloc(context, width * height, 4);
    const camber_status status =
        texels ? camber_image_shrink(context, image, placed->size, texels) : CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK) {
        gl->BindTexture(GL_TEXTURE_2D, renderer->gl.atlas.texture);
        gl->TexSubImage2D(GL_TEXTURE_2D, 0, placed->x - 1, placed->y - 1, (GLsizei)width, (GLsizei)height, GL_RGBA,
                          GL_UNSIGNED_BYTE, texels);
    }
    camber_free(context, texels);
    return status;
}

static GLsizei largest_height(const camber_renderer *renderer) {
    const uint32_t side = renderer->share.surface->info.largest_target_px;
    return side < LAST_HEIGHT ? (GLsizei)side : LAST_HEIGHT;
}

/* Empties the atlas, and enlarges its texture if possible. */
static camber_status empty_atlas(camber_renderer *renderer) {
    camber_atlas *atlas = &renderer->gl.atlas;
    const camber_gl *gl = &renderer->share.surface->gl;
    const GLsizei largest = largest_height(renderer), twice = 2 * atlas->height;
    const GLsizei height = !atlas->texture ? FIRST_HEIGHT : twice < largest ? twice : largest;
    atlas->count = 0;
    atlas->shelf_x = atlas->shelf_y = atlas->shelf_height = 0;
    if (atlas->texture && atlas->height == height)
        return CAMBER_OK;
    gl->DeleteTextures(1, &atlas->texture);
    gl->GenTextures(1, &atlas->texture);
    gl->BindTexture(GL_TEXTURE_2D, atlas->texture);
    gl->TexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, TEXTURE_WIDTH, height);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    atlas->height = height;
    const camber_status status = camber_gl_check(renderer, "the texture of patterns");
    if (status != CAMBER_OK) {
        gl->DeleteTextures(1, &atlas->texture);
        atlas->texture = 0;
    }
    return status;
}

/* Takes room for an image next to the last one, or on a shelf above. Returns false if neither has room. */
static bool take_room(camber_atlas *atlas, camber_atlas_image *placed) {
    const GLint width = (GLint)placed->size.width + 2, height = (GLint)placed->size.height + 2;
    if (atlas->shelf_x + width > TEXTURE_WIDTH) {
        atlas->shelf_y += atlas->shelf_height;
        atlas->shelf_x = atlas->shelf_height = 0;
    }
    if (!atlas->texture || atlas->shelf_y + height > atlas->height)
        return false;
    placed->x = atlas->shelf_x + 1;
    placed->y = atlas->shelf_y + 1;
    atlas->shelf_x += width;
    atlas->shelf_height = height > atlas->shelf_height ? height : atlas->shelf_height;
    return true;
}

/* ---- Images ---- */

/* The same pointer may later refer to another image, so the hash covers the pixels. */
static uint64_t hash_of(const camber_image *image) {
    uint64_t hash = camber_hash(CAMBER_HASH_START, &image->width, sizeof image->width);
    for (uint32_t y = 0; y < image->height; y++)
        hash = camber_hash(hash, camber_image_row(image, y), 4 * (size_t)image->width);
    return hash;
}

/* Hashes each image of a frame once. */
static uint64_t hash_of_use(camber_atlas *atlas, const camber_image_use *use) {
    uint64_t *hash = atlas->hashes + use->number;
    assert(use->number < atlas->hash_count);
    if (!*hash)
        *hash = hash_of(use->image) | 1;
    return *hash;
}

static const camber_atlas_image *find(const camber_atlas *atlas, uint64_t hash, camber_image_size size) {
    for (size_t i = 0; i < atlas->count; i++) {
        const camber_atlas_image *placed = atlas->images + i;
        if (placed->hash == hash && placed->size.width == size.width && placed->size.height == size.height &&
            placed->size.tiled == size.tiled)
            return placed;
    }
    return NULL;
}

static camber_status add(camber_renderer *renderer, const camber_image *image, camber_atlas_image *placed,
                         bool *is_full) {
    camber_atlas *atlas = &renderer->gl.atlas;
    if (!atlas->texture) {
        const camber_status status = empty_atlas(renderer);
        if (status != CAMBER_OK)
            return status;
    }
    if (!take_room(atlas, placed)) {
        *is_full = true;
        return CAMBER_OK;
    }
    if (!camber_grow(renderer->share.device->context, &atlas->images, &atlas->capacity, atlas->count + 1,
                     sizeof *atlas->images))
        return CAMBER_ERROR_MEMORY;
    const camber_status status = upload(renderer, image, placed);
    if (status == CAMBER_OK)
        atlas->images[atlas->count++] = *placed;
    return status;
}

/* Returns the rectangle of an image, after adding it if the atlas does not have it. */
static camber_status find_or_add(camber_renderer *renderer, const camber_image_use *use, float rect[4], bool *is_full) {
    camber_atlas *atlas = &renderer->gl.atlas;
    const camber_image_size size = camber_image_texels(use, renderer->list.view.nearest);
    camber_atlas_image wanted = {.hash = hash_of_use(atlas, use), .size = size};
    const camber_atlas_image *found = find(atlas, wanted.hash, size);
    if (!found) {
        const camber_status status = add(renderer, use->image, &wanted, is_full);
        if (status != CAMBER_OK || *is_full)
            return status;
        found = &wanted;
    }
    const float width = (float)TEXTURE_WIDTH, height = (float)atlas->height;
    rect[0] = (float)found->x / width;
    rect[1] = (float)found->y / height;
    rect[2] = (float)found->size.width / width;
    rect[3] = (float)found->size.height / height;
    return CAMBER_OK;
}

camber_status camber_atlas_find(camber_renderer *renderer, const camber_image_use *use, float rect[4]) {
    bool is_full = false;
    const camber_status status = find_or_add(renderer, use, rect, &is_full);
    assert(!is_full);
    return status;
}

/* ---- Commands ---- */

camber_status camber_atlas_hold(camber_renderer *renderer, const camber_draw_command *command, bool *is_full) {
    const camber_draw_list *list = &renderer->list;
    const camber_row_paint *rows = list->rows + command->first_row;
    float rect[4];
    camber_status status = CAMBER_OK;
    *is_full = false;
    if (!command->mesh) {
        status = find_or_add(renderer, list->image_uses + command->fill.image_use, rect, is_full);
        return status == CAMBER_OK && !*is_full
                   ? find_or_add(renderer, list->image_uses + command->fill.mean_use, rect, is_full)
                   : status;
    }
    for (size_t i = 0; i < command->mesh->row_count && status == CAMBER_OK && !*is_full; i++)
        if (rows[i].half_width_px >= 0.0f && rows[i].features & CAMBER_FEATURE_IMAGE)
            status = find_or_add(renderer, list->image_uses + rows[i].image_use, rect, is_full);
    return status;
}

camber_status camber_atlas_renew(camber_renderer *renderer, const camber_draw_command *command) {
    bool is_full = true;
    camber_status status = CAMBER_OK;
    while (status == CAMBER_OK && is_full) {
        const bool is_largest = renderer->gl.atlas.height == largest_height(renderer);
        status = empty_atlas(renderer);
        if (status == CAMBER_OK)
            status = camber_atlas_hold(renderer, command, &is_full);
        if (status == CAMBER_OK && is_full && is_largest)
            return camber_fail(renderer->share.device->context, CAMBER_ERROR_LIMIT,
                               "the images of a pass take more than %d x %d px; draw fewer images in fewer sizes",
                               (int)TEXTURE_WIDTH, (int)renderer->gl.atlas.height);
    }
    return status;
}

void camber_atlas_bind(camber_renderer *renderer) {
    const camber_gl *gl = &renderer->share.surface->gl;
    gl->ActiveTexture(GL_TEXTURE0 + CAMBER_ATLAS_UNIT);
    gl->BindTexture(GL_TEXTURE_2D, renderer->gl.atlas.texture);
    gl->ActiveTexture(GL_TEXTURE0);
}

camber_status camber_atlas_begin(camber_renderer *renderer) {
    camber_atlas *atlas = &renderer->gl.atlas;
    const size_t count = renderer->list.use_count ? renderer->list.images.count : 0;
    if (!camber_grow(renderer->share.device->context, &atlas->hashes, &atlas->hash_capacity, count,
                     sizeof *atlas->hashes))
        return CAMBER_ERROR_MEMORY;
    if (count)
        memset(atlas->hashes, 0, count * sizeof *atlas->hashes);
    atlas->hash_count = count;
    return CAMBER_OK;
}

void camber_atlas_release(camber_renderer *renderer, bool is_current) {
    camber_context *context = renderer->share.device->context;
    camber_atlas *atlas = &renderer->gl.atlas;
    if (is_current)
        renderer->share.surface->gl.DeleteTextures(1, &atlas->texture);
    camber_free(context, atlas->hashes);
    camber_free(context, atlas->images);
    *atlas = (camber_atlas){0};
}
