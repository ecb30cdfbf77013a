#include "gis/tiff_writer.h"

#include <algorithm>

#include <gdal_priv.h>

#include "base/error.h"
#include "base/files.h"
#include "gis/tiled_file.h"

namespace pyroscene::gis {
namespace {

constexpr int kTile = 512;

/// As few equal tiles as cover the edge, none above `most`, in TIFF's multiples of 16: 640 pixels make two tiles of 320, not
/// one of 512 and a padded one.
int tile_edge(int pixels, int most) {
    const int tiles = (pixels + most - 1) / most, edge = (pixels + tiles - 1) / tiles;
    return (edge + 15) / 16 * 16;
}

TiledFile::Layout layout_of(const OutputRaster& raster, TiffWriter::Sample sample) {
    const auto values = static_cast<std::size_t>(raster.cols) * raster.bands.size();
    const int most = std::min(kTile, raster.tile_rows > 0 ? raster.tile_rows : rows_of_part(values, raster.rows));
    return {tile_edge(raster.cols, kTile), tile_edge(raster.rows, most), sample};
}

/// Checked before a temporary file is made.
const OutputRaster& checked(const OutputRaster& raster, const std::string& subject) {
    initialise_gdal();
    require_sizes(raster, subject);
    return raster;
}

}  // namespace

int rows_of_part(std::size_t values_per_row, int rows) noexcept {
    constexpr std::size_t kMostBytes = 64 << 20;
    const auto fit = kMostBytes / (sizeof(float) * std::max<std::size_t>(values_per_row, 1)) / 16 * 16;
    const auto whole = (static_cast<std::size_t>(std::max(rows, 1)) + 15) / 16 * 16;
    return static_cast<int>(std::clamp<std::size_t>(fit, 16, whole));
}

struct TiffWriter::Impl {
    Impl(const std::filesystem::path& path, OutputRaster described, Sample sample)
        : raster(std::move(described)),
          layout(layout_of(checked(raster, path.string()), sample)),
          target(path),
          tiles(target.path().string(), raster, layout, path.string()),
          subject(path.string()) {}

    OutputRaster raster;
    TiledFile::Layout layout;
    AtomicFile target;
    TiledFile tiles;
    std::string subject;
};

TiffWriter::TiffWriter(const std::filesystem::path& path, OutputRaster raster, Sample sample)
    : impl_(std::make_unique<Impl>(path, std::move(raster), sample)) {}
TiffWriter::TiffWriter(TiffWriter&&) noexcept = default;
TiffWriter::~TiffWriter() = default;

const OutputRaster& TiffWriter::raster() const noexcept { return impl_->raster; }
int TiffWriter::tile_rows() const noexcept { return impl_->layout.tile_rows; }

void TiffWriter::write(const RasterPart& part, std::span<const float> pixels) {
    impl_->tiles.write(impl_->raster, part, pixels);
}
void TiffWriter::write(const RasterPart& part, std::span<const double> pixels) {
    impl_->tiles.write(impl_->raster, part, pixels);
}

void TiffWriter::set_control_points(std::vector<GroundControlPoint> points) {
    impl_->raster.control_points = std::move(points);
}

void TiffWriter::finish() {
    Impl& s = *impl_;
    const GdalErrors errors;
    const ThreadOption no_side_files("GDAL_PAM_ENABLED", "NO");
    s.tiles.describe(s.raster);
    for (const Tag& tag : s.tiles.tags(s.raster))
        owner_of(s.tiles.dataset(), tag).SetMetadataItem(tag.key.c_str(), tag.value.c_str(), tag.domain.c_str());
    s.tiles.close();
    if (errors.failed()) throw runtime_error(s.subject, "cannot be written: " + errors.message());
    s.target.commit();
}

}  // namespace pyroscene::gis
