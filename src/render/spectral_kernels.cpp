#include "render/spectral_kernels.h"

namespace pyroscene::render {

extern const SpectralKernels portable_spectral_kernels;
#ifdef PYROSCENE_HAS_AVX2_KERNELS
extern const SpectralKernels avx2_spectral_kernels;
#endif

const SpectralKernels& spectral_kernels() noexcept {
#ifdef PYROSCENE_HAS_AVX2_KERNELS
    static const bool has_avx2 = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
    if (has_avx2) return avx2_spectral_kernels;
#endif
    return portable_spectral_kernels;
}

}  // namespace pyroscene::render
