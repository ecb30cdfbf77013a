#include "gis/pixel_positions.h"

#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <GeographicLib/Ellipsoid.hpp>

#include "base/constants.h"
#include "base/error.h"
#include "gis/crs.h"
#include "gis/gdal_support.h"
#include "gis/raster_output.h"

namespace pyroscene::gis {
namespace {

std::string wkt_of(const OGRSpatialReference& crs) {
    char* text = nullptr;
    crs.exportToWkt(&text);
    const std::string wkt = text != nullptr ? text : "";
    CPLFree(text);
    return wkt;
}

void from_transform(GDALDataset& dataset, const std::array<double, 6>& t, PixelPositions& out) {
    const CrsTransform to_lonlat(wkt_of(*dataset.GetSpatialRef()), kGeographicCrs);
    for (int line = 0; line < out.lines; ++line) {
        for (int sample = 0; sample < out.samples; ++sample) {
            out.lon_deg.push_back(t[0] + (sample + 0.5) * t[1] + (line + 0.5) * t[2]);
            out.lat_deg.push_back(t[3] + (sample + 0.5) * t[4] + (line + 0.5) * t[5]);
        }
    }
    to_lonlat.forward(out.lon_deg, out.lat_deg);
}

std::vector<double> geolocation_plane(const char* file, const char* band, const PixelPositions& like,
                                      const std::string& subject) {
    if (file == nullptr) throw input_error(subject, "its geolocation names no file of coordinates");
    const int number = band != nullptr ? std::atoi(band) : 1;
    const ImageFile image = read_image(file, number);
    if (image.cols != like.samples || image.rows != like.lines)
        throw input_error(subject, fmt::format("its geolocation arrays have {} x {} values, expected {} x {}", image.cols,
                                               image.rows, like.samples, like.lines));
    const auto n = static_cast<std::ptrdiff_t>(image.cols) * image.rows;
    return {image.pixels.begin() + (number - 1) * n, image.pixels.begin() + number * n};
}

/// Spacing of the pixels from central differences, in metres of the local ellipsoid.
void measure(PixelPositions& out) {
    const GeographicLib::Ellipsoid& earth = GeographicLib::Ellipsoid::WGS84();
    const auto n = out.lon_deg.size();
    const float none = std::numeric_limits<float>::quiet_NaN();
    out.area_m2.assign(n, none);
    out.width_m.assign(n, none);
    out.height_m.assign(n, none);
    const auto at = [&](int sample, int line) {
        return static_cast<std::size_t>(line) * static_cast<std::size_t>(out.samples) + static_cast<std::size_t>(sample);
    };
    for (int line = 0; line < out.lines; ++line) {
        for (int sample = 0; sample < out.samples; ++sample) {
            const int s0 = std::max(sample - 1, 0), s1 = std::min(sample + 1, out.samples - 1);
            const int l0 = std::max(line - 1, 0), l1 = std::min(line + 1, out.lines - 1);
            if (s0 == s1 || l0 == l1) continue;
            const double lat_deg = out.lat_deg[at(sample, line)];
            const double east_m = earth.CircleRadius(lat_deg) * kDegree_rad;
            const double north_m = earth.MeridionalCurvatureRadius(lat_deg) * kDegree_rad;
            const auto step = [&](std::size_t from, std::size_t to, int pixels) {
                return std::array{std::remainder(out.lon_deg[to] - out.lon_deg[from], 360.0) * east_m / pixels,
                                  (out.lat_deg[to] - out.lat_deg[from]) * north_m / pixels};
            };
            const auto across = step(at(s0, line), at(s1, line), s1 - s0),
                       along = step(at(sample, l0), at(sample, l1), l1 - l0);
            const std::size_t i = at(sample, line);
            out.area_m2[i] = static_cast<float>(std::abs(across[0] * along[1] - across[1] * along[0]));
            out.width_m[i] = static_cast<float>(std::hypot(across[0], across[1]));
            out.height_m[i] = static_cast<float>(std::hypot(along[0], along[1]));
        }
    }
}

}  // namespace

PixelPositions pixel_positions(const std::filesystem::path& path) {
    const DatasetPtr dataset = open_raster(path);
    PixelPositions out;
    out.samples = dataset->GetRasterXSize();
    out.lines = dataset->GetRasterYSize();
    std::array<double, 6> transform{};
    if (dataset->GetSpatialRef() != nullptr && dataset->GetGeoTransform(transform.data()) == CE_None) {
        from_transform(*dataset, transform, out);
    } else {
        const char* x = dataset->GetMetadataItem("X_DATASET", "GEOLOCATION");
        if (x == nullptr) throw input_error(path.string(), "has neither a CRS with a transform nor geolocation arrays");
        out.lon_deg = geolocation_plane(x, dataset->GetMetadataItem("X_BAND", "GEOLOCATION"), out, path.string());
        out.lat_deg = geolocation_plane(dataset->GetMetadataItem("Y_DATASET", "GEOLOCATION"),
                                        dataset->GetMetadataItem("Y_BAND", "GEOLOCATION"), out, path.string());
    }
    measure(out);
    return out;
}

}  // namespace pyroscene::gis
