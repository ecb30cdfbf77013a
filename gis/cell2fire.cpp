#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/error.h"
#include "gis/fire_model_files.h"
#include "gis/raster_input.h"

namespace pyroscene::gis {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

struct NumberRow {
    int line = 0;
    std::vector<double> values;
};

/// Rows of numbers between commas. A first line that does not begin with a number holds names.
std::vector<NumberRow> number_rows(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in) throw input_error(file.string(), "cannot be opened");
    std::vector<NumberRow> rows;
    int line = 0;
    for (std::string text; std::getline(in, text);) {
        ++line;
        if (!text.empty() && text.back() == '\r') text.pop_back();
        if (text.empty() || (line == 1 && text.find_first_of("0123456789") != 0)) continue;
        NumberRow row{line, {}};
        std::istringstream fields(text);
        for (std::string field; std::getline(fields, field, ',');)
            row.values.push_back(parse_number(field, fmt::format("{}:{}", file.string(), line)));
        rows.push_back(std::move(row));
    }
    if (rows.empty()) throw input_error(file.string(), "has no row of numbers");
    return rows;
}

/// An empty raster on the cells of another.
MemoryRaster raster_like(const std::filesystem::path& like) {
    const auto info = read_info(like);
    if (info.crs_wkt.empty())
        throw input_error(like.string(), "has no coordinate reference system; put a .prj beside it or give 'crs'");
    MemoryRaster raster{info.cols, info.rows, info.geotransform, info.crs_wkt, "s", {}};
    raster.bands.emplace_back(static_cast<std::size_t>(info.cols) * static_cast<std::size_t>(info.rows), kNaN);
    return raster;
}

std::filesystem::path keep(const std::filesystem::path& file, double period_s, const MemoryRaster& arrival) {
    const auto& times_s = arrival.bands.front();
    if (std::all_of(times_s.begin(), times_s.end(), [](float t) { return std::isnan(t); }))
        throw input_error(file.string(), "no cell burns");
    return keep_in_memory("cell2fire", fmt::format("{}|{}", file.string(), period_s), "arrival", arrival);
}

}  // namespace

std::filesystem::path cell2fire_messages(const std::filesystem::path& messages, const std::filesystem::path& like,
                                         double period_s) {
    auto arrival = raster_like(like);
    auto& times_s = arrival.bands.front();
    std::vector<std::size_t> senders;
    for (const auto& [line, values] : number_rows(messages)) {
        const auto subject = fmt::format("{}:{}", messages.string(), line);
        if (values.size() < 3)
            throw input_error(subject, fmt::format("has {} numbers, expected from, to, time, rate", values.size()));
        const auto cell = [&](double number) {
            if (!(number >= 1.0 && number <= static_cast<double>(times_s.size())) || number != std::floor(number))
                throw input_error(subject,
                                  fmt::format("cell {}, expected 1 to {} as in {}", number, times_s.size(), like.string()));
            return static_cast<std::size_t>(number) - 1;
        };
        if (!(values[2] >= 0.0)) throw input_error(subject, fmt::format("time {}, expected >= 0", values[2]));
        senders.push_back(cell(values[0]));
        float& time_s = times_s[cell(values[1])];
        time_s = std::fmin(time_s, static_cast<float>(values[2] * period_s));
    }
    for (const std::size_t lit : senders)
        if (std::isnan(times_s[lit])) times_s[lit] = 0.0F;
    return keep(messages, period_s, arrival);
}

namespace {

/// The number at the end of a name: ForestGrid07.csv -> 7.
int number_of(const std::filesystem::path& grid) {
    const auto stem = grid.stem().string();
    const auto digits = stem.find_last_not_of("0123456789");
    const auto first = digits == std::string::npos ? 0 : digits + 1;
    if (first == stem.size())
        throw input_error(grid.string(), "has no number at the end of its name, as ForestGrid07.csv has");
    return static_cast<int>(parse_number(stem.substr(first), grid.string()));
}

std::vector<bool> burnt_cells(const std::filesystem::path& grid, int cols, int rows) {
    const auto lines = number_rows(grid);
    if (lines.size() != static_cast<std::size_t>(rows))
        throw input_error(grid.string(), fmt::format("has {} rows, expected {}", lines.size(), rows));
    std::vector<bool> burnt;
    for (const auto& [line, values] : lines) {
        if (values.size() != static_cast<std::size_t>(cols))
            throw input_error(fmt::format("{}:{}", grid.string(), line),
                              fmt::format("has {} cells, expected {}", values.size(), cols));
        for (const double v : values) {
            if (v != 0.0 && v != 1.0)
                throw input_error(fmt::format("{}:{}", grid.string(), line), fmt::format("holds {}, expected 0 or 1", v));
            burnt.push_back(v != 0.0);
        }
    }
    return burnt;
}

}  // namespace

std::filesystem::path cell2fire_grids(const std::vector<std::filesystem::path>& grids, const std::filesystem::path& like,
                                      double period_s) {
    std::map<int, std::filesystem::path> in_order;
    for (const auto& grid : grids)
        if (const auto [at, added] = in_order.emplace(number_of(grid), grid); !added)
            throw input_error(grid.string(), fmt::format("has the number of {}", at->second.string()));
    auto arrival = raster_like(like);
    auto& times_s = arrival.bands.front();
    int before = in_order.begin()->first - 1;
    for (const auto& [number, grid] : in_order) {
        const auto burnt = burnt_cells(grid, arrival.cols, arrival.rows);
        const auto time_s = static_cast<float>(number == 0 ? 0.0 : 0.5 * (before + number) * period_s);
        for (std::size_t i = 0; i < burnt.size(); ++i) {
            if (!burnt[i] && !std::isnan(times_s[i]))
                throw input_error(grid.string(), fmt::format("cell {} burns no longer, but did before", i + 1));
            if (burnt[i] && std::isnan(times_s[i])) times_s[i] = time_s;
        }
        before = number;
    }
    return keep(grids.front(), period_s, arrival);
}

}  // namespace pyroscene::gis
