/* The program that turns slots into records and indices, built once per method. */
#include "classify.cl"

#include "scan.cl"

#include "emit.cl"
