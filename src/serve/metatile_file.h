/* Metatiles as mod_tile reads them: 8 x 8 tiles in one file.
 *
 *     "META", count, x, y, z       int32 of this machine; the first tile of the metatile
 *     count times offset, size     tile x, y is entry 8 * x + y; a size of 0: there is no such tile
 *     the tiles
 *
 * The path has the bits of x and y in turn: FOLDER/NAME/Z/H4/H3/H2/H1/H0.meta, where H0 is of the lowest four bits. */
#ifndef CAMBER_SERVE_METATILE_FILE_H
#define CAMBER_SERVE_METATILE_FILE_H

#include "serve/tile_cache.h"

enum { CAMBER_METATILE_FILE_SIDE = 8, CAMBER_METATILE_FILE_TILES = 64 };

typedef struct camber_metatile_file {
    const char *folder, *name;
    int zoom;
    uint32_t column, row;      /* multiples of 8 */
    camber_body *const *tiles; /* CAMBER_METATILE_FILE_TILES, 8 * x + y; NULL: none */
} camber_metatile_file;

/* Writes its path. false: it is too long. */
bool camber_metatile_file_name(const camber_metatile_file *file, char *path, size_t size);
/* Writes the file beside its path, and renames it. Returns 0 or an errno. */
int camber_metatile_file_write(const camber_metatile_file *file);

#endif
