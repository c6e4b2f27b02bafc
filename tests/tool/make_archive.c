/* Writes an archive of made-up tiles by the writer that draws use, for the tests from outside.
 *
 *     make_archive OUT COUNT [shard=K/N] [style=NAME] [resume] [force] [pause=MICROSECONDS] [halt=UNITS]
 *                  [lossy] [forward]
 *
 * The tiles are those of the numbers 0 to COUNT - 1, in units of 1024, from the last unit to the first and from each
 * unit's last tile to its first; forward: from the first to the last, as an archive has them. pause: time to kill it,
 * after each unit. halt: it prints a line after so many units, and goes on when its standard input ends. lossy: every
 * 7th tile is left out. Exit statuses are the tool's: 74 where writing failed, 65 where units are of another run. */
#define _XOPEN_SOURCE 700

#include "archive/archive.h"
#include "archive/pmtiles.h"
#include "tile_maker.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { UNIT_TILES = 1024 };

typedef struct making {
    camber_archive_writer *writer;
    uint64_t count;
    long pause_us, halt; /* 0: nowhere */
    bool lossy, forward;
} making;

static void print_log(void *user, camber_log_level level, const char *message) {
    (void)user;
    if (level == CAMBER_LOG_ERROR)
        fprintf(stderr, "%s\n", message);
}

static camber_status add_unit(const making *m, uint64_t unit) {
    const uint64_t first = unit * UNIT_TILES, end = first + UNIT_TILES < m->count ? first + UNIT_TILES : m->count;
    unsigned char bytes[MADE_TILE_BYTES];
    camber_status status = CAMBER_OK;
    for (uint64_t i = 0; i < end - first && status == CAMBER_OK; i++) {
        const uint64_t number = m->forward ? first + i : end - 1 - i;
        const int zoom = camber_archive_zoom(number);
        camber_tile_index tile;
        if (m->lossy && number % 7 == 0)
            continue;
        camber_pmtiles_locate(number - camber_archive_first(zoom), zoom, &tile.column, &tile.row);
        const size_t size = make_tile(made_tile_value(number), bytes);
        status = camber_archive_writer_add(m->writer, zoom, tile, bytes, size);
    }
    return status == CAMBER_OK ? camber_archive_writer_end_unit(m->writer, unit) : status;
}

static void halt(void) {
    puts("halted");
    fflush(stdout);
    while (getchar() != EOF)
        continue;
}

static camber_status make(const making *m, uint32_t shard, uint32_t shards) {
    const uint64_t units = (m->count + UNIT_TILES - 1) / UNIT_TILES;
    const uint64_t first = shards ? units * (shard - 1) / shards : 0, end = shards ? units * shard / shards : units;
    const struct timespec pause = {.tv_nsec = m->pause_us * 1000};
    camber_status status = CAMBER_OK;
    long ended = 0;
    if (camber_archive_writer_is_done(m->writer))
        return CAMBER_OK;
    for (uint64_t i = 0; i < end - first && status == CAMBER_OK; i++) {
        const uint64_t unit = m->forward ? first + i : end - 1 - i;
        if (camber_archive_writer_has_unit(m->writer, unit))
            continue;
        status = add_unit(m, unit);
        if (++ended == m->halt)
            halt();
        nanosleep(&pause, NULL);
    }
    return status == CAMBER_OK ? camber_archive_writer_finish(m->writer) : status;
}

int main(int argc, char **argv) {
    camber_context *context = NULL;
    const camber_context_desc context_desc = {.log = print_log};
    json_t *metadata = json_pack("{s:s, s:s}", "name", "made", "attribution", "nobody");
    char fingerprint[128] = "input=made style=plain version=1";
    camber_archive_desc desc = {.type = CAMBER_TILE_PNG, .metadata = metadata, .fingerprint = fingerprint};
    making m = {0};
    if (argc < 3 || !camber_archive_get_format(argv[1], &desc.format) ||
        camber_context_create(&context_desc, &context) != CAMBER_OK)
        return 2;
    desc.path = argv[1];
    m.count = strtoull(argv[2], NULL, 10);
    desc.center = (camber_archive_center){true, 0, 0, 2};
    for (int i = 3; i < argc; i++) {
        if (strncmp(argv[i], "shard=", 6) == 0)
            sscanf(argv[i] + 6, "%u/%u", &desc.shard, &desc.shards);
        else if (strncmp(argv[i], "style=", 6) == 0)
            snprintf(fingerprint, sizeof fingerprint, "input=made style=%s version=1", argv[i] + 6);
        else if (strncmp(argv[i], "pause=", 6) == 0)
            m.pause_us = strtol(argv[i] + 6, NULL, 10);
        else if (strncmp(argv[i], "halt=", 5) == 0)
            m.halt = strtol(argv[i] + 5, NULL, 10);
        desc.resume = desc.resume || strcmp(argv[i], "resume") == 0;
        desc.force = desc.force || strcmp(argv[i], "force") == 0;
        m.forward = m.forward || strcmp(argv[i], "forward") == 0;
        m.lossy = m.lossy || strcmp(argv[i], "lossy") == 0;
    }
    camber_status status = camber_archive_writer_create(context, &desc, &m.writer);
    if (status == CAMBER_OK)
        status = make(&m, desc.shard, desc.shards);
    camber_archive_writer_destroy(m.writer);
    json_decref(metadata);
    camber_context_destroy(context);
    return status == CAMBER_OK ? 0 : status == CAMBER_ERROR_IO ? 74 : status == CAMBER_ERROR_INPUT ? 65 : 70;
}
