#include "analysis/ortho.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/error.h"

namespace pyroscene::analysis {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

MapGrid grid_of(int cols, int rows, double west_m, double north_m, double cell_m) {
    return {cols, rows, west_m, north_m, cell_m, "any"};
}

/// Ground points of an image, [line][sample].
struct Ground {
    int samples = 0, lines = 0;
    std::vector<double> x_m, y_m, z_m;

    template <class PointAt>  // PointAt(sample, line of the pixel centre) -> {x, y, z}
    Ground(int n_samples, int n_lines, PointAt point) : samples(n_samples), lines(n_lines) {
        for (int line = 0; line < lines; ++line)
            for (int sample = 0; sample < samples; ++sample) {
                const auto [x, y, z] = point(sample + 0.5, line + 0.5);
                x_m.push_back(x);
                y_m.push_back(y);
                z_m.push_back(z);
            }
    }
    [[nodiscard]] OrthoLookup lookup(const MapGrid& grid) const { return ortho_lookup(grid, samples, lines, x_m, y_m, z_m); }
};
using Point = std::array<double, 3>;

TEST(Ortho, OfAnAlignedPlaneIsThePlaneItself) {
    const MapGrid grid = grid_of(40, 30, 5000.0, 9000.0, 2.0);
    const Ground ground(40, 30, [&](double s, double l) { return Point{5000.0 + 2.0 * s, 9000.0 - 2.0 * l, 100.0}; });
    std::vector<float> image(40 * 30);
    for (std::size_t i = 0; i < image.size(); ++i) image[i] = static_cast<float>(i * 7 % 101);
    const OrthoLookup lookup = ground.lookup(grid);
    EXPECT_EQ(ortho_resample(lookup, 40, 30, image, true), image);
    const auto bilinear = ortho_resample(lookup, 40, 30, image, false);
    for (std::size_t i = 0; i < image.size(); ++i) EXPECT_NEAR(bilinear[i], image[i], 1e-3);
}

/// An image turned by any heading, mirrored or not, over flat ground: the inverse is an affine map known exactly.
TEST(Ortho, HandlesAnyHeadingAndMirroring) {
    for (const double heading_deg : {0.0, 33.0, 90.0, 145.0, 180.0, 270.0, 301.0})
        for (const double mirror : {1.0, -1.0}) {
            SCOPED_TRACE(testing::Message() << heading_deg << " deg, mirror " << mirror);
            const double c = std::cos(heading_deg * M_PI / 180.0), s = std::sin(heading_deg * M_PI / 180.0);
            const Ground ground(60, 50, [&](double sample, double line) {
                const double right = mirror * 3.0 * (sample - 30.0), up = 3.0 * (25.0 - line);
                return Point{700.0 + c * right + s * up, 900.0 - s * right + c * up, 0.0};
            });
            const MapGrid grid = grid_of(150, 150, 550.0, 1050.0, 2.0);
            const OrthoLookup lookup = ground.lookup(grid);
            for (int row = 0; row < grid.rows; ++row)
                for (int col = 0; col < grid.cols; ++col) {
                    const double dx = grid.x_centre_m(col) - 700.0, dy = grid.y_centre_m(row) - 900.0;
                    const double sample = 30.0 + mirror * (c * dx - s * dy) / 3.0, line = 25.0 - (s * dx + c * dy) / 3.0;
                    const std::size_t cell = grid.index(row, col);
                    const double inside = std::min({sample, 60.0 - sample, line, 50.0 - line});
                    if (std::abs(inside) < 1e-6) continue;
                    ASSERT_EQ(std::isfinite(lookup.sample[cell]), inside > 0.0)
                        << sample << ' ' << line;  // half pixel rim included
                    if (inside < 0.0) continue;
                    ASSERT_NEAR(lookup.sample[cell], sample, 1e-4);
                    ASSERT_NEAR(lookup.line[cell], line, 1e-4);
                    ASSERT_NEAR(lookup.ground_z_m[cell], 0.0, 1e-9);
                }
        }
}

/// Pinhole camera at 3000 m that looks 25 deg off nadir to the north-east, 1 mrad pixels.
struct Pinhole {
    double c = std::cos(25.0 * M_PI / 180.0), s = std::sin(25.0 * M_PI / 180.0), a = std::sqrt(0.5);

    [[nodiscard]] Point direction(double sample, double line) const {
        const double right = 1e-3 * (sample - 100.0), up = 1e-3 * (80.0 - line);
        const double ahead = s + c * up, down = c - s * up;  // optical axis and image vertical tilted by 25 deg
        return {a * (ahead + right), a * (ahead - right), -down};
    }
    [[nodiscard]] std::array<double, 2> project(double x, double y, double z) const {
        const double ahead = a * (x + y), right = a * (x - y), down = 3000.0 - z;
        const double axis = s * ahead + c * down;
        return {100.0 + 1e3 * right / axis, 80.0 - 1e3 * (c * ahead - s * down) / axis};
    }
};

double hills_m(double x, double y) {
    return 60.0 * std::sin(x / 75.0) + 50.0 * std::cos(y / 65.0);
}  // slopes to 39 deg and more

TEST(Ortho, FindsPositionsOnSteepTerrainOffNadirWithinATenthOfAPixel) {
    const Pinhole camera;
    const Ground ground(200, 160, [&](double sample, double line) {
        const auto d = camera.direction(sample, line);
        double low = 2700.0, high = 3900.0;  // ranges above and below all terrain; smooth hills: one crossing per ray
        for (int i = 0; i < 60; ++i) {
            const double t = 0.5 * (low + high);
            (3000.0 + t * d[2] > hills_m(t * d[0], t * d[1]) ? low : high) = t;
        }
        return Point{low * d[0], low * d[1], 3000.0 + low * d[2]};
    });
    const MapGrid grid = ortho_grid(grid_of(1, 1, 0.0, 0.0, 1.0), 2.0, ground.x_m, ground.y_m);
    const OrthoLookup lookup = ground.lookup(grid);
    double worst = 0.0;
    int seen = 0;
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col) {
            const double x = grid.x_centre_m(col), y = grid.y_centre_m(row);
            const auto [sample, line] = camera.project(x, y, hills_m(x, y));
            if (std::min({sample - 0.5, 199.5 - sample, line - 0.5, 159.5 - line}) < 0.0) continue;
            const std::size_t cell = grid.index(row, col);
            ASSERT_TRUE(std::isfinite(lookup.sample[cell])) << sample << ' ' << line;
            worst = std::max(worst, std::hypot(lookup.sample[cell] - sample, lookup.line[cell] - line));
            ++seen;
        }
    EXPECT_GT(seen, 50000);
    EXPECT_LT(worst, 0.1);
}

TEST(Ortho, AMissingPixelLeavesAHoleOfTwoPixels) {
    Ground ground(20, 20, [](double s, double l) { return Point{s, -l, 5.0}; });
    ground.x_m[10 * 20 + 10] = kNaN;
    const MapGrid grid = grid_of(200, 200, 0.0, 0.0, 0.1);
    const OrthoLookup lookup = ground.lookup(grid);
    int holes = 0;
    for (int row = 0; row < 200; ++row)
        for (int col = 0; col < 200; ++col) {
            const bool seen = std::isfinite(lookup.sample[grid.index(row, col)]);
            const double from_x = std::abs(grid.x_centre_m(col) - 10.5), from_y = std::abs(grid.y_centre_m(row) + 10.5);
            ASSERT_EQ(seen, std::max(from_x, from_y) > 1.0 - 1e-9);  // the four quads that touch the pixel are gone
            holes += !seen;
        }
    EXPECT_EQ(holes, 400);
}

TEST(Ortho, HigherGroundWinsWhereTheImageOverlapsItself) {
    // Lines run north for 20 pixels, then south again over the same ground: once below, once above.
    for (const bool first_is_higher : {true, false}) {
        const Ground ground(10, 40, [&](double s, double l) {
            const bool first = l < 20.0;
            return Point{s, first ? l : 40.0 - l, first == first_is_higher ? 50.0 : 10.0};
        });
        const MapGrid grid = grid_of(10, 15, 0.0, 17.0, 1.0);
        const OrthoLookup lookup = ground.lookup(grid);
        for (int row = 0; row < grid.rows; ++row)
            for (int col = 0; col < grid.cols; ++col) {
                const double y = grid.y_centre_m(row);
                EXPECT_NEAR(lookup.line[grid.index(row, col)], first_is_higher ? y : 40.0 - y, 1e-4);
                EXPECT_NEAR(lookup.ground_z_m[grid.index(row, col)], 50.0, 1e-4);
            }
    }
}

TEST(Ortho, GroundBehindARidgeCanBeHidden) {
    // Looking east at 45 deg: a wall 30 m high at x = 50 hides the ground from 50 to 80.
    const auto terrain = [](double x) { return x > 49.0 && x < 50.0 ? 30.0 : 0.0; };
    const Ground ground(100, 4, [&](double s, double l) {
        const double reach = 1.5 * s;  // where the ray meets height 0
        for (double x = reach - 30.0; x < reach; x += 0.01)
            if (reach - x <= terrain(x)) return Point{x, -l, reach - x};
        return Point{reach, -l, 0.0};
    });
    const MapGrid grid = grid_of(100, 4, 0.0, 0.0, 1.0);
    OrthoLookup lookup = ground.lookup(grid);
    std::vector<float> terrain_z(grid.size());
    for (int row = 0; row < 4; ++row)
        for (int col = 0; col < 100; ++col)
            terrain_z[grid.index(row, col)] = static_cast<float>(terrain(grid.x_centre_m(col)));
    ASSERT_TRUE(std::isfinite(lookup.sample[grid.index(1, 65)]));  // bridged
    EXPECT_GT(hide_unseen(lookup, terrain_z, 2.0), 0);
    for (const int col : {52, 60, 70, 76}) EXPECT_TRUE(std::isnan(lookup.sample[grid.index(1, col)])) << col;
    for (const int col : {10, 40, 45, 85, 95}) EXPECT_TRUE(std::isfinite(lookup.sample[grid.index(1, col)])) << col;
    EXPECT_TRUE(std::isnan(ortho_resample(lookup, 100, 4, std::vector<float>(400, 1.0f), true)[grid.index(1, 60)]));
}

TEST(Ortho, HeightsOnAFinerGridAreBilinear) {
    MapGrid coarse;
    coarse.cols = 4, coarse.rows = 3, coarse.cell_m = 10.0, coarse.west_m = 100.0, coarse.north_m = 50.0;
    Raster<float> terrain(coarse, "height", "m", 0.0F);
    for (int row = 0; row < 3; ++row)
        for (int col = 0; col < 4; ++col)
            terrain.values[coarse.index(row, col)] =
                static_cast<float>(2.0 * coarse.x_centre_m(col) - 3.0 * coarse.y_centre_m(row));
    MapGrid fine = coarse;
    fine.cols = 12, fine.rows = 8, fine.cell_m = 4.0, fine.west_m = 96.0;
    const auto heights = heights_on(fine, terrain);
    EXPECT_TRUE(std::isnan(heights[fine.index(4, 0)]));  // west of the terrain
    for (int row = 2; row < 6; ++row)
        for (int col = 3; col < 9; ++col)
            EXPECT_NEAR(heights[fine.index(row, col)], 2.0 * fine.x_centre_m(col) - 3.0 * fine.y_centre_m(row), 1e-3);
}

TEST(OrthoResample, AveragesOnlyValidPixels) {
    OrthoLookup lookup{grid_of(4, 1, 0, 0, 1), {1.0f, 1.5f, 0.1f, static_cast<float>(kNaN)}, {1.0f, 0.5f, 0.1f, 1.0f}, {}};
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<float> plane{2.0f, nan, 4.0f, 9.0f};  // 2 x 2
    const auto bilinear = ortho_resample(lookup, 2, 2, plane, false);
    EXPECT_FLOAT_EQ(bilinear[0], 5.0f);    // (2 + 4 + 9) / 3 in the middle
    EXPECT_TRUE(std::isnan(bilinear[1]));  // on the centre of the missing pixel
    EXPECT_FLOAT_EQ(bilinear[2], 2.0f);    // outer half pixel: nothing beyond the frame
    EXPECT_TRUE(std::isnan(bilinear[3]));
    const auto nearest = ortho_resample(lookup, 2, 2, plane, true);
    EXPECT_EQ(nearest[0], 9.0f);  // position 1.0 belongs to the second pixel
    EXPECT_TRUE(std::isnan(nearest[1]));
    EXPECT_EQ(nearest[2], 2.0f);
}

TEST(OrthoGrid, CoversTheGroundWithCornersAtMultiplesOfTheCell) {
    const std::vector<double> x{103.0, kNaN, 251.0, 180.0}, y{-42.0, 1e9, 77.0, kNaN};
    const MapGrid grid = ortho_grid(grid_of(1, 1, 0, 0, 30), 25.0, x, y);
    EXPECT_EQ(grid, grid_of(7, 6, 100.0, 100.0, 25.0));
    EXPECT_THROW(static_cast<void>(ortho_grid(grid, 25.0, std::vector{kNaN}, std::vector{1.0})), Error);
    EXPECT_THROW(static_cast<void>(ortho_grid(grid, 0.0, x, y)), Error);
    EXPECT_THROW(static_cast<void>(ortho_grid(grid, 1e-4, x, y)), Error);
}

TEST(Ortho, RefusesImagesWithoutNeighboursAndWrongLengths) {
    const std::vector<double> four(4, 0.0), three(3, 0.0);
    const MapGrid grid = grid_of(2, 2, 0, 0, 1);
    EXPECT_THROW(static_cast<void>(ortho_lookup(grid, 4, 1, four, four, four)), Error);
    EXPECT_THROW(static_cast<void>(ortho_lookup(grid, 2, 2, four, three, four)), Error);
}

}  // namespace
}  // namespace pyroscene::analysis
