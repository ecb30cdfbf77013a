#include "analysis/rpc.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace pyroscene::analysis {
namespace {

/// A pinhole over a plane tangent to a sphere, tilted: quotients of linear forms of east, north, up.
GroundTie seen(double lat_deg, double lon_deg, double h_m) {
    const double north = (lat_deg - 45.0) * 111.2e3, east = (lon_deg + 110.0) * 78.6e3, up = 3000.0 - h_m;
    const double along = std::cos(0.2) * north - std::sin(0.2) * up, depth = std::sin(0.2) * north + std::cos(0.2) * up;
    return {lat_deg, lon_deg, h_m, 320.0 + 1000.0 * east / depth, 256.0 - 1000.0 * along / depth};
}

std::vector<GroundTie> ties(int per_axis, double offset) {
    std::vector<GroundTie> out;
    for (int i = 0; i < per_axis; ++i)
        for (int j = 0; j < per_axis; ++j)
            for (int k = 0; k < per_axis; ++k)
                out.push_back(seen(45.0 + 0.01 * ((i + offset) / per_axis - 0.5),
                                   -110.0 + 0.014 * ((j + offset) / per_axis - 0.5), 200.0 * (k + offset)));
    return out;
}

TEST(RationalCamera, ReproducesAPinholeBetweenItsTies) {
    const auto camera = fit_rational_camera(ties(7, 0.0));
    EXPECT_LT(largest_residual_px(camera, ties(7, 0.0)), 1e-3);
    EXPECT_LT(largest_residual_px(camera, ties(6, 0.4)), 1e-3);
}

TEST(RationalCamera, NamesItsNumbersAsGdalDoes) {
    const auto metadata = rpc_metadata(fit_rational_camera(ties(5, 0.0)), 0.0);
    std::size_t coefficients = 0;
    for (const auto& [key, value] : metadata)
        if (key.ends_with("_COEFF"))
            coefficients += static_cast<std::size_t>(std::count(value.begin(), value.end(), ' ')) + 1;
    EXPECT_EQ(coefficients, 80U);
}

TEST(RationalCamera, WantsEnoughTies) {
    const auto few = ties(3, 0.0);
    EXPECT_THROW(fit_rational_camera(few), Error);
}

}  // namespace
}  // namespace pyroscene::analysis
