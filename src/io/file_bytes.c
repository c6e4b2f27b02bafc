/* A file that grows in memory. */
#include "io/encoder.h"

#include <string.h>

bool camber_file_bytes_add(camber_file_bytes *file, const void *bytes, size_t size_bytes) {
    file->refused |= !camber_grow(file->context, &file->bytes, &file->capacity, file->size + size_bytes, 1);
    if (file->refused)
        return false;
    memcpy(file->bytes + file->size, bytes, size_bytes);
    file->size += size_bytes;
    return true;
}
