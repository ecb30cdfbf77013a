#include "pipeline/spread_output.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.h"
#include "gis/raster_output.h"

namespace pyroscene::pipeline {
namespace {

gis::OutputRaster on_grid(const MapGrid& grid, const std::string& fingerprint) {
    gis::OutputRaster out;
    out.cols = grid.cols;
    out.rows = grid.rows;
    out.grid = grid;
    out.metadata = {{"FINGERPRINT", fingerprint},
                    {"SOURCE", "pyroscene spread: Rothermel surface fire, not an observed fire"}};
    return out;
}

void write(const std::filesystem::path& path, const Raster<float>& raster, const std::string& fingerprint) {
    auto out = on_grid(raster.grid, fingerprint);
    out.bands.push_back({raster.name, raster.unit, {}, {}, {}});
    gis::write_geotiff(path, out, std::span<const float>(raster.values));
}

void check_size(const inputs::ModelledFire& fire) {
    constexpr double kMost_bytes = 8e9;
    const double bytes =
        4.0 * static_cast<double>(fire.frames_s.size() + 1) * static_cast<double>(fire.fuel_load_kg_m2.grid.size());
    if (bytes > kMost_bytes)
        throw input_error(
            "inputs.spread.frame_step_s",
            fmt::format("{} frames are {:.1f} GB in one file, expected at most {:.0f}; 'pyroscene run' does not "
                        "store them",
                        fire.frames_s.size(), bytes * 1e-9, kMost_bytes * 1e-9));
}

double largest(const std::optional<Raster<float>>& raster) {
    double most = 0.0;
    if (raster)
        for (const float v : raster->values)
            if (v > most) most = v;
    return most;
}

}  // namespace

void write_front_rasters(const inputs::ModelledFire& fire, const std::filesystem::path& folder,
                         const std::string& fingerprint) {
    write(folder / "arrival.tif", fire.ground.arrival_time_s, fingerprint);
    if (fire.spread_rate_m_s) write(folder / "spread_rate.tif", *fire.spread_rate_m_s, fingerprint);
    if (fire.fireline_intensity_W_m) write(folder / "fireline_intensity.tif", *fire.fireline_intensity_W_m, fingerprint);
    if (fire.flame_length_m) write(folder / "flame_length.tif", *fire.flame_length_m, fingerprint);
}

void write_fire_frames(const inputs::ModelledFire& fire, const std::filesystem::path& folder, const std::string& fingerprint,
                       const std::string& utc, const std::function<void(double)>& on_progress) {
    check_size(fire);
    const MapGrid& grid = fire.fuel_load_kg_m2.grid;
    auto flux = on_grid(grid, fingerprint), fuel = flux;
    flux.metadata["QUANTITY"] =
        fmt::format("sensible heat flux of the surface fire, mean over the {:g} s up to time_s", fire.mean_over_s);
    flux.metadata["TIME_REFERENCE"] = fuel.metadata["TIME_REFERENCE"] = "seconds after " + utc;
    fuel.bands.push_back({"fuel_load", "kg m-2", {}, {}, {{"time_s", "0"}}});
    std::vector<float> flux_values, fuel_values = fire.fuel_load_kg_m2.values;
    for (std::size_t i = 0; i < fire.frames_s.size(); ++i) {
        on_progress(static_cast<double>(i) / static_cast<double>(fire.frames_s.size()));
        const auto time = fmt::format("{}", fire.frames_s[i]);
        const auto now = inputs::heat_flux_W_m2(fire, fire.frames_s[i]),
                   left = inputs::fuel_left_kg_m2(fire, fire.frames_s[i]);
        flux.bands.push_back({"heat_flux " + time + " s", "W m-2", {}, {}, {{"time_s", time}}});
        fuel.bands.push_back({"fuel_load " + time + " s", "kg m-2", {}, {}, {{"time_s", time}}});
        flux_values.insert(flux_values.end(), now.values.begin(), now.values.end());
        fuel_values.insert(fuel_values.end(), left.values.begin(), left.values.end());
    }
    gis::write_geotiff(folder / "heat_flux.tif", flux, std::span<const float>(flux_values));
    gis::write_geotiff(folder / "fuel_load.tif", fuel, std::span<const float>(fuel_values));
}

void record_spread(RunReport& report, const inputs::ModelledFire& fire) {
    const double end_s = fire.frames_s.back();
    const auto& arrival = fire.ground.arrival_time_s;
    const auto burnt = std::count_if(arrival.values.begin(), arrival.values.end(), [](float t) { return !std::isnan(t); });
    report.record("spread/burnt_area_ha", 1e-4 * static_cast<double>(burnt) * arrival.grid.cell_area_m2());
    report.record("spread/largest_rate_m_s", largest(fire.spread_rate_m_s));
    report.record("spread/largest_fireline_intensity_kW_m", 1e-3 * largest(fire.fireline_intensity_W_m));
    report.record("spread/largest_flame_length_m", largest(fire.flame_length_m));
    report.record("spread/heat_released_J", inputs::heat_released_J(fire, end_s));
    if (fire.cells_with_limited_wind > 0)
        report.count("spread_cells_with_limited_wind", static_cast<std::int64_t>(fire.cells_with_limited_wind));
    const auto left = inputs::fuel_left_kg_m2(fire, end_s);
    double burnt_kg_m2 = 0.0;
    for (std::size_t i = 0; i < left.values.size(); ++i)
        burnt_kg_m2 += static_cast<double>(fire.fuel_load_kg_m2.values[i]) - left.values[i];
    report.record("spread/fuel_burnt_kg", burnt_kg_m2 * arrival.grid.cell_area_m2());
}

}  // namespace pyroscene::pipeline
