/* Numbers to text and back as ECMAScript writes them, whatever the process's locale. */
#ifndef CAMBER_STYLE_NUMBER_H
#define CAMBER_STYLE_NUMBER_H

#include <stdbool.h>
#include <stddef.h>

/* The longest text of a double is -1.2345678901234567e-308 or 0.00000 and 17 digits. */
#define CAMBER_NUMBER_TEXT_SIZE 32

/* A decimal number at the beginning of text: sign, digits, point, exponent. Returns its end, or NULL where
 * there is none. A number too large for a double is infinite. */
const char *camber_number_parse(const char *text, double *number);
/* Number::toString: the fewest digits that read back as the same double. */
void camber_number_format(double number, char text[CAMBER_NUMBER_TEXT_SIZE]);

#endif
