#pragma once

#include <cmath>
#include <cstdint>

#include "base/raster.h"

/// Small things that surface_field.cpp and flame_columns.cpp share; not for other modules.
namespace pyroscene::fire {

/// Bilinear value between cell centres at a continuous column and row (corners at integers); beyond the outermost centres
/// the border value goes on. Where one of the four cells has no data, the value of the cell that contains the place is
/// taken, which may itself be NaN.
float bilinear_or_own(const Raster<float>& raster, double col, double row) noexcept;

/// Number of a moment for RandomKey::frame: milliseconds, so that no two frames of a run share random numbers.
inline std::uint32_t random_frame(double time_s) noexcept {
    return static_cast<std::uint32_t>(std::llround(time_s * 1000.0));
}

}  // namespace pyroscene::fire
