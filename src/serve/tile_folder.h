/* Encoded tiles in a folder, so that a server that starts again need not draw them again.
 *
 *     FOLDER/INPUT/LOOK/ZOOM/COLUMN/ROW      INPUT and LOOK in hexadecimal
 *
 * INPUT is a hash of all that tiles are drawn of: another input has other files, and those of former ones may be
 * deleted at any time, as may any file. A file has a tile and then its tag, the hash that ETags have. One that has
 * another is damaged, or something else: its tile is drawn again. Any thread may call. */
#ifndef CAMBER_SERVE_TILE_FOLDER_H
#define CAMBER_SERVE_TILE_FOLDER_H

#include "serve/tile_cache.h"

typedef struct camber_tile_folder {
    const char *path; /* of a folder that is there */
    /* A tile could not be written. It is told once, and again when one could be meanwhile. */
    void (*failed)(void *user, const char *message);
    void *user;
    atomic_bool fails;
} camber_tile_folder;

/* The bytes of a file of a folder, which the caller then holds. Links within the folder are not followed. NULL: it is
 * not there, is empty, or cannot be read. */
camber_body *camber_body_read(const char *folder, const char *name);
/* The tile, which the caller then holds. NULL: it is not there, or cannot be read. */
camber_body *camber_tile_folder_get(const camber_tile_folder *folder, uint64_t input, camber_tile_key key);
void camber_tile_folder_put(camber_tile_folder *folder, uint64_t input, camber_tile_key key, const camber_body *body);

#endif
