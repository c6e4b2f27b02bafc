/* A set of features in a file, as it is once files are read, merged and weighed: for parts of one run. */
#ifndef CAMBER_TILES_FEATURES_FILE_H
#define CAMBER_TILES_FEATURES_FILE_H

#include "features/features.h"

/* Writes the set, whole or not at all. input: the hash of the set, which says what it is of. force: it replaces another
 * file. Returns CAMBER_ERROR_IO, CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT (a number that JSON does not have). */
camber_status camber_features_save(const camber_features *features, uint64_t input, const char *path, bool force);
/* Reads the set into an empty one: the lines that touch its region, if it has one, and any of two boxes or more, which
 * lie in it. Features and classes keep their numbers. Returns CAMBER_ERROR_NOT_FOUND, CAMBER_ERROR_INPUT (another set,
 * or damaged), CAMBER_ERROR_IO, CAMBER_ERROR_MEMORY. */
camber_status camber_features_load(camber_features *features, const camber_region *boxes, size_t box_count,
                                   uint64_t input, const char *path);

#endif
