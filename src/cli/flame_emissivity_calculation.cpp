#include "cli/flame_emissivity_calculation.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "base/files.h"
#include "drawing/line_plot.h"
#include "radiometry/flame_optics.h"
#include "radiometry/planck.h"

namespace pyroscene::cli {
namespace {

const radiometry::FlameOptics& optics() {
    static const auto loaded = radiometry::load_flame_optics(data_folder() / "optical");
    return loaded;
}

/// Of one mixture and temperature, before a cold black background.
struct UniformFlame {
    double path_m = 0.0, temperature_K = 0.0;
    FlameGas gas;
    [[nodiscard]] radiometry::FlamePath at(double wavelength_um) const {
        radiometry::FlamePath path(optics(), wavelength_um);
        path.add(path_m, temperature_K, gas);
        return path;
    }
};

UniformFlame uniform_flame(const Arguments& a) {
    UniformFlame flame{a.not_negative("path_m"), a.positive("temperature_K"), {}};
    FlameGas& gas = flame.gas;
    gas.soot_volume_fraction = a.not_negative("soot_volume_fraction");
    gas.x_H2O = a.not_negative("x_h2o");
    gas.x_CO2 = a.not_negative("x_co2");
    gas.x_CO = a.not_negative("x_co");
    gas.x_CH4 = a.not_negative("x_ch4");
    gas.x_O2 = a.not_negative("x_o2");
    if (gas.x_N2() < 0.0)
        throw input_error("--x_h2o, --x_co2, --x_co, --x_ch4, --x_o2", "mole fractions sum to more than 1");
    gas.potassium_ppm = a.not_negative("potassium_ppm");
    gas.sodium_ppm = a.not_negative("sodium_ppm");
    gas.pressure_Pa = radiometry::kAtmosphere_Pa * a.positive("pressure_atm");
    return flame;
}

std::vector<double> compute(const Arguments& a) {
    const auto path = uniform_flame(a).at(a.positive("wavelength_um"));
    return {-std::expm1(-path.depth()), path.emitted_radiance()};
}

/// 0.35 to 15 um in steps of 0.1 %, and finer where lines of potassium and sodium stand.
std::vector<double> plot_wavelengths_um() {
    std::vector<double> lambda_um;
    for (double w = 0.35; w <= 15.0; w *= 1.001) lambda_um.push_back(w);
    for (const auto* lines : {&optics().alkali.potassium, &optics().alkali.sodium}) {
        double lower = lines->front().wavelength_um, upper = lower;
        for (const auto& line : *lines) {
            lower = std::min(lower, line.wavelength_um);
            upper = std::max(upper, line.wavelength_um);
        }
        const auto fine = radiometry::doublet_wavelengths_um(*lines, lower - radiometry::kAlkaliReach_um,
                                                             upper + radiometry::kAlkaliReach_um);
        lambda_um.insert(lambda_um.end(), fine.begin(), fine.end());
    }
    std::sort(lambda_um.begin(), lambda_um.end());
    return lambda_um;
}

void plot(const Arguments& a, const std::string& file) {
    const auto flame = uniform_flame(a);
    const auto lambda_um = plot_wavelengths_um();
    std::vector<double> emissivity, radiance, black;
    for (const double w : lambda_um) {
        const auto path = flame.at(w);
        emissivity.push_back(-std::expm1(-path.depth()));
        radiance.push_back(path.emitted_radiance());
        black.push_back(radiometry::planck_radiance(w, flame.temperature_K));
    }
    drawing::LinePlot upper, lower;
    upper.title = fmt::format("{} m of flame at {} K, soot {}, H2O {}, CO2 {}, CO {}, K {} ppm, Na {} ppm", a.text("path_m"),
                              a.text("temperature_K"), a.text("soot_volume_fraction"), a.text("x_h2o"), a.text("x_co2"),
                              a.text("x_co"), a.text("potassium_ppm"), a.text("sodium_ppm"));
    upper.x = lower.x = {"wavelength / um", true, {}, {}};
    upper.y = {"emissivity", false, 0.0, 1.0};
    upper.series = {{"", lambda_um, emissivity}};
    lower.y = {"radiance / W m-2 sr-1 um-1", true, 1e-4 * *std::max_element(black.begin(), black.end()), {}};
    lower.series = {{"flame", lambda_um, radiance}, {"black body", lambda_um, black}};
    drawing::write_line_plots(file, std::vector{upper, lower});
}

}  // namespace

Calculation flame_emissivity_calculation() {
    const FlameGas usual;  // that of a scenario that says nothing of its flames
    const auto words = [](double value) { return fmt::format("{:g}", value); };
    return {"flame-emissivity",
            "emissivity and radiance of a homogeneous flame (soot, hot gas, K and Na lines) at one vacuum wavelength",
            "--temperature_K 1100 --path_m 1 --wavelength_um 3.9",
            {{"wavelength_um", {}},
             {"temperature_K", {}},
             {"path_m", {}},
             {"soot_volume_fraction", words(usual.soot_volume_fraction)},
             {"x_h2o", words(usual.x_H2O)},
             {"x_co2", words(usual.x_CO2)},
             {"x_co", words(usual.x_CO)},
             {"x_ch4", words(usual.x_CH4)},
             {"x_o2", words(usual.x_O2)},
             {"potassium_ppm", words(usual.potassium_ppm)},
             {"sodium_ppm", words(usual.sodium_ppm)},
             {"pressure_atm", "1"}},
            {"emissivity", "radiance_W_m2_sr_um"},
            compute,
            plot,
            [](const Arguments&) { return plot_wavelengths_um(); }};
}

}  // namespace pyroscene::cli
