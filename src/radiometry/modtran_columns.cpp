#include "radiometry/modtran_columns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/constants.h"
#include "base/csv.h"
#include "base/error.h"

namespace pyroscene::radiometry {
namespace {

struct UnitName {
    SpectralUnit unit;
    const char* name;
};
constexpr std::array<UnitName, 7> kUnits{{{SpectralUnit::PerWavenumber, "W_cm2_cm-1"},
                                          {SpectralUnit::PerMicrometre, "W_cm2_um"},
                                          {SpectralUnit::PerNanometre, "W_cm2_nm"},
                                          {SpectralUnit::MicrowattPerNanometre, "uW_cm2_nm"},
                                          {SpectralUnit::MilliwattPerNanometreM2, "mW_m2_nm"},
                                          {SpectralUnit::WattPerNanometreM2, "W_m2_nm"},
                                          {SpectralUnit::Product, "W_m2_um"}}};

const std::vector<double>* find(const ModtranColumns& c, std::initializer_list<const char*> names) {
    for (const char* name : names)
        if (const auto it = c.columns.find(name); it != c.columns.end()) return &it->second;
    return nullptr;
}

std::vector<double> sum_of(const ModtranColumns& c, const char* whole, const char* a, const char* b) {
    if (const auto* column = find(c, {whole})) return *column;
    const auto *first = find(c, {a}), *second = find(c, {b});
    if (first == nullptr && second == nullptr) return {};
    std::vector<double> out(c.x.size(), 0.0);
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = (first != nullptr ? (*first)[i] : 0.0) + (second != nullptr ? (*second)[i] : 0.0);
    return out;
}

std::vector<double> copy_of(const std::vector<double>* column) {
    return column != nullptr ? *column : std::vector<double>{};
}

double wavelength_um(ModtranColumns::Abscissa abscissa, double x) noexcept {
    switch (abscissa) {
        case ModtranColumns::Abscissa::Wavenumber:
            return 1e4 / x;
        case ModtranColumns::Abscissa::Micrometre:
            return x;
        case ModtranColumns::Abscissa::Nanometre:
            return 1e-3 * x;
    }
    return x;
}

/// Median over the samples of the file's sun divided by the sun.
double sun_ratio(const AtmosphereRun& run, SpectralUnit unit, const Spectrum& sun) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < run.wavelength_um.size(); ++i) {
        const double lambda = run.wavelength_um[i], E = sun.at(lambda);
        if (lambda < sun.lambda_um.front() || lambda > sun.lambda_um.back() || !(E > 0.0) || !(run.toa_irradiance[i] > 0.0))
            continue;
        ratios.push_back(run.toa_irradiance[i] * to_product_unit(unit, lambda) / E);
    }
    if (ratios.empty()) return 1.0;
    const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
    std::nth_element(ratios.begin(), middle, ratios.end());
    return *middle;
}

bool resembles_sun(double ratio) noexcept { return ratio > 0.5 && ratio < 2.0; }

SpectralUnit unit_of(const ModtranColumns& c, const AtmosphereRun& raw, const RunHints& hints, const Spectrum& sun) {
    using Abscissa = ModtranColumns::Abscissa;
    const auto told = hints.unit ? hints.unit : c.unit;
    const SpectralUnit unit = told                                 ? *told
                              : c.abscissa == Abscissa::Wavenumber ? SpectralUnit::PerWavenumber
                              : c.abscissa == Abscissa::Micrometre ? SpectralUnit::PerMicrometre
                                                                   : SpectralUnit::MicrowattPerNanometre;
    if (raw.toa_irradiance.empty()) return unit;
    const double ratio = sun_ratio(raw, unit, sun);
    if (resembles_sun(ratio)) return unit;
    std::string fitting;
    for (const auto& [other, name] : kUnits)
        if (resembles_sun(sun_ratio(raw, other, sun))) {
            if (!told) return other;
            fitting = fmt::format("; with {} it would fit", name);
        }
    throw input_error(c.source, fmt::format("read as {}, the sun at the top of the atmosphere is {:.3g} times what it is{}",
                                            spectral_unit_name(unit), ratio, fitting));
}

void check_values(const AtmosphereRun& run) {
    const auto check = [&](const char* name, const std::vector<double>& values, double maximum) {
        for (std::size_t i = 0; i < values.size(); ++i)
            if (!(values[i] >= -1e-9 && values[i] <= maximum))
                throw input_error(run.source, fmt::format("{} {} at {:.6g} um, expected 0 to {}", name, values[i],
                                                          run.wavelength_um[i], maximum));
    };
    check("transmittance", run.transmittance, 1.0 + 1e-6);
    check("path thermal radiance", run.path_thermal, 1e6);
    check("path solar radiance", run.path_solar, 1e6);
    check("ground reflected radiance", run.ground_reflected, 1e6);
    check("direct reflected radiance", run.direct_reflected, 1e6);
    check("sun at the top of the atmosphere", run.toa_irradiance, 1e5);
}

/// The columns are printed with three to five digits; a larger misfit means that they were taken for each other.
void check_sum(const AtmosphereRun& run, const std::vector<double>& surface) {
    if (run.total_radiance.empty() || run.path_thermal.empty()) return;
    for (std::size_t i = 0; i < run.total_radiance.size(); ++i) {
        const auto term = [&](const std::vector<double>& v) { return v.empty() ? 0.0 : v[i]; };
        const double sum = run.path_thermal[i] + term(surface) + term(run.path_solar) + term(run.ground_reflected);
        if (std::abs(sum - run.total_radiance[i]) > 0.005 * run.total_radiance[i] + 1e-9)
            throw input_error(
                run.source,
                fmt::format("at {:.6g} um the terms sum to {:.5g} but the total radiance is {:.5g} W m-2 sr-1 um-1; "
                            "columns are missing or shifted",
                            run.wavelength_um[i], sum, run.total_radiance[i]));
    }
}

}  // namespace

double to_product_unit(SpectralUnit unit, double lambda_um) noexcept {
    switch (unit) {
        case SpectralUnit::PerWavenumber:
            return 1e8 / (lambda_um * lambda_um);
        case SpectralUnit::PerMicrometre:
            return 1e4;
        case SpectralUnit::PerNanometre:
            return 1e7;
        case SpectralUnit::MicrowattPerNanometre:
            return 10.0;
        case SpectralUnit::WattPerNanometreM2:
            return 1e3;
        case SpectralUnit::MilliwattPerNanometreM2:
        case SpectralUnit::Product:
            return 1.0;
    }
    return 1.0;
}

SpectralUnit spectral_unit(std::string_view name, const std::string& subject) {
    std::vector<std::string> names;
    for (const auto& [unit, known] : kUnits) {
        if (name == known) return unit;
        names.emplace_back(known);
    }
    throw input_error(subject, fmt::format("'{}' is unknown; there are {}", name, fmt::join(names, ", ")));
}

std::string spectral_unit_name(SpectralUnit unit) {
    for (const auto& [known, name] : kUnits)
        if (known == unit) return name;
    return {};
}

void RunGeometry::complete_with(const RunGeometry& other) {
    const auto complete = [](std::optional<double>& mine, const std::optional<double>& theirs) {
        if (!mine) mine = theirs;
    };
    complete(sensor_altitude_km, other.sensor_altitude_km);
    complete(view_zenith_deg, other.view_zenith_deg);
    complete(sun_zenith_deg, other.sun_zenith_deg);
    complete(relative_azimuth_deg, other.relative_azimuth_deg);
    complete(albedo, other.albedo);
    complete(ground_elevation_km, other.ground_elevation_km);
    complete(visibility_km, other.visibility_km);
    complete(surface_temperature_K, other.surface_temperature_K);
    complete(day_of_year, other.day_of_year);
}

void sort_by_wavelength(AtmosphereRun& run) {
    const auto lambda = run.wavelength_um;
    std::vector<std::size_t> order(lambda.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return lambda[a] < lambda[b]; });
    for (auto* array :
         {&run.transmittance, &run.path_thermal, &run.path_solar, &run.ground_reflected, &run.direct_reflected,
          &run.total_radiance, &run.toa_irradiance, &run.two_way_irradiance, &run.direct_normal, &run.diffuse,
          &run.thermal_sky, &run.spherical_albedo, &run.diffuse_transmittance, &run.correlation, &run.wavelength_um}) {
        if (array->empty()) continue;
        std::vector<double> sorted(order.size());
        for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = (*array)[order[i]];
        *array = std::move(sorted);
    }
    for (std::size_t i = 1; i < run.wavelength_um.size(); ++i)
        if (!(run.wavelength_um[i] > run.wavelength_um[i - 1]))
            throw input_error(run.source, fmt::format("wavelength {:.6g} um occurs twice", run.wavelength_um[i]));
}

std::string normalised_name(std::string_view name) {
    std::string out;
    for (const char c : name) {
        if (c >= 'a' && c <= 'z')
            out += static_cast<char>(c - 'a' + 'A');
        else if ((c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'))
            out += c;
    }
    return out;
}

std::optional<double> fortran_number(std::string_view field) {
    const auto first = field.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return std::nullopt;
    std::string text(field.substr(first, field.find_last_not_of(" \t\r") - first + 1));
    // 1.234-101 is how Fortran prints an exponent of three digits in a field for two; D marks double precision.
    for (std::size_t i = 1; i < text.size(); ++i) {
        if (text[i] == 'D' || text[i] == 'd') text[i] = 'E';
        const bool sign = text[i] == '-' || text[i] == '+';
        if (sign && (std::isdigit(static_cast<unsigned char>(text[i - 1])) != 0 || text[i - 1] == '.'))
            text.insert(i, 1, 'E');
    }
    try {
        return parse_number(text, "");
    } catch (const Error&) {
        return std::nullopt;
    }
}

AtmosphereRun to_run(const ModtranColumns& c, const RunHints& hints, const Spectrum& sun) {
    AtmosphereRun run;
    run.source = c.source;
    run.looks_up = c.looks_up;
    run.geometry = hints.geometry;
    run.geometry.complete_with(c.geometry);
    if (c.x.size() < 2) throw input_error(c.source, fmt::format("{} spectral samples, expected at least 2", c.x.size()));
    for (const double x : c.x) {
        if (!(x > 0.0)) throw input_error(c.source, fmt::format("spectral position {}, expected a positive number", x));
        run.wavelength_um.push_back(wavelength_um(c.abscissa, x));
    }
    run.transmittance = copy_of(find(c, {"TOTTRANS", "COMBINTRANS", "TRANS", "TOTALTRANS"}));
    run.path_thermal = sum_of(c, "PTHTHRML", "THRMLEM", "THRMLSCT");
    run.path_solar = sum_of(c, "SOLSCAT", "MULTSCAT", "SINGSCAT");
    run.ground_reflected = copy_of(find(c, {"GRNDRFLT"}));
    run.direct_reflected = copy_of(find(c, {"DRCTRFLT"}));
    run.total_radiance = copy_of(find(c, {"TOTALRAD"}));
    run.toa_irradiance = copy_of(find(c, {"TOASUN", "TOARAD", "SOLAR"}));
    run.two_way_irradiance = copy_of(find(c, {"REFSOL"}));
    run.direct_normal = copy_of(find(c, {"SOLTR"}));
    auto surface = copy_of(find(c, {"SURFEMIS"}));
    if (run.transmittance.empty()) {
        std::vector<std::string> names;
        for (const auto& [name, values] : c.columns) names.push_back(name);
        throw input_error(c.source, fmt::format("no column of the total transmittance; found {}", fmt::join(names, ", ")));
    }
    const auto unit = unit_of(c, run, hints, sun);
    for (auto* array : {&run.path_thermal, &run.path_solar, &run.ground_reflected, &run.direct_reflected,
                        &run.total_radiance, &run.toa_irradiance, &run.two_way_irradiance, &run.direct_normal, &surface})
        for (std::size_t i = 0; i < array->size(); ++i) (*array)[i] *= to_product_unit(unit, run.wavelength_um[i]);
    check_values(run);
    check_sum(run, surface);
    sort_by_wavelength(run);
    for (double& tau : run.transmittance) tau = std::clamp(tau, 0.0, 1.0);
    run.includes_thermal = !run.path_thermal.empty();
    const auto lit = [](const std::vector<double>& v) {
        return std::any_of(v.begin(), v.end(), [](double x) { return x > 0.0; });
    };
    run.includes_sun = lit(run.path_solar) || lit(run.direct_reflected);
    return run;
}

double zenith_at_ground_deg(double zenith_at_sensor_deg, double sensor_altitude_km, double ground_km) {
    const double nadir_rad = (180.0 - zenith_at_sensor_deg) * kDegree_rad;
    const double sine =
        std::sin(nadir_rad) * (kModtranEarthRadius_km + sensor_altitude_km) / (kModtranEarthRadius_km + ground_km);
    return std::asin(std::min(sine, 1.0)) / kDegree_rad;
}

void set_geometry(const ModtranGeometry& from, RunGeometry& to, bool& looks_up) {
    to.ground_elevation_km = from.ground_km;
    if (from.visibility_km > 0.0) to.visibility_km = from.visibility_km;
    if (from.albedo >= 0.0 && from.albedo <= 1.0) to.albedo = from.albedo;
    if (from.itype == 2 || from.itype == 3) {
        constexpr double kTop_km = 100.0;  // of MODTRAN's atmosphere
        looks_up = from.zenith_deg < 90.0;
        const double upper_km = looks_up ? (from.itype == 3 || from.h2_km <= from.h1_km ? kTop_km : from.h2_km) : from.h1_km;
        to.sensor_altitude_km = std::min(upper_km, kTop_km) - from.ground_km;
        to.view_zenith_deg = looks_up ? from.zenith_deg : zenith_at_ground_deg(from.zenith_deg, from.h1_km, from.ground_km);
    }
    if (from.day_of_year > 0) to.day_of_year = from.day_of_year;
    if (from.with_sun && (from.iparm == 2 || from.iparm == 12)) {
        to.sun_zenith_deg = from.parm2;
        if (from.iparm != 2) return;  // 12: both angles at H2, where manuals differ on what the azimuth counts from
        const double azimuth_rad = std::abs(std::remainder(from.parm1, 360.0)) * kDegree_rad;
        to.relative_azimuth_deg = azimuth_rad / kDegree_rad;
        if (looks_up || !to.view_zenith_deg) return;
        // 2: at the sensor, whose vertical leans from that of the target by the angle between them at the Earth's centre.
        const double lean = (*to.view_zenith_deg - (180.0 - from.zenith_deg)) * kDegree_rad, sun = from.parm2 * kDegree_rad;
        const double cosine = std::cos(lean) * std::cos(sun) + std::sin(lean) * std::sin(sun) * std::cos(azimuth_rad);
        to.sun_zenith_deg = std::acos(std::clamp(cosine, -1.0, 1.0)) / kDegree_rad;
    }
}

}  // namespace pyroscene::radiometry
