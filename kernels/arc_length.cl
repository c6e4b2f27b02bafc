/* The program that measures lines: how far along its line each slot is. */
#include "arc_length_sum.cl"

#include "arc_length_scan.cl"
