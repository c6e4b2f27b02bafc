/* The program that moves lines aside. */
#include "offset_clip.cl"

#include "offset_count.cl"

#include "offset_emit.cl"
