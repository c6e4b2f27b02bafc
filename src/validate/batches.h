/* How many draw calls a mesh takes where an index has 16 bits, as in older GL and WebGL renderers. */
#ifndef CAMBER_VALIDATE_BATCHES_H
#define CAMBER_VALIDATE_BATCHES_H

#include "camber_proof.h"

/* So many vertices an index of 16 bits reaches beside the restart index. */
#define CAMBER_BATCH_VERTICES 65535u

/* Triangles in their order, each into the batch under way as long as all of its vertices lie within vertices_max
 * consecutive ones of the mesh, which a base vertex moves to 0; else into a new one. A strip is cut between any two of
 * its triangles. 0 for a mesh without triangles. vertices_max: 3 or more; a triangle that spans more is a batch. */
size_t camber_batches_count(const camber_mesh_data *mesh, uint32_t vertices_max);

#endif
