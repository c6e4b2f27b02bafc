/* shape -> count -> total -> fill -> cover on a device, an area of the picture at a time. */
#include "cover/cover.h"

#include <assert.h>
#include <string.h>

enum {
    BUFFER_FILL, /* camber_fill_records */
    BUFFER_ROWS,
    BUFFER_INKS,
    BUFFER_MORE,
    BUFFER_TAIL,
    BUFFER_SHAPES,
    BUFFER_BOXES,
    BUFFER_MEASURES,
    BUFFER_COUNTS,
    BUFFER_TOTALS,
    BUFFER_STARTS,
    BUFFER_LISTS,
    BUFFER_ITEMS,
    BUFFER_PIXELS,
    BUFFERS
};

/* Segments a chunk, at least; chunks, at most: each has a count of every tile. A tile with more segments than HEAVY is
 * drawn by as many work-items as it has rows of cells. */
enum { CHUNK = 8192, CHUNKS_MAX = 64, HEAVY = 2048 };
/* What lists may take: where they would take more, rows of tiles are drawn by halves. */
static const uint64_t LISTS_BYTES = 256 * 1024 * 1024;

enum { STAGE_SHAPE, STAGE_COUNT, STAGE_TOTAL, STAGE_FILL, STAGE_COVER, STAGES };
static const char *const stage_names[STAGES] = {"shape", "count", "total", "fill", "cover"};

struct camber_cover {
    camber_device *device;
    camber_program *program; /* of the variant */
    unsigned variant;        /* of what was drawn last */
    cl_mem buffers[BUFFERS];
    size_t capacities[BUFFERS];
    uint32_t *starts, *items; /* of the host */
    size_t start_capacity, item_capacity;
    camber_cover_area area; /* drawn last */
    cl_mem given;           /* where its pixels are, if not in a buffer of its own */
    camber_cover_area band; /* of it: whole rows of tiles, as many as there is room for lists */
    uint32_t columns;       /* tiles */
    size_t shape_count, tile_count;
    double ms[STAGES];
};

/* As count and fill read them. */
typedef struct chunks {
    uint32_t shape_count, a_chunk, columns, tiles;
    float left, top;
} chunks;

/* As cover reads it. */
typedef struct sheet {
    float left, top;
    uint32_t columns, stride;
    float background[4];
    uint32_t above; /* rows of pixels before these */
} sheet;

camber_status camber_cover_create(camber_device *device, camber_cover **cover) {
    camber_cover *made = camber_alloc_zero(device->context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->device = device;
    *cover = made;
    return CAMBER_OK;
}

void camber_cover_destroy(camber_cover *cover) {
    if (!cover)
        return;
    for (int i = 0; i < BUFFERS; i++)
        if (cover->buffers[i])
            clReleaseMemObject(cover->buffers[i]);
    camber_free(cover->device->context, cover->items);
    camber_free(cover->device->context, cover->starts);
    camber_free(cover->device->context, cover);
}

camber_cover_times camber_cover_get_times(const camber_cover *cover) {
    return (camber_cover_times){cover->ms[STAGE_SHAPE], cover->ms[STAGE_COUNT], cover->ms[STAGE_TOTAL],
                                cover->ms[STAGE_FILL], cover->ms[STAGE_COVER]};
}

/* ---- Buffers ---- */

static camber_status reserve(camber_cover *cover, int which, size_t size_bytes) {
    const camber_device *device = cover->device;
    if (size_bytes <= cover->capacities[which])
        return CAMBER_OK;
    if (size_bytes > device->info.largest_buffer_bytes)
        return camber_fail(device->context, CAMBER_ERROR_LIMIT,
                           "drawing takes a buffer of %zu bytes, and %s makes none above %llu; draw less at once",
                           size_bytes, device->info.name, (unsigned long long)device->info.largest_buffer_bytes);
    if (cover->buffers[which])
        clReleaseMemObject(cover->buffers[which]);
    cover->buffers[which] = NULL;
    cover->capacities[which] = 0;
    const size_t more = size_bytes + size_bytes / 4,
                 room = more < device->info.largest_buffer_bytes ? more : size_bytes;
    const cl_mem_flags flags = CL_MEM_READ_WRITE | (which == BUFFER_PIXELS ? CL_MEM_ALLOC_HOST_PTR : 0);
    cl_int code;
    cover->buffers[which] = clCreateBuffer(device->cl, flags, room, NULL, &code);
    if (code != CL_SUCCESS) {
        cover->buffers[which] = NULL;
        return camber_fail_cl(device->context, "clCreateBuffer", code);
    }
    cover->capacities[which] = room;
    return CAMBER_OK;
}

static camber_status put(camber_cover *cover, int which, const void *bytes, size_t size_bytes) {
    const camber_status status = reserve(cover, which, size_bytes);
    return status == CAMBER_OK ? camber_write_buffer(cover->device, cover->buffers[which], 0, size_bytes, bytes)
                               : status;
}

/* ---- Stages ---- */

typedef struct argument {
    size_t size_bytes;
    const void *value;
} argument;

#define BUFFER(which)                                                                                                  \
    { sizeof(cl_mem), cover->buffers + (which) }
#define VALUE(value)                                                                                                   \
    { sizeof(value), &(value) }

/* count work-items from the first one on, each a work-group. */
static camber_status run(camber_cover *cover, int stage, const argument *arguments, cl_uint argument_count,
                         const size_t from_count[2]) {
    const camber_device *device = cover->device;
    const cl_kernel kernels[STAGES] = {cover->program->shape, cover->program->count, cover->program->total,
                                       cover->program->fill, cover->program->cover};
    const size_t one = 1;
    cl_event event = NULL;
    if (from_count[1] == 0)
        return CAMBER_OK;
    for (cl_uint i = 0; i < argument_count; i++) {
        const cl_int code = clSetKernelArg(kernels[stage], i, arguments[i].size_bytes, arguments[i].value);
        if (code != CL_SUCCESS)
            return camber_fail_stage(device, "clSetKernelArg", stage_names[stage], code);
    }
    cl_int code =
        clEnqueueNDRangeKernel(device->queue, kernels[stage], 1, from_count, from_count + 1, &one, 0, NULL, &event);
    if (code != CL_SUCCESS)
        return camber_fail_stage(device, "clEnqueueNDRangeKernel", stage_names[stage], code);
    code = clWaitForEvents(1, &event);
    camber_add_ms(event, cover->ms + stage);
    return code == CL_SUCCESS ? CAMBER_OK : camber_fail_stage(device, "clWaitForEvents", stage_names[stage], code);
}

static camber_status make_shapes(camber_cover *cover, const camber_cover_scene *scene, const camber_cover_piece *pieces,
                                 size_t piece_count) {
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < piece_count && status == CAMBER_OK; i++) {
        camber_mesh *mesh = pieces[i].mesh;
        camber_mesh_part *part = mesh ? mesh->parts + pieces[i].part : NULL;
        const camber_shape_range range = camber_cover_range(scene, pieces + i, &cover->band);
        status = part ? camber_part_use(mesh, part) : CAMBER_OK;
        if (status != CAMBER_OK)
            break;
        const cl_mem *records = part ? &part->buffers[CAMBER_BUFFER_RECORDS].mem : cover->buffers + BUFFER_FILL;
        const argument arguments[] = {{sizeof(cl_mem), records}, BUFFER(BUFFER_ROWS), BUFFER(BUFFER_SHAPES),
                                      BUFFER(BUFFER_BOXES),      VALUE(range),        BUFFER(BUFFER_MEASURES)};
        const size_t items[2] = {0, (pieces[i].end - pieces[i].first + 15) / 16};
        status = run(cover, STAGE_SHAPE, arguments, cover->variant ? 6 : 5, items);
    }
    return status;
}

static chunks cut_chunks(const camber_cover *cover, uint32_t *chunk_count) {
    const camber_cover_area *area = &cover->band;
    const size_t tiles = (cover->tile_count + 15) / 16 * 16,
                 most = cover->device->info.largest_buffer_bytes / (4 * tiles);
    const size_t wanted = (cover->shape_count + CHUNK - 1) / CHUNK, bound = most < CHUNKS_MAX ? most : CHUNKS_MAX;
    const size_t count = wanted < bound || bound == 0 ? wanted : bound;
    const size_t a_chunk = count ? (cover->shape_count + count - 1) / count : 0;
    *chunk_count = (uint32_t)count;
    return (chunks){(uint32_t)cover->shape_count,
                    (uint32_t)a_chunk,
                    camber_cover_tiles(area->width),
                    (uint32_t)tiles,
                    (float)area->x,
                    (float)area->y};
}

static camber_status count_tiles(camber_cover *cover, chunks c, uint32_t chunk_count) {
    camber_status status = reserve(cover, BUFFER_COUNTS, 4 * (size_t)c.tiles * (chunk_count ? chunk_count : 1));
    if (status == CAMBER_OK)
        status = reserve(cover, BUFFER_TOTALS, 4 * (size_t)c.tiles);
    const argument count[] = {BUFFER(BUFFER_SHAPES), BUFFER(BUFFER_BOXES), BUFFER(BUFFER_COUNTS), VALUE(c)};
    const argument total[] = {BUFFER(BUFFER_COUNTS), BUFFER(BUFFER_TOTALS), VALUE(c.tiles), VALUE(chunk_count)};
    if (status == CAMBER_OK)
        status = run(cover, STAGE_COUNT, count, 4, (size_t[]){0, chunk_count});
    if (status == CAMBER_OK)
        status = run(cover, STAGE_TOTAL, total, 4, (size_t[]){0, c.tiles / 16});
    return status;
}

static uint64_t lists_limit(const camber_device *device) {
    const uint64_t largest = device->info.largest_buffer_bytes, share = camber_device_share(device, 1);
    const uint64_t least = share < LISTS_BYTES ? share : LISTS_BYTES;
    return (largest < least ? largest : least) / 4;
}

/* The host's part of the scan: where each tile's list begins. *fits is false where they take too much for a band that
 * can be halved. */
static camber_status start_lists(camber_cover *cover, bool *fits) {
    const camber_device *device = cover->device;
    const size_t tiles = cover->tile_count;
    uint64_t sum = 0;
    cl_int code;
    if (!camber_grow(device->context, &cover->starts, &cover->start_capacity, tiles + 1, sizeof *cover->starts))
        return CAMBER_ERROR_MEMORY;
    cl_uint *totals = clEnqueueMapBuffer(device->queue, cover->buffers[BUFFER_TOTALS], CL_TRUE, CL_MAP_READ, 0,
                                         4 * tiles, 0, NULL, NULL, &code);
    if (code != CL_SUCCESS)
        return camber_fail_cl(device->context, "clEnqueueMapBuffer", code);
    for (size_t i = 0; i < tiles; i++) {
        cover->starts[i] = (uint32_t)sum;
        sum += totals[i];
    }
    cover->starts[tiles] = (uint32_t)sum;
    clEnqueueUnmapMemObject(device->queue, cover->buffers[BUFFER_TOTALS], totals, 0, NULL, NULL);
    *fits = sum <= lists_limit(device) || cover->band.height <= CAMBER_TILE_PX;
    if (!*fits)
        return CAMBER_OK;
    if (sum > UINT32_MAX)
        return camber_fail(device->context, CAMBER_ERROR_LIMIT, "%llu segments in tiles; draw less at once",
                           (unsigned long long)sum);
    camber_status status = put(cover, BUFFER_STARTS, cover->starts, 4 * (tiles + 1));
    if (status == CAMBER_OK)
        status = reserve(cover, BUFFER_LISTS, 4 * (sum ? (size_t)sum : 1));
    return status;
}

static camber_status fill_lists(camber_cover *cover, chunks c, uint32_t chunk_count) {
    const argument fill[] = {BUFFER(BUFFER_SHAPES), BUFFER(BUFFER_BOXES), BUFFER(BUFFER_STARTS),
                             BUFFER(BUFFER_COUNTS), BUFFER(BUFFER_LISTS), VALUE(c)};
    return run(cover, STAGE_FILL, fill, 6, (size_t[]){0, chunk_count});
}

/* What work-items draw: heavy tiles by rows of cells, before all others. */
static camber_status list_items(camber_cover *cover, size_t *heavy_count, size_t *item_count) {
    const size_t tiles = cover->tile_count;
    size_t heavy = 0;
    for (size_t i = 0; i < tiles; i++)
        heavy += cover->starts[i + 1] - cover->starts[i] > HEAVY;
    const size_t count = tiles + heavy * (CAMBER_TILE_CELLS - 1);
    if (!camber_grow(cover->device->context, &cover->items, &cover->item_capacity, count, 2 * sizeof *cover->items))
        return CAMBER_ERROR_MEMORY;
    size_t by_rows = 0, whole = heavy * CAMBER_TILE_CELLS;
    for (size_t i = 0; i < tiles; i++) {
        const bool is_heavy = cover->starts[i + 1] - cover->starts[i] > HEAVY;
        for (uint32_t row = 0; is_heavy && row < CAMBER_TILE_CELLS; row++) {
            cover->items[2 * by_rows] = (uint32_t)i;
            cover->items[2 * by_rows++ + 1] = row | row << 8;
        }
        if (!is_heavy) {
            cover->items[2 * whole] = (uint32_t)i;
            cover->items[2 * whole++ + 1] = (CAMBER_TILE_CELLS - 1u) << 8;
        }
    }
    *heavy_count = by_rows;
    *item_count = count;
    return put(cover, BUFFER_ITEMS, cover->items, 2 * count * sizeof *cover->items);
}

static camber_status cover_tiles(camber_cover *cover, const camber_cover_scene *scene) {
    const camber_cover_area *band = &cover->band;
    sheet s = {.left = (float)band->x,
               .top = (float)band->y,
               .columns = cover->columns,
               .stride = cover->columns * CAMBER_TILE_PX,
               .above = band->y - cover->area.y};
    size_t heavy = 0, items = 0;
    memcpy(s.background, scene->background, sizeof s.background);
    camber_status status = list_items(cover, &heavy, &items);
    const argument arguments[] = {BUFFER(BUFFER_SHAPES),
                                  BUFFER(BUFFER_STARTS),
                                  BUFFER(BUFFER_LISTS),
                                  BUFFER(BUFFER_INKS),
                                  BUFFER(BUFFER_ITEMS),
                                  {sizeof(cl_mem), cover->given ? &cover->given : cover->buffers + BUFFER_PIXELS},
                                  VALUE(s),
                                  BUFFER(BUFFER_MEASURES),
                                  BUFFER(BUFFER_MORE),
                                  BUFFER(BUFFER_TAIL)};
    const cl_uint count = cover->variant ? 10 : 7;
    if (status == CAMBER_OK)
        status = run(cover, STAGE_COVER, arguments, count, (size_t[]){0, heavy});
    if (status == CAMBER_OK)
        status = run(cover, STAGE_COVER, arguments, count, (size_t[]){heavy, items - heavy});
    return status;
}

/* What the rich variants read and write besides. */
static camber_status prepare_more(camber_cover *cover, const camber_cover_scene *scene, size_t shapes) {
    static const float nothing[4] = {0};
    const bool bare = scene->tail_count == 0;
    camber_status status = put(cover, BUFFER_MORE, scene->more, scene->ink_count * sizeof *scene->more);
    if (status == CAMBER_OK)
        status = put(cover, BUFFER_TAIL, bare ? nothing : scene->tail, (bare ? 1 : scene->tail_count) * sizeof nothing);
    if (status == CAMBER_OK)
        status = reserve(cover, BUFFER_MEASURES, 4 * CAMBER_SHAPE_MEASURES * shapes);
    return status;
}

static camber_status prepare(camber_cover *cover, const camber_cover_scene *scene) {
    const size_t shapes = cover->shape_count ? cover->shape_count : 16;
    camber_status status =
        put(cover, BUFFER_ROWS, scene->rows, scene->row_count * CAMBER_COVER_ROW_WORDS * sizeof *scene->rows);
    if (status == CAMBER_OK)
        status = put(cover, BUFFER_FILL, camber_fill_records, sizeof camber_fill_records);
    if (status == CAMBER_OK)
        status = put(cover, BUFFER_INKS, scene->inks, scene->ink_count * sizeof *scene->inks);
    if (status == CAMBER_OK)
        status = reserve(cover, BUFFER_SHAPES, 4 * CAMBER_SHAPE_WORDS * shapes);
    if (status == CAMBER_OK)
        status = reserve(cover, BUFFER_BOXES, 4 * shapes);
    if (status == CAMBER_OK && cover->variant)
        status = prepare_more(cover, scene, shapes);
    if (status == CAMBER_OK && !cover->given)
        status = reserve(cover, BUFFER_PIXELS, camber_cover_bytes(&cover->area));
    return status;
}

/* Draws the band, unless its lists do not fit. */
static camber_status draw_band(camber_cover *cover, const camber_cover_scene *scene, const camber_cover_piece *pieces,
                               size_t piece_count, bool *fits) {
    uint32_t chunk_count;
    cover->tile_count = (size_t)cover->columns * camber_cover_tiles(cover->band.height);
    const chunks c = cut_chunks(cover, &chunk_count);
    camber_status status = make_shapes(cover, scene, pieces, piece_count);
    if (status == CAMBER_OK)
        status = count_tiles(cover, c, chunk_count);
    if (status == CAMBER_OK)
        status = start_lists(cover, fits);
    if (status != CAMBER_OK || !*fits)
        return status;
    status = fill_lists(cover, c, chunk_count);
    return status == CAMBER_OK ? cover_tiles(cover, scene) : status;
}

/* Band after band; one whose lists do not fit is halved, and so are those after it. */
static camber_status draw_bands(camber_cover *cover, const camber_cover_scene *scene, const camber_cover_piece *pieces,
                                size_t piece_count) {
    const camber_cover_area *area = &cover->area;
    uint32_t rows = camber_cover_tiles(area->height);
    camber_status status = CAMBER_OK;
    cover->band = *area;
    for (uint32_t done = 0; done < area->height && status == CAMBER_OK;) {
        const uint32_t left = area->height - done, tallest = rows * CAMBER_TILE_PX;
        bool fits = true;
        cover->band.y = area->y + done;
        cover->band.height = left < tallest ? left : tallest;
        status = draw_band(cover, scene, pieces, piece_count, &fits);
        if (fits)
            done += cover->band.height;
        else
            rows = (camber_cover_tiles(cover->band.height) + 1) / 2;
    }
    return status;
}

camber_status camber_cover_draw_into(camber_cover *cover, const camber_cover_scene *scene,
                                     const camber_cover_area *area, cl_mem pixels) {
    camber_context *context = cover->device->context;
    camber_cover_piece *pieces = NULL;
    size_t piece_count = 0;
    memset(cover->ms, 0, sizeof cover->ms);
    cover->area = *area;
    cover->given = pixels;
    cover->columns = camber_cover_tiles(area->width);
    cover->variant = camber_cover_variant(scene);
    camber_status status = camber_device_cover_program(cover->device, cover->variant, &cover->program);
    if (status == CAMBER_OK)
        status = camber_cover_list_pieces(context, scene, &pieces, &piece_count, &cover->shape_count);
    if (status == CAMBER_OK)
        status = prepare(cover, scene);
    if (status == CAMBER_OK)
        status = draw_bands(cover, scene, pieces, piece_count);
    if (status == CAMBER_OK && cover->shape_count > 0)
        camber_program_save(cover->device, cover->program);
    camber_free(context, pieces);
    return status;
}

camber_status camber_cover_draw(camber_cover *cover, const camber_cover_scene *scene, const camber_cover_area *area) {
    return camber_cover_draw_into(cover, scene, area, NULL);
}

/* ---- Pixels ---- */

camber_status camber_cover_map(camber_cover *cover, camber_cover_pixels *pixels) {
    const camber_device *device = cover->device;
    const size_t row_bytes = 4 * camber_cover_stride_px(&cover->area);
    cl_int code;
    assert(!cover->given);
    const void *rgba = clEnqueueMapBuffer(device->queue, cover->buffers[BUFFER_PIXELS], CL_TRUE, CL_MAP_READ, 0,
                                          row_bytes * cover->area.height, 0, NULL, NULL, &code);
    if (code != CL_SUCCESS)
        return camber_fail_cl(device->context, "clEnqueueMapBuffer", code);
    *pixels = (camber_cover_pixels){rgba, row_bytes};
    return CAMBER_OK;
}

void camber_cover_unmap(camber_cover *cover, camber_cover_pixels pixels) {
    clEnqueueUnmapMemObject(cover->device->queue, cover->buffers[BUFFER_PIXELS], (void *)(uintptr_t)pixels.rgba, 0,
                            NULL, NULL);
}

/* ---- Stages, read back ---- */

static camber_status get(camber_cover *cover, int which, size_t size_bytes, void *copy) {
    const camber_device *device = cover->device;
    void **bytes = copy;
    *bytes = camber_alloc(device->context, size_bytes, 1);
    if (!*bytes)
        return CAMBER_ERROR_MEMORY;
    const cl_int code = size_bytes ? clEnqueueReadBuffer(device->queue, cover->buffers[which], CL_TRUE, 0, size_bytes,
                                                         *bytes, 0, NULL, NULL)
                                   : CL_SUCCESS;
    return code == CL_SUCCESS ? CAMBER_OK : camber_fail_cl(device->context, "clEnqueueReadBuffer", code);
}

static camber_status copy_pixels(camber_cover *cover, uint8_t **rgba) {
    const camber_cover_area *area = &cover->area;
    camber_cover_pixels pixels = {0};
    *rgba = camber_alloc(cover->device->context, 4 * (size_t)area->width, area->height);
    camber_status status = *rgba ? camber_cover_map(cover, &pixels) : CAMBER_ERROR_MEMORY;
    if (status != CAMBER_OK)
        return status;
    for (size_t y = 0; y < area->height; y++)
        memcpy(*rgba + 4 * y * area->width, pixels.rgba + y * pixels.row_bytes, 4 * (size_t)area->width);
    camber_cover_unmap(cover, pixels);
    return CAMBER_OK;
}

camber_status camber_cover_read_stages(camber_cover *cover, camber_cover_stages *stages) {
    camber_cover_stages made = {.shape_count = cover->shape_count, .tile_count = cover->tile_count};
    camber_status status = get(cover, BUFFER_SHAPES, 4 * CAMBER_SHAPE_WORDS * made.shape_count, &made.shapes);
    if (status == CAMBER_OK)
        status = get(cover, BUFFER_BOXES, 4 * made.shape_count, &made.boxes);
    if (status == CAMBER_OK && cover->variant)
        status = get(cover, BUFFER_MEASURES, 4 * CAMBER_SHAPE_MEASURES * made.shape_count, &made.measures);
    if (status == CAMBER_OK)
        status = get(cover, BUFFER_STARTS, 4 * (made.tile_count + 1), &made.starts);
    if (status == CAMBER_OK)
        status = get(cover, BUFFER_LISTS, 4 * (size_t)made.starts[made.tile_count], &made.lists);
    if (status == CAMBER_OK)
        status = copy_pixels(cover, &made.rgba);
    if (status != CAMBER_OK) {
        camber_cover_stages_free(cover->device->context, &made);
        return status;
    }
    *stages = made;
    return CAMBER_OK;
}
