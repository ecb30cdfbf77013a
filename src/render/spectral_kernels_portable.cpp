#define PYROSCENE_KERNELS portable_spectral_kernels
#include "render/spectral_kernels.inc"
