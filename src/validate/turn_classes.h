/* Counts the joins of polylines by their turns: a property of the network, whatever draws it. */
#ifndef CAMBER_VALIDATE_TURN_CLASSES_H
#define CAMBER_VALIDATE_TURN_CLASSES_H

#include "camber_files.h"

#define CAMBER_TURN_CLASSES 6
#define CAMBER_TURN_CLASS_DEG 30

/* Adds each join to counts[turn / 30 degrees]; 180 degrees counts in the last class. Points that
 * camber_polylines_create drops are also dropped here, and keep_open has the same meaning, so the sum equals the joins
 * of camber_mesh_info. */
void camber_turns_count(const camber_lines *lines, bool keep_open, size_t counts[CAMBER_TURN_CLASSES]);

#endif
