/* A style document while it is being read. Only document.c, document_read.c, layer.c and check.c include this. */
#ifndef CAMBER_STYLE_DOCUMENT_H
#define CAMBER_STYLE_DOCUMENT_H

#include "style/properties.h"

/* The most warnings about one document. The last one says that further warnings are left out. */
enum { CAMBER_WARNING_LIMIT = 32 };

typedef struct camber_document {
    camber_compiler compiler;
    json_t *root;
    const char *warned[CAMBER_WARNING_LIMIT]; /* names that caused a warning; the strings belong to the document */
    size_t warned_count;
    json_t *by_id;                       /* layers by id, to which others may refer */
    json_t *source_indices;              /* by name */
    size_t left_out[CAMBER_LAYER_KINDS]; /* layers that have an operator that is not supported, by kind */
    bool collects_errors;                /* continues after errors, to report all of them */
} camber_document;

/* Reads the bytes into the compiler's empty style, and keeps the root. Returns the compiler's status, or CAMBER_OK in
 * spite of errors if collects_errors is set. */
camber_status camber_document_read(camber_document *d, const char *json, size_t size_bytes);
/* Frees everything that reading needed, but not the style. */
void camber_document_end(camber_document *d);

/* Whether the name has not caused a warning yet. Records it as warned. */
bool camber_document_first_time(camber_document *d, const char *what);
bool camber_document_fail_memory(camber_document *d);
bool camber_document_copy_string(camber_document *d, const json_t *json, char **copy);
/* Reads a string of the object. If it is missing, *string does not change. */
bool camber_document_read_string(camber_document *d, const json_t *object, const char *key, char **string);
/* Reads a number of the object. If it is missing, *number does not change. */
bool camber_document_read_number(camber_document *d, const json_t *object, const char *key, double low, double high,
                                 double *number);
/* Whether reading continues after a failure, because all errors are collected. If so, resets the path to this length
 * and the status. */
bool camber_document_continues(camber_document *d, size_t path_length);
void camber_document_warn_unknown(camber_document *d, const json_t *object, const char *const *known, const char *what);

/* layer.c */
bool camber_document_read_layers(camber_document *d, const json_t *layers);
/* false: layers of this type are not supported. */
bool camber_layer_kind_find(const char *type, camber_layer_kind *kind);
void camber_style_layer_free(camber_context *context, camber_style_layer *layer);

#endif
