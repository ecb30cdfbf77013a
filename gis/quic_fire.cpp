#include <algorithm>
#include <array>
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

/// What QUIC-Fire calls an output; the time in seconds follows, then .bin.
constexpr const char *kBurnt = "mburnt_integ-", *kSurface = "surfEnergy", *kToAir = "fire-energy_to_atmos-";

bool is_of(const std::filesystem::path& file, std::string_view output) {
    const auto stem = file.stem().string();
    return stem.size() > output.size() && stem.starts_with(output) &&
           stem.find_first_not_of("0123456789", output.size()) == std::string::npos;
}

std::map<double, std::filesystem::path> in_order_of_time(const std::vector<std::filesystem::path>& files,
                                                         std::string_view output) {
    std::map<double, std::filesystem::path> in_order;
    for (const auto& file : files) {
        if (!is_of(file, output))
            throw input_error(file.string(),
                              fmt::format("expected a name like {}00300.bin, with the time in seconds", output));
        const double time_s = parse_number(file.stem().string().substr(output.size()), file.string());
        if (const auto [at, added] = in_order.emplace(time_s, file); !added)
            throw input_error(file.string(), fmt::format("is of the time of {}", at->second.string()));
    }
    return in_order;
}

class Cells {
public:
    explicit Cells(const QuicFireGrid& grid)
        : cols_(static_cast<std::size_t>(grid.cols)), rows_(static_cast<std::size_t>(grid.rows)) {}
    [[nodiscard]] std::size_t count() const noexcept { return cols_ * rows_; }
    /// Place in a raster from the north of the n-th cell from the south.
    [[nodiscard]] std::size_t from_north(std::size_t n) const noexcept {
        return (rows_ - 1 - n / cols_) * cols_ + n % cols_;
    }

private:
    std::size_t cols_, rows_;
};

MemoryRaster raster_of(const QuicFireGrid& grid, const char* unit) {
    return {grid.cols,
            grid.rows,
            north_up(grid.place.west_m, grid.place.south_m + grid.rows * grid.cell_m, grid.cell_m, grid.cell_m),
            parse_map_crs(grid.place.crs, "crs of the QUIC-Fire run").wkt,
            unit,
            {}};
}

std::filesystem::path keep(const std::vector<std::filesystem::path>& files, const QuicFireGrid& grid, const char* name,
                           const MemoryRaster& raster) {
    return keep_in_memory("quic_fire",
                          fmt::format("{}|{}|{}|{}|{}|{}|{}", files.front().string(), files.size(), grid.cell_m, grid.cols,
                                      grid.place.west_m, grid.place.south_m, grid.place.crs),
                          name, raster);
}

}  // namespace

std::filesystem::path quic_fire_arrival(const std::vector<std::filesystem::path>& files, const QuicFireGrid& grid) {
    const Cells cells(grid);
    auto arrival = raster_of(grid, "s");
    auto& known_s = arrival.bands.emplace_back(cells.count(), std::numeric_limits<float>::quiet_NaN());
    const auto in_order = in_order_of_time(files, kBurnt);
    double before_s = in_order.begin()->first;
    bool burns = false;
    for (const auto& [time_s, file] : in_order) {
        FortranRecords records(file);
        const auto burnt_pct = records.floats(cells.count());
        if (!records.at_end()) throw input_error(file.string(), "goes on after its one record");
        for (std::size_t i = 0; i < cells.count(); ++i) {
            const float value = burnt_pct[i];
            if (!(value >= -1e-3F && value <= 100.001F))
                throw input_error(file.string(), fmt::format("holds {} % of burnt mass, expected 0 to 100", value));
            float& known = known_s[cells.from_north(i)];
            if (value > 0.0F && std::isnan(known)) known = static_cast<float>(0.5 * (before_s + time_s));
            burns = burns || value > 0.0F;
        }
        before_s = time_s;
    }
    if (!burns) throw input_error(files.front().string(), "no cell burns in it and the files beside it");
    return keep(files, grid, "arrival", arrival);
}

FluxSeries quic_fire_heat_flux(const std::vector<std::filesystem::path>& files, const QuicFireGrid& grid) {
    constexpr double kMost_W_m2 = 1e8, kW = 1000.0;
    const Cells cells(grid);
    const bool to_air = is_of(files.front(), kToAir);
    const double to_W_m2 = to_air ? kW / (grid.cell_m * grid.cell_m) : kW;
    auto flux = raster_of(grid, "W m-2");
    FluxSeries series;
    for (const auto& [time_s, file] : in_order_of_time(files, to_air ? kToAir : kSurface)) {
        FortranRecords records(file);
        const auto values = to_air ? records.layers_of_floats(cells.count()) : records.floats(cells.count());
        if (!records.at_end()) throw input_error(file.string(), "goes on after its one record");
        std::vector<double> sum(cells.count(), 0.0);
        for (std::size_t i = 0; i < values.size(); ++i) sum[i % cells.count()] += values[i];
        auto& band = flux.bands.emplace_back(cells.count());
        for (std::size_t i = 0; i < cells.count(); ++i) {
            const double value = sum[i] * to_W_m2;
            if (!(value >= -1.0 && value <= kMost_W_m2))
                throw input_error(file.string(), fmt::format("holds a flux of {:.4g} kW m-2, expected 0 to {:g}", value / kW,
                                                             kMost_W_m2 / kW));
            band[cells.from_north(i)] = static_cast<float>(std::max(0.0, value));
        }
        series.times_s.push_back(time_s);
    }
    series.raster = keep(files, grid, to_air ? "energy_to_atmos" : "surface_energy", flux);
    return series;
}

}  // namespace pyroscene::gis
