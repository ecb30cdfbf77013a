#include "gis/image_stream.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <gdal_priv.h>

#include "base/error.h"
#include "gis/band_description.h"
#include "gis/gdal_support.h"
#include "gis/tags.h"

namespace pyroscene::gis {
namespace {

constexpr GIntBig kMostCache = 64 << 20;  ///< of decoded blocks; GDAL's own default is a twentieth of the machine's memory

}  // namespace

struct ImageStream::Impl {
    struct Conversion {
        double scale = 1.0, offset = 0.0, nodata = 0.0;
        bool has_nodata = false;

        void apply(std::span<float> values) const {
            const auto none = static_cast<float>(nodata);
            if (has_nodata)
                for (float& v : values) v = v == none ? std::numeric_limits<float>::quiet_NaN() : v;
            if (scale != 1.0 || offset != 0.0)
                for (float& v : values) v = static_cast<float>(scale * static_cast<double>(v) + offset);
        }
    };
    std::filesystem::path path;
    DatasetPtr dataset;
    ImageInfo info;
    std::vector<Conversion> conversion;

    void read_window(int band, int col, int row, int cols, int rows, std::span<float> out) {
        const GdalErrors errors;
        if (dataset->GetRasterBand(band)->RasterIO(GF_Read, col, row, cols, rows, out.data(), cols, rows, GDT_Float32, 0, 0,
                                                   nullptr) != CE_None)
            throw input_error(path.string(), fmt::format("band {} cannot be read: {}", band, errors.message()));
        conversion[static_cast<std::size_t>(band) - 1].apply(out);
    }
};

ImageStream::ImageStream(const std::filesystem::path& path) : impl_(std::make_unique<Impl>()) {
    Impl& s = *impl_;
    s.path = path;
    s.dataset = open_raster(path);
    if (GDALGetCacheMax64() > kMostCache) GDALSetCacheMax64(kMostCache);
    s.info.cols = s.dataset->GetRasterXSize();
    s.info.rows = s.dataset->GetRasterYSize();
    s.info.metadata = default_metadata(*s.dataset);
    std::array<double, 6> transform{};
    s.info.on_map = s.dataset->GetSpatialRef() != nullptr && s.dataset->GetGeoTransform(transform.data()) == CE_None;
    if (const char* file = s.dataset->GetMetadataItem("X_DATASET", "GEOLOCATION"); file != nullptr)
        s.info.geolocation = file;
    for (int b = 1; b <= s.dataset->GetRasterCount(); ++b) {
        GDALRasterBand& band = *s.dataset->GetRasterBand(b);
        s.info.bands.push_back(describe_band(band));
        Impl::Conversion c{band.GetScale(), band.GetOffset(), 0.0, false};
        int has = 0;
        c.nodata = band.GetNoDataValue(&has);
        c.has_nodata = has != 0 && !std::isnan(c.nodata);
        s.conversion.push_back(c);
    }
}

ImageStream::~ImageStream() = default;
ImageStream::ImageStream(ImageStream&&) noexcept = default;
const ImageInfo& ImageStream::info() const noexcept { return impl_->info; }
const std::filesystem::path& ImageStream::path() const noexcept { return impl_->path; }

void ImageStream::read(int first, int count, std::span<float> out) {
    Impl& s = *impl_;
    const auto line = static_cast<std::size_t>(s.info.cols), plane = line * static_cast<std::size_t>(count);
    if (out.size() != plane * s.info.bands.size())
        throw runtime_error(s.path.string(),
                            fmt::format("{} values asked for, expected {}", out.size(), plane * s.info.bands.size()));
    const GdalErrors errors;
    const auto bytes = [](std::size_t values) { return static_cast<GSpacing>(values * sizeof(float)); };
    if (s.dataset->RasterIO(GF_Read, 0, first, s.info.cols, count, out.data(), s.info.cols, count, GDT_Float32,
                            static_cast<int>(s.info.bands.size()), nullptr, bytes(1), bytes(line), bytes(plane),
                            nullptr) != CE_None)
        throw input_error(s.path.string(), "cannot be read: " + errors.message());
    for (std::size_t b = 0; b < s.conversion.size(); ++b) s.conversion[b].apply(out.subspan(b * plane, plane));
}

std::vector<float> ImageStream::read_band(int band) {
    std::vector<float> out(static_cast<std::size_t>(impl_->info.cols) * static_cast<std::size_t>(impl_->info.rows));
    impl_->read_window(band, 0, 0, impl_->info.cols, impl_->info.rows, out);
    return out;
}

float ImageStream::read_value(int band, int sample, int line) {
    float value = 0.0F;
    impl_->read_window(band, sample, line, 1, 1, {&value, 1});
    return value;
}

}  // namespace pyroscene::gis
