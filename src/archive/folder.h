/* Folders of tiles: the files in them. */
#ifndef CAMBER_ARCHIVE_FOLDER_H
#define CAMBER_ARCHIVE_FOLDER_H

#include "archive/writer.h"

typedef struct camber_folder_file {
    const char *path, *extension;
    uint32_t zoom, column, row; /* as they are named; no such tile may exist */
} camber_folder_file;

typedef struct camber_folder_visitor {
    camber_context *context;
    camber_status (*take_file)(void *user, const camber_folder_file *file);
    camber_status (*take_stranger)(void *user, const char *path); /* a name that is none of a tile. NULL: not told */
    void *user;
    bool has_tileset; /* tileset.json and subtrees are no strangers */
} camber_folder_visitor;

/* Visits the files by zoom, column and row. */
camber_status camber_folder_visit(const char *path, const camber_folder_visitor *visitor);

/* Looks whether a new archive may take a folder's place. Returns CAMBER_ERROR_IO where that has something else than an
 * archive of tiles, which would be lost, or where no other folder can have its name. */
camber_status camber_folder_may_go(camber_context *context, const char *path);

#endif
