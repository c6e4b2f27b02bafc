/* Converts numbers to text and back as ECMAScript does, independently of the process's locale. */
#ifndef CAMBER_STYLE_NUMBER_H
#define CAMBER_STYLE_NUMBER_H

#include <stdbool.h>
#include <stddef.h>

/* The longest text of a double is -1.2345678901234567e-308, or 0.00000 followed by 17 digits. */
#define CAMBER_NUMBER_TEXT_SIZE 32

/* Parses a decimal number at the beginning of text: sign, digits, point, exponent. Returns its end, or NULL if there is
 * no number. A number too large for a double becomes infinite. */
const char *camber_number_parse(const char *text, double *number);
/* Number::toString: writes the fewest digits that read back as the same double. */
void camber_number_format(double number, char text[CAMBER_NUMBER_TEXT_SIZE]);

#endif
