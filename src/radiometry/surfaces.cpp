#include "radiometry/surfaces.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/csv.h"
#include "base/error.h"

namespace pyroscene::radiometry {
namespace {

std::string line_of(const CsvTable& table, std::size_t row) {
    return fmt::format("{}:{}", table.path, table.row_lines[row]);
}

void check_surface(const CsvTable& table, std::string_view name, const Spectrum& s) {
    for (std::size_t i = 0; i < s.lambda_um.size(); ++i) {
        if (!(s.lambda_um[i] > (i > 0 ? s.lambda_um[i - 1] : 0.0)))
            throw input_error(line_of(table, i),
                              fmt::format("wavelength {} um, expected positive and ascending", s.lambda_um[i]));
        if (!(s.value[i] >= 0.0 && s.value[i] <= 1.0))
            throw input_error(line_of(table, i),
                              fmt::format("reflectance {} of '{}', expected a number from 0 to 1", s.value[i], name));
    }
}

}  // namespace

int SurfaceLibrary::index_of(std::string_view name) const {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
        throw input_error(path, fmt::format("no surface '{}'; the library has {}", name, fmt::join(names, ", ")));
    return static_cast<int>(found - names.begin());
}

SurfaceLibrary load_surfaces(const std::filesystem::path& path) {
    const auto table = read_csv(path);
    const auto lambda_um = table.numbers("wavelength_um");
    SurfaceLibrary library{table.path, {}, {}};
    for (const auto& name : table.columns) {
        if (name == "wavelength_um") continue;
        Spectrum reflectance{Quantity::Reflectance, lambda_um, table.numbers(name)};
        check_surface(table, name, reflectance);
        library.names.push_back(name);
        library.reflectance.push_back(std::move(reflectance));
    }
    if (library.names.empty() || lambda_um.empty())
        throw input_error(table.path, fmt::format("found {} surfaces at {} wavelengths, expected at least one of each",
                                                  library.names.size(), lambda_um.size()));
    return library;
}

FuelSurfaces load_fuel_surfaces(const std::filesystem::path& path) {
    const auto table = read_csv(path);
    const auto surface_column = table.column("surface");
    const auto codes = table.numbers("code");
    FuelSurfaces out;
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
        FuelSurfaces::Entry entry;
        if (table.has("table")) entry.table = table.rows[r][table.column("table")];
        entry.surface = table.rows[r][surface_column];
        if (!(std::abs(codes[r]) < 1e9) || codes[r] != std::floor(codes[r]))
            throw input_error(line_of(table, r), fmt::format("code {}, expected an integer", codes[r]));
        entry.code = static_cast<int>(codes[r]);
        if (entry.surface.empty()) throw input_error(line_of(table, r), fmt::format("code {} has no surface", entry.code));
        for (const auto& known : out.entries)
            if (known.table == entry.table && known.code == entry.code)
                throw input_error(line_of(table, r), fmt::format("code {} is listed twice", entry.code));
        out.entries.push_back(std::move(entry));
    }
    return out;
}

std::string surface_of_fuel(const FuelSurfaces& surfaces, std::string_view table, int code) {
    for (const auto& entry : surfaces.entries)
        if (entry.code == code && (entry.table.empty() || entry.table == table)) return entry.surface;
    return {};
}

}  // namespace pyroscene::radiometry
