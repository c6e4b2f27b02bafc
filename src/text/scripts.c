/* Tables of characters and scripts. */
#include "text/scripts.h"

#include <stddef.h>
#include <string.h>

typedef struct range {
    uint32_t first, last;
} range;

static bool is_in(const range *ranges, size_t count, uint32_t code) {
    size_t low = 0, high = count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (code > ranges[middle].last)
            low = middle + 1;
        else
            high = middle;
    }
    return low < count && code >= ranges[low].first;
}
#define IS_IN(ranges, code) is_in(ranges, sizeof(ranges) / sizeof *(ranges), code)

bool camber_is_invisible(uint32_t code) {
    return code == '\n' || code == 0xad || code == 0x61c || (code >= 0x200b && code <= 0x200f) ||
           (code >= 0x202a && code <= 0x202e) || (code >= 0x2060 && code <= 0x206f) ||
           (code >= 0xfe00 && code <= 0xfe0f) || (code >= 0xe0000 && code <= 0xe0fff);
}

bool camber_is_ideographic(uint32_t code) {
    static const range ranges[] = {
        {0x2e80, 0x2fdf},   /* radicals */
        {0x2ff0, 0x312f},   /* punctuation, hiragana, katakana, bopomofo */
        {0x31a0, 0x4dbf},   /* bopomofo, strokes, katakana, enclosed, compatibility, extension A */
        {0x4e00, 0xa4cf},   /* unified ideographs, Yi */
        {0xf900, 0xfaff},   /* compatibility ideographs */
        {0xfe10, 0xfe1f},   /* vertical forms */
        {0xfe30, 0xfe4f},   /* compatibility forms */
        {0xff00, 0xffef},   /* halfwidth and fullwidth forms */
        {0x20000, 0x323af}, /* further ideographs */
    };
    return code >= 0x2e80 && IS_IN(ranges, code);
}

bool camber_is_upright(uint32_t code) {
    /* Unicode's Vertical_Orientation U, Tu and Tr, for the characters that maps use. */
    static const range ranges[] = {
        {0xa7, 0xa7},     {0xa9, 0xa9},     {0xae, 0xae},       {0xb1, 0xb1},       {0xbc, 0xbe},
        {0xd7, 0xd7},     {0xf7, 0xf7},     {0x2ea, 0x2eb},     {0x1100, 0x11ff},   {0x2016, 0x2016},
        {0x2020, 0x2021}, {0x2030, 0x2031}, {0x203b, 0x203c},   {0x2042, 0x2042},   {0x2047, 0x2049},
        {0x2051, 0x2051}, {0x2100, 0x2101}, {0x2103, 0x2109},   {0x2113, 0x2117},   {0x211e, 0x2123},
        {0x2150, 0x217f}, {0x2189, 0x2189}, {0x221e, 0x221e},   {0x2234, 0x2235},   {0x2300, 0x2307},
        {0x2460, 0x24ff}, {0x25a0, 0x2619}, {0x2620, 0x2767},   {0x2776, 0x2793},   {0x2b12, 0x2b2f},
        {0x2e80, 0xa4cf}, {0xa960, 0xa97f}, {0xac00, 0xd7ff},   {0xe000, 0xfaff},   {0xfe10, 0xfe1f},
        {0xfe30, 0xfe48}, {0xfe50, 0xfe57}, {0xfe59, 0xfe62},   {0xff01, 0xff0c},   {0xff0e, 0xff1b},
        {0xff1f, 0xff5e}, {0xffe0, 0xffe7}, {0x1b000, 0x1b2ff}, {0x1f000, 0x1faff}, {0x20000, 0x323af},
    };
    return code >= 0xa7 && IS_IN(ranges, code);
}

bool camber_turns_without_form(uint32_t code) {
    static const range ranges[] = {
        {0x3008, 0x3011}, {0x3014, 0x301f}, {0x3030, 0x3030}, {0x30a0, 0x30a0}, {0x30fc, 0x30fc},
        {0xfe59, 0xfe5e}, {0xff08, 0xff09}, {0xff1a, 0xff1b}, {0xff3b, 0xff3b}, {0xff3d, 0xff3d},
        {0xff3f, 0xff3f}, {0xff5b, 0xff60}, {0xffe3, 0xffe3},
    };
    return code >= 0x3008 && IS_IN(ranges, code);
}

uint32_t camber_get_vertical_form(uint32_t code) {
    static const uint32_t forms[][2] = {
        {'!', 0xfe15},    {'#', 0xff03},    {'$', 0xff04},    {'%', 0xff05},    {'&', 0xff06},    {'(', 0xfe35},
        {')', 0xfe36},    {'*', 0xff0a},    {'+', 0xff0b},    {',', 0xfe10},    {'-', 0xfe32},    {'.', 0x30fb},
        {'/', 0xff0f},    {':', 0xfe13},    {';', 0xfe14},    {'<', 0xfe3f},    {'=', 0xff1d},    {'>', 0xfe40},
        {'?', 0xfe16},    {'@', 0xff20},    {'[', 0xfe47},    {'\\', 0xff3c},   {']', 0xfe48},    {'^', 0xff3e},
        {'_', 0xfe33},    {'`', 0xff40},    {'{', 0xfe37},    {'}', 0xfe38},    {'~', 0xff5e},    {0x2013, 0xfe32},
        {0x2014, 0xfe31}, {0x2018, 0xfe43}, {0x2019, 0xfe44}, {0x201c, 0xfe41}, {0x201d, 0xfe42}, {0x2025, 0xfe30},
        {0x2026, 0xfe19}, {0x2027, 0x30fb}, {0x3001, 0xfe11}, {0x3002, 0xfe12}, {0x3008, 0xfe3f}, {0x3009, 0xfe40},
        {0x300a, 0xfe3d}, {0x300b, 0xfe3e}, {0x300c, 0xfe41}, {0x300d, 0xfe42}, {0x300e, 0xfe43}, {0x300f, 0xfe44},
        {0x3010, 0xfe3b}, {0x3011, 0xfe3c}, {0x3014, 0xfe39}, {0x3015, 0xfe3a}, {0x3016, 0xfe17}, {0x3017, 0xfe18},
        {0xff01, 0xfe15}, {0xff08, 0xfe35}, {0xff09, 0xfe36}, {0xff0c, 0xfe10}, {0xff0d, 0xfe32}, {0xff0e, 0x30fb},
        {0xff1a, 0xfe13}, {0xff1b, 0xfe14}, {0xff1c, 0xfe3f}, {0xff1e, 0xfe40}, {0xff1f, 0xfe16}, {0xff3b, 0xfe47},
        {0xff3d, 0xfe48}, {0xff3f, 0xfe33}, {0xff5b, 0xfe37}, {0xff5d, 0xfe38}, {0xff5f, 0xfe35}, {0xff60, 0xfe36},
        {0xff61, 0xfe12}, {0xff62, 0xfe41}, {0xff63, 0xfe42},
    };
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++)
        if (forms[i][0] == code)
            return forms[i][1];
    return 0;
}

bool camber_is_cursive(uint32_t code) {
    static const range ranges[] = {
        {0x600, 0x6ff},     /* Arabic */
        {0x700, 0x77f},     /* Syriac, Arabic's supplement */
        {0x7c0, 0x7ff},     /* N'Ko */
        {0x840, 0x85f},     /* Mandaic */
        {0x870, 0x8ff},     /* Arabic, extended */
        {0x1800, 0x18af},   /* Mongolian */
        {0xfb50, 0xfdff},   /* presentation forms */
        {0xfe70, 0xfeff},   /* presentation forms */
        {0x1e900, 0x1e95f}, /* Adlam */
    };
    return code >= 0x600 && IS_IN(ranges, code);
}

static const char *get_ideographs_name(hb_script_t script, const char *language) {
    if (script == HB_SCRIPT_HANGUL || (language && strncmp(language, "ko", 2) == 0))
        return "CJK KR";
    if (script == HB_SCRIPT_HIRAGANA || script == HB_SCRIPT_KATAKANA || (language && strncmp(language, "ja", 2) == 0))
        return "CJK JP";
    if (language && (strcmp(language, "zh-Hant") == 0 || strcmp(language, "zh-TW") == 0))
        return "CJK TC";
    return "CJK SC";
}

const char *camber_get_script_name(hb_script_t script, const char *language) {
    switch (script) {
    case HB_SCRIPT_ARABIC: return "Arabic";
    case HB_SCRIPT_ARMENIAN: return "Armenian";
    case HB_SCRIPT_BENGALI: return "Bengali";
    case HB_SCRIPT_CANADIAN_SYLLABICS: return "Canadian Aboriginal";
    case HB_SCRIPT_CHEROKEE: return "Cherokee";
    case HB_SCRIPT_DEVANAGARI: return "Devanagari";
    case HB_SCRIPT_ETHIOPIC: return "Ethiopic";
    case HB_SCRIPT_GEORGIAN: return "Georgian";
    case HB_SCRIPT_GUJARATI: return "Gujarati";
    case HB_SCRIPT_GURMUKHI: return "Gurmukhi";
    case HB_SCRIPT_HEBREW: return "Hebrew";
    case HB_SCRIPT_JAVANESE: return "Javanese";
    case HB_SCRIPT_KANNADA: return "Kannada";
    case HB_SCRIPT_KHMER: return "Khmer";
    case HB_SCRIPT_LAO: return "Lao";
    case HB_SCRIPT_MALAYALAM: return "Malayalam";
    case HB_SCRIPT_MONGOLIAN: return "Mongolian";
    case HB_SCRIPT_MYANMAR: return "Myanmar";
    case HB_SCRIPT_NKO: return "NKo";
    case HB_SCRIPT_OL_CHIKI: return "Ol Chiki";
    case HB_SCRIPT_ORIYA: return "Oriya";
    case HB_SCRIPT_SINHALA: return "Sinhala";
    case HB_SCRIPT_SYRIAC: return "Syriac";
    case HB_SCRIPT_TAMIL: return "Tamil";
    case HB_SCRIPT_TELUGU: return "Telugu";
    case HB_SCRIPT_THAANA: return "Thaana";
    case HB_SCRIPT_THAI: return "Thai";
    case HB_SCRIPT_TIBETAN: return "Tibetan";
    case HB_SCRIPT_TIFINAGH: return "Tifinagh";
    case HB_SCRIPT_YI: return "Yi";
    case HB_SCRIPT_HAN:
    case HB_SCRIPT_BOPOMOFO:
    case HB_SCRIPT_HANGUL:
    case HB_SCRIPT_HIRAGANA:
    case HB_SCRIPT_KATAKANA: return get_ideographs_name(script, language);
    default: return NULL;
    }
}
