#include "text/number_map.h"

bool camber_number_map_set(camber_context *context, camber_number_map *map, uint32_t key, uint32_t value) {
    const size_t page = key >> 8;
    if (page >= map->page_count) {
        size_t capacity = map->page_count;
        if (!camber_grow(context, &map->pages, &capacity, page + 1, sizeof *map->pages))
            return false;
        memset(map->pages + map->page_count, 0, (capacity - map->page_count) * sizeof *map->pages);
        map->page_count = capacity;
    }
    if (!map->pages[page])
        map->pages[page] = camber_alloc_zero(context, 256, sizeof *map->pages[page]);
    if (!map->pages[page])
        return false;
    map->pages[page][key & 255] = value;
    return true;
}

void camber_number_map_free(camber_context *context, camber_number_map *map) {
    for (size_t i = 0; i < map->page_count; i++)
        camber_free(context, map->pages[i]);
    camber_free(context, map->pages);
    *map = (camber_number_map){0};
}
