#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gdal_priv.h>

#include "gis/raster_output.h"
#include "unit/gis/source_raster.h"

namespace pyroscene::gis {

struct CloseDataset {
    void operator()(GDALDataset* dataset) const noexcept { GDALClose(dataset); }
};
using TestDataset = std::unique_ptr<GDALDataset, CloseDataset>;

inline TestDataset open_written(const std::filesystem::path& path) {
    GDALAllRegister();
    return TestDataset(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER));
}

/// One metadata item, "(none)" when it is not there.
inline std::string item(GDALMajorObject* object, const char* key, const char* domain = "") {
    const char* value = object->GetMetadataItem(key, domain);
    return value == nullptr ? "(none)" : value;
}

/// Two radiance bands on a UTM grid.
inline OutputRaster two_bands(int cols, int rows) {
    OutputRaster raster;
    raster.cols = cols, raster.rows = rows;
    raster.bands = {
        {.description = "MWIR 3.0-5.0 um radiance",
         .unit = "W m-2 sr-1 um-1",
         .wavelength_um = 3.95,
         .fwhm_um = 1.5,
         .metadata = {{"band_id", "MWIR"}}},
        {.description = "LWIR, wide", .unit = "W m-2 sr-1 um-1", .wavelength_um = 9.5, .fwhm_um = 2.5, .metadata = {}}};
    raster.grid = MapGrid{
        .cols = cols, .rows = rows, .west_m = 713982.992, .north_m = 5179253.117, .cell_m = 3.0, .crs_wkt = wkt_of(32611)};
    raster.metadata = {{"run", "abc <&> \"quoted\""}};
    raster.acquisition_time = "2017-07-15T23:00:01.250Z";
    return raster;
}

/// Smooth values with a hole of nodata, [band][row][col].
inline std::vector<float> two_bands_of_pixels(int cols, int rows) {
    std::vector<float> pixels;
    for (int b = 0; b < 2; ++b)
        for (int r = 0; r < rows; ++r)
            for (int c = 0; c < cols; ++c)
                pixels.push_back(c < 5 && r < 7 ? std::numeric_limits<float>::quiet_NaN()
                                                : static_cast<float>(b * 1000 + r + 0.01 * c));
    return pixels;
}

}  // namespace pyroscene::gis
