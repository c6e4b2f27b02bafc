/* A style document while it is read. Only document.c, layer.c and check.c include this. */
#ifndef CAMBER_STYLE_DOCUMENT_H
#define CAMBER_STYLE_DOCUMENT_H

#include "style/properties.h"

/* Warnings of one document, past which it says so once more and no longer. */
enum { CAMBER_WARNING_LIMIT = 32 };

typedef struct camber_document {
    camber_compiler compiler;
    json_t *root;
    const char *warned[CAMBER_WARNING_LIMIT]; /* what was warned of; the document's strings */
    size_t warned_count;
    json_t *by_id;          /* layers by id, which others may refer to */
    json_t *source_indices; /* by name */
    bool reads_on;          /* past what is wrong: all of it is wanted */
} camber_document;

/* Reads the bytes into the compiler's style, which is there and empty; the root stays. Returns the compiler's status,
 * where it reads on CAMBER_OK whatever is wrong. */
camber_status camber_document_read(camber_document *d, const char *json, size_t size_bytes);
/* What reading took; not the style. */
void camber_document_end(camber_document *d);

/* Whether this is the first time, and then it counts as said. */
bool camber_document_first_time(camber_document *d, const char *what);
bool camber_document_fail_memory(camber_document *d);
bool camber_document_copy_string(camber_document *d, const json_t *json, char **copy);
/* A string of the object, left NULL where it is missing. */
bool camber_document_read_string(camber_document *d, const json_t *object, const char *key, char **string);
/* A number of the object, left alone where it is missing. */
bool camber_document_read_number(camber_document *d, const json_t *object, const char *key, double low, double high,
                                 double *number);
/* After a failure at this depth of the path: whether the document is read on, as where all its errors are wanted. */
bool camber_document_goes_on(camber_document *d, size_t path_length);
void camber_document_warn_unknown(camber_document *d, const json_t *object, const char *const *known, const char *what);

/* layer.c */
bool camber_document_read_layers(camber_document *d, const json_t *layers);
void camber_style_layer_free(camber_context *context, camber_style_layer *layer);

#endif
