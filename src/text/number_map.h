/* A map from numbers that are often close to each other, such as code points, to numbers: it consists of pages of 256
 * entries, and a page is made when it is first written to. */
#ifndef CAMBER_TEXT_NUMBER_MAP_H
#define CAMBER_TEXT_NUMBER_MAP_H

#include "base/base.h"

typedef struct camber_number_map {
    uint32_t **pages;
    size_t page_count;
} camber_number_map;

/* Returns 0 if nothing has been stored for the key. */
static inline uint32_t camber_number_map_get(const camber_number_map *map, uint32_t key) {
    const size_t page = key >> 8;
    return page < map->page_count && map->pages[page] ? map->pages[page][key & 255] : 0;
}
/* Stores a value. false: there is no memory. */
bool camber_number_map_set(camber_context *context, camber_number_map *map, uint32_t key, uint32_t value);
void camber_number_map_free(camber_context *context, camber_number_map *map);

#endif
