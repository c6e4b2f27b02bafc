/* Clusters: glyphs that belong to the same characters, and are turned together if a text follows a line. */
#ifndef CAMBER_TEXT_CLUSTERS_H
#define CAMBER_TEXT_CLUSTERS_H

#include "camber_text.h"

/* Returns where the middle of the cluster that begins with glyph first is along its line of text, in em, without the
 * spacing after it. *end is the cluster's end. */
double camber_text_cluster_middle(const camber_text *text, size_t first, size_t *end);

#endif
