#include "pipeline/front_inputs.h"

#include <cmath>
#include <limits>
#include <vector>

#include "base/csv.h"
#include "base/files.h"
#include "fire/flame_height.h"
#include "fire/gradients.h"
#include "fire/residence_time.h"
#include "gis/raster_input.h"

namespace pyroscene::pipeline {
namespace {

using scenario::RasterSource;
using scenario::Scenario;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr int kLastAndersonModel = 13;  ///< the others of the table are Scott and Burgan's

Raster<float> read(const RasterSource& source, const MapGrid& grid, gis::Resampling how, const char* name,
                   const char* unit) {
    return gis::read_band({source.files.front(), source.bands.empty() ? 1 : source.bands.front(), how, name, unit}, grid);
}

/// Which rasters the relations of a scenario ask for.
struct Needs {
    bool fuel = false, spread = false, residence = false;

    explicit Needs(const Scenario& s) {
        const auto& flames = s.fire.flames;
        const auto* method = fire::find_flame_height_method(flames.height.method);
        const bool by_intensity = method != nullptr && method->driver == fire::FlameDriver::FirelineIntensity;
        fuel =
            flames.intensity == fire::IntensityRule::Fuel || (flames.intensity == fire::IntensityRule::Auto && by_intensity);
        residence = flames.depth == fire::DepthRule::ResidenceTime;
        spread = fuel || residence;
    }
};

std::optional<Raster<float>> spread_rate(const Scenario& s, const MapGrid& grid,
                                         const std::optional<Raster<float>>& arrival_s) {
    std::optional<Raster<float>> rate;
    if (arrival_s) rate = fire::spread_rate_m_s(*arrival_s, s.fire.flames.maximum_spread_rate_m_s);
    if (!s.inputs.spread_rate) return rate;
    auto given = read(*s.inputs.spread_rate, grid, gis::Resampling::Nearest, "spread rate", "m s-1");
    for (std::size_t i = 0; rate && i < given.values.size(); ++i)
        if (std::isnan(given.values[i])) given.values[i] = rate->values[i];
    return given;
}

std::optional<Raster<float>> residence_time(const Scenario& s, const MapGrid& grid) {
    const auto& cover = s.inputs.cover;
    if (s.fire.flames.residence_time_s || !cover || (cover->table != "fbfm13" && cover->table != "fbfm40"))
        return std::nullopt;
    const auto times_s = fuel_residence_times_s(cover->table);
    const auto codes = gis::read_classes(cover->raster.files.front(),
                                         cover->raster.bands.empty() ? 1 : cover->raster.bands.front(), grid, -9999);
    Raster<float> out(grid, "residence time", "s", kNaN);
    for (std::size_t i = 0; i < codes.values.size(); ++i)
        if (const auto found = times_s.find(codes.values[i]); found != times_s.end())
            out.values[i] = static_cast<float>(found->second);
    return out;
}

}  // namespace

std::map<int, double> fuel_residence_times_s(const std::string& table) {
    const auto csv = read_csv(data_folder() / "fuel" / "fuel_models_53.csv");
    const auto number = csv.numbers("number");
    std::vector<std::vector<double>> loads, ratios;
    for (const std::string size : {"1h", "10h", "100h", "herb", "woody"}) {
        loads.push_back(csv.numbers("load_" + size + "_kg_m2"));
        ratios.push_back(csv.numbers("sav_" + size + "_1_m"));
    }
    std::map<int, double> times_s;
    for (std::size_t i = 0; i < number.size(); ++i) {
        const int code = static_cast<int>(number[i]);
        if ((code <= kLastAndersonModel) != (table == "fbfm13")) continue;
        std::vector<fire::FuelParticles> bed;
        for (std::size_t size = 0; size < loads.size(); ++size) bed.push_back({loads[size][i], ratios[size][i]});
        const double time_s = fire::residence_time_s(fire::characteristic_surface_to_volume_per_m(bed));
        if (time_s > 0.0) times_s[code] = time_s;
    }
    return times_s;
}

fire::FrontInputs load_front_inputs(const Scenario& scenario, const Raster<float>& terrain_m,
                                    const std::optional<Raster<float>>& arrival_time_s) {
    const MapGrid& grid = terrain_m.grid;
    const auto& inputs = scenario.inputs;
    const Needs needs(scenario);
    fire::FrontInputs front;
    if (inputs.fireline_intensity)
        front.fireline_intensity_W_m =
            read(*inputs.fireline_intensity, grid, gis::Resampling::Nearest, "fireline intensity", "W m-1");
    if (inputs.flame_length)
        front.flame_length_m = read(*inputs.flame_length, grid, gis::Resampling::Nearest, "flame length", "m");
    if (needs.spread || inputs.spread_rate) front.spread_rate_m_s = spread_rate(scenario, grid, arrival_time_s);
    if (needs.fuel && inputs.fuel_load)
        front.fuel_load_kg_m2 = read(*inputs.fuel_load, grid, gis::Resampling::Conserve, "fuel load", "kg m-2");
    if (needs.residence) front.residence_time_s = residence_time(scenario, grid);
    if (scenario.fire.flames.tilt.slope) {
        auto slope = fire::terrain_slope(terrain_m);
        front.slope_east = std::move(slope.east);
        front.slope_north = std::move(slope.north);
    }
    return front;
}

}  // namespace pyroscene::pipeline
