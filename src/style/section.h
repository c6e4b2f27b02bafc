/* The sections of a formatted text, as "format" makes them. */
#ifndef CAMBER_STYLE_SECTION_H
#define CAMBER_STYLE_SECTION_H

#include "features/value.h"

struct camber_text_section {
    const char *text;  /* "" for an image */
    const char *image; /* its name. NULL: text */
    /* Each of these is null if the section does not give it. */
    camber_value scale; /* a number */
    camber_value fonts; /* an array of strings */
    camber_value color;
    camber_value align; /* "bottom", "center" or "top" */
};

#endif
