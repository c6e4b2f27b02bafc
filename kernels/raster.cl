/* The program that draws: segments, lists of tiles, pixels. CAMBER_LANES says whether for a CPU or for a GPU. */
#include "setup.cl"

#include "setup_gpu.cl"

#include "bin_count.cl"

#include "bin_scan.cl"

#include "bin_scatter.cl"

#include "bin_gpu.cl"

#include "rasterize.cl"

#include "rasterize_gpu.cl"
