/* A record of the labels in each tile of an archive, so that a later run finds the tiles whose labels have changed. */
#ifndef CAMBER_TILES_LABEL_RECORD_H
#define CAMBER_TILES_LABEL_RECORD_H

#include "tiles/engine.h"

typedef struct camber_label_entry {
    uint64_t tile; /* its number in archives */
    uint64_t hash; /* of all labels that touch it */
} camber_label_entry;

typedef struct camber_label_record {
    camber_context *context;
    camber_label_entry *entries; /* by tile, ascending; tiles without labels have none */
    size_t count, capacity;
} camber_label_record;

/* Records the labels of all tiles from one zoom to another. Call camber_label_record_free even after a failure. Returns
 * CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT. */
camber_status camber_label_record_make(camber_tiles_engine *engine, int min_zoom, int max_zoom,
                                       camber_label_record *record);
/* Reads a record. Call camber_label_record_free even after a failure. Returns CAMBER_ERROR_NOT_FOUND,
 * CAMBER_ERROR_INPUT (not a record, or damaged), CAMBER_ERROR_IO, CAMBER_ERROR_MEMORY. */
camber_status camber_label_record_read(camber_context *context, const char *path, camber_label_record *record);
/* Writes a record, replacing an older one, or leaves everything as it is. Returns CAMBER_ERROR_IO. */
camber_status camber_label_record_write(const camber_label_record *record, const char *path);
void camber_label_record_free(camber_label_record *record);
/* Adds the tiles whose labels differ in the two records to the area's list. *added: how many were not in it. Returns
 * CAMBER_ERROR_MEMORY. */
camber_status camber_label_record_add_changed(const camber_label_record *before, const camber_label_record *now,
                                              camber_tiles_area *area, uint64_t *added);

#endif
