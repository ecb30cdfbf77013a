#pragma once

#include <array>
#include <filesystem>

#include "base/flame_gas.h"
#include "radiometry/alkali.h"
#include "radiometry/gas_table.h"
#include "radiometry/narrow_band.h"
#include "radiometry/soot.h"

namespace pyroscene::radiometry {

/// All tables about flames.
struct FlameOptics {
    SootOptics soot;
    GasOptics gas;
    AlkaliLines alkali;
};

/// Reads soot_optics.csv, gas_*.csv and alkali_lines.csv of a folder (data/optical). Throws an input error.
FlameOptics load_flame_optics(const std::filesystem::path& folder);

/// Optical depth along a ray through pieces of flame at one wavelength, constituent by constituent. Soot and atoms follow
/// Beer's law; gas follows the narrow-band model, whose transmittances do not multiply from piece to piece within a species.
/// This is the reference in double precision; the renderer's kernels do the same in floats from tables.
class FlamePath {
public:
    /// \param optics must outlive the path   \param lambda_um vacuum wavelength [um], > 0
    FlamePath(const FlameOptics& optics, double lambda_um) noexcept : optics_(&optics), lambda_um_(lambda_um) {}

    /// Appends a homogeneous piece of the ray, away from the sensor.
    void add(double length_m, double T_K, const FlameGas& gas) noexcept;

    [[nodiscard]] double soot_depth() const noexcept { return soot_; }
    [[nodiscard]] double alkali_depth() const noexcept { return alkali_; }
    [[nodiscard]] double gas_depth(GasSpecies species) const noexcept;
    [[nodiscard]] double gas_depth() const noexcept;
    [[nodiscard]] double depth() const noexcept { return soot_ + alkali_ + gas_depth(); }
    /// Radiance emitted towards the sensor by all pieces: sum of B(T_i) (tau_i - tau_{i+1}) (thesis eq 4.9 to 4.11).
    [[nodiscard]] double emitted_radiance() const noexcept { return radiance_; }

private:
    const FlameOptics* optics_;
    double lambda_um_;
    double soot_ = 0.0, alkali_ = 0.0, radiance_ = 0.0;
    std::array<GasColumn, kGasSpeciesCount> columns_{};
};

/// Emissivity of a homogeneous flame over all wavelengths, weighted with Planck's law between 0.5 and 16.6 um: what a radiometer
/// without a filter sees. Sums over 400 wavelengths (1 % of the resolved integral).
double total_emissivity(const FlameOptics& optics, const FlameGas& gas, double T_K, double length_m) noexcept;

}  // namespace pyroscene::radiometry
