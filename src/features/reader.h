/* Readers of files: a format's own file exports one, and formats/readers.c has the table of them. */
#ifndef CAMBER_FEATURES_READER_H
#define CAMBER_FEATURES_READER_H

#include "camber_map.h"

typedef struct camber_reader {
    /* Whether a file is of its format, by its name or its first bytes. */
    bool (*knows)(const char *path);
    /* Whether it reads of such a file what is asked for: the layer, the filter. */
    bool (*reads)(const camber_source_desc *desc);
    /* Reads the file as camber_features_read does. *declined becomes true where the file has what this reader leaves to
     * the next one that knows it; the set is then as before, and nothing is logged. */
    camber_status (*read)(camber_features *features, const camber_source_desc *desc, bool *declined);
    /* Fails, with a cure, where the next reader would pass over something of the file without a word. NULL: it does
     * not. */
    camber_status (*leave)(camber_context *context, const camber_source_desc *desc);
    /* The name of the n-th format, counted from 0, as GDAL has it. NULL: past the last. */
    const char *(*format)(size_t n);
} camber_reader;

static inline bool camber_reader_takes(const camber_reader *reader, const camber_source_desc *desc) {
    return reader->knows(desc->path) && reader->reads(desc);
}

#endif
