/* Counts the draw calls of a mesh if indices have 16 bits, as in older GL and WebGL renderers. */
#ifndef CAMBER_VALIDATE_BATCHES_H
#define CAMBER_VALIDATE_BATCHES_H

#include "camber_proof.h"

/* How many vertices an index of 16 bits can address, apart from the restart index. */
#define CAMBER_BATCH_VERTICES 65535u

/* Counts the batches of a mesh; 0 if it has no triangles. Triangles are taken in order. A triangle joins the current
 * batch if all vertices of the batch are then within vertices_max consecutive vertices of the mesh, which a base vertex
 * shifts to 0; otherwise it starts a new batch. A strip may be cut between any two triangles. vertices_max: 3 or more;
 * a triangle that spans more vertices is a batch by itself. */
size_t camber_batches_count(const camber_mesh_data *mesh, uint32_t vertices_max);

#endif
