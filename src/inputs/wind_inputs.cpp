#include "inputs/wind_inputs.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/csv.h"
#include "base/error.h"
#include "gis/geodesy.h"

namespace pyroscene::inputs {
namespace {

using scenario::RasterSource;

struct WindPair {
    std::filesystem::path file;
    int u_band = 1, v_band = 2;
    double time_s = std::nan("");
};

/// All pairs of bands u, v, with their times (times_s or the u band's time_s).
std::vector<WindPair> wind_pairs(const RasterSource& source) {
    const auto bands = frame_bands(source);
    if (bands.size() % 2 != 0)
        throw input_error(source.files.front().string(),
                          fmt::format("wind needs pairs of bands (u, v); found {} band(s)", bands.size()));
    std::vector<WindPair> pairs;
    for (std::size_t i = 0; i < bands.size(); i += 2)
        pairs.push_back({bands[i].file, bands[i].band, bands[i + 1].band, bands[i].time_s});
    if (!source.times_s.empty()) {
        if (source.times_s.size() != pairs.size())
            throw input_error("inputs.wind.times_s",
                              fmt::format("{} times for {} pairs of bands", source.times_s.size(), pairs.size()));
        for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i].time_s = source.times_s[i];
    }
    return pairs;
}

bool timed(const std::vector<WindPair>& pairs) {
    return std::none_of(pairs.begin(), pairs.end(), [](const WindPair& p) { return std::isnan(p.time_s); });
}

/// The u, v bands that hold for a frame: the only pair; else by time, the last one at or before the frame; else, without times, one
/// pair per frame.
WindPair wind_pair(const RasterSource& source, std::size_t frame_count, std::size_t frame, double frame_time_s) {
    const auto pairs = wind_pairs(source);
    if (pairs.size() == 1) return pairs.front();
    if (!timed(pairs)) {
        if (pairs.size() == frame_count) return pairs[frame];
        throw input_error(
            source.files.front().string(),
            fmt::format("{} pairs of wind bands without time_s for {} frames; set inputs.wind.bands: [u, v] or "
                        "inputs.wind.times_s",
                        pairs.size(), frame_count));
    }
    std::size_t found = 0;
    for (std::size_t i = 0; i < pairs.size() && pairs[i].time_s <= frame_time_s; ++i) found = i;
    return pairs[found];
}

/// Rows of inputs.wind.table.
struct StationWind {
    std::vector<double> times_s, speed_m_s, from_deg;

    explicit StationWind(const std::filesystem::path& file) {
        constexpr double kStrongest_m_s = 100.0, kTurn_deg = 360.0;
        const auto csv = read_csv(file);
        times_s = csv.numbers("time_s");
        speed_m_s = csv.numbers("speed_m_s");
        from_deg = csv.numbers("from_deg");
        if (times_s.empty()) throw input_error(csv.path, "has no row");
        for (std::size_t i = 0; i < times_s.size(); ++i) {
            const auto subject = fmt::format("{}:{}", csv.path, csv.row_lines[i]);
            if (!std::isfinite(times_s[i]) || (i > 0 && !(times_s[i] > times_s[i - 1])))
                throw input_error(subject, fmt::format("times must ascend, found {}", times_s[i]));
            if (!(speed_m_s[i] >= 0.0 && speed_m_s[i] <= kStrongest_m_s))
                throw input_error(subject, fmt::format("speed_m_s of {}, expected 0 to {}", speed_m_s[i], kStrongest_m_s));
            if (!(std::abs(from_deg[i]) <= kTurn_deg))
                throw input_error(subject, fmt::format("from_deg of {}, expected -360 to 360", from_deg[i]));
        }
    }
    /// The last row at or before a time, else the first.
    [[nodiscard]] std::size_t row_at(double time_s) const {
        const auto after = std::upper_bound(times_s.begin(), times_s.end(), time_s);
        return after == times_s.begin() ? 0 : static_cast<std::size_t>(after - times_s.begin()) - 1;
    }
};

}  // namespace

std::vector<FrameSource> frame_bands(const RasterSource& source) {
    std::vector<FrameSource> frames;
    for (const auto& file : source.files) {
        const auto in_file = gis::read_band_list(file);
        const int count = static_cast<int>(in_file.size());
        std::vector<int> bands = source.bands;
        if (bands.empty())
            for (int b = 1; b <= count; ++b) bands.push_back(b);
        for (const int band : bands) {
            if (band > count)
                throw input_error(file.string(), fmt::format("band {} asked for, but the file has {}", band, count));
            FrameSource frame{file, band, std::nan("")};
            const auto& metadata = in_file[static_cast<std::size_t>(band - 1)].metadata;
            if (const auto it = metadata.find("time_s"); it != metadata.end())
                frame.time_s = parse_number(it->second, fmt::format("{}: band {}: time_s", file.string(), band));
            frames.push_back(frame);
        }
    }
    return frames;
}

namespace {

/// As it is given.
gis::Wind given_wind(const scenario::Scenario& scenario, const MapGrid& grid, std::size_t frame_count, std::size_t frame,
                     double time_s) {
    const auto& wind = scenario.inputs.wind;
    if (wind && wind->raster) {
        const auto pair = wind_pair(*wind->raster, frame_count, frame, time_s);
        return gis::read_wind(pair.file, pair.u_band, pair.v_band, grid);
    }
    double speed = wind ? wind->speed_m_s : 0.0, from_deg = wind ? wind->from_deg : 0.0;
    if (wind && wind->table) {
        const StationWind station(*wind->table);
        const auto row = station.row_at(time_s);
        speed = station.speed_m_s[row];
        from_deg = station.from_deg[row];
    }
    const double from_rad = from_deg * kDegree_rad;
    const double convergence =
        gis::MapProjection(grid.crs_wkt)
            .convergence_rad(0.5 * (grid.west_m + grid.east_m()), 0.5 * (grid.south_m() + grid.north_m));
    const double to_grid_rad = from_rad + kPi - convergence;
    return {Raster<float>(grid, "wind east", "m s-1", static_cast<float>(speed * std::sin(to_grid_rad))),
            Raster<float>(grid, "wind north", "m s-1", static_cast<float>(speed * std::cos(to_grid_rad)))};
}

}  // namespace

gis::Wind wind_at(const scenario::Scenario& scenario, const MapGrid& grid, std::size_t frame_count, std::size_t frame,
                  double time_s, const WindLevels* levels) {
    auto wind = given_wind(scenario, grid, frame_count, frame, time_s);
    if (levels == nullptr) return wind;
    for (std::size_t i = 0; i < grid.size(); ++i) {
        wind.east_m_s.values[i] *= levels->to_twenty_feet.values[i];
        wind.north_m_s.values[i] *= levels->to_twenty_feet.values[i];
    }
    return wind;
}

std::vector<double> wind_times_s(const scenario::Scenario& scenario) {
    const auto& wind = scenario.inputs.wind;
    std::vector<double> times_s;
    if (wind && wind->table) return StationWind(*wind->table).times_s;
    if (!wind || !wind->raster) return times_s;
    const auto pairs = wind_pairs(*wind->raster);
    if (pairs.size() == 1) return times_s;
    if (!timed(pairs))
        throw input_error("inputs.wind",
                          fmt::format("{} pairs of bands without time_s; set inputs.wind.times_s", pairs.size()));
    for (const auto& pair : pairs) times_s.push_back(pair.time_s);
    return times_s;
}

}  // namespace pyroscene::inputs
