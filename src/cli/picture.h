/* A frame as a file: PNG or WebP. */
#ifndef CAMBER_CLI_PICTURE_H
#define CAMBER_CLI_PICTURE_H

#include "cli/input.h"

typedef struct camber_picture_times {
    camber_frame_stats frame;
    double write_ms; /* compression and writing */
} camber_picture_times;

/* Writes the scene as a page of vectors. mesh is empty. Returns an exit status; on failure a line has been printed. */
int camber_picture_write_page(camber_input *input, camber_mesh *mesh, camber_output *output,
                              camber_picture_times *times);
/* Draws a frame and writes it in the format that the options select. times may be NULL. Returns an exit status; on
 * failure a line has been printed. */
int camber_picture_write(camber_input *input, camber_mesh *mesh, camber_output *output, camber_picture_times *times);

#endif
