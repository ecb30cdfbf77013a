#include "sensors/image_geometry.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "base/constants.h"
#include "base/error.h"
#include "base/random.h"
#include "sensors/image_chords.h"

namespace pyroscene::sensors {
namespace {

double ground_distance_m(const gis::Geodetic& a, const gis::Geodetic& b) {
    return length(gis::ecef_from_geodetic({a.lat_deg, a.lon_deg, 0.0}) -
                  gis::ecef_from_geodetic({b.lat_deg, b.lon_deg, 0.0}));
}

TEST(Trajectory, StraightFlightKeepsHeightAndSpeed) {
    const auto path =
        straight_flight({.position = {0.0, 10.0, 20000.0}, .heading_rad = 0.5 * kPi, .pitch_rad = 0.01}, 205.0);
    const Pose pose = path.at(60.0);  // along the equator, a circle of 6378137 m
    EXPECT_NEAR(pose.position.lon_deg, 10.0 + 205.0 * 60.0 / 6378137.0 / kDegree_rad, 1e-10);
    EXPECT_NEAR(pose.position.lat_deg, 0.0, 1e-12);
    EXPECT_EQ(pose.position.h_m, 20000.0);
    EXPECT_EQ(pose.pitch_rad, 0.01);
    EXPECT_EQ(path.ground_speed_m_s, 205.0);
}

TEST(Trajectory, FlownPosesAreMetAndSmoothInBetween) {
    // A turn: heading through north from 350 to 20 deg, one row a second.
    std::vector<Pose> poses;
    for (int i = 0; i <= 3; ++i)
        poses.push_back({.position = {45.0 + 0.001 * i, -110.0, 3000.0 + 2.0 * i},
                         .heading_rad = (350.0 + 10.0 * i) * kDegree_rad,
                         .roll_rad = 0.02 * i,
                         .time_s = 100.0 + i});
    const auto path = flown(poses);
    EXPECT_FALSE(path.smooth);
    EXPECT_NEAR(path.at(101.0).position.lat_deg, 45.001, 1e-10);
    EXPECT_NEAR(path.at(101.0).position.h_m, 3002.0, 1e-4);
    const Pose between = path.at(100.5);
    EXPECT_NEAR(std::remainder(between.heading_rad / kDegree_rad - 355.0, 360.0), 0.0, 1e-2);
    EXPECT_NEAR(between.roll_rad, 0.01, 1e-4);
    EXPECT_NEAR(path.at(101.5).position.lat_deg, 45.0015, 1e-9);
    EXPECT_NEAR(path.ground_speed_m_s, 0.001 * kDegree_rad * 6371e3, 0.5);
    EXPECT_THROW(static_cast<void>(path.at(104.0)), Error);
    EXPECT_THROW(static_cast<void>(flown({poses[0]})), Error);
    std::swap(poses[1], poses[2]);
    EXPECT_THROW(static_cast<void>(flown(poses)), Error);
}

TEST(Trajectory, APassSeesItsTargetAtItsAngle) {
    const Sensor modis = load_sensor("modis-terra");
    const gis::Geodetic target{46.7, -114.2, 1200.0};
    for (const double sigma_deg : {0.0, 25.0, -50.0})
        for (const bool ascending : {false, true}) {
            const Vec3 body = mirror_direction(sigma_deg * kDegree_rad, 0.0);
            const auto path = orbit_pass(*modis.orbit, ascending, target, body);
            const Pose pose = path.at(0.0);
            const auto hit = intersect_height(body_ray(modis, pose, body), target.h_m);
            EXPECT_NEAR(ground_distance_m(hit, target), 0.0, 0.01);
            EXPECT_NEAR(pose.position.h_m, 705e3, 1e-3);
            // Sun-synchronous orbits run to the west of north and south; the turning Earth adds to it.
            EXPECT_LT(std::sin(pose.heading_rad), 0.0);
            EXPECT_EQ(std::cos(pose.heading_rad) > 0.0, ascending);
            // 6755 m/s over a standing Earth, at the azimuth of the inclination, less the ground's own speed to the east.
            const double latitude = pose.position.lat_deg * kDegree_rad;
            const double east = 6755.0 * std::cos(98.2 * kDegree_rad) / std::cos(latitude),
                         ground = 465.1 * std::cos(latitude);
            const double north = std::sqrt(6755.0 * 6755.0 - east * east);
            const double speed_m_s = ground_distance_m(path.at(-0.5).position, path.at(0.5).position);
            EXPECT_NEAR(speed_m_s, std::hypot(east - ground, north), 15.0);
        }
    EXPECT_THROW(static_cast<void>(orbit_pass({.height_m = 410e3, .inclination_deg = 51.6}, true, {60, 0, 0}, {0, 0, 1})),
                 Error);
}

TEST(Trajectory, InclinationIsReachedAtTheEquator) {
    const auto path = orbit_pass({.height_m = 700e3, .inclination_deg = 51.6}, true, {0, 0, 0}, {0, 0, 1});
    // Inertial azimuth 90 - 51.6 deg; the Earth's turn takes 465 m/s off the eastward ground speed of cos(51.6 deg) v.
    const double v = std::sqrt(3.986004418e14 / 7078137.0),
                 eastward = v * std::cos(51.6 * kDegree_rad) - 7.292115e-5 * 7078137.0;
    EXPECT_NEAR(path.at(0.0).heading_rad, std::atan2(eastward, v * std::sin(51.6 * kDegree_rad)), 1e-6);
}

/// MODIS flown straight over a standing Earth at 6755 m/s, as in the notes.
ImageGeometry modis_line(const Sensor& modis) {
    const CameraGroup& group = modis.group("1km");
    return {.sensor = &modis,
            .group = &group,
            .scan = resolved_scan(modis, group, "", 705e3, 6755.0),
            .path = straight_flight({.position = {0.0, 0.0, 705e3}}, 6755.0),
            .samples = 1354,
            .lines = 20};
}

gis::Geodetic ground(const ImageGeometry& image, int sample, int line) {
    const auto p = scan_position_of(image, sample, line);
    return intersect_height(sightline(image, p.scan, p.u, p.v).ray, 0.0);
}

TEST(ImageGeometry, TheBowTieComesFromTheGeometry) {
    const Sensor modis = load_sensor("modis-terra");
    const ImageGeometry image = modis_line(modis);
    // Ten detectors of about 1 km; scans advance by 9978 m below the satellite (6755 m/s * 1.4771 s).
    const double advance_m = ground_distance_m(ground(image, 677, 4), ground(image, 677, 14));
    EXPECT_NEAR(advance_m, 9978.0, 2.0);
    EXPECT_NEAR(ground_distance_m(ground(image, 677, 0), ground(image, 677, 9)) / 9.0, 1000.0, 1.0);
    EXPECT_GT(ground(image, 677, 10).lat_deg, ground(image, 677, 9).lat_deg);  // no overlap below the satellite
    // At the edge a scan is 20.05 km long, half of which the next one sees again (50.1 % of the line's advance).
    const double length_m = ground_distance_m(ground(image, 1353, 0), ground(image, 1353, 9)) / 0.9;
    EXPECT_NEAR(length_m, 20050.0, 60.0);
    EXPECT_LT(ground(image, 1353, 10).lat_deg, ground(image, 1353, 9).lat_deg);
    const double advance_at_edge_m = ground_distance_m(ground(image, 1353, 4), ground(image, 1353, 14));
    EXPECT_NEAR(1.0 - advance_at_edge_m / length_m, 0.501, 0.015);
    // The satellite moves 3.05 km during a sweep.
    const double sweep_s = pixel_time_s(image, 1353, 5) - pixel_time_s(image, 0, 5);
    EXPECT_NEAR(sweep_s * 6755.0, 3050.0, 10.0);
    EXPECT_GT(ground(image, 1353, 4).lat_deg, ground(image, 677, 4).lat_deg);
}

TEST(ImageGeometry, RollIsCompensatedUpToItsLimit) {
    const Sensor phoenix = load_sensor("phoenix");
    const CameraGroup& group = phoenix.group("all");
    ImageGeometry image{.sensor = &phoenix, .group = &group, .scan = group.scan};
    image.path = standing({.position = {44.0, -115.0, 4500.0}, .heading_rad = 0.5 * kPi, .roll_rad = 0.05});
    EXPECT_NEAR(sightline(image, 0, 498.5, 0.5).pose.roll_rad, 0.0, 1e-15);
    image.scan.roll_compensation_rad = 0.03;
    EXPECT_NEAR(sightline(image, 0, 498.5, 0.5).pose.roll_rad, 0.02, 1e-15);
}

TEST(ImageGeometry, CropsToTheSceneItSees) {
    const Sensor modis = load_sensor("modis-aqua");
    const CameraGroup& group = modis.group("1km");
    const gis::Geodetic target{38.0, -120.0, 500.0};
    ImageGeometry image{.sensor = &modis, .group = &group};
    image.scan = resolved_scan(modis, group, "", 705e3, 6755.0);
    const double sigma = 30.0 * kDegree_rad;
    image.path = orbit_pass(*modis.orbit, true, target, mirror_direction(sigma, 0.0));
    std::vector<gis::Geodetic> corners;
    for (const double azimuth_deg : {45.0, 135.0, 225.0, 315.0})
        corners.push_back(gis::move_along_geodesic(target, azimuth_deg, 14142.0));  // a square of 20 km
    crop_to(image, corners, 2, false, std::nullopt);
    // Position of 30 deg: from right to left, steps of 1.41793 mrad.
    const double middle = 677.0 - sigma / 1.41793e-3;
    EXPECT_NEAR(image.first_sample + 0.5 * image.samples, middle, 1.5);
    EXPECT_NEAR(image.samples, 20.0 / 1.414 + 4, 6);  // pixels of 1.41 km, the square turned by 10 deg
    EXPECT_EQ(image.lines % 10, 0);
    EXPECT_GE(image.lines, 30);
    EXPECT_LE(image.lines, 60);
    crop_to(image, corners, 2, true, 25);
    EXPECT_EQ(image.samples, 1354);
    EXPECT_EQ(image.lines, 25);
    image.path = orbit_pass(*modis.orbit, true, {38.0, -150.0, 0.0}, {0, 0, 1});
    EXPECT_THROW(crop_to(image, corners, 2, false, std::nullopt), Error);
}

TEST(ImageGeometry, CropsALowFlightToAWideScene) {
    // Corners 9 km to the sides of a scanner 3 km above the ground lie outside its 120 deg; the lines between them count.
    const Sensor phoenix = load_sensor("phoenix");
    const CameraGroup& group = phoenix.group("all");
    ImageGeometry image{.sensor = &phoenix, .group = &group};
    image.scan = resolved_scan(phoenix, group, "", 3000.0, 103.0);
    image.path = straight_flight({.position = {46.0, -114.0, 3000.0}, .heading_rad = 0.0}, 103.0);
    std::vector<gis::Geodetic> corners;
    for (const double azimuth_deg : {45.0, 135.0, 225.0, 315.0})
        corners.push_back(gis::move_along_geodesic({46.0, -114.0, 0.0}, azimuth_deg, 12728.0));
    crop_to(image, corners, 2, false, std::nullopt);
    EXPECT_EQ(image.samples, 997);
    EXPECT_NEAR(image.lines, 18000.0 / (103.0 / 20.0), 20.0);
}

struct Case {
    const char *name, *sensor, *group, *view;
    double speed_m_s, height_m, sigma_deg;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }
class EveryScan : public testing::TestWithParam<Case> {};

TEST_P(EveryScan, ChordsAreInterpolatedToAMillimetreOrAHundredThousandthOfAPixel) {
    const Case& c = GetParam();
    const Sensor sensor = load_sensor(c.sensor);
    const CameraGroup& group = sensor.group(c.group);
    const gis::Geodetic target{44.0, -115.0, 1500.0};
    ImageGeometry image{.sensor = &sensor, .group = &group};
    const Pose overhead{.position = {44.0, -115.0, c.height_m}, .heading_rad = 1.0, .pitch_rad = 0.02};
    image.scan = resolved_scan(sensor, group, c.view, c.height_m, c.speed_m_s);
    if (!sensor.orbit)
        image.path = straight_flight(overhead, c.speed_m_s);
    else if (sensor.orbit->geostationary_longitude_deg)
        image.path = geostationary(*sensor.orbit);
    else
        image.path =
            orbit_pass(*sensor.orbit, false, target,
                       image.scan.kind == ScanLaw::Kind::Cone ? scan_direction(image.scan, 0.5 * image.scan.positions, 0.5)
                                                              : mirror_direction(c.sigma_deg * kDegree_rad, 0.0));
    std::vector<gis::Geodetic> corners;
    for (const double azimuth_deg : {30.0, 120.0, 210.0, 300.0})
        corners.push_back(gis::move_along_geodesic(target, azimuth_deg, 3000.0));
    crop_to(image, corners, 2, false, std::nullopt);
    const gis::MapProjection map("EPSG:32611");
    const auto centre = map.to_map(44.0, -115.0);
    const Vec3 origin{std::round(centre[0]), std::round(centre[1]), 1000.0};
    constexpr double kBottom_m = 900.0, kTop_m = 2500.0;
    const ImageChords chords(image, map, origin, kBottom_m, kTop_m);
    double worst = 0.0, farthest_m = 0.0;
    for (std::uint64_t i = 0; i < 400; ++i) {
        const int line = static_cast<int>(image.lines * uniform01({}, i, 0)),
                  sample = static_cast<int>(image.samples * uniform01({}, i, 1));
        const auto p =
            scan_position_of(image, sample, line, 3.0 * uniform01({}, i, 2) - 1.5, 3.0 * uniform01({}, i, 3) - 1.5);
        const auto ends = chords.scan(p.scan).ends(p.u, p.v);
        const auto ray = sightline(image, p.scan, p.u, p.v).ray;
        const auto next = sightline(image, p.scan, p.u, p.v + 1.0).ray;
        const auto bottom = intersect_height(ray, kBottom_m), top = intersect_height(ray, kTop_m);
        const auto xy = map.to_map(bottom.lat_deg, bottom.lon_deg), top_xy = map.to_map(top.lat_deg, top.lon_deg);
        const double pixel_m = ground_distance_m(intersect_height(next, kBottom_m), bottom);
        const double error_m =
            std::max(std::hypot(ends.bottom_m.x + origin.x - xy[0], ends.bottom_m.y + origin.y - xy[1]),
                     std::hypot(ends.top_m.x + origin.x - top_xy[0], ends.top_m.y + origin.y - top_xy[1]));
        worst = std::max(worst, error_m / std::max(1e-3, 1e-5 * pixel_m));
        farthest_m = std::max(farthest_m, std::hypot(ends.bottom_m.x, ends.bottom_m.y));
    }
    EXPECT_LT(worst, 1.0);
    EXPECT_GT(farthest_m, 1000.0);  // the image looks at the scene, not at a point of it
}
INSTANTIATE_TEST_SUITE_P(Instruments, EveryScan,
                         testing::Values(Case{"aviris", "aviris-classic", "all", "", 205, 21500, 0},
                                         Case{"phoenix", "phoenix", "all", "", 103, 4500, 0},
                                         Case{"aviris_ng", "aviris-ng", "all", "", 120, 6500, 0},
                                         Case{"modis_edge", "modis-terra", "1km", "", 6755, 705e3, -50},
                                         Case{"viirs", "viirs-snpp", "i", "", 6581, 829e3, 31.72},
                                         Case{"landsat", "landsat5-tm", "30m", "", 6755, 705e3, 3},
                                         Case{"oli", "landsat8-oli-tirs", "30m", "", 6755, 705e3, 2},
                                         Case{"hsrs", "bird-hsrs", "ir", "", 6950, 572e3, 5},
                                         Case{"ols", "dmsp-ols", "fine", "", 6576, 833e3, 40},
                                         Case{"atsr", "atsr2", "1km", "forward", 6650, 785e3, 0},
                                         Case{"abi", "abi-goes16", "500m", "", 1, 35786023, 0}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace pyroscene::sensors
