#include "radiometry/soot.h"

#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/error.h"

namespace pyroscene::radiometry {
namespace {

double power_law(double x, double x0, double y0, double x1, double y1) noexcept {
    return y0 * std::pow(x / x0, std::log(y1 / y0) / std::log(x1 / x0));
}

}  // namespace

SootOptics load_soot_optics(const std::filesystem::path& path) {
    const auto table = read_csv(path);
    SootOptics soot{{Quantity::Dimensionless, table.numbers("wavelength_um"), table.numbers("C")}};
    const auto& x = soot.absorption_constant.lambda_um;
    const auto& y = soot.absorption_constant.value;
    if (x.size() < 2) throw input_error(table.path, fmt::format("found {} rows, expected at least 2", x.size()));
    for (std::size_t i = 0; i < x.size(); ++i) {
        const auto subject = fmt::format("{}:{}", table.path, table.row_lines[i]);
        if (!(x[i] > (i > 0 ? x[i - 1] : 0.0)))
            throw input_error(subject, fmt::format("wavelength {} um, expected positive and ascending", x[i]));
        if (!(y[i] > 0.0)) throw input_error(subject, fmt::format("C = {}, expected a positive number", y[i]));
    }
    return soot;
}

double soot_absorption_constant(const SootOptics& soot, double lambda_um) noexcept {
    const auto& x = soot.absorption_constant.lambda_um;
    const auto& y = soot.absorption_constant.value;
    const std::size_t n = x.size();
    if (lambda_um < x.front()) return power_law(lambda_um, x[0], y[0], x[1], y[1]);
    if (lambda_um > x.back()) return power_law(lambda_um, x[n - 1], y[n - 1], x[n - 2], y[n - 2]);
    return soot.absorption_constant.at(lambda_um);
}

double soot_absorption_per_m(const SootOptics& soot, double lambda_um, double volume_fraction) noexcept {
    return soot_absorption_constant(soot, lambda_um) * volume_fraction / (lambda_um * 1e-6);
}

double soot_planck_mean_per_m(double volume_fraction, double T_K) noexcept { return 1340.0 * volume_fraction * T_K; }

}  // namespace pyroscene::radiometry
