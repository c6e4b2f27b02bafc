/* The rasterizer's program: all kernels from setup to rasterize. */
#include "setup.cl"

#include "bin_count.cl"

#include "bin_scan.cl"

#include "bin_scatter.cl"

#include "bins_gpu.cl"

#include "wind.cl"

#include "rasterize.cl"

#include "rasterize_gpu.cl"
