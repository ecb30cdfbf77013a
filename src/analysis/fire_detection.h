#pragma once

#include <limits>
#include <span>
#include <vector>

namespace pyroscene::analysis {

/// What a detector says of a pixel; the numbers are those of the fire masks of NASA's MODIS and VIIRS products.
enum class FireClass : unsigned char {
    NotProcessed = 0,  ///< no data
    Glint = 2,
    Water = 3,
    Cloud = 4,
    Clear = 5,    ///< land without fire
    Unknown = 6,  ///< looks like a fire, but too few valid surroundings to tell
    Low = 7,
    Nominal = 8,
    High = 9
};

constexpr bool is_fire(FireClass c) noexcept { return c >= FireClass::Low; }

/// Planes [line][sample] of one image. NaN = no data. A span may be empty where "or none" stands: tests that need it are left out.
struct ThermalScene {
    int samples = 0, lines = 0;
    std::span<const float> mir_K, tir_K;    ///< brightness temperatures near 4 and 11 um
    std::span<const float> cloud_K;         ///< near 12 um, or none: tir_K
    std::span<const float> red, nir, swir;  ///< reflectances near 0.65, 0.86 and 2.1 um (VIIRS: 1.6 um), or none
    std::span<const float> sun_zenith_deg;  ///< or none: night
    std::span<const float> glint_deg;       ///< angle between view and mirror direction of the sun, or none
    std::span<const unsigned char> water;   ///< 1 = water, or none
    double mir_saturation_K = std::numeric_limits<double>::infinity();  ///< at and above it the MIR is a lower bound
};

/// The answer, one value per pixel.
struct Detection {
    std::vector<FireClass> fire;
    std::vector<float> confidence_percent;  ///< 0 to 100; NaN where there is no fire
    std::vector<float> background_mir_K;    ///< mean of the surroundings; NaN where none were looked at
};

/// Contextual algorithm for 1 km pixels after MODIS collection 6: fixed thresholds choose candidates, which must then stand out from
/// their surroundings. By day the candidates' thresholds follow the scene (mean of 301 x 30 pixels).
/// Source: Giglio et al. 2003 (Remote Sens. Environ. 87:273) with the changes of Giglio et al. 2016 (178:31).
Detection detect_mod14(const ThermalScene& scene);

/// Contextual algorithm for 375 m pixels after VIIRS. Source: Schroeder et al. 2014 (Remote Sens. Environ. 143:85).
Detection detect_viirs375(const ThermalScene& scene);

/// Angle between the direction to the sensor and the mirror image of the sun in a level surface [deg].
double glint_angle_deg(double view_zenith_deg, double view_azimuth_deg, double sun_zenith_deg,
                       double sun_azimuth_deg) noexcept;

}  // namespace pyroscene::analysis
