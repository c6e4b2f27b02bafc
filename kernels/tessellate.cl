/* The program that turns slots into records and indices, built once a method. */
#include "classify.cl"

#include "scan.cl"

#include "emit.cl"
