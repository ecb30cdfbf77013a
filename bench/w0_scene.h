#pragma once

#include <memory>
#include <vector>

#include "render/scene.h"

namespace pyroscene::bench {

/// Benchmark scene W0: an elliptic fire line on flat ground, after the grid of the thesis (section 5.2, appendix C.3).
///   ground   140 x 140 cells of 20 m, south-west corner at (600, 600); 34 degC, a front four cells wide at 800 degC along an
///            ellipse around (1900, 2000) with semi-axes 700 and 450 m, inside it the scar of eq 4.18 behind a front that
///            moved 0.5 m/s
///   flame    142 x 142 x 64 voxels of 20 x 20 x 5 m, south-west-bottom corner at (600, 600, 0); a column over each front cell,
///            20 to 160 m high, taller downwind (east), leaning 0.6 m per m; 1100 K at the base, 290 K less at the top
///   optics   grey flame of 0.3 /m, black ground (or a given reflectance), no air
/// Everything is deterministic.
class W0Scene {
public:
    struct Options {
        std::vector<double> lambda_um{1.35, 4.0, 9.5};
        double reflectance = 0.0;  ///< of the ground; its emissivity is 1 minus this
        int voxel_split = 1;       ///< every voxel cut into this many along each axis: the same field, more voxels
        int columns_per_cell = 1;  ///< > 1 repeats the ring inwards: more occupied voxels
        bool flame = true;
        bool grey = true;
    };
    explicit W0Scene(const Options& options);

    [[nodiscard]] render::RenderScene scene() const;
    [[nodiscard]] const fire::FlameField& flame() const noexcept { return flame_; }
    [[nodiscard]] const fire::SurfaceField& surface() const noexcept { return surface_; }
    [[nodiscard]] int voxel_split() const noexcept { return voxel_split_; }
    [[nodiscard]] const std::vector<double>& lambda_um() const noexcept { return optics_.lambda_um; }

private:
    int voxel_split_ = 1;
    Vec3 origin_m_{2000.0, 2000.0, 0.0};
    std::unique_ptr<render::TerrainMesh> terrain_;
    fire::SurfaceField surface_;
    Raster<std::uint8_t> cover_;
    fire::FlameField flame_;
    render::SceneOptics optics_;
    radiometry::SpectralGrid spectral_;
    radiometry::ViewAtmosphere atmosphere_;
};

/// Wavelengths of the benchmarks, all holding 4.0 um: 3 (the centres of the thesis's channels), 36 or 224.
std::vector<double> benchmark_wavelengths_um(int bands);

/// Pinhole camera 3000 m over the scene's centre, looking down, north up in the image; pixels of 1 mrad in the tangent plane
/// (1 mrad / `refine` and more of them for refine > 1), optionally tilted away from the nadir towards the south.
struct W0Camera {
    int samples = 640, lines = 512;
    double pixel_rad = 0.001;
    double tilt_rad = 0.0;

    [[nodiscard]] render::SceneRay ray(int line, int sample) const noexcept;
    [[nodiscard]] render::ImageRequest request(bool terms = false) const;
};

/// Mean radiance over the covered pixels of the band nearest to a wavelength.
double mean_radiance(const render::RadianceImage& image, const std::vector<double>& lambda_um, double wanted_um);

}  // namespace pyroscene::bench
