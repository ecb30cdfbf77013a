#include "pipeline/render_phase.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <tbb/parallel_invoke.h>

#include "base/constants.h"
#include "base/error.h"
#include "pipeline/geolocation.h"
#include "pipeline/image_files.h"

namespace pyroscene::pipeline {
namespace {

Vec3 sun_direction(const radiometry::SunPosition& sun, double convergence_rad) {
    const double azimuth_on_grid = sun.azimuth_rad - convergence_rad, s = std::sin(sun.zenith_rad);
    return {s * std::sin(azimuth_on_grid), s * std::cos(azimuth_on_grid), std::cos(sun.zenith_rad)};
}

/// A ray that meets nothing, for pixels that the instrument does not send.
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr render::SceneRay kNowhere{{kNaN, kNaN, kNaN}, {kNaN, kNaN, kNaN}};

void report_scene(const GroupJob& job, const render::RenderScene& scene, RunReport& report) {
    report.count("transport_wavelengths/" + job.acquisition.id, scene.optics->lambda_count);
    report.count("flame_bricks/" + job.acquisition.id, static_cast<std::int64_t>(scene.flame->bricks.size()));
    if (render::has_plume(scene))
        report.count("plume_bricks/" + job.acquisition.id, static_cast<std::int64_t>(scene.plume->bricks.size()));
}

void report_coverage(const GroupJob& job, std::int64_t missed, bool surrounded, bool open, RunReport& report) {
    const auto pixels = static_cast<std::int64_t>(job.geometry.samples) * job.geometry.lines;
    report.count("pixels", pixels);
    if (missed == pixels && !open)
        throw input_error(fmt::format("acquisition '{}'", job.acquisition.id), "the camera does not see the map at all");
    if (missed > 0 && !open)
        report.warn(fmt::format("acquisition '{}': {} of {} pixels look past the scene and {}", job.acquisition.id, missed,
                                pixels, surrounded ? "show its surroundings (render.background)" : "are no data"));
}

render::GroundIrradiance ground_light(const GroupJob& job, const render::RenderScene& scene, const Monitor& monitor,
                                      RunReport& report) {
    const PhaseTimer timer(report, "render/ground_irradiance");
    const auto& wanted = job.scenario.render;
    using Flames = render::GroundLightSettings::Flames;
    render::GroundLightSettings settings;
    settings.flames = !wanted.flame_light ? Flames::None : wanted.point_sources ? Flames::PointSources : Flames::Hemisphere;
    settings.directions = wanted.light_directions;
    settings.reach_m = std::max(wanted.light_reach_m, 1e-3);
    settings.bounces = wanted.light_bounces;
    settings.decay = wanted.light_decay;
    settings.point_source_cut = wanted.point_source_cut;
    settings.estimate_error = true;
    auto light = render::ground_irradiance(scene, settings, {{}, monitor.cancelled});
    const auto& error = light.sampling_error;
    if (error.receivers > 0) {
        const auto name = "flame_light/" + job.acquisition.id + job.files.suffix;
        report.record(name + "/doubling_changes_total_by_percent", 100.0 * error.total_relative);
        report.record(name + "/doubling_changes_cells_by_percent_rms", 100.0 * error.rms_relative);
    }
    return light;
}

/// Steps on the ground from one edge of a pixel to the other, along the line and across it.
std::array<Vec3, 2> pixel_steps(const sensors::ScanChords& scan, const sensors::ScanPosition& centre, double width) {
    const auto step = [&](double u, double v) {
        const Vec3 d = scan.ends(centre.u + u, centre.v + v).bottom_m - scan.ends(centre.u - u, centre.v - v).bottom_m;
        return Vec3{d.x, d.y, 0.0};
    };
    return {step(0.5 * width, 0.0), step(0.0, 0.5)};
}

/// The rays of the sensor's pixels: strata of the point-spread function, and their halves for pixels wider than the fire.
void set_rays(const GroupJob& job, const sensors::ImageChords& chords, render::ImageRequest& request) {
    const auto &across = job.sensor.psf_across, &along = job.sensor.psf_along;
    const bool points = across.shape == sensors::Psf::Shape::None && along.shape == sensors::Psf::Shape::None;
    const int n = points ? 1 : job.scenario.render.samples_per_axis;
    auto pattern = sensors::pixel_samples(across, along, n);
    request.rays_per_pixel = n * n;
    request.ray_weight = pattern.weight;
    const auto& geometry = job.geometry;
    request.rays = [&geometry, &chords, pattern = std::move(pattern)](int line, int begin, int end,
                                                                      std::span<render::SceneRay> out) {
        const auto scan = chords.scan(sensors::scan_position_of(geometry, begin, line).scan);
        std::size_t k = 0;
        for (int sample = begin; sample < end; ++sample) {
            const bool deleted = sensors::pixel_deleted(geometry, sample, line);
            const auto centre = sensors::scan_position_of(geometry, sample, line);
            const double width = sensors::scan_pixel_width(geometry.scan, geometry.first_sample + sample);
            for (const auto& [dx, dy] : pattern.offset) {
                const auto ends = scan.ends(centre.u + dx * width, centre.v + dy);
                out[k++] = deleted ? kNowhere : render::SceneRay{ends.top_m, ends.bottom_m, chords.open()};
            }
        }
    };
    if (points || chords.open()) return;  // halves are judged by where they meet the ground
    request.parts_per_axis = n;
    request.part_levels = sensors::PsfShares::kLevels;
    request.parts = [&geometry, &chords, shares_u = sensors::PsfShares(across, n),
                     shares_v = sensors::PsfShares(along, n)](int line) -> render::ImageRequest::PartsOfLine {
        auto scan = chords.scan(sensors::scan_position_of(geometry, 0, line).scan);
        return [&geometry, &shares_u, &shares_v, line, scan = std::move(scan)](
                   int sample, std::span<const render::PixelPart> parts, std::span<render::PartView> out) {
            if (sensors::pixel_deleted(geometry, sample, line)) {
                std::fill(out.begin(), out.end(), render::PartView{kNowhere, {}, {}});
                return;
            }
            const auto centre = sensors::scan_position_of(geometry, sample, line);
            const double width = sensors::scan_pixel_width(geometry.scan, geometry.first_sample + sample);
            const auto [step_u, step_v] = pixel_steps(scan, centre, width);
            for (std::size_t i = 0; i < parts.size(); ++i) {
                const auto u = shares_u.share(parts[i].level_u, parts[i].index_u);
                const auto v = shares_v.share(parts[i].level_v, parts[i].index_v);
                const auto ends = scan.ends(centre.u + u.centre * width, centre.v + v.centre);
                out[i] = {{ends.top_m, ends.bottom_m}, u.width * step_u, v.width * step_v};
            }
        };
    };
}

/// A point in the scene frame, whose z is height itself.
Vec3 scene_point(const gis::MapProjection& map, Vec3 origin_m, const gis::Geodetic& at) {
    const auto xy = map.to_map(at.lat_deg, at.lon_deg);
    return {xy[0] - origin_m.x, xy[1] - origin_m.y, at.h_m - origin_m.z};
}

double farthest_corner_m(const inputs::SceneInputs& in, Vec3 from_m) {
    const auto& g = in.grid;
    double farthest_m = 0.0;
    for (const double x : {0.0, g.cols * g.cell_m})
        for (const double y : {0.0, g.rows * g.cell_m})
            farthest_m = std::max(
                farthest_m, std::hypot(g.west_m + x - in.origin_m.x - from_m.x, g.north_m - y - in.origin_m.y - from_m.y));
    return farthest_m;
}

/// To the nearest voxel of flame; 0 without flame.
double distance_to_flame_m(const fire::FlameField& flame, Vec3 from_m) {
    const fire::VoxelGrid& grid = flame.grid;
    const auto gap = [](double at, double low, double width) { return std::max({low - at, at - low - width, 0.0}); };
    double nearest_m = std::numeric_limits<double>::infinity();
    for (int c = 0; c < flame.brick_cols * flame.brick_rows; ++c) {
        const auto& column = flame.columns[static_cast<std::size_t>(c)];
        for (int n = 0; n < column.brick_count * fire::FlameField::kBrickVoxels; ++n) {
            constexpr int kEdge = fire::FlameField::kBrickEdge;
            const int brick = n / fire::FlameField::kBrickVoxels, voxel = n % fire::FlameField::kBrickVoxels;
            const auto b = static_cast<std::size_t>(column.first_brick + brick);
            if (!(flame.bricks[b].fill[static_cast<std::size_t>(voxel)] > 0.0F)) continue;
            const int i = c % flame.brick_cols * kEdge + voxel % kEdge,
                      j = c / flame.brick_cols * kEdge + voxel / kEdge % kEdge,
                      k = (column.z_begin + brick) * kEdge + voxel / (kEdge * kEdge);
            const Vec3 away{gap(from_m.x, grid.corner_m.x + i * grid.dx_m, grid.dx_m),
                            gap(from_m.y, grid.corner_m.y + j * grid.dy_m, grid.dy_m),
                            gap(from_m.z, grid.corner_m.z + k * grid.dz_m, grid.dz_m)};
            nearest_m = std::min(nearest_m, length(away));
        }
    }
    return std::isfinite(nearest_m) ? nearest_m : 0.0;
}

/// Near the ground the air along a level line of sight is that of a slant path of the same length: at this view angle, the
/// largest of the atmosphere tables.
constexpr double kSlantPath_rad = 65.0 * kDegree_rad;
double height_of_slant_path_m(double length_m) { return length_m * std::cos(kSlantPath_rad); }

/// Line of sight of a pixel, east-north-up.
Vec3 view_of(const sensors::ImageChords& chords, const sensors::ImageGeometry& geometry, int line, int sample) {
    const auto position = sensors::scan_position_of(geometry, sample, line);
    return chords.scan(position.scan).at(position.u, position.v).view_enu;
}

/// Of a line of sight, upward or downward.
double view_zenith_rad(Vec3 view_enu) { return std::atan2(std::hypot(view_enu.x, view_enu.y), std::abs(view_enu.z)); }

/// Judged by the corners of the image and the middles of its sides.
double largest_view_zenith_rad(const sensors::ImageChords& chords, const sensors::ImageGeometry& geometry) {
    double largest_rad = 0.0;
    for (const int line : {0, geometry.lines / 2, geometry.lines - 1})
        for (const int sample : {0, geometry.samples / 2, geometry.samples - 1})
            largest_rad = std::max(largest_rad, view_zenith_rad(view_of(chords, geometry, line, sample)));
    return largest_rad;
}

}  // namespace

void render_group(const GroupJob& job, const Monitor& monitor, RunReport& report) {
    const auto& scenario = job.scenario;
    const auto& in = job.inputs;
    const LocalSun sun(scenario.start.unix_s + job.acquisition.time_s, in.centre);
    const gis::MapProjection map(in.grid.crs_wkt);

    std::vector<Spectrum> responses;
    for (const int b : job.bands) responses.push_back(job.sensor.bands[static_cast<std::size_t>(b)].response);
    const double flame_top_m = std::max(job.fire.flame.z_range_m()[1], job.fire.plume.z_range_m()[1]);
    const auto sensor = job.geometry.path.at(0.0).position;
    const Vec3 sensor_m = scene_point(map, in.origin_m, sensor);
    const sensors::ImageChords chords(job.geometry, map, in.origin_m, in.lowest_m - 10.0,
                                      std::max(in.highest_m, flame_top_m) + 10.0, 2.0 * farthest_corner_m(in, sensor_m));
    const double sensor_agl_m = chords.open() ? height_of_slant_path_m(distance_to_flame_m(job.fire.flame, sensor_m))
                                              : std::max(1.0, sensor.h_m - in.mean_height_m);
    const auto spectral = make_spectral_scene(scenario, in, job.tables, job.fire, responses, sensor_agl_m,
                                              chords.open() ? kSlantPath_rad : largest_view_zenith_rad(chords, job.geometry),
                                              sun.centre(), report);

    render::RenderScene scene;
    scene.terrain = &job.terrain;
    scene.surface = &job.fire.surface;
    scene.cover = &in.cover;
    scene.flame = &job.fire.flame;
    scene.plume = &job.fire.plume;
    scene.optics = &spectral.optics;
    scene.spectral = &spectral.grid;
    scene.atmosphere = &spectral.atmosphere;
    scene.air_K = spectral.air_K;
    scene.air_base_m = in.mean_height_m - in.origin_m.z;
    scene.scene_origin_m = in.origin_m;
    scene.to_sun = scenario.render.sun ? sun_direction(sun.centre(), map.convergence_rad(in.origin_m.x, in.origin_m.y))
                                       : Vec3{0.0, 0.0, -1.0};

    if (spectral.surroundings_material >= 0) scene.surroundings = {spectral.surroundings_material, in.mean_height_m};

    const auto light = ground_light(job, scene, monitor, report);

    render::ImageRequest request;
    request.samples = job.geometry.samples;
    request.lines = job.geometry.lines;
    set_rays(job, chords, request);
    const double sun_azimuth_rad = sun.centre().azimuth_rad;
    request.view = [&](int line, int sample, Vec3 hit_m) {
        const Vec3 v = view_of(chords, job.geometry, line, sample);
        const double line_of_sight_rad = std::atan2(v.x, v.y) + kPi;
        const double zenith_rad = view_zenith_rad(v);
        return render::PixelView{chords.open() ? std::min(zenith_rad, kSlantPath_rad) : zenith_rad,
                                 std::remainder(sun_azimuth_rad - line_of_sight_rad, 2.0 * kPi),
                                 chords.open() ? 0.0 : hit_m.z - scene.air_base_m};
    };
    request.terms = scenario.products.truth;

    report_scene(job, scene, report);
    ImageFiles files(job, render::has_plume(scene));
    Geolocation geolocation(job.geometry, chords, sun, scene.surroundings ? std::optional(in.mean_height_m) : std::nullopt);
    std::int64_t missed = 0;
    render::RadianceImage lines;
    render::ImageRenderer renderer(scene, &light, request, monitor);
    for (int first = 0; first < request.lines; first += files.lines_at_once()) {
        {
            const PhaseTimer timer(report, "render/image");
            renderer.render(first, std::min(files.lines_at_once(), request.lines - first), lines);
        }
        missed += std::count_if(lines.coverage.begin(), lines.coverage.end(), [](float c) { return !(c > 0.0F); });
        tbb::parallel_invoke([&] { geolocation.add(lines); }, [&] { files.add(lines, report); });
        if (monitor.is_cancelled()) throw Cancelled();
    }
    report_coverage(job, missed, scene.surroundings.has_value(), chords.open(), report);
    files.finish(geolocation, report);
}

}  // namespace pyroscene::pipeline
