#pragma once

#include <string>

#include "radiometry/atmosphere.h"

namespace pyroscene::test {

/// What a radiative-transfer code would print for the atmosphere of the shipped tables: the terms of one line of sight, over
/// ground of an albedo, combined by the definitions of MODTRAN's columns (docs/physics-radiometry.md).
struct SimulatedRun {
    radiometry::AtmosphericTerms terms;
    double sensor_altitude_km = 0.0, view_zenith_deg = 0.0, sun_zenith_deg = 45.0, relative_azimuth_deg = 0.0;
    double albedo = 0.0;
    bool sun = true;
    double ground_temperature_K = 300.0;

    /// Columns in W m-2 um-1 (sr-1): transmittance, path thermal, surface, path solar, ground reflected, direct reflected,
    /// total, sun at the top.
    struct Columns {
        double tau, thermal, surface, solar, ground, direct, total, toa;
    };
    [[nodiscard]] Columns at(std::size_t l) const;
};

/// Terms of the shipped mid-latitude summer atmosphere.
SimulatedRun simulate(double sensor_altitude_km, double view_zenith_deg, double sun_zenith_deg, double relative_azimuth_deg,
                      double albedo);

std::string tape7_text(const SimulatedRun& run);
/// Its table alone, without the echo of the cards.
std::string tape7_table(const SimulatedRun& run);
std::string modtran_csv_text(const SimulatedRun& run);
std::string modtran_json_text(const SimulatedRun& run);

}  // namespace pyroscene::test
