/* Converts numbers to text and back, as ECMAScript does. strtod and printf find the digits; this file brings them into
 * form. */
#include "style/number.h"

#include <float.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

static const char *skip_digits(const char *text) {
    while (is_digit(*text))
        text++;
    return text;
}

const char *camber_number_parse(const char *text, double *number) {
    const char *mantissa = text + (*text == '+' || *text == '-');
    const char *point = skip_digits(mantissa);
    const char *end = point;
    if (*point == '.')
        end = skip_digits(point + 1);
    if (end == mantissa || (end == mantissa + 1 && *point == '.'))
        return NULL;
    if (*end == 'e' || *end == 'E') {
        const char *exponent = end + 1 + (end[1] == '+' || end[1] == '-');
        if (is_digit(*exponent))
            end = skip_digits(exponent);
    }
    /* Parses without the locale's decimal point, which strtod would expect: the text is copied with that point in place
     * of ours. A number of more than 400 characters is rejected rather than misread; no style needs such a number. */
    char copy[416];
    const size_t length = (size_t)(end - text), before = (size_t)(point - text);
    const char *separator = localeconv()->decimal_point;
    const size_t separator_length = strlen(separator);
    if (length > 400 || separator_length > 8)
        return NULL;
    memcpy(copy, text, before);
    size_t used = before;
    if (*point == '.' && point < end) {
        memcpy(copy + used, separator, separator_length);
        used += separator_length;
        point++;
    }
    const size_t after = (size_t)(end - point);
    memcpy(copy + used, point, after);
    copy[used + after] = 0;
    *number = strtod(copy, NULL);
    return end;
}

/* Finds the shortest digits, without zeros at their end, and the decimal exponent e of 0.ddd * 10^e. A double preserves
 * any decimal of DBL_DIG digits, so shorter ones are found as DBL_DIG digits that end in zeros. Denormal numbers have
 * less than full precision, so for them each count is tried. */
static int shortest_digits(double magnitude, char digits[20], int *exponent) {
    char text[40];
    for (int count = magnitude < DBL_MIN ? 1 : DBL_DIG; count <= DBL_DECIMAL_DIG; count++) {
        snprintf(text, sizeof text, "%.*e", count - 1, magnitude);
        const double back = strtod(text, NULL);
        if (back >= magnitude && back <= magnitude)
            break;
    }
    int count = 0;
    const char *c = text;
    for (; *c && *c != 'e'; c++)
        if (is_digit(*c))
            digits[count++] = *c;
    while (count > 1 && digits[count - 1] == '0')
        count--;
    *exponent = (int)strtol(c + 1, NULL, 10) + 1;
    return count;
}

/* ECMA-262, Number::toString, with k = count and n = exponent. */
void camber_number_format(double number, char text[CAMBER_NUMBER_TEXT_SIZE]) {
    if (isnan(number) || isinf(number)) {
        snprintf(text, CAMBER_NUMBER_TEXT_SIZE, "%s", isnan(number) ? "NaN" : number > 0 ? "Infinity" : "-Infinity");
        return;
    }
    char digits[20] = "";
    int exponent = 0;
    const int count = shortest_digits(fabs(number), digits, &exponent);
    if (digits[0] == '0') {
        snprintf(text, CAMBER_NUMBER_TEXT_SIZE, "0");
        return;
    }
    const char *sign = number < 0 ? "-" : "";
    const char *zeros = "000000000000000000000";
    const size_t size = CAMBER_NUMBER_TEXT_SIZE;
    if (count <= exponent && exponent <= 21)
        snprintf(text, size, "%s%.*s%.*s", sign, count, digits, exponent - count, zeros);
    else if (exponent > 0 && exponent <= 21)
        snprintf(text, size, "%s%.*s.%.*s", sign, exponent, digits, count - exponent, digits + exponent);
    else if (exponent > -6 && exponent <= 0)
        snprintf(text, size, "%s0.%.*s%.*s", sign, -exponent, zeros, count, digits);
    else if (count == 1)
        snprintf(text, size, "%s%.1se%+d", sign, digits, exponent - 1);
    else
        snprintf(text, size, "%s%.1s.%.*se%+d", sign, digits, count - 1, digits + 1, exponent - 1);
}
