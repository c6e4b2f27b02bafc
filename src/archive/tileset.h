/* 3D Tiles 1.1 beside a folder of mesh tiles: which tiles there are, for viewers that go by it. */
#ifndef CAMBER_ARCHIVE_TILESET_H
#define CAMBER_ARCHIVE_TILESET_H

#include "archive/writer.h"

/* A file of the set, its path relative to the folder. */
typedef camber_status (*camber_tileset_writer)(void *user, const char *path, const void *bytes, size_t size_bytes);

/* Writes tileset.json and subtrees/LEVEL.COLUMN.ROW.subtree. Returns what write returns, and CAMBER_ERROR_MEMORY. */
camber_status camber_tileset_write(const camber_archive_plan *plan, camber_tileset_writer write, void *user);

#endif
