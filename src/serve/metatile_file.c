/* Writes metatiles for mod_tile. The header describes the layout. */
#include "serve/metatile_file.h"

#include "base/whole_file.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>

enum { HASHES = 5 };

typedef struct file_header {
    char magic[4];
    int32_t count, column, row, zoom;
    struct {
        int32_t offset, size;
    } tiles[CAMBER_METATILE_FILE_TILES];
} file_header;

bool camber_metatile_file_name(const camber_metatile_file *file, char *path, size_t size) {
    unsigned hash[HASHES];
    uint32_t x = file->column, y = file->row;
    for (int i = 0; i < HASHES; i++) {
        hash[i] = (x & 15) << 4 | (y & 15);
        x >>= 4;
        y >>= 4;
    }
    return snprintf(path, size, "%s/%s/%d/%u/%u/%u/%u/%u.meta", file->folder, file->name, file->zoom, hash[4], hash[3],
                    hash[2], hash[1], hash[0]) < (int)size;
}

int camber_metatile_file_write(const camber_metatile_file *file) {
    char path[PATH_MAX];
    camber_file_part parts[1 + CAMBER_METATILE_FILE_TILES] = {{NULL, 0}};
    file_header header = {.magic = {'M', 'E', 'T', 'A'},
                          .count = CAMBER_METATILE_FILE_TILES,
                          .column = (int32_t)file->column,
                          .row = (int32_t)file->row,
                          .zoom = file->zoom};
    size_t offset = sizeof header;
    for (int i = 0; i < CAMBER_METATILE_FILE_TILES; i++) {
        const camber_body *tile = file->tiles[i];
        const size_t size_bytes = tile ? tile->size_bytes : 0;
        if (offset + size_bytes > INT32_MAX)
            return EFBIG;
        header.tiles[i].offset = (int32_t)offset;
        header.tiles[i].size = (int32_t)size_bytes;
        if (tile)
            parts[1 + i] = (camber_file_part){tile->bytes, size_bytes};
        offset += size_bytes;
    }
    parts[0] = (camber_file_part){&header, sizeof header};
    if (!camber_metatile_file_name(file, path, sizeof path))
        return ENAMETOOLONG;
    return camber_whole_file_write(path, strlen(file->folder) + 1, 0644, parts, sizeof parts / sizeof *parts);
}
