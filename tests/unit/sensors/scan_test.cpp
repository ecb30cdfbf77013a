#include "sensors/scan.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "base/constants.h"
#include "base/error.h"
#include "gis/geodesy.h"
#include "sensors/image_geometry.h"

namespace pyroscene::sensors {
namespace {

Pose level(gis::Geodetic at, double heading_deg, double roll_deg = 0.0) {
    return {.position = at, .heading_rad = heading_deg * kDegree_rad, .roll_rad = roll_deg * kDegree_rad};
}

double ground_distance_m(const gis::Geodetic& a, const gis::Geodetic& b) {
    return length(gis::ecef_from_geodetic(a) - gis::ecef_from_geodetic(b));
}

/// The middle of a pixel and its edges on the ground at height 0, as seen over the equator on the way north: the line of sight
/// then sweeps along a circle of 6378137 m, the sphere of the footprint tables (docs/scan-geometry.md).
struct Footprint {
    double along_m = 0.0, across_m = 0.0, zenith_deg = 0.0, slant_m = 0.0, from_nadir_m = 0.0;
};
Footprint footprint(const ScanLaw& law, double height_m, double u, double pixel_positions, double across_rad = 0.0) {
    const Sensor aligned;
    const Pose pose = level({0.0, 0.0, height_m}, 0.0);
    const double half = 0.5 * (across_rad > 0.0 ? across_rad / law.step_across_rad : pixel_positions);
    const double v = 0.5 * law.lines_per_scan;
    const auto hit = [&](double at_u, double at_v) {
        return intersect_height(body_ray(aligned, pose, scan_direction(law, at_u, at_v)), 0.0);
    };
    const auto centre = hit(u, v);
    const auto look = look_angles(centre, gis::ecef_from_geodetic(pose.position));
    return {.along_m = ground_distance_m(hit(u, v - 0.5), hit(u, v + 0.5)),
            .across_m = ground_distance_m(hit(u - half, v), hit(u + half, v)),
            .zenith_deg = look.zenith_rad / kDegree_rad,
            .slant_m = look.range_m,
            .from_nadir_m = std::abs(centre.lon_deg) * kDegree_rad * 6378137.0};
}

double position_at_deg(const ScanLaw& law, double sigma_deg) {
    return 0.5 * law.positions + sigma_deg * kDegree_rad / law.step_across_rad;
}

// Section 5 of the sensor-geometry notes, computed there on a sphere.
struct Row {
    const char *sensor, *group;
    double sigma_deg, positions, zenith_deg, slant_km, along_km, across_km;
};
void PrintTo(const Row& row, std::ostream* out) { *out << row.sensor << " at " << row.sigma_deg << " deg"; }
class FootprintTable : public testing::TestWithParam<Row> {};

TEST_P(FootprintTable, GrowsOffNadir) {
    const Row& row = GetParam();
    const Sensor sensor = load_sensor(row.sensor);
    const ScanLaw& law = sensor.group(row.group).scan;
    const auto f = footprint(law, sensor.orbit->height_m, position_at_deg(law, row.sigma_deg), row.positions);
    EXPECT_NEAR(f.zenith_deg, row.zenith_deg, 0.01);
    EXPECT_NEAR(f.slant_m / 1e3, row.slant_km, 0.06);
    EXPECT_NEAR(f.along_m / 1e3, row.along_km, 0.0015);
    EXPECT_NEAR(f.across_m / 1e3, row.across_km, 0.0025);
}
INSTANTIATE_TEST_SUITE_P(Notes, FootprintTable,
                         testing::Values(Row{"modis-terra", "1km", 0, 1, 0, 705.0, 1.000, 1.000},
                                         Row{"modis-terra", "1km", 15, 1, 16.70, 732.8, 1.039, 1.085},
                                         Row{"modis-terra", "1km", 30, 1, 33.73, 829.7, 1.176, 1.414},
                                         Row{"modis-terra", "1km", 45, 1, 51.75, 1059.5, 1.502, 2.426},
                                         Row{"modis-terra", "1km", 55, 1, 65.46, 1414.0, 2.005, 4.828},
                                         Row{"viirs-snpp", "m", 0, 3, 0, 829.0, 0.742, 0.775},
                                         Row{"viirs-snpp", "m", 31.72, 3, 36.45, 1000.1, 0.895, 1.162},
                                         Row{"viirs-snpp", "m", 31.72, 2, 36.45, 1000.1, 0.895, 0.775},
                                         Row{"viirs-snpp", "m", 44.86, 2, 52.85, 1256.9, 1.125, 1.297},
                                         Row{"viirs-snpp", "m", 44.86, 1, 52.85, 1256.9, 1.125, 0.649},
                                         Row{"viirs-snpp", "m", 56.28, 1, 70.03, 1822.6, 1.631, 1.663}));

TEST(ScanLaw, SwathsOfSatellites) {
    // km: section 5; both ends of the line at its outer edge.
    for (const auto& [id, group, swath_km, tolerance_km] :
         {std::tuple{"modis-terra", "1km", 2330.0, 1.0}, std::tuple{"viirs-snpp", "m", 3061.0, 4.0},
          std::tuple{"landsat5-tm", "30m", 191.0, 0.5}, std::tuple{"bird-hsrs", "ir", 189.4, 0.3}}) {
        SCOPED_TRACE(id);
        const Sensor sensor = load_sensor(id);
        const ScanLaw& law = sensor.group(group).scan;
        const auto right = footprint(law, sensor.orbit->height_m, law.positions, 1),
                   left = footprint(law, sensor.orbit->height_m, 0, 1);
        EXPECT_NEAR((right.from_nadir_m + left.from_nadir_m) / 1e3, swath_km, tolerance_km);
    }
    const Sensor avhrr = load_sensor("avhrr3-noaa18");
    const ScanLaw& law = avhrr.group("lac").scan;
    const auto edge = footprint(law, 833e3, position_at_deg(law, 55.37), 1, 1.3e-3);
    EXPECT_NEAR(edge.along_m, 2286.0, 2.0);
    EXPECT_NEAR(edge.across_m, 6232.0, 10.0);
    EXPECT_NEAR(2.0 * edge.from_nadir_m, 2919e3, 1e3);
    EXPECT_NEAR(law.positions * law.step_across_rad / kDegree_rad, 2.0 * 55.39, 0.05);
}

TEST(ScanLaw, AirborneScannersOverFlatGround) {
    const Sensor aviris = load_sensor("aviris-classic");
    const ScanLaw& whisk = aviris.group("all").scan;
    EXPECT_EQ(whisk.samples(), 677);
    const auto nadir = footprint(whisk, 20e3, 338.5, 1, 1e-3);
    EXPECT_NEAR(nadir.along_m, 20.0, 0.01);
    EXPECT_NEAR(nadir.across_m, 20.0, 0.01);
    EXPECT_NEAR(footprint(whisk, 20e3, 338.5, 1).across_m, 17.4, 0.01);                      // sample spacing
    EXPECT_NEAR(2.0 * footprint(whisk, 20e3, 0.0, 1).from_nadir_m, 12.1e3, 50.0);            // 677 samples
    EXPECT_NEAR(2.0 * footprint(whisk, 20e3, 338.5 - 307.0, 1).from_nadir_m, 10.9e3, 50.0);  // 614 samples
    EXPECT_NEAR(205.0 * resolved_scan(aviris, aviris.group("all"), "", 20e3, 205.0).period_s, 17.1, 0.05);

    const Sensor phoenix = load_sensor("phoenix");
    const ScanLaw& line = phoenix.group("all").scan;
    EXPECT_EQ(line.samples(), 997);
    EXPECT_NEAR(footprint(line, 3000.0, 498.5, 1).across_m, 6.3, 0.003);
    EXPECT_NEAR(footprint(line, 3000.0, 498.5, 1).along_m, 6.3, 0.003);
    const auto edge = footprint(line, 3000.0, position_at_deg(line, 60.0), 1);
    EXPECT_NEAR(edge.along_m, 12.6, 0.05);
    EXPECT_NEAR(edge.across_m, 25.2, 0.1);
    EXPECT_NEAR(2.0 * footprint(line, 3000.0, 0.0, 1).from_nadir_m, 10.39e3, 80.0);
    ScanLaw free = line;
    free.period_s = 0.0;
    CameraGroup group = phoenix.group("all");
    group.scan = free;
    EXPECT_NEAR(1.0 / resolved_scan(phoenix, group, "", 3000.0, 102.9).period_s, 16.3, 0.05);

    const Sensor master = load_sensor("master");  // three rates: the slowest without gaps
    EXPECT_DOUBLE_EQ(resolved_scan(master, master.group("all"), "", 20e3, 206.0).period_s, 1.0 / 6.25);
    EXPECT_DOUBLE_EQ(resolved_scan(master, master.group("all"), "", 5e3, 120.0).period_s, 1.0 / 12.5);
}

TEST(ScanLaw, StaggeredLineArray) {
    const Sensor bird = load_sensor("bird-hsrs");
    const ScanLaw& law = bird.group("ir").scan;
    EXPECT_EQ(law.samples(), 1024);
    const auto middle = footprint(law, 572e3, 512.0, 1);
    EXPECT_NEAR(middle.across_m, 185.0, 0.1);  // samples every half pixel
    EXPECT_NEAR(middle.along_m, 369.9, 0.1);
    ImageGeometry image{.sensor = &bird, .group = &bird.group("ir"), .scan = law, .samples = 1024, .lines = 10};
    // Rows 60 um apart, pixels of 30 um: two lines, one to each side.
    EXPECT_DOUBLE_EQ(scan_position_of(image, 11, 3).v - scan_position_of(image, 10, 3).v, 2.0);
    EXPECT_EQ(scan_position_of(image, 10, 3).scan, 3);
}

TEST(ScanLaw, ThematicMapperSweepsBothWays) {
    const Sensor tm = load_sensor("landsat5-tm");
    const ScanLaw& law = tm.group("30m").scan;
    EXPECT_NEAR(16 * footprint(law, 705e3, 3160.0, 1).along_m, 479.0, 1.0);  // 16 lines of 42.5 urad from 705 km
    EXPECT_NEAR(law.period_s, 0.060743 + 0.010719, 1e-9);
    // Samples are in order in every line; time is not.
    EXPECT_NEAR(scan_time_s(law, 0, 6320, 8) - scan_time_s(law, 0, 0, 8), 0.060743, 1e-6);
    EXPECT_NEAR(scan_time_s(law, 1, 6320, 8) - scan_time_s(law, 1, 0, 8), -0.060743, 1e-6);
    EXPECT_EQ(scan_pose_time_s(law, 1, 0, 8), scan_pose_time_s(law, 1, 6320, 8));  // the line corrector
    EXPECT_GT(scan_angle_rad(law, 6320), 0.0);
}

TEST(ScanLaw, ModisPaddleMirror) {
    const ScanLaw law = load_sensor("modis-terra").group("1km").scan;
    EXPECT_EQ(law.samples(), 1354);
    EXPECT_EQ(law.lines_per_scan, 10);
    EXPECT_NEAR(scan_angle_rad(law, 0.5) / kDegree_rad, 54.9594, 2e-3);  // starts at the right
    EXPECT_NEAR(scan_angle_rad(law, 1353.5) / kDegree_rad, -54.9594, 2e-3);
    // The last line of a scan looks ahead, tau = 4.5 detectors.
    EXPECT_NEAR(std::asin(scan_direction(law, 677.0, 9.5).x) / kDegree_rad, 0.36557, 1e-4);
    // 20.3 turns a minute, two faces: 110 deg of view in 0.4513 s of a scan of 1.4771 s.
    EXPECT_NEAR(scan_time_s(law, 0, 1354, 5) - scan_time_s(law, 0, 0, 5), 0.4513, 1e-4);
    EXPECT_NEAR(scan_time_s(law, 7, 677, 5), 7 * 1.4771, 1e-9);
    const ScanLaw fine = load_sensor("modis-terra").group("250m").scan;  // the same angles in quarters
    EXPECT_EQ(fine.samples(), 5416);
    EXPECT_EQ(fine.lines_per_scan, 40);
    EXPECT_NEAR(scan_angle_rad(fine, 0.0), scan_angle_rad(law, 0.0), 1e-9);
    EXPECT_NEAR(scan_direction(fine, 5416, 0).x, scan_direction(law, 1354, 0).x, 1e-5);
}

TEST(ScanLaw, ViirsZonesAndDeletedRows) {
    const ScanLaw law = load_sensor("viirs-snpp").group("m").scan;
    EXPECT_EQ(law.samples(), 3200);
    EXPECT_EQ(law.positions, 6304);
    const auto angle_deg = [&](double sample) { return scan_angle_rad(law, scan_position(law, sample)) / kDegree_rad; };
    EXPECT_NEAR(angle_deg(1600.0), 0.0, 1e-12);
    EXPECT_NEAR(angle_deg(1600.0 + 592.0), 31.72, 0.01);
    EXPECT_NEAR(angle_deg(1600.0 + 592.0 + 368.0), 44.86, 0.01);
    EXPECT_NEAR(angle_deg(3200.0), 56.28, 0.01);
    EXPECT_NEAR(angle_deg(0.0), -56.28, 0.01);
    EXPECT_EQ(scan_pixel_width(law, 1600), 3.0);
    EXPECT_EQ(scan_pixel_width(law, 1007), 2.0);
    EXPECT_EQ(scan_pixel_width(law, 639), 1.0);
    EXPECT_FALSE(scan_deletes(law, 1600, 0));
    EXPECT_TRUE(scan_deletes(law, 700, 0));
    EXPECT_FALSE(scan_deletes(law, 700, 1));
    EXPECT_TRUE(scan_deletes(law, 10, 1));
    EXPECT_TRUE(scan_deletes(law, 3190, 14));
    EXPECT_FALSE(scan_deletes(law, 3190, 13));
    EXPECT_TRUE(scan_deletes(load_sensor("viirs-snpp").group("i").scan, 20, 3));
}

TEST(ScanLaw, ARotatingMirrorTurnsTheFocalPlane) {
    ScanLaw law{.kind = ScanLaw::Kind::Mirror,
                .positions = 100,
                .lines_per_scan = 3,
                .step_across_rad = 0.02,
                .step_along_rad = 0.01,
                .image_rotates = true};
    // Section 2.3: tau' = tau cos s, eta' = -tau sin s.
    const double s = 0.02 * 30.0, tau = 0.01;
    const Vec3 expected = mirror_direction(s - tau * std::sin(s), tau * std::cos(s));
    EXPECT_NEAR(length(scan_direction(law, 80.0, 2.5) - expected), 0.0, 1e-15);
    law.image_rotates = false;
    EXPECT_NEAR(length(scan_direction(law, 80.0, 2.5) - mirror_direction(s, tau)), 0.0, 1e-15);
    EXPECT_NEAR(mirror_direction(s, tau).x, std::sin(tau), 1e-15);
}

TEST(ScanLaw, OlsSwingsLikeASineAndSamplesEqualDistances) {
    const Sensor ols = load_sensor("dmsp-ols");
    const ScanLaw& law = ols.group("fine").scan;
    for (const double k : {0.0, 500.0, 2000.0, 2900.0})
        EXPECT_NEAR(footprint(law, 833e3, 0.5 * law.positions + k, 1).from_nadir_m, 500.0 * k, 0.01);
    // sigma = A sin(2 pi f t), f = 5.94 Hz
    const double u = 0.5 * law.positions + 2000.0, t = scan_time_s(law, 0, u, 0.5);
    EXPECT_NEAR(scan_angle_rad(law, u), 56.25 * kDegree_rad * std::sin(2.0 * kPi * 5.94 * t), 1e-12);
    EXPECT_NEAR(scan_time_s(law, 1, u, 0.5), 1.0 / 11.88 - t, 1e-12);
    EXPECT_LE(scan_angle_rad(law, law.positions), 56.25 * kDegree_rad);
}

TEST(ScanLaw, ConesPassThroughNadirAndLookAheadOrBack) {
    const Sensor atsr = load_sensor("atsr2");
    const auto& group = atsr.group("1km");
    ASSERT_EQ(group.views.size(), 2u);
    const ScanLaw &nadir = group.views[0].scan, &ahead = group.views[1].scan;
    EXPECT_EQ(nadir.samples(), 555);
    EXPECT_EQ(ahead.samples(), 371);
    EXPECT_NEAR(length(scan_direction(nadir, 277.5, 0.5) - Vec3{0, 0, 1}), 0.0, 1e-12);
    const Vec3 forward = scan_direction(ahead, 185.5, 0.5);
    EXPECT_NEAR(std::atan2(forward.x, forward.z) / kDegree_rad, 46.9, 1e-9);  // twice the half-angle
    EXPECT_NEAR(forward.y, 0.0, 1e-12);
    // Section 5: slant range 1244 km at the centre of the forward arc, 911 km ahead, seen under 55.09 deg, for 785 km.
    const auto hit = intersect_height(body_ray(atsr, level({0, 0, 785e3}, 90), forward), 0.0);
    const auto look = look_angles(hit, gis::ecef_from_geodetic({0, 0, 785e3}));
    EXPECT_NEAR(look.range_m, 1244.0e3, 100.0);
    EXPECT_NEAR(look.zenith_rad / kDegree_rad, 55.09, 0.01);
    EXPECT_NEAR(hit.lon_deg * kDegree_rad * 6378137.0, 911e3, 1e3);
    // Samples run to the right in both, later lines look farther ahead.
    EXPECT_GT(scan_direction(nadir, 278.5, 0.5).y, 0.0);
    EXPECT_GT(scan_direction(ahead, 186.5, 0.5).y, 0.0);
    EXPECT_GT(scan_direction(nadir, 277.5, 1.0).x, 0.0);
    EXPECT_GT(scan_direction(ahead, 185.5, 1.0).x, forward.x);
    const auto slstr = load_sensor("slstr-s3a");
    const ScanLaw& back = slstr.group("1km").views[1].scan;
    EXPECT_LT(scan_direction(back, 0.5 * back.positions, 1.0).x, -0.7);
    EXPECT_GT(scan_direction(back, back.positions, 1.0).y, 0.0);
}

TEST(ScanLaw, FixedGridsAgreeWithTheGeostationaryProjection) {
    for (const auto& [id, sweep, longitude] :
         {std::tuple{"abi-goes16", "x", -75.2}, std::tuple{"ahi-himawari8", "y", 140.7}}) {
        SCOPED_TRACE(id);
        const Sensor sensor = load_sensor(id);
        const ScanLaw& law = sensor.group("2km").scan;
        EXPECT_EQ(law.samples(), std::string(sweep) == "x" ? 5424 : 5500);
        const double height_m = sensor.orbit->height_m;
        const gis::MapProjection geos("+proj=geos +sweep=" + std::string(sweep) + " +h=" + std::to_string(height_m) +
                                      " +lon_0=" + std::to_string(longitude) + " +ellps=WGS84 +units=m +type=crs");
        const Pose pose = geostationary(*sensor.orbit).at(0.0);
        for (const auto& [dx, dy] : {std::pair{1500.5, 900.5}, std::pair{-1000.0, 1700.0}, std::pair{0.0, -2000.0}}) {
            const double u = 0.5 * law.positions + dx, v = 0.5 * law.lines_per_scan - dy;
            const auto hit = intersect_height(body_ray(sensor, pose, scan_direction(law, u, v)), 0.0);
            const auto xy = geos.to_map(hit.lat_deg, hit.lon_deg);
            EXPECT_NEAR(xy[0] / height_m / 56e-6, dx, 1e-4);
            EXPECT_NEAR(xy[1] / height_m / 56e-6, dy, 1e-4);
        }
    }
}

TEST(ScanLaw, SpinScanStepsSouth) {
    const Sensor gms = load_sensor("vissr-gms5");
    const ScanLaw& ir = gms.group("ir").scan;
    EXPECT_EQ(ir.lines_per_scan, 2500);
    EXPECT_EQ(ir.samples(), 2291);
    const Vec3 north = scan_direction(ir, 1145.5, 0.0), east = scan_direction(ir, 2291.0, 1250.0);
    EXPECT_NEAR(std::asin(north.x), 1250 * 0.14e-3, 1e-9);
    EXPECT_NEAR(std::atan2(east.y, east.z), 1145.5 * 0.0957e-3, 1e-9);
    EXPECT_NEAR(scan_time_s(ir, 0, 1145.5, 1251) - scan_time_s(ir, 0, 1145.5, 1250), 0.6, 1e-9);  // 100 turns a minute
    EXPECT_NEAR(gms.group("vis").scan.step_along_rad, 0.035e-3, 1e-9);                            // four lines a turn
}

}  // namespace
}  // namespace pyroscene::sensors
