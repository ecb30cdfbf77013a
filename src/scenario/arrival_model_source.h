#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenario/fire_frames.h"
#include "scenario/fuel_source.h"

namespace pyroscene::scenario {

/// Units that a scenario may say.
inline const std::vector<std::string> kTimeUnits{"s", "min", "h"}, kIntensityUnits{"W/m", "kW/m", "Btu/ft/s"},
    kLengthUnits{"m", "ft"}, kSpeedUnits{"m/s", "mph", "km/h", "kt"}, kRateUnits{"m/s", "m/min", "ft/min", "chain/h"};

/// A raster whose unit the scenario says.
struct UnitRaster {
    RasterSource raster;
    std::string unit;
};

/// A fire known by arrival times that a two-dimensional spread model computed (inputs.arrival_model).
struct ArrivalModelSource {
    std::string model;  ///< which program; decides units that it always uses, and which files `arrival` names
    UnitRaster arrival;
    bool grids = false;   ///< Cell2Fire: `arrival` names grids (key files), not messages (file)
    double period = 1.0;  ///< Cell2Fire: of the weather, or of its messages' time, in the unit of `arrival`
    std::optional<std::filesystem::path> like;  ///< Cell2Fire: a raster of its cells
    std::string crs;                            ///< of files that do not say theirs, and of the place
    std::optional<double> west_m, south_m;      ///< QUIC-Fire, FDS: where the origin of its coordinates lies
    int cols = 0, rows = 0;                     ///< QUIC-Fire: its grid
    double cell_m = 2.0;
    double offset_s = 0.0;  ///< of the model's clock: its 0 is so long after `start`
    std::optional<UnitRaster> fireline_intensity, flame_length, spread_rate;
    FuelSource fuel;
    double fuel_moisture_pct = 8.0;
    FireFrames frames;
};

}  // namespace pyroscene::scenario
