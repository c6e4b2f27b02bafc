/* shape -> count -> total -> fill -> cover on a device, an area of the picture at a time. */
#include "raster/rasterizer.h"

#include <string.h>

/* Segments a chunk, at least; chunks, at most: each has a count of every tile. A tile with more segments than HEAVY is
 * drawn by as many work-items as it has rows of cells. */
enum { CHUNK = 8192, CHUNKS_MAX = 64, HEAVY = 2048 };
/* The same where a work-item takes a segment. */
enum { CHUNK_OF_LANES = 512, CHUNKS_OF_LANES_MAX = 1024 };
static const char *const stage_names[STAGES] = {"shape", "count", "total", "fill", "cover"};
/* Work-items a work-group, and how many of those that one takes else: kernels/cover_lanes.cl. */
static const struct { size_t lanes, items; } lanes_of[STAGES] = {{64, 4}, {32, 1}, {64, 4}, {32, 1}, {128, 1}};

/* As count and fill read them. */
typedef struct chunks {
    uint32_t shape_count, a_chunk, tiles;
    camber_tiles of;
} chunks;

/* As cover reads it. */
typedef struct sheet {
    float left, top;
    uint32_t columns, stride;
    float background[4];
    uint32_t above; /* rows of pixels before these */
    float horizon;
    camber_eye eye;
    float sky[4];
    uint32_t first_item;
} sheet;

/* What tiles keep between slices, as cover reads it. */
typedef struct kept {
    uint32_t is_first, is_last, tile_words, sums, group, layer;
} kept;
enum { KEPT_WORDS = 48, PLANE_WORDS = CAMBER_TILE_PX * CAMBER_TILE_PX };

/* What is drawn of an area. */
typedef struct picture {
    const camber_cover_scene *scene;
    const camber_cover_piece *pieces;
    size_t piece_count, shape_count;
} picture;

/* ---- Stages ---- */

typedef struct argument {
    size_t size_bytes;
    const void *value;
} argument;

#define BUFFER(which)                                                                                                  \
    { sizeof(cl_mem), cover->buffers + (which) }
#define VALUE(value)                                                                                                   \
    { sizeof(value), &(value) }

/* Waits for what runs: once, as every waking up costs time. */
static camber_status settle(camber_cover *cover) {
    camber_status status = CAMBER_OK;
    for (size_t i = cover->pending_count; i-- > 0;) {
        const camber_cover_pending *one = cover->pending + i;
        const cl_int code = clWaitForEvents(1, &one->event);
        camber_add_ms(one->event, cover->ms + one->stage);
        if (code != CL_SUCCESS)
            status = camber_fail_stage(cover->device, "clWaitForEvents", stage_names[one->stage], code);
    }
    cover->pending_count = 0;
    return status;
}

/* Whether the variant has kernels with a work-item a pixel, and the device wants them. */
static bool has_lanes(const camber_cover *cover) {
    return cover->variant == 0 && cover->device->lanes == 1;
}

/* So many work-items, each a work-group, or what does their work. */
static camber_status run(camber_cover *cover, int stage, const argument *arguments, cl_uint argument_count,
                         size_t item_count) {
    const camber_device *device = cover->device;
    const cl_kernel kernels[STAGES] = {cover->program->shape, cover->program->count, cover->program->total,
                                       cover->program->fill, cover->program->cover};
    const bool by_lanes = has_lanes(cover);
    const size_t lanes = by_lanes ? lanes_of[stage].lanes : 1, items = by_lanes ? lanes_of[stage].items : 1;
    const size_t count = (item_count + items - 1) / items * lanes;
    cl_event event = NULL;
    if (count == 0)
        return CAMBER_OK;
    for (cl_uint i = 0; i < argument_count; i++) {
        const cl_int code = clSetKernelArg(kernels[stage], i, arguments[i].size_bytes, arguments[i].value);
        if (code != CL_SUCCESS)
            return camber_fail_stage(device, "clSetKernelArg", stage_names[stage], code);
    }
    cl_int code = clEnqueueNDRangeKernel(device->queue, kernels[stage], 1, NULL, &count, &lanes, 0, NULL, &event);
    if (code != CL_SUCCESS)
        return camber_fail_stage(device, "clEnqueueNDRangeKernel", stage_names[stage], code);
    cover->pending[cover->pending_count++] = (camber_cover_pending){event, stage};
    return cover->pending_count == CAMBER_COVER_PENDING ? settle(cover) : CAMBER_OK;
}

static bool is_pitched(const camber_cover *cover) {
    return cover->variant & CAMBER_COVER_PITCHED;
}

/* Of a kernel: those of the rich variants, and one more of those that are pitched. */
static cl_uint more_arguments(const camber_cover *cover, cl_uint rich) {
    return (cover->variant ? rich : 0) + is_pitched(cover);
}

/* What of a piece lies in the slice: its first record begins a work-item, as the piece's does. */
static bool cut_piece(const camber_cover *cover, camber_cover_piece *piece) {
    const size_t from = cover->first_shape, to = from + cover->shape_count, base = piece->base;
    const size_t before = from > base ? from - base : 0, past = to > base ? to - base : 0;
    if (piece->end - piece->first > past)
        piece->end = piece->first + past;
    piece->first += before;
    piece->base = base + before - from;
    return piece->first < piece->end;
}

static camber_status make_shapes(camber_cover *cover, const camber_cover_scene *scene, const camber_cover_piece *pieces,
                                 size_t piece_count) {
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < piece_count && status == CAMBER_OK; i++) {
        camber_cover_piece piece = pieces[i];
        if (!cut_piece(cover, &piece))
            continue;
        camber_mesh *mesh = piece.mesh;
        camber_mesh_part *part = mesh ? mesh->parts + piece.part : NULL;
        const camber_shape_range range = camber_cover_range(scene, &piece, &cover->band);
        status = part ? camber_part_ensure_made(mesh, part) : CAMBER_OK;
        if (status != CAMBER_OK)
            break;
        const cl_mem *records = part ? &part->buffers[CAMBER_BUFFER_RECORDS].mem : cover->buffers + BUFFER_FILL;
        const argument arguments[] = {{sizeof(cl_mem), records}, BUFFER(BUFFER_ROWS), BUFFER(BUFFER_SHAPES),
                                      BUFFER(BUFFER_BOXES),      VALUE(range),        BUFFER(BUFFER_MEASURES),
                                      BUFFER(BUFFER_PLANES)};
        const size_t items = (piece.end - piece.first + 15) / 16;
        status = run(cover, STAGE_SHAPE, arguments, 5 + more_arguments(cover, 1), items);
    }
    return status;
}

/* Of a tile in a chunk: its count, and a mark where it takes one. */
static size_t count_words(const camber_cover *cover) {
    return has_lanes(cover) ? 2 : 1;
}

static chunks cut_chunks(const camber_cover *cover, uint32_t *chunk_count) {
    const camber_cover_area *area = &cover->band;
    const bool by_lanes = has_lanes(cover);
    const size_t least = by_lanes ? CHUNK_OF_LANES : CHUNK, chunks_max = by_lanes ? CHUNKS_OF_LANES_MAX : CHUNKS_MAX;
    const size_t tiles = (cover->tile_count + 15) / 16 * 16,
                 most = cover->device->info.largest_buffer_bytes / (count_words(cover) * 4 * tiles);
    const size_t wanted = (cover->shape_count + least - 1) / least, bound = most < chunks_max ? most : chunks_max;
    const size_t count = wanted < bound || bound == 0 ? wanted : bound;
    const size_t a_chunk = count ? (cover->shape_count + count - 1) / count : 0;
    *chunk_count = (uint32_t)count;
    return (chunks){
        (uint32_t)cover->shape_count,
        (uint32_t)a_chunk,
        (uint32_t)tiles,
        {(float)area->x, (float)area->y, camber_cover_tiles(area->width), camber_cover_tiles(area->height)}};
}

static camber_status count_tiles(camber_cover *cover, chunks c, uint32_t chunk_count) {
    camber_status status =
        camber_cover_reserve(cover, BUFFER_COUNTS, count_words(cover) * 4 * c.tiles * (chunk_count ? chunk_count : 1));
    if (status == CAMBER_OK)
        status = camber_cover_reserve(cover, BUFFER_TOTALS, 4 * (size_t)c.tiles);
    const argument count[] = {BUFFER(BUFFER_SHAPES), BUFFER(BUFFER_BOXES), BUFFER(BUFFER_COUNTS), VALUE(c)};
    const argument total[] = {BUFFER(BUFFER_COUNTS), BUFFER(BUFFER_TOTALS), VALUE(c.tiles), VALUE(chunk_count)};
    if (status == CAMBER_OK)
        status = run(cover, STAGE_COUNT, count, 4, chunk_count);
    if (status == CAMBER_OK)
        status = run(cover, STAGE_TOTAL, total, 4, c.tiles / 16);
    return status;
}

/* The host's part of the scan: where each tile's list begins. *fits is false where they take too much for a band that
 * can be halved, or a slice. */
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
    *fits =
        4 * sum <= camber_cover_most_bytes(cover) || (cover->band.height <= CAMBER_TILE_PX && cover->shape_count <= 16);
    if (!*fits)
        return CAMBER_OK;
    if (sum > UINT32_MAX)
        return camber_fail(device->context, CAMBER_ERROR_LIMIT, "%llu segments in tiles; draw less at once",
                           (unsigned long long)sum);
    camber_status status = camber_cover_put(cover, BUFFER_STARTS, cover->starts, 4 * (tiles + 1));
    if (status == CAMBER_OK)
        status = camber_cover_reserve(cover, BUFFER_LISTS, 4 * (sum ? (size_t)sum : 1));
    return status;
}

static camber_status fill_lists(camber_cover *cover, chunks c, uint32_t chunk_count) {
    const argument fill[] = {BUFFER(BUFFER_SHAPES), BUFFER(BUFFER_BOXES), BUFFER(BUFFER_STARTS),
                             BUFFER(BUFFER_COUNTS), BUFFER(BUFFER_LISTS), VALUE(c)};
    return run(cover, STAGE_FILL, fill, 6, chunk_count);
}

static bool is_heavy(const camber_cover *cover, size_t tile) {
    return has_lanes(cover) || cover->starts[tile + 1] - cover->starts[tile] > HEAVY;
}

/* What work-items draw: heavy tiles by rows of cells, before all others; where they have a pixel each, all tiles. */
static camber_status list_items(camber_cover *cover, size_t *heavy_count, size_t *item_count) {
    const size_t tiles = cover->tile_count;
    size_t heavy = 0;
    for (size_t i = 0; i < tiles; i++)
        heavy += is_heavy(cover, i);
    const size_t count = tiles + heavy * (CAMBER_TILE_CELLS - 1);
    if (!camber_grow(cover->device->context, &cover->items, &cover->item_capacity, count, 2 * sizeof *cover->items))
        return CAMBER_ERROR_MEMORY;
    size_t by_rows = 0, whole = heavy * CAMBER_TILE_CELLS;
    for (size_t i = 0; i < tiles; i++) {
        const bool by_row = is_heavy(cover, i);
        for (uint32_t row = 0; by_row && row < CAMBER_TILE_CELLS; row++) {
            cover->items[2 * by_rows] = (uint32_t)i;
            cover->items[2 * by_rows++ + 1] = row | row << 8;
        }
        if (!by_row) {
            cover->items[2 * whole] = (uint32_t)i;
            cover->items[2 * whole++ + 1] = (CAMBER_TILE_CELLS - 1u) << 8;
        }
    }
    *heavy_count = by_rows;
    *item_count = count;
    return camber_cover_put(cover, BUFFER_ITEMS, cover->items, 2 * count * sizeof *cover->items);
}

/* Where planes lie that a scene needs: an ink's and the picture's five, three of unions, four a level, one of masks. */
static kept plan_kept(const camber_cover_scene *scene) {
    bool unions = false, groups = false, layers = false, masks = false;
    for (size_t i = 0; i < scene->ink_count; i++) {
        unions = unions || scene->inks[i].mode == CAMBER_INK_UNION;
        groups = groups || scene->inks[i].group;
        layers = layers || scene->inks[i].layer;
        masks = masks || scene->inks[i].mode == CAMBER_INK_MASKED;
    }
    kept k = {.sums = 5};
    k.group = k.sums + (unions ? 3 : 0);
    k.layer = k.group + (groups ? 4 : 0);
    k.tile_words = KEPT_WORDS + (k.layer + (layers ? 4 : 0) + (masks ? 1 : 0)) * PLANE_WORDS;
    return k;
}

static camber_status cover_tiles(camber_cover *cover, const camber_cover_scene *scene, kept k, size_t heavy,
                                 size_t items) {
    const camber_cover_area *band = &cover->band;
    sheet s = {.left = (float)band->x,
               .top = (float)band->y,
               .columns = cover->columns,
               .stride = cover->columns * CAMBER_TILE_PX,
               .above = band->y - cover->area.y,
               .horizon = (float)scene->horizon,
               .eye = scene->eye};
    memcpy(s.background, scene->background, sizeof s.background);
    memcpy(s.sky, scene->sky, sizeof s.sky);
    camber_status status =
        camber_cover_reserve(cover, BUFFER_KEPT, k.is_first && k.is_last ? 4 : 4 * cover->tile_count * k.tile_words);
    const argument arguments[] = {BUFFER(BUFFER_SHAPES),
                                  BUFFER(BUFFER_STARTS),
                                  BUFFER(BUFFER_LISTS),
                                  BUFFER(BUFFER_INKS),
                                  BUFFER(BUFFER_ITEMS),
                                  {sizeof(cl_mem), cover->given ? &cover->given : cover->buffers + BUFFER_PIXELS},
                                  VALUE(s),
                                  BUFFER(BUFFER_KEPT),
                                  VALUE(k),
                                  BUFFER(BUFFER_MEASURES),
                                  BUFFER(BUFFER_MORE),
                                  BUFFER(BUFFER_TAIL),
                                  BUFFER(BUFFER_PLANES)};
    const cl_uint count = 9 + more_arguments(cover, 3);
    if (status == CAMBER_OK)
        status = run(cover, STAGE_COVER, arguments, count, heavy);
    s.first_item = (uint32_t)heavy;
    if (status == CAMBER_OK)
        status = run(cover, STAGE_COVER, arguments, count, items - heavy);
    return status;
}

/* What the rich variants read and write besides. */
static camber_status prepare_more(camber_cover *cover, const camber_cover_scene *scene, size_t shapes) {
    static const float nothing[4] = {0};
    const bool bare = scene->tail_count == 0;
    camber_status status = camber_cover_put(cover, BUFFER_MORE, scene->more, scene->ink_count * sizeof *scene->more);
    if (status == CAMBER_OK)
        status = camber_cover_put(cover, BUFFER_TAIL, bare ? nothing : scene->tail,
                                  (bare ? 1 : scene->tail_count) * sizeof nothing);
    if (status == CAMBER_OK)
        status = camber_cover_reserve(cover, BUFFER_MEASURES, 4 * CAMBER_SHAPE_MEASURES * shapes);
    if (status == CAMBER_OK && is_pitched(cover))
        status = camber_cover_reserve(cover, BUFFER_PLANES, 4 * CAMBER_PLANE_WORDS * shapes);
    return status;
}

static size_t shapes_at_once(const camber_cover *cover) {
    const size_t a_shape = is_pitched(cover) ? CAMBER_PLANE_WORDS : CAMBER_SHAPE_WORDS;
    const size_t count = (size_t)(camber_cover_most_bytes(cover) / (4 * a_shape)) / 16 * 16;
    return count ? count : 16;
}

static camber_status prepare(camber_cover *cover, const camber_cover_scene *scene) {
    const size_t most = shapes_at_once(cover), wanted = cover->shape_count ? cover->shape_count : 16;
    const size_t shapes = wanted < most ? wanted : most;
    camber_status status = camber_cover_put(cover, BUFFER_ROWS, scene->rows,
                                            scene->row_count * CAMBER_COVER_ROW_WORDS * sizeof *scene->rows);
    if (status == CAMBER_OK)
        status = camber_cover_put(cover, BUFFER_FILL, camber_fill_records, sizeof camber_fill_records);
    if (status == CAMBER_OK)
        status = camber_cover_put(cover, BUFFER_INKS, scene->inks, scene->ink_count * sizeof *scene->inks);
    if (status == CAMBER_OK)
        status = camber_cover_reserve(cover, BUFFER_SHAPES, 4 * CAMBER_SHAPE_WORDS * shapes);
    if (status == CAMBER_OK)
        status = camber_cover_reserve(cover, BUFFER_BOXES, 4 * shapes);
    if (status == CAMBER_OK && cover->variant)
        status = prepare_more(cover, scene, shapes);
    if (status == CAMBER_OK && !cover->given)
        status = camber_cover_reserve(cover, BUFFER_PIXELS, camber_cover_bytes(&cover->area));
    return status;
}

/* Draws the slice of the band, unless its lists do not fit. */
static camber_status draw_slice(camber_cover *cover, const picture *p, kept k, bool *fits) {
    uint32_t chunk_count;
    const chunks c = cut_chunks(cover, &chunk_count);
    camber_status status = make_shapes(cover, p->scene, p->pieces, p->piece_count);
    if (status == CAMBER_OK)
        status = count_tiles(cover, c, chunk_count);
    if (status == CAMBER_OK)
        status = start_lists(cover, fits);
    if (status != CAMBER_OK || !*fits)
        return status;
    size_t heavy, items;
    cover->slice_count++;
    status = list_items(cover, &heavy, &items);
    if (status == CAMBER_OK)
        status = fill_lists(cover, c, chunk_count);
    return status == CAMBER_OK ? cover_tiles(cover, p->scene, k, heavy, items) : status;
}

/* Slice after slice, from the last one to the first, unless the band can be halved where the lists of one do not fit.
 */
static camber_status draw_band(camber_cover *cover, const picture *p, bool *fits) {
    size_t most = shapes_at_once(cover), left = p->shape_count;
    kept k = plan_kept(p->scene);
    camber_status status = CAMBER_OK;
    cover->tile_count = (size_t)cover->columns * camber_cover_tiles(cover->band.height);
    do {
        cover->shape_count = left < most ? left : most;
        cover->first_shape = left - cover->shape_count;
        k.is_first = left == p->shape_count;
        k.is_last = cover->first_shape == 0;
        *fits = true;
        status = draw_slice(cover, p, k, fits);
        if (*fits)
            left = cover->first_shape;
        else if (cover->band.height > CAMBER_TILE_PX)
            return status;
        else
            most = (cover->shape_count / 2 + 15) / 16 * 16;
    } while (status == CAMBER_OK && left > 0);
    return status;
}

/* Rows of tiles of a band: all, or of what is drawn in slices as many as may be kept. */
static uint32_t rows_at_once(const camber_cover *cover, const picture *p) {
    const uint32_t rows = camber_cover_tiles(cover->area.height);
    const uint64_t row_bytes = 4 * (uint64_t)plan_kept(p->scene).tile_words * cover->columns;
    const uint64_t most = camber_cover_most_bytes(cover) / row_bytes;
    if (p->shape_count <= shapes_at_once(cover) || most >= rows)
        return rows;
    return most > 0 ? (uint32_t)most : 1;
}

/* Band after band; one whose lists do not fit is halved, and so are those after it. */
static camber_status draw_bands(camber_cover *cover, const picture *p) {
    const camber_cover_area *area = &cover->area;
    uint32_t rows = rows_at_once(cover, p);
    camber_status status = CAMBER_OK;
    cover->band = *area;
    for (uint32_t done = 0; done < area->height && status == CAMBER_OK;) {
        const uint32_t left = area->height - done, tallest = rows * CAMBER_TILE_PX;
        bool fits = true;
        cover->band.y = area->y + done;
        cover->band.height = left < tallest ? left : tallest;
        status = draw_band(cover, p, &fits);
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
    picture p = {.scene = scene};
    memset(cover->ms, 0, sizeof cover->ms);
    cover->slice_count = 0;
    cover->area = *area;
    cover->given = pixels;
    cover->columns = camber_cover_tiles(area->width);
    cover->variant = camber_cover_variant(scene);
    camber_status status = camber_device_cover_program(cover->device, cover->variant, &cover->program);
    if (status == CAMBER_OK)
        status = camber_cover_list_pieces(context, scene, &pieces, &p.piece_count, &p.shape_count);
    p.pieces = pieces;
    cover->shape_count = p.shape_count;
    if (status == CAMBER_OK)
        status = prepare(cover, scene);
    if (status == CAMBER_OK)
        status = draw_bands(cover, &p);
    const camber_status settled = settle(cover);
    if (status != CAMBER_OK)
        clFinish(cover->device->queue); /* what is put goes with the scene */
    status = status == CAMBER_OK ? settled : status;
    camber_free(context, pieces);
    return status;
}

camber_status camber_cover_draw(camber_cover *cover, const camber_cover_scene *scene, const camber_cover_area *area) {
    return camber_cover_draw_into(cover, scene, area, NULL);
}
