#include "pipeline/render_phase.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "base/constants.h"
#include "base/error.h"
#include "gis/raster_output.h"
#include "pipeline/sensor_json.h"
#include "sensors/detector.h"

namespace pyroscene::pipeline {
namespace {

using render::RadianceImage;

/// A ray that meets nothing, for pixels that the instrument does not send.
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr render::SceneRay kNowhere{{kNaN, kNaN, kNaN}, {kNaN, kNaN, kNaN}};

/// Sun angles over the scene: exact at the centre, linear in latitude and longitude around it (a few km: < 0.001 deg).
class LocalSun {
public:
    LocalSun(double unix_s, const gis::Geodetic& centre) : centre_(centre) {
        const auto at = [&](double dlat, double dlon) {
            return radiometry::sun_position(unix_s, centre.lat_deg + dlat, centre.lon_deg + dlon);
        };
        constexpr double kStep_deg = 0.05;
        here_ = at(0.0, 0.0);
        const auto north = at(kStep_deg, 0.0), east = at(0.0, kStep_deg);
        zenith_per_deg_ = {(north.zenith_rad - here_.zenith_rad) / kStep_deg,
                           (east.zenith_rad - here_.zenith_rad) / kStep_deg};
        azimuth_per_deg_ = {std::remainder(north.azimuth_rad - here_.azimuth_rad, 2.0 * kPi) / kStep_deg,
                            std::remainder(east.azimuth_rad - here_.azimuth_rad, 2.0 * kPi) / kStep_deg};
    }
    [[nodiscard]] const radiometry::SunPosition& centre() const { return here_; }
    [[nodiscard]] double zenith_rad(double lat_deg, double lon_deg) const {
        return here_.zenith_rad + zenith_per_deg_[0] * (lat_deg - centre_.lat_deg) +
               zenith_per_deg_[1] * (lon_deg - centre_.lon_deg);
    }
    [[nodiscard]] double azimuth_rad(double lat_deg, double lon_deg) const {
        return here_.azimuth_rad + azimuth_per_deg_[0] * (lat_deg - centre_.lat_deg) +
               azimuth_per_deg_[1] * (lon_deg - centre_.lon_deg);
    }

private:
    gis::Geodetic centre_;
    radiometry::SunPosition here_;
    std::array<double, 2> zenith_per_deg_{}, azimuth_per_deg_{};
};

double positive_degrees(double angle_rad) {
    const double degrees = std::fmod(angle_rad / kDegree_rad, 360.0);
    return degrees < 0.0 ? degrees + 360.0 : degrees;
}

Vec3 sun_direction(const radiometry::SunPosition& sun, double convergence_rad) {
    const double azimuth_on_grid = sun.azimuth_rad - convergence_rad, s = std::sin(sun.zenith_rad);
    return {s * std::sin(azimuth_on_grid), s * std::cos(azimuth_on_grid), std::cos(sun.zenith_rad)};
}

/// The geolocation planes in the order of the file.
constexpr std::array<std::array<const char*, 2>, 9> kGeolocationBands{{{"longitude", "degree"},
                                                                       {"latitude", "degree"},
                                                                       {"height", "m"},
                                                                       {"view_zenith", "degree"},
                                                                       {"view_azimuth", "degree"},
                                                                       {"sun_zenith", "degree"},
                                                                       {"sun_azimuth", "degree"},
                                                                       {"range", "m"},
                                                                       {"time", "s"}}};

/// \param surroundings_m  height of the ground beyond the map, which pixels past it show; nothing: such pixels have no place
std::vector<double> geolocate(const RadianceImage& image, const sensors::ImageGeometry& geometry,
                              const sensors::ImageChords& chords, const LocalSun& sun,
                              std::optional<double> surroundings_m) {
    const std::size_t n = static_cast<std::size_t>(image.samples) * static_cast<std::size_t>(image.lines);
    std::vector<double> planes(n * kGeolocationBands.size(), std::nan(""));
    tbb::parallel_for(0, image.lines, [&](int line) {
        const auto scan = chords.scan(sensors::scan_position_of(geometry, 0, line).scan);
        for (int sample = 0; sample < image.samples; ++sample) {
            const std::size_t i =
                static_cast<std::size_t>(line) * static_cast<std::size_t>(image.samples) + static_cast<std::size_t>(sample);
            const bool on_map = image.coverage[i] > 0.0F;
            if (!on_map && (!surroundings_m || chords.open() || sensors::pixel_deleted(geometry, sample, line))) continue;
            const auto position = sensors::scan_position_of(geometry, sample, line);
            const auto chord = scan.at(position.u, position.v);
            const Vec3 hit_m = on_map ? Vec3{image.hit_x_m[i], image.hit_y_m[i], image.hit_z_m[i]}
                                      : Vec3{0.0, 0.0, surroundings_m.value_or(0.0)};
            const Vec3 way_m = chord.bottom_m - chord.top_m;
            const double f = chords.open() ? dot(hit_m - chord.top_m, way_m) / dot(way_m, way_m)
                                           : (chord.top_m.z - hit_m.z) / (chord.top_m.z - chord.bottom_m.z);
            const double lon = std::lerp(chord.top_lon_deg, chord.bottom_lon_deg, f);
            const double lat = std::lerp(chord.top_lat_deg, chord.bottom_lat_deg, f);
            const Vec3 v = chord.view_enu;
            const double values[] = {lon,
                                     lat,
                                     hit_m.z,
                                     std::atan2(std::hypot(v.x, v.y), v.z) / kDegree_rad,
                                     positive_degrees(std::atan2(v.x, v.y)),
                                     sun.zenith_rad(lat, lon) / kDegree_rad,
                                     positive_degrees(sun.azimuth_rad(lat, lon)),
                                     std::lerp(chord.top_range_m, chord.bottom_range_m, f),
                                     sensors::pixel_time_s(geometry, sample, line)};
            for (std::size_t b = 0; b < std::size(values); ++b) planes[b * n + i] = values[b];
        }
    });
    return planes;
}

std::vector<gis::GroundControlPoint> control_points(const RadianceImage& image, const std::vector<double>& planes) {
    std::vector<gis::GroundControlPoint> points;
    const std::size_t n = static_cast<std::size_t>(image.samples) * static_cast<std::size_t>(image.lines);
    constexpr int kPerAxis = 9;
    for (int r = 0; r < kPerAxis; ++r)
        for (int c = 0; c < kPerAxis; ++c) {
            const int line = r * (image.lines - 1) / (kPerAxis - 1), sample = c * (image.samples - 1) / (kPerAxis - 1);
            const std::size_t i =
                static_cast<std::size_t>(line) * static_cast<std::size_t>(image.samples) + static_cast<std::size_t>(sample);
            if (!std::isnan(planes[i]))
                points.push_back({sample + 0.5, line + 0.5, planes[i], planes[n + i], planes[2 * n + i]});
        }
    // A scene that fills a corner of the image may lie between them: then its own pixels, evenly.
    constexpr std::size_t kFewest = 4, kMost = 64;
    if (points.size() >= kFewest) return points;
    std::vector<std::size_t> seen;
    for (std::size_t i = 0; i < n; ++i)
        if (!std::isnan(planes[i])) seen.push_back(i);
    points.clear();
    const auto samples = static_cast<std::size_t>(image.samples);
    for (std::size_t k = 0; k < seen.size(); k += std::max<std::size_t>(1, seen.size() / kMost)) {
        const std::size_t i = seen[k];
        points.push_back({static_cast<double>(i % samples) + 0.5, static_cast<double>(i / samples) + 0.5, planes[i],
                          planes[n + i], planes[2 * n + i]});
    }
    return points;
}

std::map<std::string, std::string> common_metadata(const GroupJob& job) {
    const auto pose = job.geometry.path.at(0.0);
    const auto& group = job.group;
    const auto& scan = job.geometry.scan;
    const auto place_in_scan = sensors::scan_position_of(job.geometry, 0, 0);
    const bool lines_of_scans = scan.kind != sensors::ScanLaw::Kind::Frame && scan.kind != sensors::ScanLaw::Kind::Disk;
    return {{"FINGERPRINT", job.fingerprint},
            {"SCAN_TYPE", scan_type_name(job.sensor.scan)},
            {"FIRST_SAMPLE", fmt::format("{}", job.geometry.first_sample)},
            {"FIRST_LINE", fmt::format("{}", job.geometry.first_line)},
            {"LINES_PER_SCAN", fmt::format("{}", lines_of_scans ? scan.lines_per_scan : job.geometry.lines)},
            {"FIRST_LINE_OF_SCAN", fmt::format("{}", lines_of_scans ? static_cast<int>(std::floor(place_in_scan.v)) : 0)},
            {"SCENARIO", job.scenario.name},
            {"ACQUISITION", job.acquisition.id},
            {"SENSOR", job.sensor.id},
            {"CAMERA_GROUP", group.id},
            {"TIME_S", fmt::format("{}", job.acquisition.time_s)},
            {"PLATFORM_LATITUDE_DEG", fmt::format("{:.10f}", pose.position.lat_deg)},
            {"PLATFORM_LONGITUDE_DEG", fmt::format("{:.10f}", pose.position.lon_deg)},
            {"PLATFORM_HEIGHT_M", fmt::format("{:.4f}", pose.position.h_m)},
            {"PLATFORM_HEADING_DEG", fmt::format("{}", pose.heading_rad / kDegree_rad)},
            {"PLATFORM_PITCH_DEG", fmt::format("{}", pose.pitch_rad / kDegree_rad)},
            {"PLATFORM_ROLL_DEG", fmt::format("{}", pose.roll_rad / kDegree_rad)},
            {"FOCAL_LENGTH_M", fmt::format("{}", group.focal_length_m)},
            {"PIXEL_PITCH_M", fmt::format("{}", group.pixel_pitch_m)},
            {"PHYSICS", job.scenario.physics == fire::Physics::Thesis ? "thesis" : "default"}};
}

gis::OutputRaster sensor_raster(const GroupJob& job, const std::vector<gis::GroundControlPoint>& points) {
    gis::OutputRaster out;
    out.cols = job.geometry.samples;
    out.rows = job.geometry.lines;
    out.geolocation = job.files.geolocation();
    out.control_points = points;
    out.metadata = common_metadata(job);
    out.acquisition_time = UtcTime{job.scenario.start.unix_s + job.acquisition.time_s}.iso8601();
    return out;
}

void write_geolocation(const GroupJob& job, const std::vector<double>& planes) {
    auto out = sensor_raster(job, {});
    out.geolocation.reset();
    out.compression = gis::Compression::Zstd;
    for (const auto& [name, unit] : kGeolocationBands) out.bands.push_back({name, unit, {}, {}, {}});
    gis::write_geotiff(job.files.geolocation(), out, std::span<const double>(planes));
}

/// What the detector makes of the noise-free image.
struct Measured {
    Buffer<float> radiance_W_m2_sr_um;    ///< [band][line][sample]
    std::vector<std::uint8_t> saturated;  ///< same shape, 1 = clipped, 2 = folded over; of one band when no truth is wanted
};

/// Takes the noise-free radiance away when no truth is wanted, to have a cube only once.
Measured measure(const GroupJob& job, RadianceImage& image, RunReport& report) {
    const bool truth = job.scenario.products.truth;
    const std::size_t n = image.coverage.size();
    Measured out;
    out.saturated.resize(truth ? image.radiance_W_m2_sr_um.size() : n);
    out.radiance_W_m2_sr_um = truth ? image.radiance_W_m2_sr_um : std::move(image.radiance_W_m2_sr_um);
    for (std::size_t k = 0; k < job.bands.size(); ++k) {
        auto band = job.sensor.bands[static_cast<std::size_t>(job.bands[k])];
        if (!job.scenario.render.noise) {
            band.noise = {};
            if (band.sensitive_range) band.sensitive_range->noise = {};
        }
        const auto stream = fmt::format("noise/{}/{}", job.acquisition.id, band.id);
        const RandomKey key{job.scenario.seed, stream_id(stream.c_str()), 0};
        sensors::add_stray_light(job.sensor.stray, image.samples, std::span(out.radiance_W_m2_sr_um).subspan(k * n, n));
        const auto count = sensors::apply_detector(band, key, std::span(out.radiance_W_m2_sr_um).subspan(k * n, n),
                                                   std::span(out.saturated).subspan(truth ? k * n : 0, n));
        report.count(fmt::format("saturated_pixels/{}/{}", job.acquisition.id, band.id), count);
    }
    return out;
}

void write_radiance(const GroupJob& job, const Measured& measured, const std::vector<gis::GroundControlPoint>& points) {
    auto out = sensor_raster(job, points);
    for (const int b : job.bands) {
        const auto& band = job.sensor.bands[static_cast<std::size_t>(b)];
        gis::OutputBand meta{band.id + " radiance", "W m-2 sr-1 um-1", band.centre_um, band.fwhm_um, {{"band_id", band.id}}};
        if (band.saturation_radiance_W_m2_sr_um)
            meta.metadata["saturation_radiance"] = fmt::format("{:.6g}", *band.saturation_radiance_W_m2_sr_um);
        out.bands.push_back(std::move(meta));
    }
    gis::write_geotiff(job.files.radiance(), out, std::span<const float>(measured.radiance_W_m2_sr_um));
}

void write_truth(const GroupJob& job, const RadianceImage& image, const std::vector<std::uint8_t>& saturated) {
    auto out = sensor_raster(job, {});
    out.compression = gis::Compression::Zstd;  // the largest file; read by this program and by GDAL, hardly by others
    const std::size_t n = image.coverage.size();
    Buffer<float> pixels;
    pixels.reserve(n * (10 + job.bands.size() * (2 + render::kTermCount)));
    const auto add = [&](gis::OutputBand band, const auto& plane) {
        out.bands.push_back(std::move(band));
        pixels.insert(pixels.end(), plane.begin(), plane.end());
    };
    const auto fraction = [](const char* name) { return gis::OutputBand{name, "1", {}, {}, {}}; };
    Buffer<float> smoke = image.smoke_fraction;
    if (smoke.empty()) {  // no plume: the fraction is 0 wherever something is seen
        smoke.resize(n);
        for (std::size_t i = 0; i < n; ++i) smoke[i] = image.flame_fraction[i] * 0.0F;
    }
    add(fraction("fraction_flame"), image.flame_fraction);
    add(fraction("fraction_front"), image.front_fraction);
    add(fraction("fraction_scar"), image.scar_fraction);
    add(fraction("fraction_background"), image.background_fraction);
    add(fraction("fraction_smoke"), smoke);
    add({"ground_temperature", "K", {}, {}, {}}, image.ground_temperature_K);
    add({"flame_temperature", "K", {}, {}, {}}, image.flame_temperature_K);
    add({"fire_radiant_exitance", "W m-2", {}, {}, {}}, image.radiant_exitance_W_m2);
    add(fraction("scene_coverage"), image.coverage);
    for (std::size_t k = 0; k < job.bands.size(); ++k) {
        const auto& band = job.sensor.bands[static_cast<std::size_t>(job.bands[k])];
        const auto plane = [&](const auto& cube) { return std::span(cube).subspan(k * n, n); };
        const auto radiance = [&](const std::string& name) {
            return gis::OutputBand{
                band.id + " " + name, "W m-2 sr-1 um-1", band.centre_um, band.fwhm_um, {{"band_id", band.id}}};
        };
        add(radiance("radiance_noise_free"), plane(image.radiance_W_m2_sr_um));
        add({band.id + " saturated", "1", {}, {}, {{"band_id", band.id}}}, plane(saturated));
        for (std::size_t t = 0; t < image.terms.size(); ++t)
            if (!image.terms[t].empty()) add(radiance(std::string("term_") + render::kTermNames[t]), plane(image.terms[t]));
    }
    gis::write_geotiff(job.files.truth(), out, std::span<const float>(pixels));
}

void report_image(const GroupJob& job, const RadianceImage& image, const render::RenderScene& scene, bool open,
                  RunReport& report) {
    const auto pixels = static_cast<std::int64_t>(image.coverage.size());
    report.count("pixels", pixels);
    const auto missed = std::count_if(image.coverage.begin(), image.coverage.end(), [](float c) { return !(c > 0.0F); });
    if (missed == pixels && !open)
        throw input_error(fmt::format("acquisition '{}'", job.acquisition.id), "the camera does not see the map at all");
    if (missed > 0 && !open)
        report.warn(fmt::format("acquisition '{}': {} of {} pixels look past the scene and {}", job.acquisition.id, missed,
                                pixels, scene.surroundings ? "show its surroundings (render.background)" : "are no data"));
    report.count("transport_wavelengths/" + job.acquisition.id, scene.optics->lambda_count);
    report.count("flame_bricks/" + job.acquisition.id, static_cast<std::int64_t>(scene.flame->bricks.size()));
    if (render::has_plume(scene))
        report.count("plume_bricks/" + job.acquisition.id, static_cast<std::int64_t>(scene.plume->bricks.size()));
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

/// Height above the ground from which a path at the largest view angle of the atmosphere tables is so long: near the ground
/// the air along a level line of sight is that of a slant path of the same length.
double height_of_slant_path_m(double length_m) {
    constexpr double kLargestViewZenith_deg = 65.0;
    return length_m * std::cos(kLargestViewZenith_deg * kDegree_rad);
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
    const auto spectral = make_spectral_scene(scenario, in, job.fire, responses, sensor_agl_m, sun.centre(), report);

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
    request.view = [&](int line, int sample, Vec3) {
        const auto position = sensors::scan_position_of(job.geometry, sample, line);
        const Vec3 v = chords.scan(position.scan).at(position.u, position.v).view_enu;
        const double line_of_sight_rad = std::atan2(v.x, v.y) + kPi;
        return render::PixelView{std::atan2(std::hypot(v.x, v.y), std::abs(v.z)),
                                 std::remainder(sun_azimuth_rad - line_of_sight_rad, 2.0 * kPi)};
    };
    request.terms = scenario.products.truth;

    RadianceImage image;
    {
        const PhaseTimer timer(report, "render/image");
        image = render::render_image(scene, &light, request, monitor);
    }
    report_image(job, image, scene, chords.open(), report);

    const PhaseTimer timer(report, "render/write");
    const auto planes =
        geolocate(image, job.geometry, chords, sun, scene.surroundings ? std::optional(in.mean_height_m) : std::nullopt);
    const auto points = control_points(image, planes);
    write_geolocation(job, planes);
    if (monitor.is_cancelled()) throw Cancelled();
    const auto measured = measure(job, image, report);
    if (scenario.products.truth) write_truth(job, image, measured.saturated);
    if (monitor.is_cancelled()) throw Cancelled();
    // The radiance comes last: its presence says that the acquisition is rendered.
    write_radiance(job, measured, points);
}

}  // namespace pyroscene::pipeline
