/* The joins of polylines by how much they turn: what a network is made of, whatever draws it. */
#ifndef CAMBER_VALIDATE_TURN_CLASSES_H
#define CAMBER_VALIDATE_TURN_CLASSES_H

#include "camber_files.h"

#define CAMBER_TURN_CLASSES 6
#define CAMBER_TURN_CLASS_DEG 30

/* Adds each join to counts[turn / 30 degrees]; 180 degrees goes to the last. Points that camber_polylines_create drops
 * are dropped here too, and keep_open is its: so the sum is camber_mesh_info's joins. */
void camber_turns_count(const camber_lines *lines, bool keep_open, size_t counts[CAMBER_TURN_CLASSES]);

#endif
