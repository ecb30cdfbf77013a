#include "cli/flame_calculations.h"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/constants.h"
#include "base/error.h"
#include "base/files.h"
#include "fire/flame_height.h"
#include "fire/flame_tilt.h"
#include "radiometry/alkali.h"
#include "radiometry/alkali_thesis.h"

namespace pyroscene::cli {
namespace {

template <class Table>
std::vector<std::string> names_of(const Table& table) {
    std::vector<std::string> names;
    for (const auto& row : table) names.emplace_back(row.name);
    return names;
}

template <class Table>
const auto& row_of(const Table& table, const std::string& name) {
    for (const auto& row : table)
        if (row.name == name) return row;
    throw input_error("--method", fmt::format("'{}' is unknown; there are {}", name, fmt::join(names_of(table), ", ")));
}

fire::Physics physics(const Arguments& a) {
    const auto word = a.text("physics");
    if (word != "default" && word != "thesis")
        throw input_error("--physics", fmt::format("'{}' is neither default nor thesis", word));
    return word == "thesis" ? fire::Physics::Thesis : fire::Physics::Default;
}

double number_or(const Arguments& a, const std::string& name, double otherwise) {
    return a.has(name) ? a.number(name) : otherwise;
}

/// Given, or heat flux x area of the cell.
double heat_release_W(const Arguments& a) {
    if (a.has("heat_release_W") || !a.has("cell_area_m2")) return a.not_negative("heat_release_W");
    return a.not_negative("heat_flux_W_m2") * a.positive("cell_area_m2");
}

/// Given, or of the circle with the area of the cell.
double diameter_m(const Arguments& a) {
    if (a.has("diameter_m") || !a.has("cell_area_m2")) return a.positive("diameter_m");
    return std::sqrt(4.0 / kPi * a.positive("cell_area_m2"));
}

/// Given, or fireline intensity / heat flux.
double front_depth_m(const Arguments& a) {
    if (a.has("front_depth_m") || !a.has("heat_flux_W_m2")) return a.positive("front_depth_m");
    return 1e3 * a.not_negative("fireline_intensity_kW_m") / a.positive("heat_flux_W_m2");
}

double plume_coefficient(const Arguments& a) {
    if (a.has("plume_coefficient_m_kW")) return a.positive("plume_coefficient_m_kW");
    return fire::plume_coefficient_m_kW(a.positive("air_temperature_K"), a.positive("air_density_kg_m3"),
                                        a.positive("air_heat_capacity_J_kg_K"),
                                        a.positive("heat_of_combustion_J_kg") / a.positive("air_fuel_ratio"), physics(a));
}

std::vector<double> flame_height(const Arguments& a) {
    const auto& method = row_of(fire::kFlameHeightMethods, a.text("method"));
    fire::FlameHeightInputs in;
    switch (method.driver) {
        case fire::FlameDriver::HeatFlux:
            in.heat_flux_W_m2 = a.not_negative("heat_flux_W_m2");
            in.alpha = a.not_negative("alpha");
            in.volumetric_heat_release_W_m3 = a.positive("volumetric_heat_release_W_m3");
            break;
        case fire::FlameDriver::HeatRelease:
            in.heat_release_W = heat_release_W(a);
            in.diameter_m = diameter_m(a);
            in.plume_coefficient_m_kW = plume_coefficient(a);
            break;
        case fire::FlameDriver::FirelineIntensity:
            in.fireline_intensity_W_m = 1e3 * a.not_negative("fireline_intensity_kW_m");
            if (method.name == "finney_grumstrup") in.front_depth_m = front_depth_m(a);
            break;
        case fire::FlameDriver::Given:
            in.heat_flux_W_m2 = number_or(a, "heat_flux_W_m2", 1.0);
            in.constant_m = a.not_negative("constant_m");
            if (method.name == "raster") in.given_length_m = a.not_negative("flame_length_m");
            break;
    }
    const double size_m = method.size_m(in), tilt_rad = a.number("tilt_deg") * kDegree_rad;
    if (!(tilt_rad >= 0.0 && tilt_rad < 0.5 * kPi))
        throw input_error("--tilt_deg", fmt::format("is {}, must lie within 0 and 90", a.number("tilt_deg")));
    const double height_m = fire::vertical_height_m(method.extent, size_m, tilt_rad, a.not_negative("stand_height_m"));
    const bool is_height = method.extent == fire::FlameExtent::Height;
    return {height_m, is_height ? size_m / std::cos(tilt_rad) : size_m};
}

/// m'' D: given as its two factors, or fireline intensity / heat of combustion.
double burning_rate_kg_m_s(const Arguments& a) {
    if (a.has("burning_rate_kg_m2_s")) return a.not_negative("burning_rate_kg_m2_s") * a.positive("diameter_m");
    return 1e3 * a.not_negative("fireline_intensity_kW_m") / a.positive("heat_of_combustion_J_kg");
}

std::vector<double> flame_tilt(const Arguments& a) {
    const auto& method = row_of(fire::kFlameTiltMethods, a.text("method"));
    fire::TiltInputs in;
    in.wind_m_s = a.not_negative("wind_m_s");
    in.air_density_kg_m3 = a.positive("air_density_kg_m3");
    in.air_heat_capacity_J_kg_K = a.positive("air_heat_capacity_J_kg_K");
    in.air_temperature_K = a.positive("air_temperature_K");
    in.fuel_vapour_density_kg_m3 = a.positive("fuel_vapour_density_kg_m3");
    in.heat_of_combustion_J_kg = a.positive("heat_of_combustion_J_kg");
    in.physics = physics(a);
    const double slope_deg = a.number("slope_deg");
    if (!(std::abs(slope_deg) < 90.0))
        throw input_error("--slope_deg", fmt::format("is {}, must lie within -90 and 90", slope_deg));
    if (slope_deg != 0.0 && !method.has_slope)
        throw input_error("--slope_deg", fmt::format("method '{}' knows no slope", method.name));
    in.slope_rad = slope_deg * kDegree_rad;
    switch (method.driver) {
        case fire::TiltDriver::None:
            break;
        case fire::TiltDriver::FirelineIntensity:
            in.fireline_intensity_W_m = 1e3 * a.not_negative("fireline_intensity_kW_m");
            break;
        case fire::TiltDriver::BurningRate:
            in.burning_rate_kg_m_s = burning_rate_kg_m_s(a);
            break;
        case fire::TiltDriver::FlameSize:
            in.extent = a.has("flame_length_m") ? fire::FlameExtent::Length : fire::FlameExtent::Height;
            in.flame_size_m = a.has("flame_length_m") ? a.not_negative("flame_length_m") : a.not_negative("flame_height_m");
            break;
        case fire::TiltDriver::HeatRelease:
            in.heat_release_W = a.not_negative("heat_release_W");
            break;
    }
    return {method.tilt_rad(in) / kDegree_rad};
}

}  // namespace

Calculation flame_height_calculation() {
    return {"flame-height",
            fmt::format("vertical height and length along the leaning axis of a flame; methods {}",
                        fmt::join(names_of(fire::kFlameHeightMethods), ", ")),
            "--heat_flux_W_m2 5.92e6",
            {{"method", "heat_flux"},
             {"heat_flux_W_m2", {}, true},
             {"alpha", "1"},
             {"volumetric_heat_release_W_m3", "2e6"},
             {"cell_area_m2", {}, true},
             {"heat_release_W", {}, true},
             {"diameter_m", {}, true},
             {"plume_coefficient_m_kW", {}, true},
             {"heat_of_combustion_J_kg", "16515000"},
             {"air_fuel_ratio", "5.5"},
             {"air_density_kg_m3", "1.18"},
             {"air_heat_capacity_J_kg_K", "1005"},
             {"air_temperature_K", "300"},
             {"fireline_intensity_kW_m", {}, true},
             {"front_depth_m", {}, true},
             {"constant_m", "2"},
             {"flame_length_m", {}, true},
             {"tilt_deg", "0"},
             {"stand_height_m", "0"},
             {"physics", "default"}},
            {"height_m", "length_m"},
            flame_height};
}

Calculation flame_tilt_calculation() {
    return {"flame-tilt",
            fmt::format("flame tilt from the vertical; methods {}", fmt::join(names_of(fire::kFlameTiltMethods), ", ")),
            "--wind_m_s 3 --fireline_intensity_kW_m 500",
            {{"method", "buoyant_velocity"},
             {"wind_m_s", {}},
             {"fireline_intensity_kW_m", {}, true},
             {"flame_height_m", {}, true},
             {"flame_length_m", {}, true},
             {"heat_release_W", {}, true},
             {"burning_rate_kg_m2_s", {}, true},
             {"diameter_m", {}, true},
             {"slope_deg", "0"},
             {"air_density_kg_m3", "1.18"},
             {"air_heat_capacity_J_kg_K", "1005"},
             {"air_temperature_K", "300"},
             {"fuel_vapour_density_kg_m3", "0.36"},
             {"heat_of_combustion_J_kg", "16515000"},
             {"physics", "default"}},
            {"tilt_deg"},
            flame_tilt};
}

Calculation thesis_potassium_calculation() {
    return {"thesis-potassium",
            "potassium lines as appendix A of the thesis computes them, kept for its figures; flame-emissivity has the "
            "model to use",
            "--temperature_K 1100",
            {{"temperature_K", {}}, {"emissivity", "1"}},
            {"ionised_fraction", "power_W", "ratio_766", "ratio_770"},
            [](const Arguments& a) {
                const radiometry::ThesisPotassium gas;
                const double T_K = a.positive("temperature_K"), emissivity = a.positive("emissivity");
                return std::vector{radiometry::thesis_ionised_fraction(gas, T_K),
                                   radiometry::thesis_potassium_power_W(gas, T_K),
                                   radiometry::thesis_potassium_ratio(gas, T_K, emissivity, 766.40, 766.60),
                                   radiometry::thesis_potassium_ratio(gas, T_K, emissivity, 769.80, 770.00)};
            }};
}

Calculation alkali_width_calculation() {
    return {"alkali-width",
            "equivalent width of the doublets of potassium (767, 770 nm) and sodium (589 nm) in a homogeneous flame",
            "--temperature_K 1100 --path_m 1",
            {{"temperature_K", {}}, {"path_m", {}}, {"potassium_ppm", "1"}, {"sodium_ppm", "0"}, {"pressure_atm", "1"}},
            {"potassium_nm", "sodium_nm"},
            [](const Arguments& a) {
                static const auto lines = radiometry::load_alkali_lines(data_folder() / "optical" / "alkali_lines.csv");
                const double T_K = a.positive("temperature_K"), path_m = a.positive("path_m"),
                             pressure_atm = a.positive("pressure_atm");
                const auto width_nm = [&](const auto& doublet, const char* ppm) {
                    return 1e3 *
                           radiometry::equivalent_width_um(doublet, 1e-6 * a.not_negative(ppm) * path_m, T_K, pressure_atm);
                };
                return std::vector{width_nm(lines.potassium, "potassium_ppm"), width_nm(lines.sodium, "sodium_ppm")};
            }};
}

}  // namespace pyroscene::cli
