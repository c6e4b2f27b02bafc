/* The joins of a mesh, found only from its triangles and classified with independent arithmetic, to count whether
 * neighbouring segments draw a pixel twice. */
#ifndef CAMBER_VALIDATE_MESH_JOINS_H
#define CAMBER_VALIDATE_MESH_JOINS_H

#include "camber_proof.h"

typedef enum camber_join_room {
    CAMBER_JOIN_PLAIN = 0, /* both segments have room to be cut along the bisector */
    CAMBER_JOIN_TIGHT,     /* (half the width + pad) tan(turn / 2) reaches half the shorter segment */
    CAMBER_JOIN_SPLIT,     /* the turn exceeds 127 degrees (tan(turn / 2) = 2), and the join is not a miter */
    CAMBER_JOIN_ROOMS
} camber_join_room;

const char *camber_join_room_name(camber_join_room room);

typedef struct camber_found_join {
    camber_index_range range; /* of the mesh: only the triangles of the two segments that meet */
    camber_join_room room;
    float x, y;      /* where the segments meet, px */
    double turn_deg; /* 0 to 180 */
    uint32_t row;
    /* The seam of a ring: its first segment is elsewhere in the mesh, and the range contains only the triangles of the
     * join. */
    bool seam;
} camber_found_join;

typedef struct camber_mesh_joins {
    camber_found_join *items; /* count of them, in the order of the mesh; free with camber_mesh_joins_free */
    size_t count;
} camber_mesh_joins;

/* strokes: those with which the mesh was tessellated. A join whose room equals its bound up to a relative error of 1e-5
 * counts as tight. Seams are found if they have triangles, as in kite and fan. Returns false if memory is exhausted.
 * Cost: about 10 ns per triangle. */
bool camber_mesh_joins_find(const camber_mesh_data *mesh, const camber_stroke *strokes, camber_mesh_joins *joins);
void camber_mesh_joins_free(camber_mesh_joins *joins);

#endif
