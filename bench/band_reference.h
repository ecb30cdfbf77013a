#pragma once

#include <functional>
#include <vector>

#include "radiometry/atmosphere.h"
#include "radiometry/flame_optics.h"
#include "sensors/sensor.h"

namespace pyroscene::bench {

/// How well the transport wavelengths of a band do.
struct BandError {
    const sensors::Band* band = nullptr;
    int nodes = 0;
    double worst = 0.0;  ///< largest relative error of the scenes' band radiances, signed
    int scene = -1;      ///< which, an index into kReferenceScenes
};

/// What the bands look at: flames and ground through air, none of which the transport wavelengths were picked for.
inline constexpr const char* kReferenceScenes[] = {"2.3 m of flame, 1080 K, before ground of 700 K, 30 deg",
                                                   "two layers of flame, 820 and 1270 K, 30 deg",
                                                   "0.4 m of moist, lean flame, 1350 K, nadir",
                                                   "9 m of moist, lean flame, 1000 K, 30 deg",
                                                   "ground of 310 K by day, 30 deg",
                                                   "ground of 650 K by day, 45 deg",
                                                   "1.5 m of flame, 1200 K, before ground of 320 K, no air"};

/// Wavelengths at most 1 cm-1 apart, closer at the corners of the response and in lines.
std::vector<double> fine_wavelengths_um(const Spectrum& response, const radiometry::FlameOptics& optics);

/// Band radiances on the grid that a render would take (vertical and 25 and 50 degrees of air known to it) against sums over every
/// 1 cm-1 at most, alkali lines resolved a thousand times finer; mid-latitude summer, sun 40 degrees from the zenith, sensor at
/// 3 km or, in space, 100 km.
/// \param wanted  which bands; all when empty
std::vector<BandError> quadrature_errors(const sensors::Sensor& sensor, const radiometry::FlameOptics& optics,
                                         const radiometry::AtmosphereSet& air,
                                         const std::function<bool(const sensors::Band&)>& wanted = {});

}  // namespace pyroscene::bench
