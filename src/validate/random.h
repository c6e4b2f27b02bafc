/* Random numbers that are the same on every machine: xorshift64*, S. Vigna, "An experimental exploration of Marsaglia's
 * xorshift generators, scrambled". */
#ifndef CAMBER_VALIDATE_RANDOM_H
#define CAMBER_VALIDATE_RANDOM_H

#include <stddef.h>
#include <stdint.h>

/* Returns 53 random bits. seed: not 0; each call changes it. */
uint64_t camber_random_bits(uint64_t *seed);
double camber_random_between(uint64_t *seed, double least, double most);
/* Returns a number from 0 to bound - 1. */
size_t camber_random_below(uint64_t *seed, size_t bound);

#endif
