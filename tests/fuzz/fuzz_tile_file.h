/* A set of vector tiles in one file, read as camber reads any. */
#ifndef CAMBER_TESTS_FUZZ_FUZZ_TILE_FILE_H
#define CAMBER_TESTS_FUZZ_FUZZ_TILE_FILE_H

#include "fuzz_scene.h"

void fuzz_write_file(const char *path, const void *bytes, size_t size);
/* Reads the file as an input, and through a style's source; what is read becomes a scene. scheme: as in mbtiles://. */
void fuzz_read_tiles(fuzz_run *run, const char *path, const char *scheme);

#endif
