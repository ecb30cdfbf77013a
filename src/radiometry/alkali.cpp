#include "radiometry/alkali.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/csv.h"
#include "base/error.h"
#include "radiometry/narrow_band.h"
#include "radiometry/planck.h"
#include "radiometry/voigt.h"

namespace pyroscene::radiometry {
namespace {

constexpr double kElementaryCharge_C = 1.602176634e-19, kVacuumPermittivity_F_m = 8.8541878128e-12;
constexpr double kElectronMass_kg = 9.1093837015e-31, kAtomicMass_kg = 1.66053906660e-27;
/// e^2 / (4 eps0 m_e c): integrated absorption cross-section per oscillator [m2 Hz].
constexpr double kCrossSection_m2_Hz =
    kElementaryCharge_C * kElementaryCharge_C / (4.0 * kVacuumPermittivity_F_m * kElectronMass_kg * kLightSpeed_m_s);

double frequency_Hz(double lambda_um) noexcept { return kLightSpeed_m_s / (lambda_um * 1e-6); }

}  // namespace

AlkaliLines load_alkali_lines(const std::filesystem::path& path) {
    const auto table = read_csv(path);
    const auto column = [&](const char* name) {
        auto values = table.numbers(name);
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (!(values[i] > 0.0)) {
                throw input_error(fmt::format("{}:{}", table.path, table.row_lines[i]),
                                  fmt::format("{} = {}, expected a positive number", name, values[i]));
            }
        }
        return values;
    };
    const auto wavelength_nm = column("vacuum_wavelength_nm"), strength = column("f_ik"), mass_u = column("atomic_mass_u"),
               fwhm = column("gL_ref_cm1_per_atm"), reference_K = column("gL_Tref_K"), exponent = column("gL_n");
    AlkaliLines lines;
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        const auto& species = table.rows[i][table.column("species")];
        if (species != "K" && species != "Na") {
            throw input_error(fmt::format("{}:{}", table.path, table.row_lines[i]),
                              fmt::format("species '{}', expected K or Na", species));
        }
        (species == "K" ? lines.potassium : lines.sodium)
            .push_back({wavelength_nm[i] * 1e-3, strength[i], mass_u[i], fwhm[i], reference_K[i], exponent[i]});
    }
    if (lines.potassium.empty() || lines.sodium.empty())
        throw input_error(table.path, "expected at least one line of K and one of Na");
    return lines;
}

LineWidths line_widths(const AlkaliLine& line, double T_K, double pressure_atm) noexcept {
    const double nu_Hz = frequency_Hz(line.wavelength_um), mass_kg = line.mass_u * kAtomicMass_kg;
    const double gauss_Hz =
        nu_Hz * std::sqrt(8.0 * std::log(2.0) * kBoltzmann_J_K * T_K / (mass_kg * kLightSpeed_m_s * kLightSpeed_m_s));
    const double lorentz_per_cm =
        line.collision_fwhm_per_cm_atm * pressure_atm * std::pow(line.collision_reference_K / T_K, line.collision_exponent);
    return {gauss_Hz, kLightSpeed_m_s * 100.0 * lorentz_per_cm};
}

double line_absorption_per_m(const AlkaliLine& line, double lambda_um, double T_K, double mole_fraction,
                             double pressure_atm) noexcept {
    if (!(mole_fraction > 0.0 && pressure_atm > 0.0 && T_K > 0.0)) return 0.0;
    const double atoms_per_m3 = mole_fraction * pressure_atm * kAtmosphere_Pa / (kBoltzmann_J_K * T_K);
    const double centre_Hz = frequency_Hz(line.wavelength_um);
    // c (1/a - 1/b) = c (b - a) / (a b): no cancellation close to the centre.
    const double offset_Hz = kLightSpeed_m_s * 1e6 * (line.wavelength_um - lambda_um) / (line.wavelength_um * lambda_um);
    const double stimulated = -std::expm1(-kPlanck_J_s * centre_Hz / (kBoltzmann_J_K * T_K));
    const LineWidths widths = line_widths(line, T_K, pressure_atm);
    return kCrossSection_m2_Hz * line.oscillator_strength * atoms_per_m3 * stimulated *
           voigt_profile_per_Hz(offset_Hz, widths.gauss_Hz, widths.lorentz_Hz);
}

double doublet_absorption_per_m(std::span<const AlkaliLine> lines, double lambda_um, double T_K, double mole_fraction,
                                double pressure_atm) noexcept {
    double sum = 0.0;
    for (const auto& line : lines) {
        if (std::abs(lambda_um - line.wavelength_um) < kAlkaliReach_um)
            sum += line_absorption_per_m(line, lambda_um, T_K, mole_fraction, pressure_atm);
    }
    return sum;
}

double alkali_absorption_per_m(const AlkaliLines& lines, double lambda_um, double T_K, const FlameGas& gas) noexcept {
    return doublet_absorption_per_m(lines.potassium, lambda_um, T_K, 1e-6 * gas.potassium_ppm, pressure_atm(gas)) +
           doublet_absorption_per_m(lines.sodium, lambda_um, T_K, 1e-6 * gas.sodium_ppm, pressure_atm(gas));
}

std::vector<double> doublet_wavelengths_um(std::span<const AlkaliLine> lines, double lower_um, double upper_um) {
    constexpr double kCore_um = 1e-7, kGrowth = 1.04;  // a tenth of the narrowest width; wings by 4 %
    std::vector<double> points{lower_um, upper_um};
    for (const auto& line : lines) {
        points.push_back(line.wavelength_um);
        double offset = 0.0, step = kCore_um;
        while (offset < upper_um - lower_um) {
            offset += step;
            step = std::max(kCore_um, (kGrowth - 1.0) * offset);
            points.push_back(line.wavelength_um - offset);
            points.push_back(line.wavelength_um + offset);
        }
    }
    std::erase_if(points, [&](double x) { return !(x >= lower_um && x <= upper_um); });
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    return points;
}

double equivalent_width_um(std::span<const AlkaliLine> lines, double x_path_m, double T_K, double pressure_atm) {
    if (lines.empty() || !(x_path_m > 0.0)) return 0.0;
    double first = lines.front().wavelength_um, last = first;
    for (const auto& line : lines) {
        first = std::min(first, line.wavelength_um);
        last = std::max(last, line.wavelength_um);
    }
    const auto x = doublet_wavelengths_um(lines, first - kAlkaliReach_um, last + kAlkaliReach_um);
    double sum = 0.0, before = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double absorbed = -std::expm1(-doublet_absorption_per_m(lines, x[i], T_K, x_path_m, pressure_atm));
        if (i > 0) sum += 0.5 * (absorbed + before) * (x[i] - x[i - 1]);
        before = absorbed;
    }
    return sum;
}

namespace {

constexpr int kPathNodes = 145, kTemperatureNodes = 13;  // 16 to a decade; 800 to 2000 K
constexpr double kLeastPath_m = 1e-12, kLargestPath_m = 1e-3, kColdest_K = 800.0, kHottest_K = 2000.0;

}  // namespace

EquivalentWidthTable::EquivalentWidthTable(std::span<const AlkaliLine> lines, double pressure_atm) {
    for (int t = 0; t < kTemperatureNodes; ++t) {
        const double T_K = kColdest_K * std::pow(kHottest_K / kColdest_K, t / (kTemperatureNodes - 1.0));
        for (int p = 0; p < kPathNodes; ++p) {
            const double x_path_m = kLeastPath_m * std::pow(kLargestPath_m / kLeastPath_m, p / (kPathNodes - 1.0));
            ln_width_.push_back(std::log(equivalent_width_um(lines, x_path_m, T_K, pressure_atm)));
        }
    }
}

double EquivalentWidthTable::at_um(double x_path_m, double T_K) const noexcept {
    if (!(x_path_m > 0.0)) return 0.0;
    const auto place = [](double value, double low, double high, int nodes) {
        return std::clamp(std::log(value / low) / std::log(high / low), 0.0, 1.0) * (nodes - 1);
    };
    const double p = place(x_path_m, kLeastPath_m, kLargestPath_m, kPathNodes);
    const double t = place(T_K, kColdest_K, kHottest_K, kTemperatureNodes);
    const int p0 = std::min(static_cast<int>(p), kPathNodes - 2), t0 = std::min(static_cast<int>(t), kTemperatureNodes - 2);
    const double fp = p - p0, ft = t - t0;
    const auto at = [&](int ti, int pi) { return ln_width_[static_cast<std::size_t>(ti * kPathNodes + pi)]; };
    const double ln_width = (1.0 - ft) * ((1.0 - fp) * at(t0, p0) + fp * at(t0, p0 + 1)) +
                            ft * ((1.0 - fp) * at(t0 + 1, p0) + fp * at(t0 + 1, p0 + 1));
    return std::exp(ln_width) * std::min(1.0, x_path_m / kLeastPath_m);
}

double alkali_band_ratio(std::span<const AlkaliLine> lines, const Spectrum& response, double continuum_depth,
                         double x_path_m, double T_K, double pressure_atm) {
    auto x = doublet_wavelengths_um(lines, response.lambda_um.front(), response.lambda_um.back());
    x.insert(x.end(), response.lambda_um.begin(), response.lambda_um.end());
    std::sort(x.begin(), x.end());
    double area = 0.0, lines_area = 0.0, r_before = 0.0, line_before = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double r = response.at(x[i], false) * planck_radiance(x[i], T_K);
        const double in_line = -r * std::expm1(-doublet_absorption_per_m(lines, x[i], T_K, x_path_m, pressure_atm));
        if (i > 0) {
            area += 0.5 * (r + r_before) * (x[i] - x[i - 1]);
            lines_area += 0.5 * (in_line + line_before) * (x[i] - x[i - 1]);
        }
        r_before = r;
        line_before = in_line;
    }
    return 1.0 + std::exp(-continuum_depth) * lines_area / (-std::expm1(-continuum_depth) * area);
}

}  // namespace pyroscene::radiometry
