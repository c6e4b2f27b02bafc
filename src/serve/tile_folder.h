/* Encoded tiles in a folder, so that a server that is started again need not draw them again.
 *
 *     FOLDER/INPUT/LOOK/ZOOM/COLUMN/ROW      INPUT and LOOK in hexadecimal
 *
 * INPUT is a hash of everything that the tiles are drawn from, so another input uses other files. Files of former
 * inputs may be deleted at any time, and so may any other file. A file contains a tile, and then its tag, the hash that
 * is also used for ETags. If the tag does not match, the file is damaged or something else, and the tile is drawn
 * again. Any thread may call these functions. */
#ifndef CAMBER_SERVE_TILE_FOLDER_H
#define CAMBER_SERVE_TILE_FOLDER_H

#include "serve/tile_cache.h"

typedef struct camber_tile_folder {
    const char *path; /* of an existing folder */
    /* Called when a tile cannot be written. It is not called again until a tile has been written successfully. */
    void (*failed)(void *user, const char *message);
    void *user;
    atomic_bool fails;
} camber_tile_folder;

/* Returns the bytes of a file in a folder, which the caller then holds. Links within the folder are not followed.
 * Returns NULL if the file is missing, empty, or cannot be read. */
camber_body *camber_body_read(const char *folder, const char *name);
/* Returns the tile, which the caller then holds; NULL if it is missing or cannot be read. */
camber_body *camber_tile_folder_get(const camber_tile_folder *folder, uint64_t input, camber_tile_key key);
void camber_tile_folder_put(camber_tile_folder *folder, uint64_t input, camber_tile_key key, const camber_body *body);

#endif
