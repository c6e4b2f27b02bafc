/* Draws a pyramid of tiles into an archive.
 *
 * Input: an engine, and the tiles that are wanted. Output: an archive. Main idea: the calling thread makes networks,
 * draws pictures and writes tiles, while other threads cut and encode the pictures. Each picture is a unit of the
 * archive's writer, so a killed run loses only the pictures in progress.
 *
 *     census -> schedule -> [resumed?] -> draw --> encode (threads) --> writer --> archive
 *                                          ^------- the next picture ----' */
#define _XOPEN_SOURCE 700

#include "archive/archive.h"
#include "archive/pmtiles.h"
#include "features/features.h"
#include "features/mercator.h"
#include "map/plan.h"
#include "style/style.h"
#include "tiles/encoding.h"
#include "tiles/features_file.h"
#include "tiles/label_record.h"
#include "tiles/schedule_file.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <unistd.h>

typedef struct pyramid {
    camber_context *context;
    camber_tiles_engine *engine;
    const camber_tiles_draw_desc *desc;
    camber_tiles_area area;
    camber_schedule schedule;
    camber_archive *renewed;    /* the archive whose tiles are replaced. NULL: none */
    camber_label_record labels; /* of the archive, if they are recorded; otherwise context is NULL */
    camber_archive_writer *writer;
    camber_encode_queue *queue;
    camber_tiles_stats stats;
    char fingerprint[CAMBER_FINGERPRINT_SIZE];
    double done_cost;
    uint64_t done_tiles, wanted_tiles; /* of the schedule's tasks */
    double weight;                     /* of the next picture: see camber_encode_job */
    /* A tile that shows only the background, for tiles that are kept although they are empty. */
    uint8_t *blank;
    size_t blank_bytes, blank_capacity;
    int blank_zoom; /* negative: none yet */
} pyramid;

static uint64_t unit_of(const camber_tile_task *task, uint32_t side) {
    return camber_pmtiles_number(task->zoom, task->column * side, task->row * side);
}

static uint64_t count_bits(uint64_t bits) {
    uint64_t count = 0;
    for (; bits; bits &= bits - 1)
        count++;
    return count;
}

/* ---- Writing ---- */

static camber_tile_index tile_of(const camber_tiles_picture *picture, uint32_t bit) {
    return (camber_tile_index){picture->column + bit % picture->side, picture->row + bit / picture->side};
}

/* Returns the nth tile of a picture along the Hilbert curve, which is the order of tiles in an archive. */
static uint32_t bit_along_curve(const camber_tiles_picture *picture, uint64_t unit, uint32_t n) {
    uint32_t column, row;
    const uint64_t zoom_first = camber_pmtiles_number(picture->zoom, 0, 0), count = picture->side * picture->side;
    camber_pmtiles_locate((unit - zoom_first) / count * count + n, picture->zoom, &column, &row);
    return (row - picture->row) * picture->side + column - picture->column;
}

/* Passes the tiles of an encoded picture to the writer, which takes ownership of them. */
static camber_status write_job(pyramid *p, const camber_encode_job *job) {
    const double start_ms = camber_now_ms();
    const camber_tiles_picture *picture = &job->picture;
    camber_status status = job->status;
    for (uint32_t n = 0; n < picture->side * picture->side && status == CAMBER_OK; n++) {
        const uint32_t bit = bit_along_curve(picture, job->unit, n);
        const camber_encoded_tile *tile = job->tiles + bit;
        if (!(job->wanted >> bit & 1))
            continue;
        if (tile->size_bytes && !p->desc->dry_run)
            status = camber_archive_writer_add(p->writer, picture->zoom, tile_of(picture, bit), tile->bytes,
                                               tile->size_bytes);
        else if (p->renewed)
            status = camber_archive_writer_remove(p->writer, picture->zoom, tile_of(picture, bit));
        p->stats.tiles += tile->size_bytes > 0;
        p->stats.background += tile->size_bytes == 0;
        p->stats.bytes += (uint64_t)(job->weight * (double)tile->size_bytes + 0.5);
    }
    if (status == CAMBER_OK && !p->desc->dry_run)
        status = camber_archive_writer_end_unit(p->writer, job->unit);
    p->stats.write_ms += camber_now_ms() - start_ms;
    return status;
}

/* Writes all encoded pictures. If waits is true, it first waits for at least one picture, if any is in progress. */
static camber_status write_ready(pyramid *p, bool waits) {
    camber_encode_job *job;
    camber_status status = CAMBER_OK;
    do {
        const double start_ms = camber_now_ms();
        job = camber_encode_queue_take(p->queue, waits);
        p->stats.wait_ms += camber_now_ms() - start_ms;
        if (!job)
            return CAMBER_OK;
        status = write_job(p, job);
        camber_encode_queue_release(p->queue, job);
        waits = false;
    } while (status == CAMBER_OK);
    return status;
}

/* ---- Tiles without lines ---- */

static camber_status make_blank(pyramid *p, int zoom) {
    const uint32_t px = p->engine->tile_px;
    const camber_encoder_desc desc = {.encoding = p->desc->encoding, .quality = p->desc->quality};
    camber_encoder *encoder = NULL;
    const uint8_t *bytes = NULL;
    uint8_t *rgba = camber_alloc(p->context, px, 4 * (size_t)px);
    camber_status status = rgba ? camber_encoder_create(p->context, &desc, &encoder) : CAMBER_ERROR_MEMORY;
    for (size_t i = 0; rgba && i < (size_t)px * px; i++)
        memcpy(rgba + 4 * i, p->engine->zooms[zoom].background, 4);
    const camber_pixels pixels = {.rgba = rgba, .width = px, .height = px};
    if (status == CAMBER_OK)
        status = camber_encoder_encode(encoder, &pixels, &bytes, &p->blank_bytes);
    if (status == CAMBER_OK && !camber_grow(p->context, &p->blank, &p->blank_capacity, p->blank_bytes, 1))
        status = CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK) {
        memcpy(p->blank, bytes, p->blank_bytes);
        p->blank_zoom = zoom;
    }
    camber_encoder_destroy(encoder);
    camber_free(p->context, rgba);
    return status;
}

/* Writes a metatile that no line touches: its tiles are stored as blanks, or removed. */
static camber_status write_blanks(pyramid *p, const camber_tile_task *task, const camber_tiles_picture *picture) {
    const bool keeps = p->desc->keep_empty, makes = keeps && p->blank_zoom != task->zoom;
    camber_status status = CAMBER_OK;
    while (makes && status == CAMBER_OK && camber_encode_queue_is_busy(p->queue))
        status = write_ready(p, true); /* the tiles before it must be written first */
    if (makes && status == CAMBER_OK)
        status = make_blank(p, task->zoom);
    for (uint32_t bit = 0; bit < picture->side * picture->side && status == CAMBER_OK; bit++) {
        if (!(task->wanted >> bit & 1))
            continue;
        const camber_tile_index tile = tile_of(picture, bit);
        if (!p->desc->dry_run)
            status = keeps ? camber_archive_writer_add(p->writer, task->zoom, tile, p->blank, p->blank_bytes)
                           : camber_archive_writer_remove(p->writer, task->zoom, tile);
        p->stats.tiles += keeps;
        p->stats.bytes += keeps ? (uint64_t)(p->weight * (double)p->blank_bytes + 0.5) : 0;
    }
    return status == CAMBER_OK && !p->desc->dry_run
               ? camber_archive_writer_end_unit(p->writer, unit_of(task, picture->side))
               : status;
}

/* ---- Drawing ---- */

/* Draws a metatile of an open zoom, and queues it for the threads that encode. */
static camber_status draw_task(pyramid *p, const camber_tile_task *task, const camber_metatile *metatile) {
    camber_encode_job *job;
    camber_status status = write_ready(p, false);
    while (status == CAMBER_OK && !(job = camber_encode_queue_get_free(p->queue)))
        status = write_ready(p, true);
    if (status != CAMBER_OK)
        return status;
    job->picture = camber_engine_describe(p->engine, task->zoom, task->column, task->row, metatile);
    job->wanted = task->wanted;
    job->unit = unit_of(task, job->picture.side);
    job->weight = p->weight;
    job->drops_background = !p->desc->keep_empty && job->picture.has_background;
    if (!p->desc->keep_empty && !job->picture.has_background && !p->renewed)
        job->wanted &= task->touched;
    job->ratio = p->engine->desc.ratio;
    if (p->engine->desc.meshes)
        status = camber_engine_tessellate_metatile(p->engine, metatile, &job->picture, &job->lines);
    else
        status = camber_engine_draw_metatile(p->engine, metatile, job->rgba, &job->picture);
    if (status != CAMBER_OK)
        return status;
    memcpy(job->background, job->picture.background, sizeof job->background);
    camber_encode_queue_put(p->queue, job);
    p->stats.units++;
    p->stats.points += task->points;
    return CAMBER_OK;
}

static camber_status do_task(pyramid *p, const camber_tile_task *task) {
    camber_engine_zoom *zoom;
    const uint32_t side = camber_engine_side(p->engine, task->zoom);
    if (!p->desc->dry_run && camber_archive_writer_has_unit(p->writer, unit_of(task, side))) {
        p->stats.resumed++;
        return CAMBER_OK;
    }
    camber_status status = camber_engine_open_zoom(p->engine, task->zoom, &zoom);
    if (status != CAMBER_OK)
        return status;
    const camber_metatile *metatile = camber_census_find(&zoom->census, task->column, task->row);
    if (task->touched || !zoom->has_background)
        return draw_task(p, task, metatile);
    const camber_tiles_picture picture =
        camber_engine_describe(p->engine, task->zoom, task->column, task->row, metatile);
    return write_blanks(p, task, &picture);
}

/* Draws the tasks of one zoom. */
static camber_status draw_zoom(pyramid *p, size_t first, size_t end) {
    const camber_schedule *s = &p->schedule;
    camber_status status = CAMBER_OK;
    for (size_t i = first; i < end && status == CAMBER_OK; i++) {
        status = do_task(p, s->tasks + i);
        p->done_cost += camber_task_cost(s->tasks + i);
        p->done_tiles += count_bits(s->tasks[i].wanted);
        camber_progress_tell(p->context,
                             &(camber_progress_info){.stage = "drawing tiles",
                                                     .fraction = s->cost > 0.0 ? p->done_cost / s->cost : -1.0,
                                                     .unit = "tiles",
                                                     .done = p->done_tiles,
                                                     .total = p->wanted_tiles});
    }
    while (status == CAMBER_OK && p->engine->desc.meshes && camber_encode_queue_is_busy(p->queue))
        status = write_ready(p, true); /* encoding meshes needs the zoom's plan */
    if (status == CAMBER_OK)
        camber_engine_forget_zoom(p->engine, s->tasks[first].zoom);
    return status;
}

/* Whether points are freed as soon as no remaining zoom draws them. If the style needs lengths along lines, all points
 * are needed. */
static bool spends_points(const pyramid *p) {
    return p->desc->spent && !p->schedule.has_arc_length;
}

/* Frees the points that neither this zoom nor any lower zoom draws. */
static camber_status spend_points(pyramid *p, int zoom) {
    camber_engine_zoom *opened;
    const camber_status status = camber_engine_plan_zoom(p->engine, zoom, &opened);
    return status == CAMBER_OK ? camber_features_thin(p->desc->spent, opened->plan->least_importance) : status;
}

/* Finds the tasks of a zoom, which are consecutive. */
static size_t find_tasks(const camber_schedule *schedule, int zoom, size_t *end) {
    size_t first = 0;
    while (first < schedule->count && schedule->tasks[first].zoom < zoom)
        first++;
    for (*end = first; *end < schedule->count && schedule->tasks[*end].zoom == zoom;)
        ++*end;
    return first;
}

static uint64_t count_wanted(const camber_schedule *schedule) {
    uint64_t count = 0;
    for (size_t i = 0; i < schedule->count; i++)
        count += count_bits(schedule->tasks[i].wanted);
    return count;
}

/* Draws zoom by zoom, in the order of the archive, so that the archive need not copy tiles. If points are freed on the
 * way, the deepest zoom is drawn first: each zoom leaves fewer points for the next, and the lowest zooms, whose
 * networks contain all lines, are drawn when the least memory is in use. */
static camber_status draw_all(pyramid *p) {
    const bool spends = spends_points(p);
    camber_status status = CAMBER_OK;
    p->wanted_tiles = count_wanted(&p->schedule);
    for (int n = 0; n <= p->area.max_zoom - p->area.min_zoom && status == CAMBER_OK; n++) {
        const int zoom = spends ? p->area.max_zoom - n : p->area.min_zoom + n;
        size_t end;
        const size_t first = find_tasks(&p->schedule, zoom, &end);
        if (first == end)
            continue;
        if (spends)
            status = spend_points(p, zoom);
        if (status == CAMBER_OK)
            status = draw_zoom(p, first, end);
    }
    while (status == CAMBER_OK && camber_encode_queue_is_busy(p->queue))
        status = write_ready(p, true);
    return status;
}

/* ---- A dry run ---- */

/* Estimates the bytes of a task's tiles, in units of the bytes per point. A tile costs as much as 70 to 260 points
 * (least squares, Porto and Liechtenstein at zooms 15 and 16, PNG and WebP, 2026-11-29). The estimate only decides
 * which tasks are sampled, so it need not be accurate. */
static double guess_bytes(const camber_tile_task *task) {
    static const double TILE_POINTS = 100.0;
    return TILE_POINTS * (double)count_bits(task->wanted) + (double)task->points;
}

static double guess_all(const camber_schedule *s, size_t first, size_t end) {
    double sum = 0.0;
    for (size_t i = first; i < end; i++)
        sum += guess_bytes(s->tasks + i);
    return sum;
}

/* Draws a sample of a zoom's metatiles to estimate how many bytes all of them will take. `tried` marks are placed at
 * equal distances along the cumulative estimated bytes, and the metatiles at the marks are drawn. So a large metatile
 * is more likely to be drawn, and stands for fewer others. Each mark stands for an equal share of the bytes. */
static camber_status try_zoom(pyramid *p, size_t first, size_t end, size_t tried) {
    const camber_schedule *s = &p->schedule;
    const double all = guess_all(s, first, end);
    const bool draws_all = tried >= end - first;
    camber_status status = CAMBER_OK;
    double passed = 0.0;
    for (size_t i = first, mark = 0; i < end && tried && status == CAMBER_OK; i++) {
        const double guessed = guess_bytes(s->tasks + i);
        size_t marks = 0;
        passed += guessed;
        for (; mark < tried && ((double)mark + 0.5) / (double)tried * all <= passed; mark++)
            marks++;
        p->weight = draws_all ? 1.0 : (double)marks / (double)tried * all / guessed;
        if (draws_all || marks)
            status = do_task(p, s->tasks + i);
    }
    while (status == CAMBER_OK && camber_encode_queue_is_busy(p->queue))
        status = write_ready(p, true);
    p->weight = 1.0;
    return status;
}

/* Zooms with more estimated bytes get more marks. */
static camber_status try_all(pyramid *p) {
    enum { TRIED_EACH = 3, TRIED_MORE = 24 };
    const camber_schedule *s = &p->schedule;
    const double all = guess_all(s, 0, s->count);
    camber_status status = CAMBER_OK;
    for (size_t i = 0, end; i < s->count && status == CAMBER_OK; i = end) {
        for (end = i; end < s->count && s->tasks[end].zoom == s->tasks[i].zoom; end++)
            ;
        /* a schedule does not need the bytes, and drawing pictures takes most of the time */
        const double more = all > 0.0 ? TRIED_MORE * guess_all(s, i, end) / all : 0.0;
        status = try_zoom(p, i, end, p->desc->schedule_path ? 0 : TRIED_EACH + (size_t)(more + 0.5));
        if (status == CAMBER_OK)
            camber_engine_forget_zoom(p->engine, s->tasks[i].zoom);
    }
    p->stats.tiles = count_wanted(s);
    p->stats.background = 0;
    p->stats.units = s->count;
    p->stats.points = 0;
    for (size_t i = 0; i < s->count; i++)
        p->stats.points += s->tasks[i].points;
    return status;
}

/* ---- The archive ---- */

static void put_text(json_t *metadata, const char *name, const char *text) {
    if (text && *text)
        json_object_set_new(metadata, name, json_string(text));
}

/* Returns the zoom at which the bounds are about four tiles wide. */
static int find_center_zoom(const camber_tiles_area *area) {
    const double side = fmax(area->bounds.x1 - area->bounds.x0, area->bounds.y1 - area->bounds.y0);
    const double zoom = side > 0.0 ? floor(log2(4.0 / side)) : area->max_zoom;
    return zoom < area->min_zoom ? area->min_zoom : zoom > area->max_zoom ? area->max_zoom : (int)zoom;
}

/* If a box crosses the antimeridian, the archive's bounds are the whole world, and their middle is not the middle of
 * the box. */
static double find_center_longitude(const camber_tiles_area *area, const double bounds[4]) {
    double longitude, latitude;
    if (area->bounds.x1 <= 1.0)
        return 0.5 * (bounds[0] + bounds[2]);
    camber_mercator_unproject(camber_mercator_wrap(0.5 * (area->bounds.x0 + area->bounds.x1)), 0.5, &longitude,
                              &latitude);
    return longitude;
}

/* Whether the style's backgrounds make a dark map, so that a page's texts and buttons should be dark, too. The zoom
 * that is shown first decides. */
static bool is_dark(const pyramid *p) {
    static const float DARK = 0.4f; /* relative luminance, 0 to 1; the shipped styles have 0.08 and 0.95 */
    const camber_style *style = p->engine->features->style;
    const double zoom = fmax(camber_engine_zoom_desc(&p->engine->desc, find_center_zoom(&p->area)).zoom, 0.0);
    float light = 1.0f;
    for (size_t i = 0; i < style->layer_count; i++) {
        const camber_style_layer *layer = style->layers + i;
        if (layer->kind != CAMBER_LAYER_BACKGROUND || layer->properties[CAMBER_BACKGROUND_PATTERN] ||
            !camber_style_layer_matches(layer, zoom, NULL))
            continue;
        const camber_color color = camber_style_layer_paint(layer, zoom, NULL).color;
        const float own = 0.2126f * color.r + 0.7152f * color.g + 0.0722f * color.b;
        light += color.a * (own - light);
    }
    return light < DARK && !p->engine->desc.meshes;
}

static json_t *make_metadata(const pyramid *p) {
    const camber_tiles_draw_desc *desc = p->desc;
    const camber_features *features = p->engine->features;
    json_t *metadata = json_object();
    char generator[64];
    snprintf(generator, sizeof generator, "camber %s", camber_version());
    put_text(metadata, "name", desc->name ? desc->name : "camber");
    put_text(metadata, "description", desc->description);
    put_text(metadata, "attribution",
             desc->attribution ? desc->attribution : camber_features_get_attribution(features));
    put_text(metadata, "type", "baselayer");
    put_text(metadata, "version", camber_version());
    put_text(metadata, "generator", generator);
    put_text(metadata, "style", features->style->name);
    put_text(metadata, "theme", is_dark(p) ? "dark" : NULL);
    json_object_set_new(metadata, "tileSize", json_integer((json_int_t)p->engine->tile_px));
    json_object_set_new(metadata, "ratio", json_real(p->engine->desc.ratio));
    return metadata;
}

static camber_tile_type type_of(const pyramid *p) {
    const camber_encoding encoding = p->desc->encoding;
    return p->engine->desc.meshes             ? CAMBER_TILE_GLB
           : encoding == CAMBER_ENCODING_WEBP ? CAMBER_TILE_WEBP
                                              : CAMBER_TILE_PNG;
}

/* Describes the archive as it will be after its tiles have been replaced. */
static void describe_renewed(const pyramid *p, camber_archive_desc *whole) {
    const camber_archive *there = p->renewed;
    const double asked[4] = {whole->bounds[0], whole->bounds[1], whole->bounds[2], whole->bounds[3]};
    whole->force = true;
    whole->resume = false;
    whole->min_zoom = there->min_zoom;
    whole->max_zoom = there->max_zoom;
    if (there->has_bounds)
        memcpy(whole->bounds, there->bounds, sizeof whole->bounds);
    /* a box or a region says where else tiles may be added */
    for (int i = 0; i < 4 && there->has_bounds && (p->desc->has_bbox || p->desc->region); i++)
        whole->bounds[i] = i < 2 ? fmin(whole->bounds[i], asked[i]) : fmax(whole->bounds[i], asked[i]);
    whole->center = there->center;
    whole->center.zoom = there->whole_center_zoom;
    whole->metadata = there->metadata;
    whole->shard = there->shard;
    whole->shards = there->shards;
}

static camber_status open_writer(pyramid *p) {
    const camber_tiles_draw_desc *desc = p->desc;
    json_t *metadata = make_metadata(p);
    camber_archive_desc whole = {.path = desc->output,
                                 .type = type_of(p),
                                 .force = desc->force,
                                 .resume = desc->resume,
                                 .min_zoom = p->area.min_zoom,
                                 .max_zoom = p->area.max_zoom,
                                 .metadata = metadata,
                                 .fingerprint = p->fingerprint,
                                 .shard = desc->shard,
                                 .shards = desc->shards};
    camber_status status = metadata ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    camber_tiles_area_bounds(&p->area, whole.bounds);
    whole.center = (camber_archive_center){true, find_center_longitude(&p->area, whole.bounds),
                                           0.5 * (whole.bounds[1] + whole.bounds[3]), find_center_zoom(&p->area)};
    if (!camber_archive_get_format(desc->output, &whole.format))
        status =
            camber_fail(p->context, CAMBER_ERROR_ARGUMENT,
                        "%s: unknown extension; name it .pmtiles, .mbtiles, or a folder with a slash", desc->output);
    if (desc->renew)
        describe_renewed(p, &whole);
    if (status == CAMBER_OK)
        status = camber_archive_writer_create(p->context, &whole, &p->writer);
    if (status == CAMBER_OK && p->renewed)
        status = camber_archive_writer_take(p->writer, p->renewed);
    json_decref(metadata);
    if (status == CAMBER_OK && desc->begun && !camber_archive_writer_is_done(p->writer))
        desc->begun(desc->user);
    return status;
}

static camber_status draw_archive(pyramid *p) {
    const double start_ms = camber_now_ms();
    camber_status status = open_writer(p);
    p->stats.write_ms += camber_now_ms() - start_ms;
    if (status == CAMBER_OK && camber_archive_writer_is_done(p->writer)) {
        p->stats.done = true;
        /* an earlier run may have been stopped before it could write the record */
        return p->labels.context ? camber_label_record_write(&p->labels, p->desc->label_record) : CAMBER_OK;
    }
    if (status == CAMBER_OK)
        status = draw_all(p);
    const double drawn_ms = camber_now_ms();
    if (status == CAMBER_OK)
        status = camber_archive_writer_finish(p->writer);
    if (status == CAMBER_OK && p->labels.context)
        status = camber_label_record_write(&p->labels, p->desc->label_record);
    if (status == CAMBER_OK)
        p->stats.emptied = camber_archive_writer_get_removed(p->writer);
    p->stats.write_ms += camber_now_ms() - drawn_ms;
    return status;
}

/* ---- The call ---- */

static camber_status check_desc(const pyramid *p) {
    const camber_tiles_draw_desc *desc = p->desc;
    if (desc->shards && (desc->shard < 1 || desc->shard > desc->shards))
        return camber_fail(p->context, CAMBER_ERROR_ARGUMENT, "tiles: part %u of %u; choose 1 to %u", desc->shard,
                           desc->shards, desc->shards);
    if (desc->renew && (desc->shards || desc->resume || desc->dry_run || desc->schedule))
        return camber_fail(
            p->context, CAMBER_ERROR_ARGUMENT,
            "tiles: renewing cannot be combined with shards, resuming, a dry run or a schedule; leave those out");
    if (desc->label_record && (desc->shards || desc->schedule))
        return camber_fail(
            p->context, CAMBER_ERROR_ARGUMENT,
            "tiles: labels cannot be recorded by a part of a run; leave out the shards and the schedule");
    if (p->engine->desc.on_demand_side)
        return camber_fail(p->context, CAMBER_ERROR_ARGUMENT,
                           "tiles: the engine draws tiles on demand; make one without on_demand_side");
    return CAMBER_OK;
}

/* Whether all tiles are opaque, so that the encoders need not check for an alpha channel. */
static bool is_opaque(const pyramid *p) {
    for (int zoom = p->area.min_zoom; zoom <= p->area.max_zoom; zoom++)
        if (!p->engine->zooms[zoom].has_background || p->engine->zooms[zoom].background[3] < 255)
            return false;
    return true;
}

/* Writes the features first and the schedule last, so that a schedule never exists without its features. */
static camber_status save_schedule(pyramid *p, uint64_t input, camber_box data) {
    const camber_tiles_draw_desc *desc = p->desc;
    camber_tiles_schedule whole = {.context = p->context, .input = input, .data = data, .schedule = p->schedule};
    memcpy(whole.fingerprint, p->fingerprint, sizeof whole.fingerprint);
    if (!camber_schedule_name_features(desc->schedule_path, whole.features, sizeof whole.features))
        return camber_fail(p->context, CAMBER_ERROR_ARGUMENT, "%s: the name is too long; choose a shorter one",
                           desc->schedule_path);
    camber_status status = camber_files_hash(p->context, desc->inputs, desc->input_count, &whole.files);
    if (status == CAMBER_OK)
        status = camber_features_save(p->engine->features, input, whole.features, desc->force);
    return status == CAMBER_OK ? camber_schedule_write(&whole, desc->schedule_path, desc->force) : status;
}

static camber_status fail_renewed(const pyramid *p, const char *names) {
    return camber_fail(p->context, CAMBER_ERROR_INPUT,
                       "%s: differs in its %s; renew it with the options that it was drawn with, or draw it again",
                       p->desc->output, names);
}

/* Opens the archive whose tiles are replaced, and checks that this run may replace them. */
static camber_status open_renewed(pyramid *p) {
    char names[128], own[CAMBER_FINGERPRINT_SIZE];
    const camber_status status = camber_archive_open(p->context, p->desc->output, &p->renewed);
    if (status != CAMBER_OK)
        return status;
    const camber_archive *there = p->renewed;
    if (!there->fingerprint)
        return camber_fail(p->context, CAMBER_ERROR_INPUT,
                           "%s: does not record what it was drawn from, so its tiles cannot be renewed; draw it again",
                           p->desc->output);
    if (there->type != type_of(p))
        return fail_renewed(p, "format");
    if (!camber_fingerprint_renew(there->fingerprint, p->fingerprint, own, names, sizeof names))
        return fail_renewed(p, names);
    memcpy(p->fingerprint, own, sizeof own);
    return CAMBER_OK;
}

/* Restricts a list to the archive's own zooms and bounds, unless the caller gave others. */
static camber_status keep_list(pyramid *p, camber_box data) {
    const camber_archive *there = p->renewed;
    const camber_tiles_draw_desc *desc = p->desc;
    const bool zooms_asked = desc->min_zoom >= 0, box_asked = desc->has_bbox || desc->region;
    const double *bounds = there->has_bounds && !box_asked ? there->bounds : NULL;
    if (there->has_bounds && !camber_tiles_bounds_meet(there->bounds, data))
        return camber_fail(p->context, CAMBER_ERROR_INPUT,
                           "%s: the input lies outside the archive's bounds, so its tiles would be deleted; use the "
                           "original input, or draw a new archive",
                           desc->output);
    p->stats.left_out = camber_tiles_area_keep(&p->area, zooms_asked ? desc->min_zoom : there->min_zoom,
                                               zooms_asked ? desc->max_zoom : there->max_zoom, bounds);
    p->stats.done = p->area.tile_count == 0;
    return CAMBER_OK;
}

/* Adds to the list the tiles whose labels differ from those that an earlier run has recorded. */
static camber_status add_relabelled(pyramid *p) {
    const camber_archive *there = p->renewed;
    const camber_tiles_draw_desc *desc = p->desc;
    const size_t listed = p->area.tile_count;
    camber_label_record before = {0};
    uint64_t added = 0;
    camber_status status = camber_label_record_read(p->context, desc->label_record, &before);
    if (status == CAMBER_OK)
        status = camber_label_record_add_changed(&before, &p->labels, &p->area, &added);
    camber_label_record_free(&before);
    if (status != CAMBER_OK)
        return status;
    (void)camber_tiles_area_keep(&p->area, there->min_zoom, there->max_zoom,
                                 there->has_bounds && !desc->has_bbox && !desc->region ? there->bounds : NULL);
    p->stats.relabelled = p->area.tile_count > listed ? p->area.tile_count - listed : 0;
    p->stats.done = p->area.tile_count == 0;
    return CAMBER_OK;
}

/* Records the labels of the archive, which a run that renews tiles compares with those before it. */
static camber_status record_labels(pyramid *p) {
    const camber_archive *there = p->renewed;
    const bool lists = there && p->desc->tile_count;
    const double start_ms = camber_now_ms();
    if (lists && access(p->desc->label_record, F_OK) != 0)
        return camber_fail(p->context, CAMBER_ERROR_NOT_FOUND,
                           "%s: no such record, so nothing says which labels have moved; draw the archive again with "
                           "--label-record",
                           p->desc->label_record);
    camber_status status = camber_label_record_make(p->engine, there ? there->min_zoom : p->area.min_zoom,
                                                    there ? there->max_zoom : p->area.max_zoom, &p->labels);
    if (status == CAMBER_OK && lists)
        status = add_relabelled(p);
    p->stats.census_ms += camber_now_ms() - start_ms;
    return status;
}

/* Labels that have moved may be in tiles that nobody has listed. */
static void warn_of_labels(const pyramid *p) {
    if (p->renewed && p->desc->tile_count && !p->desc->label_record && p->engine->features->fonts &&
        camber_features_label_kinds(p->engine->features))
        camber_log(p->context, CAMBER_LOG_WARNING,
                   "%s: labels that have moved may be in tiles that are not listed; give --label-record FILE when an "
                   "archive is drawn and when it is renewed, and such tiles are renewed, too",
                   p->desc->output);
}

static camber_status find_drawn(const pyramid *p, camber_box *data) {
    const bool asked = p->desc->min_zoom >= 0;
    return camber_plan_drawn_box(p->engine->features, asked ? p->desc->min_zoom : 0,
                                 asked ? p->desc->max_zoom : CAMBER_LARGEST_TILE_ZOOM, data);
}

/* Finds where lines are. */
static camber_status make_schedule(pyramid *p) {
    camber_box data;
    const double start_ms = camber_now_ms();
    const uint64_t input = camber_features_hash(p->engine->features, &data);
    camber_status status = find_drawn(p, &data);
    p->stats.census_ms += camber_now_ms() - start_ms;
    if (status == CAMBER_OK)
        status = camber_tiles_area_make(p->context, p->desc, data, &p->area);
    if (status != CAMBER_OK)
        return status;
    camber_fingerprint_write(p->engine, p->desc, &p->area, input, p->fingerprint);
    if (p->desc->renew)
        status = open_renewed(p);
    if (status == CAMBER_OK && p->desc->renew && p->desc->tile_count)
        status = keep_list(p, data);
    if (status == CAMBER_OK && p->desc->label_record && !p->desc->dry_run)
        status = record_labels(p);
    warn_of_labels(p);
    if (status != CAMBER_OK || p->stats.done)
        return status;
    status = camber_schedule_make(p->engine, &p->area, p->desc->keep_empty || p->desc->renew, &p->schedule);
    return status == CAMBER_OK && p->desc->dry_run && p->desc->schedule_path ? save_schedule(p, input, data) : status;
}

/* Loads the schedule that a dry run has written. */
static camber_status take_schedule(pyramid *p) {
    const camber_tiles_schedule *given = p->desc->schedule;
    camber_engine_zoom *planned;
    camber_status status = camber_tiles_area_make(p->context, p->desc, given->data, &p->area);
    if (status != CAMBER_OK)
        return status;
    camber_fingerprint_write(p->engine, p->desc, &p->area, given->input, p->fingerprint);
    if (strcmp(p->fingerprint, given->fingerprint) != 0)
        return camber_fail(p->context, CAMBER_ERROR_INPUT,
                           "tiles: the schedule was made with another style, options, tiles or version; give the same "
                           "ones, or make a new schedule");
    p->schedule = given->schedule;
    if (!(p->schedule.tasks = camber_alloc(p->context, given->schedule.count, sizeof *p->schedule.tasks)))
        return CAMBER_ERROR_MEMORY;
    memcpy(p->schedule.tasks, given->schedule.tasks, given->schedule.count * sizeof *p->schedule.tasks);
    p->schedule.context = p->context;
    for (int zoom = p->area.min_zoom; zoom <= p->area.max_zoom && status == CAMBER_OK; zoom++)
        status = camber_engine_plan_zoom(p->engine, zoom, &planned);
    return status;
}

static camber_status prepare(pyramid *p) {
    camber_status status = check_desc(p);
    if (status == CAMBER_OK)
        status = p->desc->schedule ? take_schedule(p) : make_schedule(p);
    if (status != CAMBER_OK || p->stats.done)
        return status;
    camber_schedule_meet(&p->schedule, &p->area);
    if (p->desc->shards)
        status = camber_schedule_choose(&p->schedule, p->desc->shard, p->desc->shards);
    const camber_encoder_desc encoder = {
        .encoding = p->desc->encoding, .opaque = is_opaque(p), .quality = p->desc->quality};
    if (status == CAMBER_OK)
        status = camber_encode_queue_create(&p->engine->workers, p->engine->desc.meshes ? NULL : &encoder,
                                            camber_tiles_engine_get_picture_bytes(p->engine), &p->queue);
    return status;
}

camber_status camber_tiles_draw(camber_tiles_engine *engine, const camber_tiles_draw_desc *desc,
                                camber_tiles_stats *stats) {
    pyramid p = {.context = engine->context, .engine = engine, .desc = desc, .weight = 1.0, .blank_zoom = -1};
    assert(!desc->spent || desc->spent == engine->features);
    engine->census_ms = engine->make_ms = engine->draw_ms = 0.0;
    camber_status status = prepare(&p);
    if (status == CAMBER_OK && !p.stats.done)
        status = desc->dry_run ? try_all(&p) : draw_archive(&p);
    if (p.queue) {
        const camber_encode_times times = camber_encode_queue_get_times(p.queue);
        p.stats.encode_ms = times.wall_ms;
        p.stats.encode_cpu_ms = times.cpu_ms;
    }
    camber_encode_queue_destroy(p.queue);
    camber_archive_writer_destroy(p.writer);
    camber_archive_close(p.renewed);
    camber_schedule_free(&p.schedule);
    camber_label_record_free(&p.labels);
    camber_tiles_area_free(&p.area);
    camber_free(p.context, p.blank);
    for (int zoom = 0; zoom <= CAMBER_LARGEST_TILE_ZOOM; zoom++)
        camber_engine_forget_zoom(engine, zoom);
    p.stats.census_ms += engine->census_ms;
    p.stats.make_ms = engine->make_ms;
    p.stats.draw_ms = engine->draw_ms;
    if (status == CAMBER_OK && stats)
        *stats = p.stats;
    return status;
}
