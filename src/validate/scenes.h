/* Made-up scenes: polylines for tests, for the checks of validate and for the benchmark. They are the same on every
 * machine, so that pictures, figures and bounds can be compared. */
#ifndef CAMBER_VALIDATE_SCENES_H
#define CAMBER_VALIDATE_SCENES_H

#include "camber_files.h"

/* Valid when zeroed. Free it with camber_made_scene_free. */
typedef struct camber_made_scene {
    const char *name; /* if it is a checked scene */
    float *points;    /* pairs */
    size_t point_count, point_capacity;
    uint32_t *offsets; /* polyline_count + 1 of them */
    uint32_t *rows;
    size_t polyline_count, polyline_capacity;
    bool failed; /* memory is exhausted, and points have been lost */
} camber_made_scene;

/* ---- Building ---- */

void camber_made_scene_point(camber_made_scene *scene, double x, double y);
/* Makes a polyline from the points that were added since the previous polyline ended. */
void camber_made_scene_end(camber_made_scene *scene, size_t row);
/* Adds count points, starting anywhere in a square of 1000 px. Each step has a random length from step[0] to step[1]
 * px, and turns by at most turn radians. */
void camber_made_scene_walk(camber_made_scene *scene, uint64_t *seed, size_t count, const double step[2], double turn);
/* Describes the whole scene as polylines; rings are closed. */
camber_polylines_desc camber_made_scene_polylines(const camber_made_scene *scene);
void camber_made_scene_free(camber_made_scene *scene);

/* ---- Checked scenes: what `camber validate` draws without an input ---- */

#define CAMBER_SCENE_ROWS 5
#define CAMBER_SCENE_WIDTH_ROW 2 /* the row that is drawn CAMBER_SCENE_WIDTH_PX wide */
#define CAMBER_SCENE_WIDTH_PX 8
#define CAMBER_SCENE_DRAWN_ONCE "smooth rings" /* the scene in which no line draws a pixel twice */
#define CAMBER_SCENE_SIDE_PX 1024              /* size of the picture for which most scenes are made */

size_t camber_checked_scene_count(void);
/* Makes scene number `number`, less than camber_checked_scene_count. Returns false if memory is exhausted. */
bool camber_checked_scene_make(size_t number, camber_made_scene *scene);

/* ---- Kernel scenes, which tests compare with the CPU twin ---- */

#define CAMBER_KERNEL_SCENES 6
#define CAMBER_KERNEL_ROWS 9

/* Makes scene number `number`, less than CAMBER_KERNEL_SCENES. Returns false if memory is exhausted. */
bool camber_kernel_scene_make(size_t number, camber_made_scene *scene);

/* Builders of single scenes, which are added to the existing points. */
typedef void camber_scene_builder(camber_made_scene *scene, uint64_t *seed);
camber_scene_builder camber_scene_add_walks;
/* Polylines that end at, before and after the borders of blocks, and one line over many blocks. */
camber_scene_builder camber_scene_add_blocks;
camber_scene_builder camber_scene_add_rings;
/* Turns of every whole degree, with long and short neighbours; reversals; zigzags shorter than their width. */
camber_scene_builder camber_scene_add_turns;
/* Dots, empty polylines, repeated and invalid points, rings of two segments. */
camber_scene_builder camber_scene_add_degenerate;
/* Coordinates from the smallest float to the largest that is kept. */
camber_scene_builder camber_scene_add_sizes;

/* Makes a scene of about 2,000 points for a simulator: polylines that end before, at and after the borders of blocks of
 * 64, 128 and 256 points, rings, stars, dots, reversals. Returns false if memory is exhausted. */
bool camber_small_scene_make(camber_made_scene *scene);

/* ---- Benchmark ---- */

/* Makes random walks that turn like roads, in a square of side_px. Returns false if memory is exhausted. */
bool camber_road_walks_make(size_t polyline_count, double side_px, double step_px, camber_made_scene *scene);

#endif
