#pragma once

#include <cstdint>

namespace pyroscene::fire {

/// What a flame-size relation gives. A height is vertical; a length lies along the leaning axis, so that height = length cos(tilt)
/// over level ground. Mixing them up shrinks tall flames twice.
enum class FlameExtent : std::uint8_t {
    Height,
    Length,
    LengthAboveStand  ///< crown fires: the axis starts at the top of the stand, whose height is added upright
};

/// Vertical height of a flame above the ground [m]. \param size_m what the relation gave; <= 0 or NaN gives 0, also where the
/// stand is tall  \param tilt_rad from the vertical, 0 to below pi/2  \param stand_height_m used by LengthAboveStand only
double vertical_height_m(FlameExtent extent, double size_m, double tilt_rad, double stand_height_m) noexcept;

}  // namespace pyroscene::fire
