/* A set of vector tiles in one file, read as camber reads any. */
#ifndef CAMBER_TESTS_FUZZ_FUZZ_TILE_FILE_H
#define CAMBER_TESTS_FUZZ_FUZZ_TILE_FILE_H

#include "fuzz_scene.h"

/* Writes the bytes to a file, and reads that as an input and through a style's source; scheme is mbtiles or pmtiles.
 * Each time a scene is made of the lines. */
void fuzz_read_tiles(fuzz_run *run, const void *bytes, size_t size, const char *scheme);

#endif
