/* What frames have that CAMBER_COVER_RICH draws: strokes of two bands, that fade, are dashed, drawn in part, or change
 * their colour along them. stroke.frag says the same of fragments. */
#ifndef CAMBER_COVER_BANDS_H
#define CAMBER_COVER_BANDS_H

#include "cover.h"

/* Words of a segment's measure: how far along its line A lies, px; how much farther a px along it; the line's length.
 */
#define CAMBER_SHAPE_MEASURES 4

/* What a row has beside its ink, as bits. An ink with none is drawn as one of a plain frame is. */
#define CAMBER_FEATURE_GAP 1u
#define CAMBER_FEATURE_BLUR 2u
#define CAMBER_FEATURE_DASH 4u
#define CAMBER_FEATURE_TRIM 8u
#define CAMBER_FEATURE_RAMP 16u

/* Behind each ink. What it names in the tail is by float4s: dashes are one each, from where to where; stops of ramps
 * two, the place and the premultiplied colour. */
typedef struct camber_ink_more {
    camber_u32 features;
    float half_gap, blur, period; /* px */
    camber_u32 first_dash, dash_count, round_dashes, spare;
    camber_u32 first_stop, stop_count;
    float trim_from, trim_to; /* shares of the line's length */
} camber_ink_more;

/* How much farther along its line a px of a segment lies. */
CAMBER_FN camber_real camber_shape_rate(const camber_shape *s, camber_real from, camber_real to) {
    const camber_real dx = s->bx - s->ax, dy = s->by - s->ay, length = CAMBER_SQRT(dx * dx + dy * dy);
    const camber_real none = CAMBER_REAL(0.0f), one = CAMBER_REAL(1.0f);
    return length > 0.0f ? (to - from) / (length > 0.0f ? length : one) : none;
}

#ifdef __OPENCL_VERSION__
typedef char camber_ink_more_is_whole_vectors[sizeof(camber_ink_more) % 16 == 0 ? 1 : -1];
#else
_Static_assert(sizeof(camber_ink_more) % 16 == 0, "the device reads whole float4s");
#endif

#endif
