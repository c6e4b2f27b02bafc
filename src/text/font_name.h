/* Names of fonts as styles write them: a family, then words of its style, such as "Open Sans Semibold Italic". */
#ifndef CAMBER_TEXT_FONT_NAME_H
#define CAMBER_TEXT_FONT_NAME_H

#include "base/base.h"

typedef struct camber_font_style {
    float weight;   /* 1 to 1000; 400 is regular, 700 bold */
    float width;    /* percent; 100 is normal */
    bool is_italic; /* italic or oblique */
} camber_font_style;

#define CAMBER_FONT_STYLE_REGULAR ((camber_font_style){400.0f, 100.0f, false})

/* Two keys of a name, with and without its style, and the style. A key is a hash of letters and digits, whatever their
 * case. */
typedef struct camber_font_name {
    uint64_t whole_key;  /* with the style, but without the word "regular" */
    uint64_t family_key; /* equals whole_key if no word of the name belongs to a style */
    camber_font_style style;
} camber_font_name;

camber_font_name camber_font_name_split(const char *name);
/* Returns the whole key of a name that is given in two parts. b may be NULL. */
uint64_t camber_font_name_key(const char *a, const char *b);
/* Returns how much two styles differ; 0: not at all. */
float camber_font_style_compare(const camber_font_style *a, const camber_font_style *b);

/* Returns the Debian package that has a font with this name. NULL: it is not known. */
const char *camber_font_name_package(const char *name);

#endif
