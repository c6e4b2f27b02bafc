/* Schedules metatiles: zoom by zoom, in the order of the Hilbert curve, which is the order of archives.
 *
 * Input: censuses, and the area that is wanted. Output: tasks, and which of them belong to a shard (called part here:
 * one of several processes that share a run). Main idea: a part reads what it draws, so each part is a stretch of a
 * walk through the pyramid that stays in one area of the map for as long as possible.
 *
 * At a wide zoom, one metatile covers much of the data. Parts with such tasks read all data, so these tasks can be
 * combined in any way. At deep zooms, the walk visits each metatile before those below it, along the Hilbert curve, so
 * a part reads one compact area.
 *
 * Wide tasks are packed, the largest first, each into the first part that has room for it. The deep tasks are one
 * sequence, which is cut: at each deep zoom, a part has one stretch of the archive. The cost of the most expensive part
 * is minimised first, and then the cost of the most expensive part of the other kind. */
#include "tiles/schedule.h"

#include "archive/pmtiles.h"

#include <math.h>
#include <stdlib.h>

/* The cost of a metatile, in microseconds of one processor: PICTURE_US for each metatile, plus TILE_US and POINT_US for
 * each of its tiles and points, including the time to find them. After adding a quarter of a second for each part's
 * start and reading, which is the same for all parts, the model predicts the times of parts (8, 16 and 32 parts) with
 * an error of 7 % (root mean square; 10 million points, 2026-11-27, 9412da4, Intel Xeon, AVX-512). */
static const double PICTURE_US = 1.3e3, TILE_US = 120.0, POINT_US = 0.58;
/* A part with a wide metatile holds all points. If it also has deep ones, it searches all points for each of their
 * zooms. The search for wide zooms is included in POINT_US, because their metatiles contain most of the points. */
static const double LOOK_US = 0.024;
/* Censuses with at most this many polylines in all are kept for drawing; others are taken again. */
static const size_t MOST_KEPT = (size_t)1 << 22;
/* A zoom is wide if one metatile has more of its points than this share. */
static const double WIDE_SHARE = 0.125;
enum { CUT_STEPS = 24 }; /* to less than a millionth of the sum */

static unsigned count_tiles(uint64_t tiles) {
    unsigned count = 0;
    for (; tiles; tiles &= tiles - 1)
        count++;
    return count;
}

double camber_task_cost(const camber_tile_task *task) {
    if (!task->touched)
        return 0.0;
    return PICTURE_US + TILE_US * count_tiles(task->touched) + POINT_US * (double)task->points;
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
    uint64_t number; /* the number of one of the metatile's tiles */
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
    /* Any tile's number sorts metatiles correctly, because the tiles of a metatile have consecutive numbers. */
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
        camber_progress_count(engine->context, "finding where lines are", "zooms", (uint64_t)(zoom - area->min_zoom),
                              (uint64_t)(area->max_zoom - area->min_zoom + 1));
        status = camber_engine_open_zoom(engine, zoom, &opened);
        if (status == CAMBER_OK)
            status = camber_engine_add_label_tiles(engine, zoom, area);
        if (status != CAMBER_OK)
            break;
        status = all ? add_all(schedule, &opened->census, area) : add_touched(schedule, &opened->census, area);
        schedule->has_arc_length = schedule->has_arc_length || opened->plan->plan.has_arc_length;
        for (size_t i = 0; i < opened->census.metatile_count; i++)
            kept += opened->census.metatiles[i].end - opened->census.metatiles[i].first;
        if (kept > MOST_KEPT)
            camber_engine_forget_zoom(engine, zoom);
    }
    return status == CAMBER_OK ? camber_schedule_choose(schedule, 1, 1) : status;
}

void camber_schedule_free(camber_schedule *schedule) {
    if (schedule->context)
        camber_free(schedule->context, schedule->tasks);
    *schedule = (camber_schedule){0};
}

/* ---- Parts ---- */

/* The position of a task in the walk. Wide tasks are sorted by cost, the largest first. A deep task is sorted by the
 * first metatile below it at the deepest level: a walk that goes from each metatile to those below it visits them in
 * this order. */
typedef struct turn {
    uint64_t place;
    size_t task;
} turn;

typedef struct walk {
    const camber_schedule *schedule;
    size_t *order;   /* the tasks: wide ones, then deep ones */
    double *costs;   /* of the tasks, in that order */
    size_t wide;     /* number of wide tasks */
    double joining;  /* extra cost of deep tasks in a part that also has a wide one */
    double *loads;   /* costs of the parts; shards of them */
    uint32_t shards; /* at most as many as there are tasks */
} walk;

static int compare_turns(const void *left, const void *right) {
    const turn *a = left, *b = right;
    return a->place != b->place ? (a->place < b->place ? -1 : 1) : a->task < b->task ? -1 : a->task > b->task;
}

/* Counts the wide tasks. Tasks are sorted by zoom, and all wide zooms are lower than the deep ones. */
static size_t count_wide(const camber_schedule *s) {
    size_t wide = 0;
    for (size_t first = 0, end; first < s->count; first = end) {
        double all = 0.0, most = 0.0;
        for (end = first; end < s->count && s->tasks[end].zoom == s->tasks[first].zoom; end++) {
            all += (double)s->tasks[end].points;
            most = fmax(most, (double)s->tasks[end].points);
        }
        if (most > WIDE_SHARE * all)
            wide = end;
    }
    return wide;
}

static camber_status order_tasks(walk *w) {
    const camber_schedule *s = w->schedule;
    int deepest = 0;
    turn *list = camber_alloc(s->context, s->count, sizeof *list);
    if (!list || !(w->order = camber_alloc(s->context, s->count, sizeof *w->order)) ||
        !(w->costs = camber_alloc(s->context, s->count, sizeof *w->costs))) {
        camber_free(s->context, list);
        return CAMBER_ERROR_MEMORY;
    }
    for (size_t i = w->wide; i < s->count; i++)
        deepest = s->tasks[i].level > deepest ? s->tasks[i].level : deepest;
    for (size_t i = 0; i < s->count; i++) {
        const camber_tile_task *task = s->tasks + i;
        const uint64_t rank =
            camber_pmtiles_number(task->level, task->column, task->row) - camber_pmtiles_number(task->level, 0, 0);
        list[i] = (turn){
            i < w->wide ? UINT64_MAX - (uint64_t)camber_task_cost(task) : rank << (2 * (deepest - task->level)), i};
    }
    qsort(list, w->wide, sizeof *list, compare_turns);
    qsort(list + w->wide, s->count - w->wide, sizeof *list, compare_turns);
    for (size_t i = 0; i < s->count; i++) {
        w->order[i] = list[i].task;
        w->costs[i] = camber_task_cost(s->tasks + list[i].task);
    }
    camber_free(s->context, list);
    return CAMBER_OK;
}

/* The highest cost of a part to which a wide task is added, and of one to which a deep task is added, unless the part
 * has only that task. */
typedef struct limits {
    double wide, deep;
} limits;

/* Fills the parts. parts receives the part of each task, counted from 1; it may be NULL. Returns whether the number of
 * parts suffices. */
static bool fill(const walk *w, limits most, uint32_t *parts) {
    uint32_t count = 0;
    for (size_t i = 0; i < w->schedule->count; i++) {
        const bool wide = i < w->wide;
        const double room = (wide ? most.wide : most.deep) - w->costs[i], joining = i == w->wide ? w->joining : 0.0;
        uint32_t at = wide || count == 0 ? 0 : count - 1;
        while (at < count && w->loads[at] + joining > room)
            at++;
        if (at < count)
            w->loads[at] += joining;
        else if (count < w->shards)
            w->loads[count++] = 0.0;
        else
            return false;
        w->loads[at] += w->costs[i];
        if (parts)
            parts[w->order[i]] = at + 1;
    }
    return true;
}

/* Finds the lowest limits between low and high for which the number of parts suffices. */
static limits lower_limits(const walk *w, limits low, limits high) {
    for (int i = 0; i < CUT_STEPS; i++) {
        const limits middle = {0.5 * (low.wide + high.wide), 0.5 * (low.deep + high.deep)};
        if (fill(w, middle, NULL))
            high = middle;
        else
            low = middle;
    }
    return high;
}

/* First minimises the cost of the most expensive part, then that of the most expensive part of the other kind. */
static limits find_limits(const walk *w) {
    double all = w->joining;
    for (size_t i = 0; i < w->schedule->count; i++)
        all += w->costs[i];
    all *= 2.0; /* then one part suffices, however sums are rounded */
    const limits both = lower_limits(w, (limits){0.0, 0.0}, (limits){all, all});
    const limits deep = lower_limits(w, (limits){both.wide, 0.0}, both);
    return lower_limits(w, (limits){0.0, deep.deep}, deep);
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
    walk w = {.schedule = schedule, .shards = shards < schedule->count ? shards : (uint32_t)schedule->count};
    if (shards <= 1 || schedule->count == 0) {
        keep_part(schedule, NULL, shard);
        return CAMBER_OK;
    }
    uint32_t *parts = camber_alloc(schedule->context, schedule->count, sizeof *parts);
    w.wide = count_wide(schedule);
    for (size_t i = w.wide; i < schedule->count; i++)
        w.joining += LOOK_US * (double)schedule->tasks[i].points;
    w.loads = camber_alloc(schedule->context, w.shards, sizeof *w.loads);
    const camber_status status = parts && w.loads ? order_tasks(&w) : CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK) {
        (void)fill(&w, find_limits(&w), parts);
        keep_part(schedule, parts, shard);
    }
    camber_free(schedule->context, w.order);
    camber_free(schedule->context, w.costs);
    camber_free(schedule->context, w.loads);
    camber_free(schedule->context, parts);
    return status;
}
