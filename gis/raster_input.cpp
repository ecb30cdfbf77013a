#include "gis/raster_input.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <gdal_priv.h>

#include "base/error.h"
#include "gis/gdal_support.h"
#include "gis/raster_source.h"
#include "gis/resample.h"
#include "gis/tags.h"

namespace pyroscene::gis {
namespace {

BandInfo band_info(GDALRasterBand& band) {
    BandInfo info;
    info.description = band.GetDescription();
    info.unit = band.GetUnitType();
    int present = 0;
    if (const double nodata = band.GetNoDataValue(&present); present != 0) info.nodata = nodata;
    info.scale = band.GetScale();
    info.offset = band.GetOffset();
    info.metadata = default_metadata(band);
    return info;
}

std::vector<BandInfo> band_list(GDALDataset& dataset) {
    std::vector<BandInfo> bands;
    for (int b = 1; b <= dataset.GetRasterCount(); ++b) bands.push_back(band_info(*dataset.GetRasterBand(b)));
    return bands;
}

}  // namespace

bool is_in_memory(const std::filesystem::path& name) { return name.string().starts_with("/vsimem/"); }

RasterInfo read_info(const std::filesystem::path& path) {
    const DatasetPtr dataset = open_raster(path);
    RasterInfo info;
    info.path = path.string();
    info.cols = dataset->GetRasterXSize();
    info.rows = dataset->GetRasterYSize();
    info.geotransform = require_geotransform(*dataset, info.path);
    if (const char* wkt = dataset->GetProjectionRef(); wkt != nullptr && *wkt != '\0') {
        const CrsInfo crs = parse_crs(wkt, info.path);
        info.crs_wkt = crs.wkt;
        info.geographic = crs.geographic;
    }
    info.bands = band_list(*dataset);
    info.metadata = default_metadata(*dataset);
    return info;
}

std::vector<BandInfo> read_band_list(const std::filesystem::path& path) { return band_list(*open_raster(path)); }

Raster<float> read_band(const BandRequest& request, const MapGrid& grid) {
    SourceBand source = open_band(request.file, request.band, request.unit);
    source.least = request.least;
    Raster<float> raster;
    raster.grid = grid;
    raster.name = request.name;
    raster.unit = request.unit;
    raster.values = resample(source, grid, request.resampling);
    return raster;
}

Raster<int> read_classes(const std::filesystem::path& file, int band, const MapGrid& grid, int nodata_value) {
    const SourceBand source = open_band(file, band, "");
    const std::vector<float> values = resample(source, grid, Resampling::Nearest);
    Raster<int> classes(grid, "class", "1", nodata_value);
    constexpr float kLargest = 16777216.0f;  // integers beyond are not exact in float
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (std::isnan(values[i])) continue;
        if (values[i] != std::round(values[i]) || std::abs(values[i]) > kLargest)
            throw input_error(source.subject, fmt::format("holds {}; expected integer classes", values[i]));
        classes.values[i] = static_cast<int>(values[i]);
    }
    return classes;
}

}  // namespace pyroscene::gis
