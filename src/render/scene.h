#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/buffer.h"
#include "base/flame_gas.h"
#include "base/raster.h"
#include "base/report.h"
#include "base/vec3.h"
#include "fire/flame_field.h"
#include "fire/surface_field.h"
#include "radiometry/flame_optics.h"
#include "radiometry/spectral_grid.h"
#include "radiometry/total_emissivity.h"
#include "radiometry/view_atmosphere.h"
#include "render/scene_ray.h"
#include "render/terrain_mesh.h"

namespace pyroscene::render {

/// Terms of the at-sensor radiance (eq 4.44 with the thermal path and the thermal sky, docs/physics.md). They sum to the total.
enum class Term {
    GroundEmission,
    ReflectedSun,
    ReflectedSky,
    ReflectedThermalSky,
    ReflectedFlame,
    FlameEmission,
    PathSolar,
    PathThermal,
    Adjacency,
    SmokeEmission,   ///< only in scenes with a plume, like the next
    SmokeScattering  ///< sun, sky, ground and flame light scattered by smoke
};
inline constexpr int kTermCount = 11;
inline constexpr int kSmokeTermCount = 2;  ///< the last ones
inline constexpr std::array<const char*, kTermCount> kTermNames{
    "ground_emission", "reflected_sun", "reflected_sky", "reflected_thermal_sky", "reflected_flame", "flame_emission",
    "path_solar",      "path_thermal",  "adjacency",     "smoke_emission",        "smoke_scattering"};

/// Spectral properties on the transport grid.
struct SceneOptics {
    int lambda_count = 0;
    std::vector<double> lambda_um;
    std::vector<float> flame_absorption_per_m;  ///< [lambda] of flame that fills its voxel
    std::vector<float> smoke_extinction_per_m;  ///< [lambda] of plume voxels of fill 1; empty without a plume
    /// [lambda] scattered / extinct, and Henyey-Greenstein's g; both empty: the plume only absorbs.
    std::vector<float> smoke_albedo, smoke_asymmetry;
    bool smoke_multiple_scattering = true;  ///< false: light is scattered by smoke once only
    FlameGas gas;                           ///< what the flame is made of
    bool grey = false;                      ///< absorption equal at all wavelengths: one exp per step
    /// Hot gas and alkali lines beside the soot, of one mixture for all flame. Without tables, or where they say nothing at
    /// these wavelengths, flame_absorption_per_m is all that absorbs.
    std::shared_ptr<const radiometry::FlameOptics> flame_tables;
    FlameGas flame_gas;
    int material_count = 0;
    std::vector<float> reflectance;  ///< [material][lambda]; emissivity = 1 - reflectance
    int burnt_material = 0;          ///< material of burnt and burning ground
    /// The same over all wavelengths, for the true exitance, which is the fire's and not the sensor's; black unless told.
    radiometry::TotalEmissivity burnt_emissivity;
};

/// All that a camera can see. Pointers are not owned and must outlive the render.
struct RenderScene {
    const TerrainMesh* terrain = nullptr;
    const fire::SurfaceField* surface = nullptr;
    const Raster<std::uint8_t>* cover = nullptr;  ///< material of unburnt ground per map cell
    const fire::FlameField* flame = nullptr;
    const fire::FlameField* plume = nullptr;  ///< smoke on a lattice of its own; null or empty = none
    const SceneOptics* optics = nullptr;
    const radiometry::SpectralGrid* spectral = nullptr;
    const radiometry::ViewAtmosphere* atmosphere = nullptr;
    Vec3 scene_origin_m;      ///< map coordinates of the scene frame's origin (z = 0)
    double air_base_m = 0.0;  ///< height 0 of the atmosphere, scene frame
    Vec3 to_sun;              ///< unit vector, scene frame; z <= 0 = night
    /// Level ground at ambient temperature wherever a ray finds no scene: beyond the map and where it has no data.
    struct Surroundings {
        int material = 0;
        double height_m = 0.0;  ///< scene frame
    };
    std::optional<Surroundings> surroundings;  ///< nullopt = such rays see nothing
    double air_K = 0.0;  ///< near the ground: brightens the thermal sky towards the horizon; 0 = the same all over
};

inline bool has_plume(const RenderScene& scene) noexcept { return scene.plume != nullptr && !scene.plume->empty(); }

/// Settings of the light that flames and slopes throw on the ground.
struct GroundLightSettings {
    /// None: only how slopes hide the sky. Hemisphere: quadrature through the flames. PointSources: thesis 4.4, for
    /// comparison, without anything in the way.
    enum class Flames { None, Hemisphere, PointSources } flames = Flames::Hemisphere;
    int directions = 64;     ///< vertical planes around a receiver for flames (each cut into strata of elevation), and
                             ///< directions of the hemisphere for terrain
    double reach_m = 500.0;  ///< a flame farther away than this does not count
    int bounces = 3;         ///< reflections on the ground between a flame and the camera; 1 = direct light of flames only
    int decay = 4;           ///< by this factor fewer directions from each bounce to the next (thesis 6.4: 64, 3, 4)
    double point_source_cut = 0.01;  ///< a point source ends where its irradiance is this fraction of that in 1 m distance
    bool estimate_error = false;     ///< fill GroundIrradiance::sampling_error
};

/// How far the light of flames is from that of twice as many directions, on an even sample of receivers.
struct LightSamplingError {
    int receivers = 0;
    double total_relative = 0.0;  ///< of the sum over receivers and wavelengths, signed
    double rms_relative = 0.0;    ///< per receiver, weighted by its irradiance
};

class SkyView;

/// Light on the ground, independent of any camera, on the map grid of the terrain. Cells near flames have a row with their
/// irradiances, means over the cell on its slope: from flames, and from the sky as far as flames and terrain let it
/// through, with what slopes in view emit and reflect. Cells without a row receive nothing from flames; of their hemisphere
/// the share `sky_view` is sky, the rest ambient terrain.
struct GroundIrradiance {
    MapGrid grid;
    std::vector<std::int32_t> row_of_cell;  ///< [map cell] row into the arrays below, -1 = none
    int lambda_count = 0;
    int stride = 0;                             ///< floats per row, lambda_count padded with zeros to whole vectors
    std::vector<float> irradiance_W_m2_um;      ///< [row][lambda] by flames and the glow of ground in view
    std::vector<float> sky_irradiance_W_m2_um;  ///< [row][lambda] diffuse sun; empty at night
    std::vector<float>
        thermal_irradiance_W_m2_um;           ///< [row][lambda] thermal sky and slopes as warm as the ambient; empty if none
    std::shared_ptr<const SkyView> sky_view;  ///< (sky_view.h) for cells without a row; null on a plane
    LightSamplingError sampling_error;
};

/// Hemisphere quadrature at each terrain cell near flames, through the flame field, occluded by terrain, and reflections
/// between slopes.
/// A plume dims the sky and glows in its place. Deterministic for any thread count. Method and accuracy: docs/physics-render.md.
GroundIrradiance ground_irradiance(const RenderScene& scene, const GroundLightSettings& settings,
                                   const Monitor& monitor = {});

/// View geometry of one pixel at the ground, for the atmosphere.
struct PixelView {
    double view_zenith_rad = 0.0;       ///< of the line, upward or downward: at most pi/2
    double relative_azimuth_rad = 0.0;  ///< sun azimuth - line of sight azimuth
    double ground_m = 0.0;              ///< height of the ground seen, as ViewAtmosphere::height_m
};

/// A share of a pixel's response: of the strata along an axis each is halved `level` times; index counts the halves.
struct PixelPart {
    int level_u = 0, level_v = 0;  ///< along the line, across the lines
    int index_u = 0, index_v = 0;
};
/// Its ray, and the steps from one end of the share to the other on level ground, along the line and across it.
struct PartView {
    SceneRay ray;
    Vec3 across_m, along_m;
};

/// Where the sub-rays of an image come from. Callbacks are called from several threads at once.
struct ImageRequest {
    int samples = 0, lines = 0;
    int rays_per_pixel = 1;
    std::vector<double> ray_weight;  ///< [rays_per_pixel], sums to 1 (the PSF)
    /// Fills the sub-rays of pixels [begin, end) of a line, pixel after pixel.
    std::function<void(int line, int begin, int end, std::span<SceneRay> out)> rays;
    /// View angles of a pixel whose mean ground hit (scene frame) is given.
    std::function<PixelView(int line, int sample, Vec3 hit_m)> view;
    bool terms = true;  ///< keep every radiance term apart
    /// Views of finer and finer shares of the pixels of a line, for pixels wider than the fire in them; empty = never. The
    /// shares of level 0 are those of `rays`, parts_per_axis x parts_per_axis = rays_per_pixel; halves have half the weight.
    using PartsOfLine = std::function<void(int sample, std::span<const PixelPart>, std::span<PartView> out)>;
    std::function<PartsOfLine(int line)> parts;
    int parts_per_axis = 0, part_levels = 0;
};

/// What one image holds before the detector. Planes are [line][sample], cubes [band][line][sample]; NaN where nothing is hit.
struct RadianceImage {
    int samples = 0, lines = 0, bands = 0;
    int first_line = 0;                           ///< place of the first line held in the image asked for
    Buffer<float> radiance_W_m2_sr_um;            ///< [band][line][sample], noise-free
    std::array<Buffer<float>, kTermCount> terms;  ///< each as radiance, empty when not asked for (or no plume)
    Buffer<double> hit_x_m, hit_y_m, hit_z_m;     ///< PSF-weighted mean ground point, scene frame
    Buffer<float>
        coverage;  ///< weight of sub-rays that met the scene, 0..1; the rest saw its surroundings or the sky, if any
    Buffer<float> flame_fraction, front_fraction, scar_fraction, background_fraction;  ///< seen; sum with smoke and sky = 1
    Buffer<float> smoke_fraction;                                                      ///< empty in scenes without a plume
    Buffer<float> flame_temperature_K;    ///< emission-weighted, NaN without flame
    Buffer<float> ground_temperature_K;   ///< (mean T^4)^(1/4) of the ground seen
    Buffer<float> radiant_exitance_W_m2;  ///< true FRP per ground area: flame + front + (scar - ambient)
};

/// Renders an image some lines at a time, so that memory need not hold all of it. Bit-identical for any thread count and however
/// the image is cut.
class ImageRenderer {
public:
    /// All that is handed over must outlive this. Throws an input error for a scene or a request that cannot be rendered.
    ImageRenderer(const RenderScene& scene, const GroundIrradiance* flame_light, const ImageRequest& request,
                  const Monitor& monitor);
    ~ImageRenderer();
    /// Lines [first, first + count) of the request; `out` may be used again. Throws Cancelled when the monitor asks.
    void render(int first, int count, RadianceImage& out);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The whole image at once.
RadianceImage render_image(const RenderScene& scene, const GroundIrradiance* flame_light, const ImageRequest& request,
                           const Monitor& monitor = {});

}  // namespace pyroscene::render
