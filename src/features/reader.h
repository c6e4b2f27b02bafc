/* The interface of file readers. Each format's file exports one, and formats/readers.c has the table of them. */
#ifndef CAMBER_FEATURES_READER_H
#define CAMBER_FEATURES_READER_H

#include "camber_map.h"

typedef struct camber_reader {
    /* Whether a file is of this reader's format, judged by its name or its first bytes. */
    bool (*knows)(const char *path);
    /* Whether the reader supports the request: its layer and its filter. */
    bool (*reads)(const camber_source_desc *desc);
    /* Reads the file as camber_features_read does. *declined becomes true if the file contains something that this
     * reader leaves to the next one that knows the file. The set is then unchanged, and nothing is logged. */
    camber_status (*read)(camber_features *features, const camber_source_desc *desc, bool *declined);
    /* Fails, with advice, if the next reader would silently skip a part of the file. NULL: it never would. */
    camber_status (*leave)(camber_context *context, const camber_source_desc *desc);
    /* Returns the name of the n-th format, counted from 0, as GDAL spells it, or NULL after the last. */
    const char *(*format)(size_t n);
} camber_reader;

static inline bool camber_reader_takes(const camber_reader *reader, const camber_source_desc *desc) {
    return reader->knows(desc->path) && reader->reads(desc);
}

#endif
