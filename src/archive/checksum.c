#include "archive/checksum.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

bool camber_checksum_add(camber_checksum *checksum, uint64_t hash) {
    if (!camber_grow(checksum->context, &checksum->hashes, &checksum->capacity, checksum->count + 1,
                     sizeof *checksum->hashes))
        return false;
    checksum->hashes[checksum->count++] = hash;
    return true;
}

static int compare_hashes(const void *left, const void *right) {
    const uint64_t a = *(const uint64_t *)left, b = *(const uint64_t *)right;
    return a < b ? -1 : a > b;
}

void camber_checksum_write(camber_checksum *checksum, char text[17]) {
    uint64_t sum = 0;
    if (checksum->count)
        qsort(checksum->hashes, checksum->count, sizeof *checksum->hashes, compare_hashes);
    for (size_t i = 0; i < checksum->count; i++)
        if (i == 0 || checksum->hashes[i] != checksum->hashes[i - 1])
            sum += camber_mix(0, checksum->hashes[i]);
    snprintf(text, 17, "%016" PRIx64, sum);
    camber_free(checksum->context, checksum->hashes);
    *checksum = (camber_checksum){.context = checksum->context};
}
