/* Metatiles in the format of mod_tile: 8 x 8 tiles in one file.
 *
 *     "META", count, x, y, z       int32 in this machine's byte order; the position of the metatile's first tile
 *     count times offset, size     tile x, y is entry 8 * x + y; size 0: the tile is missing
 *     the tiles
 *
 * The path interleaves the bits of x and y: FOLDER/NAME/Z/H4/H3/H2/H1/H0.meta, in which H0 contains the lowest four
 * bits of both. */
#ifndef CAMBER_SERVE_METATILE_FILE_H
#define CAMBER_SERVE_METATILE_FILE_H

#include "serve/tile_cache.h"

enum { CAMBER_METATILE_FILE_SIDE = 8, CAMBER_METATILE_FILE_TILES = 64 };

typedef struct camber_metatile_file {
    const char *folder, *name;
    int zoom;
    uint32_t column, row;      /* multiples of 8 */
    camber_body *const *tiles; /* CAMBER_METATILE_FILE_TILES of them, at 8 * x + y; NULL: missing */
} camber_metatile_file;

/* Writes the file's path to `path`. Returns false if it is too long. */
bool camber_metatile_file_name(const camber_metatile_file *file, char *path, size_t size);
/* Writes a temporary file in the same folder, and renames it. Returns 0 or an errno. */
int camber_metatile_file_write(const camber_metatile_file *file);

#endif
