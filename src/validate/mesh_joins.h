/* The joins of a mesh, found from its triangles alone and judged by arithmetic of their own, so that it can be counted
 * whether neighbouring segments draw a pixel twice. */
#ifndef CAMBER_VALIDATE_MESH_JOINS_H
#define CAMBER_VALIDATE_MESH_JOINS_H

#include "camber_proof.h"

typedef enum camber_join_room {
    CAMBER_JOIN_PLAIN = 0, /* both segments have room to be cut along the bisector */
    CAMBER_JOIN_TIGHT,     /* (half the width + pad) tan(turn / 2) reaches half the shorter segment */
    CAMBER_JOIN_SPLIT,     /* the turn passes 127 degrees, tan(turn / 2) = 2, and is no miter */
    CAMBER_JOIN_ROOMS
} camber_join_room;

const char *camber_join_room_name(camber_join_room room);

typedef struct camber_found_join {
    camber_index_range range; /* of the mesh: the triangles of the two segments that meet, and no others */
    camber_join_room room;
    float x, y;      /* where they meet, px */
    double turn_deg; /* 0 to 180 */
    uint32_t row;
    /* The seam of a ring: its first segment lies elsewhere in the mesh, and the range has only what its join added. */
    bool seam;
} camber_found_join;

typedef struct camber_mesh_joins {
    camber_found_join *items; /* count, in the order of the mesh; free with camber_mesh_joins_free */
    size_t count;
} camber_mesh_joins;

/* strokes: those that the mesh was tessellated with. A join whose room is at its bound to 1e-5 of it counts as tight.
 * Seams are found where they have triangles, in kite and fan. false: out of memory. Cost: some 10 ns a triangle. */
bool camber_mesh_joins_find(const camber_mesh_data *mesh, const camber_stroke *strokes, camber_mesh_joins *joins);
void camber_mesh_joins_free(camber_mesh_joins *joins);

#endif
