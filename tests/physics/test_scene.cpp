#include "physics/test_scene.h"

#include "base/constants.h"
#include "radiometry/planck.h"

namespace pyroscene::test {

TestScene::TestScene(const Setup& setup) {
    MapGrid grid;
    grid.cols = setup.cols;
    grid.rows = setup.rows;
    grid.cell_m = setup.cell_m;
    grid.west_m = origin_m.x;
    grid.north_m = origin_m.y + setup.rows * setup.cell_m;
    heights = Raster<float>(grid, "height", "m", 0.0F);
    rebuild_terrain();
    surface.grid = grid;
    surface.base_temperature_K.assign(grid.size(), static_cast<float>(setup.ground_K));
    surface.front_fraction.assign(grid.size(), 0.0F);
    surface.burned.assign(grid.size(), 0);
    surface.front_temperature_K = 1073.15;
    surface.ambient_temperature_K = setup.ground_K;
    cover = Raster<std::uint8_t>(grid, "cover", "1", 0);
    const auto n = setup.lambda_um.size();
    optics.lambda_count = static_cast<int>(n);
    optics.lambda_um = setup.lambda_um;
    optics.flame_absorption_per_m.assign(n, static_cast<float>(setup.absorption_per_m));
    optics.grey = true;
    optics.material_count = 2;  // vegetation, burnt
    optics.reflectance.assign(2 * n, static_cast<float>(setup.reflectance));
    optics.burnt_material = 1;
    optics.burnt_emissivity.value.fill(1.0 - setup.reflectance);
    spectral = radiometry::monochromatic_grid(setup.lambda_um);
    atmosphere = radiometry::vacuum(static_cast<int>(n));
}

void TestScene::set_sky(double sky_K) {
    for (std::size_t i = 0; i < optics.lambda_um.size(); ++i) {
        atmosphere.thermal_irradiance_W_m2_um[i] =
            static_cast<float>(kPi * radiometry::planck_radiance(optics.lambda_um[i], sky_K));
    }
}

render::RenderScene TestScene::scene() const {
    render::RenderScene s;
    s.terrain = terrain.get();
    s.surface = &surface;
    s.cover = &cover;
    s.flame = &flame;
    s.plume = &plume;
    s.optics = &optics;
    s.spectral = &spectral;
    s.atmosphere = &atmosphere;
    s.scene_origin_m = origin_m;
    s.to_sun = to_sun;
    return s;
}

std::vector<fire::FlameVoxel> box_of_voxels(int nx, int ny, int nz, double temperature_K, double fill) {
    std::vector<fire::FlameVoxel> voxels;
    for (int k = 0; k < nz; ++k) {
        for (int j = 0; j < ny; ++j) {
            for (int i = 0; i < nx; ++i) {
                voxels.push_back({i, j, k, static_cast<float>(fill), static_cast<float>(temperature_K)});
            }
        }
    }
    return voxels;
}

render::ImageRequest rays_request(std::vector<render::SceneRay> rays, bool terms) {
    render::ImageRequest request;
    request.samples = static_cast<int>(rays.size());
    request.lines = 1;
    request.ray_weight = {1.0};
    request.terms = terms;
    request.rays = [rays = std::move(rays)](int, int begin, int end, std::span<render::SceneRay> out) {
        std::copy(rays.begin() + begin, rays.begin() + end, out.begin());
    };
    request.view = [](int, int, Vec3) { return render::PixelView{}; };
    return request;
}

std::vector<float> trace(const TestScene& scene, const render::SceneRay& ray, const render::GroundIrradiance* light) {
    const auto image = render::render_image(scene.scene(), light, rays_request({ray}));
    return {image.radiance_W_m2_sr_um.begin(), image.radiance_W_m2_sr_um.end()};
}

}  // namespace pyroscene::test
