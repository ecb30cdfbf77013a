#include "pipeline/optical_tables.h"

#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "base/files.h"
#include "gis/netcdf_input.h"

namespace pyroscene::pipeline {
namespace {

/// Heights above `ground_m` that enclose the relief, from the highest down. They lie at round elevations, among them those of the
/// shipped tables, between which these are bent.
std::vector<double> ground_heights_m(const inputs::SceneInputs& in, double ground_m) {
    constexpr double kStep_m = 250.0, kLevel_m = 20.0;
    if (!(in.highest_m - in.lowest_m > kLevel_m)) return {0.0};
    const double to_table_m = ground_m - in.mean_height_m;
    std::vector<double> heights_m;
    const double lowest = std::floor((in.lowest_m + to_table_m) / kStep_m);
    for (double step = std::ceil((in.highest_m + to_table_m) / kStep_m); step >= lowest; step -= 1.0)
        heights_m.push_back(step * kStep_m - ground_m);
    return heights_m;
}

radiometry::AtmosphereSet load_atmosphere(const scenario::AtmosphereSource& source, radiometry::ElevationRange ground) {
    std::optional<gis::NetcdfFile> open;  // the variables of a file are asked for one after the other
    const auto read = [&](const std::filesystem::path& path, const std::string& variable) {
        if (!open || open->path() != path) open.emplace(path);
        return open->read(variable).values;
    };
    if (source.file) {
        try {
            return {{radiometry::make_atmosphere_table(
                [&](const std::string& variable) { return read(*source.file, variable); })}};
        } catch (const Error& e) {
            if (e.kind() != ErrorKind::Input) throw;
            throw input_error("atmosphere.file", fmt::format("{} (import-atmosphere makes such tables)", e.what()));
        }
    }
    return radiometry::make_atmosphere_set(source.model, source.visibility_km, ground,
                                           [&](const std::string& file, const std::string& variable) {
                                               return read(data_folder() / "atmosphere" / file, variable);
                                           });
}

}  // namespace

OpticalTables load_optical_tables(const scenario::Scenario& scenario, const inputs::SceneInputs& in) {
    OpticalTables tables;
    tables.ground_elevation_m = scenario.atmosphere.ground_elevation_m.value_or(in.mean_height_m);
    const auto& air = scenario.atmosphere;
    if (air.model != "none" || air.file) {
        const double ground_m = tables.ground_elevation_m;
        // A table of the user's is for one height of the ground.
        tables.ground_heights_m = air.file ? std::vector<double>{0.0} : ground_heights_m(in, ground_m);
        tables.air =
            load_atmosphere(air, {ground_m + tables.ground_heights_m.back(), ground_m + tables.ground_heights_m.front()});
    }
    if (scenario.flame.hot_gas && !scenario.flame.grey_absorption_per_m && !scenario.flame.off)
        tables.flame = shipped_flame_optics();
    tables.soot = radiometry::load_soot_optics(data_folder() / "optical" / "soot_optics.csv");
    return tables;
}

std::shared_ptr<const radiometry::FlameOptics> shipped_flame_optics() {
    static const auto tables =
        std::make_shared<const radiometry::FlameOptics>(radiometry::load_flame_optics(data_folder() / "optical"));
    return tables;
}

}  // namespace pyroscene::pipeline
