#include "render/scene_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "base/constants.h"
#include "base/error.h"
#include "radiometry/planck.h"

namespace pyroscene::render {
namespace {

constexpr double kTruthWavelength_um = 4.0;
constexpr double kTotalUnit_m = 0.01, kTotalStep = 0.25;
constexpr int kTotalNodes = 42;  ///< to 280 m

void require(bool holds, std::string_view subject, std::string_view message) {
    if (!holds) throw input_error(subject, message);
}

void check_length(std::size_t found, std::size_t expected, std::string_view what) {
    require(found == expected, "scene", fmt::format("{} has {} values, expected {}", what, found, expected));
}

void check_surface(const fire::SurfaceField& surface) {
    const auto n = static_cast<std::size_t>(std::max(surface.refinement, 1));
    const std::size_t map_cells = surface.grid.size() / (n * n);
    std::size_t cells = surface.grid.size();
    if (const auto& blocks = surface.block_of_cell; !blocks.empty()) {
        check_length(blocks.grid.size(), map_cells, "block_of_cell");
        std::int32_t least = 0, most = 0;
        for (std::size_t cell = 0; cell < map_cells; ++cell)
            least = std::min(least, blocks[cell]), most = std::max(most, blocks[cell]);
        require(least >= 0, "scene", "block_of_cell holds a negative number");
        cells = std::max(static_cast<std::size_t>(most) + 1, fire::SurfaceField::kSharedBlocks) * n * n;
    }
    check_length(surface.base_temperature_K.size(), cells, "base_temperature_K");
    check_length(surface.front_fraction.size(), cells, "front_fraction");
    check_length(surface.burned.size(), cells, "burned");
}

/// {lowest, highest} temperature of ground and flame.
std::pair<double, double> temperature_range_K(const RenderScene& scene) {
    double lowest = std::min(scene.surface->front_temperature_K, scene.surface->ambient_temperature_K);
    double highest = std::max(scene.surface->front_temperature_K, scene.surface->ambient_temperature_K);
    for (const float T_K : scene.surface->base_temperature_K) {
        if (!(T_K > 0.0F)) continue;  // NaN = no data
        lowest = std::min(lowest, static_cast<double>(T_K));
        highest = std::max(highest, static_cast<double>(T_K));
    }
    if (!scene.flame->empty()) {
        const auto [low, high] = scene.flame->temperature_range_K();
        lowest = std::min(lowest, low);
        highest = std::max(highest, high);
    }
    if (has_plume(scene)) {
        const auto [low, high] = scene.plume->temperature_range_K();
        lowest = std::min(lowest, low);
        highest = std::max(highest, high);
    }
    return {lowest, highest};
}

std::vector<double> exact_temperatures_K(const RenderScene& scene) {
    std::vector<double> exact{scene.surface->ambient_temperature_K, scene.surface->front_temperature_K};
    if (!scene.flame->empty()) {
        const auto [low, high] = scene.flame->temperature_range_K();
        if (low == high) exact.push_back(low);
    }
    if (has_plume(scene)) {
        const auto [low, high] = scene.plume->temperature_range_K();
        if (low == high) exact.push_back(low);
    }
    // The fields hold floats: a temperature is recognised after that rounding.
    for (double& T_K : exact) T_K = static_cast<float>(T_K);
    std::sort(exact.begin(), exact.end());
    exact.erase(std::unique(exact.begin(), exact.end()), exact.end());
    return exact;
}

/// Appends a row per material.
template <class Value>
void add_rows(const SceneTables& t, SceneTables::Rows& r, Value&& value) {
    r.stride = t.stride;
    for (int m = 0; m < t.materials; ++m) {
        const std::size_t row = r.values.size();
        r.values.resize(row + static_cast<std::size_t>(t.stride), 0.0F);
        for (int l = 0; l < t.lambdas; ++l) r.values[row + static_cast<std::size_t>(l)] = static_cast<float>(value(m, l));
    }
}

void add_row(const SceneTables& t, SceneTables::Rows& r, const std::vector<float>& values) {
    r.stride = t.stride;
    const std::size_t row = r.values.size();
    r.values.insert(r.values.end(), values.begin(), values.end());
    r.values.resize(row + static_cast<std::size_t>(t.stride), 0.0F);
}

template <class Value>
SceneTables::Rows rows(const SceneTables& t, Value&& value) {
    SceneTables::Rows r;
    add_rows(t, r, value);
    return r;
}

/// Null when the scene has no flame or no gas absorbs at its wavelengths.
std::unique_ptr<const radiometry::FlameTable> make_mixture(const RenderScene& scene, int stride) {
    const SceneOptics& optics = *scene.optics;
    if (!optics.flame_tables || optics.grey || scene.flame->empty()) return nullptr;
    const auto [low_K, high_K] = scene.flame->temperature_range_K();
    auto table = std::make_unique<radiometry::FlameTable>(
        radiometry::make_flame_table(*optics.flame_tables, optics.flame_gas, optics.lambda_um, stride, low_K, high_K));
    const auto has_lines = [&](double lambda_um) {
        return radiometry::alkali_absorption_per_m(optics.flame_tables->alkali, lambda_um, high_K, optics.flame_gas) > 0.0;
    };
    if (table->gases.empty() && std::none_of(optics.lambda_um.begin(), optics.lambda_um.end(), has_lines)) return nullptr;
    return table;
}

/// Vertical optical depth of a grey layer of uniform temperature from its hemispherical emissivity: solves 1 - 2 E3(t) = e
/// by Newton's method. Infinite for a layer that cannot be told from a black one.
double layer_depth(double emissivity) {
    constexpr double kBlack = 0.999;
    if (emissivity <= 0.0) return 0.0;
    if (emissivity > kBlack) return std::numeric_limits<double>::infinity();
    double t = -std::log1p(-emissivity) / static_cast<double>(kMeanSlant);
    for (int i = 0; i < 12; ++i) {
        const double E1 = -std::expint(-t), E2 = std::exp(-t) - t * E1, E3 = 0.5 * (std::exp(-t) - t * E2);
        t = std::max(t - (1.0 - 2.0 * E3 - emissivity) / (2.0 * E2), 0.5 * t);
    }
    return t;
}

bool any_positive(const std::vector<float>& values) {
    return std::any_of(values.begin(), values.end(), [](float v) { return v > 0.0F; });
}

}  // namespace

void check_scene(const RenderScene& scene) {
    require(
        scene.terrain && scene.surface && scene.cover && scene.flame && scene.optics && scene.spectral && scene.atmosphere,
        "scene", "terrain, surface, cover, flame, optics, spectral grid and atmosphere must all be given");
    const SceneOptics& optics = *scene.optics;
    const auto lambdas = static_cast<std::size_t>(optics.lambda_count),
               materials = static_cast<std::size_t>(optics.material_count);
    require(optics.lambda_count > 0, "scene", "the optics hold no wavelength, expected at least one");
    check_length(static_cast<std::size_t>(scene.spectral->size()), lambdas, "the spectral grid");
    check_length(optics.lambda_um.size(), lambdas, "lambda_um of the optics");
    check_length(optics.flame_absorption_per_m.size(), lambdas, "flame_absorption_per_m");
    if (has_plume(scene)) {
        check_length(optics.smoke_extinction_per_m.size(), lambdas, "smoke_extinction_per_m");
        if (!optics.smoke_albedo.empty() || !optics.smoke_asymmetry.empty()) {
            check_length(optics.smoke_albedo.size(), lambdas, "smoke_albedo");
            check_length(optics.smoke_asymmetry.size(), lambdas, "smoke_asymmetry");
        }
    }
    check_length(optics.reflectance.size(), lambdas * materials, "reflectance");
    check_length(static_cast<std::size_t>(scene.atmosphere->lambda_count()), lambdas, "the atmosphere");
    if (!scene.atmosphere->illumination.empty())
        check_length(scene.atmosphere->illumination.size(), scene.atmosphere->height_m.size(),
                     "the atmosphere's illumination");
    require(optics.burnt_material >= 0 && optics.burnt_material < optics.material_count, "scene",
            fmt::format("burnt_material is {}, expected one of {} materials", optics.burnt_material, optics.material_count));
    if (scene.surroundings) {
        require(scene.surroundings->material >= 0 && scene.surroundings->material < optics.material_count, "scene",
                fmt::format("surroundings of material {}, expected one of {} materials", scene.surroundings->material,
                            optics.material_count));
    }
    check_surface(*scene.surface);
    check_length(scene.cover->values.size(), scene.cover->grid.size(), "cover");
    const auto highest = std::max_element(scene.cover->values.begin(), scene.cover->values.end());
    require(highest == scene.cover->values.end() || *highest < optics.material_count, "scene",
            fmt::format("cover holds material {}, expected 0 to {}",
                        highest == scene.cover->values.end() ? 0 : static_cast<int>(*highest), optics.material_count - 1));
}

double SceneTables::total_transmittance_at(double fill_length_m) const noexcept {
    const double position = std::clamp(std::log1p(fill_length_m / kTotalUnit_m) / kTotalStep, 0.0, kTotalNodes - 1.0);
    const int i = std::min(static_cast<int>(position), kTotalNodes - 2);
    const double* t = total_transmittance.data() + i;
    return t[0] + (position - i) * (t[1] - t[0]);
}

SceneTables::SceneTables(const RenderScene& scene) {
    const SceneOptics& optics = *scene.optics;
    const radiometry::ViewAtmosphere& air = *scene.atmosphere;
    lambdas = optics.lambda_count;
    stride = padded(lambdas);
    materials = optics.material_count;
    burnt_material = optics.burnt_material;
    front_K = static_cast<float>(scene.surface->front_temperature_K);
    ambient_K = static_cast<float>(scene.surface->ambient_temperature_K);
    const auto [lowest, highest] = temperature_range_K(scene);
    planck = PlanckRows(optics.lambda_um, stride, lowest, highest, exact_temperatures_K(scene));

    absorption_per_m = optics.flame_absorption_per_m;
    absorption_per_m.resize(static_cast<std::size_t>(stride), absorption_per_m.back());
    least_absorption_per_m = *std::min_element(absorption_per_m.begin(), absorption_per_m.end());
    mixture = make_mixture(scene, stride);
    grey = optics.grey;
    if (!grey && !scene.flame->empty()) set_total_transmittance(scene);
    const auto nearest = std::min_element(optics.lambda_um.begin(), optics.lambda_um.end(), [](double a, double b) {
        return std::abs(a - kTruthWavelength_um) < std::abs(b - kTruthWavelength_um);
    });
    truth_absorption_per_m = absorption_per_m[static_cast<std::size_t>(nearest - optics.lambda_um.begin())];

    if (has_plume(scene))
        truth_smoke_extinction_per_m =
            optics.smoke_extinction_per_m[static_cast<std::size_t>(nearest - optics.lambda_um.begin())];
    to_sun = scene.to_sun;
    has_sun = scene.to_sun.z > 0.0 && any_positive(air.direct_normal_irradiance_W_m2_um);
    has_sky = has_sun || any_positive(air.diffuse_irradiance_W_m2_um);  // slopes reflect the sun as a part of the sky
    has_thermal_sky = any_positive(air.thermal_irradiance_W_m2_um);
    const auto reflectance = [&](int m, int l) {
        return static_cast<double>(optics.reflectance[static_cast<std::size_t>(m) * static_cast<std::size_t>(lambdas) +
                                                      static_cast<std::size_t>(l)]);
    };
    emissivity = rows(*this, [&](int m, int l) { return 1.0 - reflectance(m, l); });
    reflectance_per_pi = rows(*this, [&](int m, int l) { return reflectance(m, l) / kPi; });
    set_illumination(scene);
    set_open_sky(scene);
    set_slopes(scene);
}

void SceneTables::set_total_transmittance(const RenderScene& scene) {
    const SceneOptics& optics = *scene.optics;
    const double T_K = scene.flame->emission_mean_temperature_K();
    const double soot_per_m = radiometry::soot_planck_mean_per_m(optics.gas.soot_volume_fraction, T_K);
    for (int i = 0; i < kTotalNodes; ++i) {
        const double length_m = kTotalUnit_m * std::expm1(kTotalStep * i);
        total_transmittance.push_back(
            optics.flame_tables ? 1.0 - radiometry::total_emissivity(*optics.flame_tables, optics.flame_gas, T_K, length_m)
                                : std::exp(-soot_per_m * length_m));
    }
}

void SceneTables::set_illumination(const RenderScene& scene) {
    const radiometry::ViewAtmosphere& air = *scene.atmosphere;
    const auto add = [&](const radiometry::GroundIllumination& light) {
        const auto reflected = [&](const std::vector<float>& irradiance) {
            return [&](int m, int l) {
                return static_cast<double>(reflectance_per_pi[m][l]) * irradiance[static_cast<std::size_t>(l)];
            };
        };
        add_rows(*this, sun, reflected(light.direct_normal_irradiance_W_m2_um));
        add_rows(*this, sky, reflected(light.diffuse_irradiance_W_m2_um));
        add_rows(*this, thermal_sky, reflected(light.thermal_irradiance_W_m2_um));
        add_row(*this, sky_irradiance, light.diffuse_irradiance_W_m2_um);
        add_row(*this, thermal_sky_irradiance, light.thermal_irradiance_W_m2_um);
    };
    const std::size_t levels = std::max<std::size_t>(air.illumination.size(), 1);
    for (std::size_t i = 0; i < levels; ++i) {
        level_m.push_back(scene.air_base_m + air.height_m[i]);
        add(air.illumination_at(i));
    }
}

GroundLevel SceneTables::level_at(double height_m) const noexcept {
    if (level_m.size() < 2) return {};
    const auto after = std::upper_bound(level_m.begin() + 1, level_m.end() - 1, height_m, std::greater<>());
    const double above = *(after - 1), below = *after;
    return {static_cast<int>(after - level_m.begin()) - 1,
            static_cast<float>(std::clamp((above - height_m) / (above - below), 0.0, 1.0))};
}

const float* SceneTables::at_level(const Rows& irradiance, GroundLevel level, std::vector<float>& between) const {
    const float* first = irradiance[level.first];
    if (!(level.next > 0.0F)) return first;
    const float* next = irradiance[level.first + 1];
    between.resize(static_cast<std::size_t>(stride));
    for (std::size_t l = 0; l < between.size(); ++l) between[l] = first[l] + level.next * (next[l] - first[l]);
    return between.data();
}

void SceneTables::set_open_sky(const RenderScene& scene) {
    const radiometry::ViewAtmosphere& air = *scene.atmosphere;
    const auto row = static_cast<std::size_t>(stride);
    open_sky.stride = stride;
    open_sky.sunlit.assign(row, 0.0F);
    open_sky.thermal.assign(row * OpenSky::kCosine.size(), 0.0F);
    for (std::size_t l = 0; l < static_cast<std::size_t>(lambdas); ++l) {
        open_sky.sunlit[l] = air.diffuse_irradiance_W_m2_um[l] / static_cast<float>(kPi);
        const double mean = static_cast<double>(air.thermal_irradiance_W_m2_um[l]) / kPi;
        const double black = scene.air_K > 0.0 ? radiometry::planck_radiance(scene.optics->lambda_um[l], scene.air_K) : 0.0;
        const double depth = black > mean ? layer_depth(mean / black) : std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < OpenSky::kCosine.size(); ++k) {
            constexpr double kLevel = 1e-6;
            const double L =
                std::isfinite(depth) ? -black * std::expm1(-depth / std::max(OpenSky::kCosine[k], kLevel)) : mean;
            open_sky.thermal[k * row + l] = static_cast<float>(L);
        }
    }
}

void SceneTables::set_slopes(const RenderScene& scene) {
    const radiometry::ViewAtmosphere& air = *scene.atmosphere;
    std::vector<double> share(static_cast<std::size_t>(materials), 0.0);
    for (const std::uint8_t material : scene.cover->values)
        share[material] += 1.0 / static_cast<double>(scene.cover->values.size());
    const PlanckRows::Lookup ambient = planck.at(ambient_K);
    std::vector<double> solar(static_cast<std::size_t>(lambdas)), thermal(solar.size());
    for (std::size_t l = 0; l < solar.size(); ++l) {
        double reflectance = 0.0, black_body = 0.0;  // the mean over the materials, divided by pi
        for (int m = 0; m < materials; ++m)
            reflectance += share[static_cast<std::size_t>(m)] * static_cast<double>(reflectance_per_pi[m][l]);
        for (int j = 0; j < ambient.count; ++j)
            black_body += static_cast<double>(ambient.weight[static_cast<std::size_t>(j)] * planck.row(ambient.row + j)[l]);
        const double sun_W_m2_um =
            has_sun ? scene.to_sun.z * static_cast<double>(air.direct_normal_irradiance_W_m2_um[l]) : 0.0;
        solar[l] = kPi * reflectance * (sun_W_m2_um + static_cast<double>(air.diffuse_irradiance_W_m2_um[l]));
        thermal[l] = kPi * ((1.0 - kPi * reflectance) * black_body +
                            reflectance * static_cast<double>(air.thermal_irradiance_W_m2_um[l]));
    }
    const auto reflected = [&](const std::vector<double>& irradiance) {
        return rows(*this, [&](int m, int l) {
            return static_cast<double>(reflectance_per_pi[m][l]) * irradiance[static_cast<std::size_t>(l)];
        });
    };
    slopes_solar = reflected(solar);
    slopes_thermal = reflected(thermal);
    if (has_plume(scene)) set_smoke(scene, solar, thermal);
}

void SceneTables::set_smoke(const RenderScene& scene, std::span<const double> reflected, std::span<const double> emitted) {
    const SceneOptics& optics = *scene.optics;
    const radiometry::ViewAtmosphere& air = *scene.atmosphere;
    const auto size = static_cast<std::size_t>(stride);
    smoke.scatters = any_positive(optics.smoke_albedo);
    smoke.extinction_per_m = optics.smoke_extinction_per_m;
    smoke.extinction_per_m.resize(size, smoke.extinction_per_m.back());
    smoke.sun.assign(size, 0.0F);
    smoke.sky_radiance = smoke.ground_radiance = smoke.ground_lit = smoke.sun;
    for (std::size_t l = 0; l < emitted.size(); ++l) {
        if (has_sun) smoke.sun[l] = air.direct_normal_irradiance_W_m2_um[l];
        smoke.sky_radiance[l] =
            (air.diffuse_irradiance_W_m2_um[l] + air.thermal_irradiance_W_m2_um[l]) / static_cast<float>(kPi);
        smoke.ground_radiance[l] = static_cast<float>(emitted[l] / kPi);
        smoke.ground_lit[l] = static_cast<float>(reflected[l] / kPi);
    }
    if (smoke.scatters) set_smoke_scattering(scene);
}

void SceneTables::set_smoke_scattering(const RenderScene& scene) {
    const SceneOptics& optics = *scene.optics;
    smoke.albedo = optics.smoke_albedo;
    smoke.asymmetry = optics.smoke_asymmetry;
    for (std::vector<float>* row : {&smoke.albedo, &smoke.asymmetry}) row->resize(static_cast<std::size_t>(stride), 0.0F);
    smoke.beam_per_m = smoke.flame_per_m = smoke.extinction_per_m;
    smoke.flame_spread_per_m.assign(smoke.beam_per_m.size(), 0.0F);
    if (!optics.smoke_multiple_scattering) return;
    smoke.diffusion = make_smoke_diffusion(optics.lambda_um, optics.smoke_extinction_per_m, optics.smoke_albedo,
                                           optics.smoke_asymmetry, has_sun ? scene.to_sun.z : 0.0, stride);
    for (std::size_t l = 0; l < optics.smoke_albedo.size(); ++l) {
        const float k = smoke.extinction_per_m[l], w = smoke.albedo[l], g = smoke.asymmetry[l];
        smoke.beam_per_m[l] = k * (1.0F - w * g * g);
        // Through a layer light decays by diffusion and, where nothing absorbs, passes as 1 / (1 + 3/4 (1 - g) t).
        smoke.flame_per_m[l] = k * std::min(1.0F, std::sqrt(3.0F * (1.0F - w) * (1.0F - w * g)));
        smoke.flame_spread_per_m[l] = 0.75F * k * w * (1.0F - g);
    }
}

}  // namespace pyroscene::render
