#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/csv.h"
#include "base/error.h"
#include "gis/geodesy.h"
#include "pipeline/acquisition.h"

namespace pyroscene::pipeline {
namespace {

using scenario::Acquisition;
using Pass = scenario::Platform::Pass;

std::string subject(const Acquisition& a) { return fmt::format("acquisition '{}'", a.id); }

std::vector<sensors::Pose> read_poses(const std::filesystem::path& file) {
    const auto table = read_csv(file);
    const auto time_s = table.numbers("time_s"), lat = table.numbers("lat_deg"), lon = table.numbers("lon_deg"),
               height_m = table.numbers("height_m"), heading = table.numbers("heading_deg"),
               pitch = table.numbers("pitch_deg"), roll = table.numbers("roll_deg");
    std::vector<sensors::Pose> poses;
    for (std::size_t i = 0; i < time_s.size(); ++i)
        poses.push_back({.position = {lat[i], lon[i], height_m[i]},
                         .heading_rad = heading[i] * kDegree_rad,
                         .pitch_rad = pitch[i] * kDegree_rad,
                         .roll_rad = roll[i] * kDegree_rad,
                         .time_s = time_s[i]});
    return poses;
}

/// Flight along measured poses; its time 0 is that of the acquisition.
sensors::Trajectory flown_path(const Acquisition& a) {
    auto path = sensors::flown(read_poses(*a.platform.trajectory));
    path.at = [at = path.at, start_s = a.time_s](double time_s) { return at(start_s + time_s); };
    return path;
}

/// A geostationary sensor sees what it sees; the map has to lie above its horizon.
void check_horizon(const Acquisition& a, const inputs::SceneInputs& in, const sensors::Sensor& sensor,
                   const sensors::Trajectory& path) {
    auto target = in.centre;
    target.h_m = in.mean_height_m;
    const Vec3 ground = gis::ecef_from_geodetic(target);
    const Vec3 up = gis::ecef_from_geodetic({target.lat_deg, target.lon_deg, target.h_m + 1.0}) - ground;
    const Vec3 towards = normalized(gis::ecef_from_geodetic(path.at(0.0).position) - ground);
    const double zenith_deg = std::acos(std::clamp(dot(up, towards), -1.0, 1.0)) / kDegree_rad;
    if (zenith_deg > 90.0)
        throw input_error(subject(a), fmt::format("the map lies below the horizon of sensor '{}' above {:.1f} E (it stands "
                                                  "{:.0f} deg from the zenith)",
                                                  sensor.id, *sensor.orbit->geostationary_longitude_deg, zenith_deg));
}

/// Direction in which a pass sees its place.
sensors::Trajectory pass_path(const Acquisition& a, const inputs::SceneInputs& in, const fire::FireState* state,
                              const sensors::Sensor& sensor, const sensors::ScanLaw& law) {
    if (!sensor.orbit)
        throw input_error(subject(a), fmt::format("platform.pass needs an orbit, and sensor '{}' has none", sensor.id));
    const bool stands = sensor.orbit->geostationary_longitude_deg.has_value();
    if (stands != (a.platform.pass == Pass::Geostationary))
        throw input_error(subject(a),
                          stands ? fmt::format("sensor '{}' is geostationary: platform.pass: geostationary", sensor.id)
                                 : fmt::format("sensor '{}' is not geostationary; platform.pass: ascending or "
                                               "descending",
                                               sensor.id));
    if (stands && a.platform.scan_angle_deg != 0.0)
        throw input_error(subject(a),
                          "platform.scan_angle_deg has no place in a geostationary pass, which sees what it sees");
    if (stands) {
        auto path = sensors::geostationary(*sensor.orbit);
        check_horizon(a, in, sensor, path);
        return path;
    }
    // The place, on the ground.
    Acquisition over = a;
    over.platform.altitude_m = in.highest_m + 1.0;
    auto target = resolve_pose(over, in, state).position;
    target.h_m = in.mean_height_m;
    const double angle_rad = a.platform.scan_angle_deg * kDegree_rad;
    const bool cone = law.kind == sensors::ScanLaw::Kind::Cone;
    const Vec3 direction =
        cone ? sensors::scan_direction(law, 0.5 * law.positions + angle_rad / law.step_across_rad, 0.5 * law.lines_per_scan)
             : sensors::mirror_direction(angle_rad, 0.0);
    return sensors::orbit_pass(*sensor.orbit, a.platform.pass == Pass::Ascending, target, direction,
                               a.platform.pitch_deg * kDegree_rad, a.platform.roll_deg * kDegree_rad);
}

/// Corners, edges and centre of the map at its lowest and highest ground.
std::vector<gis::Geodetic> outline(const inputs::SceneInputs& in) {
    const gis::MapProjection map(in.grid.crs_wkt);
    std::vector<gis::Geodetic> points;
    constexpr int kPerSide = 4;
    for (const double height_m : {in.lowest_m, in.highest_m})
        for (int row = 0; row <= kPerSide; ++row)
            for (int col = 0; col <= kPerSide; ++col)
                points.push_back(map.to_geodetic(in.grid.west_m + in.grid.cols * in.grid.cell_m * col / kPerSide,
                                                 in.grid.north_m - in.grid.rows * in.grid.cell_m * row / kPerSide,
                                                 height_m));
    return points;
}

/// Keys of scanners beside a camera that takes its image at one moment.
void check_frame_keys(const Acquisition& a, const sensors::Sensor& sensor) {
    const char* key = a.lines                       ? "lines"
                      : a.whole_lines               ? "samples"
                      : a.platform.ground_speed_m_s ? "platform.ground_speed_m_s"
                                                    : nullptr;
    if (key != nullptr)
        throw input_error(
            subject(a), fmt::format("{} is for scanners, and sensor '{}' takes whole frames; leave it out", key, sensor.id));
}

}  // namespace

sensors::ImageGeometry resolve_geometry(const Acquisition& a, const inputs::SceneInputs& in, const fire::FireState* state,
                                        const sensors::Sensor& sensor, const sensors::CameraGroup& group) {
    sensors::ImageGeometry image{.sensor = &sensor, .group = &group, .time_s = a.time_s};
    const bool frame = group.scan.kind == sensors::ScanLaw::Kind::Frame;
    if (frame) check_frame_keys(a, sensor);
    if (a.platform.trajectory) {
        image.path = flown_path(a);
    } else if (a.platform.pass != Pass::None) {
        image.scan = sensors::resolved_scan(sensor, group, a.view, sensor.orbit ? sensor.orbit->height_m : 0.0,
                                            sensor.ground_speed_m_s > 0.0 ? sensor.ground_speed_m_s : 1.0);
        image.path = pass_path(a, in, state, sensor, image.scan);
    } else {
        const auto pose = resolve_pose(a, in, state);
        const double speed_m_s = a.platform.ground_speed_m_s.value_or(sensor.ground_speed_m_s);
        if (!frame && !(speed_m_s > 0.0))
            throw input_error(subject(a), fmt::format("sensor '{}' scans while it moves, and no speed is known; give "
                                                      "platform.ground_speed_m_s, platform.pass or platform.trajectory",
                                                      sensor.id));
        image.path = frame ? sensors::standing(pose) : sensors::straight_flight(pose, speed_m_s);
    }
    const auto pose = image.path.at(0.0);
    const double agl_m = std::max(1.0, pose.position.h_m - in.mean_height_m);
    image.scan = sensors::resolved_scan(sensor, group, a.view, agl_m, image.path.ground_speed_m_s);
    constexpr int kMargin_px = 2;
    sensors::crop_to(image, outline(in), kMargin_px, a.whole_lines, a.lines);
    return image;
}

}  // namespace pyroscene::pipeline
