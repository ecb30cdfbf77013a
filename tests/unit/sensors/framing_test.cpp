#include "sensors/framing.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/constants.h"
#include "base/error.h"

namespace pyroscene::sensors {
namespace {

constexpr double kEarthRadius_m = 6378137.0;

Pose pose_deg(gis::Geodetic at, double heading_deg, double pitch_deg, double roll_deg) {
    return {.position = at,
            .heading_rad = heading_deg * kDegree_rad,
            .pitch_rad = pitch_deg * kDegree_rad,
            .roll_rad = roll_deg * kDegree_rad};
}

/// Checks a hit against a worked value: 0.02 m on the ground (the table gives 1e-7 deg), range 2 mm, angle 1e-5 deg.
void expect_hit(const EcefRay& ray, double ground_h_m, double lat_deg, double lon_deg, double slant_m,
                double view_zenith_deg) {
    const gis::Geodetic hit = intersect_height(ray, ground_h_m);
    EXPECT_NEAR((hit.lat_deg - lat_deg) * kDegree_rad * kEarthRadius_m, 0.0, 0.02);
    EXPECT_NEAR((hit.lon_deg - lon_deg) * kDegree_rad * kEarthRadius_m * std::cos(lat_deg * kDegree_rad), 0.0, 0.02);
    EXPECT_NEAR(hit.h_m, ground_h_m, 1e-3);
    const LookAngles look = look_angles(hit, ray.origin_m);
    EXPECT_NEAR(look.range_m, slant_m, 2e-3);
    EXPECT_NEAR(look.zenith_rad / kDegree_rad, view_zenith_deg, 1e-5);
}

// Worked rays of the sensor geometry notes (section 6), computed with an independent program on WGS 84. The notes count
// pixel centres at integers.
TEST(PixelRay, WorkedWaspRays) {
    const Sensor wasp = load_sensor("wasp");
    const CameraGroup& ir = wasp.group("ir");
    const gis::Geodetic at{43.0, -88.0, 3300.0};
    expect_hit(pixel_ray(wasp, ir, pose_deg(at, 0, 0, 0), 0.5, 0.5), 300.0, 43.0068990, -88.0117561, 3241.461, 22.26035);
    const Pose tilted = pose_deg(at, 45, 2, -5);
    expect_hit(pixel_ray(wasp, ir, tilted, 320.0, 256.0), 300.0, 42.9989952, -87.9968143, 3013.301, 5.38676);
    expect_hit(pixel_ray(wasp, ir, tilted, 639.5, 511.5), 300.0, 42.9877415, -87.9951027, 3318.917, 25.32961);
}

/// Line of sight of a mirror scanner: angles in the body frame, attitude heading and roll (section 2.3 of the notes).
EcefRay scanner_ray(const gis::Geodetic& at, double heading_deg, double roll_deg, double sigma_deg, double tau_deg) {
    const double sigma = sigma_deg * kDegree_rad, tau = tau_deg * kDegree_rad, roll = roll_deg * kDegree_rad;
    const Vec3 body{std::sin(tau), std::cos(tau) * std::sin(sigma), std::cos(tau) * std::cos(sigma)};
    const double right = std::cos(roll) * body.y - std::sin(roll) * body.z,
                 down = std::sin(roll) * body.y + std::cos(roll) * body.z;
    const double c = std::cos(heading_deg * kDegree_rad), s = std::sin(heading_deg * kDegree_rad);
    const gis::LocalAxes axes = gis::local_axes(at.lat_deg, at.lon_deg);
    return {gis::ecef_from_geodetic(at),
            (c * body.x - s * right) * axes.north + (s * body.x + c * right) * axes.east - down * axes.up};
}

TEST(IntersectHeight, WorkedScannerRays) {
    const gis::Geodetic modis{40.0, -105.0, 705000.0};
    expect_hit(scanner_ray(modis, 190, 0, 54.9594, 0.0), 0.0, 41.0181859, -118.6599163, 1411509.945, 65.38407);
    expect_hit(scanner_ray(modis, 190, 0, -54.9594, 0.36557), 0.0, 37.3649192, -92.0595297, 1411610.598, 65.38920);
    expect_hit(scanner_ray(modis, 190, 0, 30.0, -0.36557), 0.0, 40.5963402, -109.8209939, 829656.033, 33.72648);
    expect_hit(scanner_ray({38.0, -120.0, 21500.0}, 270, 0, -16.84840, 0), 1500.0, 37.9454373, -120.0, 20900.017, 16.90296);
    expect_hit(scanner_ray({44.0, -115.0, 4500.0}, 90, 3, 59.91993, 0), 1500.0, 43.9585376, -115.0, 5499.467, 56.96139);
}

TEST(IntersectHeight, MissesGiveNaN) {
    const gis::Geodetic at{43.0, -88.0, 3000.0};
    const gis::LocalAxes axes = gis::local_axes(at.lat_deg, at.lon_deg);
    const Vec3 origin = gis::ecef_from_geodetic(at);
    EXPECT_TRUE(std::isnan(intersect_height({origin, axes.up}, 0.0).h_m));
    EXPECT_TRUE(std::isnan(intersect_height({origin, axes.north}, 0.0).h_m));    // horizontal, over the horizon
    EXPECT_TRUE(std::isnan(intersect_height({origin, -axes.up}, 3001.0).h_m));   // starts below the surface
    EXPECT_NEAR(distance_to_height_m({origin, -axes.up}, 500.0), 2500.0, 1e-6);  // along the normal
    // Dip of the horizon on a sphere: cos(dip) = R / (R + h), 1.76 deg for 3 km. A little steeper meets the ground.
    const double steeper = 1.9 * kDegree_rad, flatter = 1.6 * kDegree_rad;
    EXPECT_FALSE(
        std::isnan(intersect_height({origin, std::cos(steeper) * axes.north - std::sin(steeper) * axes.up}, 0.0).h_m));
    EXPECT_TRUE(
        std::isnan(intersect_height({origin, std::cos(flatter) * axes.north - std::sin(flatter) * axes.up}, 0.0).h_m));
}

TEST(LookAngles, PointBackToTheSensor) {
    const gis::Geodetic ground{-33.0, 151.0, 100.0};
    const gis::LocalAxes axes = gis::local_axes(ground.lat_deg, ground.lon_deg);
    const double azimuth = 250.0 * kDegree_rad, zenith = 35.0 * kDegree_rad;
    const Vec3 view =
        std::sin(zenith) * (std::sin(azimuth) * axes.east + std::cos(azimuth) * axes.north) + std::cos(zenith) * axes.up;
    const LookAngles look = look_angles(ground, gis::ecef_from_geodetic(ground) + 7000.0 * view);
    EXPECT_NEAR(look.zenith_rad, zenith, 1e-9);
    EXPECT_NEAR(look.azimuth_rad, azimuth, 1e-9);
    EXPECT_NEAR(look.range_m, 7000.0, 1e-6);
}

/// North, east and down parts of a ray's direction.
Vec3 in_ned(const EcefRay& ray, const gis::Geodetic& at) {
    const gis::LocalAxes axes = gis::local_axes(at.lat_deg, at.lon_deg);
    return {dot(ray.direction, axes.north), dot(ray.direction, axes.east), -dot(ray.direction, axes.up)};
}

TEST(PixelRay, AttitudeHasTheSignsOfTheBodyFrame) {
    const Sensor wasp = load_sensor("wasp");
    const CameraGroup& ir = wasp.group("ir");
    const gis::Geodetic at{10.0, 20.0, 2000.0};
    const auto centre = [&](double heading, double pitch, double roll) {
        return in_ned(pixel_ray(wasp, ir, pose_deg(at, heading, pitch, roll), 320.0, 256.0), at);
    };
    EXPECT_NEAR(centre(0, 10, 0).x, std::sin(10.0 * kDegree_rad), 1e-12);   // nose up looks ahead, north
    EXPECT_NEAR(centre(90, 10, 0).y, std::sin(10.0 * kDegree_rad), 1e-12);  // heading east
    EXPECT_NEAR(centre(0, 0, 10).y, -std::sin(10.0 * kDegree_rad), 1e-12);  // right wing down looks left, west
    const Vec3 right = in_ned(pixel_ray(wasp, ir, pose_deg(at, 0, 0, 0), 640.0, 256.0), at);
    EXPECT_NEAR(right.y / right.z, 320.0 * 0.001, 1e-12);  // heading north: samples grow to the east,
    const Vec3 lower = in_ned(pixel_ray(wasp, ir, pose_deg(at, 0, 0, 0), 320.0, 512.0), at);
    EXPECT_NEAR(lower.x / lower.z, -256.0 * 0.001, 1e-12);  // lines to the south
}

TEST(PixelRay, BoresightTurnsTheCameraInsideTheBody) {
    Sensor wasp = load_sensor("wasp");
    const gis::Geodetic at{10.0, 20.0, 2000.0};
    // The same attitude, once as attitude of the body and once as misalignment of the camera in a level body.
    const EcefRay flown = pixel_ray(wasp, wasp.group("ir"), pose_deg(at, 3, 2, 1), 100.0, 50.0);
    wasp.boresight_offset_rad = {1 * kDegree_rad, 2 * kDegree_rad, 3 * kDegree_rad};
    const EcefRay mounted = pixel_ray(wasp, wasp.group("ir"), pose_deg(at, 0, 0, 0), 100.0, 50.0);
    EXPECT_NEAR(length(flown.direction - mounted.direction), 0.0, 1e-14);
    // Misalignment is applied first, in the camera; the heading of the body turns the result.
    const Vec3 turned = in_ned(pixel_ray(wasp, wasp.group("ir"), pose_deg(at, 90, 0, 0), 100.0, 50.0), at);
    const Vec3 straight = in_ned(mounted, at);
    EXPECT_NEAR(turned.x, -straight.y, 1e-14);
    EXPECT_NEAR(turned.y, straight.x, 1e-14);
}

TEST(PixelRay, InvertsBrownDistortion) {
    Sensor camera = load_sensor("wasp");
    CameraGroup ir = camera.group("ir");
    ir.radial = {-0.12, 0.03, -0.004};
    ir.tangential = {2e-4, -3e-4};
    const gis::Geodetic at{0.0, 0.0, 1000.0};
    for (const auto& [x, y] : {std::pair{0.2, 0.1}, std::pair{-0.31, 0.25}, std::pair{0.0, -0.2}}) {
        // Brown's model forwards, from the ideal direction to the pixel.
        const double r2 = x * x + y * y, radial = 1.0 + r2 * (-0.12 + r2 * (0.03 - 0.004 * r2));
        const double xd = x * radial + 2.0 * 2e-4 * x * y - 3e-4 * (r2 + 2.0 * x * x);
        const double yd = y * radial + 2e-4 * (r2 + 2.0 * y * y) - 2.0 * 3e-4 * x * y;
        const Vec3 ned = in_ned(pixel_ray(camera, ir, pose_deg(at, 0, 0, 0), 320.0 + 1000.0 * xd, 256.0 + 1000.0 * yd), at);
        EXPECT_NEAR(ned.y / ned.z, x, 1e-12);
        EXPECT_NEAR(ned.x / ned.z, -y, 1e-12);
    }
    ir.radial = {-5.0, 0.0, 0.0};  // folds the image inside the frame
    EXPECT_THROW(static_cast<void>(pixel_ray(camera, ir, pose_deg(at, 0, 0, 0), 0.5, 0.5)), Error);
}

TEST(PixelRay, AnOutlineWithoutFocalLengthHasNoRays) {
    const Sensor wasp = load_sensor("wasp");
    EXPECT_THROW(static_cast<void>(pixel_ray(wasp, CameraGroup{.id = "all"}, pose_deg({0, 0, 1000}, 0, 0, 0), 1.0, 1.0)),
                 Error);
}

}  // namespace
}  // namespace pyroscene::sensors
