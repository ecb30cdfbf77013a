#include "spread/propagate.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/constants.h"
#include "spread/curved_ray.h"

namespace pyroscene::spread {
namespace {

constexpr double kEdge_m = 3000.0;
constexpr double kLong_s = 1e9;

MapGrid square(int cells, double edge_m = kEdge_m) {
    return {.cols = cells, .rows = cells, .west_m = 0.0, .north_m = 0.0, .cell_m = edge_m / cells, .crs_wkt = "map"};
}

/// Head of a rate towards an azimuth on level ground.
FireShape ellipse(double rate_m_s, double length_to_width, double azimuth_deg) {
    return fire_shape({.rate_m_s = rate_m_s, .from_upslope_rad = azimuth_deg * kDegree_rad}, length_to_width, 0.0, 0.0);
}

Propagation everywhere(const MapGrid& grid, const FireShape& shape, std::vector<Seed> seeds) {
    return {grid,    std::move(seeds),
            {0.0},   [size = grid.size(), shape](std::size_t) { return FireShapes(size, shape); },
            kLong_s, {}};
}

/// Mean of |t - exact| in the time that the slowest way across a cell takes, and the largest relative error from 150 m on.
struct Errors {
    double mean_s = 0.0, worst = 0.0, worst_rate = 0.0;
};
Errors point_fire(int cells, const FireShape& shape) {
    const auto grid = square(cells);
    const double middle = cells / 2 + 0.5;
    const auto arrival = propagate(everywhere(grid, shape, {{middle, middle, 0.0}}));
    Errors errors;
    int count = 0;
    for (int row = 0; row < cells; ++row)
        for (int col = 0; col < cells; ++col) {
            const double x_m = (col + 0.5 - middle) * grid.cell_m, y_m = -(row + 0.5 - middle) * grid.cell_m;
            const double exact_s = shape.time_s(x_m, y_m), error_s = arrival.time_s.at(row, col) - exact_s;
            if (std::hypot(x_m, y_m) < 150.0 || exact_s > 1200.0) continue;
            errors.mean_s += std::abs(error_s);
            errors.worst = std::max(errors.worst, std::abs(error_s) / exact_s);
            const double rate = normal_rate_m_s(arrival.slowness[grid.index(row, col)], 0.0, 0.0);
            errors.worst_rate =
                std::max(errors.worst_rate, std::abs(rate / normal_rate_m_s(slowness(shape, x_m, y_m), 0.0, 0.0) - 1.0));
            ++count;
        }
    errors.mean_s /= count;
    return errors;
}

TEST(FireShape, TakesTheTimesOfTheEllipse) {
    // Published values of the relation for a head of 0.8113887 m/s and length / width 1.750798.
    const auto shape = ellipse(0.8113887, 1.750798, 90.0);
    for (const auto& [angle_deg, ray_m_s, normal_m_s] : {std::array{0.0, 0.8113887, 0.8113887},
                                                         {30.0, 0.5027846, 0.7231247},
                                                         {60.0, 0.2465706, 0.4963015},
                                                         {90.0, 0.1453740, 0.2545205},
                                                         {120.0, 0.1030717, 0.1305268},
                                                         {180.0, 0.07983926, 0.07983926}}) {
        const double x = std::cos(angle_deg * kDegree_rad), y = std::sin(angle_deg * kDegree_rad);
        EXPECT_NEAR(1.0 / shape.time_s(x, y), ray_m_s, 1e-6) << angle_deg;
        // The normal rate is that of the front whose normal has the angle: the least time to reach a straight line.
        double slowest = 1e9;
        for (double a = -179.9; a < 180.0; a += 0.1) {
            const double towards = std::cos((a - angle_deg) * kDegree_rad);
            if (towards > 0.01)
                slowest = std::min(slowest, shape.time_s(std::cos(a * kDegree_rad), std::sin(a * kDegree_rad)) / towards);
        }
        EXPECT_NEAR(1.0 / slowest, normal_m_s, 2e-6) << angle_deg;
    }
}

TEST(FireShape, MeasuresLengthsAlongTheSlope) {
    // 30 degrees up to the east, head upslope: the map distance is cos(30) of that along the slope.
    const double tangent = std::tan(30.0 * kDegree_rad);
    const auto shape = fire_shape({.rate_m_s = 0.5, .from_upslope_rad = 0.0}, 2.0, tangent, 0.0);
    EXPECT_NEAR(shape.time_s(100.0, 0.0), 100.0 / std::cos(30.0 * kDegree_rad) / 0.5, 1e-3);
    const auto flat = ellipse(0.5, 2.0, 90.0);
    EXPECT_NEAR(shape.time_s(0.0, 100.0), flat.time_s(0.0, 100.0), 1e-3);
    EXPECT_NEAR(normal_rate_m_s(slowness(shape, 10.0, 0.0), tangent, 0.0), 0.5, 1e-6);
    EXPECT_EQ(fire_shape({}, 1.0, 0.0, 0.0).time_s(1.0, 0.0), std::numeric_limits<double>::infinity());
}

TEST(CurvedRay, IsAParabolaOverItsChord) {
    const CurvedRay ray{{10.0, 20.0}, 30.0, -40.0, 0.004};
    const double sagitta = 0.004 * 50.0 * 50.0 / 8.0;
    const auto middle = ray.at(0.5);
    EXPECT_NEAR(middle.col, 25.0 + sagitta * 0.8, 1e-12);
    EXPECT_NEAR(middle.row, 0.0 + sagitta * 0.6, 1e-12);
    const auto half = ray.first_half();
    for (const double share : {0.1, 0.5, 0.8}) {
        EXPECT_NEAR(half.at(share).col, ray.at(0.5 * share).col, 0.02) << share;
        EXPECT_NEAR(half.at(share).row, ray.at(0.5 * share).row, 0.02) << share;
    }
    const auto last = ray.at(1.0), before = ray.at(1.0 - 1e-6), along = ray.direction_at_end();
    EXPECT_NEAR((last.col - before.col) * 1e6, along.col, 1e-3);
    EXPECT_NEAR((last.row - before.row) * 1e6, along.row, 1e-3);
    // On even ground its time is its length, longer than the chord by 8/3 sagitta2 / chord.
    const auto grid = square(100, 1000.0);
    const FireShapes even(grid.size(), ellipse(0.5, 1.0, 0.0));
    const CurvedRay across{{10.0, 60.0}, 30.0, -40.0, 0.004};
    const double chord_s = straight_ray_s(grid, even, across.start, across.dx, across.dy);
    EXPECT_NEAR(chord_s, 1000.0, 1e-3);
    EXPECT_NEAR(curved_ray_s(grid, even, across), 1000.0 + 8.0 / 3.0 * sagitta * sagitta / 50.0 / 50.0 * 1000.0, 0.03);
}

TEST(Propagate, DrawsCircles) {
    const auto errors = point_fire(151, ellipse(1.0, 1.0, 0.0));
    EXPECT_LT(errors.worst, 0.002);
    EXPECT_LT(errors.worst_rate, 0.002);
}

// On even ground the way is straight: exact from a point, however thin the ellipse (at most 8 in Anderson's relation).
TEST(Propagate, DrawsEllipsesOfAnyShapeInAnyDirection) {
    for (const double azimuth_deg : {0.0, 22.5, 45.0, 67.0, 190.0})
        for (const double length_to_width : {1.75, 3.0, 5.0, 8.0}) {
            const auto errors = point_fire(151, ellipse(1.0, length_to_width, azimuth_deg));
            EXPECT_LT(errors.worst, 1e-5) << azimuth_deg << ' ' << length_to_width;
            EXPECT_LT(errors.worst_rate, 1e-3) << azimuth_deg << ' ' << length_to_width;
        }
}

// Beyond the longest straight ray a way has a joint at the centre of a cell.
TEST(Propagate, BendsLongWaysByLessThanACell) {
    for (const double length_to_width : {1.75, 4.0, 8.0})
        EXPECT_LT(point_fire(301, ellipse(1.0, length_to_width, 30.0)).worst, 0.002) << length_to_width;
}

TEST(Propagate, ConvergesOutsideACircle) {
    // Outside a circle that burns from the start.
    const auto mean_error_s = [](int cells) {
        const auto grid = square(cells);
        auto job = everywhere(grid, ellipse(1.0, 1.0, 0.0), {});
        const double middle = 0.5 * cells, radius = 300.0 / grid.cell_m;
        const int seeds = static_cast<int>(60.0 * radius);
        for (int i = 0; i < seeds; ++i)
            job.seeds.push_back(
                {middle + radius * std::cos(2.0 * kPi * i / seeds), middle + radius * std::sin(2.0 * kPi * i / seeds), 0.0});
        const auto arrival = propagate(job);
        double sum = 0.0;
        int count = 0;
        for (int row = 0; row < cells; ++row)
            for (int col = 0; col < cells; ++col)
                if (const double r = std::hypot(row + 0.5 - middle, col + 0.5 - middle) * grid.cell_m;
                    r > 350.0 && r < 1400.0) {
                    sum += std::abs(arrival.time_s.at(row, col) - (r - 300.0));
                    ++count;
                }
        return sum / count;
    };
    const double coarse = mean_error_s(120), middle = mean_error_s(240), fine = mean_error_s(480);
    EXPECT_LT(middle, 0.5 * coarse);
    EXPECT_LT(fine, 0.5 * middle);
    EXPECT_LT(fine, 0.006);  // of 1100 s
}

// Speed that grows by 1 m/s in 2000 m to the north: ways are arcs, t = acosh(1 + d2 / (2 L2 v0 v)) / (v / L) with L = 2000 m from a point
// where the speed is 1 m/s. Cells of one speed make steps of it.
TEST(Propagate, ConvergesWhereTheWaysAreCurved) {
    const auto mean_error_s = [](int cells) {
        const auto grid = square(cells);
        constexpr double kLength_m = 2000.0;
        const double middle = cells / 2 + 0.5;
        auto job = everywhere(grid, {}, {{middle, middle, 0.0}});
        const auto speed_m_s = [&](int row) { return 1.0 - (row + 0.5 - middle) * grid.cell_m / kLength_m; };
        job.shapes = [&](std::size_t) {
            FireShapes shapes(grid.size());
            for (int row = 0; row < cells; ++row)
                for (int col = 0; col < cells; ++col) shapes[grid.index(row, col)] = ellipse(speed_m_s(row), 1.0, 0.0);
            return shapes;
        };
        const auto arrival = propagate(job);
        double sum = 0.0;
        int count = 0;
        for (int row = 0; row < cells; ++row)
            for (int col = 0; col < cells; ++col) {
                const double d_m = std::hypot(col + 0.5 - middle, row + 0.5 - middle) * grid.cell_m;
                if (d_m < 150.0 || d_m > 1400.0) continue;
                const double exact_s =
                    kLength_m * std::acosh(1.0 + d_m * d_m / (2.0 * kLength_m * kLength_m * speed_m_s(row)));
                sum += std::abs(arrival.time_s.at(row, col) - exact_s);
                ++count;
            }
        return sum / count;
    };
    const double coarse = mean_error_s(51), middle = mean_error_s(101), fine = mean_error_s(201);
    EXPECT_LT(coarse, 0.6);  // of about 1000 s
    EXPECT_LT(middle, 0.5 * coarse);
    EXPECT_LT(fine, 0.5 * middle);
}

/// A straight front under a wind at an angle to it: exact normal rate.
TEST(Propagate, MovesAStraightFrontWithItsNormalRate) {
    const auto grid = square(120);
    const auto shape = ellipse(0.8113887, 1.750798, 60.0);  // 30 degrees off the normal
    std::vector<Seed> seeds;
    for (double row = 0.0; row <= 120.0; row += 0.25) seeds.push_back({20.5, row, 0.0});
    const auto arrival = propagate(everywhere(grid, shape, seeds));
    for (int col = 25; col < 100; ++col)
        EXPECT_NEAR(arrival.time_s.at(60, col), (col - 20) * grid.cell_m / 0.7231247, 2e-3 * (col - 20) * grid.cell_m)
            << col;
    EXPECT_NEAR(normal_rate_m_s(arrival.slowness[grid.index(60, 80)], 0.0, 0.0), 0.7231247, 1e-3);
}

TEST(Propagate, GoesAroundABarrierAndNotThroughItsCorners) {
    const auto grid = square(101, 1010.0);
    auto job = everywhere(grid, ellipse(1.0, 1.0, 0.0), {{20.5, 50.5, 0.0}});
    // A staircase of cells that touch at corners only, from the top to row 80.
    job.shapes = [&](std::size_t) {
        FireShapes shapes(grid.size(), ellipse(1.0, 1.0, 0.0));
        for (int row = 0; row <= 80; ++row) shapes[grid.index(row, 40 + (row % 2))] = {};
        return shapes;
    };
    const auto arrival = propagate(job);
    EXPECT_TRUE(std::isnan(arrival.time_s.at(50, 40)));
    // Around the end of it at row 81: two straight ways.
    const double around_m = 10.0 * (std::hypot(40.0 - 20.0, 81.0 - 50.0) + std::hypot(60.0 - 40.0, 81.0 - 50.0));
    EXPECT_NEAR(arrival.time_s.at(50, 60), around_m, 0.03 * around_m);
    EXPECT_NEAR(arrival.time_s.at(50, 30), 100.0, 1.0);
}

TEST(Propagate, TakesTheMeanOfTwoFuelsAtTheirBorder) {
    const auto grid = square(100, 2000.0);
    auto job = everywhere(grid, {}, {});
    for (double row = 0.0; row <= 100.0; row += 0.25) job.seeds.push_back({10.5, row, 0.0});
    job.shapes = [&](std::size_t) {
        FireShapes shapes(grid.size(), ellipse(0.2, 1.0, 0.0));
        for (int row = 0; row < 100; ++row)
            for (int col = 0; col < 100; ++col)
                if (col / 5 % 2 == 0) shapes[grid.index(row, col)] = ellipse(1.0, 1.0, 0.0);
        return shapes;
    };
    const auto arrival = propagate(job);
    // From 10.5 to 45.5: 19.5 cells are fast, 15.5 slow.
    EXPECT_NEAR(arrival.time_s.at(50, 45), 20.0 * (19.5 / 1.0 + 15.5 / 0.2), 2.0);
}

TEST(Propagate, FollowsAChangeOfTheWeather) {
    const auto grid = square(151);
    const auto first = ellipse(1.0, 1.0, 0.0), second = ellipse(0.25, 1.0, 0.0);
    auto job = everywhere(grid, first, {{75.5, 75.5, 0.0}});
    job.period_start_s = {0.0, 300.0};
    job.shapes = [&](std::size_t period) { return FireShapes(grid.size(), period == 0 ? first : second); };
    const auto arrival = propagate(job);
    for (const int cells : {5, 14, 16, 30, 60}) {
        const double r_m = cells * grid.cell_m, exact_s = r_m <= 300.0 ? r_m : 300.0 + (r_m - 300.0) / 0.25;
        EXPECT_NEAR(arrival.time_s.at(75, 75 + cells), exact_s, 0.01 * exact_s) << cells;
    }
}

TEST(Propagate, ChangesWeatherInTheMiddleOfASlowCell) {
    // 100 m cells at 0.01 m/s take 10 000 s; after 5 000 s it goes ten times as fast, after 5 400 s not at all until 20 000 s.
    const auto grid = square(41, 4100.0);
    auto job = everywhere(grid, {}, {{20.5, 20.5, 0.0}});
    job.period_start_s = {0.0, 5000.0, 5400.0, 20000.0};
    job.shapes = [&](std::size_t period) {
        constexpr std::array kRates{0.01, 0.1, 0.0, 0.05};
        return FireShapes(grid.size(), kRates[period] > 0.0 ? ellipse(kRates[period], 1.0, 0.0) : FireShape{});
    };
    const auto arrival = propagate(job);
    // 50 m in the first period, 40 m in the second, then the last.
    EXPECT_NEAR(arrival.time_s.at(20, 21), 20000.0 + 10.0 / 0.05, 2.0);
    EXPECT_NEAR(arrival.time_s.at(20, 31), 20000.0 + 1010.0 / 0.05, 0.01 * 20200.0);
}

TEST(Propagate, StopsAtTheEndAndStartsEachSeedAtItsTime) {
    const auto grid = square(101);
    auto job = everywhere(grid, ellipse(1.0, 1.0, 0.0), {{20.5, 50.5, 0.0}, {80.5, 50.5, 400.0}, {50.5, 5.5, 2000.0}});
    job.end_s = 900.0;
    const auto arrival = propagate(job);
    for (int row = 0; row < 101; ++row)
        for (int col = 0; col < 101; ++col) {
            const double a = std::hypot(col - 20, row - 50) * grid.cell_m,
                         b = 400.0 + std::hypot(col - 80, row - 50) * grid.cell_m;
            const double exact_s = std::min(a, b), found_s = arrival.time_s.at(row, col);
            if (exact_s > 905.0) {
                EXPECT_TRUE(std::isnan(found_s)) << row << ' ' << col;
            }
            if (exact_s < 895.0) {
                EXPECT_NEAR(found_s, exact_s, 4.0) << row << ' ' << col;
            }
        }
}

TEST(Propagate, IsCancelledByItsProgress) {
    auto job = everywhere(square(101), ellipse(1.0, 1.0, 0.0), {{50.5, 50.5, 0.0}});
    job.on_progress = [](double) { throw std::runtime_error("stop"); };
    EXPECT_THROW(propagate(job), std::runtime_error);
}

}  // namespace
}  // namespace pyroscene::spread
