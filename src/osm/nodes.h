/* The nodes of a file: where those lie that lines need. */
#ifndef CAMBER_OSM_NODES_H
#define CAMBER_OSM_NODES_H

#include "osm/blobs.h"
#include "osm/node_set.h"

typedef struct camber_osm_nodes_desc {
    const camber_osm_file *file;
    size_t blob_count; /* those that may have nodes */
    unsigned threads;
    double from, to; /* of the progress */
} camber_osm_nodes_desc;

/* Finds the first blob that begins with a way or a relation; all blobs before it begin with nodes, if the file is in
 * order. */
camber_status camber_osm_nodes_end(const camber_osm_file *file, size_t *blob, bool *declined);
/* The same for the first that begins with a relation. */
camber_status camber_osm_ways_end(const camber_osm_file *file, size_t *blob, bool *declined);
/* Reads the places of the set's nodes. *declined: a way comes before a node, or a node comes twice. */
camber_status camber_osm_nodes_read(camber_osm_node_set *nodes, const camber_osm_nodes_desc *desc, bool *declined);

#endif
