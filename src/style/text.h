/* Texts that grow in an evaluation's memory. */
#ifndef CAMBER_STYLE_TEXT_H
#define CAMBER_STYLE_TEXT_H

#include "style/evaluation.h"

typedef struct camber_text {
    camber_evaluation *e;
    char *bytes;
    size_t length, capacity;
} camber_text;

/* These functions return false if the evaluation's memory or time is used up, and set its cause. */
bool camber_text_add(camber_text *text, const char *bytes, size_t length);
/* Adds the value as "to-string" writes it. */
bool camber_text_add_value(camber_text *text, const camber_value *value);
/* Appends a 0 to the text and makes it a value. */
bool camber_text_end(camber_text *text, camber_value *value);

#endif
