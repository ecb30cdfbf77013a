#include "pipeline/plume_scene.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/files.h"
#include "gis/raster_input.h"
#include "inputs/wrf_inputs.h"
#include "radiometry/smoke.h"

namespace pyroscene::pipeline {
namespace {

using scenario::PlumeSource;
using scenario::Scenario;

/// The file of the last moment at or before a time, as GDAL wants it named.
std::filesystem::path file_at(const PlumeSource& source, double time_s) {
    std::size_t found = 0;
    for (std::size_t i = 0; i < source.times_s.size(); ++i)
        if (source.times_s[i] <= time_s) found = i;
    if (!source.times_s.empty() && source.times_s.front() > time_s)
        throw input_error("inputs.plume.times_s", fmt::format("the first field is of {} s, needed is one at or before {} s",
                                                              source.times_s.front(), time_s));
    const auto& file = source.files[found];
    if (source.variable.empty()) return file;
    return fmt::format("NETCDF:\"{}\":{}", file.string(), source.variable);
}

/// A quantity of the input as excess over the air.
void to_excess_K(Raster<float>& level, PlumeSource::Quantity quantity, double air_K) {
    for (float& value : level.values) {
        if (quantity == PlumeSource::Quantity::Temperature) value = static_cast<float>(value - air_K);
        if (quantity == PlumeSource::Quantity::Buoyancy)
            value = static_cast<float>(fire::excess_of_buoyancy_K(value, air_K));
    }
}

radiometry::SmokeOptics smoke_of(const Scenario& scenario) {
    return radiometry::load_smoke_optics(data_folder() / "optical" / "smoke_optics_fine.csv", scenario.plume.smoke);
}

/// With the layers as concentrations.
fire::PlumeParameters parameters_of(const Scenario& scenario) {
    constexpr double kNominal_um = 0.55;
    auto p = scenario.plume.parameters;
    for (const auto& layer : scenario.plume.layers) {
        const double thickness_m = layer.top_m - layer.bottom_m;
        const double concentration_g_m3 =
            layer.concentration_g_m3
                ? *layer.concentration_g_m3
                : layer.optical_depth_550nm / thickness_m /
                      radiometry::smoke_coefficients(smoke_of(scenario), kNominal_um, 1.0).extinction_per_m;
        p.layers.push_back(
            {layer.bottom_m, layer.top_m, concentration_g_m3, layer.temperature_K.value_or(p.air_temperature_K)});
    }
    return p;
}

fire::FlameField plume_of_input(const Scenario& scenario, const fire::PlumeParameters& p, const inputs::SceneInputs& in,
                                double time_s) {
    const PlumeSource& source = *scenario.inputs.plume;
    const auto file = source.of_wrf ? inputs::wrf_plume_levels(scenario, time_s) : file_at(source, time_s);
    const auto bands = gis::read_band_list(file).size();
    if (bands != source.levels_m.size())
        throw input_error("inputs.plume.levels_m", fmt::format("{} heights, but '{}' has {} bands; each is a level",
                                                               source.levels_m.size(), file.string(), bands));
    const char* unit = source.quantity == PlumeSource::Quantity::Buoyancy ? "" : "K";
    std::vector<Raster<float>> levels;
    for (std::size_t b = 0; b < bands; ++b) {
        levels.push_back(gis::read_band({file, static_cast<int>(b) + 1, gis::Resampling::Bilinear, "plume", unit}, in.grid));
        to_excess_K(levels.back(), source.quantity, p.air_temperature_K);
    }
    return fire::plume_of_levels(levels, source.levels_m, in.terrain_m, p, in.origin_m);
}

}  // namespace

fire::FlameField make_plume(const Scenario& scenario, const inputs::SceneInputs& in, double time_s) {
    const auto p = parameters_of(scenario);
    if (scenario.inputs.plume) return plume_of_input(scenario, p, in, time_s);
    if (!scenario.plume.rise)
        return p.layers.empty() ? fire::FlameField{} : fire::layers_alone(in.terrain_m, p, in.origin_m);
    const auto frame = inputs::load_frame(scenario, in, inputs::frame_at(in.frames, time_s, "plume"));
    return fire::rising_plume(frame, in.terrain_m, p, in.origin_m);
}

void set_plume_optics(const Scenario& scenario, const radiometry::SpectralGrid& grid, render::SceneOptics& optics) {
    if (const auto& grey = scenario.plume.grey_absorption_per_m) {
        optics.smoke_extinction_per_m.assign(static_cast<std::size_t>(grid.size()), static_cast<float>(*grey));
        return;
    }
    optics.smoke_multiple_scattering = scenario.plume.multiple_scattering;
    const auto smoke = smoke_of(scenario);
    for (const double lambda_um : grid.lambda_um) {
        const auto at = radiometry::smoke_coefficients(smoke, lambda_um, 1.0);
        optics.smoke_extinction_per_m.push_back(static_cast<float>(at.extinction_per_m));
        optics.smoke_albedo.push_back(static_cast<float>(at.single_scattering_albedo));
        optics.smoke_asymmetry.push_back(static_cast<float>(at.asymmetry));
    }
}

}  // namespace pyroscene::pipeline
