#include "gis/geodesy.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "base/constants.h"
#include "base/error.h"

namespace pyroscene::gis {
namespace {

constexpr double kA_m = 6378137.0, kF = 1.0 / 298.257223563, kE2 = kF * (2.0 - kF);

// Manual page of GeographicLib's CartConvert: 33.3 44.4 6000 -> 3816209.60 3737108.55 3485109.57.
TEST(Ecef, AgreesWithAPublishedPoint) {
    const Vec3 p = ecef_from_geodetic({.lat_deg = 33.3, .lon_deg = 44.4, .h_m = 6000.0});
    EXPECT_NEAR(p.x, 3816209.60, 0.006);
    EXPECT_NEAR(p.y, 3737108.55, 0.006);
    EXPECT_NEAR(p.z, 3485109.57, 0.006);
}

TEST(Ecef, HasTheSemiAxesOfWgs84) {
    EXPECT_DOUBLE_EQ(ecef_from_geodetic({.lat_deg = 0.0, .lon_deg = 0.0, .h_m = 0.0}).x, kA_m);
    EXPECT_NEAR(ecef_from_geodetic({.lat_deg = -90.0, .lon_deg = 0.0, .h_m = 100.0}).z, -6356752.314245 - 100.0, 1e-6);
}

TEST(Ecef, RoundTripsFromBelowGroundToOrbit) {
    for (const double lat_deg : {-89.9, -33.0, 0.0, 46.7, 90.0})
        for (const double h_m : {-100.0, 3000.0, 705000.0, 36.0e6}) {
            const Geodetic p = geodetic_from_ecef(ecef_from_geodetic({.lat_deg = lat_deg, .lon_deg = -114.1, .h_m = h_m}));
            EXPECT_NEAR(p.lat_deg, lat_deg, 1e-12);
            EXPECT_NEAR(p.h_m, h_m, 1e-7);
            if (lat_deg < 90.0) {
                EXPECT_NEAR(p.lon_deg, -114.1, 1e-12);
            }
        }
}

TEST(LocalAxes, AreTheDerivativesOfThePosition) {
    const double lat = 46.7, lon = -114.1, d = 1e-4;
    const LocalAxes axes = local_axes(lat, lon);
    const auto at = [](double a, double b, double h) { return ecef_from_geodetic({.lat_deg = a, .lon_deg = b, .h_m = h}); };
    const Vec3 east = normalized(at(lat, lon + d, 0) - at(lat, lon - d, 0)),
               north = normalized(at(lat + d, lon, 0) - at(lat - d, lon, 0));
    EXPECT_LT(length(axes.east - east), 1e-8);
    EXPECT_LT(length(axes.north - north), 1e-8);
    EXPECT_LT(length(axes.up - (at(lat, lon, 1.0) - at(lat, lon, 0.0))), 1e-8);
    EXPECT_LT(length(cross(axes.east, axes.north) - axes.up), 1e-15);
}

// One degree along the equator is a pi / 180; the quarter meridian of WGS 84 measures 10 001 965.729 m.
TEST(Geodesic, FollowsTheEquatorAndTheMeridian) {
    const Geodetic start{.lat_deg = 0.0, .lon_deg = 10.0, .h_m = 2500.0};
    const Geodetic east = move_along_geodesic(start, 90.0, kA_m * kDegree_rad);
    EXPECT_NEAR(east.lon_deg, 11.0, 1e-12);
    EXPECT_NEAR(east.lat_deg, 0.0, 1e-12);
    EXPECT_EQ(east.h_m, 2500.0);
    EXPECT_NEAR(move_along_geodesic(start, 0.0, 10001965.729).lat_deg, 90.0, 1e-8);
}

struct Place {
    double lat_deg, lon_deg;
    const char* crs;
};

// Zones after the definition of the grid, with its exceptions in Norway and Svalbard and UPS beyond 84 N and 80 S.
TEST(UtmOrUps, PicksTheZone) {
    const Place places[] = {{46.69, -114.14, "EPSG:32611"}, {43.0, -88.0, "EPSG:32616"}, {-33.87, 151.2, "EPSG:32756"},
                            {60.4, 5.3, "EPSG:32632"},      {78.2, 15.6, "EPSG:32633"},  {0.0, 179.9, "EPSG:32660"},
                            {10.0, -180.0, "EPSG:32601"},   {83.9, 100.0, "EPSG:32647"}, {84.1, 100.0, "EPSG:32661"},
                            {-79.9, 100.0, "EPSG:32747"},   {-80.1, 100.0, "EPSG:32761"}};
    for (const auto& p : places) EXPECT_EQ(utm_or_ups_crs(p.lat_deg, p.lon_deg), p.crs) << p.lat_deg << ' ' << p.lon_deg;
}

TEST(UtmOrUps, RefusesPlacesOffTheEarth) {
    EXPECT_THROW(utm_or_ups_crs(91.0, 0.0), Error);
    EXPECT_THROW(utm_or_ups_crs(std::nan(""), 0.0), Error);
}

// CN Tower, Toronto: 43 deg 38' 33.24" N, 79 deg 23' 13.7" W is 17T 630084 4833438 (Wikipedia, "Universal Transverse Mercator").
TEST(MapProjection, PlacesAKnownTower) {
    const MapProjection map("EPSG:32617");
    const auto [x, y] = map.to_map(43.0 + 38.0 / 60 + 33.24 / 3600, -(79.0 + 23.0 / 60 + 13.7 / 3600));
    EXPECT_NEAR(x, 630084.0, 0.6);
    EXPECT_NEAR(y, 4833438.0, 0.6);
}

// The meridian arc from the equator to 45 degrees is 4 984 944.378 m on WGS 84; UTM shrinks it by 0.9996.
TEST(MapProjection, SouthernZonesCountFromTenThousandKilometres) {
    const auto [x, y] = MapProjection("EPSG:32756").to_map(-45.0, 153.0);
    EXPECT_NEAR(x, 500000.0, 1e-6);
    EXPECT_NEAR(y, 1.0e7 - 0.9996 * 4984944.378, 1e-3);
}

double polar_radius_m(double colatitude_lat_deg) {
    // Snyder 1987, eqs 15-9 and 21-33, with k0 = 0.994.
    const double e = std::sqrt(kE2), s = std::sin(colatitude_lat_deg * kDegree_rad);
    const double t = std::tan(kPi / 4 - colatitude_lat_deg * kDegree_rad / 2) / std::pow((1 - e * s) / (1 + e * s), e / 2);
    return 2.0 * kA_m * 0.994 * t / std::sqrt(std::pow(1 + e, 1 + e) * std::pow(1 - e, 1 - e));
}

TEST(MapProjection, UpsHasEastingFirst) {
    const double rho = polar_radius_m(86.0);
    const MapProjection north("EPSG:32661"), south("EPSG:32761");
    EXPECT_NEAR(north.to_map(86.0, 90.0)[0], 2.0e6 + rho, 1e-3);
    EXPECT_NEAR(north.to_map(86.0, 90.0)[1], 2.0e6, 1e-3);
    EXPECT_NEAR(north.to_map(86.0, 0.0)[1], 2.0e6 - rho, 1e-3);
    EXPECT_NEAR(south.to_map(-86.0, 0.0)[1], 2.0e6 + rho, 1e-3);
    EXPECT_NEAR(south.to_map(-86.0, -90.0)[0], 2.0e6 - rho, 1e-3);
}

TEST(MapProjection, AcceptsProjStringsAndWkt) {
    const auto [x, y] = MapProjection("EPSG:32611").to_map(46.69, -114.14);
    const char* const wkt =
        "PROJCS[\"m\",GEOGCS[\"w\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563]],PRIMEM[\"Greenwich\",0],"
        "UNIT[\"degree\",0.0174532925199433]],PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"latitude_of_origin\",0],"
        "PARAMETER[\"central_meridian\",-117],PARAMETER[\"scale_factor\",0.9996],PARAMETER[\"false_easting\",500000],"
        "PARAMETER[\"false_northing\",0],UNIT[\"metre\",1]]";
    for (const char* crs : {"+proj=utm +zone=11 +datum=WGS84", "+proj=utm +zone=11 +datum=WGS84 +type=crs", wkt}) {
        EXPECT_NEAR(MapProjection(crs).to_map(46.69, -114.14)[0], x, 1e-6) << crs;
        EXPECT_NEAR(MapProjection(crs).to_map(46.69, -114.14)[1], y, 1e-6) << crs;
    }
}

TEST(MapProjection, RoundTripsNearTheZoneEdgeAndKeepsHeight) {
    const MapProjection map("EPSG:32611");
    for (const double lon_deg : {-120.0, -117.0, -114.0, -111.0})
        for (const double lat_deg : {5.0, 46.7, 83.0}) {
            const auto [x, y] = map.to_map(lat_deg, lon_deg);
            const Geodetic back = map.to_geodetic(x, y, 1234.5);
            EXPECT_NEAR(back.lat_deg, lat_deg, 1e-11);
            EXPECT_NEAR(back.lon_deg, lon_deg, 1e-11);
            EXPECT_EQ(back.h_m, 1234.5);
        }
}

TEST(MapProjection, ManyAtOnceEqualOneByOne) {
    const MapProjection map("EPSG:32616");
    std::vector<double> lon{-88.0, -87.5, -86.0}, lat{43.0, 43.1, 42.9};
    auto x = lon, y = lat;
    map.to_map(x, y);
    for (std::size_t i = 0; i < lon.size(); ++i) {
        const auto [one_x, one_y] = map.to_map(lat[i], lon[i]);
        EXPECT_EQ(x[i], one_x);
        EXPECT_EQ(y[i], one_y);
    }
    map.to_geographic(x, y);
    for (std::size_t i = 0; i < lon.size(); ++i) EXPECT_NEAR(x[i], lon[i], 1e-11);
}

TEST(MapProjection, IsNaNWithoutAnImage) {
    const MapProjection map("EPSG:32611");
    EXPECT_TRUE(std::isnan(map.to_map(0.0, -117.0 + 90.0)[0]));
    EXPECT_TRUE(std::isnan(map.to_map(std::nan(""), 0.0)[1]));
    EXPECT_TRUE(std::isnan(map.to_geodetic(1e12, 1e12).lat_deg));
    EXPECT_NEAR(map.to_map(0.0, -117.0)[0], 500000.0, 1e-6);  // and recovers
}

std::string message_for(const std::string& crs) {
    try {
        const MapProjection map(crs);
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Input);
        return e.what();
    }
    ADD_FAILURE() << crs << " was accepted";
    return {};
}

TEST(MapProjection, SaysWhatIsWrongWithACrs) {
    EXPECT_NE(message_for("EPSG:99999").find("EPSG:99999"), std::string::npos);
    EXPECT_NE(message_for("").find("not a coordinate reference system"), std::string::npos);
    EXPECT_NE(message_for("/etc/hostname").find("not a coordinate reference system"), std::string::npos);
    EXPECT_NE(message_for("EPSG:4326").find("geographic"), std::string::npos);
    EXPECT_NE(message_for("EPSG:4978").find("not projected"), std::string::npos);
    EXPECT_NE(message_for("EPSG:2227").find("0.3048006096 m; expected metres"), std::string::npos);
}

// Convergence of the transverse Mercator: tan(gamma) = tan(dlon) sin(lat) on the sphere; the ellipsoid adds
// dlon^3 sin(lat) cos(lat)^2 eta^2 (Snyder 1987; Thomas 1952), with eta = e' cos(lat).
double utm_convergence_rad(double lat_deg, double from_central_meridian_deg) {
    const double lat = lat_deg * kDegree_rad, dlon = from_central_meridian_deg * kDegree_rad;
    const double eta2 = kE2 / (1.0 - kE2) * std::pow(std::cos(lat), 2);
    return std::atan(std::tan(dlon) * std::sin(lat)) + std::pow(dlon, 3) * std::sin(lat) * std::pow(std::cos(lat), 2) * eta2;
}

TEST(Convergence, OfUtmIsPositiveEastOfTheCentralMeridianInTheNorth) {
    for (const char* crs : {"EPSG:32611", "EPSG:32711"})
        for (const double dlon : {-3.0, -0.5, 0.0, 2.9}) {
            const double lat = std::string(crs) == "EPSG:32611" ? 46.7 : -33.0;
            const MapProjection map(crs);
            const auto [x, y] = map.to_map(lat, -117.0 + dlon);
            EXPECT_NEAR(map.convergence_rad(x, y), utm_convergence_rad(lat, dlon), 2e-8) << crs << ' ' << dlon;
        }
}

TEST(Convergence, OfUpsIsTheLongitude) {
    const MapProjection north("EPSG:32661"), south("EPSG:32761");
    for (const double lon : {-100.0, 30.0, 90.0, 150.0}) {
        const auto [x, y] = north.to_map(87.0, lon);
        EXPECT_NEAR(north.convergence_rad(x, y), lon * kDegree_rad, 1e-8);
        const auto [xs, ys] = south.to_map(-87.0, lon);
        EXPECT_NEAR(south.convergence_rad(xs, ys), -lon * kDegree_rad, 1e-8);
    }
}

}  // namespace
}  // namespace pyroscene::gis
