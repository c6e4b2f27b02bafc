/* Letters of Unicode in UTF-8: their case, their diacritics and their order, for the scripts of maps that have these.
 */
#ifndef CAMBER_UNICODE_H
#define CAMBER_UNICODE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The code point at text, which is not at its end. Returns its bytes. A byte that is no UTF-8 stands for itself, as
 * CAMBER_STRAY_BYTE + byte. */
#define CAMBER_STRAY_BYTE 0x110000u
size_t camber_unicode_read(const char *text, uint32_t *code);
/* Returns the bytes written. */
size_t camber_unicode_write(uint32_t code, char bytes[4]);

/* The other case's code points, two at most. Returns how many. */
typedef size_t camber_unicode_case_fn(uint32_t code, uint32_t other[2]);
camber_unicode_case_fn camber_unicode_upper, camber_unicode_lower;

/* The order of two texts by letters, then by diacritics and by case where these count: below 0, 0 or above. */
int camber_unicode_compare(const char *a, const char *b, bool by_case, bool by_diacritics);

#endif
