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
    /* The polyline is a ring, to be filled: what it winds around stays so where a camera cuts the ring. A ring with an
     * invalid point is left out. */
    bool is_area;
    bool is_dots; /* each point of the polyline is a dot by itself, and none is left out */
} camber_network_entry;

typedef struct camber_network_desc {
    const double *points;  /* pairs of x, y in any plane, y down: world units */
    const size_t *offsets; /* polyline i has the points [offsets[i], offsets[i + 1]) */
    size_t polyline_count;
    /* For each point the largest tolerance, in world units, that keeps it (camber_camera.simplify_px). The ends of a
     * polyline always stay. NULL: all points stay. */
    const float *importance;
    const camber_network_entry *entries; /* entry_count. NULL: each polyline once, with row 0 */
    size_t entry_count;
    bool keep_open;      /* as in camber_polylines_desc */
    bool has_arc_length; /* points know how far along their polyline they lie, for meshes with arc lengths. It takes 4
                            bytes a point */
    /* With has_arc_length, two numbers for each polyline. They say that it is a part of a longer line, from the first
     * share of that line's length to the second; its arc lengths are those of the longer line. NULL: 0 and 1 for all.
     */
    const float *progress;
    /* Points of less importance than this are not stored, for cameras that would leave them out in any case. Ends stay,
     * and arc lengths and the box of all points are as if no point were left out. 0: all are stored. */
    float least_importance;
    /* Points are rounded to multiples of this, world units; where their box is too large for it, to twice as much, or 4
     * times and so on. So networks of parts of a map round its points alike. 0: as fine as the box allows. */
    double step;
} camber_network_desc;

/* Polylines in world coordinates, kept on the device from frame to frame. The polylines of a mesh of a network, and of
 * its passes, are the network's entries. Coordinates are rounded to 2^31 steps over the longer side of the box of all
 * points: 0.02 mm for a city of 50 km, 2 cm for the planet; or to steps that the caller chooses. */
typedef struct camber_network camber_network;

/* Makes a network of polylines, and cleans them as camber_polylines_create does. Points that are not finite split their
 * polyline. Points that lie on the same step as the one before are dropped. A polyline that comes back to its first
 * point is a ring.
 * Returns CAMBER_ERROR_INPUT (offsets that do not ascend, an entry of no polyline, a row of 2^24 or more),
 * CAMBER_ERROR_LIMIT (2^31 points or more), CAMBER_ERROR_MEMORY.
 * It takes one pass over the points, and keeps 12 bytes a stored point and 24 a polyline. A device that works in host
 * memory shares them. */
CAMBER_API camber_status camber_network_create(camber_context *context, const camber_network_desc *desc,
                                               camber_network **network);
/* Frees the network. A mesh that holds it keeps the parts that it needs. */
CAMBER_API void camber_network_destroy(camber_network *network);
/* Returns counts over the entries. kept_points counts those that a camera may still leave out. */
CAMBER_API camber_polylines_stats camber_network_get_stats(const camber_network *network);

/* How a network is seen. */
typedef struct camber_camera {
    double x, y;            /* the picture's centre, world units */
    double scale_px;        /* px a world unit, above 0 */
    double bearing_deg;     /* clockwise: the direction that is up in the picture */
    uint32_t width, height; /* of the picture, px */
    /* Points are left out that camber_network_desc.importance keeps only for smaller tolerances than this, 0 or more
     * px. 0: none are. */
    double simplify_px;
    /* The farthest that any paint of the mesh will translate lines, 0 or more px (camber_paint.translate_x_px). Lines
     * that come into the picture so are then kept as well. */
    double translate_px;
    double pitch_deg; /* 0 to 85. The mesh remembers it, and a frame that draws the mesh is seen with it */
} camber_camera;

/* Tessellates the lines of a network that the camera sees, and replaces what the mesh held. The device projects the
 * lines, leaves points out, cuts and compacts; the host learns only the sizes.
 * Polylines are cut where they leave a window around the picture. It lies farther out than any stroke reaches, by 64 px
 * at least, so that no caps show and no vertices lie far away. The mesh keeps the network on the device: another call
 * uploads nothing. The same camera gives the same bytes.
 * Returns what camber_mesh_tessellate does, and CAMBER_ERROR_ARGUMENT for a camera that is not finite, a scale or a
 * size of 0, a size above 65535, or a scale that makes more than 10^9 px of a step.
 * network may be of another context than the mesh, but all networks of one mesh are of the same one, by whose numbers
 * it knows them. One thread has both meanwhile. The cost is linear in the points of the polylines whose boxes are seen.
 */
CAMBER_API camber_status camber_mesh_tessellate_network(camber_mesh *mesh, camber_network *network,
                                                        const camber_camera *camera,
                                                        const camber_tessellation_desc *desc);
/* Returns whether the mesh's last tessellation was of this network. */
CAMBER_API bool camber_mesh_holds_network(const camber_mesh *mesh, const camber_network *network);

#ifdef __cplusplus
}
#endif

#endif
