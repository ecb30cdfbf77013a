#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace pyroscene::fire {

/// Which relations give flames their size, lean and share of a cell, with the numbers that only these relations use.
struct FlameHeightSettings {
    std::string method = "heat_flux";  ///< a row of kFlameHeightMethods
    double constant_m = 2.0;           ///< of method constant
    double air_fuel_ratio = 5.5;       ///< kg of air burnt with one kg of fuel (Heskestad)
    std::optional<double>
        plume_coefficient_m_kW;  ///< Heskestad's A; absent = from air, heat of combustion and air_fuel_ratio
    std::optional<double> burning_area_fraction;  ///< of a cell, for Heskestad's diameter; absent = its front fraction
    double stand_height_m = 0.0;                  ///< trees under a crown fire (Butler)
};

struct FlameTiltSettings {
    std::string method = "buoyant_velocity";  ///< a row of kFlameTiltMethods
    bool slope = false;                       ///< count the ground's slope along the wind
    double fuel_vapour_density_kg_m3 = 0.36;  ///< of AGA and the thesis (4.6.4)
};

/// Where the fireline intensity of a cell comes from. A raster of it goes before all of these.
enum class IntensityRule : std::uint8_t {
    Auto,     ///< Fuel for flame-height methods driven by intensity, HeatFlux for the others
    Fuel,     ///< load x heat of combustion x spread rate (eq 4.29); HeatFlux where one is unknown
    HeatFlux  ///< cell-mean heat flux x cell edge
};

/// How deep the flaming zone is, hence how much of a cell it covers.
enum class DepthRule : std::uint8_t {
    HeatFlux,      ///< cell-mean heat flux / flux inside the flaming zone
    ResidenceTime  ///< residence time x spread rate; HeatFlux where one is unknown and where the front has passed
};

struct FlameRelations {
    FlameHeightSettings height;
    FlameTiltSettings tilt;
    IntensityRule intensity = IntensityRule::Auto;
    DepthRule depth = DepthRule::HeatFlux;
    std::optional<double> residence_time_s;     ///< of flames at one place; absent = the raster of FrontInputs
    double heat_of_combustion_J_kg = 16.515e6;  ///< fuel to heat: low heat (thesis 4.6.3)
    double consumed_fraction = 1.0;             ///< of the fuel load, in the flaming front
    double maximum_spread_rate_m_s = 10.0;      ///< for rates from arrival times
};

}  // namespace pyroscene::fire
