/* A fingerprint identifies what tiles are made from. All parts of a run have the same fingerprint. */
#ifndef CAMBER_TILES_FINGERPRINT_H
#define CAMBER_TILES_FINGERPRINT_H

#include "tiles/area.h"
#include "tiles/engine.h"

enum { CAMBER_FINGERPRINT_SIZE = 192 };

/* Hashes all features, which takes a pass over all points, and finds their bounding box. */
uint64_t camber_features_hash(const camber_features *features, camber_box *box);
/* Writes the words input=, style=, options=, area= and version=. All values but the version are hashes. */
void camber_fingerprint_write(const camber_tiles_engine *engine, const camber_tiles_draw_desc *desc,
                              const camber_tiles_area *area, uint64_t input, char text[CAMBER_FINGERPRINT_SIZE]);
/* Writes the fingerprint that the archive with the fingerprint `there` gets after a run with the fingerprint `now` has
 * replaced some of its tiles: `there` with the new input. Returns false if the two differ in more than the input and
 * the area; names then lists the differences. */
bool camber_fingerprint_renew(const char *there, const char *now, char text[CAMBER_FINGERPRINT_SIZE], char *names,
                              size_t names_size);

#endif
