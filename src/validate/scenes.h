/* The built-in scenes of validate: the same on every machine. */
#ifndef CAMBER_VALIDATE_SCENES_H
#define CAMBER_VALIDATE_SCENES_H

#include "camber_proof.h"

#define CAMBER_SCENE_ROWS 5
#define CAMBER_SCENE_WIDTH_ROW 2 /* that is drawn CAMBER_SCENE_WIDTH_PX wide */
#define CAMBER_SCENE_WIDTH_PX 8
#define CAMBER_SCENE_DRAWN_ONCE "smooth rings" /* of which no line draws a pixel twice */
#define CAMBER_SCENE_SIDE_PX 1024              /* of the picture that most scenes are laid out for */

/* Freed with camber_builtin_free. */
typedef struct camber_made_scene {
    const char *name;
    float *points; /* pairs */
    size_t point_count, point_capacity;
    uint32_t *offsets; /* polyline_count + 1 */
    uint32_t *rows;    /* below CAMBER_SCENE_ROWS */
    size_t polyline_count, polyline_capacity;
    uint64_t random; /* state of the generator */
    bool failed;     /* out of memory */
} camber_made_scene;

size_t camber_builtin_count(void);
/* Makes scene number below camber_builtin_count. false: out of memory. */
bool camber_builtin_make(size_t number, camber_made_scene *scene);
void camber_builtin_free(camber_made_scene *scene);

#endif
