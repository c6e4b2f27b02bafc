/* Saves a set of features in a file for the parts of one run, after the input has been read, its lines have been
 * merged, and the importance of their points has been computed. */
#ifndef CAMBER_TILES_FEATURES_FILE_H
#define CAMBER_TILES_FEATURES_FILE_H

#include "features/features.h"

/* Writes the whole set, or no file at all. input: the hash of the set, which identifies it. force: an existing file may
 * be replaced. Returns CAMBER_ERROR_IO, CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT (a number that JSON cannot
 * represent). */
camber_status camber_features_save(const camber_features *features, uint64_t input, const char *path, bool force);
/* Reads the set into an empty one. If it has a region, only lines that touch the region are read; if there are two or
 * more boxes, which must be inside the region, only lines that touch one of the boxes. Labels' features are all read.
 * Features and classes keep their numbers. Returns CAMBER_ERROR_NOT_FOUND, CAMBER_ERROR_INPUT (another set, or a
 * damaged file), CAMBER_ERROR_IO, CAMBER_ERROR_MEMORY. */
camber_status camber_features_load(camber_features *features, const camber_region *boxes, size_t box_count,
                                   uint64_t input, const char *path);

#endif
