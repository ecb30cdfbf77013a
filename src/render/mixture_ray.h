#pragma once

#include <vector>

#include "radiometry/flame_table.h"
#include "render/mixture_piece.h"
#include "render/planck_rows.h"
#include "render/spectral_kernels.h"

namespace pyroscene::render {

/// A ray through flame with gas: running sums per species, so that each voxel's transmittance comes from the whole path before
/// it (FlamePath in floats, all wavelengths at once). One per thread.
class MixtureRay {
public:
    /// \param table must outlive the ray
    explicit MixtureRay(const radiometry::FlameTable& table);
    MixtureRay(const MixtureRay&) = delete;
    MixtureRay& operator=(const MixtureRay&) = delete;
    MixtureRay(MixtureRay&&) = default;
    MixtureRay& operator=(MixtureRay&&) = delete;
    ~MixtureRay() = default;

    void begin();
    /// Appends a piece away from the sensor and adds scale times its emission at the sensor to `flame` [stride].
    /// \param fill_length_m length times filled fraction   \param emission of the Planck rows, whose stride is the table's
    void add(double T_K, double fill_length_m, const PlanckRows& planck, float scale, float* flame);
    /// Transmittance of all pieces [stride]; others that absorb on the way multiply it.
    [[nodiscard]] float* tau() noexcept { return tau_.data(); }

private:
    const radiometry::FlameTable* table_;
    const SpectralKernels* kernels_;
    std::vector<float> sums_, continuum_depth_, depth_, ahead_, tau_;
    std::vector<unsigned char> opaque_;
    std::vector<MixtureGas> gases_;
};

}  // namespace pyroscene::render
