#include "gis/tiled_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include "base/error.h"
#include "gis/crs.h"
#include "gis/extent.h"

namespace pyroscene::gis {
namespace {

constexpr std::uint8_t kNoClass = 255;

std::uint8_t class_code(double value, const std::string& subject) {
    if (std::isnan(value)) return kNoClass;
    if (!(value >= 0.0 && value < kNoClass) || value != std::round(value))
        throw runtime_error(subject,
                            fmt::format("cannot be written: {} is not a class; expected integers from 0 to 254", value));
    return static_cast<std::uint8_t>(value);
}

/// CRS, transform, control points and geolocation arrays of another raster.
void copy_spatial_reference(GDALDataset& dataset, const std::filesystem::path& like) {
    const DatasetPtr source = open_raster(like);
    std::array<double, 6> transform{};
    if (source->GetGeoTransform(transform.data()) == CE_None) dataset.SetGeoTransform(transform.data());
    if (const auto* crs = source->GetSpatialRef()) dataset.SetSpatialRef(crs);
    if (source->GetGCPCount() > 0) dataset.SetGCPs(source->GetGCPCount(), source->GetGCPs(), source->GetGCPSpatialRef());
    if (char** arrays = source->GetMetadata("GEOLOCATION")) dataset.SetMetadata(arrays, "GEOLOCATION");
}

void set_spatial_reference(GDALDataset& dataset, const OutputRaster& raster) {
    if (raster.like) return copy_spatial_reference(dataset, *raster.like);
    OGRSpatialReference crs;
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    if (raster.grid) {
        crs.importFromWkt(raster.grid->crs_wkt.c_str());
        auto geotransform = geotransform_of(*raster.grid);
        dataset.SetSpatialRef(&crs);
        dataset.SetGeoTransform(geotransform.data());
        return;
    }
    if (raster.control_points.empty()) return;
    crs.importFromWkt(parse_crs(kGeographicCrs, "control points").wkt.c_str());
    std::vector<GDAL_GCP> points;
    std::string empty;
    for (const auto& p : raster.control_points)
        points.push_back({.pszId = empty.data(),
                          .pszInfo = empty.data(),
                          .dfGCPPixel = p.sample,
                          .dfGCPLine = p.line,
                          .dfGCPX = p.lon_deg,
                          .dfGCPY = p.lat_deg,
                          .dfGCPZ = p.h_m});
    dataset.SetGCPs(static_cast<int>(points.size()), points.data(), &crs);
}

void set_nodata_and_colours(GDALDataset& dataset, const OutputRaster& raster) {
    for (std::size_t i = 0; i < raster.bands.size(); ++i)
        dataset.GetRasterBand(static_cast<int>(i) + 1)
            ->SetNoDataValue(raster.classes ? kNoClass : std::numeric_limits<double>::quiet_NaN());
    if (!raster.classes || raster.bands.size() != 1) return;  // TIFF knows a colour table only for a single band
    GDALColorTable colours;
    for (std::size_t i = 0; i < raster.class_names.size(); ++i) {
        const ClassColour c = class_colour(i);
        const GDALColorEntry entry{c.red, c.green, c.blue, 255};
        colours.SetColorEntry(static_cast<int>(i), &entry);
    }
    if (!raster.class_names.empty()) dataset.GetRasterBand(1)->SetColorTable(&colours);
}

/// A tile of one band's rows, filled up beyond the raster's edge with the last pixels, which compress to nothing.
template <class Out, class In>
void fill_tile(std::vector<Out>& tile, int tile_cols, std::span<const In> rows, int cols, int row0, int col0,
               const std::string& subject) {
    const int tile_rows = static_cast<int>(tile.size()) / tile_cols, row_count = static_cast<int>(rows.size()) / cols;
    for (int r = 0; r < tile_rows; ++r) {
        const auto row = static_cast<std::size_t>(std::min(row0 + r, row_count - 1));
        const In* in = rows.data() + row * static_cast<std::size_t>(cols);
        Out* out = tile.data() + static_cast<std::size_t>(r) * static_cast<std::size_t>(tile_cols);
        for (int c = 0; c < tile_cols; ++c) {
            const In value = in[std::min(col0 + c, cols - 1)];
            if constexpr (std::is_same_v<Out, std::uint8_t>)
                out[c] = class_code(value, subject);
            else
                out[c] = static_cast<Out>(value);
        }
    }
}

int compression_threads = 0;  // see CompressionThreads

}  // namespace

CompressionThreads::CompressionThreads(int threads) noexcept : before_(std::exchange(compression_threads, threads)) {}
CompressionThreads::~CompressionThreads() { compression_threads = before_; }

Options::~Options() { CSLDestroy(list_); }

Options& Options::set(const char* key, const std::string& value) {
    list_ = CSLSetNameValue(list_, key, value.c_str());
    return *this;
}

void set_compression(Options& options, const OutputRaster& raster, const char* level_key) {
    options.set("NUM_THREADS", compression_threads > 0 ? std::to_string(compression_threads) : std::string("ALL_CPUS"));
    if (raster.compression == Compression::None) return;
    options.set("COMPRESS", raster.compression == Compression::Zstd ? "ZSTD" : "DEFLATE").set(level_key, "1");
}

GDALMajorObject& owner_of(GDALDataset& dataset, const Tag& tag) {
    if (tag.band == 0) return dataset;
    return *dataset.GetRasterBand(tag.band);
}

void require_sizes(const OutputRaster& raster, const std::string& subject) {
    if (raster.cols < 1 || raster.rows < 1 || raster.bands.empty())
        throw runtime_error(subject, fmt::format("cannot be written: {} bands of {} x {} pixels", raster.bands.size(),
                                                 raster.cols, raster.rows));
    if (raster.grid && (raster.grid->cols != raster.cols || raster.grid->rows != raster.rows))
        throw runtime_error(subject, fmt::format("cannot be written: {} x {} pixels on a map grid of {} x {}", raster.cols,
                                                 raster.rows, raster.grid->cols, raster.grid->rows));
}

TiledFile::TiledFile(const std::string& path, const OutputRaster& raster, const Layout& layout, std::string subject)
    : subject_(std::move(subject)), layout_(layout), sums_(raster.bands.size()) {
    const GdalErrors errors;
    const ThreadOption no_side_files("GDAL_PAM_ENABLED", "NO");
    Options options;
    options.set("TILED", "YES").set("BLOCKXSIZE", std::to_string(layout.tile_cols));
    options.set("BLOCKYSIZE", std::to_string(layout.tile_rows)).set("INTERLEAVE", "BAND").set("BIGTIFF", "IF_SAFER");
    set_compression(options, raster, raster.compression == Compression::Zstd ? "ZSTD_LEVEL" : "ZLEVEL");
    if (!raster.classes && raster.compression != Compression::None) options.set("PREDICTOR", "3");
    using Sample = TiffWriter::Sample;
    const GDALDataType type = raster.classes ? GDT_Byte : layout.sample == Sample::Float64 ? GDT_Float64 : GDT_Float32;
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    dataset_.reset(
        driver->Create(path.c_str(), raster.cols, raster.rows, static_cast<int>(raster.bands.size()), type, options.get()));
    if (!dataset_) throw runtime_error(subject_, "cannot be written: " + errors.message());
    set_nodata_and_colours(*dataset_, raster);
}

TiledFile::~TiledFile() {
    const ThreadOption no_side_files("GDAL_PAM_ENABLED", "NO");
    const GdalErrors quiet;  // what fails while a broken file is closed has been said
    dataset_.reset();
}

/// Whole tiles straight to the driver: GDAL's block cache would hold a second copy of everything.
template <class Out, class T>
void TiledFile::write_band(const OutputRaster& raster, const RasterPart& part, std::size_t band, std::span<const T> pixels) {
    const GdalErrors errors;
    std::vector<Out> tile(static_cast<std::size_t>(layout_.tile_cols) * static_cast<std::size_t>(layout_.tile_rows));
    for (int row = 0; row < part.rows; row += layout_.tile_rows)
        for (int col = 0; col < raster.cols; col += layout_.tile_cols) {
            fill_tile(tile, layout_.tile_cols, pixels, raster.cols, row, col, subject_);
            if (dataset_->GetRasterBand(static_cast<int>(band) + 1)
                    ->WriteBlock(col / layout_.tile_cols, (part.first_row + row) / layout_.tile_rows, tile.data()) !=
                CE_None)
                throw runtime_error(subject_, "cannot be written: " + errors.message());
        }
    sums_[band].add(pixels);
}

template <class T>
void TiledFile::write(const OutputRaster& raster, const RasterPart& part, std::span<const T> pixels) {
    const auto size = static_cast<std::size_t>(raster.cols) * static_cast<std::size_t>(part.rows);
    const bool fits = part.first_band + part.bands <= raster.bands.size() && part.first_row >= 0 &&
                      part.first_row % layout_.tile_rows == 0 && part.first_row + part.rows <= raster.rows &&
                      (part.rows % layout_.tile_rows == 0 || part.first_row + part.rows == raster.rows);
    if (!fits || pixels.size() != size * part.bands)
        throw runtime_error(
            subject_,
            fmt::format("cannot be written: {} pixels as rows {} to {} of bands {} to {}; the raster has "
                        "{} bands of {} x {} in tiles of {} rows",
                        pixels.size(), part.first_row, part.first_row + part.rows, part.first_band + 1,
                        part.first_band + part.bands, raster.bands.size(), raster.cols, raster.rows, layout_.tile_rows));
    for (std::size_t b = 0; b < part.bands; ++b) {
        const auto plane = pixels.subspan(b * size, size);
        if (raster.classes)
            write_band<std::uint8_t>(raster, part, part.first_band + b, plane);
        else
            write_band<T>(raster, part, part.first_band + b, plane);
    }
}
template void TiledFile::write(const OutputRaster&, const RasterPart&, std::span<const float>);
template void TiledFile::write(const OutputRaster&, const RasterPart&, std::span<const double>);

std::vector<Tag> TiledFile::tags(const OutputRaster& raster) const {
    std::vector<BandStatistics> statistics;
    const auto size = static_cast<std::size_t>(raster.cols) * static_cast<std::size_t>(raster.rows);
    for (const auto& sum : sums_) {
        if (sum.pixels() != size)
            throw runtime_error(subject_, fmt::format("cannot be written: band {} has {} of {} pixels",
                                                      statistics.size() + 1, sum.pixels(), size));
        statistics.push_back(sum.statistics());
    }
    return output_tags(raster, statistics, subject_);
}

void TiledFile::describe(const OutputRaster& raster) {
    set_spatial_reference(*dataset_, raster);
    for (const auto& [key, value] : raster.rpc) dataset_->SetMetadataItem(key.c_str(), value.c_str(), "RPC");
    for (std::size_t i = 0; i < raster.bands.size(); ++i) {
        GDALRasterBand& band = *dataset_->GetRasterBand(static_cast<int>(i) + 1);
        band.SetDescription(raster.bands[i].description.c_str());
        if (!raster.bands[i].unit.empty()) band.SetUnitType(raster.bands[i].unit.c_str());
    }
}

}  // namespace pyroscene::gis
