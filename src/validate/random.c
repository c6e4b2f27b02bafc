#include "validate/random.h"

uint64_t camber_random_bits(uint64_t *seed) {
    *seed ^= *seed >> 12;
    *seed ^= *seed << 25;
    *seed ^= *seed >> 27;
    return *seed * 2685821657736338717ull >> 11;
}

double camber_random_between(uint64_t *seed, double least, double most) {
    return least + (most - least) * (double)camber_random_bits(seed) * 0x1p-53;
}

size_t camber_random_below(uint64_t *seed, size_t bound) {
    return (size_t)(camber_random_bits(seed) % bound);
}
