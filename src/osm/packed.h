/* Ways with the places of their nodes, packed: five bytes a point or so, until there is room for all of them. */
#ifndef CAMBER_OSM_PACKED_H
#define CAMBER_OSM_PACKED_H

#include "osm/ways.h"

typedef struct camber_osm_pack_desc {
    const char *name; /* the file's, for messages */
    unsigned threads;
    bool drops_areas;
    double from, to; /* of the progress */
} camber_osm_pack_desc;

/* Packs the ways once the places of their nodes are known, and frees ids and nodes. From then on a way's node_count is
 * how many of its nodes the file has, 0 where it makes no line; its tags say that it is an area where it is closed, and
 * whether it has gaps.
 * *dropped: so many areas are gone. */
camber_status camber_osm_pack(camber_osm_ways *ways, const camber_osm_pack_desc *desc, size_t *dropped);

/* Unpacks the places of a run: node_count of them. */
void camber_osm_unpack_run(const camber_osm_ways *ways, const camber_osm_run *run, uint64_t *places);

#endif
