/* The nodes of a file: where those lie that lines need. */
#ifndef CAMBER_OSM_NODES_H
#define CAMBER_OSM_NODES_H

#include "osm/blobs.h"
#include "osm/node_set.h"

typedef struct camber_osm_nodes_desc {
    const camber_osm_file *file;
    size_t blob_count; /* those that may have places */
    size_t node_blobs; /* so many, but for the last, have nodes alone; 0: the file is in no order */
    bool relations;    /* these are wanted, wherever they are */
    bool on_ways;      /* ways have places, too */
    unsigned threads;
    double from, to; /* of the progress */
} camber_osm_nodes_desc;

/* Where kinds of entities end, if the file is in order. */
typedef struct camber_osm_ends {
    size_t nodes; /* the first blob that begins with a way or a relation: all before it begin with nodes */
    size_t ways;  /* the first that begins with a relation */
} camber_osm_ends;

/* of_ways: where ways end is wanted, too; else that is 0. */
camber_status camber_osm_find_ends(camber_osm_file *file, bool of_ways, camber_osm_ends *ends, bool *declined);
/* Reads the places of the set's nodes. Of a node that has several the easternmost counts, whatever the order.
 * *declined: nodes do not come first, or one has several places; only a file in order is declined. */
camber_status camber_osm_nodes_read(camber_osm_node_set *nodes, const camber_osm_nodes_desc *desc, bool *declined);

#endif
