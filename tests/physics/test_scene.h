#pragma once

#include <memory>
#include <span>
#include <vector>

#include "render/scene.h"

namespace pyroscene::test {

/// A scene that owns its parts, with setters for what a test cares about. The ground is flat at z = 0 unless heights are
/// given, of one material and one temperature; no flame; no air. The scene frame's origin is the raster's south-west corner.
class TestScene {
public:
    struct Setup {
        int cols = 8, rows = 8;
        double cell_m = 20.0;
        double ground_K = 300.0;
        std::vector<double> lambda_um{4.0};
        double reflectance = 0.0;
        double absorption_per_m = 0.3;
    };

    explicit TestScene(const Setup& setup);

    /// Sets heights from a function of the cell centre's scene coordinates.
    template <class Height>
    void set_heights(Height&& height) {
        for (int r = 0; r < heights.grid.rows; ++r) {
            for (int c = 0; c < heights.grid.cols; ++c) {
                heights.at(r, c) = static_cast<float>(
                    height(heights.grid.x_centre_m(c) - origin_m.x, heights.grid.y_centre_m(r) - origin_m.y));
            }
        }
        rebuild_terrain();
    }
    void rebuild_terrain() { terrain = std::make_unique<render::TerrainMesh>(heights, origin_m); }
    /// Absorption at each wavelength; not grey.
    void set_absorption(std::vector<float> per_m) {
        optics.flame_absorption_per_m = std::move(per_m);
        optics.grey = false;
    }
    /// Isotropic sky of a black body, and vacuum otherwise.
    void set_sky(double sky_K);
    /// Voxels of the flame that fill the box of lattice indices [i0, i1) x [j0, j1) x [k0, k1).
    void set_flame(const fire::VoxelGrid& grid, std::span<const fire::FlameVoxel> voxels) {
        flame = make_flame_field(grid, voxels);
    }

    [[nodiscard]] render::RenderScene scene() const;

    Vec3 origin_m{500000.0, 4600000.0, 0.0};
    Raster<float> heights;
    std::unique_ptr<render::TerrainMesh> terrain;
    fire::SurfaceField surface;
    Raster<std::uint8_t> cover;
    fire::FlameField flame, plume;
    render::SceneOptics optics;
    radiometry::SpectralGrid spectral;
    radiometry::ViewAtmosphere atmosphere;
    Vec3 to_sun{0.0, 0.0, -1.0};
};

/// A box of equal voxels.
std::vector<fire::FlameVoxel> box_of_voxels(int nx, int ny, int nz, double temperature_K, double fill = 1.0);

/// A request of one line with one ray per pixel.
render::ImageRequest rays_request(std::vector<render::SceneRay> rays, bool terms = true);

/// Radiance [band] of a single ray.
std::vector<float> trace(const TestScene& scene, const render::SceneRay& ray,
                         const render::GroundIrradiance* light = nullptr);

}  // namespace pyroscene::test
