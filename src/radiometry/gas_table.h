#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <vector>

namespace pyroscene::radiometry {

inline constexpr double kAtmosphere_Pa = 101325.0;

/// Species of the narrow-band model. The number is their place in arrays.
enum class GasSpecies { H2O, CO2, CO, CH4 };
inline constexpr std::size_t kGasSpeciesCount = 4;
inline constexpr std::array<GasSpecies, kGasSpeciesCount> kGasSpecies{GasSpecies::H2O, GasSpecies::CO2, GasSpecies::CO,
                                                                      GasSpecies::CH4};

/// Values over wavenumber and temperature, as the files hold them.
struct GasGrid {
    std::vector<double> wavenumber_per_cm;  ///< ascending
    std::vector<double> temperature_K;      ///< ascending
    std::vector<double> values;             ///< [wavenumber][temperature], >= 0

    /// Linear in wavenumber; in temperature linear in the logarithm where both neighbours are positive, else linear.
    /// Zero outside the wavenumbers; temperatures are clamped to the table.
    [[nodiscard]] double at(double wavenumber, double T_K) const noexcept;
};

/// One absorber: mean absorption coefficient [1/(atm m), of the gas at its own temperature], and how dense its lines are.
struct GasTable {
    GasGrid kappa_per_atm_m;
    /// Inverse mean line spacing 1/d [cm]; for CH4 the fine-structure parameter a_C at 1 atm instead.
    GasGrid line_density;
};

struct GasOptics {
    std::array<GasTable, kGasSpeciesCount> species;
    [[nodiscard]] const GasTable& operator[](GasSpecies s) const noexcept { return species[static_cast<std::size_t>(s)]; }
};

/// Reads gas_kappa_<species>.csv and gas_lines_<species>.csv of a folder (data/optical: NIST RADCAL, 600 to 9300 1/cm,
/// 300 to 2000 K). Throws an input error that names file and line: unreadable, wavenumbers or temperatures not ascending,
/// a negative value.
GasOptics load_gas_optics(const std::filesystem::path& folder);

}  // namespace pyroscene::radiometry
