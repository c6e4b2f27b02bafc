/* The nodes of a file: reads the places of those that lines need. */
#ifndef CAMBER_OSM_NODES_H
#define CAMBER_OSM_NODES_H

#include "osm/blobs.h"
#include "osm/node_set.h"

typedef struct camber_osm_nodes_desc {
    const camber_osm_file *file;
    size_t blob_count; /* how many blobs, from the first on, may contain places */
    size_t node_blobs; /* all of these blobs but the last have only nodes; 0: the file is not in order */
    bool relations;    /* relations are wanted, wherever they are */
    bool on_ways;      /* ways contain places, too */
    unsigned threads;
    double from, to; /* the progress before and after this pass */
} camber_osm_nodes_desc;

/* Where the kinds of entities end in a file that is in order. */
typedef struct camber_osm_ends {
    size_t nodes; /* the first blob that begins with a way or a relation; all blobs before it begin with nodes */
    size_t ways;  /* the first blob that begins with a relation */
} camber_osm_ends;

/* Finds where nodes end and, if of_ways is set, where ways end; otherwise ends->ways becomes 0. */
camber_status camber_osm_find_ends(camber_osm_file *file, bool of_ways, camber_osm_ends *ends, bool *declined);
/* Reads the places of the set's nodes. If a node has several places, the easternmost counts, whatever their order.
 * *declined: nodes do not come first, or a node has several places; only a file that should be in order is declined. */
camber_status camber_osm_nodes_read(camber_osm_node_set *nodes, const camber_osm_nodes_desc *desc, bool *declined);

#endif
