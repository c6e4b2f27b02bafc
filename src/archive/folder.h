/* Folders of tiles: visits their files, and checks whether a folder may be replaced. */
#ifndef CAMBER_ARCHIVE_FOLDER_H
#define CAMBER_ARCHIVE_FOLDER_H

#include "archive/writer.h"

typedef struct camber_folder_file {
    const char *path, *extension;
    uint32_t zoom, column, row; /* as in the file's path; such a tile may not exist */
} camber_folder_file;

typedef struct camber_folder_visitor {
    camber_context *context;
    camber_status (*take_file)(void *user, const camber_folder_file *file);
    camber_status (*take_stranger)(
        void *user, const char *path); /* called for a name that is not that of a tile. NULL: such names are ignored */
    void *user;
    bool has_tileset; /* tileset.json and subtrees are expected */
} camber_folder_visitor;

/* Visits the files in the order of zoom, column and row. */
camber_status camber_folder_visit(const char *path, const camber_folder_visitor *visitor);

/* Checks whether a new archive may replace a folder. Returns CAMBER_ERROR_IO if the folder has files that are not part
 * of an archive and would be lost, or if no other folder can take its name. */
camber_status camber_folder_may_go(camber_context *context, const char *path);

#endif
