/* Functions whose results decide where something is drawn. The C library's differ in the last bit between processors:
 * with and without FMA, on x86-64 and on aarch64. These use + - * / sqrt alone, so they give the same bits everywhere,
 * within a unit or two in the last place of what the C library's give. */
#ifndef CAMBER_BASE_MATHS_H
#define CAMBER_BASE_MATHS_H

#include <math.h>

/* Returns the length of a vector whose squares neither overflow nor vanish. */
static inline double camber_length(double x, double y) {
    return sqrt(x * x + y * y);
}

/* Returns 2^x, exactly if x is whole. The series of the exponential function, up to the 15th power, takes the rest. */
static inline double camber_exp2(double x) {
    if (!(fabs(x) < 1000.0))
        return exp2(x);
    const double whole = floor(x + 0.5), rest = (x - whole) * 0.69314718055994530942;
    double sum = 1.0;
    for (int n = 15; n > 0; n--)
        sum = 1.0 + rest / n * sum;
    return ldexp(sum, (int)whole);
}

/* Sets the sine and cosine of an angle of few turns: the series for what is left after quarter turns, up to the 17th
 * power. Pi / 2 is the sum of two numbers, of which the first has 33 bits, so that its product is exact. */
static inline void camber_sine_cosine(double angle, double *sine, double *cosine) {
    if (!(fabs(angle) < 1e5)) {
        *sine = sin(angle), *cosine = cos(angle);
        return;
    }
    const double quarters = floor(angle * 0.63661977236758134308 + 0.5);
    const double rest = (angle - quarters * 1.57079632673412561417) - quarters * 6.07710050650619224932e-11;
    const double w = rest * rest;
    double s = 1.0, c = 1.0;
    for (int n = 16; n > 0; n -= 2) {
        s = 1.0 - w / (n * (n + 1)) * s;
        c = 1.0 - w / (n * (n - 1)) * c;
    }
    s *= rest;
    const int turn = (int)fmod(quarters, 4.0) & 3;
    *sine = turn == 0 ? s : turn == 1 ? c : turn == 2 ? -s : -c;
    *cosine = turn == 0 ? c : turn == 1 ? -s : turn == 2 ? -c : s;
}

/* Turns a direction, given by its sine and cosine. */
static inline void camber_rotate(double angle, double *sine, double *cosine) {
    double s, c;
    camber_sine_cosine(angle, &s, &c);
    const double turned = *cosine * c - *sine * s;
    *sine = *cosine * s + *sine * c;
    *cosine = turned;
}

#endif
