#include "radiometry/smoke.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/csv.h"
#include "base/error.h"

namespace pyroscene::radiometry {
namespace {

double power_law_at(const Spectrum& s, double lambda_um) noexcept {
    const auto& x = s.lambda_um;
    const auto& y = s.value;
    if (lambda_um <= x.front()) return y.front();
    if (lambda_um >= x.back()) return y.back();
    const auto high = static_cast<std::size_t>(std::upper_bound(x.begin(), x.end(), lambda_um) - x.begin());
    const double fraction = std::log(lambda_um / x[high - 1]) / std::log(x[high] / x[high - 1]);
    return y[high - 1] * std::pow(y[high] / y[high - 1], fraction);
}

}  // namespace

SmokeOptics load_smoke_optics(const std::filesystem::path& path, std::string_view kind) {
    const auto table = read_csv(path);
    const auto column = [&](const char* quantity) {
        Spectrum spectrum{Quantity::Dimensionless, table.numbers("wavelength_um"),
                          table.numbers(fmt::format("{}_{}", quantity, kind))};
        for (std::size_t i = 0; i < spectrum.value.size(); ++i)
            if (!(spectrum.value[i] >= 0.0 && (i == 0 || spectrum.lambda_um[i] > spectrum.lambda_um[i - 1])))
                throw input_error(fmt::format("{}:{}", table.path, table.row_lines[i]),
                                  fmt::format("{} = {} at {} um, expected no negative number and ascending wavelengths",
                                              quantity, spectrum.value[i], spectrum.lambda_um[i]));
        if (spectrum.value.size() < 2) throw input_error(table.path, "expected at least two wavelengths");
        return spectrum;
    };
    return {column("mee"), column("ssa"), column("g")};
}

SmokeCoefficients smoke_coefficients(const SmokeOptics& smoke, double lambda_um, double concentration_g_m3) noexcept {
    return {power_law_at(smoke.extinction_m2_g, lambda_um) * concentration_g_m3, smoke.albedo.at(lambda_um),
            smoke.asymmetry.at(lambda_um)};
}

double henyey_greenstein_per_sr(double cosine, double asymmetry) noexcept {
    const double g2 = asymmetry * asymmetry, base = 1.0 + g2 - 2.0 * asymmetry * cosine;
    return (1.0 - g2) / (4.0 * kPi * base * std::sqrt(base));
}

}  // namespace pyroscene::radiometry
