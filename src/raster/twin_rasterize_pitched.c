/* rasterize of the CPU twin for a picture with a pitch: the same text, built as such kernels are. */
#define CAMBER_STROKE_PITCHED 1
#include "twin_rasterize.c" // NOLINT(bugprone-suspicious-include)
