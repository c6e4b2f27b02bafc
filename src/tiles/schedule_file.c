/* Saves schedules to files, so that each part of a run need not search for lines, and reads only what it draws.
 *
 * Input: the schedule of a whole run. Output: a JSON file, which is written whole or not at all. A part must not use
 * the schedule of another input, but cannot hash features that it does not read. So the file contains a hash of the
 * input files, which is cheap to compute, because only pieces of large files are read. It also contains the run's
 * fingerprint, which all parts then use. */
#define _FILE_OFFSET_BITS 64
#define _XOPEN_SOURCE 700

#include "tiles/schedule_file.h"

#include "archive/contents.h"
#include "archive/output_file.h"
#include "features/features.h"
#include "tiles/features_file.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <strings.h>
#include <unistd.h>

/* A file is hashed in pieces. If it has more than MOST_PIECES, only this many are hashed, including the first and the
 * last ones, which contain the headers of most formats. */
enum { PIECE_BYTES = 64 << 10, MOST_PIECES = 1024, TASK_TEXT = 128, NUMBERS = 7 };

/* ---- The input's files ---- */

static camber_status hash_piece(camber_context *context, const char *path, int file, uint64_t at, uint8_t *bytes,
                                uint64_t *hash) {
    size_t done;
    const int cause = camber_file_read(file, bytes, PIECE_BYTES, at, &done);
    if (cause)
        return camber_file_fail(context, path, cause);
    *hash = camber_mix(*hash, camber_content_hash(bytes, done));
    return CAMBER_OK;
}

static camber_status hash_file(camber_context *context, const char *path, uint8_t *bytes, uint64_t *hash) {
    int file;
    uint64_t size_bytes;
    camber_status status = camber_file_open(context, path, CAMBER_NAMED_BY_CALLER, &file, &size_bytes);
    if (status != CAMBER_OK)
        return status;
    const uint64_t all = (size_bytes + PIECE_BYTES - 1) / PIECE_BYTES, pieces = all < MOST_PIECES ? all : MOST_PIECES;
    *hash = camber_mix(*hash, size_bytes);
    for (uint64_t i = 0; i < pieces && status == CAMBER_OK; i++)
        status =
            hash_piece(context, path, file, PIECE_BYTES * (i + 1 == pieces ? all - 1 : i * all / pieces), bytes, hash);
    close(file);
    return status;
}

/* The attributes of a Shapefile are in a second file with another extension. */
static bool name_attributes(const char *path, char *name, size_t size) {
    const size_t length = strlen(path);
    if (length < 4 || length >= size || strcasecmp(path + length - 4, ".shp") != 0)
        return false;
    memcpy(name, path, length - 3);
    memcpy(name + length - 3, path[length - 1] == 'P' ? "DBF" : "dbf", 4);
    return access(name, F_OK) == 0;
}

camber_status camber_files_hash(camber_context *context, const char *const *paths, size_t count, uint64_t *hash) {
    uint8_t *bytes = camber_alloc(context, PIECE_BYTES, 1);
    camber_status status = bytes ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    uint64_t made = camber_mix(0, count);
    for (size_t i = 0; i < count && status == CAMBER_OK; i++) {
        char beside[4096];
        status = hash_file(context, paths[i], bytes, &made);
        if (status == CAMBER_OK && name_attributes(paths[i], beside, sizeof beside))
            status = hash_file(context, beside, bytes, &made);
    }
    camber_free(context, bytes);
    if (status == CAMBER_OK)
        *hash = made;
    return status;
}

bool camber_schedule_name_features(const char *path, char *name, size_t size) {
    const int length = snprintf(name, size, "%s.features", path);
    return length > 0 && (size_t)length < size;
}

/* ---- Writing ---- */

static json_t *make_json(const camber_tiles_schedule *s) {
    char text[TASK_TEXT];
    json_t *json = json_object(), *tasks = json_array();
    json_object_set_new(json, "camber_schedule", json_integer(1));
    json_object_set_new(json, "fingerprint", json_string(s->fingerprint));
    snprintf(text, sizeof text, "%" PRIx64 " %" PRIx64, s->files, s->input);
    json_object_set_new(json, "input", json_string(text));
    json_object_set_new(json, "has_arc_length", json_boolean(s->schedule.has_arc_length));
    json_object_set_new(json, "box", json_pack("[f,f,f,f]", s->data.x0, s->data.y0, s->data.x1, s->data.y1));
    for (size_t i = 0; i < s->schedule.count; i++) {
        const camber_tile_task *task = s->schedule.tasks + i;
        snprintf(text, sizeof text, "%x %x %x %x %" PRIx64 " %" PRIx64 " %" PRIx64, (unsigned)task->zoom,
                 (unsigned)task->level, task->column, task->row, task->wanted, task->touched, task->points);
        json_array_append_new(tasks, json_string(text));
    }
    json_object_set_new(json, "tasks", tasks);
    return json;
}

camber_status camber_schedule_write(const camber_tiles_schedule *schedule, const char *path, bool force) {
    camber_context *context = schedule->context;
    camber_whole_file output;
    json_t *json = make_json(schedule);
    char *text = json ? json_dumps(json, JSON_INDENT(1) | JSON_REAL_PRECISION(17)) : NULL;
    json_decref(json);
    if (!text)
        return camber_fail(context, CAMBER_ERROR_MEMORY, "%s: out of memory for the schedule; raise the memory limit",
                           path);
    camber_status status = camber_output_begin(context, path, &output);
    if (status == CAMBER_OK) {
        status = camber_write_at(context, path, output.file, text, strlen(text), 0);
        status = camber_output_end(context, &output, status, force);
    }
    free(text);
    return status;
}

/* ---- Reading ---- */

/* Reads hexadecimal numbers that are separated by single blanks. Returns false if there are not exactly `count`. */
static bool read_numbers(const char *text, uint64_t *numbers, size_t count) {
    for (size_t i = 0; i < count; i++) {
        char *end;
        errno = 0;
        if (!text || !strchr("0123456789abcdef", *text) || !*text)
            return false;
        numbers[i] = strtoull(text, &end, 16);
        if (errno || *end != (i + 1 < count ? ' ' : 0))
            return false;
        text = end + 1;
    }
    return true;
}

static bool read_task(const char *text, camber_tile_task *task) {
    uint64_t n[NUMBERS];
    if (!read_numbers(text, n, NUMBERS) || n[0] > CAMBER_LARGEST_TILE_ZOOM || n[1] > n[0] || n[0] - n[1] > 3 ||
        n[2] >> n[1] || n[3] >> n[1])
        return false;
    *task = (camber_tile_task){(int)n[0], (int)n[1], (uint32_t)n[2], (uint32_t)n[3], n[4], n[5], n[6]};
    const uint32_t tiles = camber_task_side(task) * camber_task_side(task);
    return tiles == 64 || !((task->wanted | task->touched) >> tiles);
}

static bool read_box(const json_t *json, camber_box *box) {
    double *const numbers[4] = {&box->x0, &box->y0, &box->x1, &box->y1};
    for (size_t i = 0; i < 4; i++) {
        if (!json_is_number(json_array_get(json, i)))
            return false;
        *numbers[i] = json_number_value(json_array_get(json, i));
    }
    return true;
}

/* Reads the schedule from JSON. Tasks must be sorted by zoom. */
static bool take_json(const json_t *json, camber_tiles_schedule *made) {
    const json_t *tasks = json_object_get(json, "tasks");
    const char *fingerprint = json_string_value(json_object_get(json, "fingerprint"));
    uint64_t input[2];
    if (json_integer_value(json_object_get(json, "camber_schedule")) != 1 || !json_is_array(tasks) || !fingerprint ||
        strlen(fingerprint) >= sizeof made->fingerprint || !read_box(json_object_get(json, "box"), &made->data) ||
        !read_numbers(json_string_value(json_object_get(json, "input")), input, 2))
        return false;
    memcpy(made->fingerprint, fingerprint, strlen(fingerprint) + 1);
    made->files = input[0];
    made->input = input[1];
    made->schedule.has_arc_length = json_is_true(json_object_get(json, "has_arc_length"));
    for (size_t i = 0; i < json_array_size(tasks); i++) {
        camber_tile_task *task = made->schedule.tasks + i;
        if (!read_task(json_string_value(json_array_get(tasks, i)), task) || (i > 0 && task->zoom < task[-1].zoom))
            return false;
        made->schedule.count++;
    }
    return true;
}

void camber_tiles_schedule_destroy(camber_tiles_schedule *schedule) {
    if (!schedule)
        return;
    camber_schedule_free(&schedule->schedule);
    camber_free(schedule->context, schedule);
}

static camber_status parse(camber_context *context, const char *path, camber_tiles_schedule **schedule) {
    char *bytes = NULL;
    size_t size_bytes = 0;
    camber_status status = camber_read_file(context, path, CAMBER_NAMED_BY_CALLER, &bytes, &size_bytes);
    if (status != CAMBER_OK)
        return status;
    json_t *json = json_loadb(bytes, size_bytes, 0, NULL);
    const size_t tasks = json_array_size(json_object_get(json, "tasks"));
    camber_tiles_schedule *made = camber_alloc_zero(context, 1, sizeof *made);
    if (made)
        *made = (camber_tiles_schedule){.context = context, .schedule = {.context = context, .capacity = tasks}};
    if (!made || !(made->schedule.tasks = camber_alloc(context, tasks, sizeof *made->schedule.tasks)))
        status = CAMBER_ERROR_MEMORY;
    else if (!take_json(json, made))
        status = camber_fail(context, CAMBER_ERROR_INPUT,
                             "%s: not a schedule of tiles, or damaged; make it with --dry-run --schedule", path);
    if (status == CAMBER_OK)
        *schedule = made;
    else
        camber_tiles_schedule_destroy(made);
    json_decref(json);
    camber_free(context, bytes);
    return status;
}

camber_status camber_tiles_schedule_read(camber_context *context, const char *path, const char *const *inputs,
                                         size_t input_count, camber_tiles_schedule **schedule) {
    camber_tiles_schedule *made = NULL;
    uint64_t files = 0;
    camber_status status = parse(context, path, &made);
    if (status == CAMBER_OK)
        status = camber_files_hash(context, inputs, input_count, &files);
    if (status == CAMBER_OK && files != made->files)
        status = camber_fail(
            context, CAMBER_ERROR_INPUT,
            "%s: the schedule was made from another input; make it again with --dry-run --schedule --force", path);
    if (status == CAMBER_OK && !camber_schedule_name_features(path, made->features, sizeof made->features))
        made->features[0] = 0;
    if (status == CAMBER_OK)
        *schedule = made;
    else
        camber_tiles_schedule_destroy(made);
    return status;
}

/* ---- Reading for a part ---- */

static void add_box(camber_region *box, const camber_region *more) {
    box->x0 = fmin(box->x0, more->x0);
    box->y0 = fmin(box->y0, more->y0);
    box->x1 = fmax(box->x1, more->x1);
    box->y1 = fmax(box->y1, more->y1);
}

static double area_with(camber_region box, const camber_region *more) {
    add_box(&box, more);
    return (box.x1 - box.x0) * (box.y1 - box.y0);
}

/* Adds a box to the few boxes of a part: as a new one, or by extending the one that grows least. */
static void add_to_boxes(camber_tiles_schedule *schedule, const camber_region *more) {
    size_t best = 0;
    double least = INFINITY;
    for (size_t i = 0; i < schedule->box_count; i++) {
        const camber_region *box = schedule->boxes + i;
        const double grows = area_with(*box, more) - area_with(*box, box);
        if (grows < least) {
            least = grows;
            best = i;
        }
    }
    if (schedule->box_count < CAMBER_SCHEDULE_BOXES && least > 0.0)
        schedule->boxes[schedule->box_count++] = *more;
    else
        add_box(schedule->boxes + best, more);
}

/* Returns how far from a tile a line that reaches it may be, in world units. Meshes are drawn at all zooms up to the
 * next. */
static double margin_of(const camber_features *features, const camber_tiles_engine_desc *desc, int zoom) {
    double most = 0.0;
    for (size_t s = 0; s < (desc->meshes ? CAMBER_MESH_SAMPLES : 1); s++) {
        camber_zoom_desc own = camber_engine_zoom_desc(desc, zoom);
        own.zoom += camber_mesh_sample_zoom(s);
        own.scale_px *= exp2(camber_mesh_sample_zoom(s));
        const camber_view view = camber_zoom_view(&own);
        most = fmax(most, camber_view_margin(features->style, &view, desc->simplify_px));
    }
    return most;
}

camber_status camber_tiles_schedule_read_for(camber_tiles_schedule *schedule, camber_features *features,
                                             const camber_tiles_engine_desc *desc, uint32_t shard, uint32_t shards) {
    const camber_schedule *whole = &schedule->schedule;
    camber_schedule part = {.context = schedule->context, .count = whole->count, .capacity = whole->count};
    camber_region region = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    features->has_region = false;
    schedule->box_count = 0;
    if (!(part.tasks = camber_alloc(part.context, whole->count, sizeof *part.tasks)))
        return CAMBER_ERROR_MEMORY;
    memcpy(part.tasks, whole->tasks, whole->count * sizeof *part.tasks);
    const camber_status status = camber_schedule_choose(&part, shard, shards);
    for (size_t i = 0; i < part.count && status == CAMBER_OK; i++) {
        const camber_tile_task *task = part.tasks + i;
        const double margin = margin_of(features, desc, task->zoom), level = exp2(task->level);
        const camber_region box = {task->column / level - margin, task->row / level - margin,
                                   (task->column + 1.0) / level + margin, (task->row + 1.0) / level + margin};
        add_box(&region, &box);
        add_to_boxes(schedule, &box);
    }
    camber_schedule_free(&part);
    const camber_box *data = &schedule->data;
    const bool all = region.x0 <= data->x0 && region.y0 <= data->y0 && region.x1 >= data->x1 && region.y1 >= data->y1;
    features->region = region;
    features->has_region = !all && region.x1 - region.x0 < 0.5; /* false for a part without tiles */
    if (!features->has_region)
        schedule->box_count = 0;
    return status;
}

camber_status camber_tiles_schedule_load(const camber_tiles_schedule *schedule, camber_features *features,
                                         bool *loaded) {
    *loaded = schedule->features[0] && access(schedule->features, F_OK) == 0;
    if (!*loaded && camber_features_label_kinds(features)) /* files cannot be read for labels alone */
        features->has_region = false;
    return *loaded ? camber_features_load(features, schedule->boxes, schedule->box_count, schedule->input,
                                          schedule->features)
                   : CAMBER_OK;
}
