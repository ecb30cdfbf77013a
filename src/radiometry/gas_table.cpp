#include "radiometry/gas_table.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/error.h"

namespace pyroscene::radiometry {
namespace {

constexpr std::array<const char*, kGasSpeciesCount> kFileNames{"h2o", "co2", "co", "ch4"};

/// Interval of ascending `x` that holds `at`, and the place in it.
struct Place {
    std::size_t low;
    double fraction;
};
Place place_in(const std::vector<double>& x, double at) noexcept {
    const auto above = static_cast<std::size_t>(std::upper_bound(x.begin(), x.end(), at) - x.begin());
    const std::size_t low = std::clamp<std::size_t>(above, 1, x.size() - 1) - 1;
    return {low, std::clamp((at - x[low]) / (x[low + 1] - x[low]), 0.0, 1.0)};
}

double blend(double a, double b, double fraction) noexcept {
    if (a > 0.0 && b > 0.0) return a * std::pow(b / a, fraction);
    return a + fraction * (b - a);
}

GasGrid read_grid(const std::filesystem::path& path) {
    const auto table = read_csv(path);
    GasGrid grid;
    grid.wavenumber_per_cm = table.numbers("wavenumber_cm1");
    std::vector<std::vector<double>> columns;
    for (const auto& name : table.columns) {
        if (!name.starts_with("T")) continue;
        grid.temperature_K.push_back(parse_number(name.substr(1), table.path + ": column " + name));
        columns.push_back(table.numbers(name));
    }
    if (columns.size() < 2 || table.rows.size() < 2) {
        throw input_error(table.path,
                          fmt::format("found {} rows and {} temperature columns (T300, ...), expected at least 2",
                                      table.rows.size(), columns.size()));
    }
    if (!std::is_sorted(grid.temperature_K.begin(), grid.temperature_K.end(), std::less_equal<>()))
        throw input_error(table.path, "temperature columns must ascend");
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        const auto subject = fmt::format("{}:{}", table.path, table.row_lines[row]);
        if (row > 0 && !(grid.wavenumber_per_cm[row] > grid.wavenumber_per_cm[row - 1]))
            throw input_error(subject, fmt::format("wavenumber {}, expected ascending", grid.wavenumber_per_cm[row]));
        for (const auto& column : columns) {
            if (!(column[row] >= 0.0)) throw input_error(subject, fmt::format("value {}, expected >= 0", column[row]));
            grid.values.push_back(column[row]);
        }
    }
    return grid;
}

}  // namespace

double GasGrid::at(double wavenumber, double T_K) const noexcept {
    if (!(wavenumber >= wavenumber_per_cm.front() && wavenumber <= wavenumber_per_cm.back())) return 0.0;
    const Place w = place_in(wavenumber_per_cm, wavenumber), t = place_in(temperature_K, T_K);
    const double* low = values.data() + w.low * temperature_K.size() + t.low;
    const double* high = low + temperature_K.size();
    return (1.0 - w.fraction) * blend(low[0], low[1], t.fraction) + w.fraction * blend(high[0], high[1], t.fraction);
}

GasOptics load_gas_optics(const std::filesystem::path& folder) {
    GasOptics optics;
    for (std::size_t i = 0; i < kGasSpeciesCount; ++i) {
        optics.species[i] = {read_grid(folder / fmt::format("gas_kappa_{}.csv", kFileNames[i])),
                             read_grid(folder / fmt::format("gas_lines_{}.csv", kFileNames[i]))};
    }
    return optics;
}

}  // namespace pyroscene::radiometry
