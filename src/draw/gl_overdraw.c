/* Counts overdraw on the GPU: all fragments, and the pixels that a range of indices covers once and more than once.
 *
 * Every fragment adds 1/255 to an 8-bit channel, which stays at 255 when it is full. If a pixel shows 255, too much was
 * drawn before the counts were read, and the same triangles are drawn again in smaller steps. So no count is lost, and
 * no extension is needed.
 *
 * A range takes two draw calls, which use the stencil. The stencil is 0 before them:
 *   cover    if it is 0, adds 1 to the drawn pixels; each fragment with coverage then adds 1 to the stencil
 *   repeat   if it is 2 or more, adds 1 to the repeated pixels; the stencil is then set back to 0
 * So only the first fragment of a pixel passes. */
#include "draw/renderer.h"
#include "vertices/vertices.h"

#include <assert.h>
#include <string.h>

enum {
    SIDE_MAX_PX = 65535,
    AREA_SIDE_PX = 2048,
    FULL = 255,            /* a channel */
    INDICES_MAX = 3 << 28, /* of a draw call: fits into a signed 32-bit number, has whole triangles, and is even */
    INDICES_LEAST = 252,   /* the same, and no pixel can be full after so few */
    COVERED = 0,
    EVERY = 1, /* the channels that stroke.frag and count.frag add to */
};

typedef struct counting {
    camber_renderer *renderer;
    const camber_overdraw_desc *desc;
    const camber_index_range *ranges; /* each is counted separately */
    size_t range_count;
    const camber_index_range
        *drawn; /* the same indices, to count all ranges together; a single range if it is the whole mesh */
    size_t drawn_count;
    const camber_shader *raster, *every;
    camber_gl_area area;
    const camber_mesh_part *bound; /* NULL: none */
    camber_status status;          /* status of binding a part */
    uint8_t *pixels;               /* RGBA8 of an area */
    camber_overdraw sum;
} counting;

static const camber_gl *gl_of(const counting *c) {
    return &c->renderer->share.surface->gl;
}

/* ---- Ranges ---- */

/* Returns how many indices the next triangle of a strip shares with the previous one. */
static uint64_t shared_indices(const camber_mesh *mesh) {
    return mesh->mesh_info.strips ? 2 : 0;
}

static camber_mesh_part *part_of(const camber_mesh *mesh, uint64_t index) {
    size_t low = 0, high = mesh->part_count;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (mesh->parts[middle].first_index <= index)
            low = middle;
        else
            high = middle;
    }
    return mesh->parts + low;
}

/* Issues a draw call for as much of a range as is in one part and is not too long. */
static void draw_range(counting *c, camber_index_range range) {
    camber_mesh *mesh = c->desc->mesh;
    const uint64_t shared = shared_indices(mesh);
    while (range.index_count > shared && c->status == CAMBER_OK) {
        camber_mesh_part *part = part_of(mesh, range.first_index);
        const uint64_t first = range.first_index - part->first_index, left = part->index_count - first;
        uint64_t count = range.index_count < INDICES_MAX ? range.index_count : INDICES_MAX;
        count = count < left ? count : left;
        if (part != c->bound) {
            c->status = camber_part_ensure_output(mesh, part);
            if (c->status != CAMBER_OK)
                return;
            camber_gl_bind_part(c->renderer, part);
        }
        c->bound = part;
        camber_gl_draw_indices(c->renderer, mesh, first, count);
        const uint64_t done = count < left ? count - shared : count; /* no triangle is in two parts */
        range.first_index += done;
        range.index_count -= done;
    }
}

static camber_status check_ranges(const counting *c) {
    const camber_mesh_info *info = &c->desc->mesh->mesh_info;
    for (size_t i = 0; i < c->range_count; i++) {
        const camber_index_range r = c->ranges[i];
        const bool inside = r.first_index <= info->index_count && r.index_count <= info->index_count - r.first_index;
        const bool whole = info->strips ? r.first_index % 2 == 0 : r.first_index % 3 == 0 && r.index_count % 3 == 0;
        if (!inside || !whole)
            return camber_fail(c->renderer->share.device->context, CAMBER_ERROR_ARGUMENT,
                               "range %zu: %llu indices from %llu on; the mesh has %zu, %s", i,
                               (unsigned long long)r.index_count, (unsigned long long)r.first_index, info->index_count,
                               info->strips ? "and strips begin at even ones" : "three a triangle");
    }
    return CAMBER_OK;
}

/* Lists the ranges of the polylines that are drawn, and all of them as one. */
static camber_status list_polylines(counting *c, camber_index_range **list) {
    camber_mesh *mesh = c->desc->mesh;
    camber_index_range *ranges =
        camber_alloc(c->renderer->share.device->context, mesh->polyline_count + 1, sizeof *ranges);
    if (!ranges)
        return CAMBER_ERROR_MEMORY;
    uint64_t first = 0, next;
    size_t count = 0;
    camber_status status = camber_mesh_first_index(mesh, 0, &first);
    for (size_t i = 0; i < mesh->polyline_count && status == CAMBER_OK; i++, first = next) {
        status = camber_mesh_first_index(mesh, i + 1, &next);
        const uint32_t row = mesh->polyline_rows[i];
        const bool drawn = row < c->desc->paint_count && c->desc->paints[row].width_px > 0.0f;
        if (status == CAMBER_OK && drawn && next > first)
            ranges[count++] = (camber_index_range){first, next - first};
    }
    if (status != CAMBER_OK) {
        camber_free(c->renderer->share.device->context, ranges);
        return status;
    }
    *list = ranges;
    ranges[mesh->polyline_count] = (camber_index_range){0, mesh->mesh_info.index_count};
    c->ranges = ranges;
    c->range_count = count;
    c->drawn = ranges + mesh->polyline_count;
    c->drawn_count = 1;
    return CAMBER_OK;
}

/* ---- Fragments ---- */

/* A position in the drawn ranges: an index within one of them. */
typedef struct cursor {
    size_t range;
    uint64_t index;
} cursor;

/* Draws the triangles that end with one of the next indices, and returns where it stopped. It draws at most `indices`
 * indices. */
static cursor draw_some(counting *c, cursor at, uint64_t indices) {
    const uint64_t shared = shared_indices(c->desc->mesh);
    while (at.range < c->drawn_count && indices > 0) {
        const camber_index_range range = c->drawn[at.range];
        const uint64_t left = range.index_count - at.index, count = left < indices ? left : indices;
        const uint64_t back = at.index < shared ? at.index : shared;
        draw_range(c, (camber_index_range){range.first_index + at.index - back, count + back});
        indices -= count;
        at.index += count;
        if (at.index == range.index_count)
            at = (cursor){at.range + 1, 0};
    }
    return at;
}

/* Reads the counts of an area back: the sums of both channels, and the highest value in either. */
static camber_status read_counts(counting *c, uint64_t sums[2], int *highest) {
    const size_t count = (size_t)c->area.width * c->area.height;
    gl_of(c)->ReadPixels(0, 0, (GLsizei)c->area.width, (GLsizei)c->area.height, GL_RGBA, GL_UNSIGNED_BYTE, c->pixels);
    uint64_t covered = 0, every = 0;
    int most = 0;
    for (size_t i = 0; i < count; i++) {
        const int a = c->pixels[4 * i + COVERED], b = c->pixels[4 * i + EVERY];
        covered += (unsigned)a;
        every += (unsigned)b;
        most = a > most ? a : most;
        most = b > most ? b : most;
    }
    sums[COVERED] = covered;
    sums[EVERY] = every;
    *highest = most;
    return c->status == CAMBER_OK ? camber_gl_check(c->renderer, "counting") : c->status;
}

static camber_status count_fragments(counting *c) {
    const camber_gl *gl = gl_of(c);
    uint64_t batch = INDICES_MAX;
    gl->UseProgram(c->every->program);
    for (cursor at = {0, 0}; at.range < c->drawn_count;) {
        uint64_t sums[2];
        int highest;
        gl->Clear(GL_COLOR_BUFFER_BIT);
        const cursor end = draw_some(c, at, batch);
        const camber_status status = read_counts(c, sums, &highest);
        if (status != CAMBER_OK)
            return status;
        if (highest == FULL && batch > INDICES_LEAST) {
            batch = batch / 12 * 6;
            batch = batch < INDICES_LEAST ? INDICES_LEAST : batch;
            continue;
        }
        c->sum.fragments += sums[EVERY];
        at = end;
        batch = batch < INDICES_MAX / 2 ? 2 * batch : INDICES_MAX;
    }
    return CAMBER_OK;
}

/* ---- Pixels drawn once and more than once ---- */

static void cover_and_repeat(counting *c, size_t first, size_t count) {
    const camber_gl *gl = gl_of(c);
    for (size_t i = first; i < first + count; i++) {
        gl->UseProgram(c->raster->program);
        gl->StencilFunc(GL_EQUAL, 0, 0xff);
        gl->StencilOp(GL_INCR, GL_INCR, GL_INCR);
        draw_range(c, c->ranges[i]);
        gl->UseProgram(c->every->program);
        gl->StencilFunc(GL_LEQUAL, 2, 0xff);
        gl->StencilOp(GL_ZERO, GL_ZERO, GL_ZERO);
        draw_range(c, c->ranges[i]);
    }
}

static void add_to_map(const counting *c) {
    const camber_gl_area *area = &c->area;
    for (uint32_t y = 0; y < area->height; y++) {
        uint8_t *row = c->desc->map + (size_t)(area->y + y) * c->desc->width + area->x;
        const uint8_t *counts = c->pixels + 4 * (size_t)y * area->width + EVERY;
        for (uint32_t x = 0; x < area->width; x++) {
            const int sum = row[x] + counts[4 * (size_t)x];
            row[x] = (uint8_t)(sum < 255 ? sum : 255);
        }
    }
}

static camber_status count_pixels(counting *c) {
    const camber_gl *gl = gl_of(c);
    size_t batch = c->range_count;
    camber_status status = CAMBER_OK;
    gl->Enable(GL_STENCIL_TEST);
    for (size_t first = 0; first < c->range_count;) {
        uint64_t sums[2];
        int highest;
        const size_t left = c->range_count - first, count = left < batch ? left : batch;
        gl->Clear(GL_COLOR_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
        cover_and_repeat(c, first, count);
        status = read_counts(c, sums, &highest);
        if (status != CAMBER_OK)
            break;
        if (highest == FULL && count > FULL) {
            batch = count / 2 < FULL ? FULL : count / 2;
            continue;
        }
        c->sum.drawn_pixels += sums[COVERED];
        c->sum.repeated_pixels += sums[EVERY];
        if (c->desc->map)
            add_to_map(c);
        first += count;
        batch = 2 * count;
    }
    gl->Disable(GL_STENCIL_TEST);
    return status;
}

/* ---- Areas ---- */

static camber_status count_area(counting *c) {
    camber_status status =
        camber_target_bind(c->renderer, CAMBER_TARGET_COUNTS, (GLsizei)c->area.width, (GLsizei)c->area.height);
    if (status != CAMBER_OK)
        return status;
    c->bound = NULL; /* the target's texture is now bound instead of the rows */
    camber_gl_use_shader(c->renderer, c->raster, c->desc->mesh, &c->area);
    camber_gl_use_shader(c->renderer, c->every, c->desc->mesh, &c->area);
    status = count_fragments(c);
    return status == CAMBER_OK ? count_pixels(c) : status;
}

static camber_status count_areas(counting *c) {
    const camber_overdraw_desc *desc = c->desc;
    const uint32_t largest = c->renderer->share.surface->info.largest_target_px;
    const uint32_t side = largest < AREA_SIDE_PX ? largest : AREA_SIDE_PX;
    const uint32_t widest = desc->width < side ? desc->width : side,
                   tallest = desc->height < side ? desc->height : side;
    camber_context *context = c->renderer->share.device->context;
    camber_status status = CAMBER_OK;
    c->pixels = camber_alloc(context, (size_t)widest * tallest, 4);
    if (!c->pixels)
        return CAMBER_ERROR_MEMORY;
    for (uint32_t y = 0; y < desc->height && status == CAMBER_OK; y += tallest) {
        for (uint32_t x = 0; x < desc->width && status == CAMBER_OK; x += widest) {
            c->area = (camber_gl_area){.x = x,
                                       .y = y,
                                       .width = desc->width - x < widest ? desc->width - x : widest,
                                       .height = desc->height - y < tallest ? desc->height - y : tallest};
            status = count_area(c);
        }
        camber_progress(context, "counting", (double)(y + c->area.height) / desc->height);
    }
    camber_free(context, c->pixels);
    return status;
}

static camber_status prepare(counting *c, camber_index_range **list) {
    const camber_overdraw_desc *desc = c->desc;
    const camber_gl *gl = gl_of(c);
    camber_status status = desc->ranges ? check_ranges(c) : list_polylines(c, list);
    if (status == CAMBER_OK)
        status = camber_rows_upload_widths(c->renderer, desc->mesh, desc->paints, desc->paint_count);
    if (status == CAMBER_OK)
        status = camber_gl_stroke_shader(c->renderer, desc->mesh, 0.0f, CAMBER_VARIANT_COUNT, &c->raster);
    if (status == CAMBER_OK)
        status = camber_shaders_count(&c->renderer->gl.shaders, desc->mesh->mesh_info.method, &c->every);
    if (status != CAMBER_OK)
        return status;
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE);
    gl->Disable(GL_DITHER);
    gl->ClearColor(0, 0, 0, 0);
    return CAMBER_OK;
}

camber_status camber_renderer_count_overdraw(camber_renderer *renderer, const camber_overdraw_desc *desc,
                                             camber_overdraw *overdraw) {
    camber_context *context = renderer->share.device->context;
    assert(desc->mesh->owner == renderer);
    assert(desc->paint_count == 0 || desc->paints);
    if (renderer->raster)
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "overdraw is counted by GL; open the renderer with a surface");
    if (desc->width < 1 || desc->width > SIDE_MAX_PX || desc->height < 1 || desc->height > SIDE_MAX_PX)
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "a picture of %u x %u px; each side must be 1 to %d",
                           desc->width, desc->height, SIDE_MAX_PX);
    if (desc->map)
        memset(desc->map, 0, (size_t)desc->width * desc->height);
    counting c = {.renderer = renderer,
                  .desc = desc,
                  .ranges = desc->ranges,
                  .range_count = desc->range_count,
                  .drawn = desc->ranges,
                  .drawn_count = desc->range_count};
    camber_index_range *list = NULL;
    camber_status status = CAMBER_OK;
    if (!desc->mesh->empty) {
        status = camber_surface_make_current(renderer->share.surface);
        if (status != CAMBER_OK)
            return status;
        renderer->share.frames_begun++; /* the buffers that it reads must not change before it is done */
        status = prepare(&c, &list);
        if (status == CAMBER_OK)
            status = count_areas(&c);
        renderer->share.surface->gl.BindVertexArray(0);
        camber_free(context, list);
    }
    if (status == CAMBER_OK)
        *overdraw = c.sum;
    else
        camber_surface_forget_errors(renderer->share.surface);
    return status;
}
