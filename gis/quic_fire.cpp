#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/error.h"
#include "gis/crs.h"
#include "gis/fire_model_files.h"
#include "gis/fortran_records.h"

namespace pyroscene::gis {
namespace {

/// mburnt_integ-00300.bin -> 300.
double time_of(const std::filesystem::path& file) {
    const auto stem = file.stem().string();
    const auto before = stem.find_last_not_of("0123456789");
    const auto first = before == std::string::npos ? 0 : before + 1;
    if (!stem.starts_with("mburnt_integ") || first == stem.size())
        throw input_error(file.string(), "expected a name like mburnt_integ-00300.bin, with the time in seconds");
    return parse_number(stem.substr(first), file.string());
}

}  // namespace

std::filesystem::path quic_fire_arrival(const std::vector<std::filesystem::path>& files, const QuicFireGrid& grid) {
    std::map<double, std::filesystem::path> in_order;
    for (const auto& file : files)
        if (const auto [at, added] = in_order.emplace(time_of(file), file); !added)
            throw input_error(file.string(), fmt::format("is of the time of {}", at->second.string()));
    const auto cells = static_cast<std::size_t>(grid.cols) * static_cast<std::size_t>(grid.rows);
    const double north_m = grid.place.south_m + grid.rows * grid.cell_m;
    MemoryRaster arrival{grid.cols,
                         grid.rows,
                         north_up(grid.place.west_m, north_m, grid.cell_m, grid.cell_m),
                         parse_map_crs(grid.place.crs, "crs of the QUIC-Fire run").wkt,
                         "s",
                         {std::vector<float>(cells, std::numeric_limits<float>::quiet_NaN())}};
    double before_s = in_order.begin()->first;
    bool burns = false;
    for (const auto& [time_s, file] : in_order) {
        FortranRecords records(file);
        const auto burnt_pct = records.floats(cells);
        if (!records.at_end()) throw input_error(file.string(), "goes on after its one record");
        for (std::size_t i = 0; i < cells; ++i) {
            const float value = burnt_pct[i];
            if (!(value >= -1e-3F && value <= 100.001F))
                throw input_error(file.string(), fmt::format("holds {} % of burnt mass, expected 0 to 100", value));
            const std::size_t from_south = i / static_cast<std::size_t>(grid.cols),
                              row = static_cast<std::size_t>(grid.rows) - 1 - from_south;
            float& known =
                arrival.bands[0][row * static_cast<std::size_t>(grid.cols) + i % static_cast<std::size_t>(grid.cols)];
            if (value > 0.0F && std::isnan(known)) known = static_cast<float>(0.5 * (before_s + time_s));
            burns = burns || value > 0.0F;
        }
        before_s = time_s;
    }
    if (!burns) throw input_error(files.front().string(), "no cell burns in it and the files beside it");
    return keep_in_memory("quic_fire",
                          fmt::format("{}|{}|{}|{}|{}|{}|{}", files.front().string(), files.size(), grid.cell_m, grid.cols,
                                      grid.place.west_m, grid.place.south_m, grid.place.crs),
                          "arrival", arrival);
}

}  // namespace pyroscene::gis
