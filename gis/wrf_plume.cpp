#include "gis/wrf_plume.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "gis/memory_raster.h"
#include "gis/netcdf_input.h"

namespace pyroscene::gis {
namespace {

constexpr double kGravity_m_s2 = 9.81;  // WRF's

/// A variable [z, y, x] of one record; indices count from the south-west and the ground.
class Cube {
public:
    Cube(const NetcdfFile& file, const char* variable, int record)
        : array_(file.read_record(variable, static_cast<std::size_t>(record))) {
        if (array_.shape.size() != 3)
            throw input_error(fmt::format("{}, variable '{}'", file.path().string(), variable),
                              fmt::format("has {} dimensions beside the time, expected 3", array_.shape.size()));
    }
    [[nodiscard]] double at(int k, int row, int col) const {
        return array_
            .values[(static_cast<std::size_t>(k) * array_.shape[1] + static_cast<std::size_t>(row)) * array_.shape[2] +
                    static_cast<std::size_t>(col)];
    }
    [[nodiscard]] const std::string& unit() const { return array_.unit; }
    [[nodiscard]] int layers() const { return static_cast<int>(array_.shape[0]); }
    void require(const char* name, int layers, int rows, int cols, const std::string& file) const {
        if (array_.shape[0] != static_cast<std::size_t>(layers) || array_.shape[1] != static_cast<std::size_t>(rows) ||
            array_.shape[2] != static_cast<std::size_t>(cols))
            throw input_error(file, fmt::format("{} has {} x {} x {} values, expected {} x {} x {}", name, array_.shape[0],
                                                array_.shape[1], array_.shape[2], layers, rows, cols));
    }

private:
    NamedArray array_;
};

/// Dry air above a place [Pa] that WRF's tendencies are multiplied by: c1 (MU + MUB) + c2 of a layer.
class DryAir {
public:
    DryAir(const NetcdfFile& file, const WrfSfire& wrf, int record, int layers)
        : mu_(file.read_record("MU", static_cast<std::size_t>(record))),
          base_(file.read_record("MUB", static_cast<std::size_t>(record))),
          c1_(static_cast<std::size_t>(layers), 1.0),
          c2_(static_cast<std::size_t>(layers), 0.0) {
        const std::vector<std::size_t> map{static_cast<std::size_t>(wrf.rows), static_cast<std::size_t>(wrf.cols)};
        if (mu_.shape != map || base_.shape != map)
            throw input_error(file.path().string(), fmt::format("MU and MUB are not of {} x {} values", wrf.rows, wrf.cols));
        if (!wrf.has("C1H") || !wrf.has("C2H")) return;  // before the hybrid coordinate (WRF 3.9)
        const auto read = [&](const char* name, std::vector<double>& into) {
            auto values = file.read_record(name, static_cast<std::size_t>(record)).values;
            if (values.size() != into.size())
                throw input_error(file.path().string(),
                                  fmt::format("{} has {} values, expected {}", name, values.size(), into.size()));
            into = std::move(values);
        };
        read("C1H", c1_);
        read("C2H", c2_);
    }
    [[nodiscard]] double Pa(int k, int row, int col) const {
        const auto at = static_cast<std::size_t>(row) * mu_.shape[1] + static_cast<std::size_t>(col);
        return c1_[static_cast<std::size_t>(k)] * (mu_.values[at] + base_.values[at]) + c2_[static_cast<std::size_t>(k)];
    }

private:
    NamedArray mu_, base_;
    std::vector<double> c1_, c2_;
};

struct Fields {
    Cube tendency, u, v, w, ph, phb;
    DryAir air;

    Fields(const NetcdfFile& file, const WrfSfire& wrf, int record)
        : tendency(file, "RTHFRTEN", record),
          u(file, "U", record),
          v(file, "V", record),
          w(file, "W", record),
          ph(file, "PH", record),
          phb(file, "PHB", record),
          air(file, wrf, record, tendency.layers()) {
        const int nz = tendency.layers();
        const auto path = file.path().string();
        constexpr std::array kUnits{"", "K/s", "K s-1", "K s^-1", "Pa K/s", "Pa K s-1"};
        if (std::find(kUnits.begin(), kUnits.end(), tendency.unit()) == kUnits.end())
            throw input_error(path, fmt::format("RTHFRTEN is in '{}', expected 'K/s'", tendency.unit()));
        tendency.require("RTHFRTEN", nz, wrf.rows, wrf.cols, path);
        u.require("U", nz, wrf.rows, wrf.cols + 1, path);
        v.require("V", nz, wrf.rows + 1, wrf.cols, path);
        w.require("W", nz + 1, wrf.rows, wrf.cols, path);
        ph.require("PH", nz + 1, wrf.rows, wrf.cols, path);
        phb.require("PHB", nz + 1, wrf.rows, wrf.cols, path);
    }
    [[nodiscard]] double heating_K_s(int k, int row, int col) const {
        return tendency.at(k, row, col) / air.Pa(k, row, col);
    }
    [[nodiscard]] double height_m(int k, int row, int col) const {
        return (ph.at(k, row, col) + phb.at(k, row, col) - ph.at(0, row, col) - phb.at(0, row, col)) / kGravity_m_s2;
    }
};

/// Heights of the layers' centres above the ground and their excess, from the ground up.
struct Column {
    std::vector<double> height_m, excess_K;

    Column(const Fields& f, const WrfSfire& wrf, int row, int col) {
        constexpr double kSlowest_m_s = 0.5;
        double below_K = 0.0;
        for (int k = 0; k < f.tendency.layers(); ++k) {
            const double bottom = f.height_m(k, row, col), top = f.height_m(k + 1, row, col), dz = top - bottom;
            const double u = 0.5 * (f.u.at(k, row, col) + f.u.at(k, row, col + 1)),
                         v = 0.5 * (f.v.at(k, row, col) + f.v.at(k, row + 1, col)),
                         rising_below = std::max(0.0, f.w.at(k, row, col)),
                         rising = std::max(0.0, 0.5 * (f.w.at(k, row, col) + f.w.at(k + 1, row, col)));
            const double airing_per_s =
                std::max(std::abs(u) / wrf.dx_m + std::abs(v) / wrf.dy_m + rising / dz, kSlowest_m_s / dz);
            below_K = (f.heating_K_s(k, row, col) + rising_below * below_K / dz) / airing_per_s;
            height_m.push_back(0.5 * (bottom + top));
            excess_K.push_back(below_K);
        }
    }
    [[nodiscard]] float at(double z_m) const {
        if (z_m > height_m.back()) return 0.0F;
        const auto above =
            static_cast<std::size_t>(std::lower_bound(height_m.begin(), height_m.end(), z_m) - height_m.begin());
        if (above == 0) return static_cast<float>(excess_K.front());
        const double share = (z_m - height_m[above - 1]) / (height_m[above] - height_m[above - 1]);
        return static_cast<float>(std::lerp(excess_K[above - 1], excess_K[above], share));
    }
};

}  // namespace

std::vector<std::string> wrf_plume_variables() { return {"RTHFRTEN", "U", "V", "W", "PH", "PHB", "MU", "MUB"}; }

double wrf_heating_W(const WrfSfire& wrf, const WrfMoment& moment) {
    // Dry air of 1000 hPa and 317 K; cp as WRF has it, 7/2 of 287 J kg-1 K-1.
    constexpr double kAir_kg_m3 = 1.1, kHeat_J_kg_K = 1004.5;
    const NetcdfFile file(moment.file);
    const Fields fields(file, wrf, moment.record);
    double sum_K_m_s = 0.0;
    for (int k = 0; k < fields.tendency.layers(); ++k)
        for (int row = 0; row < wrf.rows; ++row)
            for (int col = 0; col < wrf.cols; ++col)
                sum_K_m_s +=
                    fields.heating_K_s(k, row, col) * (fields.height_m(k + 1, row, col) - fields.height_m(k, row, col));
    return kAir_kg_m3 * kHeat_J_kg_K * sum_K_m_s * wrf.dx_m * wrf.dy_m;
}

std::filesystem::path wrf_plume(const WrfSfire& wrf, const WrfMoment& moment, std::span<const double> levels_m) {
    const NetcdfFile file(moment.file);
    const Fields fields(file, wrf, moment.record);
    MemoryRaster out{wrf.cols, wrf.rows, north_up(wrf.west_m, wrf.north_m, wrf.dx_m, wrf.dy_m), wrf.crs_wkt, "K", {}};
    out.bands.assign(levels_m.size(),
                     std::vector<float>(static_cast<std::size_t>(wrf.cols) * static_cast<std::size_t>(wrf.rows)));
    for (int row = 0; row < wrf.rows; ++row)
        for (int col = 0; col < wrf.cols; ++col) {
            const Column column(fields, wrf, row, col);
            const auto pixel = static_cast<std::size_t>(wrf.rows - 1 - row) * static_cast<std::size_t>(wrf.cols) +
                               static_cast<std::size_t>(col);
            for (std::size_t i = 0; i < levels_m.size(); ++i) out.bands[i][pixel] = column.at(levels_m[i]);
        }
    return keep_in_memory("wrf_plume", fmt::format("{}#{}", moment.file.string(), moment.record), "excess", out);
}

}  // namespace pyroscene::gis
