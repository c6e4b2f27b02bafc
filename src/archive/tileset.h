/* The files of 3D Tiles 1.1 for a folder of mesh tiles. They tell viewers which tiles exist. */
#ifndef CAMBER_ARCHIVE_TILESET_H
#define CAMBER_ARCHIVE_TILESET_H

#include "archive/writer.h"

/* Writes a file of the set; path is relative to the folder. */
typedef camber_status (*camber_tileset_writer)(void *user, const char *path, const void *bytes, size_t size_bytes);

/* Writes tileset.json and subtrees/LEVEL.COLUMN.ROW.subtree. Returns the errors of the writer, and CAMBER_ERROR_MEMORY.
 */
camber_status camber_tileset_write(const camber_archive_plan *plan, camber_tileset_writer write, void *user);

#endif
