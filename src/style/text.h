/* Texts that grow in an evaluation's memory. */
#ifndef CAMBER_STYLE_TEXT_H
#define CAMBER_STYLE_TEXT_H

#include "style/evaluation.h"
#include "style/unicode.h"

typedef struct camber_string {
    camber_evaluation *e;
    char *bytes;
    size_t length, capacity;
} camber_string;

/* These return false where the memory or the time of an evaluation is used up, and set its cause. */
bool camber_string_add(camber_string *text, const char *bytes, size_t length);
/* Adds the value as "to-string" writes it. */
bool camber_string_add_value(camber_string *text, const camber_value *value);
/* Adds the text with its letters in the other case. */
bool camber_string_add_cased(camber_string *text, const char *string, camber_unicode_case_fn *change);
/* Puts a 0 behind the text and makes it a value. */
bool camber_string_end(camber_string *text, camber_value *value);

#endif
