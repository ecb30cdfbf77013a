#include "inputs/arrival_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.h"
#include "fire/gradients.h"
#include "gis/fire_model_files.h"
#include "gis/raster_input.h"
#include "gis/units.h"
#include "inputs/fuel_cells.h"

namespace pyroscene::inputs {
namespace {

const std::vector<std::string> kFdsArrival{"FIRE ARRIVAL TIME", "TIME OF ARRIVAL"};
constexpr double kAboveZero = std::numeric_limits<float>::min();

/// Reads a raster in the unit that the scenario says; a tag of the file must say the same. Values below `least` are no data, so that
/// none of them is mixed into a neighbour.
Raster<float> read(const scenario::UnitRaster& source, const std::string& crs, const char* name, const char* unit,
                   double least, const MapGrid& grid) {
    const auto file = gis::with_crs(source.raster.files.front(), crs, "inputs.arrival_model.crs");
    const int band = source.raster.bands.empty() ? 1 : source.raster.bands.front();
    const auto said = gis::unit_conversion(source.unit, unit);
    if (!said) throw input_error(file.string(), fmt::format("unit '{}' is none of a {}", source.unit, name));
    const auto info = gis::read_info(file);
    if (band >= 1 && band <= static_cast<int>(info.bands.size())) {
        const auto& tag = info.bands[static_cast<std::size_t>(band) - 1].unit;
        const auto tagged = gis::unit_conversion(tag, unit);
        if (!tag.empty() && (!tagged || std::abs(tagged->scale / said->scale - 1.0) > 1e-6))
            throw input_error(file.string(),
                              fmt::format("band {} says its unit is '{}', the scenario says '{}'", band, tag, source.unit));
    }
    auto raster = gis::read_band({file, band, gis::Resampling::Bilinear, name, "", least}, grid);
    raster.unit = unit;
    for (float& v : raster.values) v = static_cast<float>(v * said->scale + said->offset);
    return raster;
}

gis::LocalPlacement place_of(const scenario::ArrivalModelSource& source) {
    return {source.crs, source.west_m.value_or(0.0), source.south_m.value_or(0.0)};
}

/// What programs write that are no rasters, as rasters in memory.
scenario::ArrivalModelSource with_rasters(scenario::ArrivalModelSource source) {
    auto& arrival = source.arrival;
    const auto& files = arrival.raster.files;
    if (source.model == "cell2fire") {
        const double period_s = source.period * gis::unit_conversion(arrival.unit, "s").value().scale;
        const auto like = gis::with_crs(*source.like, source.crs, "inputs.arrival_model.crs");
        arrival.raster.files = {source.grids ? gis::cell2fire_grids(files, like, period_s)
                                             : gis::cell2fire_messages(files.front(), like, period_s)};
    } else if (source.model == "quic-fire") {
        arrival.raster.files = {gis::quic_fire_arrival(files, {source.cols, source.rows, source.cell_m, place_of(source)})};
    } else if (source.model == "fds") {
        arrival.raster.files = {gis::fds_ground_quantity(files.front(), kFdsArrival, "s", place_of(source))};
        if (source.spread_rate)
            source.spread_rate->raster.files = {gis::fds_ground_quantity(source.spread_rate->raster.files.front(),
                                                                         {"LS SPREAD RATE"}, "m/s", place_of(source))};
    } else {
        return source;
    }
    arrival.raster.bands.clear();
    arrival.unit = "s";
    if (source.west_m) source.crs.clear();  // was that of the place
    return source;
}

/// Times on the scenario's clock, NaN where the fire never came.
Raster<float> arrival_times_s(const scenario::ArrivalModelSource& source, const MapGrid& grid) {
    const bool zero_is_burnt = source.model != "flammap";
    auto arrival = read(source.arrival, source.crs, "arrival_time", "s", zero_is_burnt ? 0.0 : kAboveZero, grid);
    for (float& t : arrival.values) t += static_cast<float>(source.offset_s);
    return arrival;
}

/// A unit that is wrong by a factor of 60 shows in the rate at which the front must have run.
void check_rate(const Raster<float>& rate_m_s, const scenario::ArrivalModelSource& source,
                std::vector<std::string>& warnings) {
    constexpr double kSlowest_m_s = 0.001, kFastest_m_s = 10.0;
    std::vector<float> known;
    std::copy_if(rate_m_s.values.begin(), rate_m_s.values.end(), std::back_inserter(known),
                 [](float v) { return v > 0.0F; });
    if (known.empty()) return;
    const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
    std::nth_element(known.begin(), middle, known.end());
    if (*middle < kSlowest_m_s || *middle > kFastest_m_s)
        warnings.push_back(fmt::format(
            "arrival times of '{}' in {} mean a front of {:.2g} m/s (median); fires run at {} to {} m/s: check "
            "inputs.arrival_model.arrival.unit",
            source.arrival.raster.files.front().string(), source.arrival.unit, *middle, kSlowest_m_s, kFastest_m_s));
}

}  // namespace

ModelledFire read_arrival_model(const scenario::Scenario& scenario, const MapGrid& grid) {
    const auto& given = *scenario.inputs.arrival_model;
    const auto source = with_rasters(given);
    ModelledFire fire;
    try {
        fire.ground.arrival_time_s = arrival_times_s(source, grid);
    } catch (const Error& e) {  // what is in memory has a name that says nothing
        const auto& file = given.arrival.raster.files.front();
        if (e.kind() != ErrorKind::Input || file == source.arrival.raster.files.front()) throw;
        throw input_error(file.string(), fmt::format("as arrival times ({})", e.what()));
    }
    fire.frames_s = source.frames.times_s;
    fire.mean_over_s = source.frames.mean_over_s;
    auto implied = fire::spread_rate_m_s(fire.ground.arrival_time_s, std::numeric_limits<double>::max());
    check_rate(implied, given, fire.warnings);
    std::optional<Raster<float>> rate;
    if (source.spread_rate) {
        rate = read(*source.spread_rate, source.crs, "spread_rate", "m s-1", kAboveZero, grid);
        for (std::size_t i = 0; i < implied.values.size(); ++i)
            if (!std::isnan(rate->values[i])) implied.values[i] = rate->values[i];
    }
    for (float& v : implied.values) v = std::min(v, static_cast<float>(scenario.fire.flames.maximum_spread_rate_m_s));
    fire.spread_rate_m_s = std::move(implied);
    if (source.fireline_intensity)
        fire.fireline_intensity_W_m =
            read(*source.fireline_intensity, source.crs, "fireline_intensity", "W m-1", kAboveZero, grid);
    if (source.flame_length)
        fire.flame_length_m = read(*source.flame_length, source.crs, "flame_length", "m", kAboveZero, grid);
    const auto models = fuel_models(source.fuel);
    add_fuel(fire, fuel_of_cells(source.fuel, models, grid), models, source.frames.coarse_burn_time_s,
             [&](std::size_t, double) { return source.fuel_moisture_pct / 100.0; });
    if (rate && fire.fireline_intensity_W_m)
        for (std::size_t i = 0; i < grid.size(); ++i) {
            const float heat_J_m2 = fire.fireline_intensity_W_m->values[i] / rate->values[i];
            if (std::isfinite(heat_J_m2) && fire.fuel_load_kg_m2.values[i] > 0.0F)
                fire.ground.heat_J_m2.values[i] = heat_J_m2;
        }
    return fire;
}

std::vector<std::filesystem::path> arrival_model_files(const scenario::ArrivalModelSource& source) {
    auto files = files_of(source.fuel);
    files.insert(files.end(), source.arrival.raster.files.begin(), source.arrival.raster.files.end());
    if (source.like) files.push_back(*source.like);
    if (source.model == "fds")
        for (auto& file : gis::fds_files(source.arrival.raster.files.front(), kFdsArrival)) files.push_back(std::move(file));
    for (const auto* raster : {&source.fireline_intensity, &source.flame_length, &source.spread_rate})
        if (*raster) files.push_back((*raster)->raster.files.front());
    return files;
}

}  // namespace pyroscene::inputs
