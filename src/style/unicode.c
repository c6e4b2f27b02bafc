/* Unicode for expressions, without a library: reading UTF-8, upper and lower case, and the order of a collator.
 *
 * It knows the scripts that are common on maps and have case or diacritics: Latin, Greek, Cyrillic, Armenian, Georgian.
 * Other letters have one case, and are ordered by code point.
 *
 * A library would know all scripts. ICU takes 36 MB installed, and libcamber-map does not link it: only GDAL loads it,
 * after the style has been compiled. libunistring takes 1.8 MB, and cannot collate by base letters without a locale of
 * the process. Filters on roads need neither, so these tables are enough (Debian 12, 2026-11). */
#include "style/unicode.h"

#include <string.h>

size_t camber_unicode_read(const char *text, uint32_t *code) {
    const unsigned char *c = (const unsigned char *)text;
    const size_t size = c[0] < 0x80 ? 1 : c[0] >= 0xc2 && c[0] < 0xe0 ? 2 : c[0] < 0xe0 ? 0 : c[0] < 0xf0 ? 3 : 4;
    *code = CAMBER_STRAY_BYTE + c[0];
    if (size == 0 || c[0] > 0xf4)
        return 1;
    uint32_t made = size == 1 ? c[0] : c[0] & (0xffu >> (size + 1));
    for (size_t i = 1; i < size; i++) {
        if ((c[i] & 0xc0) != 0x80)
            return 1;
        made = made << 6 | (c[i] & 0x3f);
    }
    *code = made;
    return size;
}

size_t camber_unicode_write(uint32_t code, char bytes[4]) {
    if (code >= CAMBER_STRAY_BYTE || code < 0x80) {
        bytes[0] = (char)(code & 0xff);
        return 1;
    }
    const size_t size = code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
    for (size_t i = size - 1; i > 0; i--, code >>= 6)
        bytes[i] = (char)(0x80 | (code & 0x3f));
    bytes[0] = (char)((0xf00u >> size & 0xf0) | code);
    return size;
}

/* ---- Case ---- */

/* Every step-th lower-case letter from first to last, and the distance to its upper-case letter. */
typedef struct range {
    uint16_t first, last, step;
    int16_t to_capital;
} range;

static const range ranges[] = {
    {'a', 'z', 1, -32},      {0xe0, 0xf6, 1, -32},    {0xf8, 0xfe, 1, -32},    {0xff, 0xff, 1, 121},
    {0x101, 0x12f, 2, -1},   {0x133, 0x137, 2, -1},   {0x13a, 0x148, 2, -1},   {0x14b, 0x177, 2, -1},
    {0x17a, 0x17e, 2, -1},   {0x1ce, 0x1dc, 2, -1},   {0x1df, 0x1ef, 2, -1},   {0x1f9, 0x21f, 2, -1},
    {0x223, 0x233, 2, -1},   {0x3ac, 0x3ac, 1, -38},  {0x3ad, 0x3af, 1, -37},  {0x3b1, 0x3c1, 1, -32},
    {0x3c3, 0x3cb, 1, -32},  {0x3cc, 0x3cc, 1, -64},  {0x3cd, 0x3ce, 1, -63},  {0x430, 0x44f, 1, -32},
    {0x450, 0x45f, 1, -80},  {0x461, 0x481, 2, -1},   {0x48b, 0x4bf, 2, -1},   {0x4c2, 0x4ce, 2, -1},
    {0x4cf, 0x4cf, 1, -15},  {0x4d1, 0x52f, 2, -1},   {0x561, 0x586, 1, -48},  {0x10d0, 0x10fa, 1, 3008},
    {0x1e01, 0x1e95, 2, -1}, {0x1ea1, 0x1eff, 2, -1}, {0xff41, 0xff5a, 1, -32}};

enum { SHARP_S = 0xdf, CAPITAL_SHARP_S = 0x1e9e, DOTLESS_I = 0x131, DOTTED_CAPITAL_I = 0x130, DOT_ABOVE = 0x307 };

size_t camber_unicode_upper(uint32_t code, uint32_t upper[2]) {
    /* Lower-case letters whose upper-case letter has a different lower-case letter. */
    static const uint16_t odd[][2] = {{0xb5, 0x39c}, {DOTLESS_I, 'I'}, {0x17f, 'S'}, {0x3c2, 0x3a3}};
    upper[0] = code;
    if (code == SHARP_S) {
        upper[0] = upper[1] = 'S';
        return 2;
    }
    for (size_t i = 0; i < sizeof odd / sizeof *odd; i++)
        if (code == odd[i][0])
            upper[0] = odd[i][1];
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++)
        if (code >= ranges[i].first && code <= ranges[i].last && (code - ranges[i].first) % ranges[i].step == 0)
            upper[0] = (uint32_t)((int32_t)code + ranges[i].to_capital);
    return 1;
}

size_t camber_unicode_lower(uint32_t code, uint32_t lower[2]) {
    lower[0] = code == CAPITAL_SHARP_S ? SHARP_S : code;
    if (code == DOTTED_CAPITAL_I) {
        lower[0] = 'i';
        lower[1] = DOT_ABOVE;
        return 2;
    }
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++) {
        const int64_t small = (int64_t)code - ranges[i].to_capital;
        if (small >= ranges[i].first && small <= ranges[i].last && (small - ranges[i].first) % ranges[i].step == 0)
            lower[0] = (uint32_t)small;
    }
    return 1;
}

/* ---- Order ---- */

/* Base letters of lower-case letters: latin_1 has one for each code from e0, latin_a one for each pair from 100. A
 * blank: the letter is its own base. */
static const char latin_1[] = "aaaaaa ceeeeiiii nooooo  uuuuy y";
static const char latin_a[] = "aaaccccd eeeeeggggh iiii  jk";

typedef struct base_range {
    uint16_t first, last;
    char base[3];
} base_range;

/* Base letters of lower-case letters that the two strings above do not cover. */
static const base_range bases[] = {
    {0x13a, 0x13e, "l"},        {0x144, 0x148, "n"},        {0x14d, 0x151, "o"},        {0x155, 0x159, "r"},
    {0x15b, 0x161, "s"},        {0x163, 0x165, "t"},        {0x169, 0x173, "u"},        {0x175, 0x175, "w"},
    {0x177, 0x177, "y"},        {0x17a, 0x17e, "z"},        {0x1ea1, 0x1eb7, "a"},      {0x1eb9, 0x1ec7, "e"},
    {0x1ec9, 0x1ecb, "i"},      {0x1ecd, 0x1ee3, "o"},      {0x1ee5, 0x1ef1, "u"},      {0x1ef3, 0x1ef9, "y"},
    {0x3ac, 0x3ac, "\xce\xb1"}, {0x3ad, 0x3ad, "\xce\xb5"}, {0x3ae, 0x3ae, "\xce\xb7"}, {0x3af, 0x3af, "\xce\xb9"},
    {0x3ca, 0x3ca, "\xce\xb9"}, {0x3cb, 0x3cb, "\xcf\x85"}, {0x3cc, 0x3cc, "\xce\xbf"}, {0x3cd, 0x3cd, "\xcf\x85"},
    {0x3ce, 0x3ce, "\xcf\x89"}};

static uint32_t base_of(uint32_t small) {
    uint32_t base = small;
    if (small >= 0xe0 && small <= 0xff && latin_1[small - 0xe0] != ' ')
        base = (unsigned char)latin_1[small - 0xe0];
    else if (small >= 0x100 && (small - 0x100) / 2 < sizeof latin_a - 1 && latin_a[(small - 0x100) / 2] != ' ')
        base = (unsigned char)latin_a[(small - 0x100) / 2];
    for (size_t i = 0; i < sizeof bases / sizeof *bases; i++)
        if (small >= bases[i].first && small <= bases[i].last)
            camber_unicode_read(bases[i].base, &base);
    return base;
}

/* A letter's properties, in the order in which they are compared. */
typedef struct weight {
    uint32_t base;
    uint32_t mark;
    bool capital;
} weight;

static bool is_mark(uint32_t code) {
    return code >= 0x300 && code <= 0x36f;
}

/* Orders blanks and punctuation before digits, and digits before letters. */
static uint32_t rank(uint32_t base) {
    if (base >= 0x80)
        return base + 1024;
    const uint32_t group = base >= 'a' && base <= 'z' ? 512 : base >= '0' && base <= '9' ? 256 : 0;
    return base + group;
}

/* Reads the next letter and the combining marks after it. base is 0 at the end. */
static const char *next_weight(const char *text, weight *made) {
    uint32_t code, small[2];
    *made = (weight){0};
    if (*text == 0)
        return text;
    text += camber_unicode_read(text, &code);
    camber_unicode_lower(code, small);
    const uint32_t base = base_of(small[0]);
    made->base = rank(base);
    made->mark = base == small[0] ? 0 : small[0];
    made->capital = small[0] != code;
    while (*text) {
        const size_t size = camber_unicode_read(text, &code);
        if (!is_mark(code))
            break;
        made->mark = made->mark * 31 + code;
        text += size;
    }
    return text;
}

int camber_unicode_compare(const char *a, const char *b, bool by_case, bool by_diacritics) {
    int marks = 0, cases = 0;
    for (;;) {
        weight left, right;
        a = next_weight(a, &left);
        b = next_weight(b, &right);
        if (left.base != right.base)
            return left.base < right.base ? -1 : 1;
        if (left.base == 0)
            break;
        if (marks == 0 && left.mark != right.mark)
            marks = left.mark < right.mark ? -1 : 1;
        if (cases == 0 && left.capital != right.capital)
            cases = right.capital ? -1 : 1;
    }
    return by_diacritics && marks ? marks : by_case ? cases : 0;
}
