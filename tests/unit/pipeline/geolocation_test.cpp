#include "pipeline/geolocation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"

namespace pyroscene::pipeline {
namespace {

// A satellite's swath reaches 12 degrees of latitude and, at 60 degrees north, 25 of longitude from the scene.
TEST(LocalSun, IsTheSunOfEveryPixelOfASwath) {
    constexpr double kTolerance_deg = 0.003;
    const gis::Geodetic centres[] = {{46.7, -114.1, 0.0}, {60.0, 179.9, 0.0}, {-33.0, 18.0, 0.0}, {20.0, -156.0, 0.0}};
    for (const auto& centre : centres)
        for (const double unix_s : {1500156000.0, 1500121000.0, 1481900000.0}) {  // July by day and night, December
            const LocalSun sun(unix_s, centre);
            for (const double dlat : {-12.0, -0.5, -0.09, 0.0, 0.05, 0.3, 12.0})
                for (const double dlon : {-25.0, -1.0, -0.08, 0.0, 0.09, 0.4, 25.0}) {
                    double lon = centre.lon_deg + dlon;
                    if (lon > 180.0) lon -= 360.0;  // as geolocation has it beyond the date line
                    const auto told = sun.at(centre.lat_deg + dlat, lon),
                               exact = radiometry::sun_position(unix_s, centre.lat_deg + dlat, lon);
                    EXPECT_NEAR(told.zenith_rad, exact.zenith_rad, kTolerance_deg * kDegree_rad);
                    const double turn_rad = std::remainder(told.azimuth_rad - exact.azimuth_rad, 2.0 * kPi);
                    EXPECT_NEAR(turn_rad * std::sin(exact.zenith_rad), 0.0, kTolerance_deg * kDegree_rad)
                        << centre.lat_deg << " " << dlat << " " << dlon;
                }
        }
}

}  // namespace
}  // namespace pyroscene::pipeline
