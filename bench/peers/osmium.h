/* libosmium as a reader of OpenStreetMap's PBF files. C and C++ read this. */
#ifndef CAMBER_BENCH_PEERS_OSMIUM_H
#define CAMBER_BENCH_PEERS_OSMIUM_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Reads the ways that have one of the keys, with all of their tags and their points in world coordinates, as a map
 * needs them. Threads besides the caller decode blocks. Gives the milliseconds and how many points there are; below 0:
 * the file does not read. */
double bench_osmium_read(const char *path, const char *const *keys, size_t key_count, size_t *points);

#ifdef __cplusplus
}
#endif

#endif
