/* The CPU twin of rasterize for a picture with a pitch: the same source, built like the kernels for it. */
#define CAMBER_STROKE_PITCHED 1
#include "twin_rasterize.c" // NOLINT(bugprone-suspicious-include)
