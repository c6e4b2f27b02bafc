/* A style document while it is read. Only document.c, layer.c and check.c include this. */
#ifndef CAMBER_STYLE_DOCUMENT_H
#define CAMBER_STYLE_DOCUMENT_H

#include "style/properties.h"

/* The most warnings of one document; then it says so once and warns no more. */
enum { CAMBER_WARNING_LIMIT = 32 };

typedef struct camber_document {
    camber_compiler compiler;
    json_t *root;
    const char *warned[CAMBER_WARNING_LIMIT]; /* names that were warned of; the strings are the document's */
    size_t warned_count;
    json_t *by_id;          /* layers by id, which others may refer to */
    json_t *source_indices; /* by name */
    bool reads_on;          /* reads on past errors, since all of them are wanted */
} camber_document;

/* Reads the bytes into the compiler's style, which is empty; the root stays. Returns the compiler's status; where it
 * reads past errors, CAMBER_OK whatever is wrong. */
camber_status camber_document_read(camber_document *d, const char *json, size_t size_bytes);
/* Frees what reading needed; the style stays. */
void camber_document_end(camber_document *d);

/* Whether the name comes for the first time; from now on it counts as warned of. */
bool camber_document_first_time(camber_document *d, const char *what);
bool camber_document_fail_memory(camber_document *d);
bool camber_document_copy_string(camber_document *d, const json_t *json, char **copy);
/* Reads a string of the object; NULL where it is missing. */
bool camber_document_read_string(camber_document *d, const json_t *object, const char *key, char **string);
/* Reads a number of the object; unchanged where it is missing. */
bool camber_document_read_number(camber_document *d, const json_t *object, const char *key, double low, double high,
                                 double *number);
/* Whether reading continues after a failure at this depth of the path, as where all errors are wanted. */
bool camber_document_goes_on(camber_document *d, size_t path_length);
void camber_document_warn_unknown(camber_document *d, const json_t *object, const char *const *known, const char *what);

/* layer.c */
bool camber_document_read_layers(camber_document *d, const json_t *layers);
/* false: layers of this type are not drawn. */
bool camber_layer_kind_find(const char *type, camber_layer_kind *kind);
void camber_style_layer_free(camber_context *context, camber_style_layer *layer);

#endif
