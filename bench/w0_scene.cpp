#include "bench/w0_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>

namespace pyroscene::bench {
namespace {

constexpr int kCells = 140, kVoxelsAcross = 142, kLayers = 64;
constexpr double kCell_m = 20.0, kCorner_m = 600.0, kLayer_m = 5.0;

/// Bit-exact noise in [0, 1) from an index, so that every program renders the same flames.
double noise(std::uint64_t index) {
    std::uint64_t a = index * 0x9E3779B97F4A7C15U;
    a ^= a >> 29U;
    a *= 0xBF58476D1CE4E5B9U;
    a ^= a >> 32U;
    return static_cast<double>(a & 0xFFFFFFU) / 16777216.0;
}

double centre_m(int cell) { return kCorner_m + kCell_m * (cell + 0.5); }

/// Metres outside the fire line (negative inside).
double distance_to_line_m(int i, int j) {
    return (std::hypot((centre_m(i) - 1900.0) / 700.0, (centre_m(j) - 2000.0) / 450.0) - 1.0) * 550.0;
}

double ground_K(double outside_m) {
    if (std::abs(outside_m) < 40.0) return 273.15 + 800.0;
    if (outside_m > 0.0) return 273.15 + 34.0;
    const double since_s = -(outside_m + 40.0) / 0.5;
    return 578.97 * std::exp(-since_s / 74.88) + 197.50 * std::exp(-since_s / 247.72) + 33.19 + 273.15;
}

std::vector<fire::FlameVoxel> voxels(double half_width_m) {
    std::map<std::tuple<int, int, int>, float> hottest;
    for (int j = 0; j < kCells; ++j) {
        for (int i = 0; i < kCells; ++i) {
            if (!(std::abs(distance_to_line_m(i, j)) < half_width_m)) continue;
            const double head = std::clamp(0.5 + 0.5 * (centre_m(i) - 1200.0) / 1400.0, 0.0, 1.0);
            const double height_m = 20.0 + 140.0 * head * (0.35 + 0.65 * noise(static_cast<std::uint64_t>(j * 4096 + i)));
            const int layers = static_cast<int>(std::nearbyint(height_m / kLayer_m));
            for (int k = 0; k < std::min(layers, kLayers); ++k) {
                const int leaned = i + static_cast<int>(std::nearbyint(k * 5.0 * 0.6 / 20.0));
                if (leaned >= kVoxelsAcross) continue;
                const double f = (k + 0.5) / layers, v = noise(static_cast<std::uint64_t>((k * 256 + j) * 256 + leaned + 7));
                const auto T_K = static_cast<float>(1100.0 - 290.0 * f + 15.0 * (v - 1.0));
                float& held = hottest[{k, j, leaned}];
                held = std::max(held, T_K);
            }
        }
    }
    std::vector<fire::FlameVoxel> out;
    for (const auto& [at, T_K] : hottest) {
        out.push_back({std::get<2>(at), std::get<1>(at), std::get<0>(at), 1.0F, std::max(T_K, 795.0F)});
    }
    return out;
}

fire::FlameField flame_field(const W0Scene::Options& options, Vec3 origin_m) {
    const int split = options.voxel_split;
    fire::VoxelGrid grid;
    grid.corner_m = Vec3{kCorner_m, kCorner_m, 0.0} - origin_m;
    grid.nx = grid.ny = kVoxelsAcross * split;
    grid.dx_m = grid.dy_m = kCell_m / split;
    grid.dz_m = kLayer_m / split;
    std::vector<fire::FlameVoxel> fine;
    for (const fire::FlameVoxel& v : voxels(40.0 * options.columns_per_cell)) {
        for (int n = 0; n < split * split * split; ++n) {
            fine.push_back({v.i * split + n % split, v.j * split + n / split % split, v.k * split + n / (split * split),
                            v.fill, v.temperature_K});
        }
    }
    return make_flame_field(grid, fine);
}

}  // namespace

W0Scene::W0Scene(const Options& options) : voxel_split_(options.voxel_split) {
    MapGrid grid;
    grid.cols = grid.rows = kCells;
    grid.cell_m = kCell_m;
    grid.west_m = kCorner_m;
    grid.north_m = kCorner_m + kCells * kCell_m;
    terrain_ = std::make_unique<render::TerrainMesh>(Raster<float>(grid, "height", "m", 0.0F), origin_m_);
    cover_ = Raster<std::uint8_t>(grid, "cover", "1", 0);
    surface_.grid = grid;
    surface_.front_temperature_K = 273.15 + 800.0;
    surface_.ambient_temperature_K = 273.15 + 34.0;
    surface_.front_fraction.assign(grid.size(), 0.0F);
    surface_.base_temperature_K.resize(grid.size());
    surface_.burned.resize(grid.size());
    for (int row = 0; row < kCells; ++row) {
        for (int i = 0; i < kCells; ++i) {
            const double outside_m = distance_to_line_m(i, kCells - 1 - row);
            surface_.base_temperature_K[grid.index(row, i)] = static_cast<float>(ground_K(outside_m));
            surface_.burned[grid.index(row, i)] = outside_m < 40.0 ? 1 : 0;
        }
    }
    if (options.flame) flame_ = flame_field(options, origin_m_);
    const auto n = options.lambda_um.size();
    optics_.lambda_count = static_cast<int>(n);
    optics_.lambda_um = options.lambda_um;
    optics_.flame_absorption_per_m.assign(n, 0.3F);
    optics_.grey = options.grey;
    optics_.material_count = 1;
    optics_.reflectance.assign(n, static_cast<float>(options.reflectance));
    spectral_ = radiometry::monochromatic_grid(options.lambda_um);
    atmosphere_ = radiometry::vacuum(static_cast<int>(n));
}

render::RenderScene W0Scene::scene() const {
    render::RenderScene s;
    s.terrain = terrain_.get();
    s.surface = &surface_;
    s.cover = &cover_;
    s.flame = &flame_;
    s.optics = &optics_;
    s.spectral = &spectral_;
    s.atmosphere = &atmosphere_;
    s.scene_origin_m = origin_m_;
    s.to_sun = {0.0, 0.0, -1.0};
    return s;
}

std::vector<double> benchmark_wavelengths_um(int bands) {
    if (bands == 3) return {1.35, 4.0, 9.5};
    // Even from 1 um on in steps that meet 4.0 um: 36 bands to 11.5 um, 224 bands to 12.15 um.
    const double step_um = bands <= 36 ? 0.3 : 0.05;
    std::vector<double> lambda_um;
    for (int i = 0; i < bands; ++i) lambda_um.push_back(1.0 + step_um * i);
    return lambda_um;
}

render::SceneRay W0Camera::ray(int line, int sample) const noexcept {
    const double right = (sample + 0.5 - samples / 2.0) * pixel_rad, up = (lines / 2.0 - line - 0.5) * pixel_rad;
    const double c = std::cos(tilt_rad), s = std::sin(tilt_rad);
    // Down and north of the camera, turned about the east axis so that the line of sight still meets the scene's centre.
    const Vec3 look{0.0, s, -c}, north{0.0, c, s};
    const double range_m = 3000.0 / c;
    const Vec3 eye = -range_m * look;
    const Vec3 direction = look + right * Vec3{1.0, 0.0, 0.0} + up * north;
    return {eye, eye + (-(eye.z + 10.0) / direction.z) * direction};
}

render::ImageRequest W0Camera::request(bool terms) const {
    render::ImageRequest request;
    request.samples = samples;
    request.lines = lines;
    request.ray_weight = {1.0};
    request.terms = terms;
    request.rays = [camera = *this](int line, int begin, int end, std::span<render::SceneRay> out) {
        for (int s = begin; s < end; ++s) out[static_cast<std::size_t>(s - begin)] = camera.ray(line, s);
    };
    return request;
}

double mean_radiance(const render::RadianceImage& image, const std::vector<double>& lambda_um, double wanted_um) {
    const auto nearest = std::min_element(lambda_um.begin(), lambda_um.end(), [&](double a, double b) {
        return std::abs(a - wanted_um) < std::abs(b - wanted_um);
    });
    const std::size_t pixels = image.coverage.size();
    const float* plane = image.radiance_W_m2_sr_um.data() + static_cast<std::size_t>(nearest - lambda_um.begin()) * pixels;
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        if (!(image.coverage[i] > 0.0F)) continue;
        sum += plane[i];
        ++count;
    }
    return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

}  // namespace pyroscene::bench
