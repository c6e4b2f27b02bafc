/* Mixes two colours: in sRGB, in CIELAB, or in LCh, the cylindrical form of CIELAB, which the specification calls hcl.
 */
#include "style/spaces.h"

#include <math.h>

/* CIELAB with the white point D50, and LCh. sRGB's primaries are adapted to D50 by Bradford's method. Lightness is 0 to
 * 100. */
typedef struct lab {
    double l, a, b;
} lab;

typedef struct hcl {
    double h, c, l; /* h in degrees; NAN for a grey, which has no hue */
} hcl;

static const double white_x = 0.96422, white_z = 0.82521;
static const double epsilon = 6.0 / 29.0;
static const double degree = 3.14159265358979323846 / 180.0;

static double to_linear(double channel) {
    return channel <= 0.04045 ? channel / 12.92 : pow((channel + 0.055) / 1.055, 2.4);
}

static float from_linear(double light) {
    const double channel = light <= 0.00304 ? 12.92 * light : 1.055 * pow(light, 1.0 / 2.4) - 0.055;
    return channel > 0.0 ? channel < 1.0 ? (float)channel : 1.0f : 0.0f;
}

static double to_lightness(double t) {
    return t > epsilon * epsilon * epsilon ? cbrt(t) : t / (3.0 * epsilon * epsilon) + 4.0 / 29.0;
}

static double from_lightness(double t) {
    return t > epsilon ? t * t * t : 3.0 * epsilon * epsilon * (t - 4.0 / 29.0);
}

static lab to_lab(camber_color color) {
    const double r = to_linear((double)color.r), g = to_linear((double)color.g), b = to_linear((double)color.b);
    const double y = to_lightness(0.2225045 * r + 0.7168786 * g + 0.0606169 * b);
    double x = y, z = y;
    /* A grey has no hue, even if rounding of the matrix products says otherwise. */
    if (color.r < color.g || color.r > color.g || color.g < color.b || color.g > color.b) {
        x = to_lightness((0.4360747 * r + 0.3850649 * g + 0.1430804 * b) / white_x);
        z = to_lightness((0.0139322 * r + 0.0971045 * g + 0.7141733 * b) / white_z);
    }
    return (lab){fmax(116.0 * y - 16.0, 0.0), 500.0 * (x - y), 200.0 * (y - z)};
}

static camber_color from_lab(lab from) {
    const double level = (from.l + 16.0) / 116.0;
    const double x = white_x * from_lightness(level + from.a / 500.0), y = from_lightness(level);
    const double z = white_z * from_lightness(level - from.b / 200.0);
    return (camber_color){.r = from_linear(3.1338561 * x - 1.6168667 * y - 0.4906146 * z),
                          .g = from_linear(-0.9787684 * x + 1.9161415 * y + 0.0334540 * z),
                          .b = from_linear(0.0719453 * x - 0.2289914 * y + 1.4052427 * z)};
}

static hcl to_hcl(camber_color color) {
    const lab from = to_lab(color);
    const double c = sqrt(from.a * from.a + from.b * from.b);
    double h = NAN;
    if (c >= 5e-5) {
        h = atan2(from.b, from.a) / degree;
        h = h < 0.0 ? h + 360.0 : h;
    }
    return (hcl){h, c, from.l};
}

static double mix_channel(double a, double b, double t) {
    return a + t * (b - a);
}

/* Mixes hues along the shorter arc. A grey takes the other colour's hue, and black also takes its chroma. */
static camber_color mix_hcl(camber_color low, camber_color high, double t) {
    const hcl a = to_hcl(low), b = to_hcl(high);
    double h = isnan(a.h) ? b.h : a.h, c = mix_channel(a.c, b.c, t);
    if (!isnan(a.h) && !isnan(b.h)) {
        const double turn = b.h - a.h;
        h = a.h + t * (turn > 180.0 ? turn - 360.0 : turn < -180.0 ? turn + 360.0 : turn);
    } else if (!isnan(a.h) && !(b.l > 0.0)) {
        c = a.c;
    } else if (!isnan(b.h) && !(a.l > 0.0)) {
        c = b.c;
    }
    h = isnan(h) ? 0.0 : h * degree;
    return from_lab((lab){mix_channel(a.l, b.l, t), cos(h) * c, sin(h) * c});
}

camber_color camber_color_mix(camber_color a, camber_color b, double t, camber_color_space space) {
    camber_color made;
    if (space == CAMBER_SPACE_HCL) {
        made = mix_hcl(a, b, t);
    } else if (space == CAMBER_SPACE_LAB) {
        const lab low = to_lab(a), high = to_lab(b);
        made = from_lab(
            (lab){mix_channel(low.l, high.l, t), mix_channel(low.a, high.a, t), mix_channel(low.b, high.b, t)});
    } else {
        /* Mixes straight components, not premultiplied ones, as the specification's own tests do. */
        made.r = (float)mix_channel((double)a.r, (double)b.r, t);
        made.g = (float)mix_channel((double)a.g, (double)b.g, t);
        made.b = (float)mix_channel((double)a.b, (double)b.b, t);
    }
    made.a = (float)mix_channel((double)a.a, (double)b.a, t);
    return made;
}
