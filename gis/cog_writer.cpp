#include <algorithm>

#include <fmt/format.h>
#include <gdal_priv.h>

#include "base/error.h"
#include "base/files.h"
#include "gis/cog_tags.h"
#include "gis/tiff_writer.h"
#include "gis/tiled_file.h"

namespace pyroscene::gis {
namespace {

/// Edge of a COG's tiles. The driver interleaves bands by pixel, so a tile holds all of them: many bands get smaller tiles,
/// 16 MB at most, and a small raster no larger ones than it needs.
int cog_tile(const OutputRaster& raster) {
    constexpr std::size_t kLargest = 512, kMostTileBytes = 16 << 20, kSmallest = 128;
    std::size_t tile = kLargest;
    while (tile > kSmallest && tile * tile * sizeof(float) * raster.bands.size() > kMostTileBytes) tile /= 2;
    const auto edge = static_cast<std::size_t>(std::max(raster.cols, raster.rows));
    while (tile > kSmallest && tile / 2 >= edge) tile /= 2;
    return static_cast<int>(tile);
}

/// Overviews of the waiting bands, half the size each down to one tile. Left to itself the COG driver keeps them in a
/// compressed temporary file, which takes four times as long (and from 128 bands on, twenty times: it then unpacks a tile
/// anew for every band).
bool build_overviews(GDALDataset& source, const OutputRaster& raster, int tile) {
    std::vector<int> factors;
    for (int factor = 2; std::max(raster.cols, raster.rows) * 2 > tile * factor; factor *= 2) factors.push_back(factor);
    if (factors.empty()) return true;
    const ThreadOption same_tiles("GDAL_TIFF_OVR_BLOCKSIZE", std::to_string(tile).c_str());
    return GDALBuildOverviews(&source, raster.classes ? "NEAREST" : "AVERAGE", static_cast<int>(factors.size()),
                              factors.data(), 0, nullptr, nullptr, nullptr) == CE_None;
}

OutputRaster uncompressed(OutputRaster raster) {
    raster.compression = Compression::None;
    return raster;
}

const OutputRaster& checked(const OutputRaster& raster, const std::string& subject) {
    initialise_gdal();
    require_sizes(raster, subject);
    if (!raster.grid && !raster.like)
        throw runtime_error(subject, "cannot be written: a Cloud-Optimized GeoTIFF needs a map grid");
    return raster;
}

}  // namespace

struct CogWriter::Impl {
    Impl(const std::filesystem::path& path, OutputRaster described)
        : subject(path.string()),
          raster(std::move(described)),
          tile(cog_tile(checked(raster, subject))),
          target(path),
          waiting(path.parent_path() / (path.stem().string() + "_bands.tif")),
          tiles(waiting.path().string(), uncompressed(raster), {tile, tile, TiffWriter::Sample::Float32}, subject) {}

    std::string subject;
    OutputRaster raster;
    int tile;
    AtomicFile target, waiting;
    TiledFile tiles;
};

CogWriter::CogWriter(const std::filesystem::path& path, OutputRaster raster)
    : impl_(std::make_unique<Impl>(path, std::move(raster))) {}
CogWriter::CogWriter(CogWriter&&) noexcept = default;
CogWriter::~CogWriter() = default;

void CogWriter::write_band(std::size_t band, std::span<const float> pixels) {
    impl_->tiles.write(impl_->raster, {band, 1, 0, impl_->raster.rows}, pixels);
}

void CogWriter::finish() {
    Impl& s = *impl_;
    const GdalErrors errors;
    const ThreadOption no_side_files("GDAL_PAM_ENABLED", "NO");
    s.tiles.describe(s.raster);
    const CogTags tags(s.tiles.tags(s.raster));
    for (const Tag& tag : tags.before_writing())
        owner_of(s.tiles.dataset(), tag).SetMetadataItem(tag.key.c_str(), tag.value.c_str(), tag.domain.c_str());
    Options options;
    options.set("BLOCKSIZE", std::to_string(s.tile)).set("OVERVIEWS", "FORCE_USE_EXISTING");
    options.set("PREDICTOR", s.raster.classes ? "NO" : "YES").set("BIGTIFF", "IF_SAFER");
    set_compression(options, s.raster, "LEVEL");
    const ThreadOption small_swaths("GDAL_SWATH_SIZE", "16777216");
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("COG");
    DatasetPtr written;
    if (build_overviews(s.tiles.dataset(), s.raster, s.tile))
        written.reset(driver->CreateCopy(s.target.path().c_str(), &s.tiles.dataset(), 0, options.get(), nullptr, nullptr));
    const bool done = written != nullptr;
    written.reset();
    if (!done || errors.failed()) throw runtime_error(s.subject, "cannot be written: " + errors.message());
    s.tiles.close();
    tags.complete(s.target.path());
    s.target.commit();
}

}  // namespace pyroscene::gis
