/* Properties of any scene, whatever the style and the features. */
#ifndef CAMBER_TESTS_FUZZ_FUZZ_SCENE_H
#define CAMBER_TESTS_FUZZ_FUZZ_SCENE_H

#include "fuzz.h"

#include "camber_map.h"

/* Rings of areas are closed, and no line. */
void fuzz_check_areas(const camber_features *features);
/* Has the set read all that there is for labels, too. */
void fuzz_want_labels(camber_features *features, camber_style *style);
/* Makes the scene, checks it and tessellates it. */
void fuzz_scene(fuzz_run *run, const camber_features *features, const camber_scene_desc *desc);

#endif
