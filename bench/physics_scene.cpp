#include "bench/physics_scene.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/files.h"
#include "bench/band_reference.h"
#include "gis/netcdf_input.h"
#include "radiometry/surfaces.h"
#include "radiometry/transport_grid.h"

namespace pyroscene::bench {
namespace {

constexpr double kSunZenith_rad = 40.0 * kDegree_rad, kSunAzimuth_rad = 225.0 * kDegree_rad;
constexpr double kAir_K = 300.0, kSensor_m = 3000.0;

radiometry::AtmosphereConditions conditions() {
    radiometry::AtmosphereConditions c;
    c.sensor_altitude_agl_m = kSensor_m;
    c.sun_zenith_rad = kSunZenith_rad;
    return c;
}

/// Smoke rises from the whole fire line at x = 1200 to 2600 m and leans east; denser and warmer near its source.
fire::FlameField make_plume() {
    fire::VoxelGrid grid;
    grid.nx = grid.ny = 142;
    grid.dx_m = grid.dy_m = grid.dz_m = 20.0;
    grid.corner_m = {600.0 - 2000.0, 600.0 - 2000.0, 0.0};
    std::vector<fire::FlameVoxel> voxels;
    for (int i = 0; i < grid.nx; ++i) {
        const double x_m = 600.0 + grid.dx_m * (i + 0.5), along_m = x_m - 1200.0;
        if (along_m < 0.0) continue;
        const double axis_m = 60.0 + 0.5 * along_m, radius_m = 100.0 + 0.2 * along_m;
        for (int j = 0; j < grid.ny; ++j) {
            const double aside_m = 600.0 + grid.dy_m * (j + 0.5) - 2000.0;
            for (int k = 0; k * grid.dz_m < 1500.0; ++k) {
                const double above_m = grid.dz_m * (k + 0.5) - axis_m;
                if (std::hypot(aside_m / 2.5, above_m) > radius_m) continue;
                const double thinned = 200.0 / (100.0 + radius_m);
                voxels.push_back(
                    {i, j, k, static_cast<float>(2e-3 * thinned), static_cast<float>(kAir_K + 40.0 * thinned * thinned)});
            }
        }
    }
    return fire::make_flame_field(grid, voxels);
}

std::vector<float> on_nodes(const Spectrum& reflectance, const std::vector<double>& lambda_um) {
    std::vector<float> out;
    for (const double lambda : lambda_um) out.push_back(static_cast<float>(reflectance.at(lambda)));
    return out;
}

}  // namespace

PhysicsTables::PhysicsTables()
    : flame(std::make_shared<const radiometry::FlameOptics>(radiometry::load_flame_optics(data_folder() / "optical"))),
      smoke(radiometry::load_smoke_optics(data_folder() / "optical" / "smoke_optics_fine.csv", "savanna")),
      air(radiometry::make_atmosphere_set("midlatitude_summer", 23.0, 0.0,
                                          [](const std::string& file, const std::string& variable) {
                                              const auto path = data_folder() / "atmosphere" / file;
                                              return gis::read_netcdf_variable(path, variable).values;
                                          })) {
    const auto library = radiometry::load_surfaces(data_folder() / "optical" / "surface_reflectance.csv");
    const auto spectrum = [&](const char* name) {
        return library.reflectance[static_cast<std::size_t>(library.index_of(name))];
    };
    dry_grass = spectrum("grass_dry");
    char_black = spectrum("char_black");
}

PhysicsScene::PhysicsScene(const PhysicsTables& tables, radiometry::SpectralGrid grid)
    : w0_({}), plume_(make_plume()), spectral_(std::move(grid)) {
    const auto& lambda_um = spectral_.lambda_um;
    optics_.lambda_count = spectral_.size();
    optics_.lambda_um = lambda_um;
    optics_.flame_tables = tables.flame;
    for (const double lambda : lambda_um) {
        optics_.flame_absorption_per_m.push_back(static_cast<float>(
            radiometry::soot_absorption_per_m(tables.flame->soot, lambda, optics_.gas.soot_volume_fraction)));
        const auto smoke = radiometry::smoke_coefficients(tables.smoke, lambda, 1.0);
        optics_.smoke_extinction_per_m.push_back(static_cast<float>(smoke.extinction_per_m));
        optics_.smoke_albedo.push_back(static_cast<float>(smoke.single_scattering_albedo));
        optics_.smoke_asymmetry.push_back(static_cast<float>(smoke.asymmetry));
    }
    optics_.material_count = 2;
    optics_.burnt_material = 1;
    const auto grass = on_nodes(tables.dry_grass, lambda_um), burnt = on_nodes(tables.char_black, lambda_um);
    optics_.reflectance = grass;
    optics_.reflectance.insert(optics_.reflectance.end(), burnt.begin(), burnt.end());
    const std::vector<double> albedo(grass.begin(), grass.end());
    atmosphere_ = radiometry::make_view_atmosphere(tables.air, conditions(), spectral_, albedo);
}

render::RenderScene PhysicsScene::scene() const {
    render::RenderScene s = w0_.scene();
    s.plume = &plume_;
    s.optics = &optics_;
    s.spectral = &spectral_;
    s.atmosphere = &atmosphere_;
    s.air_K = kAir_K;
    s.to_sun = {std::sin(kSunZenith_rad) * std::sin(kSunAzimuth_rad), std::sin(kSunZenith_rad) * std::cos(kSunAzimuth_rad),
                std::cos(kSunZenith_rad)};
    return s;
}

radiometry::SpectralGrid picked_grid(const PhysicsTables& tables, const std::vector<Spectrum>& responses) {
    radiometry::SpectralStructure structure{tables.flame.get(), {}, {}};
    for (const double view_deg : {0.0, 25.0, 50.0})
        structure.air.push_back(radiometry::evaluate(tables.air, {conditions(), view_deg * kDegree_rad, kPi / 2.0}));
    return radiometry::make_spectral_grid(responses, structure);
}

radiometry::SpectralGrid fine_grid(const PhysicsTables& tables, const std::vector<Spectrum>& responses) {
    radiometry::SpectralGrid grid;
    for (const Spectrum& response : responses) {
        const auto edges_um = fine_wavelengths_um(response, *tables.flame);
        const int begin = grid.size();
        double sum = 0.0;
        for (std::size_t i = 1; i < edges_um.size(); ++i) {
            const double middle_um = 0.5 * (edges_um[i - 1] + edges_um[i]);
            const double weight = response.at(middle_um, false) * (edges_um[i] - edges_um[i - 1]);
            if (!(weight > 0.0)) continue;
            grid.lambda_um.push_back(middle_um);
            grid.cell_lower_um.push_back(middle_um);
            grid.cell_upper_um.push_back(middle_um);
            grid.weight.push_back(weight);
            sum += weight;
        }
        for (auto i = static_cast<std::size_t>(begin); i < grid.weight.size(); ++i) grid.weight[i] /= sum;
        grid.bands.push_back({begin, grid.size()});
    }
    return grid;
}

}  // namespace pyroscene::bench
