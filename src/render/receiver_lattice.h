#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/flame_columns.h"
#include "render/scene.h"

namespace pyroscene::render {

/// A receiver of GroundIrradiance, and where its flame light comes from: traced, or interpolated between four others.
struct LatticeReceiver {
    std::int32_t row = 0;
    bool traced = true;
    std::array<std::int32_t, 4> from{};  ///< rows, in order along the map's row or column
    std::array<float, 4> weight{};       ///< of their 1 / sqrt(E), see receiver_waves()
};

/// On level ground the light of flames varies smoothly away from them: like r^-2 to r^-3, so that 1 / sqrt(E) is almost linear.
/// Receivers on lattices of 16, 8, 4, 2 and 1 cells; one at least six spacings from any flame lies in the middle between others
/// of the next coarser lattice and takes its light from a cubic through four of their 1 / sqrt(E). Waves come in the order in
/// which they can be worked on; within one the order does not matter.
std::vector<std::vector<LatticeReceiver>> receiver_waves(const GroundIrradiance& light, const FlameColumns& flame,
                                                         Vec3 scene_origin_m);

}  // namespace pyroscene::render
