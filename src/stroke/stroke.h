/* Makes the points of parts, and makes them again after they were evicted. */
#ifndef CAMBER_STROKE_STROKE_H
#define CAMBER_STROKE_STROKE_H

#include "residency/mesh.h"

/* cull.c: makes a part's slots from a network (stages cull_count and cull_emit). If they are too many for the device's
 * buffers or for the part's share of memory, sets *fits to false and makes none. */
camber_status camber_part_project(camber_mesh *mesh, camber_mesh_part *part, bool *fits);

/* classify.c: computes the join words of the part's points for a method. */
camber_status camber_part_classify(camber_mesh *mesh, camber_mesh_part *part, camber_method method);
/* Runs a kernel over a part's points, and waits for it. After that nothing reads host arrays that were queued with
 * camber_buffer_write_later. */
camber_status camber_part_run(camber_mesh *mesh, const camber_mesh_part *part, camber_launch launch,
                              camber_stage_id stage);
/* Returns the program with a method's classify, scan and emit. */
camber_status camber_mesh_program(camber_mesh *mesh, camber_method method, camber_program **program);

/* tessellate.c: makes a part again, unless its buffers hold the points or the output that the mesh is drawn from. part
 * points into mesh->parts. Other parts may be evicted. */
camber_status camber_part_ensure_made(camber_mesh *mesh, camber_mesh_part *part);
/* Also makes sure that the part's join words are for the given method. */
camber_status camber_part_ensure_classified(camber_mesh *mesh, camber_mesh_part *part, camber_method method);
/* Also makes sure that the part's join words are for strips, which the rasterizer reads whatever the method. */
camber_status camber_part_ensure_points(camber_mesh *mesh, camber_mesh_part *part);
/* Fails because a part that was made again has another size than before. */
camber_status camber_part_fail_remade(const camber_mesh *mesh, const camber_mesh_part *part, size_t slots,
                                      size_t records);

/* read_points.c: a part's points in host memory: the words of its slots, and of a sentinel before and after the slots.
 */
typedef struct camber_part_points {
    float *x, *y;
    uint32_t *info, *joins;
    camber_arc_length *arc_lengths; /* one per slot. NULL: the mesh has none */
} camber_part_points;

/* Makes the part if necessary, and reads its points. camber_part_points_free frees them. */
camber_status camber_part_read_points(camber_mesh *mesh, camber_mesh_part *part, camber_part_points *points);
void camber_part_points_free(camber_context *context, camber_part_points *points);

#endif
