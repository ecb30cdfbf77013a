#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "base/constants.h"
#include "base/error.h"
#include "base/random.h"
#include "sensors/image_chords.h"

namespace pyroscene::sensors {
namespace {

struct View {
    const char *name, *crs;
    gis::Geodetic position;
    double heading_deg, pitch_deg, roll_deg;
    double bottom_m, top_m;
};
void PrintTo(const View& view, std::ostream* out) { *out << view.name; }

Pose pose_of(const View& v) {
    return {.position = v.position,
            .heading_rad = v.heading_deg * kDegree_rad,
            .pitch_rad = v.pitch_deg * kDegree_rad,
            .roll_rad = v.roll_deg * kDegree_rad};
}

/// Chords of one frame.
ImageChords frame(const Sensor& sensor, const CameraGroup& camera, const Pose& pose, const gis::MapProjection& map,
                  Vec3 origin_m, double bottom_m, double top_m, double reach_m = 0.0) {
    const ImageGeometry image{.sensor = &sensor,
                              .group = &camera,
                              .scan = camera.scan,
                              .path = standing(pose),
                              .samples = camera.samples,
                              .lines = camera.lines};
    return {image, map, origin_m, bottom_m, top_m, reach_m};
}

class AnyView : public testing::TestWithParam<View> {};

TEST_P(AnyView, IsInterpolatedToAMillimetre) {
    const View& view = GetParam();
    const Sensor wasp = load_sensor("wasp");
    const CameraGroup& ir = wasp.group("ir");
    const Pose pose = pose_of(view);
    const gis::MapProjection map(view.crs);
    const auto under = map.to_map(view.position.lat_deg, view.position.lon_deg);
    const Vec3 origin{std::round(under[0]), std::round(under[1]), 1000.0};
    const ImageChords image = frame(wasp, ir, pose, map, origin, view.bottom_m, view.top_m);
    const ScanChords chords = image.scan(0);
    double worst = 0.0, worst_view = 0.0, worst_deg = 0.0;  // the first in units of what is allowed
    for (std::uint64_t i = 0; i < 2000; ++i) {              // anywhere in the frame and 4 pixels around it
        const double sample = -4.0 + 648.0 * uniform01({}, i, 0), line = -4.0 + 520.0 * uniform01({}, i, 1);
        const Chord chord = chords.at(sample, line);
        const auto ends = chords.ends(sample, line);
        EXPECT_EQ(ends.top_m, chord.top_m);
        EXPECT_EQ(ends.bottom_m, chord.bottom_m);
        const EcefRay ray = pixel_ray(wasp, ir, pose, sample, line);
        const auto top = intersect_height(ray, view.top_m), bottom = intersect_height(ray, view.bottom_m);
        const auto top_xy = map.to_map(top.lat_deg, top.lon_deg), bottom_xy = map.to_map(bottom.lat_deg, bottom.lon_deg);
        const double error_m = std::max(
            {std::abs(chord.top_m.x + origin.x - top_xy[0]), std::abs(chord.top_m.y + origin.y - top_xy[1]),
             std::abs(chord.bottom_m.x + origin.x - bottom_xy[0]), std::abs(chord.bottom_m.y + origin.y - bottom_xy[1]),
             std::abs(chord.top_m.z + origin.z - view.top_m), std::abs(chord.bottom_m.z + origin.z - view.bottom_m),
             std::abs(chord.bottom_range_m - look_angles(bottom, ray.origin_m).range_m),
             std::abs(chord.top_range_m - look_angles(top, ray.origin_m).range_m)});
        const auto next = intersect_height(pixel_ray(wasp, ir, pose, sample, line - 1.0), view.bottom_m);
        const double pixel_m = length(gis::ecef_from_geodetic(next) - gis::ecef_from_geodetic(bottom));
        worst = std::max(worst, error_m / std::max(1e-3, 1e-5 * pixel_m));
        worst_deg = std::max({worst_deg, std::abs(std::remainder(chord.bottom_lon_deg - bottom.lon_deg, 360.0)),
                              std::abs(chord.bottom_lat_deg - bottom.lat_deg), std::abs(chord.top_lat_deg - top.lat_deg),
                              std::abs(std::remainder(chord.top_lon_deg - top.lon_deg, 360.0))});
        const LookAngles look = look_angles(bottom, ray.origin_m);
        const Vec3 expected{std::sin(look.zenith_rad) * std::sin(look.azimuth_rad),
                            std::sin(look.zenith_rad) * std::cos(look.azimuth_rad), std::cos(look.zenith_rad)};
        worst_view = std::max(worst_view, length(chord.view_enu - expected));
    }
    EXPECT_LT(worst, 1.0);
    EXPECT_LT(worst_deg, 5e-8);  // 5 mm: from orbit a pixel is 500 m long
    EXPECT_LT(worst_view, 1e-7);
}

INSTANTIATE_TEST_SUITE_P(
    Cameras, AnyView,
    testing::Values(View{"utm_north_tilted", "EPSG:32611", {46.7, -114.2, 6000.0}, 37, 25, -12, 900.0, 2800.0},
                    View{"utm_south", "EPSG:32755", {-36.5, 147.3, 6000.0}, 200, -15, 20, 200.0, 1800.0},
                    View{"zone_edge", "EPSG:32611", {44.0, -119.98, 5000.0}, 290, 10, 30, 0.0, 1200.0},
                    View{"beyond_zone_edge", "EPSG:32611", {44.0, -121.5, 5000.0}, 290, 10, 30, 0.0, 1200.0},
                    View{"antimeridian", "EPSG:32660", {-16.0, 179.99, 5000.0}, 90, 20, 0, 0.0, 1000.0},
                    View{"very_oblique", "EPSG:32611", {46.7, -114.2, 6000.0}, 120, 60, 0, 900.0, 2800.0},
                    View{"nadir_from_orbit", "EPSG:32611", {46.7, -114.2, 500000.0}, 12, 0, 25, 900.0, 2800.0},
                    View{"lambert", "EPSG:5070", {46.7, -114.2, 6000.0}, 37, 25, -12, 900.0, 2800.0}),
    [](const auto& test) { return std::string(test.param.name); });

/// A level camera near the ground sees ground and sky; its lines of sight all end 800 m away.
TEST(FrameChords, RunToAFixedDistanceWhereACameraNearTheGroundSeesTheHorizon) {
    const Sensor wasp = load_sensor("wasp");
    const CameraGroup& ir = wasp.group("ir");
    const gis::MapProjection map("EPSG:32611");
    const Pose pose{.position = {46.7, -114.2, 1002.0}, .heading_rad = 1.2, .pitch_rad = 95.0 * kDegree_rad};
    const auto under = map.to_map(pose.position.lat_deg, pose.position.lon_deg);
    const Vec3 origin{under[0], under[1], 0.0};
    constexpr double kReach_m = 800.0;
    const ImageChords chords = frame(wasp, ir, pose, map, origin, 990.0, 1010.0, kReach_m);
    EXPECT_TRUE(chords.open());
    const double convergence_rad = map.convergence_rad(under[0], under[1]);
    const auto scan = chords.scan(0);
    for (std::uint64_t i = 0; i < 500; ++i) {
        const double sample = 640.0 * uniform01({}, i, 0), line = 512.0 * uniform01({}, i, 1);
        const Chord chord = scan.at(sample, line);
        EXPECT_LT(length(chord.top_m - Vec3{0.0, 0.0, 1002.0}), 1e-6);
        EXPECT_NEAR(chord.bottom_range_m, kReach_m, 1e-9);
        const Vec3 way_m = chord.bottom_m - chord.top_m;
        // Map scale is within 1e-3 of 1 and the Earth bends by 5 cm over 800 m.
        EXPECT_NEAR(length(way_m), kReach_m, 1.0);
        const gis::LocalAxes axes = gis::local_axes(pose.position.lat_deg, pose.position.lon_deg);
        const Vec3 looks = pixel_ray(wasp, ir, pose, sample, line).direction;
        const double azimuth_rad = std::atan2(dot(looks, axes.east), dot(looks, axes.north)) - convergence_rad,
                     up = dot(looks, axes.up), level = std::sqrt(1.0 - up * up);
        const Vec3 on_map{level * std::sin(azimuth_rad), level * std::cos(azimuth_rad), up};
        EXPECT_LT(length(normalized(way_m) - on_map), 1e-3);
    }
    // One that sees nothing but ground near by ends below it as ever, and one high above still must.
    Pose down = pose;
    down.pitch_rad = 20.0 * kDegree_rad;
    EXPECT_FALSE(frame(wasp, ir, down, map, origin, 990.0, 1010.0, kReach_m).open());
    Pose high = pose;
    high.position.h_m = 3000.0;
    EXPECT_THROW(frame(wasp, ir, high, map, origin, 990.0, 1010.0, kReach_m), Error);
}

const View kLow{"low", "EPSG:32611", {46.7, -114.2, 2000.0}, 0, 10, 0, 900.0, 2800.0};

TEST(FrameChords, StartAtAPlatformBelowTheUpperShell) {
    const Sensor wasp = load_sensor("wasp");
    const gis::MapProjection map(kLow.crs);
    const auto under = map.to_map(kLow.position.lat_deg, kLow.position.lon_deg);
    const ImageChords chords =
        frame(wasp, wasp.group("ir"), pose_of(kLow), map, {under[0], under[1], 0.0}, kLow.bottom_m, kLow.top_m);
    const Chord chord = chords.scan(0).at(100.0, 400.0);
    EXPECT_NEAR(length(chord.top_m - Vec3{0.0, 0.0, 2000.0}), 0.0, 1e-6);
    EXPECT_NEAR(chord.top_range_m, 0.0, 1e-9);
    EXPECT_NEAR(chord.bottom_m.z, 900.0, 1e-9);
    EXPECT_NEAR(chord.top_lat_deg, 46.7, 1e-11);
}

std::string message_of(const View& view) {
    const Sensor wasp = load_sensor("wasp");
    try {
        static_cast<void>(
            frame(wasp, wasp.group("ir"), pose_of(view), gis::MapProjection(view.crs), {}, view.bottom_m, view.top_m));
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Input);
        return e.what();
    }
    return "accepted";
}

TEST(FrameChords, RefuseACameraThatDoesNotLookAtTheGround) {
    View view = kLow;
    view.pitch_deg = 85;
    EXPECT_NE(message_of(view).find("passes over the horizon"), std::string::npos) << message_of(view);
    view.pitch_deg = 180;
    EXPECT_NE(message_of(view).find("passes over the horizon"), std::string::npos) << message_of(view);
    view = kLow;
    view.bottom_m = 2100.0;
    EXPECT_NE(message_of(view).find("not above the lowest ground"), std::string::npos) << message_of(view);
}

}  // namespace
}  // namespace pyroscene::sensors
