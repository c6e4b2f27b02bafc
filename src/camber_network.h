/* camber: networks, which are polylines that a camera moves over.
 *
 * The rules of camber.h hold here too.
 */
#ifndef CAMBER_NETWORK_H
#define CAMBER_NETWORK_H

#include "camber.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A polyline of a network, in drawing order. */
typedef struct camber_network_entry {
    uint32_t polyline;
    uint32_t row;   /* an index into the strokes, below 2^24 */
    double shift_x; /* added to each x: another copy of a world that repeats itself */
} camber_network_entry;

typedef struct camber_network_desc {
    const double *points;  /* pairs of x, y in any plane, y down: world units */
    const size_t *offsets; /* polyline i has the points [offsets[i], offsets[i + 1]) */
    size_t polyline_count;
    /* By point: the largest tolerance, in world units, that keeps it. The ends of a polyline always stay. NULL: all
     * points do. */
    const float *importance;
    const camber_network_entry *entries; /* entry_count. NULL: each polyline once, with row 0 */
    size_t entry_count;
    bool keep_open;      /* as in camber_polylines_desc */
    bool has_arc_length; /* points know how far along their polyline they lie, for meshes with arc lengths: 4 bytes a
                            point */
    /* Where has_arc_length, pairs by polyline: it is a part of a longer line, from this share of that one's length to
     * this one, and its measures are those of the whole. NULL: 0 and 1 for all. */
    const float *progress;
} camber_network_desc;

/* Polylines in world coordinates, kept on the device from frame to frame. What a mesh and its passes call polyline is
 * an entry here. Coordinates are rounded to 2^31 steps over the longer side of the box of all points: 0.02 mm for a
 * city of 50 km, 2 cm for the planet. */
typedef struct camber_network camber_network;

/* Cleans as camber_polylines_create does: points that are not finite split their polyline, those that repeat the one
 * before to the step go, a polyline that comes back to its first point is a ring.
 * Returns CAMBER_ERROR_INPUT (offsets that do not ascend, an entry of no polyline, a row of 2^24 or more),
 * CAMBER_ERROR_LIMIT (2^31 points or more), CAMBER_ERROR_MEMORY. Cost: one pass; 12 bytes a point and 24 a polyline,
 * which a device that works in host memory shares. */
CAMBER_API camber_status camber_network_create(camber_context *context, const camber_network_desc *desc,
                                               camber_network **network);
/* A mesh that holds the network keeps what it needs of it. */
CAMBER_API void camber_network_destroy(camber_network *network);
/* Counts over the entries. kept_points: before the camera leaves any out. */
CAMBER_API camber_polylines_stats camber_network_get_stats(const camber_network *network);

typedef struct camber_camera {
    double x, y;            /* of the picture's centre, world units */
    double scale_px;        /* px a world unit */
    double bearing_deg;     /* clockwise: the direction that is up in the picture */
    uint32_t width, height; /* of the picture, px */
    double simplify_px;  /* points that matter less than this are left out (camber_network_desc.importance). 0: none */
    double translate_px; /* lines that paints will translate by so much are kept around the picture as well */
    double pitch_deg;    /* 0 to 85: the mesh remembers it, and the frame that draws the mesh is seen with it */
} camber_camera;

/* Tessellates what the camera sees of a network. The device projects, leaves out, cuts and compacts; of this the host
 * learns the sizes. Polylines are cut where they leave a window around the picture that lies farther out than any
 * stroke reaches, by 64 px at least, so that neither caps show there nor vertices lie far away. The mesh keeps the
 * network on the device: another call uploads nothing. The same camera gives the same bytes.
 * Returns what camber_mesh_tessellate does, and CAMBER_ERROR_ARGUMENT for a camera that is not finite, a scale or a
 * size of 0, a size above 65535, a scale that makes more than 10^9 px of a step. Cost: linear in the points of the
 * polylines whose boxes are seen. */
CAMBER_API camber_status camber_mesh_tessellate_network(camber_mesh *mesh, camber_network *network,
                                                        const camber_camera *camera,
                                                        const camber_tessellation_desc *desc);
/* Whether the mesh's last tessellation was of this network. */
CAMBER_API bool camber_mesh_holds_network(const camber_mesh *mesh, const camber_network *network);

#ifdef __cplusplus
}
#endif

#endif
