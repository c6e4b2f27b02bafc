/* The program that makes offset lines. */
#include "offset_clip.cl"

#include "offset_count.cl"

#include "offset_emit.cl"
