/* An archive of PMTiles: opened, listed, and its tiles taken; and the same bytes as a directory. */
#include "fuzz.h"

#include "archive/pmtiles.h"
#include "archive/tile_set.h"

#include <stdio.h>
#include <unistd.h>

/* Tiles of a zoom that are taken. */
enum { MOST_TILES = 64 };

static void take_tiles(fuzz_run *run, camber_tile_set *set, int zoom) {
    camber_bytes bytes = {.context = run->context};
    camber_tile_index *places = NULL;
    size_t count = 0;
    if (fuzz_done(run, camber_tile_set_list(set, zoom, &places, &count)))
        for (size_t i = 0; i < count && i < MOST_TILES; i++) {
            const char *why = NULL;
            REQUIRE(places[i].column < 1u << zoom && places[i].row < 1u << zoom);
            if (!fuzz_done(run, camber_tile_set_get(set, zoom, places[i], &bytes, &why)))
                break;
        }
    camber_free(run->context, places);
    camber_bytes_free(&bytes);
}

static void parse(fuzz_run *run, const uint8_t *bytes, size_t size) {
    camber_pmtiles_directory directory = {0};
    const char *why = NULL;
    const camber_status status = camber_pmtiles_parse(run->context, bytes, size, &directory, &why);
    REQUIRE(status == CAMBER_OK ? !why : status == CAMBER_ERROR_MEMORY ? run->refused : why != NULL);
    run->errors = 0;
    for (size_t i = 1; i < directory.count; i++)
        REQUIRE(directory.entries[i].number > directory.entries[i - 1].number);
    camber_free(run->context, directory.entries);
}

static void use(fuzz_run *run, const uint8_t *bytes, size_t size) {
    char path[64];
    snprintf(path, sizeof path, "/tmp/camber-fuzz-%ld.pmtiles", (long)getpid());
    FILE *file = fopen(path, "wb");
    REQUIRE(file && fwrite(bytes, 1, size, file) == size && fclose(file) == 0);
    camber_tile_set *set = NULL;
    if (fuzz_done(run, camber_tile_set_open(run->context, path, CAMBER_NAMED_BY_CALLER, &set)))
        for (int zoom = set->min_zoom; zoom <= set->max_zoom && zoom < set->min_zoom + 3; zoom++)
            take_tiles(run, set, zoom);
    camber_tile_set_close(set);
    unlink(path);
    parse(run, bytes, size);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    fuzz_each(bytes, size, use);
    return 0;
}
