/* Schedules metatiles: zoom by zoom, along the Hilbert curve, as archives have them.
 *
 * Input: censuses, and the area that is wanted. Output: tasks, and which of them a part has. Main idea: a part of a run
 * reads what it draws, so parts are runs of a walk through the pyramid that stays in one place as long as it can.
 *
 *     wide zooms     zoom by zoom: a metatile of them has much of the data. Their parts read all of it
 *     deep zooms     each metatile, then those below it, along the Hilbert curve. So a part reads one stretch
 *
 * At each deep zoom a part has one stretch of the archive. Runs are cut so that the part that takes longest takes as
 * little as can be, what it reads included. */
#include "tiles/schedule.h"

#include "source/pmtiles.h"

#include <math.h>
#include <stdlib.h>

/* The time that a picture and a tile take besides its points, in points; 2026-11-25, two cores of an AMD EPYC. */
static const double PICTURE_COST = 12e3, TILE_COST = 1.6e3;
/* Censuses that are kept for drawing take so many polylines at most; others are made a second time. */
static const size_t MOST_KEPT = (size_t)1 << 22;
/* The time to take a point from the file of features, in points that are drawn; and to pass over it. */
static const double READ_COST = 0.15, SKIP_COST = 0.12;
/* The time to look whether deep tiles have a point. A part that goes on from wide zooms to deep ones holds all points.
 */
static const double LOOK_COST = 0.2;
/* A zoom is wide if one metatile has more of its points than this share. */
static const double WIDE_SHARE = 0.125;
/* A point takes up to so much longer where many lie in a tile; half of that where so many do (2026-11-26). */
static const double DENSE_COST = 0.6, DENSE_POINTS = 50e3;
/* Where more points lie in a square of 32 px they hide each other, and each takes less: as the root of their number
 * (2026-11-26, of 10 million points in one tile 0.37 us, in tiles of zoom 3 0.8). The squares are tiles of a zoom that
 * is so many deeper. */
static const double CROWD_POINTS = 600e3;
enum { CROWD_ZOOMS = 3 };
enum { CUT_STEPS = 60 };

static unsigned count_tiles(uint64_t tiles) {
    unsigned count = 0;
    for (; tiles; tiles &= tiles - 1)
        count++;
    return count;
}

double camber_task_cost(const camber_tile_task *task) {
    if (!task->touched)
        return 0.0;
    const double points = (double)task->points, tiles = count_tiles(task->touched), density = points / tiles;
    const double more = DENSE_COST * density / (density + DENSE_POINTS);
    return PICTURE_COST + points * (1.0 + more) + TILE_COST * tiles;
}

static camber_status add_task(camber_schedule *schedule, const camber_tile_task *task) {
    if (!camber_grow(schedule->context, &schedule->tasks, &schedule->capacity, schedule->count + 1,
                     sizeof *schedule->tasks))
        return CAMBER_ERROR_MEMORY;
    schedule->tasks[schedule->count++] = *task;
    return CAMBER_OK;
}

/* ---- Metatiles that lines touch ---- */

static camber_status add_touched(camber_schedule *schedule, const camber_census *census,
                                 const camber_tiles_area *area) {
    for (size_t i = 0; i < census->metatile_count; i++) {
        const camber_metatile *metatile = census->metatiles + i;
        const uint64_t wanted =
            metatile->tiles & camber_tiles_area_pick(area, census->zoom, census->side, metatile->column, metatile->row);
        const camber_tile_task task = {census->zoom,     camber_metatile_level(census->zoom, census->side),
                                       metatile->column, metatile->row,
                                       wanted,           wanted,
                                       metatile->points};
        const camber_status status = wanted ? add_task(schedule, &task) : CAMBER_OK;
        if (status != CAMBER_OK)
            return status;
    }
    return CAMBER_OK;
}

/* ---- All metatiles ---- */

typedef struct place {
    uint64_t number; /* of the metatile's first tile */
    uint32_t column, row;
} place;

typedef struct places {
    camber_context *context;
    place *items;
    size_t count, capacity;
} places;

static int compare_places(const void *left, const void *right) {
    const place *a = left, *b = right;
    return a->number < b->number ? -1 : a->number > b->number;
}

static bool add_place(places *list, int zoom, uint32_t side, uint32_t column, uint32_t row) {
    if (!camber_grow(list->context, &list->items, &list->capacity, list->count + 1, sizeof *list->items))
        return false;
    /* The least number of a metatile's tiles goes by its place along the curve, and any of them does for sorting. */
    list->items[list->count++] = (place){camber_pmtiles_number(zoom, column * side, row * side), column, row};
    return true;
}

static bool list_range(places *list, const camber_tiles_area *area, int zoom, uint32_t side) {
    const camber_metatile_range range = camber_tiles_area_metatiles(area, zoom, side);
    const int64_t metatiles = ((int64_t)1 << zoom) / side;
    for (int64_t row = range.first_row; row <= range.last_row; row++)
        for (int64_t column = range.first_column; column <= range.last_column; column++)
            if (!add_place(list, zoom, side, (uint32_t)(((column % metatiles) + metatiles) % metatiles), (uint32_t)row))
                return false;
    return true;
}

static bool list_listed(places *list, const camber_tiles_area *area, int zoom, uint32_t side) {
    const uint64_t first = camber_pmtiles_number(zoom, 0, 0), end = camber_pmtiles_number(zoom + 1, 0, 0);
    for (size_t i = 0; i < area->tile_count; i++) {
        uint32_t column, row;
        if (area->tiles[i] < first || area->tiles[i] >= end)
            continue;
        camber_pmtiles_locate(area->tiles[i] - first, zoom, &column, &row);
        if (!add_place(list, zoom, side, column / side, row / side))
            return false;
    }
    return true;
}

static bool list_counted(places *list, const camber_census *census) {
    for (size_t i = 0; i < census->metatile_count; i++)
        if (!add_place(list, census->zoom, census->side, census->metatiles[i].column, census->metatiles[i].row))
            return false;
    return true;
}

static camber_status add_all(camber_schedule *schedule, const camber_census *census, const camber_tiles_area *area) {
    const int zoom = census->zoom;
    const uint32_t side = census->side;
    places list = {.context = schedule->context};
    camber_status status = CAMBER_OK;
    if (!(area->tiles ? list_listed(&list, area, zoom, side)
                      : list_range(&list, area, zoom, side) && list_counted(&list, census)))
        status = CAMBER_ERROR_MEMORY;
    if (list.count)
        qsort(list.items, list.count, sizeof *list.items, compare_places);
    for (size_t i = 0; i < list.count && status == CAMBER_OK; i++) {
        const place *at = list.items + i;
        if (i > 0 && at->number == at[-1].number)
            continue;
        const camber_metatile *metatile = camber_census_find(census, at->column, at->row);
        const uint64_t touched =
            metatile ? metatile->tiles & camber_tiles_area_pick(area, zoom, side, at->column, at->row) : 0;
        const uint64_t kept = area->tiles ? camber_tiles_area_pick(area, zoom, side, at->column, at->row)
                                          : camber_tiles_area_pick_bounds(area, zoom, side, at->column, at->row);
        const camber_tile_task task = {zoom,    camber_metatile_level(zoom, side), at->column, at->row, touched | kept,
                                       touched, metatile ? metatile->points : 0};
        if (task.wanted)
            status = add_task(schedule, &task);
    }
    camber_free(schedule->context, list.items);
    return status;
}

/* ---- The schedule ---- */

void camber_schedule_meet(const camber_schedule *schedule, camber_tiles_area *area) {
    for (size_t i = 0; i < schedule->count; i++) {
        const camber_tile_task *task = schedule->tasks + i;
        const uint32_t side = camber_task_side(task);
        for (uint32_t k = 0; k < side * side; k++)
            if (task->touched >> k & 1)
                camber_tiles_area_meet(area, task->zoom, task->column * side + k % side, task->row * side + k / side);
    }
}

camber_status camber_schedule_make(camber_tiles_engine *engine, const camber_tiles_area *area, bool all,
                                   camber_schedule *schedule) {
    size_t kept = 0;
    camber_status status = CAMBER_OK;
    *schedule = (camber_schedule){.context = engine->context};
    for (int zoom = area->min_zoom; zoom <= area->max_zoom && status == CAMBER_OK; zoom++) {
        camber_engine_zoom *opened;
        camber_progress(engine->context, "looking where lines are",
                        (double)(zoom - area->min_zoom) / (area->max_zoom - area->min_zoom + 1));
        status = camber_engine_open_zoom(engine, zoom, &opened);
        if (status != CAMBER_OK)
            break;
        status = all ? add_all(schedule, &opened->census, area) : add_touched(schedule, &opened->census, area);
        schedule->has_arc_length = schedule->has_arc_length || opened->plan->plan.has_arc_length;
        for (size_t i = 0; i < opened->census.metatile_count; i++)
            kept += opened->census.metatiles[i].end - opened->census.metatiles[i].first;
        if (kept > MOST_KEPT)
            camber_tiles_engine_forget(engine, zoom);
    }
    return status == CAMBER_OK ? camber_schedule_choose(schedule, 1, 1) : status;
}

void camber_schedule_free(camber_schedule *schedule) {
    if (schedule->context)
        camber_free(schedule->context, schedule->tasks);
    *schedule = (camber_schedule){0};
}

/* ---- Parts ---- */

/* A deep task: where a walk meets it that goes from a metatile to those below it. */
typedef struct deep_task {
    uint64_t place; /* of the first metatile below it, at the deepest level */
    size_t task;
} deep_task;

typedef struct walk {
    const camber_schedule *schedule;
    size_t *order; /* of the tasks: wide ones, then deep ones */
    size_t wide;   /* so many are wide */
    int deepest;   /* zoom */
    double read_all, skip_all, look_all;
    double crowd[CAMBER_LARGEST_TILE_ZOOM + 1]; /* of each zoom: what a point's time is multiplied by */
} walk;

static int compare_deep(const void *left, const void *right) {
    const deep_task *a = left, *b = right;
    return a->place != b->place ? (a->place < b->place ? -1 : 1) : a->task < b->task ? -1 : a->task > b->task;
}

/* Finds out what the walk is like: the tasks come by zoom, and a deep zoom has no wide one below it. */
static void measure(walk *w) {
    const camber_schedule *s = w->schedule;
    double points[CAMBER_LARGEST_TILE_ZOOM + 1] = {0}, tiles[CAMBER_LARGEST_TILE_ZOOM + 1] = {0};
    for (size_t i = 0; i < s->count; i++) {
        points[s->tasks[i].zoom] += (double)s->tasks[i].points;
        tiles[s->tasks[i].zoom] += count_tiles(s->tasks[i].touched);
    }
    for (int z = 0; z <= CAMBER_LARGEST_TILE_ZOOM; z++) {
        const double most = z + CROWD_ZOOMS <= CAMBER_LARGEST_TILE_ZOOM ? CROWD_POINTS * tiles[z + CROWD_ZOOMS] : 0.0;
        w->crowd[z] = most > 0.0 && points[z] > most ? sqrt(most / points[z]) : 1.0;
    }
    for (size_t first = 0, end; first < s->count; first = end) {
        uint64_t most = 0, all = 0;
        for (end = first; end < s->count && s->tasks[end].zoom == s->tasks[first].zoom; end++) {
            all += s->tasks[end].points;
            most = s->tasks[end].points > most ? s->tasks[end].points : most;
        }
        if ((double)most > WIDE_SHARE * (double)all)
            w->wide = end;
        w->deepest = s->tasks[first].zoom;
        w->read_all = READ_COST * (double)all;
        w->skip_all = SKIP_COST * (double)all;
        w->look_all = LOOK_COST * (double)all;
    }
}

static camber_status order_tasks(walk *w) {
    const camber_schedule *s = w->schedule;
    const size_t deep = s->count - w->wide;
    int deepest = 0;
    deep_task *list = camber_alloc(s->context, deep, sizeof *list);
    if (!list || !(w->order = camber_alloc(s->context, s->count, sizeof *w->order))) {
        camber_free(s->context, list);
        return CAMBER_ERROR_MEMORY;
    }
    for (size_t i = w->wide; i < s->count; i++)
        deepest = s->tasks[i].level > deepest ? s->tasks[i].level : deepest;
    for (size_t i = 0; i < deep; i++) {
        const camber_tile_task *task = s->tasks + w->wide + i;
        const uint64_t rank =
            camber_pmtiles_number(task->level, task->column, task->row) - camber_pmtiles_number(task->level, 0, 0);
        list[i] = (deep_task){rank << (2 * (deepest - task->level)), w->wide + i};
    }
    if (deep)
        qsort(list, deep, sizeof *list, compare_deep);
    for (size_t i = 0; i < s->count; i++)
        w->order[i] = i < w->wide ? i : list[i - w->wide].task;
    camber_free(s->context, list);
    return CAMBER_OK;
}

/* Fills parts, none of which takes longer than most unless it is a single task. parts gets each task's, from 1; NULL:
 * they are counted alone. Returns how many there are. */
static uint64_t fill(const walk *w, double most, uint32_t *parts) {
    uint64_t part = 1;
    double sum = w->skip_all + (w->wide ? w->read_all : 0.0);
    bool empty = true;
    for (size_t i = 0; i < w->schedule->count; i++) {
        const camber_tile_task *task = w->schedule->tasks + w->order[i];
        const double reads = i >= w->wide && task->zoom == w->deepest ? READ_COST * (double)task->points : 0.0;
        const double cost = w->crowd[task->zoom] * camber_task_cost(task) + reads;
        if (i == w->wide && !empty)
            sum += w->look_all;
        if (sum + cost > most && !empty) {
            part++;
            sum = w->skip_all + (i < w->wide ? w->read_all : 0.0);
        }
        empty = false;
        sum += cost;
        if (parts)
            parts[w->order[i]] = (uint32_t)part;
    }
    return part;
}

/* Finds the least time that the longest part takes. */
static double find_most(const walk *w, uint32_t shards) {
    double low = 0.0, high = w->read_all + w->skip_all + w->look_all;
    for (size_t i = 0; i < w->schedule->count; i++)
        high += (1.0 + READ_COST) * camber_task_cost(w->schedule->tasks + i);
    for (int i = 0; i < CUT_STEPS; i++) {
        const double middle = 0.5 * (low + high);
        if (fill(w, middle, NULL) <= shards)
            high = middle;
        else
            low = middle;
    }
    return high;
}

static void keep_part(camber_schedule *schedule, const uint32_t *parts, uint32_t shard) {
    size_t kept = 0;
    schedule->cost = 0.0;
    for (size_t i = 0; i < schedule->count; i++) {
        if (parts && parts[i] != shard)
            continue;
        schedule->tasks[kept++] = schedule->tasks[i];
        schedule->cost += camber_task_cost(schedule->tasks + i);
    }
    schedule->count = kept;
}

camber_status camber_schedule_choose(camber_schedule *schedule, uint32_t shard, uint32_t shards) {
    walk w = {.schedule = schedule};
    if (shards <= 1 || schedule->count == 0) {
        keep_part(schedule, NULL, shard);
        return CAMBER_OK;
    }
    measure(&w);
    uint32_t *parts = camber_alloc(schedule->context, schedule->count, sizeof *parts);
    const camber_status status = parts ? order_tasks(&w) : CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK) {
        (void)fill(&w, find_most(&w, shards), parts);
        keep_part(schedule, parts, shard);
    }
    camber_free(schedule->context, w.order);
    camber_free(schedule->context, parts);
    return status;
}
