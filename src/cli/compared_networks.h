/* The networks that compare measures: lines of one width in one view, which is fitted to all of them. */
#ifndef CAMBER_CLI_COMPARED_NETWORKS_H
#define CAMBER_CLI_COMPARED_NETWORKS_H

#include "cli/input.h"

typedef struct camber_compared_networks {
    camber_session *session;
    size_t count;
    uint32_t width, height; /* of the picture, px */
    double width_px;        /* of the lines */

    /* Polylines in pixels, simplified if the options say so: one network. */
    camber_input input;
    camber_lines simplified;
    camber_polylines *polylines;

    /* A map. */
    camber_spool copy; /* copy of standard input */
    camber_style *style;
    camber_features **features; /* count of them */
    camber_view_desc view;
    camber_scene *scene; /* of the current network */
    camber_scene_info info;
} camber_compared_networks;

/* A network, ready to be tessellated and compared with the exact coverage. */
typedef struct camber_compared_network {
    const char *name; /* its --where, or the name of the file */
    const camber_polylines *polylines;
    const camber_lines *lines;
    const uint32_t *rows; /* NULL: all 0 */
    const camber_stroke *strokes;
    size_t stroke_count;
    bool keep_open; /* as in camber_polylines_desc */
} camber_compared_network;

/* Reads the files that the options name, once for each --where. Returns an exit status; on failure a line has been
 * printed. The networks must be closed in any case. */
int camber_compared_networks_open(camber_compared_networks *networks, camber_session *session);
void camber_compared_networks_close(camber_compared_networks *networks);

/* Projects network number i, which is valid until the next call. Returns an exit status; on failure a line has been
 * printed. */
int camber_compared_networks_project(camber_compared_networks *networks, size_t i, camber_compared_network *network);

#endif
