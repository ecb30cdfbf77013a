#define PYROSCENE_KERNELS avx2_spectral_kernels
#include "render/spectral_kernels.inc"
