#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/spectrum.h"

namespace pyroscene::radiometry {

/// Named reflectance spectra of opaque ground. Emissivity = 1 - reflectance (Kirchhoff, diffuse surfaces).
struct SurfaceLibrary {
    std::string path;  ///< file it was read from
    std::vector<std::string> names;
    std::vector<Spectrum> reflectance;  ///< Quantity::Reflectance, 0..1, one per name

    /// Position of a surface. Throws an input error that lists the surfaces there are.
    [[nodiscard]] int index_of(std::string_view name) const;
};

/// Reads a table with the column wavelength_um and one reflectance column per surface
/// (data/optical/surface_reflectance.csv). Throws an input error naming file and line: reflectance outside 0..1, wavelengths
/// not ascending, no surface column.
SurfaceLibrary load_surfaces(const std::filesystem::path& path);

/// Which surface spectrum unburnt ground of a fuel model has.
struct FuelSurfaces {
    struct Entry {
        std::string table;    ///< fuel model system ("fbfm13", "fbfm40"), empty when the file has no such column
        int code = 0;         ///< value in the fuel raster
        std::string surface;  ///< name in a SurfaceLibrary
    };
    std::vector<Entry> entries;
};

/// Reads columns code, surface and, where one file holds several systems, table (data/fuel/surface_of_fuel.csv).
/// Throws an input error naming file and line: a code that is no integer, an empty surface, a code given twice.
FuelSurfaces load_fuel_surfaces(const std::filesystem::path& path);

/// Surface of a fuel code; empty for codes that are not listed (no data, -9999): the caller's default applies.
/// \param table system of the code; entries without a system match any
std::string surface_of_fuel(const FuelSurfaces& surfaces, std::string_view table, int code);

}  // namespace pyroscene::radiometry
