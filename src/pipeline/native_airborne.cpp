// Framing cameras with exterior orientation and a rational camera model (WASP); line scanners with position and attitude of
// every line, and the orthomosaic of the thermal band with hot pixels that interpreters get (Phoenix).
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/rpc.h"
#include "base/constants.h"
#include "base/files.h"
#include "gis/tiff_writer.h"
#include "pipeline/native.h"
#include "radiometry/planck.h"

namespace pyroscene::pipeline {
namespace {

using Json = nlohmann::ordered_json;

gis::OutputRaster raster_of(const NativeJob& job) {
    gis::OutputRaster out;
    out.acquisition_time = UtcTime{job.unix_s()}.iso8601();
    out.metadata = {{"SCENARIO", job.job.scenario.name},
                    {"ACQUISITION", job.job.acquisition.id},
                    {"SENSOR", job.job.sensor.id},
                    {"CAMERA_GROUP", job.job.group.id}};
    return out;
}

std::filesystem::path file_of(const NativeJob& job, const char* what) {
    return job.file(job.job.acquisition.id + job.job.files.suffix + what);
}

/// Image and ground points of the exact camera, over the image and the heights of the scene (with a tenth to spare).
std::vector<analysis::GroundTie> camera_ties(const NativeJob& job) {
    constexpr int kPerAxis = 15, kHeights = 7;
    const auto& geometry = *job.job.geometry;
    const auto& in = job.job.inputs;
    const double spare_m = 0.1 * (in.highest_m - in.lowest_m) + 10.0, low_m = in.lowest_m - spare_m,
                 high_m = in.highest_m + spare_m;
    std::vector<analysis::GroundTie> ties;
    for (int i = 0; i < kPerAxis; ++i)
        for (int j = 0; j < kPerAxis; ++j) {
            const double u = geometry.samples * i / (kPerAxis - 1.0), v = geometry.lines * j / (kPerAxis - 1.0);
            const auto ray = sensors::sightline(geometry, 0.0, u, v).ray;
            for (int k = 0; k < kHeights; ++k) {
                const auto point = sensors::intersect_height(ray, std::lerp(low_m, high_m, k / (kHeights - 1.0)));
                if (!std::isfinite(point.lat_deg)) continue;
                ties.push_back({point.lat_deg, point.lon_deg, point.h_m, u - 0.5, v - 0.5});
            }
        }
    return ties;
}

/// Axes of the camera (right, up in the image, backwards) in the map's east, north and up.
std::array<Vec3, 3> camera_on_map(const sensors::Sensor& sensor, const sensors::Pose& pose, double convergence_rad) {
    const auto axes = gis::local_axes(pose.position.lat_deg, pose.position.lon_deg);
    const double c = std::cos(convergence_rad), s = std::sin(convergence_rad);
    const auto on_map = [&](Vec3 body) {
        const Vec3 d = sensors::body_ray(sensor, pose, body).direction;
        const double east = dot(d, axes.east), north = dot(d, axes.north);
        return Vec3{c * east - s * north, s * east + c * north, dot(d, axes.up)};
    };
    return {on_map({0.0, 1.0, 0.0}), on_map({1.0, 0.0, 0.0}), on_map({0.0, 0.0, -1.0})};
}

/// Omega, phi, kappa of the rotation from map to image axes, M = M(kappa) M(phi) M(omega) [degrees].
std::array<double, 3> omega_phi_kappa_deg(const std::array<Vec3, 3>& m) {
    return {std::atan2(-m[2].y, m[2].z) / kDegree_rad, std::asin(std::clamp(m[2].x, -1.0, 1.0)) / kDegree_rad,
            std::atan2(-m[1].x, m[0].x) / kDegree_rad};
}

Json orientation(const NativeJob& job, double residual_px) {
    const auto& sensor = job.job.sensor;
    const auto& group = job.job.group;
    const auto pose = job.job.geometry->path.at(0.0);
    const gis::MapProjection map(job.job.inputs.grid.crs_wkt);
    const auto [x_m, y_m] = map.to_map(pose.position.lat_deg, pose.position.lon_deg);
    const auto axes = camera_on_map(sensor, pose, map.convergence_rad(x_m, y_m));
    const auto [omega, phi, kappa] = omega_phi_kappa_deg(axes);
    const Vec3 ecef = gis::ecef_from_geodetic(pose.position);
    Json rows = Json::array();
    for (const Vec3& a : axes) rows.push_back({a.x, a.y, a.z});
    return {{"synthetic", true},
            {"image", job.job.acquisition.id + job.job.files.suffix + "_frame.tif"},
            {"time", UtcTime{job.unix_s()}.iso8601()},
            {"position",
             {{"latitude_deg", pose.position.lat_deg},
              {"longitude_deg", pose.position.lon_deg},
              {"ellipsoidal_height_m", pose.position.h_m},
              {"ecef_m", {ecef.x, ecef.y, ecef.z}},
              {"map_xyz_m", {x_m, y_m, pose.position.h_m}}}},
            {"attitude_deg",
             {{"heading_true_north", pose.heading_rad / kDegree_rad},
              {"pitch_nose_up", pose.pitch_rad / kDegree_rad},
              {"roll_right_wing_down", pose.roll_rad / kDegree_rad}}},
            {"omega_phi_kappa_deg", {omega, phi, kappa}},
            {"rotation_map_to_camera", rows},
            {"camera",
             {{"samples", group.samples},
              {"lines", group.lines},
              {"focal_length_mm", 1e3 * group.focal_length_m},
              {"pixel_pitch_um", 1e6 * group.pixel_pitch_m},
              {"principal_point_px", {group.principal_point_px[0], group.principal_point_px[1]}},
              {"brown_k", {group.radial[0], group.radial[1], group.radial[2]}},
              {"brown_p", {group.tangential[0], group.tangential[1]}}}},
            {"rpc_largest_residual_px", residual_px},
            {"conventions",
             "camera x to the right, y up in the image, z backwards; map x east, y north, z up; pixel centres at integers; "
             "no correction of map scale or Earth curvature in omega, phi, kappa"}};
}

/// Brightness temperature of a rendered band.
std::vector<float> brightness_K(const NativeJob& job, std::size_t k) {
    const radiometry::BandThermometer thermometer(job.band(k).response);
    auto out = job.image.radiance_plane(k);
    for (float& value : out) value = static_cast<float>(thermometer.temperature_K(value));
    return out;
}

/// The band nearest to a wavelength.
std::size_t band_near(const NativeJob& job, double lambda_um) {
    std::size_t best = 0;
    for (std::size_t k = 1; k < job.job.bands.size(); ++k)
        if (std::abs(job.band(k).centre_um - lambda_um) < std::abs(job.band(best).centre_um - lambda_um)) best = k;
    return best;
}

/// Position and attitude when the middle of each line is taken.
void write_lines(const NativeJob& job) {
    const auto& g = *job.job.geometry;
    std::string text = "line,time_utc,latitude_deg,longitude_deg,ellipsoidal_height_m,heading_deg,pitch_deg,roll_deg\n";
    for (int line = 0; line < g.lines; ++line) {
        const auto at = sensors::scan_position_of(g, g.samples / 2, line);
        const auto look = sensors::sightline(g, at.scan, at.u, at.v);
        text += fmt::format("{},{},{:.8f},{:.8f},{:.3f},{:.5f},{:.5f},{:.5f}\n", line,
                            UtcTime{job.job.scenario.start.unix_s + sensors::pixel_time_s(g, g.samples / 2, line)}.iso8601(),
                            look.pose.position.lat_deg, look.pose.position.lon_deg, look.pose.position.h_m,
                            look.pose.heading_rad / kDegree_rad, look.pose.pitch_rad / kDegree_rad,
                            look.pose.roll_rad / kDegree_rad);
    }
    write_text_file(file_of(job, "_lines.csv"), text);
}

}  // namespace

void write_oriented_frame(const NativeJob& job) {
    const auto ties = camera_ties(job);
    const auto camera = analysis::fit_rational_camera(ties);
    const double residual_px = analysis::largest_residual_px(camera, ties);
    auto out = raster_of(job);
    out.cols = job.image.samples;
    out.rows = job.image.lines;
    out.bands = job.image.radiance->info().bands;
    for (const auto& [key, value] : analysis::rpc_metadata(camera, residual_px)) out.rpc[key] = value;
    gis::TiffWriter frame(file_of(job, "_frame.tif"), std::move(out));
    for (std::size_t k = 0; k < job.job.bands.size(); ++k)
        frame.write({k, 1, 0, job.image.lines}, job.image.radiance_plane(k));
    frame.finish();
    write_text_file(file_of(job, "_orientation.json"), orientation(job, residual_px).dump(2) + "\n");
    job.report.record("rpc_largest_residual_px/" + job.job.acquisition.id + job.job.files.suffix, residual_px);
}

void write_strip(const NativeJob& job) {
    constexpr double kMid_um = 4.0, kLong_um = 10.0;
    constexpr float kHotter_K = 20.0F, kHot_K = 330.0F, kVeryHot_K = 350.0F;  // 330 K: above sunlit ground
    const auto& r = job.image;
    const std::size_t mid = band_near(job, kMid_um), longwave = band_near(job, kLong_um);
    const auto mid_K = brightness_K(job, mid), long_K = brightness_K(job, longwave);
    std::vector<float> hot(r.n);
    for (std::size_t i = 0; i < r.n; ++i) {
        const bool is_hot = mid_K[i] > kHot_K && (mid_K[i] - long_K[i] > kHotter_K || long_K[i] > kVeryHot_K);
        hot[i] = std::isnan(long_K[i]) || std::isnan(mid_K[i]) ? std::nanf("") : is_hot ? 1.0F : 0.0F;
    }
    auto out = raster_of(job);
    const auto temperature = [&](std::size_t k) {
        const auto& band = job.band(k);
        return gis::OutputBand{band.id + " brightness temperature", "K", band.centre_um, band.fwhm_um, {}};
    };
    out.bands = {temperature(longwave), temperature(mid), {"hot pixel", "1", {}, {}, {}}};
    std::vector<float> strip, mosaic;
    for (const auto* plane : std::initializer_list<const std::vector<float>*>{&long_K, &mid_K, &hot}) {
        strip.insert(strip.end(), plane->begin(), plane->end());
        const auto map = analysis::ortho_resample(job.lookup, r.samples, r.lines, *plane, plane == &hot);
        mosaic.insert(mosaic.end(), map.begin(), map.end());
    }
    out.cols = r.samples;
    out.rows = r.lines;
    out.geolocation = job.job.files.geolocation();
    gis::write_geotiff(file_of(job, "_strip.tif"), out, std::span<const float>(strip));
    out.geolocation.reset();
    out.grid = job.lookup.grid;
    out.cols = job.lookup.grid.cols;
    out.rows = job.lookup.grid.rows;
    gis::write_cog(file_of(job, "_orthomosaic.tif"), out, std::span<const float>(mosaic));
    write_lines(job);
}

}  // namespace pyroscene::pipeline
