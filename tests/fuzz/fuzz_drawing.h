/* What a device draws of a mesh, against the twin. */
#ifndef CAMBER_TESTS_FUZZ_FUZZ_DRAWING_H
#define CAMBER_TESTS_FUZZ_FUZZ_DRAWING_H

#include "fuzz.h"

/* A device and what draws with it. It has threads and a compiler, and takes longer than all the rest: a target that
 * replays has one, and one that fuzzes where CAMBER_FUZZ_DEVICE is set. */
typedef struct fuzz_easel {
    camber_context *context;
    camber_renderer *renderer;
    camber_mesh *mesh; /* NULL: there is no device */
} fuzz_easel;

void fuzz_easel_open(fuzz_easel *easel);
/* Draws the mesh with lines over each other, united, and in a group: the same shapes, lists and pixels as the twin's.
 */
void fuzz_easel_draw(const fuzz_easel *easel, const camber_stroke *strokes, size_t stroke_count);

#endif
