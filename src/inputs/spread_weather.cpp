#include "inputs/spread_weather.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/csv.h"
#include "base/error.h"
#include "gis/raster_input.h"
#include "inputs/wind_inputs.h"

namespace pyroscene::inputs {
namespace {

using scenario::Scenario;
using scenario::SpreadSource;
using spread::Field;

constexpr std::array<const char*, spread::kFuelClasses> kMoistureColumns{"m1h_pct", "m10h_pct", "m100h_pct", "mherb_pct",
                                                                         "mwoody_pct"};

/// Times and moistures of inputs.spread.moisture.table.
struct MoistureTable {
    std::vector<double> times_s;
    std::array<std::vector<double>, spread::kFuelClasses> moisture;  ///< empty = no such column

    explicit MoistureTable(const SpreadSource& source) {
        if (!source.moisture_table) return;
        const auto csv = read_csv(*source.moisture_table);
        times_s = csv.numbers("time_s");
        for (std::size_t i = 0; i < times_s.size(); ++i)
            if (i > 0 && !(times_s[i] > times_s[i - 1]))
                throw input_error(fmt::format("{}:{}", csv.path, csv.row_lines[i]), "times must ascend");
        if (times_s.empty()) throw input_error(csv.path, "has no row");
        for (std::size_t c = 0; c < kMoistureColumns.size(); ++c) {
            if (source.moisture_pct[c]) continue;  // the scenario says it
            moisture[c] = csv.numbers(kMoistureColumns[c]);
            for (std::size_t i = 0; i < moisture[c].size(); ++i) {
                if (!(moisture[c][i] >= 0.0 && moisture[c][i] <= 1000.0))
                    throw input_error(fmt::format("{}:{}: column '{}'", csv.path, csv.row_lines[i], kMoistureColumns[c]),
                                      fmt::format("found {}, expected 0 to 1000", moisture[c][i]));
                moisture[c][i] /= 100.0;
            }
        }
    }
};

/// The rasters of inputs.spread.moisture: five bands for each moment.
struct MoistureRasters {
    std::vector<FrameSource> bands;
    std::vector<double> times_s;  ///< one per five bands; empty = one moment for all times

    explicit MoistureRasters(const SpreadSource& source) {
        if (!source.moisture_raster) return;
        const char* const subject = "inputs.spread.moisture";
        bands = frame_bands(*source.moisture_raster);
        if (bands.size() % kMoistureColumns.size() != 0)
            throw input_error(subject, fmt::format("found {} bands, expected {} for each moment: {}", bands.size(),
                                                   kMoistureColumns.size(), fmt::join(kMoistureColumns, ", ")));
        const std::size_t moments = bands.size() / kMoistureColumns.size();
        if (moments == 1) return;
        const auto& given = source.moisture_raster->times_s;
        if (!given.empty() && given.size() != moments)
            throw input_error(subject, fmt::format("{} times_s for {} moments", given.size(), moments));
        for (std::size_t i = 0; i < moments; ++i) {
            const double time_s = given.empty() ? bands[i * kMoistureColumns.size()].time_s : given[i];
            if (std::isnan(time_s) || (i > 0 && !(time_s > times_s.back())))
                throw input_error(subject,
                                  fmt::format("{} moments need ascending times: time_s of the bands or times_s", moments));
            times_s.push_back(time_s);
        }
    }
    [[nodiscard]] Field at(double time_s, std::size_t column, const MapGrid& grid) const {
        const std::size_t moment = times_s.empty() ? 0 : holding(times_s, time_s);
        const auto& band = bands[moment * kMoistureColumns.size() + column];
        auto raster =
            gis::read_band({band.file, band.band, gis::Resampling::Bilinear, kMoistureColumns[column], "percent"}, grid);
        for (float& v : raster.values) v *= 0.01F;
        return compact_field(std::move(raster));
    }
};

}  // namespace

spread::Field compact_field(Raster<float> raster) {
    const float first = raster.values.front();
    if (std::all_of(raster.values.begin(), raster.values.end(), [&](float v) { return v == first; })) return {first};
    return {0.0, std::move(raster)};
}

spread::Field field_of(const scenario::QuantitySource& source, const char* name, const char* unit, const MapGrid& grid) {
    if (!source.raster) return {source.value};
    // With a scale the values have no unit of the file's but that of the key.
    auto raster =
        gis::read_band({source.raster->files.front(), source.raster->bands.empty() ? 1 : source.raster->bands.front(),
                        gis::Resampling::Bilinear, name, source.scale == 1.0 ? unit : ""},
                       grid);
    for (float& v : raster.values) v = static_cast<float>(v * source.scale);
    return compact_field(std::move(raster));
}

std::size_t holding(const std::vector<double>& times_s, double time_s) {
    std::size_t i = 0;
    while (i + 1 < times_s.size() && times_s[i + 1] <= time_s) ++i;
    return i;
}

std::vector<spread::Weather> spread_weather(const Scenario& scenario, const MapGrid& grid, const WindLevels* levels) {
    const auto& source = *scenario.inputs.spread;
    const MoistureTable table(source);
    const MoistureRasters rasters(source);
    const auto wind_times = wind_times_s(scenario);
    std::set<double> times_s{0.0};
    for (const auto* list : {&table.times_s, &rasters.times_s, &wind_times}) times_s.insert(list->begin(), list->end());
    std::vector<spread::Weather> weather;
    for (const double time_s : times_s) {
        if (time_s < 0.0 || time_s > source.frames.times_s.back()) continue;
        auto& w = weather.emplace_back();
        w.from_s = time_s;
        auto wind = wind_at(scenario, grid, 1, 0, time_s, levels);
        w.wind_east_m_s = compact_field(std::move(wind.east_m_s));
        w.wind_north_m_s = compact_field(std::move(wind.north_m_s));
        for (std::size_t c = 0; c < kMoistureColumns.size(); ++c) {
            if (const auto& given = source.moisture_pct[c])
                w.moisture[c] = {*given / 100.0, {}};
            else if (source.moisture_raster)
                w.moisture[c] = rasters.at(time_s, c, grid);
            else
                w.moisture[c] = {table.moisture[c][holding(table.times_s, time_s)], {}};
        }
    }
    return weather;
}

}  // namespace pyroscene::inputs
