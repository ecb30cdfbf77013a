#include "inputs/scene_inputs.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/csv.h"
#include "base/error.h"
#include "base/files.h"
#include "inputs/arrival_model.h"
#include "inputs/flux_model.h"
#include "inputs/front_inputs.h"
#include "inputs/fuel_cells.h"
#include "inputs/spread_model.h"
#include "radiometry/surfaces.h"

namespace pyroscene::inputs {
namespace {

using scenario::RasterSource;
using scenario::Scenario;

int first_band(const RasterSource& source) { return source.bands.empty() ? 1 : source.bands.front(); }

/// Which row of scar.by_cover holds in each cell; no values when there is no such table.
Raster<std::uint8_t> scar_classes(const Scenario& scenario, const MapGrid& grid) {
    const auto& scars = scenario.fire.scar_of_cover;
    if (scars.empty() || !scenario.inputs.cover) return {};
    std::map<int, std::uint8_t> class_of_code;
    for (const auto& scar : scars) class_of_code.emplace(scar.code, static_cast<std::uint8_t>(class_of_code.size() + 1));
    const auto& source = scenario.inputs.cover->raster;
    const auto codes = gis::read_classes(source.files.front(), first_band(source), grid, -9999);
    Raster<std::uint8_t> classes(grid, "scar class", "1");
    for (std::size_t i = 0; i < codes.values.size(); ++i)
        if (const auto it = class_of_code.find(codes.values[i]); it != class_of_code.end()) classes.values[i] = it->second;
    return classes;
}

Raster<std::uint8_t> cover_materials(const Scenario& scenario, const MapGrid& grid, std::vector<std::string>& names) {
    names = {scenario.surface.unburned};
    Raster<std::uint8_t> cover(grid, "cover", "1", std::uint8_t{0});
    if (!scenario.inputs.cover) return cover;
    const auto& source = *scenario.inputs.cover;
    const auto codes = gis::read_classes(source.raster.files.front(), first_band(source.raster), grid, -9999);
    const bool shipped = scenario::is_shipped_fuel_table(source.table);
    const auto table = radiometry::load_fuel_surfaces(shipped ? data_folder() / "fuel" / "surface_of_fuel.csv"
                                                              : std::filesystem::path(source.table));
    std::map<int, std::uint8_t> index_of_code;
    for (std::size_t i = 0; i < codes.values.size(); ++i) {
        const int code = codes.values[i];
        auto known = index_of_code.find(code);
        if (known == index_of_code.end()) {
            auto name = radiometry::surface_of_fuel(
                table, shipped ? scenario::fuel_set_of(source.table, code) : std::string(), code);
            if (name.empty()) name = scenario.surface.unburned;
            auto position = std::find(names.begin(), names.end(), name);
            if (position == names.end()) position = names.insert(names.end(), name);
            known = index_of_code.emplace(code, static_cast<std::uint8_t>(position - names.begin())).first;
        }
        cover.values[i] = known->second;
    }
    return cover;
}

}  // namespace

std::vector<FrameSource> heat_flux_frames(const RasterSource& source) {
    auto frames = frame_bands(source);
    if (!source.times_s.empty()) {
        if (source.times_s.size() != frames.size())
            throw input_error("inputs.heat_flux.times_s",
                              fmt::format("{} times for {} frames of '{}'", source.times_s.size(), frames.size(),
                                          source.files.front().string()));
        for (std::size_t i = 0; i < frames.size(); ++i) frames[i].time_s = source.times_s[i];
    }
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const auto& frame = frames[i];
        if (std::isnan(frame.time_s))
            throw input_error(frame.file.string(),
                              fmt::format("band {} has no 'time_s' metadata; set inputs.heat_flux.times_s", frame.band));
        if (i > 0 && !(frame.time_s > frames[i - 1].time_s))
            throw input_error(frame.file.string(), fmt::format("frame times must ascend: {} s follows {} s (band {})",
                                                               frame.time_s, frames[i - 1].time_s, frame.band));
    }
    return frames;
}

SceneInputs load_scene_inputs(const Scenario& scenario, const std::function<void(double)>& on_progress) {
    SceneInputs in;
    const auto& terrain = scenario.inputs.terrain;
    in.grid = gis::make_map_grid(terrain.files.front(), scenario.map_crs, scenario.map_cell_m);
    in.terrain_m =
        gis::read_band({terrain.files.front(), first_band(terrain), gis::Resampling::Bilinear, "terrain", "m"}, in.grid);
    double sum = 0.0;
    std::size_t count = 0;
    in.lowest_m = 1e30;
    in.highest_m = -1e30;
    for (float& height : in.terrain_m.values) {
        height += static_cast<float>(scenario.geoid_undulation_m);
        if (std::isnan(height)) continue;
        in.lowest_m = std::min(in.lowest_m, static_cast<double>(height));
        in.highest_m = std::max(in.highest_m, static_cast<double>(height));
        sum += height;
        ++count;
    }
    in.mean_height_m = sum / static_cast<double>(count);
    in.wind_levels = wind_levels(scenario, in.grid);
    const WindLevels* const levels = in.wind_levels ? &*in.wind_levels : nullptr;
    if (scenario.inputs.arrival_model) in.modelled = read_arrival_model(scenario, in.grid);
    if (scenario.inputs.spread)
        in.modelled = spread_own_fire(scenario, in.terrain_m, levels, [&](double time_s) {
            if (on_progress) on_progress(time_s / scenario.inputs.spread->frames.times_s.back());
        });
    if (in.modelled) {
        for (const double time_s : in.modelled->frames_s) in.frames.push_back({{}, 0, time_s});
        in.arrival_time_s = share(in.modelled->ground.arrival_time_s);
    } else {
        in.frames = heat_flux_frames(scenario.inputs.heat_flux);
    }
    in.cover = cover_materials(scenario, in.grid, in.cover_names);
    in.scar_class = scar_classes(scenario, in.grid);
    if (const auto& arrival = scenario.inputs.arrival)
        in.arrival_time_s = share(gis::read_band(
            {arrival->files.front(), first_band(*arrival), gis::Resampling::Bilinear, "arrival time", "s"}, in.grid));
    in.front = load_front_inputs(scenario, in.terrain_m, in.arrival_time_s, in.modelled ? &*in.modelled : nullptr);
    if (levels != nullptr) in.front.midflame_wind = levels->to_midflame;
    in.origin_m = {0.5 * (in.grid.west_m + in.grid.east_m()), 0.5 * (in.grid.south_m() + in.grid.north_m), 0.0};
    in.centre = gis::MapProjection(in.grid.crs_wkt).to_geodetic(in.origin_m.x, in.origin_m.y, in.mean_height_m);
    return in;
}

fire::FrameInputs load_frame(const Scenario& scenario, const SceneInputs& inputs, std::size_t frame) {
    const auto& source = inputs.frames[frame];
    fire::FrameInputs out;
    out.time_s = source.time_s;
    out.heat_flux_W_m2 =
        inputs.modelled
            ? heat_flux_W_m2(*inputs.modelled, source.time_s)
            : gis::read_band({source.file, source.band, gis::Resampling::Conserve, "heat flux", "W m-2"}, inputs.grid);
    out.arrival_time_s = inputs.arrival_time_s;
    out.front = &inputs.front;
    out.scar_class = inputs.scar_class;
    auto wind = wind_at(scenario, inputs.grid, inputs.frames.size(), frame, source.time_s,
                        inputs.wind_levels ? &*inputs.wind_levels : nullptr);
    out.wind_east_m_s = std::move(wind.east_m_s);
    out.wind_north_m_s = std::move(wind.north_m_s);
    return out;
}

std::size_t frame_at(const std::vector<FrameSource>& frames, double time_s, const std::string& acquisition_id) {
    std::size_t found = frames.size();
    for (std::size_t i = 0; i < frames.size() && frames[i].time_s <= time_s; ++i) found = i;
    if (found == frames.size())
        throw input_error(fmt::format("acquisition '{}'", acquisition_id),
                          fmt::format("time_s {} lies before the first frame ({} s)", time_s, frames.front().time_s));
    return found;
}

std::vector<std::filesystem::path> input_files(const Scenario& scenario) {
    const auto& in = scenario.inputs;
    std::vector<const RasterSource*> sources{&in.terrain};
    if (!in.spread && !in.arrival_model) sources.push_back(&in.heat_flux);
    if (in.fuel_load) sources.push_back(&*in.fuel_load);
    if (in.arrival) sources.push_back(&*in.arrival);
    for (const auto* source : {&in.fireline_intensity, &in.flame_length, &in.spread_rate})
        if (*source) sources.push_back(&**source);
    if (in.wind && in.wind->raster) sources.push_back(&*in.wind->raster);
    if (in.cover) sources.push_back(&in.cover->raster);
    std::set<std::filesystem::path> unique;
    if (in.wrf_sfire) unique.insert(in.wrf_sfire->files.begin(), in.wrf_sfire->files.end());
    if (in.wind && in.wind->windninja)
        for (const auto* files : {&in.wind->windninja->speed, &in.wind->windninja->angle})
            unique.insert(files->begin(), files->end());
    if (in.wind)
        for (const auto* trees : {&in.wind->canopy.cover, &in.wind->canopy.height_m})
            if (trees->raster) sources.push_back(&*trees->raster);
    if (in.wind && in.wind->table) unique.insert(*in.wind->table);
    if (in.landscape)
        for (const auto& file : files_of(in.landscape->fuel)) unique.insert(file);
    if (in.spread)
        for (const auto& file : spread_files(*in.spread)) unique.insert(file);
    if (in.arrival_model)
        for (const auto& file : arrival_model_files(*in.arrival_model)) unique.insert(file);
    if (in.flux_model)
        for (const auto& file : flux_model_files(*in.flux_model)) unique.insert(file);
    if (in.plume) unique.insert(in.plume->files.begin(), in.plume->files.end());
    for (const auto* source : sources) unique.insert(source->files.begin(), source->files.end());
    std::erase_if(unique, gis::is_in_memory);  // what WRF files are read through; they themselves are in the list
    return {unique.begin(), unique.end()};
}

}  // namespace pyroscene::inputs
