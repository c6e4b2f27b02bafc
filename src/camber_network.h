/* Networks: polylines in world coordinates that stay on the device while a camera moves over them.
 *
 * The rules of camber.h apply here too. */
#ifndef CAMBER_NETWORK_H
#define CAMBER_NETWORK_H

#include "camber.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Computes how important each point of a set of polylines is, for camber_network_desc.importance. importance[i] is the
 * largest tolerance, in the points' unit, that keeps point i: a tolerance T keeps the points whose importance is T or
 * more, and T = 0 keeps all. A polyline's ends have INFINITY. A ring (first point == last point) keeps its seam, and
 * three distinct points if it has an area.
 *
 * Without shared nodes a tolerance T keeps the points that the Douglas-Peucker method keeps: the original is within T
 * of the simplified polyline, and vice versa. A node is a set of points whose coordinates are equal, bit for bit. All
 * of them get the largest of their importances, so that a node is kept everywhere or nowhere. Points kept for that
 * reason can raise the distance to 2 T.
 *
 * points are pairs of coordinates, which should be finite. Polyline i has the points [offsets[i], offsets[i + 1]), so
 * offsets has polyline_count + 1 entries. They ascend, and are indices into points and importance, whose entries before
 * the first offset are left alone.
 * Returns CAMBER_ERROR_INPUT (offsets that do not ascend), CAMBER_ERROR_LIMIT (2^31 points or more),
 * CAMBER_ERROR_MEMORY.
 * Cost: O(n log n), in the worst case too. */
CAMBER_API camber_status camber_importance_weigh(camber_context *context, const double *points, const size_t *offsets,
                                                 size_t polyline_count, float *importance);

/* One drawing of a polyline of a network. Entries are in drawing order. */
typedef struct camber_network_entry {
    uint32_t polyline;
    uint32_t row;   /* an index into the strokes, below 2^24 */
    double shift_x; /* added to each x: for another copy of a world that repeats */
    /* The polyline is a ring that will be filled. Its inside stays correct even if the camera's window cuts the ring. A
     * ring with an invalid point is left out. */
    bool is_area;
    bool is_dots; /* each point of the polyline is a separate dot, and none is left out */
} camber_network_entry;

typedef struct camber_network_desc {
    const double *points;  /* pairs of x, y in any plane, y down, in world units */
    const size_t *offsets; /* polyline i has the points [offsets[i], offsets[i + 1]) */
    size_t polyline_count;
    /* For each point the largest tolerance, in world units, at which it is kept (camber_camera.simplify_px), as
     * camber_importance_weigh computes it. The ends of a polyline are always kept. NULL: unknown, so that cameras
     * cannot simplify. */
    const float *importance;
    const camber_network_entry *entries; /* entry_count of them. NULL: each polyline once, with row 0 */
    size_t entry_count;
    bool keep_open; /* as in camber_polylines_desc */
    /* each point stores how far along its polyline it is, for meshes with arc lengths: 4 more bytes per point */
    bool has_arc_length;
    /* With has_arc_length: two numbers per polyline, for polylines that are parts of longer lines. A polyline extends
     * from the first fraction of the longer line's length to the second, and its arc lengths are measured along the
     * longer line. NULL: 0 and 1 for all. */
    const float *progress;
    /* Points of less importance than this are not stored, for callers whose cameras would leave them out in any case.
     * Ends are kept, and arc lengths and the bounding box are as if no point were left out. 0: all are stored. */
    float least_importance;
    /* Points are rounded to multiples of this step, in world units, or of 2, 4, ... times the step if their bounding
     * box is too large for it. So networks of different parts of a map round points alike. 0: the finest step that the
     * box allows. */
    double step;
} camber_network_desc;

/* Polylines in world coordinates, kept on the device from frame to frame. In a mesh of a network, and in its passes,
 * the polylines are the network's entries. Coordinates are rounded to 2^31 steps over the longer side of the bounding
 * box of all points (0.02 mm for a city of 50 km, 2 cm for the planet), or to a step that the caller chooses. */
typedef struct camber_network camber_network;

/* Makes a network from polylines, and cleans them as camber_polylines_create does. Points that are not finite split
 * their polyline. Points that round to the same step as the previous one are dropped. A polyline that returns to its
 * first point is a ring.
 * Returns CAMBER_ERROR_INPUT (offsets that do not ascend, an entry without a polyline, a row of 2^24 or more),
 * CAMBER_ERROR_LIMIT (2^31 points or more), CAMBER_ERROR_MEMORY.
 * Cost: one pass over the points. The network takes 12 bytes per stored point and 24 per polyline. A device that uses
 * the host's memory borrows these arrays (zero copy). */
CAMBER_API camber_status camber_network_create(camber_context *context, const camber_network_desc *desc,
                                               camber_network **network);
/* Frees the network. A mesh that holds it keeps the data that it needs. */
CAMBER_API void camber_network_destroy(camber_network *network);
/* Returns counts over the entries. kept_points includes points that a camera may still leave out. */
CAMBER_API camber_polylines_stats camber_network_get_stats(const camber_network *network);

/* A view of a network. */
typedef struct camber_camera {
    double x, y;            /* the picture's centre, world units */
    double scale_px;        /* px per world unit, above 0 */
    double bearing_deg;     /* clockwise: the direction that is up in the picture */
    uint32_t width, height; /* size of the picture, px */
    /* The simplification tolerance, 0 or more px: points whose camber_network_desc.importance is smaller are left out,
     * so a network that is simplified must have it. 0: no points are left out. */
    double simplify_px;
    /* The largest distance by which any paint of the mesh will translate lines, 0 or more px
     * (camber_paint.translate_x_px). Lines that such a translation moves into the picture are then kept as well. */
    double translate_px;
    double pitch_deg; /* 0 to 85. The mesh remembers it, and frames that draw the mesh use it */
} camber_camera;

/* Tessellates the lines of a network that the camera sees, and replaces the mesh's earlier content. The device projects
 * the lines, simplifies and compacts them; the host learns only the sizes. Polylines end where they leave a window
 * around the picture, which is larger than any stroke reaches, by at least 64 px, so that no caps show. They end with
 * whole segments; only those longer than 1,536 px are divided, so no vertices are far away. With a pitch they are cut.
 * The mesh keeps the network on the device: another call uploads nothing. The same camera gives the same bytes.
 * Returns the errors of camber_mesh_tessellate, and CAMBER_ERROR_ARGUMENT (a camera that is not finite, a scale or a
 * size of 0, a size above 65535, a scale at which a step is more than 10^9 px, or a tolerance above 0 for a network
 * without importance).
 * network may be from another context than the mesh, but all networks of one mesh must be from the same context,
 * because the mesh identifies them by the numbers that the context gives them. One thread must own both contexts during
 * the call.
 * Cost: linear in the points of the polylines whose bounding boxes are seen. */
CAMBER_API camber_status camber_mesh_tessellate_network(camber_mesh *mesh, camber_network *network,
                                                        const camber_camera *camera,
                                                        const camber_tessellation_desc *desc);
/* Returns whether the mesh holds this network from its last tessellation. */
CAMBER_API bool camber_mesh_holds_network(const camber_mesh *mesh, const camber_network *network);

#ifdef __cplusplus
}
#endif

#endif
