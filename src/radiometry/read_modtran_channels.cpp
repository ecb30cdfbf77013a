#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/error.h"
#include "radiometry/modtran_columns.h"

namespace pyroscene::radiometry {
namespace {

constexpr std::size_t kColumns = 26;
// Positions of the columns (0-based) in a channel file.
enum Column : std::size_t {
    kWavelength_nm = 0,
    kRadiance_per_nm = 4,
    kChannelRadiance = 6,
    kWidth_nm = 8,
    kThermal = 11,
    kThermalScatter = 12,
    kSurface = 13,
    kMultipleScatter = 14,
    kSingleScatter = 15,
    kGroundReflected = 16,
    kDirectReflected = 17,
    kSunOverPi = 18,
    kTwoWaySun = 19,
    kDirectCoefficient = 21,
    kDiffuseCoefficient = 22,
    kSphericalAlbedo = 23,
    kTransmittance = 24
};

using Row = std::array<double, kColumns>;

Row read_row(const std::string& line, const std::string& where) {
    std::istringstream in(line);
    Row row{};
    for (std::size_t k = 0; k < kColumns; ++k) {
        std::string word;
        in >> word;
        const auto value = fortran_number(word);
        if (!value)
            throw input_error(where, fmt::format("column {} of {} reads '{}', expected a number", k + 1, kColumns, word));
        row[k] = *value;
    }
    if (!(row[kWidth_nm] > 0.0)) throw input_error(where, fmt::format("channel width {} nm", row[kWidth_nm]));
    const double product = row[kRadiance_per_nm] * row[kWidth_nm];
    if (std::abs(product - row[kChannelRadiance]) > 1e-3 * std::abs(row[kChannelRadiance]))
        throw input_error(where, fmt::format("mean radiance times width is {:.6g} but the channel radiance is {:.6g}: "
                                             "the columns are not those of a channel file",
                                             product, row[kChannelRadiance]));
    return row;
}

void add_row(AtmosphereRun& run, const Row& r, const std::string& where) {
    const double mean = 1e7 / r[kWidth_nm];  // W cm-2 over the response -> W m-2 um-1
    const double sum =
        r[kThermal] + r[kThermalScatter] + r[kSurface] + r[kMultipleScatter] + r[kSingleScatter] + r[kGroundReflected];
    if (std::abs(sum - r[kChannelRadiance]) > 0.005 * std::abs(r[kChannelRadiance]))
        throw input_error(
            where, fmt::format("the terms sum to {:.6g} but the channel radiance is {:.6g}", sum, r[kChannelRadiance]));
    const double tau = r[kTransmittance];
    if (!(tau >= 0.0 && tau <= 1.0)) throw input_error(where, fmt::format("path transmittance {}, expected 0 to 1", tau));
    run.wavelength_um.push_back(1e-3 * r[kWavelength_nm]);
    run.transmittance.push_back(tau);
    run.path_thermal.push_back(mean * (r[kThermal] + r[kThermalScatter]));
    run.path_solar.push_back(mean * (r[kMultipleScatter] + r[kSingleScatter]));
    // The coefficients refer to the sun on horizontal ground without air: A = T tau, B = T t_d, with T what reaches the
    // ground (direct and diffuse) before bounces.
    const double horizontal_sun = kPi * mean * r[kSunOverPi];
    const double total = tau > 1e-4 ? r[kDirectCoefficient] / tau : 0.0;
    const double direct = tau > 1e-4 ? mean * r[kTwoWaySun] / tau : 0.0;  // normal to the beam, with its correlation
    run.toa_irradiance.push_back(horizontal_sun);
    run.direct_normal.push_back(direct);
    run.diffuse.push_back(total * horizontal_sun);
    run.spherical_albedo.push_back(std::clamp(r[kSphericalAlbedo], 0.0, 1.0));
    run.diffuse_transmittance.push_back(total > 1e-4 ? r[kDiffuseCoefficient] / total : 0.0);
}

/// So far toa_irradiance holds the sun on the horizontal and diffuse what reaches the ground in all.
void finish(AtmosphereRun& run, const RunHints& hints, const Spectrum& sun) {
    run.geometry = hints.geometry;
    if (!run.geometry.sun_zenith_deg)
        throw input_error(run.source, "a channel file does not say where the sun stood; give --sun-zenith-deg");
    const double cosine = std::cos(*run.geometry.sun_zenith_deg * kDegree_rad);
    std::vector<double> ratios;
    for (std::size_t i = 0; i < run.wavelength_um.size(); ++i) {
        run.toa_irradiance[i] /= cosine;
        run.diffuse[i] = std::max(0.0, run.diffuse[i] - run.direct_normal[i] * cosine);
        ratios.push_back(run.toa_irradiance[i] / sun.at(run.wavelength_um[i]));
    }
    const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
    std::nth_element(ratios.begin(), middle, ratios.end());
    if (!(*middle > 0.85 && *middle < 1.15))
        throw input_error(run.source,
                          fmt::format("with the sun at {:.4g} deg zenith its light at the top of the atmosphere is "
                                      "{:.3g} times what it is; check the sun zenith angle",
                                      *run.geometry.sun_zenith_deg, *middle));
}

}  // namespace

std::vector<AtmosphereRun> read_modtran_channels(const std::string& path, const std::string& text, const RunHints& hints,
                                                 const Spectrum& sun) {
    std::vector<AtmosphereRun> runs;
    std::istringstream in(text);
    bool in_block = false;
    int line_number = 0;
    for (std::string line; std::getline(in, line);) {
        ++line_number;
        const auto where = fmt::format("{}:{}", path, line_number);
        const auto first = line.find_first_not_of(" \r");
        const bool data = first != std::string::npos && std::isdigit(static_cast<unsigned char>(line[first])) != 0 &&
                          line.find("SPECTRAL") == std::string::npos;
        if (!data) {
            if (in_block && line.find("****") != std::string::npos)
                throw input_error(where, "stars instead of a number: a column of this file was too narrow");
            in_block = in_block && first == std::string::npos;
            continue;
        }
        if (!in_block) runs.emplace_back().source = where;
        in_block = true;
        add_row(runs.back(), read_row(line, where), where);
    }
    if (runs.empty()) throw input_error(path, "no channel was found: this is no MODTRAN channel file");
    for (auto& run : runs) {
        sort_by_wavelength(run);  // neighbouring spectrometers of an instrument overlap
        finish(run, hints, sun);
    }
    return runs;
}

}  // namespace pyroscene::radiometry
