#include "gis/raster_source.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <fmt/format.h>
#include <gdal_priv.h>

#include "base/error.h"
#include "gis/units.h"

namespace pyroscene::gis {

std::array<double, 6> require_geotransform(GDALDataset& dataset, const std::string& subject) {
    std::array<double, 6> gt{};
    if (dataset.GetGeoTransform(gt.data()) != CE_None)
        throw input_error(subject, "has no georeference (geotransform); expected a raster that says where its pixels lie");
    if (gt[1] * gt[5] - gt[2] * gt[4] == 0.0)
        throw input_error(subject, fmt::format("has a degenerate georeference: pixel vectors ({}, {}) and ({}, {})", gt[1],
                                               gt[4], gt[2], gt[5]));
    return gt;
}

CrsInfo require_crs(GDALDataset& dataset, const std::string& subject) {
    const char* wkt = dataset.GetProjectionRef();
    if (wkt == nullptr || *wkt == '\0')
        throw input_error(subject,
                          "has no coordinate reference system; expected one in the file (gdal_edit.py -a_srs EPSG:... "
                          "adds it)");
    CrsInfo crs = parse_crs(wkt, subject);
    if (!crs.geographic && !crs.projected)
        throw input_error(subject,
                          fmt::format("the coordinate reference system '{}' is neither geographic nor projected", crs.name));
    return crs;
}

SourceBand open_band(const std::filesystem::path& path, int band, const std::string& unit) {
    SourceBand source;
    source.dataset = open_raster(path);
    source.cols = source.dataset->GetRasterXSize();
    source.rows = source.dataset->GetRasterYSize();
    source.geotransform = require_geotransform(*source.dataset, path.string());
    source.crs = require_crs(*source.dataset, path.string());
    choose_band(source, path, band, unit);
    return source;
}

void choose_band(SourceBand& source, const std::filesystem::path& path, int band, const std::string& unit) {
    const int count = source.dataset->GetRasterCount();
    if (band < 1 || band > count)
        throw input_error(path.string(),
                          fmt::format("band {} is asked for, found {} band{}", band, count, count == 1 ? "" : "s"));
    source.subject = fmt::format("{}, band {}", path.string(), band);
    source.band = band;
    source.scale = 1.0;
    source.offset = 0.0;
    if (unit.empty()) return;
    GDALRasterBand* pixels = source.dataset->GetRasterBand(band);
    if (GDALDataTypeIsComplex(pixels->GetRasterDataType()) != 0)
        throw input_error(source.subject, "holds complex numbers; expected real ones");
    const UnitConversion to_canonical = require_unit(source.subject, pixels->GetUnitType(), unit);
    source.scale = to_canonical.scale * pixels->GetScale();
    source.offset = to_canonical.scale * pixels->GetOffset() + to_canonical.offset;
}

namespace {

void convert_rows(const std::vector<double>& stored, const std::vector<std::uint8_t>& mask, const SourceBand& source,
                  float* out) {
    for (std::size_t i = 0; i < stored.size(); ++i) {
        const auto value = static_cast<float>(source.scale * stored[i] + source.offset);
        const bool valid = (mask.empty() || mask[i] != 0) && std::isfinite(value) && value >= source.least;
        out[i] = valid ? value : std::numeric_limits<float>::quiet_NaN();
    }
}

}  // namespace

std::vector<float> read_window(const SourceBand& source, const PixelWindow& window) {
    const GdalErrors errors;
    GDALRasterBand* pixels = source.dataset->GetRasterBand(source.band);
    const bool has_mask = (pixels->GetMaskFlags() & GMF_ALL_VALID) == 0;
    std::vector<float> values(window.size());
    const int step = std::clamp((1 << 20) / window.cols, 1, window.rows);
    std::vector<double> stored;
    std::vector<std::uint8_t> mask;
    for (int row = 0; row < window.rows; row += step) {
        const int n = std::min(step, window.rows - row);
        const std::size_t count = static_cast<std::size_t>(n) * static_cast<std::size_t>(window.cols);
        stored.resize(count);
        CPLErr status = pixels->RasterIO(GF_Read, window.col, window.row + row, window.cols, n, stored.data(), window.cols,
                                         n, GDT_Float64, 0, 0, nullptr);
        if (has_mask && status == CE_None) {
            mask.resize(count);
            status = pixels->GetMaskBand()->RasterIO(GF_Read, window.col, window.row + row, window.cols, n, mask.data(),
                                                     window.cols, n, GDT_Byte, 0, 0, nullptr);
        }
        if (status != CE_None) throw input_error(source.subject, "cannot be read: " + errors.message());
        convert_rows(stored, mask, source,
                     values.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(window.cols));
    }
    return values;
}

}  // namespace pyroscene::gis
