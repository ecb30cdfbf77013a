#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "base/raster.h"
#include "spread/propagate.h"
#include "spread/rothermel.h"

namespace pyroscene::spread {

/// A quantity on the map: one value, or a raster (no values = the one).
struct Field {
    double everywhere = 0.0;
    Raster<float> raster{};

    [[nodiscard]] bool uniform() const noexcept { return raster.values.empty(); }
    [[nodiscard]] double at(std::size_t cell) const noexcept { return uniform() ? everywhere : raster.values[cell]; }
};

/// What a fire spreads over.
struct Landscape {
    Raster<std::uint16_t> fuel;  ///< 0 = carries no fire, else a number of `models`
    FuelModels models;
    Raster<float> slope_east, slope_north;  ///< rise over run
    Field canopy_cover{}, canopy_height_m{}, crown_ratio{0.5};
};

/// Wind 20 ft (6.1 m) above the vegetation along the axes of the map and fuel moistures that hold from a time on, until those of the next.
struct Weather {
    double from_s = 0.0;
    Field wind_east_m_s, wind_north_m_s;
    std::array<Field, kFuelClasses> moisture;  ///< water / dry mass
};

struct SpreadRules {
    Curing curing = Curing::BehavePlus;
    bool wind_limit = false;
};

/// Shapes of the fire in all cells. Runs on all cores. Cells with a value that is not finite carry no fire.
FireShapes fire_shapes(const Landscape& landscape, const Weather& weather, const SpreadRules& rules);

/// What a fire did, all on the grid of the landscape; NaN where it did not come before the end.
struct FireSpread {
    Raster<float> arrival_time_s;
    Raster<float> spread_rate_m_s;            ///< normal to the front, along the slope, as it passed
    Raster<float> fireline_intensity_W_m;     ///< Byram: heat per area x that rate
    Raster<float> flame_length_m;             ///< of that intensity
    std::size_t cells_with_limited_wind = 0;  ///< burnt cells whose wind the limit cut
};

/// Follows a fire. \param weather  at least one, ascending in time \param end_s  until when
/// Throws an input error when there is no weather, when times do not ascend, or when grids differ.
FireSpread spread_fire(const Landscape& landscape, const std::vector<Weather>& weather, const SpreadRules& rules,
                       const std::vector<Seed>& seeds, double end_s,
                       const std::function<void(double time_s)>& on_progress = {});

}  // namespace pyroscene::spread
