/* Merges parts into one archive: checks whether they fit together, and passes them to a writer.
 *
 * If the parts do not fit together, one message says why: which of the N parts are missing, which are given twice, and
 * which have another input, style, options or version. */
#include "archive/archive.h"

#include "camber_tiles.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct merging {
    camber_context *context;
    const camber_tiles_merge_desc *desc;
    camber_archive **parts;
    char troubles[3072];
} merging;

CAMBER_PRINTF(2, 3) static void add_trouble(merging *m, const char *format, ...) {
    const size_t used = strlen(m->troubles);
    va_list list;
    if (used + 64 > sizeof m->troubles)
        return;
    const int gap = snprintf(m->troubles + used, sizeof m->troubles - used, "%s", used ? "; " : "");
    va_start(list, format);
    vsnprintf(m->troubles + used + gap, sizeof m->troubles - used - (size_t)gap, format, list);
    va_end(list);
}

/* ---- Checks of the parts ---- */

/* Reads a number from the metadata, which is a text in MBTiles. Returns 0 if there is none. */
static double number_of(const camber_archive *archive, const char *name) {
    const json_t *value = json_object_get(archive->metadata, name);
    return json_is_string(value) ? strtod(json_string_value(value), NULL) : json_number_value(value);
}

/* Checks that the parts have the same number under this name, such as the size of their tiles, because tiles of two
 * sizes do not make a map. Archives of other tools may not state it. before and after: the text around the number in
 * the message. */
static void compare_numbers(merging *m, const char *name, const char *before, const char *after) {
    const camber_archive *first = NULL;
    for (size_t i = 0; i < m->desc->part_count; i++) {
        const double own = number_of(m->parts[i], name);
        if (own > 0 && first && own != number_of(first, name))
            add_trouble(m, "%s has tiles of %s%g%s, not %g as %s", m->parts[i]->path, before, own, after,
                        number_of(first, name), first->path);
        first = own > 0 && !first ? m->parts[i] : first;
    }
}

static void compare_sizes(merging *m) {
    compare_numbers(m, "tileSize", "", " px");
    if (!m->troubles[0])
        compare_numbers(m, "ratio", "ratio ", "");
}

static void compare_parts(merging *m, const camber_archive *first, const camber_archive *part) {
    if (part->type != first->type)
        add_trouble(m, "%s has tiles of type %s, not %s as %s", part->path, camber_tile_type_get_name(part->type),
                    camber_tile_type_get_name(first->type), first->path);
    else if (part->gzipped != first->gzipped)
        add_trouble(m, "%s has tiles that are%s compressed, unlike %s", part->path, part->gzipped ? "" : " not",
                    first->path);
    if (part->shards != first->shards) {
        add_trouble(m, "%s is %s, unlike %s", part->path,
                    !part->shards    ? "not a shard"
                    : !first->shards ? "a shard"
                                     : "a shard of a run with another number of shards",
                    first->path);
        return;
    }
    if (first->shards &&
        (!part->fingerprint || !first->fingerprint || strcmp(part->fingerprint, first->fingerprint) != 0)) {
        char names[256];
        camber_fingerprint_compare(part->fingerprint ? part->fingerprint : "",
                                   first->fingerprint ? first->fingerprint : "", names, sizeof names);
        add_trouble(m, "%s differs in its %s from %s", part->path, names, first->path);
    }
}

/* Checks that every part from 1 to N is there once. */
static void count_shards(merging *m) {
    const uint32_t shards = m->parts[0]->shards;
    char missing[512] = "";
    size_t count = 0;
    for (uint32_t k = 1; k <= shards; k++) {
        const camber_archive *found = NULL;
        for (size_t i = 0; i < m->desc->part_count; i++) {
            if (m->parts[i]->shard != k || m->parts[i]->shards != shards)
                continue;
            if (found)
                add_trouble(m, "part %u of %u is given twice, %s and %s", k, shards, found->path, m->parts[i]->path);
            found = m->parts[i];
        }
        const size_t used = strlen(missing);
        if (!found && used + 16 < sizeof missing)
            snprintf(missing + used, sizeof missing - used, "%s%u", count ? ", " : "", k);
        count += !found;
        if (count > m->desc->part_count + 1000) /* only damaged files announce more parts than this */
            break;
    }
    if (count)
        add_trouble(m, "part%s %s of %u %s missing", count == 1 ? "" : "s", missing, shards, count == 1 ? "is" : "are");
}

static camber_status check_parts(merging *m) {
    for (size_t i = 0; i < m->desc->part_count; i++)
        if (m->parts[i]->type == CAMBER_TILE_OTHER && m->parts[i]->format == CAMBER_ARCHIVE_MBTILES)
            return camber_fail(m->context, CAMBER_ERROR_INPUT,
                               "%s: its metadata have no format, and its first tile is of no known format; set it in "
                               "the metadata (png, jpg, webp, pbf)",
                               m->parts[i]->path);
    for (size_t i = 1; i < m->desc->part_count; i++)
        compare_parts(m, m->parts[0], m->parts[i]);
    if (m->parts[0]->shards)
        count_shards(m);
    else
        compare_sizes(m);
    if (!m->troubles[0])
        return CAMBER_OK;
    return camber_fail(m->context, CAMBER_ERROR_INPUT, "%s: cannot be merged: %s; give %s", m->desc->output,
                       m->troubles, m->parts[0]->shards ? "all parts of one run" : "archives of one kind");
}

/* ---- The merged archive ---- */

static void unite(camber_archive_desc *whole, const camber_archive *part) {
    double *bounds = whole->bounds;
    whole->min_zoom = part->min_zoom < whole->min_zoom ? part->min_zoom : whole->min_zoom;
    whole->max_zoom = part->max_zoom > whole->max_zoom ? part->max_zoom : whole->max_zoom;
    if (!part->has_bounds)
        return;
    bounds[0] = part->bounds[0] < bounds[0] ? part->bounds[0] : bounds[0];
    bounds[1] = part->bounds[1] < bounds[1] ? part->bounds[1] : bounds[1];
    bounds[2] = part->bounds[2] > bounds[2] ? part->bounds[2] : bounds[2];
    bounds[3] = part->bounds[3] > bounds[3] ? part->bounds[3] : bounds[3];
}

/* Parts of one run differ only in their tiles. For other archives, the texts of the first one are used, and the bounds
 * are united; if the centres differ, the middle of the united bounds is used. */
static camber_archive_desc describe(const merging *m, camber_archive_format format) {
    const camber_archive *first = m->parts[0];
    camber_archive_desc whole = {.path = m->desc->output,
                                 .format = format,
                                 .type = first->type,
                                 .gzipped = first->gzipped,
                                 .force = m->desc->force,
                                 .unites = true,
                                 .min_zoom = first->min_zoom,
                                 .max_zoom = first->max_zoom,
                                 .metadata = first->metadata};
    if (first->has_bounds)
        memcpy(whole.bounds, first->bounds, sizeof whole.bounds);
    if (first->shards || m->desc->part_count == 1) {
        whole.center = first->center;
        whole.center.zoom = first->whole_center_zoom;
        whole.fingerprint = first->fingerprint;
    }
    for (size_t i = 1; i < m->desc->part_count && !first->shards; i++)
        unite(&whole, m->parts[i]);
    return whole;
}

static camber_status write(merging *m, camber_archive_format format) {
    const camber_archive_desc whole = describe(m, format);
    camber_archive_writer *writer = NULL;
    if (format == CAMBER_ARCHIVE_MBTILES && whole.type == CAMBER_TILE_MVT && !whole.gzipped)
        return camber_fail(m->context, CAMBER_ERROR_INPUT,
                           "%s: its vector tiles are not compressed, but MBTiles needs them with gzip; write PMTiles",
                           m->parts[0]->path);
    camber_status status = camber_archive_writer_create(m->context, &whole, &writer);
    if (status == CAMBER_OK && m->desc->begun)
        m->desc->begun(m->desc->user);
    for (size_t i = 0; i < m->desc->part_count && status == CAMBER_OK; i++) {
        camber_progress_count(m->context, "reading parts", "parts", i, m->desc->part_count);
        status = camber_archive_writer_take(writer, m->parts[i]);
    }
    if (status == CAMBER_OK)
        status = camber_archive_writer_finish(writer);
    camber_archive_writer_destroy(writer);
    return status;
}

static camber_status open_parts(merging *m) {
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < m->desc->part_count && status == CAMBER_OK; i++)
        if ((status = camber_archive_open(m->context, m->desc->parts[i], &m->parts[i])) == CAMBER_OK)
            status = camber_archive_sniff(m->parts[i]);
    return status;
}

camber_status camber_tiles_merge(camber_context *context, const camber_tiles_merge_desc *desc) {
    merging m = {.context = context, .desc = desc};
    camber_archive_format format;
    if (desc->part_count == 0)
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "%s: no archives to merge; name them", desc->output);
    if (!camber_archive_get_format(desc->output, &format))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "%s: unknown extension; name it .pmtiles, .mbtiles, or a folder with a slash", desc->output);
    if (!(m.parts = camber_alloc_zero(context, desc->part_count, sizeof *m.parts)))
        return CAMBER_ERROR_MEMORY;
    camber_budget_begin(context);
    camber_status status = open_parts(&m);
    if (status == CAMBER_OK)
        status = check_parts(&m);
    if (status == CAMBER_OK)
        status = write(&m, format);
    for (size_t i = 0; i < desc->part_count; i++)
        camber_archive_close(m.parts[i]);
    camber_free(context, m.parts);
    return status;
}

bool camber_tiles_beside(const char *path, size_t n, char *name, size_t size) {
    return camber_archive_temporary_path(path, n, name, size);
}
