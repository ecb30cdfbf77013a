#include "gis/raster_output.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include "base/error.h"
#include "base/files.h"
#include "gis/cog_tags.h"
#include "gis/crs.h"
#include "gis/extent.h"
#include "gis/gdal_support.h"
#include "gis/tags.h"

namespace pyroscene::gis {
namespace {

constexpr int kTile = 512;
constexpr std::uint8_t kNoClass = 255;

/// GDAL's "KEY=VALUE" list.
class Options {
public:
    Options() = default;
    Options(const Options&) = delete;
    Options& operator=(const Options&) = delete;
    ~Options() { CSLDestroy(list_); }
    Options& set(const char* key, const std::string& value) {
        list_ = CSLSetNameValue(list_, key, value.c_str());
        return *this;
    }
    [[nodiscard]] char** get() const noexcept { return list_; }

private:
    char** list_ = nullptr;
};

std::string thread_count(const OutputRaster& raster) {
    return raster.threads > 0 ? std::to_string(raster.threads) : std::string("ALL_CPUS");
}

/// Level 1 of either: level 6 of DEFLATE takes 2.3 times as long to save 5 % on radiance with the floating-point predictor.
void set_compression(Options& options, const OutputRaster& raster, const char* level_key) {
    const bool zstd = raster.compression == Compression::Zstd;
    options.set("COMPRESS", zstd ? "ZSTD" : "DEFLATE").set(level_key, "1").set("NUM_THREADS", thread_count(raster));
}

void require_size(const OutputRaster& raster, std::size_t pixels, const std::string& subject) {
    const auto expected =
        static_cast<std::size_t>(raster.cols) * static_cast<std::size_t>(raster.rows) * raster.bands.size();
    if (raster.cols < 1 || raster.rows < 1 || raster.bands.empty() || pixels != expected)
        throw runtime_error(subject, fmt::format("cannot be written: {} pixels for {} bands of {} x {}", pixels,
                                                 raster.bands.size(), raster.cols, raster.rows));
    if (raster.grid && (raster.grid->cols != raster.cols || raster.grid->rows != raster.rows))
        throw runtime_error(subject, fmt::format("cannot be written: {} x {} pixels on a map grid of {} x {}", raster.cols,
                                                 raster.rows, raster.grid->cols, raster.grid->rows));
}

template <class T>
std::span<const T> band_pixels(const OutputRaster& raster, std::span<const T> pixels, std::size_t band) {
    const auto size = static_cast<std::size_t>(raster.cols) * static_cast<std::size_t>(raster.rows);
    return pixels.subspan(band * size, size);
}

template <class T>
std::vector<Tag> tags_with_statistics(const OutputRaster& raster, std::span<const T> pixels, const std::string& subject) {
    std::vector<BandStatistics> statistics;
    for (std::size_t b = 0; b < raster.bands.size(); ++b)
        statistics.push_back(band_statistics(band_pixels(raster, pixels, b)));
    return output_tags(raster, statistics, subject);
}

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

void describe_bands(GDALDataset& dataset, const OutputRaster& raster) {
    for (std::size_t i = 0; i < raster.bands.size(); ++i) {
        GDALRasterBand& band = *dataset.GetRasterBand(static_cast<int>(i) + 1);
        band.SetDescription(raster.bands[i].description.c_str());
        if (!raster.bands[i].unit.empty()) band.SetUnitType(raster.bands[i].unit.c_str());
        band.SetNoDataValue(raster.classes ? kNoClass : std::numeric_limits<double>::quiet_NaN());
    }
    if (!raster.classes || raster.bands.size() != 1) return;  // TIFF knows a colour table only for a single band
    GDALColorTable colours;
    for (std::size_t i = 0; i < raster.class_names.size(); ++i) {
        const ClassColour c = class_colour(i);
        const GDALColorEntry entry{c.red, c.green, c.blue, 255};
        colours.SetColorEntry(static_cast<int>(i), &entry);
    }
    if (!raster.class_names.empty()) dataset.GetRasterBand(1)->SetColorTable(&colours);
}

GDALMajorObject& owner_of(GDALDataset& dataset, const Tag& tag) {
    if (tag.band == 0) return dataset;
    return *dataset.GetRasterBand(tag.band);
}

/// A tile of `band`, filled up beyond the raster's edge with its last pixels, which compress to nothing.
template <class Out, class In>
void fill_tile(std::vector<Out>& tile, int tile_cols, int tile_rows, std::span<const In> band, const OutputRaster& raster,
               int col0, int row0, const std::string& subject) {
    for (int r = 0; r < tile_rows; ++r) {
        const auto row = static_cast<std::size_t>(std::min(row0 + r, raster.rows - 1));
        const In* in = band.data() + row * static_cast<std::size_t>(raster.cols);
        Out* out = tile.data() + static_cast<std::size_t>(r) * static_cast<std::size_t>(tile_cols);
        for (int c = 0; c < tile_cols; ++c) {
            const In value = in[std::min(col0 + c, raster.cols - 1)];
            if constexpr (std::is_same_v<Out, std::uint8_t>)
                out[c] = class_code(value, subject);
            else
                out[c] = value;
        }
    }
}

/// Whole tiles straight to the driver: GDAL's block cache would hold a second copy of everything.
template <class Out, class In>
void write_tiles(GDALDataset& dataset, const OutputRaster& raster, std::span<const In> pixels, const GdalErrors& errors,
                 const std::string& subject) {
    for (std::size_t b = 0; b < raster.bands.size(); ++b) {
        GDALRasterBand& band = *dataset.GetRasterBand(static_cast<int>(b) + 1);
        int tile_cols = 0, tile_rows = 0;
        band.GetBlockSize(&tile_cols, &tile_rows);
        std::vector<Out> tile(static_cast<std::size_t>(tile_cols) * static_cast<std::size_t>(tile_rows));
        for (int row = 0; row < raster.rows; row += tile_rows)
            for (int col = 0; col < raster.cols; col += tile_cols) {
                fill_tile(tile, tile_cols, tile_rows, band_pixels(raster, pixels, b), raster, col, row, subject);
                if (band.WriteBlock(col / tile_cols, row / tile_rows, tile.data()) != CE_None)
                    throw runtime_error(subject, "cannot be written: " + errors.message());
            }
    }
}

/// As few equal tiles as cover the edge, none above kTile, in TIFF's multiples of 16: 640 pixels make two tiles of 320, not
/// one of 512 and a padded one.
std::string tile_edge(int pixels) {
    const int tiles = (pixels + kTile - 1) / kTile, edge = (pixels + tiles - 1) / tiles;
    return std::to_string((edge + 15) / 16 * 16);
}

template <class T>
void write_tiled(const std::filesystem::path& path, const OutputRaster& raster, std::span<const T> pixels) {
    initialise_gdal();
    const std::string subject = path.string();
    require_size(raster, pixels.size(), subject);
    const ThreadOption no_side_files("GDAL_PAM_ENABLED", "NO");
    AtomicFile file(path);
    const GdalErrors errors;
    Options options;
    options.set("TILED", "YES").set("BLOCKXSIZE", tile_edge(raster.cols)).set("BLOCKYSIZE", tile_edge(raster.rows));
    options.set("INTERLEAVE", "BAND").set("BIGTIFF", "IF_SAFER");
    set_compression(options, raster, raster.compression == Compression::Zstd ? "ZSTD_LEVEL" : "ZLEVEL");
    if (!raster.classes) options.set("PREDICTOR", "3");
    const GDALDataType type = raster.classes ? GDT_Byte : std::is_same_v<T, double> ? GDT_Float64 : GDT_Float32;
    const int band_count = static_cast<int>(raster.bands.size());
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    DatasetPtr dataset(driver->Create(file.path().c_str(), raster.cols, raster.rows, band_count, type, options.get()));
    if (!dataset) throw runtime_error(subject, "cannot be written: " + errors.message());
    set_spatial_reference(*dataset, raster);
    describe_bands(*dataset, raster);
    for (const auto& [key, value] : raster.rpc) dataset->SetMetadataItem(key.c_str(), value.c_str(), "RPC");
    for (const Tag& tag : tags_with_statistics(raster, pixels, subject))
        owner_of(*dataset, tag).SetMetadataItem(tag.key.c_str(), tag.value.c_str(), tag.domain.c_str());
    if (raster.classes)
        write_tiles<std::uint8_t>(*dataset, raster, pixels, errors, subject);
    else
        write_tiles<T>(*dataset, raster, pixels, errors, subject);
    dataset.reset();
    if (errors.failed()) throw runtime_error(subject, "cannot be written: " + errors.message());
    file.commit();
}

/// Edge of a COG's tiles. The driver interleaves bands by pixel, so a tile holds all of them: many bands get smaller tiles,
/// 16 MB at most, and a small raster no larger ones than it needs.
int cog_tile(const OutputRaster& raster) {
    constexpr std::size_t kMostTileBytes = 16 << 20, kSmallest = 128;
    std::size_t tile = kTile;
    while (tile > kSmallest && tile * tile * sizeof(float) * raster.bands.size() > kMostTileBytes) tile /= 2;
    const auto edge = static_cast<std::size_t>(std::max(raster.cols, raster.rows));
    while (tile > kSmallest && tile / 2 >= edge) tile /= 2;
    return static_cast<int>(tile);
}

/// The pixels as a dataset without a copy. GDAL's interface is not const, but the COG driver only reads.
template <class T>
DatasetPtr memory_dataset(const OutputRaster& raster, const T* pixels, GDALDataType type) {
    DatasetPtr dataset = create_memory_dataset(raster.cols, raster.rows);
    const auto band_size = static_cast<std::size_t>(raster.cols) * static_cast<std::size_t>(raster.rows);
    for (std::size_t b = 0; b < raster.bands.size(); ++b) {
        Options options;
        options.set("DATAPOINTER", fmt::format("{}", fmt::ptr(pixels + b * band_size)));
        if (dataset->AddBand(type, options.get()) != CE_None) throw runtime_error("raster in memory", "cannot be set up");
    }
    return dataset;
}

/// Overviews of the source in memory, half the size each down to one tile. Left to itself the COG driver keeps them in a
/// compressed temporary file, which takes four times as long (and from 128 bands on, twenty times: it then unpacks a tile
/// anew for every band).
void build_overviews(GDALDataset& source, const OutputRaster& raster, int tile, const std::string& subject,
                     const GdalErrors& errors) {
    std::vector<int> factors;
    for (int factor = 2; std::max(raster.cols, raster.rows) * 2 > tile * factor; factor *= 2) factors.push_back(factor);
    if (factors.empty()) return;
    const char* method = raster.classes ? "NEAREST" : "AVERAGE";
    if (GDALBuildOverviews(&source, method, static_cast<int>(factors.size()), factors.data(), 0, nullptr, nullptr,
                           nullptr) != CE_None)
        throw runtime_error(subject, "overviews cannot be made: " + errors.message());
}

}  // namespace

void write_geotiff(const std::filesystem::path& path, const OutputRaster& raster, std::span<const float> pixels) {
    write_tiled(path, raster, pixels);
}

void write_geotiff(const std::filesystem::path& path, const OutputRaster& raster, std::span<const double> pixels) {
    write_tiled(path, raster, pixels);
}

void write_cog(const std::filesystem::path& path, const OutputRaster& raster, std::span<const float> pixels) {
    initialise_gdal();
    const std::string subject = path.string();
    require_size(raster, pixels.size(), subject);
    if (!raster.grid && !raster.like)
        throw runtime_error(subject, "cannot be written: a Cloud-Optimized GeoTIFF needs a map grid");
    const ThreadOption no_side_files("GDAL_PAM_ENABLED", "NO");
    AtomicFile file(path);
    const GdalErrors errors;
    std::vector<std::uint8_t> codes;
    if (raster.classes)
        for (const float value : pixels) codes.push_back(class_code(value, subject));
    DatasetPtr source =
        raster.classes ? memory_dataset(raster, codes.data(), GDT_Byte) : memory_dataset(raster, pixels.data(), GDT_Float32);
    set_spatial_reference(*source, raster);
    describe_bands(*source, raster);
    const CogTags tags(tags_with_statistics(raster, pixels, subject));
    for (const Tag& tag : tags.before_writing())
        owner_of(*source, tag).SetMetadataItem(tag.key.c_str(), tag.value.c_str(), tag.domain.c_str());
    const int tile = cog_tile(raster);
    build_overviews(*source, raster, tile, subject, errors);
    Options options;
    options.set("BLOCKSIZE", std::to_string(tile)).set("OVERVIEWS", "FORCE_USE_EXISTING");
    options.set("PREDICTOR", raster.classes ? "NO" : "YES").set("BIGTIFF", "IF_SAFER");
    set_compression(options, raster, "LEVEL");
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("COG");
    DatasetPtr written(driver->CreateCopy(file.path().c_str(), source.get(), 0, options.get(), nullptr, nullptr));
    const bool done = written != nullptr;
    written.reset();
    if (!done || errors.failed()) throw runtime_error(subject, "cannot be written: " + errors.message());
    tags.complete(file.path());
    file.commit();
}

}  // namespace pyroscene::gis
