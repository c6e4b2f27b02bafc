/* Which schema the layers of vector tiles have, as far as the style city knows it. */
#ifndef CAMBER_ARCHIVE_TILE_SCHEMA_H
#define CAMBER_ARCHIVE_TILE_SCHEMA_H

#include <jansson.h>

/* layers: the array vector_layers of the metadata, objects with an "id" and maybe "fields"; NULL: none. Returns the
 * name of the schema and its version, or NULL. */
const char *camber_tile_schema_of_layers(const json_t *layers);

#endif
