/* Runs the rasterizer's stages on a device: setup -> bin_count -> bin_scan -> bin_scatter -> rasterize.
 *
 * Input: a scene and an area. Output: the area's pixels in a buffer. An area, a rectangle of the picture, is drawn band
 * by band, and a band slice by slice, from the last segments to the first. Bands and slices are as large as the buffers
 * for lists and spills allow. */
#include "raster/rasterizer.h"

#include "kernels/area.h"

#include "base/stages.h"
#include "gpu/launch.h"

#include <string.h>

/* CHUNK, CHUNKS_MAX: the fewest segments of a chunk, and the most chunks, which are limited because each has a count
 * for every tile. A GPU has more chunks, because it needs many work-groups.
 * HEAVY: on a CPU, a tile with more segments than this is drawn by as many work-items as it has rows of cells, each of
 * which walks the whole list until its row is full. That takes more work, so it is only done where the processors would
 * otherwise wait for the tile: if it has more than one in SHARES of the segments that each of them draws. If there are
 * edges of rings, the tile must also be drawn in one slice, because its rows share the edges that they spill. */
enum { CHUNK = 8192, CHUNKS_MAX = 64, GPU_CHUNK = 256, GPU_CHUNKS_MAX = 4096, HEAVY = 2048, SHARES = 8 };

enum { PLANE_WORDS = CAMBER_TILE_PX * CAMBER_TILE_PX };

/* The scene and the ranges that an area is drawn from. */
typedef struct listed_scene {
    const camber_raster_scene *scene;
    camber_range_list list;
} listed_scene;

/* ---- Stages ---- */

#define BUFFER(which) CAMBER_ARG_BUFFER(raster->buffers[which])

static const char *stage_name(int stage) {
    return camber_stage_name((camber_stage_id)((int)CAMBER_STAGE_SETUP + stage));
}

/* Waits once for all running kernels, because each wait costs time, and adds their times up. */
static camber_status settle(camber_raster *raster) {
    camber_status status = CAMBER_OK;
    for (size_t i = raster->pending_count; i-- > 0;) {
        const camber_raster_pending *one = raster->pending + i;
        const camber_status waited = camber_event_wait(raster->device, one->event, stage_name(one->stage));
        camber_event_end(raster->device, one->event, raster->ms + one->stage);
        status = status == CAMBER_OK ? waited : status;
    }
    raster->pending_count = 0;
    return status;
}

/* Starts a stage's kernel for job_count jobs. Each job is a work-group of one work-item, or, on a GPU, of those that
 * share a chunk or a tile. */
static camber_status run(camber_raster *raster, int stage, const camber_kernel_arg *args, size_t arg_count,
                         size_t job_count) {
    const bool is_alone = stage == STAGE_SETUP || stage == STAGE_WIND || !camber_raster_shares_tiles(raster);
    const size_t a_job = is_alone ? 1 : CAMBER_TILE_ITEMS;
    camber_kernel *const kernels[STAGES] = {raster->program->setup,    raster->program->bin_count,
                                            raster->program->bin_scan, raster->program->bin_scatter,
                                            raster->program->wind,     raster->program->rasterize};
    const camber_launch launch = {stage_name(stage), kernels[stage], args, arg_count, a_job * job_count, a_job};
    camber_event *event = NULL;
    if (job_count == 0)
        return CAMBER_OK;
    const camber_status status = camber_launch_kernel(raster->device, &launch, &event);
    if (status != CAMBER_OK)
        return status;
    raster->pending[raster->pending_count++] = (camber_raster_pending){event, stage};
    return raster->pending_count == CAMBER_RASTER_PENDING ? settle(raster) : CAMBER_OK;
}

static bool is_pitched(const camber_raster *raster) {
    return raster->variant & CAMBER_RASTER_PITCHED;
}

/* Cuts a range to its slots in the slice. The first of them begins a work-item, like the first slot of the range. */
static bool cut_range(const camber_raster *raster, camber_slot_range *range) {
    const size_t from = raster->first_segment, to = from + raster->segment_count, base = range->base;
    const size_t before = from > base ? from - base : 0, past = to > base ? to - base : 0;
    if (range->end - range->first > past)
        range->end = range->first + past;
    range->first += before;
    range->base = base + before - from;
    return range->first < range->end;
}

/* Starts setup for ranges of one part. */
static camber_status set_up(camber_raster *raster, const camber_setup_args *args, uint32_t count, size_t items,
                            const camber_mesh_part *part) {
    const camber_status status = camber_raster_put(raster, BUFFER_SETUPS, args, count * sizeof *args);
    const camber_kernel_arg arguments[] = {CAMBER_ARG_BUFFER(part->x),
                                           CAMBER_ARG_BUFFER(part->y),
                                           CAMBER_ARG_BUFFER(part->info),
                                           CAMBER_ARG_BUFFER(part->joins),
                                           CAMBER_ARG_BUFFER(part->arc_lengths),
                                           BUFFER(BUFFER_ROWS),
                                           BUFFER(BUFFER_SEGMENTS),
                                           BUFFER(BUFFER_BOXES),
                                           BUFFER(BUFFER_SETUPS),
                                           CAMBER_ARG_VALUE(count),
                                           BUFFER(BUFFER_ARC_LENGTHS),
                                           BUFFER(BUFFER_PLANES),
                                           BUFFER(BUFFER_CHANGES),
                                           BUFFER(BUFFER_EDGES),
                                           BUFFER(BUFFER_BUNCHES)};
    return status == CAMBER_OK ? run(raster, STAGE_SETUP, arguments, sizeof arguments / sizeof *arguments, items)
                               : status;
}

/* Makes the segments that ranges of one part have in the slice, all in one launch, because each launch costs time. */
static camber_status set_up_part(camber_raster *raster, const listed_scene *p, size_t first, size_t end) {
    const size_t an_item = CAMBER_SETUP_SLOTS(raster->device->lanes);
    camber_mesh *mesh = p->list.ranges[first].mesh;
    camber_mesh_part *part = mesh->parts + p->list.ranges[first].part;
    camber_setup_args *args = raster->setups + first;
    camber_status status = CAMBER_OK;
    size_t items = 0;
    uint32_t count = 0;
    for (size_t i = first; i < end && status == CAMBER_OK; i++) {
        camber_slot_range range = p->list.ranges[i];
        if (!cut_range(raster, &range))
            continue;
        /* edges of rings have no joins */
        status = range.is_area ? camber_part_ensure_made(mesh, part) : camber_part_ensure_points(mesh, part);
        args[count] = camber_raster_setup_args(p->scene, &range, &raster->band);
        args[count++].first_item = (uint32_t)items;
        items += (range.end - range.first + an_item - 1) / an_item;
    }
    if (status != CAMBER_OK || count == 0)
        return status;
    return set_up(raster, args, count, items, part);
}

static camber_status make_segments(camber_raster *raster, const listed_scene *p) {
    const camber_slot_range *ranges = p->list.ranges;
    camber_status status = camber_grow(raster->device->context, &raster->setups, &raster->setup_capacity, p->list.count,
                                       sizeof *raster->setups)
                               ? CAMBER_OK
                               : CAMBER_ERROR_MEMORY;
    for (size_t i = 0, end; i < p->list.count && status == CAMBER_OK; i = end) {
        for (end = i + 1;
             end < p->list.count && ranges[end].mesh == ranges[i].mesh && ranges[end].part == ranges[i].part;)
            end++;
        status = set_up_part(raster, p, i, end);
    }
    return status;
}

/* Finds the smallest range of the slice's segments that contains all edges of rings. */
static void find_edges(const camber_raster *raster, uint32_t *first, uint32_t *count) {
    const size_t slice = raster->first_segment, end = raster->end_edge > slice ? raster->end_edge - slice : 0;
    *first = raster->first_edge > slice ? (uint32_t)(raster->first_edge - slice) : 0;
    *count = end > *first ? (uint32_t)(end - *first) : 0;
}

static camber_bin_args cut_chunks(const camber_raster *raster, uint32_t *chunk_count) {
    const camber_raster_area *area = &raster->band;
    const size_t lists = (raster->list_count + 15) / 16 * 16,
                 most = (size_t)(camber_raster_most_bytes(raster, CAMBER_RASTER_COUNTS) / (4 * lists));
    const size_t least = camber_raster_shares_tiles(raster) ? GPU_CHUNK : CHUNK;
    const size_t chunks_max = camber_raster_shares_tiles(raster) ? GPU_CHUNKS_MAX : CHUNKS_MAX;
    const size_t wanted = (raster->segment_count + least - 1) / least;
    const size_t bound = most == 0 ? 1 : most < chunks_max ? most : chunks_max, count = wanted < bound ? wanted : bound;
    const size_t a_chunk = count ? ((raster->segment_count + count - 1) / count + 15) / 16 * 16 : 0;
    *chunk_count = (uint32_t)count;
    uint32_t first_edge, edge_count;
    find_edges(raster, &first_edge, &edge_count);
    return (camber_bin_args){
        (uint32_t)raster->segment_count,
        (uint32_t)a_chunk,
        (uint32_t)lists,
        first_edge,
        edge_count,
        {(float)area->x, (float)area->y, camber_raster_tiles(area->width), camber_raster_tiles(area->height)}};
}

static camber_status count_segments(camber_raster *raster, camber_bin_args c, uint32_t chunk_count) {
    camber_status status =
        camber_raster_reserve(raster, BUFFER_COUNTS, 4 * (size_t)c.lists * (chunk_count ? chunk_count : 1));
    if (status == CAMBER_OK)
        status = camber_raster_reserve(raster, BUFFER_TOTALS, 4 * (size_t)c.lists);
    const camber_kernel_arg count[] = {BUFFER(BUFFER_SEGMENTS), BUFFER(BUFFER_EDGES),  BUFFER(BUFFER_BOXES),
                                       BUFFER(BUFFER_BUNCHES),  BUFFER(BUFFER_COUNTS), CAMBER_ARG_VALUE(c)};
    const camber_kernel_arg total[] = {BUFFER(BUFFER_COUNTS), BUFFER(BUFFER_TOTALS), CAMBER_ARG_VALUE(c.lists),
                                       CAMBER_ARG_VALUE(chunk_count)};
    if (status == CAMBER_OK)
        status = run(raster, STAGE_BIN_COUNT, count, sizeof count / sizeof *count, chunk_count);
    if (status == CAMBER_OK)
        status = run(raster, STAGE_BIN_SCAN, total, 4, c.lists / 16);
    return status;
}

/* Adds the tiles' totals up on the host, which says where each list begins. *fits is false if the lists are too long
 * and the band or the slice can still be halved. */
static camber_status start_lists(camber_raster *raster, bool *fits) {
    const camber_device *device = raster->device;
    const size_t lists = raster->list_count;
    uint64_t sum = 0;
    const uint32_t *totals;
    if (!camber_grow(device->context, &raster->starts, &raster->start_capacity, lists + 2, sizeof *raster->starts))
        return CAMBER_ERROR_MEMORY;
    camber_status status =
        camber_buffer_map(device, raster->buffers[BUFFER_TOTALS], CAMBER_MAP_READ, 4 * lists, &totals);
    if (status != CAMBER_OK)
        return status;
    for (size_t i = 0; i < lists; i++) {
        raster->starts[i] = (uint32_t)sum;
        sum += totals[i];
    }
    /* One more than there are lists, because rasterize also looks at the next tile's list. */
    raster->starts[lists] = raster->starts[lists + 1] = (uint32_t)sum;
    camber_buffer_unmap(device, raster->buffers[BUFFER_TOTALS], totals);
    const uint64_t crossings = sum - raster->starts[raster->tile_count];
    *fits = 4 * (sum + CAMBER_CROSSING_WORDS * crossings) <= camber_raster_most_bytes(raster, CAMBER_RASTER_LISTS) ||
            (raster->band.height <= CAMBER_TILE_PX && raster->segment_count <= 16);
    if (!*fits)
        return CAMBER_OK;
    if (sum > UINT32_MAX)
        return camber_fail(device->context, CAMBER_ERROR_LIMIT, "%llu segments in tiles; draw less at once",
                           (unsigned long long)sum);
    status = camber_raster_put(raster, BUFFER_STARTS, raster->starts, 4 * (lists + 2));
    if (status == CAMBER_OK)
        status = camber_raster_reserve(raster, BUFFER_LISTS, 4 * (sum ? (size_t)sum : 1));
    return status;
}

static camber_status scatter_segments(camber_raster *raster, camber_bin_args c, uint32_t chunk_count) {
    const camber_kernel_arg fill[] = {BUFFER(BUFFER_SEGMENTS), BUFFER(BUFFER_EDGES),  BUFFER(BUFFER_BOXES),
                                      BUFFER(BUFFER_BUNCHES),  BUFFER(BUFFER_STARTS), BUFFER(BUFFER_COUNTS),
                                      BUFFER(BUFFER_LISTS),    CAMBER_ARG_VALUE(c)};
    return run(raster, STAGE_BIN_SCATTER, fill, sizeof fill / sizeof *fill, chunk_count);
}

/* Computes how edges change the winding numbers to their right. */
static camber_status wind_rows(camber_raster *raster, camber_tile_grid of) {
    if (raster->list_count == raster->tile_count)
        return CAMBER_OK;
    const size_t edges = raster->starts[raster->list_count] - raster->starts[raster->tile_count];
    camber_status status =
        camber_raster_reserve(raster, BUFFER_CROSSINGS, 4 * CAMBER_CROSSING_WORDS * (edges ? edges : 1));
    if (status == CAMBER_OK)
        status = camber_raster_reserve(raster, BUFFER_ENDS, 4 * (size_t)of.rows);
    const camber_kernel_arg wind[] = {BUFFER(BUFFER_EDGES),     BUFFER(BUFFER_STARTS), BUFFER(BUFFER_LISTS),
                                      BUFFER(BUFFER_CROSSINGS), BUFFER(BUFFER_ENDS),   CAMBER_ARG_VALUE(of)};
    return status == CAMBER_OK ? run(raster, STAGE_WIND, wind, sizeof wind / sizeof *wind, of.rows) : status;
}

/* Whether the slice draws anything in a tile: its own segments, or polygons whose edges cross its row of tiles. */
static bool has_work(const camber_raster *raster, size_t tile) {
    const uint32_t *lists = raster->starts, *rows = lists + raster->tile_count + tile / raster->columns;
    return lists[tile + 1] > lists[tile] || (raster->list_count > raster->tile_count && rows[1] > rows[0]);
}

/* Returns the most tiles that can be spilled: as many as memory allows, and at least a row of them. */
static size_t most_spills(const camber_raster *raster, camber_spill_args k) {
    const size_t most = (size_t)(camber_raster_most_bytes(raster, CAMBER_RASTER_SPILLS) / (4 * (uint64_t)k.tile_words));
    return most > raster->columns ? most : raster->columns;
}

/* Notes that no tile of the band has a spill yet. */
static camber_status begin_spills(camber_raster *raster) {
    const size_t tiles = raster->tile_count;
    if (!camber_grow(raster->device->context, &raster->spills, &raster->spill_capacity, tiles, sizeof *raster->spills))
        return CAMBER_ERROR_MEMORY;
    memset(raster->spills, 255, tiles * sizeof *raster->spills);
    raster->spill_count = 0;
    return CAMBER_OK;
}

/* Gives a spill to each tile that this slice is the first to draw; the last slice spills none. The buffer has room for
 * as many as there may ever be, because it would lose its contents if it grew. *fits is false if there are too many,
 * which never happens for one row of tiles. */
static camber_status place_spills(camber_raster *raster, camber_spill_args k, bool *fits) {
    const size_t most = most_spills(raster, k), tiles = raster->tile_count;
    raster->spills_before = raster->spill_count;
    for (size_t i = 0; i < tiles && !k.is_last; i++) {
        if (raster->spills[i] != UINT32_MAX || !has_work(raster, i))
            continue;
        *fits = raster->spill_count < most;
        if (!*fits)
            return CAMBER_OK;
        raster->spills[i] = (uint32_t)raster->spill_count++;
    }
    return camber_raster_reserve(
        raster, BUFFER_SPILL,
        k.is_last && raster->spill_count == 0 ? 4 : 4 * (tiles < most ? tiles : most) * k.tile_words);
}

static bool is_heavy(const camber_raster *raster, camber_spill_args k, size_t tile) {
    const uint64_t count = raster->starts[tile + 1] - raster->starts[tile], units = raster->device->info.compute_units;
    const bool at_once = k.is_last && raster->spill_count == 0;
    return count > HEAVY && !camber_raster_shares_tiles(raster) && (raster->end_edge == 0 || at_once) &&
           SHARES * units * count > raster->starts[raster->tile_count];
}

static void put_job(camber_raster *raster, size_t job, size_t tile, uint32_t rows) {
    const uint32_t spill = raster->spills[tile];
    uint32_t *words = raster->jobs + CAMBER_JOB_WORDS * job;
    words[0] = (uint32_t)tile;
    words[1] = rows;
    words[2] = spill == UINT32_MAX              ? CAMBER_JOB_BEGINS
               : spill >= raster->spills_before ? spill | CAMBER_JOB_BEGINS
                                                : spill;
}

/* Lists the jobs for the tiles that the slice draws; the last slice draws all tiles. Heavy tiles are first, with one
 * job per row of cells, and then whole tiles. */
static camber_status list_jobs(camber_raster *raster, camber_spill_args k, size_t *heavy_count, size_t *job_count) {
    const size_t tiles = raster->tile_count;
    size_t heavy = 0;
    for (size_t i = 0; i < tiles; i++)
        heavy += is_heavy(raster, k, i);
    size_t by_rows = 0, whole = heavy * CAMBER_TILE_CELLS;
    if (!camber_grow(raster->device->context, &raster->jobs, &raster->job_capacity, tiles + whole,
                     CAMBER_JOB_WORDS * sizeof *raster->jobs))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < tiles; i++) {
        const bool by_row = is_heavy(raster, k, i);
        for (uint32_t row = 0; by_row && row < CAMBER_TILE_CELLS; row++)
            put_job(raster, by_rows++, i, CAMBER_JOB_ROWS(row, row));
        if (!by_row && (k.is_last || has_work(raster, i)))
            put_job(raster, whole++, i, CAMBER_JOB_ROWS(0, CAMBER_TILE_CELLS - 1));
    }
    *heavy_count = by_rows;
    *job_count = whole;
    if (whole == 0)
        return CAMBER_OK;
    return camber_raster_put(raster, BUFFER_JOBS, raster->jobs, CAMBER_JOB_WORDS * whole * sizeof *raster->jobs);
}

/* Lays out the planes of a spill: five for the brush and the picture, three for unions or two for areas, four for the
 * group and for the layer, and one for masks. */
static camber_spill_args plan_spill(const camber_raster *raster, const camber_raster_scene *scene) {
    const bool areas = raster->end_edge > 0; /* areas that have edges, unlike fills of the picture */
    bool unions = false, groups = false, layers = false, masks = false;
    for (size_t i = 0; i < scene->brush_count; i++) {
        unions = unions || scene->brushes[i].mode == CAMBER_BRUSH_UNION;
        groups = groups || scene->brushes[i].group;
        layers = layers || scene->brushes[i].layer;
        masks = masks || scene->brushes[i].mode == CAMBER_BRUSH_MASKED;
    }
    camber_spill_args k = {.sums = 5};
    k.group = k.sums + (unions ? 3 : areas ? 2 : 0);
    k.layer = k.group + (groups ? 4 : 0);
    k.behind = k.layer + (layers ? 4 : 0) + (masks ? 1 : 0);
    k.tile_words = camber_raster_state_words(raster) + k.behind * PLANE_WORDS;
    k.tile_words += areas ? camber_raster_area_words(raster) : 0;
    return k;
}

static camber_status rasterize_tiles(camber_raster *raster, const camber_raster_scene *scene, camber_spill_args k,
                                     size_t heavy, size_t jobs) {
    const camber_raster_area *band = &raster->band;
    camber_target_args s = {.left = (float)band->x,
                            .top = (float)band->y,
                            .columns = raster->columns,
                            .stride = raster->columns * CAMBER_TILE_PX,
                            .first_row =
                                raster->list_count > raster->tile_count ? (uint32_t)raster->tile_count : UINT32_MAX,
                            .r = scene->background[0],
                            .g = scene->background[1],
                            .b = scene->background[2],
                            .a = scene->background[3],
                            .above = band->y - raster->area.y,
                            .horizon = (float)scene->horizon,
                            .eye = scene->eye};
    memcpy(s.sky, scene->sky, sizeof s.sky);
    find_edges(raster, &s.first_edge, &s.edge_count);
    const camber_kernel_arg arguments[] = {
        BUFFER(BUFFER_SEGMENTS),
        BUFFER(BUFFER_EDGES),
        BUFFER(BUFFER_STARTS),
        BUFFER(BUFFER_LISTS),
        BUFFER(BUFFER_BRUSHES),
        BUFFER(BUFFER_JOBS),
        CAMBER_ARG_BUFFER(raster->given ? raster->given : raster->buffers[BUFFER_PIXELS]),
        CAMBER_ARG_VALUE(s),
        BUFFER(BUFFER_SPILL),
        CAMBER_ARG_VALUE(k),
        BUFFER(BUFFER_ARC_LENGTHS),
        BUFFER(BUFFER_BRUSH_EXT),
        BUFFER(BUFFER_SIDE_TABLE),
        BUFFER(BUFFER_PLANES),
        BUFFER(BUFFER_CROSSINGS),
        BUFFER(BUFFER_ENDS)};
    const size_t count = sizeof arguments / sizeof *arguments;
    camber_status status = run(raster, STAGE_RASTERIZE, arguments, count, heavy);
    s.first_job = (uint32_t)heavy;
    if (status == CAMBER_OK)
        status = run(raster, STAGE_RASTERIZE, arguments, count, jobs - heavy);
    return status;
}

/* Makes the buffers that only the rich variants use. */
static camber_status prepare_rich(camber_raster *raster, const camber_raster_scene *scene) {
    static const float nothing[4] = {0};
    const bool bare = scene->side_table_count == 0;
    camber_status status =
        camber_raster_put(raster, BUFFER_BRUSH_EXT, scene->brush_ext, scene->brush_count * sizeof *scene->brush_ext);
    if (status == CAMBER_OK)
        status = camber_raster_put(raster, BUFFER_SIDE_TABLE, bare ? nothing : scene->side_table,
                                   (bare ? 1 : scene->side_table_count) * sizeof nothing);
    return status;
}

/* The buffers that have words for each segment: BUFFER_SEGMENTS and the ones after it. */
enum { SEGMENT_BUFFERS = BUFFER_PLANES - BUFFER_SEGMENTS + 1, MOST_SEGMENTS = 1 << 20 };
typedef struct segment_words {
    size_t of[SEGMENT_BUFFERS], all;
} segment_words;

static segment_words count_segment_words(const camber_raster *raster) {
    segment_words words = {.of = {CAMBER_SEGMENT_WORDS, raster->end_edge ? CAMBER_SIXTEEN_EDGES_WORDS / 16 : 0, 1,
                                  raster->variant ? CAMBER_SEGMENT_ARC_LENGTHS : 0,
                                  is_pitched(raster) ? CAMBER_PLANE_WORDS : 0}};
    for (int i = 0; i < SEGMENT_BUFFERS; i++)
        words.all += words.of[i];
    return words;
}

static size_t segments_at_once(const camber_raster *raster) {
    const uint64_t bytes = camber_raster_most_bytes(raster, CAMBER_RASTER_SEGMENTS);
    const size_t fitting = (size_t)(bytes / (4 * count_segment_words(raster).all)) / 16 * 16;
    const size_t most = is_pitched(raster) ? MOST_SEGMENTS / 2 : MOST_SEGMENTS;
    return fitting < 16 ? 16 : fitting < most ? fitting : most;
}

/* Makes room for a multiple of 16 segments. Earlier pictures of other kinds may have left buffers, which count against
 * the same memory limit. */
static camber_status reserve_segments(camber_raster *raster, size_t segments) {
    const segment_words words = count_segment_words(raster);
    uint64_t all = 0;
    camber_status status = CAMBER_OK;
    for (int i = 0; i < SEGMENT_BUFFERS; i++) {
        const size_t held = raster->capacities[BUFFER_SEGMENTS + i], wanted = 4 * words.of[i] * segments;
        all += held > wanted ? held : wanted;
    }
    const bool too_many =
        raster->memory.allowed_bytes && all > camber_raster_most_bytes(raster, CAMBER_RASTER_SEGMENTS);
    for (int i = 0; i < SEGMENT_BUFFERS && too_many; i++)
        camber_raster_drop(raster, BUFFER_SEGMENTS + i);
    for (int i = 0; i < SEGMENT_BUFFERS && status == CAMBER_OK; i++)
        if (words.of[i])
            status = camber_raster_reserve(raster, BUFFER_SEGMENTS + i, 4 * words.of[i] * segments);
    return status;
}

static camber_status prepare(camber_raster *raster, const listed_scene *p) {
    const camber_raster_scene *scene = p->scene;
    const camber_range_list *list = &p->list;
    const size_t most = segments_at_once(raster), wanted = raster->segment_count ? raster->segment_count : 16;
    const size_t segments = wanted < most ? wanted : most;
    camber_status status = camber_raster_put(raster, BUFFER_ROWS, scene->rows,
                                             scene->row_count * CAMBER_RASTER_ROW_WORDS * sizeof *scene->rows);
    if (status == CAMBER_OK)
        status = camber_raster_put(raster, BUFFER_BRUSHES, scene->brushes, scene->brush_count * sizeof *scene->brushes);
    if (status == CAMBER_OK && list->change_count)
        status = camber_raster_put(raster, BUFFER_CHANGES, list->changes, list->change_count * sizeof *list->changes);
    if (status == CAMBER_OK)
        status = reserve_segments(raster, segments);
    if (status == CAMBER_OK && raster->end_edge)
        status = camber_raster_reserve(raster, BUFFER_BUNCHES, 4 * (segments / 16));
    if (status == CAMBER_OK && raster->variant)
        status = prepare_rich(raster, scene);
    if (status == CAMBER_OK && !raster->given)
        status = camber_raster_reserve(raster, BUFFER_PIXELS, camber_raster_bytes(&raster->area));
    return status;
}

/* Draws a slice of the band, unless its lists or the band's spills do not fit. */
static camber_status draw_slice(camber_raster *raster, const listed_scene *p, camber_spill_args k, bool *fits) {
    uint32_t chunk_count;
    const camber_bin_args c = cut_chunks(raster, &chunk_count);
    camber_status status = make_segments(raster, p);
    if (status == CAMBER_OK)
        status = count_segments(raster, c, chunk_count);
    if (status == CAMBER_OK)
        status = start_lists(raster, fits);
    if (status == CAMBER_OK && *fits)
        status = place_spills(raster, k, fits);
    if (status != CAMBER_OK || !*fits)
        return status;
    size_t heavy, jobs;
    raster->slice_count++;
    status = list_jobs(raster, k, &heavy, &jobs);
    if (status == CAMBER_OK)
        status = scatter_segments(raster, c, chunk_count);
    if (status == CAMBER_OK)
        status = wind_rows(raster, c.of);
    return status == CAMBER_OK ? rasterize_tiles(raster, p->scene, k, heavy, jobs) : status;
}

/* Draws the band's slices, from the last to the first. If the lists or spills of one do not fit, it either stops, so
 * that the caller halves the band, or halves the slice. */
static camber_status draw_band(camber_raster *raster, const listed_scene *p, bool *fits) {
    size_t most = segments_at_once(raster), left = p->list.segment_count;
    camber_spill_args k = plan_spill(raster, p->scene);
    camber_status status = CAMBER_OK;
    raster->tile_count = (size_t)raster->columns * camber_raster_tiles(raster->band.height);
    raster->list_count = raster->tile_count + (raster->end_edge ? camber_raster_tiles(raster->band.height) : 0);
    if (begin_spills(raster) != CAMBER_OK)
        return CAMBER_ERROR_MEMORY;
    do {
        raster->segment_count = left < most ? left : most;
        raster->first_segment = left - raster->segment_count;
        k.is_last = raster->first_segment == 0;
        *fits = true;
        status = draw_slice(raster, p, k, fits);
        if (*fits)
            left = raster->first_segment;
        else if (raster->band.height > CAMBER_TILE_PX)
            return status;
        else
            most = (raster->segment_count / 2 + 15) / 16 * 16;
    } while (status == CAMBER_OK && left > 0);
    return status;
}

/* Draws the area's bands. The first band is the whole area. A band whose lists or spills do not fit is halved, and so
 * are the bands after it. A band of `sure` rows can always be spilled, so a lack of room for spills never makes a band
 * smaller than that. */
static camber_status draw_bands(camber_raster *raster, const listed_scene *p) {
    const camber_raster_area *area = &raster->area;
    const uint32_t sure = (uint32_t)(most_spills(raster, plan_spill(raster, p->scene)) / raster->columns);
    uint32_t rows = camber_raster_tiles(area->height);
    camber_status status = CAMBER_OK;
    raster->band = *area;
    for (uint32_t done = 0; done < area->height && status == CAMBER_OK;) {
        const uint32_t left = area->height - done, tallest = rows * CAMBER_TILE_PX;
        bool fits = true;
        raster->band.y = area->y + done;
        raster->band.height = left < tallest ? left : tallest;
        status = draw_band(raster, p, &fits);
        const uint32_t drawn = camber_raster_tiles(raster->band.height), half = (drawn + 1) / 2;
        if (fits)
            done += raster->band.height;
        else
            rows = half < sure && sure < drawn ? sure : half;
    }
    return status;
}

camber_status camber_raster_draw_into(camber_raster *raster, const camber_raster_scene *scene,
                                      const camber_raster_area *area, camber_buffer *pixels) {
    camber_context *context = raster->device->context;
    listed_scene p = {.scene = scene, .list = {.context = context}};
    memset(raster->ms, 0, sizeof raster->ms);
    raster->slice_count = 0;
    raster->area = *area;
    raster->given = pixels;
    raster->columns = camber_raster_tiles(area->width);
    raster->variant = camber_raster_variant(scene);
    camber_status status = camber_device_raster_program(raster->device, raster->variant, &raster->program);
    if (status == CAMBER_OK)
        status = camber_raster_list_ranges(context, scene, &p.list);
    raster->segment_count = p.list.segment_count;
    raster->first_edge = p.list.first_edge;
    raster->end_edge = p.list.end_edge;
    if (status == CAMBER_OK)
        status = prepare(raster, &p);
    if (status == CAMBER_OK)
        status = draw_bands(raster, &p);
    const camber_status settled = settle(raster);
    if (status != CAMBER_OK)
        /* the caller may free the scene, so the device must have copied everything that was put */
        camber_device_settle(raster->device);
    status = status == CAMBER_OK ? settled : status;
    camber_raster_free_ranges(&p.list);
    return status;
}

camber_status camber_raster_draw(camber_raster *raster, const camber_raster_scene *scene,
                                 const camber_raster_area *area) {
    return camber_raster_draw_into(raster, scene, area, NULL);
}
