#include "inputs/front_inputs.h"

#include <cmath>
#include <limits>

#include "fire/flame_height.h"
#include "fire/gradients.h"
#include "fire/residence_time.h"
#include "gis/raster_input.h"
#include "spread/fuel_model.h"

namespace pyroscene::inputs {
namespace {

using scenario::RasterSource;
using scenario::Scenario;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

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

std::optional<Raster<float>> spread_rate(const Scenario& s, const MapGrid& grid, const SharedRaster<float>& arrival_s) {
    std::optional<Raster<float>> rate;
    if (arrival_s) rate = fire::spread_rate_m_s(*arrival_s, s.fire.flames.maximum_spread_rate_m_s);
    if (!s.inputs.spread_rate) return rate;
    auto given = read(*s.inputs.spread_rate, grid, gis::Resampling::Bilinear, "spread rate", "m s-1");
    for (std::size_t i = 0; rate && i < given.values.size(); ++i)
        if (std::isnan(given.values[i])) given.values[i] = rate->values[i];
    return given;
}

std::optional<Raster<float>> residence_time(const Scenario& s, const MapGrid& grid) {
    const auto& cover = s.inputs.cover;
    if (s.fire.flames.residence_time_s || !cover || !scenario::is_shipped_fuel_table(cover->table)) return std::nullopt;
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
    std::map<int, double> times_s;
    for (const auto& [number, model] : spread::standard_fuel_models())
        if (scenario::in_shipped_fuel_table(table, number))
            times_s[number] = fire::residence_time_s(model.characteristic_surface_to_volume_per_m());
    return times_s;
}

fire::FrontInputs load_front_inputs(const Scenario& scenario, const Raster<float>& terrain_m,
                                    const SharedRaster<float>& arrival_time_s, const ModelledFire* modelled) {
    const MapGrid& grid = terrain_m.grid;
    const auto& inputs = scenario.inputs;
    const Needs needs(scenario);
    fire::FrontInputs front;
    if (inputs.fireline_intensity)
        front.fireline_intensity_W_m =
            read(*inputs.fireline_intensity, grid, gis::Resampling::Bilinear, "fireline intensity", "W m-1");
    if (inputs.flame_length)
        front.flame_length_m = read(*inputs.flame_length, grid, gis::Resampling::Bilinear, "flame length", "m");
    if (modelled == nullptr && (needs.spread || inputs.spread_rate))
        front.spread_rate_m_s = spread_rate(scenario, grid, arrival_time_s);
    if (needs.fuel && inputs.fuel_load)
        front.fuel_load_kg_m2 = read(*inputs.fuel_load, grid, gis::Resampling::Conserve, "fuel load", "kg m-2");
    if (modelled != nullptr) {
        front.fireline_intensity_W_m = modelled->fireline_intensity_W_m;
        front.flame_length_m = modelled->flame_length_m;
        front.spread_rate_m_s = modelled->spread_rate_m_s;
        front.fuel_load_kg_m2 = modelled->fuel_load_kg_m2;
    }
    if (needs.residence) front.residence_time_s = residence_time(scenario, grid);
    if (scenario.fire.flames.tilt.slope) {
        auto slope = fire::terrain_slope(terrain_m);
        front.slope_east = std::move(slope.east);
        front.slope_north = std::move(slope.north);
    }
    return front;
}

}  // namespace pyroscene::inputs
