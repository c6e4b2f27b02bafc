/* How the arguments of a kernel are laid out: one after another, each at a multiple of this. */
#ifndef CAMBER_GPU_CPU_ARGS_H
#define CAMBER_GPU_CPU_ARGS_H

#define CAMBER_CPU_ARG_BYTES 16

#endif
