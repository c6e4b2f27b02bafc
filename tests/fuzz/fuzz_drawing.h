/* A device's pictures of a mesh, against the twin's. */
#ifndef CAMBER_TESTS_FUZZ_FUZZ_DRAWING_H
#define CAMBER_TESTS_FUZZ_FUZZ_DRAWING_H

#include "fuzz.h"

/* A device and what draws with it. It has threads and a compiler, and takes longer than all the rest: a target that
 * replays has one, and one that fuzzes where CAMBER_FUZZ_DEVICE is set. */
typedef struct fuzz_drawer {
    camber_context *context;
    camber_renderer *renderer;
    camber_mesh *mesh; /* NULL: there is no device */
} fuzz_drawer;

void fuzz_drawer_open(fuzz_drawer *drawer);
/* Draws the mesh with lines over each other, united, and in a group: the same segments, lists and pixels as the twin's.
 * A mesh that has a camera brings its pitch along; others are drawn with a pitch as well. */
void fuzz_drawer_draw(const fuzz_drawer *drawer, const camber_stroke *strokes, size_t stroke_count, bool has_camera);

#endif
