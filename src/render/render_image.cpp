#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/error.h"
#include "render/band_output.h"
#include "render/parallel.h"
#include "render/pixel.h"
#include "render/pixel_parts.h"
#include "render/scene.h"

namespace pyroscene::render {
namespace {

constexpr int kTileSamples = 128;  // pixels a thread renders before it writes them out plane by plane
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

void check_request(const ImageRequest& request) {
    if (request.samples < 1 || request.lines < 1 || request.rays_per_pixel < 1) {
        throw input_error("image", fmt::format("{} x {} pixels of {} rays, expected at least one of each", request.samples,
                                               request.lines, request.rays_per_pixel));
    }
    if (request.ray_weight.size() != static_cast<std::size_t>(request.rays_per_pixel)) {
        throw input_error("image", fmt::format("{} ray weights, expected one for each of {} rays per pixel",
                                               request.ray_weight.size(), request.rays_per_pixel));
    }
    if (!request.rays) throw input_error("image", "no source of rays");
    if (request.parts && request.parts_per_axis * request.parts_per_axis != request.rays_per_pixel) {
        throw input_error("image", fmt::format("{} shares along an axis of a pixel, expected the root of {} rays",
                                               request.parts_per_axis, request.rays_per_pixel));
    }
}

/// Terms of the scene: the last ones belong to plumes.
int term_count(const RenderScene& scene) {
    static_assert(static_cast<int>(Term::SmokeEmission) == kTermCount - kSmokeTermCount);
    return has_plume(scene) ? kTermCount : kTermCount - kSmokeTermCount;
}

/// Room for some lines; the values of the image before stay until they are overwritten, all of them.
void make_room(const RenderScene& scene, const ImageRequest& request, int first_line, int lines, RadianceImage& image) {
    image.samples = request.samples;
    image.first_line = first_line;
    image.lines = lines;
    image.bands = scene.spectral->band_count();
    const std::size_t pixels = static_cast<std::size_t>(request.samples) * static_cast<std::size_t>(lines);
    const std::size_t cube = pixels * static_cast<std::size_t>(image.bands);
    image.radiance_W_m2_sr_um.resize(cube);
    if (request.terms) {
        for (int t = 0; t < term_count(scene); ++t) image.terms[static_cast<std::size_t>(t)].resize(cube);
    }
    for (auto* plane : {&image.hit_x_m, &image.hit_y_m, &image.hit_z_m}) plane->resize(pixels);
    for (auto* plane :
         {&image.coverage, &image.flame_fraction, &image.front_fraction, &image.scar_fraction, &image.background_fraction,
          &image.flame_temperature_K, &image.ground_temperature_K, &image.radiant_exitance_W_m2}) {
        plane->resize(pixels);
    }
    if (has_plume(scene)) image.smoke_fraction.resize(pixels);
}

void write_truth(const PixelTruth& truth, std::size_t at, RadianceImage& image) {
    const auto ratio = [](double sum, double of) { return of > 0.0 ? sum / of : static_cast<double>(kNaN); };
    const auto share = [&](double sum) { return ratio(sum, truth.seen); };
    const double placed = truth.seen - truth.sky;
    image.coverage[at] = static_cast<float>(truth.coverage);
    image.hit_x_m[at] = ratio(truth.hit_m.x, placed);
    image.hit_y_m[at] = ratio(truth.hit_m.y, placed);
    image.hit_z_m[at] = ratio(truth.hit_m.z, placed);
    image.flame_fraction[at] = static_cast<float>(share(truth.flame));
    if (!image.smoke_fraction.empty()) image.smoke_fraction[at] = static_cast<float>(share(truth.smoke));
    image.front_fraction[at] = static_cast<float>(share(truth.front));
    image.scar_fraction[at] = static_cast<float>(share(truth.scar));
    image.background_fraction[at] = static_cast<float>(share(truth.background));
    image.radiant_exitance_W_m2[at] = static_cast<float>(share(truth.exitance_W_m2));
    const auto temperature = [](double T4_sum, double weight) {
        return weight > 0.0 ? static_cast<float>(std::sqrt(std::sqrt(T4_sum / weight))) : kNaN;
    };
    image.flame_temperature_K[at] = temperature(truth.flame_T4, truth.flame);
    image.ground_temperature_K[at] = temperature(truth.ground_T4, truth.front + truth.scar + truth.background);
}

/// Renders tiles: kTileSamples pixels of one line. One per thread.
class TileRenderer {
public:
    /// \param detail  null: the rays of the request as they are
    TileRenderer(const PreparedScene& prepared, const ImageRequest& request, const FireDetail* detail)
        : request_(request),
          terrain_(*prepared.scene.terrain),
          bands_(prepared.scene.spectral->band_count()),
          quantities_(request.terms ? 1 + term_count(prepared.scene) : 1),
          pixel_(prepared),
          output_(prepared, request.terms),
          rays_(static_cast<std::size_t>(kTileSamples) * static_cast<std::size_t>(request.rays_per_pixel)),
          hits_(rays_.size()),
          buffer_(static_cast<std::size_t>(kTileSamples) * static_cast<std::size_t>(quantities_ * bands_)) {
        if (detail != nullptr) parts_.emplace(*detail, request);
    }

    void render(int line, int begin, int end, RadianceImage& image) {
        const auto rays_per_pixel = static_cast<std::size_t>(request_.rays_per_pixel);
        const std::span<SceneRay> rays(rays_.data(), static_cast<std::size_t>(end - begin) * rays_per_pixel);
        const bool by_parts = parts_ && parts_->begin(line, begin, end);
        if (!by_parts) {
            request_.rays(line, begin, end, rays);
            terrain_.intersect(rays, hits_);
        }
        for (int sample = begin; sample < end; ++sample) {
            pixel_.begin();
            if (by_parts) {
                parts_->trace(sample, pixel_);
            } else {
                const auto first = static_cast<std::size_t>(sample - begin) * rays_per_pixel;
                for (std::size_t r = 0; r < rays_per_pixel; ++r) {
                    const SceneRay& ray = rays[first + r];
                    if (const auto met = pixel_.meet(ray, hits_[first + r])) pixel_.add(ray, *met, request_.ray_weight[r]);
                }
            }
            pixel_.finish();
            const PixelTruth& truth = pixel_.truth();
            write_truth(truth, index(image, line, sample), image);
            float* out = buffer_.data() + static_cast<std::ptrdiff_t>(sample - begin) * (quantities_ * bands_);
            if (!(truth.seen > 0.0)) {
                std::fill(out, out + quantities_ * bands_, kNaN);
                continue;
            }
            PixelView view;
            if (output_.needs_view() && request_.view)
                view = request_.view(line, sample, truth.hit_m / std::max(truth.seen - truth.sky, 1e-30));
            output_.compute(pixel_, view, out, out + bands_);
        }
        write_planes(line, begin, end, image);
    }

private:
    static std::size_t index(const RadianceImage& image, int line, int sample) {
        return static_cast<std::size_t>(line - image.first_line) * static_cast<std::size_t>(image.samples) +
               static_cast<std::size_t>(sample);
    }

    /// From [pixel][quantity][band] of the tile to [band][line][sample] of the image: runs of a tile's length.
    void write_planes(int line, int begin, int end, RadianceImage& image) const {
        const std::size_t plane = image.coverage.size(), first = index(image, line, begin);
        for (int q = 0; q < quantities_; ++q) {
            float* cube = q == 0 ? image.radiance_W_m2_sr_um.data() : image.terms[static_cast<std::size_t>(q - 1)].data();
            spectral_kernels().transpose(end - begin, bands_, buffer_.data() + static_cast<std::ptrdiff_t>(q) * bands_,
                                         quantities_ * bands_, cube + first, static_cast<long>(plane));
        }
    }

    const ImageRequest& request_;
    const TerrainMesh& terrain_;
    int bands_, quantities_;
    Pixel pixel_;
    BandOutput output_;
    std::vector<SceneRay> rays_;
    std::vector<std::optional<TerrainMesh::Hit>> hits_;  ///< of these
    std::optional<PartTracer> parts_;
    std::vector<float> buffer_;  ///< [pixel of the tile][total, terms...][band]
};

}  // namespace

struct ImageRenderer::Impl {
    Impl(const RenderScene& scene, const GroundIrradiance* flame_light, const ImageRequest& wanted, const Monitor& monitor)
        : request(wanted), prepared(scene, flame_light), progress(monitor, request.lines * tiles_per_line()) {
        if (!request.parts) return;
        detail.emplace(scene, flame_light);
        if (!std::isfinite(detail->finest_spacing_m(1.0))) detail.reset();  // nothing burns
    }
    [[nodiscard]] int tiles_per_line() const { return (request.samples + kTileSamples - 1) / kTileSamples; }

    const ImageRequest& request;
    const PreparedScene prepared;
    std::optional<FireDetail> detail;
    Progress progress;
    tbb::enumerable_thread_specific<TileRenderer> renderers{
        [this] { return TileRenderer(prepared, request, detail ? &*detail : nullptr); }};
};

ImageRenderer::ImageRenderer(const RenderScene& scene, const GroundIrradiance* flame_light, const ImageRequest& request,
                             const Monitor& monitor) {
    check_scene(scene);
    check_request(request);
    impl_ = std::make_unique<Impl>(scene, flame_light, request, monitor);
}

ImageRenderer::~ImageRenderer() = default;

void ImageRenderer::render(int first, int count, RadianceImage& out) {
    Impl& s = *impl_;
    make_room(s.prepared.scene, s.request, first, count, out);
    const int across = s.tiles_per_line();
    tbb::parallel_for(tbb::blocked_range<int>(0, count * across, 1), [&](const tbb::blocked_range<int>& tiles) {
        TileRenderer& renderer = s.renderers.local();
        for (int tile = tiles.begin(); tile != tiles.end(); ++tile) {
            s.progress.stop_if_cancelled();
            const int sample = tile % across * kTileSamples;
            renderer.render(first + tile / across, sample, std::min(sample + kTileSamples, s.request.samples), out);
            s.progress.advance();
        }
    });
}

RadianceImage render_image(const RenderScene& scene, const GroundIrradiance* flame_light, const ImageRequest& request,
                           const Monitor& monitor) {
    RadianceImage image;
    ImageRenderer(scene, flame_light, request, monitor).render(0, request.lines, image);
    return image;
}

}  // namespace pyroscene::render
