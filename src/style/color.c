/* Parses colours of CSS Color Module Level 4: hex digits, rgb(), hsl() and names.
 *
 * Input: text. Output: straight sRGB components from 0 to 1; false if the text is not a colour. */
#include "style/color.h"

#include "style/number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct named_color {
    char name[24];
    uint32_t rgb;
} named_color;

/* CSS Color Module Level 4, section 6.1, sorted by name. */
static const named_color named_colors[] = {{"aliceblue", 0xf0f8ff},
                                           {"antiquewhite", 0xfaebd7},
                                           {"aqua", 0x00ffff},
                                           {"aquamarine", 0x7fffd4},
                                           {"azure", 0xf0ffff},
                                           {"beige", 0xf5f5dc},
                                           {"bisque", 0xffe4c4},
                                           {"black", 0x000000},
                                           {"blanchedalmond", 0xffebcd},
                                           {"blue", 0x0000ff},
                                           {"blueviolet", 0x8a2be2},
                                           {"brown", 0xa52a2a},
                                           {"burlywood", 0xdeb887},
                                           {"cadetblue", 0x5f9ea0},
                                           {"chartreuse", 0x7fff00},
                                           {"chocolate", 0xd2691e},
                                           {"coral", 0xff7f50},
                                           {"cornflowerblue", 0x6495ed},
                                           {"cornsilk", 0xfff8dc},
                                           {"crimson", 0xdc143c},
                                           {"cyan", 0x00ffff},
                                           {"darkblue", 0x00008b},
                                           {"darkcyan", 0x008b8b},
                                           {"darkgoldenrod", 0xb8860b},
                                           {"darkgray", 0xa9a9a9},
                                           {"darkgreen", 0x006400},
                                           {"darkgrey", 0xa9a9a9},
                                           {"darkkhaki", 0xbdb76b},
                                           {"darkmagenta", 0x8b008b},
                                           {"darkolivegreen", 0x556b2f},
                                           {"darkorange", 0xff8c00},
                                           {"darkorchid", 0x9932cc},
                                           {"darkred", 0x8b0000},
                                           {"darksalmon", 0xe9967a},
                                           {"darkseagreen", 0x8fbc8f},
                                           {"darkslateblue", 0x483d8b},
                                           {"darkslategray", 0x2f4f4f},
                                           {"darkslategrey", 0x2f4f4f},
                                           {"darkturquoise", 0x00ced1},
                                           {"darkviolet", 0x9400d3},
                                           {"deeppink", 0xff1493},
                                           {"deepskyblue", 0x00bfff},
                                           {"dimgray", 0x696969},
                                           {"dimgrey", 0x696969},
                                           {"dodgerblue", 0x1e90ff},
                                           {"firebrick", 0xb22222},
                                           {"floralwhite", 0xfffaf0},
                                           {"forestgreen", 0x228b22},
                                           {"fuchsia", 0xff00ff},
                                           {"gainsboro", 0xdcdcdc},
                                           {"ghostwhite", 0xf8f8ff},
                                           {"gold", 0xffd700},
                                           {"goldenrod", 0xdaa520},
                                           {"gray", 0x808080},
                                           {"green", 0x008000},
                                           {"greenyellow", 0xadff2f},
                                           {"grey", 0x808080},
                                           {"honeydew", 0xf0fff0},
                                           {"hotpink", 0xff69b4},
                                           {"indianred", 0xcd5c5c},
                                           {"indigo", 0x4b0082},
                                           {"ivory", 0xfffff0},
                                           {"khaki", 0xf0e68c},
                                           {"lavender", 0xe6e6fa},
                                           {"lavenderblush", 0xfff0f5},
                                           {"lawngreen", 0x7cfc00},
                                           {"lemonchiffon", 0xfffacd},
                                           {"lightblue", 0xadd8e6},
                                           {"lightcoral", 0xf08080},
                                           {"lightcyan", 0xe0ffff},
                                           {"lightgoldenrodyellow", 0xfafad2},
                                           {"lightgray", 0xd3d3d3},
                                           {"lightgreen", 0x90ee90},
                                           {"lightgrey", 0xd3d3d3},
                                           {"lightpink", 0xffb6c1},
                                           {"lightsalmon", 0xffa07a},
                                           {"lightseagreen", 0x20b2aa},
                                           {"lightskyblue", 0x87cefa},
                                           {"lightslategray", 0x778899},
                                           {"lightslategrey", 0x778899},
                                           {"lightsteelblue", 0xb0c4de},
                                           {"lightyellow", 0xffffe0},
                                           {"lime", 0x00ff00},
                                           {"limegreen", 0x32cd32},
                                           {"linen", 0xfaf0e6},
                                           {"magenta", 0xff00ff},
                                           {"maroon", 0x800000},
                                           {"mediumaquamarine", 0x66cdaa},
                                           {"mediumblue", 0x0000cd},
                                           {"mediumorchid", 0xba55d3},
                                           {"mediumpurple", 0x9370db},
                                           {"mediumseagreen", 0x3cb371},
                                           {"mediumslateblue", 0x7b68ee},
                                           {"mediumspringgreen", 0x00fa9a},
                                           {"mediumturquoise", 0x48d1cc},
                                           {"mediumvioletred", 0xc71585},
                                           {"midnightblue", 0x191970},
                                           {"mintcream", 0xf5fffa},
                                           {"mistyrose", 0xffe4e1},
                                           {"moccasin", 0xffe4b5},
                                           {"navajowhite", 0xffdead},
                                           {"navy", 0x000080},
                                           {"oldlace", 0xfdf5e6},
                                           {"olive", 0x808000},
                                           {"olivedrab", 0x6b8e23},
                                           {"orange", 0xffa500},
                                           {"orangered", 0xff4500},
                                           {"orchid", 0xda70d6},
                                           {"palegoldenrod", 0xeee8aa},
                                           {"palegreen", 0x98fb98},
                                           {"paleturquoise", 0xafeeee},
                                           {"palevioletred", 0xdb7093},
                                           {"papayawhip", 0xffefd5},
                                           {"peachpuff", 0xffdab9},
                                           {"peru", 0xcd853f},
                                           {"pink", 0xffc0cb},
                                           {"plum", 0xdda0dd},
                                           {"powderblue", 0xb0e0e6},
                                           {"purple", 0x800080},
                                           {"rebeccapurple", 0x663399},
                                           {"red", 0xff0000},
                                           {"rosybrown", 0xbc8f8f},
                                           {"royalblue", 0x4169e1},
                                           {"saddlebrown", 0x8b4513},
                                           {"salmon", 0xfa8072},
                                           {"sandybrown", 0xf4a460},
                                           {"seagreen", 0x2e8b57},
                                           {"seashell", 0xfff5ee},
                                           {"sienna", 0xa0522d},
                                           {"silver", 0xc0c0c0},
                                           {"skyblue", 0x87ceeb},
                                           {"slateblue", 0x6a5acd},
                                           {"slategray", 0x708090},
                                           {"slategrey", 0x708090},
                                           {"snow", 0xfffafa},
                                           {"springgreen", 0x00ff7f},
                                           {"steelblue", 0x4682b4},
                                           {"tan", 0xd2b48c},
                                           {"teal", 0x008080},
                                           {"thistle", 0xd8bfd8},
                                           {"tomato", 0xff6347},
                                           {"turquoise", 0x40e0d0},
                                           {"violet", 0xee82ee},
                                           {"wheat", 0xf5deb3},
                                           {"white", 0xffffff},
                                           {"whitesmoke", 0xf5f5f5},
                                           {"yellow", 0xffff00},
                                           {"yellowgreen", 0x9acd32}};

static char lower(char c) {
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

static const char *skip_space(const char *text) {
    return text + strspn(text, " \t\r\n\f");
}

static int compare_names(const void *key, const void *named) {
    return strcmp(key, ((const named_color *)named)->name);
}

static camber_color from_rgba8(uint32_t r, uint32_t g, uint32_t b, uint32_t a) {
    return (camber_color){(float)r / 255.0f, (float)g / 255.0f, (float)b / 255.0f, (float)a / 255.0f};
}

static bool parse_hex(const char *text, size_t length, camber_color *color) {
    uint32_t digits[8] = {0};
    if (length != 3 && length != 4 && length != 6 && length != 8)
        return false;
    for (size_t i = 0; i < length; i++) {
        const char c = lower(text[i]);
        if (c >= '0' && c <= '9')
            digits[i] = (uint32_t)(c - '0');
        else if (c >= 'a' && c <= 'f')
            digits[i] = (uint32_t)(c - 'a' + 10);
        else
            return false;
    }
    uint32_t parts[4] = {0, 0, 0, 255};
    const size_t step = length > 4 ? 2 : 1;
    for (size_t i = 0; i < length / step; i++)
        parts[i] = step == 2 ? digits[2 * i] * 16 + digits[2 * i + 1] : digits[i] * 17;
    *color = from_rgba8(parts[0], parts[1], parts[2], parts[3]);
    return true;
}

typedef enum unit {
    UNIT_NONE,
    UNIT_PERCENT,
    UNIT_ANGLE, /* converted to degrees */
} unit;

typedef struct component {
    double number;
    unit unit;
} component;

/* Returns the text after word, or NULL if text does not begin with it. Case is ignored; word is in lower case. */
static const char *after_word(const char *text, const char *word) {
    while (*word) {
        if (lower(*text++) != *word++)
            return NULL;
    }
    return text;
}

static const char *parse_component(const char *text, component *part) {
    static const struct {
        const char *name;
        double degrees;
    } angles[] = {{"deg", 1}, {"grad", 0.9}, {"rad", 57.29577951308232}, {"turn", 360}};
    text = camber_number_parse(text, &part->number);
    if (!text)
        return NULL;
    part->unit = UNIT_NONE;
    if (*text == '%') {
        part->unit = UNIT_PERCENT;
        return text + 1;
    }
    for (size_t i = 0; i < sizeof angles / sizeof *angles; i++) {
        const char *end = after_word(text, angles[i].name);
        if (end) {
            part->unit = UNIT_ANGLE;
            part->number *= angles[i].degrees;
            return end;
        }
    }
    return text;
}

/* Parses "1, 2, 3)", "1, 2, 3, .5)", "1 2 3)" or "1 2 3 / .5)" with nothing after it. Returns the number of components,
 * or 0 if the text is none of these. */
static size_t parse_arguments(const char *text, component parts[4], bool *commas) {
    size_t count = 0;
    *commas = false;
    for (;;) {
        text = parse_component(skip_space(text), &parts[count]);
        if (!text)
            return 0;
        count++;
        const char *next = skip_space(text);
        if (*next == ')')
            return *skip_space(next + 1) == 0 && count >= 3 ? count : 0;
        if (count == 4)
            return 0;
        if (count == 1)
            *commas = *next == ',';
        if (*commas ? *next != ',' : count == 3 ? *next != '/' : next == text || *next == ',')
            return 0;
        text = *commas || count == 3 ? next + 1 : next;
    }
}

static float clamp_unit(double number) {
    return number > 0.0 ? number < 1.0 ? (float)number : 1.0f : 0.0f;
}

static bool to_rgb(const component parts[3], bool commas, camber_color *color) {
    float channels[3];
    for (int i = 0; i < 3; i++) {
        if (parts[i].unit == UNIT_ANGLE || (commas && parts[i].unit != parts[0].unit))
            return false;
        channels[i] = clamp_unit(parts[i].number / (parts[i].unit == UNIT_PERCENT ? 100.0 : 255.0));
    }
    color->r = channels[0];
    color->g = channels[1];
    color->b = channels[2];
    return true;
}

/* CSS Color Module Level 4, section 7.1. */
static float hsl_channel(double n, double hue, double saturation, double lightness) {
    const double k = fmod(n + hue / 30.0, 12.0);
    const double a = saturation * (lightness < 0.5 ? lightness : 1.0 - lightness);
    return clamp_unit(lightness - a * fmax(-1.0, fmin(fmin(k - 3.0, 9.0 - k), 1.0)));
}

static bool to_hsl(const component parts[3], camber_color *color) {
    if (parts[0].unit == UNIT_PERCENT || parts[1].unit != UNIT_PERCENT || parts[2].unit != UNIT_PERCENT)
        return false;
    double hue = fmod(parts[0].number, 360.0);
    if (hue < 0.0)
        hue += 360.0;
    if (!isfinite(hue))
        return false;
    const double saturation = (double)clamp_unit(parts[1].number / 100.0);
    const double lightness = (double)clamp_unit(parts[2].number / 100.0);
    color->r = hsl_channel(0.0, hue, saturation, lightness);
    color->g = hsl_channel(8.0, hue, saturation, lightness);
    color->b = hsl_channel(4.0, hue, saturation, lightness);
    return true;
}

static bool parse_function(const char *text, camber_color *color) {
    component parts[4];
    bool commas;
    const char *arguments = after_word(text, "rgb");
    const bool rgb = arguments != NULL;
    if (!rgb)
        arguments = after_word(text, "hsl");
    if (!arguments)
        return false;
    arguments += lower(*arguments) == 'a';
    if (*arguments != '(')
        return false;
    const size_t count = parse_arguments(arguments + 1, parts, &commas);
    if (count == 0)
        return false;
    camber_color made = {0.0f, 0.0f, 0.0f, 1.0f};
    if (count == 4) {
        if (parts[3].unit == UNIT_ANGLE)
            return false;
        made.a = clamp_unit(parts[3].number / (parts[3].unit == UNIT_PERCENT ? 100.0 : 1.0));
    }
    if (!(rgb ? to_rgb(parts, commas, &made) : to_hsl(parts, &made)))
        return false;
    *color = made;
    return true;
}

bool camber_color_parse(const char *text, camber_color *color) {
    text = skip_space(text);
    size_t length = strlen(text);
    while (length > 0 && strchr(" \t\r\n\f", text[length - 1]))
        length--;
    if (*text == '#')
        return parse_hex(text + 1, length - 1, color);
    char name[sizeof named_colors[0].name];
    if (length == 0)
        return false;
    if (length >= sizeof name || strchr(text, '('))
        return parse_function(text, color);
    for (size_t i = 0; i < length; i++)
        name[i] = lower(text[i]);
    name[length] = 0;
    if (strcmp(name, "transparent") == 0) {
        *color = (camber_color){0.0f, 0.0f, 0.0f, 0.0f};
        return true;
    }
    const named_color *named =
        bsearch(name, named_colors, sizeof named_colors / sizeof *named_colors, sizeof *named_colors, compare_names);
    if (!named)
        return false;
    *color = from_rgba8(named->rgb >> 16, named->rgb >> 8 & 255, named->rgb & 255, 255);
    return true;
}
