/* Reads tiles of a set into features, either the given tiles or a whole file.
 *
 * Input: an open set, and the addresses of the tiles to read. Output: features whose lines are joined across borders,
 * and counts of tiles found, lost and damaged. If the style does not name the layers of a file, the layer with roads is
 * chosen by the names that common schemas use for it.
 */
#include "formats/tile_reader.h"
#include "archive/tile_schema.h"
#include "features/rings.h"

#include <stdio.h>
#include <strings.h>
#include <sys/stat.h>

static const double PROGRESS_MS = 50;

/* ---- Tiles to features ---- */

typedef struct reader {
    camber_context *context;
    const camber_tile_reading *reading;
    camber_mvt *mvt;
    camber_bytes bytes;
    size_t found, lost;
    double shown_ms;
} reader;

static void show_progress(reader *self, size_t done) {
    const double now = camber_now_ms();
    if (now - self->shown_ms < PROGRESS_MS)
        return;
    self->shown_ms = now;
    camber_progress_count(self->context, "reading", "tiles", done, self->reading->address_count);
}

static camber_status read_tile_at(reader *self, const camber_tile_address *address) {
    const camber_tile_index kept = {address->column & ((UINT32_C(1) << address->zoom) - 1), address->row};
    const char *why;
    const camber_status status = camber_tile_set_get(self->reading->set, address->zoom, kept, &self->bytes, &why);
    if (status != CAMBER_OK)
        return status;
    if (why)
        camber_mvt_spoil(self->mvt, address, why);
    self->found += why || self->bytes.size_bytes;
    return why ? CAMBER_OK : camber_mvt_read(self->mvt, address, self->bytes.data, self->bytes.size_bytes);
}

static camber_status read_addresses(reader *self) {
    const camber_mvt_stats *stats = camber_mvt_get_stats(self->mvt);
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < self->reading->address_count && status == CAMBER_OK; i++) {
        const size_t damaged = stats->damaged_features, given = stats->kept_features + stats->skipped_features;
        status = read_tile_at(self, &self->reading->addresses[i]);
        self->lost += stats->damaged_features > damaged && stats->kept_features + stats->skipped_features == given;
        show_progress(self, i);
    }
    return status;
}

camber_status camber_features_read_tiles(camber_features *features, const camber_tile_reading *reading,
                                         camber_tile_result *result) {
    camber_context *context = features->context;
    reader self = {.context = context, .reading = reading, .bytes.context = context};
    camber_mvt_desc desc = reading->mvt;
    camber_budget_read_again(context);
    camber_status status = camber_tile_stitcher_create(context, reading->zoom, &desc.stitcher);
    if (status == CAMBER_OK && camber_features_label_kinds(features))
        status = camber_tile_stitcher_create(context, reading->zoom, &desc.labels);
    if (status == CAMBER_OK)
        status = camber_mvt_create(context, &desc, &self.mvt);
    if (status == CAMBER_OK)
        status = read_addresses(&self);
    if (status == CAMBER_OK)
        status = camber_tile_stitcher_finish(desc.stitcher, features);
    if (status == CAMBER_OK && desc.labels)
        status = camber_tile_stitcher_finish_labels(desc.labels, features);
    if (status == CAMBER_OK)
        *result = (camber_tile_result){*camber_mvt_get_stats(self.mvt), self.found, self.lost};
    camber_bytes_free(&self.bytes);
    camber_mvt_destroy(self.mvt);
    camber_tile_stitcher_destroy(desc.labels);
    camber_tile_stitcher_destroy(desc.stitcher);
    return status;
}

/* ---- A file as input ---- */

typedef struct input {
    camber_context *context;
    camber_features *features;
    const camber_source_desc *desc;
    camber_tile_set *set;
    int zoom;
    camber_tile_address *addresses;
    size_t address_count;
    const char **layers; /* the names of the layers to read */
    size_t layer_count;
    char *layer; /* the layer among these that the style does not name. NULL: it names all of them */
} input;

/* Lists every tile of the highest zoom. */
static camber_status list_addresses(input *self) {
    camber_tile_index *addresses = NULL;
    camber_status status = CAMBER_OK;
    self->zoom = self->set->max_zoom;
    for (; self->zoom >= 0 && status == CAMBER_OK; self->zoom--) {
        status = camber_tile_set_list(self->set, self->zoom, &addresses, &self->address_count);
        if (self->address_count || self->zoom == 0)
            break;
        camber_free(self->context, addresses);
        addresses = NULL;
    }
    if (status != CAMBER_OK)
        return status;
    if (!(self->addresses = camber_alloc(self->context, self->address_count, sizeof *self->addresses)))
        status = CAMBER_ERROR_MEMORY;
    for (size_t i = 0; status == CAMBER_OK && addresses && i < self->address_count; i++)
        self->addresses[i] =
            (camber_tile_address){.zoom = self->zoom, .column = addresses[i].column, .row = addresses[i].row};
    camber_free(self->context, addresses);
    return status;
}

static const char *layer_name(const input *self, size_t i) {
    return json_string_value(json_object_get(json_array_get(self->set->layers, i), "id"));
}

static camber_status fail_damaged(const input *self, const camber_mvt_stats *stats) {
    return camber_fail(self->context, CAMBER_ERROR_INPUT, "%s: no feature can be read: %s; get the file again",
                       self->desc->path, stats->damage);
}

/* If the set does not list its layers, finds them by examining all tiles. */
static camber_status look_for_layers(input *self) {
    camber_context *context = self->context;
    reader look = {.context = context, .bytes.context = context};
    const camber_tile_reading reading = {.set = self->set,
                                         .addresses = self->addresses,
                                         .address_count = self->address_count,
                                         .mvt.features = self->features};
    camber_budget_read_again(context);
    look.reading = &reading;
    camber_status status = camber_mvt_create(context, &reading.mvt, &look.mvt);
    if (status != CAMBER_OK)
        return status;
    status = read_addresses(&look);
    size_t count;
    const camber_mvt_layer *layers = camber_mvt_layers(look.mvt, &count);
    const camber_mvt_stats *stats = camber_mvt_get_stats(look.mvt);
    if (status == CAMBER_OK && count == 0 && stats->damaged_features)
        status = fail_damaged(self, stats);
    json_t *found = json_array();
    for (int lines = 1; lines >= 0 && status == CAMBER_OK; lines--)
        for (size_t i = 0; i < count; i++)
            if (layers[i].has_lines == (lines == 1))
                json_array_append_new(found, json_pack("{s:s, s:b}", "id", layers[i].name, "lines", lines));
    json_decref(self->set->layers);
    self->set->layers = found;
    camber_bytes_free(&look.bytes);
    camber_mvt_destroy(look.mvt);
    return status;
}

/* Finds the layer with roads by the names in common schemas: OpenMapTiles, Mapbox Streets, Shortbread, Tilezen, TIGER.
 */
static const char *find_roads(const input *self) {
    static const char *const names[] = {"transportation", "roads",   "road",     "streets",
                                        "street",         "highway", "highways", "tiger"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        for (size_t i = 0; i < json_array_size(self->set->layers); i++)
            if (layer_name(self, i) && strcasecmp(layer_name(self, i), names[k]) == 0)
                return layer_name(self, i);
    return NULL;
}

static const char *find_named(const input *self, const char *name) {
    for (size_t i = 0; i < json_array_size(self->set->layers); i++)
        if (layer_name(self, i) && strcmp(layer_name(self, i), name) == 0)
            return layer_name(self, i);
    return NULL;
}

static camber_status fail_layer(const input *self) {
    char names[512] = "";
    size_t used = 0;
    for (size_t i = 0; i < json_array_size(self->set->layers); i++) {
        const char *name = layer_name(self, i);
        const int added = snprintf(names + used, sizeof names - used, "%s%s", used ? ", " : "", name ? name : "");
        if (added < 0 || used + (size_t)added >= sizeof names - 6) {
            memcpy(names + used, ", ...", 6);
            break;
        }
        used += (size_t)added;
    }
    if (self->desc->layer)
        return camber_fail(self->context, CAMBER_ERROR_INPUT, "%s: no layer \"%s\"; choose one of: %s",
                           self->desc->path, self->desc->layer, used ? names : "(it has no layers)");
    return camber_fail(self->context, CAMBER_ERROR_INPUT, "%s: no layer has lines; its layers are: %s",
                       self->desc->path, used ? names : "(none)");
}

static const char *find_one(const input *self) {
    const char *named = self->desc->layer;
    return named ? find_named(self, named) : find_roads(self);
}

static bool holds_drawn(const input *self, size_t i) {
    return self->features->schema->wants_plain_areas ||
           json_is_true(json_object_get(json_array_get(self->set->layers, i), "lines"));
}

/* Chooses the layers of tiles without a schema: the first layer with lines, or all layers if the style draws unknown
 * data. */
static camber_status choose_all(input *self) {
    const size_t count = json_array_size(self->set->layers);
    camber_free(self->context, self->layers);
    if (!(self->layers = camber_alloc(self->context, count + 1, sizeof *self->layers)))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < count && (self->features->schema->wants_plain || self->layer_count == 0); i++)
        if (layer_name(self, i) && holds_drawn(self, i))
            self->layers[self->layer_count++] = layer_name(self, i);
    return self->layer_count ? CAMBER_OK : fail_layer(self);
}

static camber_status choose_one(input *self) {
    const char *name = find_one(self);
    if (!name) {
        const camber_status status = look_for_layers(self);
        if (status != CAMBER_OK)
            return status;
        name = find_one(self);
        if (!name && !self->desc->layer)
            return choose_all(self);
    }
    if (!name)
        return fail_layer(self);
    if (!(self->layer = camber_copy_string(self->context, name)))
        return CAMBER_ERROR_MEMORY;
    self->layers[self->layer_count++] = self->layer;
    return CAMBER_OK;
}

/* Whether the style may trust the names of layers. A style that draws unknown data trusts them only if they belong to a
 * known schema, because anyone may call a layer "roads". */
static bool has_schema(const input *self) {
    return !self->features->schema->wants_plain || camber_tile_schema_of_layers(self->set->layers);
}

/* Counts the source layers that are read. If labels are wanted, this includes the layers that only symbol layers
 * name. */
static size_t count_named(const input *self) {
    const camber_schema *schema = self->features->schema;
    const bool labels = camber_features_label_kinds(self->features);
    return schema->drawn_source_layer_count + (labels ? schema->label_source_layer_count : 0);
}

/* Lists the layers of the set that the style names. */
static void list_named(input *self) {
    const camber_schema *schema = self->features->schema;
    const size_t count = count_named(self);
    for (size_t i = 0; i < count; i++) {
        const char *name = schema->source_layers[i];
        size_t k = 0;
        while (k < self->layer_count && strcmp(self->layers[k], name) != 0)
            k++;
        if (k == self->layer_count && find_named(self, name))
            self->layers[self->layer_count++] = name;
    }
}

static camber_status choose_layers(input *self) {
    const size_t named_count = count_named(self);
    if (!(self->layers = camber_alloc(self->context, named_count + 1, sizeof *self->layers)))
        return CAMBER_ERROR_MEMORY;
    if (!self->desc->layer && named_count) {
        const camber_status status = json_array_size(self->set->layers) ? CAMBER_OK : look_for_layers(self);
        if (status != CAMBER_OK)
            return status;
        if (has_schema(self))
            list_named(self);
    }
    return self->layer_count ? CAMBER_OK : choose_one(self);
}

static camber_status read_input(input *self, camber_tile_result *result) {
    const camber_schema *schema = self->features->schema;
    camber_status status = camber_tile_set_open(self->context, self->desc->path, CAMBER_NAMED_BY_CALLER, &self->set);
    if (status == CAMBER_OK)
        status = list_addresses(self);
    if (status == CAMBER_OK)
        status = choose_layers(self);
    if (status != CAMBER_OK)
        return status;
    const camber_tile_reading reading = {.set = self->set,
                                         .zoom = self->zoom,
                                         .addresses = self->addresses,
                                         .address_count = self->address_count,
                                         .mvt = {.features = self->features,
                                                 .layers = self->layers,
                                                 .layer_count = self->layer_count,
                                                 .wants_polygons = schema->wants_polygons,
                                                 .wants_areas = schema->wants_areas,
                                                 .wants_points = schema->wants_points,
                                                 .unsorted = true,
                                                 .no_schema = !has_schema(self)}};
    return camber_features_read_tiles(self->features, &reading, result);
}

/* Fails if the whole file contained nothing that can be drawn. */
static camber_status check_result(const input *self, const camber_mvt_stats *stats,
                                  const camber_features_mark *before) {
    if (self->features->feature_count > before->feature_count)
        return CAMBER_OK;
    if (stats->damaged_features)
        return fail_damaged(self, stats);
    if (stats->skipped_features == 0)
        return CAMBER_OK;
    return camber_fail(self->context, CAMBER_ERROR_INPUT,
                       "%s: no lines; its %zu features are points, areas or empty; choose another --layer, or a style "
                       "that draws outlines of polygons",
                       self->desc->path, stats->skipped_features);
}

static void add_stats(camber_features *features, const camber_mvt_stats *stats) {
    camber_features_count(features);
    features->stats.skipped_features += stats->skipped_features;
    features->stats.damaged_features += stats->damaged_features;
}

/* Warns about losses. Points and areas that are not drawn are not worth a warning, because nobody asked for them. */
static void warn_of_losses(const input *self, const camber_mvt_stats *stats) {
    if (stats->damaged_features)
        camber_log(self->context, CAMBER_LOG_WARNING,
                   "%s: %zu damaged features (the first: %s); their readable parts are kept", self->desc->path,
                   stats->damaged_features, stats->damage);
    if (stats->skipped_features)
        camber_log(self->context, CAMBER_LOG_INFO, "%s: left out what is %s of %zu features", self->desc->path,
                   camber_features_left_out(camber_features_kinds(self->features, false)), stats->skipped_features);
}

static bool knows(const char *path) {
    struct stat about;
    return camber_tile_set_knows(path) && strncmp(path, "/vsi", 4) != 0 &&
           !(stat(path, &about) == 0 && S_ISDIR(about.st_mode));
}

static bool reads(const camber_source_desc *desc) {
    return !desc->where;
}

static camber_status read_file(camber_features *features, const camber_source_desc *desc, bool *declined) {
    *declined = false;
    input self = {.context = features->context, .features = features, .desc = desc};
    const camber_features_mark before = camber_features_get_mark(features);
    const double start_ms = camber_now_ms();
    camber_tile_result result = {.found = 0};
    camber_status status = read_input(&self, &result);
    if (status == CAMBER_OK)
        status = check_result(&self, &result.stats, &before);
    if (status == CAMBER_OK)
        status = camber_features_add_attribution(features, self.set->attribution);
    camber_tile_set_close(self.set);
    camber_free(self.context, self.layers);
    camber_free(self.context, self.layer);
    camber_free(self.context, self.addresses);
    features->times.file_ms += camber_now_ms() - start_ms;
    if (status == CAMBER_OK)
        status =
            camber_features_merge_and_weigh(features, before.polyline_count, !self.desc->keep_apart, CAMBER_MERGE_ANY);
    if (status != CAMBER_OK) {
        camber_features_reset(features, &before);
        return status;
    }
    camber_features_pin_borders(features, before.polyline_count, self.zoom);
    camber_rings_report(features, desc->path, before.polyline_count, &before.stats);
    add_stats(features, &result.stats);
    warn_of_losses(&self, &result.stats);
    camber_progress(features->context, "reading", 1);
    return CAMBER_OK;
}

const camber_reader camber_tile_file_reader = {
    .knows = knows, .reads = reads, .read = read_file, .format = camber_tile_set_format};
