/* Unicode in UTF-8: case, diacritics and order of letters, for the scripts of maps that have these. */
#ifndef CAMBER_STYLE_UNICODE_H
#define CAMBER_STYLE_UNICODE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Reads the code point at text, which must not be empty. Returns its number of bytes. A byte that is not UTF-8 is read
 * as CAMBER_STRAY_BYTE + byte. */
#define CAMBER_STRAY_BYTE 0x110000u
size_t camber_unicode_read(const char *text, uint32_t *code);
/* Returns the number of bytes written. */
size_t camber_unicode_write(uint32_t code, char bytes[4]);

/* Writes the code points of the other case, at most two. Returns how many. */
typedef size_t camber_unicode_case_fn(uint32_t code, uint32_t other[2]);
camber_unicode_case_fn camber_unicode_upper, camber_unicode_lower;

/* Compares two texts by letters, then, if requested, by diacritics and by case. The result is below 0, 0 or above 0. */
int camber_unicode_compare(const char *a, const char *b, bool by_case, bool by_diacritics);

#endif
