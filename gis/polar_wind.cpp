#include "gis/polar_wind.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/error.h"
#include "gis/crs.h"
#include "gis/memory_raster.h"
#include "gis/raster_source.h"
#include "gis/units.h"

namespace pyroscene::gis {
namespace {

struct Band {
    SourceBand source;
    std::vector<float> values;
};

Band read(const std::filesystem::path& file, const std::string& crs) {
    if (file.stem().string().ends_with("_cld"))
        throw input_error(file.string(), "is WindNinja's cloud cover; expected a speed (_vel) or an angle (_ang)");
    Band band{open_band(with_crs(file, crs, "inputs.wind.windninja.crs"), 1, ""), {}};
    band.values = read_window(band.source, {0, 0, band.source.cols, band.source.rows});
    return band;
}

/// Azimuth of the map's y axis, clockwise from true north, at each pixel [rad]; 0 in geographic systems.
class GridNorth {
public:
    explicit GridNorth(const SourceBand& source)
        : source_(source), to_lonlat_(source.crs.wkt, kGeographicCrs), geographic_(source.crs.geographic) {}

    [[nodiscard]] double azimuth_rad(int col, int row) const {
        if (geographic_) return 0.0;
        const auto& gt = source_.geotransform;
        constexpr double kHalfStep_m = 30.0;
        return y_axis_azimuth_rad(to_lonlat_, gt[0] + gt[1] * (col + 0.5) + gt[2] * (row + 0.5),
                                  gt[3] + gt[4] * (col + 0.5) + gt[5] * (row + 0.5),
                                  kHalfStep_m / source_.crs.metres_per_unit);
    }

private:
    const SourceBand& source_;
    CrsTransform to_lonlat_;
    bool geographic_;
};

double speed_m_s(float stored, double scale, const std::string& subject) {
    constexpr double kStrongest_m_s = 150.0;
    const double speed = scale * static_cast<double>(stored);
    if (speed < 0.0 || speed > kStrongest_m_s)
        throw input_error(
            subject, fmt::format("holds a wind of {:g} m/s, expected 0 to {:g}; is its unit wrong?", speed, kStrongest_m_s));
    return speed;
}

double angle_rad(float stored, const std::string& subject) {
    if (stored < -360.0F || stored > 720.0F)
        throw input_error(subject, fmt::format("holds an angle of {:g} degrees, expected 0 to 360", stored));
    return static_cast<double>(stored) * kDegree_rad;
}

}  // namespace

std::filesystem::path wind_components(const PolarWind& wind) {
    const Band speed = read(wind.speed, wind.crs), angle = read(wind.angle, wind.crs);
    const SourceBand& grid = speed.source;
    if (angle.source.cols != grid.cols || angle.source.rows != grid.rows || angle.source.geotransform != grid.geotransform)
        throw input_error(wind.angle.string(), fmt::format("has not the pixels of {}", wind.speed.string()));
    const auto unit = unit_conversion(wind.unit, "m s-1");
    if (!unit) throw input_error(wind.speed.string(), fmt::format("unit '{}' is none of a speed", wind.unit));
    const GridNorth north(grid);
    MemoryRaster out{grid.cols, grid.rows, grid.geotransform, grid.crs.wkt, "m s-1", {}};
    out.bands.assign(2, std::vector<float>(speed.values.size(), std::numeric_limits<float>::quiet_NaN()));
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col) {
            const auto i =
                static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.cols) + static_cast<std::size_t>(col);
            if (std::isnan(speed.values[i])) continue;
            const double s = speed_m_s(speed.values[i], unit->scale, wind.speed.string());
            if (s > 0.0 && std::isnan(angle.values[i])) continue;
            const double from = s > 0.0 ? angle_rad(angle.values[i], wind.angle.string()) : 0.0;
            const double from_y_axis = from - (wind.grid_north ? 0.0 : north.azimuth_rad(col, row));
            out.bands[0][i] = static_cast<float>(-s * std::sin(from_y_axis));
            out.bands[1][i] = static_cast<float>(-s * std::cos(from_y_axis));
        }
    return keep_in_memory(
        "polar_wind",
        fmt::format("{}|{}|{}|{}|{}", wind.speed.string(), wind.angle.string(), wind.unit, wind.crs, wind.grid_north),
        "components", out);
}

}  // namespace pyroscene::gis
