/* Recognises the schema of vector tiles by their layers, if it is one that the style city supports. */
#ifndef CAMBER_ARCHIVE_TILE_SCHEMA_H
#define CAMBER_ARCHIVE_TILE_SCHEMA_H

#include <jansson.h>

/* layers: the array vector_layers of the metadata, whose objects have an "id" and may have "fields"; NULL: none.
 * Returns the name and version of the schema, or NULL. */
const char *camber_tile_schema_of_layers(const json_t *layers);

#endif
