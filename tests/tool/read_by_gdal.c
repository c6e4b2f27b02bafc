/* Reads every tile of MBTiles by GDAL's raster driver, which shares nothing with camber.
 *
 *     read_by_gdal COUNT FILE STEP
 *
 * FILE is of make_archive: the tiles of the numbers 0 to COUNT - 1 are there, and no other. Every STEP-th is read, and
 * has the pixels that it was made of; the one behind the last is transparent. Exit status 1: a tile is another, 77:
 * GDAL here has no such driver. */
#include "archive/archive.h"
#include "archive/pmtiles.h"
#include "tile_maker.h"

#include <gdal.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = MADE_TILE_SIDE };

typedef struct zoomed {
    GDALDatasetH set;
    int zoom;
} zoomed;

static bool open_zoom(zoomed *now, const char *path, int zoom) {
    char level[32];
    snprintf(level, sizeof level, "ZOOM_LEVEL=%d", zoom);
    const char *const drivers[] = {"MBTiles", NULL}, *const options[] = {level, "USE_BOUNDS=NO", NULL};
    if (now->set && now->zoom == zoom)
        return true;
    if (now->set)
        GDALClose(now->set);
    now->set = GDALOpenEx(path, GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR, drivers, options, NULL);
    now->zoom = zoom;
    return now->set != NULL;
}

/* The first band, which is grey or red, and the last, the alpha. */
static bool read_tile(zoomed *now, const char *path, uint64_t number, uint8_t grey[64], uint8_t alpha[64]) {
    const int zoom = camber_archive_zoom(number);
    camber_tile_index tile;
    camber_pmtiles_locate(number - camber_archive_first(zoom), zoom, &tile.column, &tile.row);
    if (!open_zoom(now, path, zoom))
        return false;
    const int bands = GDALGetRasterCount(now->set), x = (int)tile.column * SIDE, y = (int)tile.row * SIDE;
    GDALRasterBandH first = GDALGetRasterBand(now->set, 1), last = GDALGetRasterBand(now->set, bands);
    return GDALRasterIO(first, GF_Read, x, y, SIDE, SIDE, grey, SIDE, SIDE, GDT_Byte, 0, 0) == CE_None &&
           GDALRasterIO(last, GF_Read, x, y, SIDE, SIDE, alpha, SIDE, SIDE, GDT_Byte, 0, 0) == CE_None;
}

static bool is_made(uint64_t number, const uint8_t grey[64], const uint8_t alpha[64]) {
    const uint64_t value = made_tile_value(number);
    bool same = true;
    for (size_t i = 0; i < 64; i++)
        same = same && grey[i] == (value >> i & 1 ? 255 : 16) && alpha[i] == 255;
    return same;
}

int main(int argc, char **argv) {
    if (argc != 4)
        return 2;
    const uint64_t count = strtoull(argv[1], NULL, 10), step = strtoull(argv[3], NULL, 10);
    uint8_t grey[64], alpha[64];
    zoomed now = {0};
    uint64_t read = 0;
    GDALAllRegister();
    if (!GDALGetDriverByName("MBTiles"))
        return 77;
    for (uint64_t number = 0; number < count; number += step, read++)
        if (!read_tile(&now, argv[2], number, grey, alpha) || !is_made(number, grey, alpha)) {
            fprintf(stderr, "%s: tile %llu is another\n", argv[2], (unsigned long long)number);
            return 1;
        }
    bool empty = camber_archive_zoom(count) != now.zoom || read_tile(&now, argv[2], count, grey, alpha);
    for (size_t i = 0; i < 64 && camber_archive_zoom(count) == now.zoom; i++)
        empty = empty && alpha[i] == 0;
    GDALClose(now.set);
    if (!empty)
        fprintf(stderr, "%s: tile %llu is there\n", argv[2], (unsigned long long)count);
    printf("%llu\n", (unsigned long long)read);
    return empty ? 0 : 1;
}
