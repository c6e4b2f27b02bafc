/* The program that extracts from a network what a camera sees. */
#include "cull_count.cl"

#include "cull_emit.cl"
