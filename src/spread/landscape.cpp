#include "spread/landscape.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "base/error.h"

namespace pyroscene::spread {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Fire behaviour cell by cell under one weather; beds of uniform moisture are computed once.
class Behaviour {
public:
    Behaviour(const Landscape& landscape, const Weather& weather, const SpreadRules& rules)
        : land_(landscape), weather_(weather), rules_(rules) {
        uniform_ = std::all_of(weather.moisture.begin(), weather.moisture.end(), [](const Field& f) { return f.uniform(); });
        beds_.resize(landscape.models.empty() ? 1 : static_cast<std::size_t>(landscape.models.rbegin()->first) + 1);
        for (const auto& [number, model] : landscape.models)
            beds_[static_cast<std::size_t>(number)] = {&model, uniform_ ? bed_of(model, 0) : FuelBed{}};
    }

    [[nodiscard]] FuelBed bed(std::size_t cell) const noexcept {
        const auto& known = beds_[land_.fuel.values[cell]];
        if (known.model == nullptr) return {};
        return uniform_ ? known.bed : bed_of(*known.model, cell);
    }

    [[nodiscard]] HeadFire head(const FuelBed& bed, std::size_t cell) const noexcept {
        const FuelModel* model = beds_[land_.fuel.values[cell]].model;
        const double east = weather_.wind_east_m_s.at(cell), north = weather_.wind_north_m_s.at(cell);
        const double up_east = land_.slope_east.values[cell], up_north = land_.slope_north.values[cell];
        if (model == nullptr || !std::isfinite(east + north + up_east + up_north)) return {};
        const double tangent = std::hypot(up_east, up_north);
        const double upslope_rad = tangent > 0.0 ? std::atan2(up_east, up_north) : 0.0;
        const double wind_m_s = std::hypot(east, north) * reduction(*model, cell);
        return head_fire(bed, wind_m_s, std::atan2(east, north) - upslope_rad, tangent, rules_.wind_limit);
    }

private:
    struct Known {
        const FuelModel* model = nullptr;
        FuelBed bed;
    };

    [[nodiscard]] FuelBed bed_of(const FuelModel& model, std::size_t cell) const noexcept {
        Moistures moisture;
        for (std::size_t i = 0; i < moisture.size(); ++i) {
            moisture[i] = weather_.moisture[i].at(cell);
            if (!std::isfinite(moisture[i])) return {};
        }
        return fuel_bed(model, moisture, rules_.curing);
    }

    /// From 20 ft above the vegetation to midflame.
    [[nodiscard]] double reduction(const FuelModel& model, std::size_t cell) const noexcept {
        const auto known = [&](const Field& f) { return std::isfinite(f.at(cell)) ? f.at(cell) : 0.0; };
        const Canopy canopy{known(land_.canopy_cover), known(land_.canopy_height_m), known(land_.crown_ratio)};
        return wind_adjustment(model.depth_m, canopy);
    }

    const Landscape& land_;
    const Weather& weather_;
    const SpreadRules& rules_;
    bool uniform_ = false;
    std::vector<Known> beds_;
};

void check(const Landscape& land, const std::vector<Weather>& weather) {
    if (weather.empty()) throw input_error("spread", "no weather is given");
    for (std::size_t i = 1; i < weather.size(); ++i)
        if (!(weather[i].from_s > weather[i - 1].from_s)) throw input_error("spread", "times of the weather must ascend");
    const auto same = [&](const MapGrid& grid) { return grid == land.fuel.grid; };
    const auto fits = [&](const Field& f) { return f.uniform() || same(f.raster.grid); };
    bool all = same(land.slope_east.grid) && same(land.slope_north.grid) && fits(land.canopy_cover) &&
               fits(land.canopy_height_m) && fits(land.crown_ratio);
    for (const auto& w : weather) {
        all = all && fits(w.wind_east_m_s) && fits(w.wind_north_m_s);
        for (const auto& m : w.moisture) all = all && fits(m);
    }
    if (!all) throw input_error("spread", "landscape and weather are not on one grid");
}

/// Which weather holds at a time.
std::size_t weather_at(const std::vector<Weather>& weather, double time_s) noexcept {
    std::size_t i = 0;
    while (i + 1 < weather.size() && weather[i + 1].from_s <= time_s) ++i;
    return i;
}

}  // namespace

FireShapes fire_shapes(const Landscape& landscape, const Weather& weather, const SpreadRules& rules) {
    const Behaviour behaviour(landscape, weather, rules);
    FireShapes shapes(landscape.fuel.values.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, shapes.size(), 4096), [&](const auto& range) {
        for (std::size_t cell = range.begin(); cell != range.end(); ++cell) {
            if (landscape.fuel.values[cell] == 0) continue;
            const auto head = behaviour.head(behaviour.bed(cell), cell);
            shapes[cell] = fire_shape(head, length_to_width(head.effective_wind_m_s), landscape.slope_east.values[cell],
                                      landscape.slope_north.values[cell]);
        }
    });
    return shapes;
}

FireSpread spread_fire(const Landscape& landscape, const std::vector<Weather>& weather, const SpreadRules& rules,
                       const std::vector<Seed>& seeds, double end_s, const std::function<void(double)>& on_progress) {
    check(landscape, weather);
    const MapGrid& grid = landscape.fuel.grid;
    Propagation job{grid, seeds, {}, {}, end_s, on_progress};
    for (const auto& w : weather) job.period_start_s.push_back(w.from_s);
    job.shapes = [&](std::size_t period) { return fire_shapes(landscape, weather[period], rules); };
    auto arrival = propagate(job);

    std::vector<Behaviour> behaviour;
    behaviour.reserve(weather.size());
    for (const auto& w : weather) behaviour.emplace_back(landscape, w, rules);
    FireSpread out{std::move(arrival.time_s), Raster<float>(grid, "spread_rate", "m s-1", kNaN),
                   Raster<float>(grid, "fireline_intensity", "W m-1", kNaN), Raster<float>(grid, "flame_length", "m", kNaN)};
    std::atomic<std::size_t> limited{0};
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, grid.size(), 4096), [&](const auto& range) {
        for (std::size_t cell = range.begin(); cell != range.end(); ++cell) {
            const double time_s = out.arrival_time_s.values[cell];
            if (std::isnan(time_s)) continue;
            const auto& here = behaviour[weather_at(weather, time_s)];
            const FuelBed bed = here.bed(cell);
            const auto head = here.head(bed, cell);
            // No front is faster than the head; rounding could make it so.
            const double normal = normal_rate_m_s(arrival.slowness[cell], landscape.slope_east.values[cell],
                                                  landscape.slope_north.values[cell]);
            const double rate = std::min(head.rate_m_s, normal);
            out.spread_rate_m_s.values[cell] = static_cast<float>(rate);
            out.fireline_intensity_W_m.values[cell] = static_cast<float>(bed.heat_J_m2 * rate);
            out.flame_length_m.values[cell] = static_cast<float>(flame_length_m(bed.heat_J_m2 * rate));
            if (head.limited) ++limited;
        }
    });
    out.cells_with_limited_wind = limited;
    return out;
}

}  // namespace pyroscene::spread
