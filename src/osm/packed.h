/* Ways with the places of their nodes, packed to about five bytes per point until there is memory for the lines. */
#ifndef CAMBER_OSM_PACKED_H
#define CAMBER_OSM_PACKED_H

#include "osm/ways.h"

typedef struct camber_osm_pack_desc {
    const char *name; /* the file's name, for messages */
    unsigned threads;
    bool drops_areas;
    double from, to; /* the progress before and after this pass */
} camber_osm_pack_desc;

/* Packs the ways after the places of their nodes were read, and frees ids and nodes. Afterwards a way's node_count is
 * the number of its nodes that the file contains, or 0 if it makes no line. The bits in its tags then say whether it is
 * an area, for which it must be closed, and whether it has gaps. *dropped: how many areas were lost. */
camber_status camber_osm_pack(camber_osm_ways *ways, const camber_osm_pack_desc *desc, size_t *dropped);

/* Unpacks the node_count places of a run. */
void camber_osm_unpack_run(const camber_osm_ways *ways, const camber_osm_run *run, uint64_t *places);

#endif
