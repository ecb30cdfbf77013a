#include "cli/spread_calculation.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/csv.h"
#include "base/error.h"
#include "spread/rothermel.h"

namespace pyroscene::cli {
namespace {

/// The model with a number of the shipped table, or of the file of --fuel_models.
const spread::FuelModel& fuel_model(const Arguments& a) {
    static std::map<std::string, spread::FuelModels> files;  // stays between the rows of a CSV file
    const auto* models = &spread::standard_fuel_models();
    if (a.has("fuel_models")) {
        const auto file = a.text("fuel_models");
        auto known = files.find(file);
        if (known == files.end()) known = files.emplace(file, spread::read_fuel_models(file)).first;
        models = &known->second;
    }
    const double number = a.number("fuel_model");
    const auto found = models->find(number == std::floor(number) ? static_cast<int>(number) : 0);
    if (found == models->end())
        throw input_error("--fuel_model", fmt::format("there is no fuel model {}; the table has {} from {} to {}", number,
                                                      models->size(), models->begin()->first, models->rbegin()->first));
    return found->second;
}

double midflame_wind_m_s(const Arguments& a, const spread::FuelModel& model) {
    constexpr double kFastest_m_s = 200.0;
    const double wind_m_s = a.within("wind_m_s", 0.0, kFastest_m_s);
    const auto mode = a.text("wind_mode");
    if (mode == "midflame") return wind_m_s;
    if (mode != "20ft" && mode != "10m")
        throw input_error("--wind_mode", fmt::format("'{}' is none of midflame, 20ft, 10m", mode));
    const spread::Canopy canopy{a.within("canopy_cover", 0.0, 1.0), a.within("canopy_height_m", 0.0, 150.0),
                                a.within("crown_ratio", 0.0, 1.0)};
    return wind_m_s * spread::wind_adjustment(model.depth_m, canopy) /
           (mode == "10m" ? spread::kTenMetresToTwentyFeet : 1.0);
}

spread::Curing curing(const Arguments& a) {
    const auto word = a.text("curing");
    if (word != "behave" && word != "linear")
        throw input_error("--curing", fmt::format("'{}' is neither behave nor linear", word));
    return word == "behave" ? spread::Curing::BehavePlus : spread::Curing::Linear;
}

std::vector<double> spread_behaviour(const Arguments& a) {
    constexpr double kWettest_pct = 1000.0;
    const auto& model = fuel_model(a);
    spread::Moistures moisture{};
    const char* const names[] = {"m1h_pct", "m10h_pct", "m100h_pct", "mherb_pct", "mwoody_pct"};
    for (std::size_t i = 0; i < moisture.size(); ++i) moisture[i] = a.within(names[i], 0.0, kWettest_pct) / 100.0;
    const auto bed = spread::fuel_bed(model, moisture, curing(a));
    // -1 is how fuel layers mark the aspect of level ground.
    const double aspect_deg = a.within("aspect_deg", -1.0, 360.0), from_deg = a.within("wind_from_deg", -360.0, 360.0);
    const double slope_rad = a.within("slope_deg", 0.0, 89.0) * kDegree_rad;
    const auto head = spread::head_fire(bed, midflame_wind_m_s(a, model), (from_deg - aspect_deg) * kDegree_rad,
                                        std::tan(slope_rad), a.within("wind_limit", 0, 1) != 0.0);
    const double intensity_W_m = bed.heat_J_m2 * head.rate_m_s;
    double direction_deg = std::fmod(aspect_deg + 540.0 + head.from_upslope_rad / kDegree_rad, 360.0);
    if (360.0 - direction_deg < 1e-9) direction_deg = 0.0;
    return {head.rate_m_s, direction_deg, 1e-3 * intensity_W_m, spread::flame_length_m(intensity_W_m), 1e-3 * bed.heat_J_m2};
}

}  // namespace

Calculation spread_calculation() {
    return {"spread",
            "surface fire of a fuel model (Rothermel 1972) in its fastest direction; wind from, aspect downslope, both "
            "clockwise "
            "from north; wind_mode midflame, 20ft or 10m",
            "--fuel_model 1 --m1h_pct 5 --m10h_pct 6 --m100h_pct 7 --mherb_pct 60 --mwoody_pct 90 --wind_m_s 2",
            {{"fuel_model", {}},
             {"m1h_pct", {}},
             {"m10h_pct", {}},
             {"m100h_pct", {}},
             {"mherb_pct", {}},
             {"mwoody_pct", {}},
             {"wind_mode", "midflame"},
             {"wind_m_s", {}},
             {"wind_from_deg", "0"},
             {"slope_deg", "0"},
             {"aspect_deg", "0"},
             {"canopy_cover", "0"},
             {"canopy_height_m", "0"},
             {"crown_ratio", "0"},
             {"curing", "behave"},
             {"wind_limit", "0"},
             {"fuel_models", {}, true}},
            {"ros_m_s", "dir_max_deg", "fli_kW_m", "flame_length_m", "hpua_kJ_m2"},
            spread_behaviour};
}

}  // namespace pyroscene::cli
