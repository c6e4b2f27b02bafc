/* Verifies archives: collects findings, and checks what all formats have in common: zooms, bounds, metadata and the
 * bytes of tiles. */
#include "archive/verify.h"
#include "archive/contents.h"
#include "archive/pmtiles.h"
#include "archive/tile_check.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

/* ---- Bounds ---- */

static void check_bounds(camber_verify *v) {
    const double *b = v->archive->bounds;
    const camber_archive_center *center = &v->archive->center;
    const int low = v->archive->min_zoom, high = v->archive->max_zoom;
    if (low > high || low < 0 || high > CAMBER_LARGEST_TILE_ZOOM)
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true, "zooms from %d to %d make no sense", low, high);
    if (v->archive->has_bounds && !(b[0] < b[2] && b[1] < b[3])) {
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true, "the bounds %.7g,%.7g,%.7g,%.7g have no area", b[0], b[1],
                           b[2], b[3]);
        v->archive->has_bounds = false;
    } else if (v->archive->has_bounds && !(b[0] >= -180.0000001 && b[2] <= 180.0000001 && b[1] >= -90 && b[3] <= 90)) {
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true, "the bounds %.7g,%.7g,%.7g,%.7g extend beyond the world",
                           b[0], b[1], b[2], b[3]);
    }
    if (center->given && (center->zoom < low || center->zoom > high))
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true, "the centre's zoom %d is not from %d to %d", center->zoom,
                           low, high);
    if (center->given && v->archive->has_bounds &&
        (center->longitude < b[0] - 1e-6 || center->longitude > b[2] + 1e-6 || center->latitude < b[1] - 1e-6 ||
         center->latitude > b[3] + 1e-6))
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true, "the centre %.7g,%.7g is outside the bounds",
                           center->longitude, center->latitude);
    camber_verify_find_boxes(v);
}

/* Compares the stated zooms with the zooms of the tiles. */
static void check_zooms(camber_verify *v) {
    int low = -1, high = -1;
    for (int zoom = 0; zoom <= CAMBER_LARGEST_TILE_ZOOM; zoom++) {
        low = low < 0 && v->tally.zoom_tiles[zoom] ? zoom : low;
        high = v->tally.zoom_tiles[zoom] ? zoom : high;
    }
    if (low >= 0 && low != v->archive->min_zoom)
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true, "its lowest zoom is given as %d, but is %d",
                           v->archive->min_zoom, low);
    if (high >= 0 && high != v->archive->max_zoom)
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true, "its highest zoom is given as %d, but is %d",
                           v->archive->max_zoom, high);
    if (v->outside && v->flipped == v->outside && v->archive->format != CAMBER_ARCHIVE_PMTILES)
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true, "its rows count from the %s; %s count from the %s",
                           v->archive->format == CAMBER_ARCHIVE_MBTILES ? "north" : "south",
                           v->archive->format == CAMBER_ARCHIVE_MBTILES ? "those of MBTiles" : "a folder's",
                           v->archive->format == CAMBER_ARCHIVE_MBTILES ? "south" : "north");
}

/* ---- Verifying ---- */

static void check_metadata(camber_verify *v) {
    const json_t *about = v->archive->metadata;
    static const char *const texts[] = {"name", "description", "attribution", "version", "type"};
    if (v->archive->type == CAMBER_TILE_MVT && !json_is_array(json_object_get(about, "vector_layers")))
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true,
                           "the metadata have no vector_layers, which describe the layers of vector tiles");
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        const json_t *value = json_object_get(about, texts[i]);
        if (value && !json_is_string(value))
            camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true, "%s in the metadata is not a string", texts[i]);
    }
}

static void check_sum(camber_verify *v) {
    char text[17];
    camber_checksum_write(&v->checksum, text);
    if (v->archive->checksum[0] && strcmp(text, v->archive->checksum) != 0)
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true,
                           "the checksum of its tiles is %s, and was %s when they were written: some are damaged, or "
                           "another program has changed them",
                           text, v->archive->checksum);
}

static camber_status verify(camber_verify *v) {
    camber_status status = CAMBER_ERROR_INPUT;
    (void)camber_archive_sniff(v->archive); /* if this fails, the walk below fails, too */
    if (v->archive->sniffed && v->archive->format != CAMBER_ARCHIVE_FOLDER)
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true, "%s, and its tiles look like %s",
                           v->archive->format == CAMBER_ARCHIVE_PMTILES ? "the header names no type of tiles"
                                                                        : "the metadata have no format",
                           camber_tile_type_get_name(v->archive->type));
    check_bounds(v);
    check_metadata(v);
    switch (v->archive->format) {
    case CAMBER_ARCHIVE_PMTILES: status = camber_verify_pmtiles(v); break;
    case CAMBER_ARCHIVE_MBTILES: status = camber_verify_mbtiles(v); break;
    case CAMBER_ARCHIVE_FOLDER: status = camber_verify_folder(v); break;
    }
    if (status == CAMBER_OK) {
        check_zooms(v);
        check_sum(v);
    }
    return status;
}

/* Keeps the last error that was logged, because damage that prevents reading is also a finding. */
typedef struct kept_log {
    char error[1024];
} kept_log;

static void keep_error(void *user, camber_log_level level, const char *message) {
    kept_log *log = user;
    if (level == CAMBER_LOG_ERROR)
        snprintf(log->error, sizeof log->error, "%s", message);
}

typedef struct found {
    camber_tiles_findings findings; /* the part that is visible to the caller */
    camber_context *context;
} found;

/* Opens and verifies the archive, and turns error messages into findings. */
static camber_status run(camber_verify *v, const char *path) {
    kept_log log = {""};
    const camber_saved_log before = {v->context->desc.log, v->context->desc.log_user};
    v->context->desc.log = keep_error;
    v->context->desc.log_user = &log;
    camber_status status = camber_archive_open(v->context, path, &v->archive);
    if (status == CAMBER_OK)
        status = verify(v);
    if (status == CAMBER_ERROR_INPUT) {
        const size_t length = strlen(path);
        const bool named = strncmp(log.error, path, length) == 0 && log.error[length] == ':';
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true, "%s", log.error + (named ? length + 2 : 0));
        status = CAMBER_OK;
    }
    if (status == CAMBER_OK && v->out_of_memory)
        status = CAMBER_ERROR_MEMORY;
    v->context->desc.log = before.log;
    v->context->desc.log_user = before.user;
    return status == CAMBER_OK ? status : camber_fail(v->context, status, "%s", log.error);
}

camber_status camber_tiles_verify(camber_context *context, const char *path, camber_tiles_findings **findings) {
    found *made = camber_alloc_zero(context, 1, sizeof *made);
    camber_verify v = {.context = context,
                       .tally.context = context,
                       .bytes.context = context,
                       .unpacked.context = context,
                       .checksum.context = context};
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = context;
    camber_budget_begin(context);
    const camber_status status = run(&v, path);
    made->findings = (camber_tiles_findings){v.findings, v.count, v.left_out, v.tally.tiles, 0};
    for (int zoom = 0; zoom <= CAMBER_LARGEST_TILE_ZOOM; zoom++)
        made->findings.size_bytes += v.tally.zoom_bytes[zoom];
    camber_tally_free(&v.tally);
    camber_free(context, v.checksum.hashes);
    camber_bytes_free(&v.bytes);
    camber_bytes_free(&v.unpacked);
    camber_archive_close(v.archive);
    if (status != CAMBER_OK) {
        camber_tiles_findings_destroy(&made->findings);
        return status;
    }
    *findings = &made->findings;
    return CAMBER_OK;
}

void camber_tiles_findings_destroy(camber_tiles_findings *findings) {
    found *f = (found *)(void *)findings; /* findings is its first member */
    if (!f)
        return;
    for (size_t i = 0; i < f->findings.count; i++)
        camber_free(f->context, (void *)(uintptr_t)f->findings.findings[i].message);
    camber_free(f->context, (void *)(uintptr_t)f->findings.findings);
    camber_free(f->context, f);
}
