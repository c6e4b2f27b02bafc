/* Says what tiles are made of, in words that parts of one run share. */
#ifndef CAMBER_TILES_FINGERPRINT_H
#define CAMBER_TILES_FINGERPRINT_H

#include "tiles/area.h"
#include "tiles/engine.h"

enum { CAMBER_FINGERPRINT_SIZE = 192 };

/* Hashes all features, which takes a pass over the points, and finds their box. */
uint64_t camber_features_hash(const camber_features *features, camber_box *box);
/* Writes input=, style=, options=, area= and version=, each but the last a hash. */
void camber_fingerprint_write(const camber_tiles_engine *engine, const camber_tiles_draw_desc *desc,
                              const camber_tiles_area *area, uint64_t input, char text[CAMBER_FINGERPRINT_SIZE]);
/* Writes the fingerprint that `there` becomes once tiles of `now` are renewed in it: its own, but for the input. false:
 * the two differ in more than the input and the area; names has what. */
bool camber_fingerprint_renew(const char *there, const char *now, char text[CAMBER_FINGERPRINT_SIZE], char *names,
                              size_t names_size);

#endif
