/* Measures clusters of glyphs. */
#include "text/clusters.h"

#include <math.h>

/* How far the middle of a glyph that is upright in a downward line is above its baseline, em. */
static const double UPRIGHT_MIDDLE_EM = 0.38;

double camber_text_cluster_middle(const camber_text *text, size_t first, size_t *end) {
    const camber_text_glyph *g = text->glyphs;
    const double spacing = (double)text->letter_spacing_em;
    double low = INFINITY, high = -INFINITY;
    size_t i = first + 1;
    while (i < text->glyph_count && g[i].run == g[first].run && g[i].byte == g[first].byte)
        i++;
    for (size_t k = first; k < i; k++) {
        double from = (double)(text->vertical ? g[k].y : g[k].x);
        double to = from + fmax((double)g[k].advance - (k + 1 == i ? spacing : 0.0), 0.0);
        if (text->vertical && !g[k].turned && g[k].glyph != CAMBER_NO_GLYPH) {
            from -= (UPRIGHT_MIDDLE_EM + 0.5) * (double)g[k].scale;
            to = from + (double)g[k].scale;
        }
        low = fmin(low, from);
        high = fmax(high, to);
    }
    *end = i;
    return 0.5 * (low + high);
}
