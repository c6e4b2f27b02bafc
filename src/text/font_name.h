/* Names of fonts as styles write them: a family, then words of its style, such as "Open Sans Semibold Italic". */
#ifndef CAMBER_TEXT_FONT_NAME_H
#define CAMBER_TEXT_FONT_NAME_H

#include "base/base.h"

typedef struct camber_font_style {
    float weight;   /* 1 to 1000; 400 is regular, 700 bold */
    float width;    /* percent; 100 is normal */
    bool is_italic; /* or oblique */
} camber_font_style;

#define CAMBER_FONT_STYLE_REGULAR ((camber_font_style){400.0f, 100.0f, false})

/* A name without its style, and both as keys: hashes of their letters and digits, whatever the case. */
typedef struct camber_font_name {
    uint64_t whole_key;  /* with the style, but without the word "regular" */
    uint64_t family_key; /* equals whole_key if no word of the name is one of a style */
    camber_font_style style;
} camber_font_name;

camber_font_name camber_font_name_split(const char *name);
/* The whole key of a name that stands in two parts. b may be NULL. */
uint64_t camber_font_name_key(const char *a, const char *b);
/* How much two styles differ; 0: not at all. */
float camber_font_style_compare(const camber_font_style *a, const camber_font_style *b);

/* The Debian package that has a font of this name. NULL: it is not known. */
const char *camber_font_name_package(const char *name);

#endif
