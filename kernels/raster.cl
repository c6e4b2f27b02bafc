/* The rasterizer's program: all kernels from setup to rasterize. CAMBER_LANES chooses those for CPUs (16) or GPUs (1).
 */
#include "setup.cl"

#include "setup_gpu.cl"

#include "bin_count.cl"

#include "bin_scan.cl"

#include "bin_scatter.cl"

#include "bin_gpu.cl"

#include "rasterize.cl"

#include "rasterize_gpu.cl"
