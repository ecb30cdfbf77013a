#include "render/terrain_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/random.h"

namespace pyroscene::render {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A raster of heights from a function of cell column and row; UTM-like corner, so that float32 map numbers would fail.
template <class Height>
Raster<float> heights(int cols, int rows, double cell_m, Height&& height) {
    MapGrid grid;
    grid.cols = cols;
    grid.rows = rows;
    grid.cell_m = cell_m;
    grid.west_m = 712340.0;
    grid.north_m = 5184200.0;
    Raster<float> raster(grid, "height", "m");
    for (int r = 0; r < rows; ++r) {
        for (int c = 0; c < cols; ++c) raster.at(r, c) = static_cast<float>(height(c, r));
    }
    return raster;
}

Vec3 south_west(const MapGrid& grid) { return {grid.west_m, grid.south_m(), 0.0}; }

/// Rough ground: independent heights, slopes up to 60 degrees.
Raster<float> rough(int cols, int rows) {
    return heights(cols, rows, 30.0, [cols](int c, int r) {
        return 1500.0 + 50.0 * uniform01({.seed = 7}, static_cast<std::uint64_t>(r) * static_cast<std::uint64_t>(cols) +
                                                          static_cast<std::uint64_t>(c));
    });
}

TEST(TerrainMesh, PlaneIsHitWhereGeometrySays) {
    // z = 100 + 0.2 x - 0.1 y over the south-west corner; a plane is its own mesh, rim included.
    const auto plane = [](double x, double y) { return 100.0 + 0.2 * x - 0.1 * y; };
    const auto raster = heights(40, 30, 20.0, [&](int c, int r) { return plane((c + 0.5) * 20.0, (30 - r - 0.5) * 20.0); });
    const TerrainMesh mesh(raster, south_west(raster.grid));
    const Vec3 normal = normalized(Vec3{-0.2, 0.1, 1.0});
    for (const Vec3 at : {Vec3{1.0, 1.0, 0.0}, Vec3{799.0, 599.0, 0.0}, Vec3{5.0, 300.0, 0.0}, Vec3{400.0, 300.0, 0.0}}) {
        const Vec3 target{at.x, at.y, plane(at.x, at.y)};
        const Vec3 start = target + 5000.0 * normalized(Vec3{0.3, -0.2, 1.0}),
                   end = target - 10.0 * normalized(Vec3{0.3, -0.2, 1.0});
        const auto hit = mesh.intersect(start, end);
        ASSERT_TRUE(hit) << at.x << ' ' << at.y;
        EXPECT_NEAR(length(hit->point_m - target), 0.0, 1e-3);
        EXPECT_NEAR(hit->distance_m, 5000.0, 1e-3);
        EXPECT_NEAR(length(hit->normal - normal), 0.0, 1e-5);
        EXPECT_NEAR(mesh.height_at(at.x, at.y), target.z, 1e-3);
    }
    EXPECT_NEAR(mesh.height_range_m()[0], plane(0.0, 600.0), 1e-3);
    EXPECT_NEAR(mesh.height_range_m()[1], plane(800.0, 0.0), 1e-3);
    EXPECT_GE(mesh.steepest_slope(), std::hypot(0.2, 0.1));
}

TEST(TerrainMesh, CoversTheRasterExactly) {
    const auto raster = heights(10, 6, 20.0, [](int, int) { return 50.0; });
    const TerrainMesh mesh(raster, south_west(raster.grid));
    const auto down = [&](double x, double y) { return mesh.intersect({x, y, 1000.0}, {x, y, -10.0}); };
    EXPECT_TRUE(down(0.01, 0.01));
    EXPECT_TRUE(down(199.99, 119.99));
    EXPECT_FALSE(down(-0.2, 60.0));
    EXPECT_FALSE(down(200.2, 60.0));
    EXPECT_FALSE(down(100.0, 120.2));
    EXPECT_TRUE(std::isnan(mesh.height_at(-0.2, 60.0)));
}

TEST(TerrainMesh, SegmentEndsWhereItEnds) {
    const auto raster = heights(10, 10, 20.0, [](int, int) { return 50.0; });
    const TerrainMesh mesh(raster, south_west(raster.grid));
    EXPECT_FALSE(mesh.intersect({100.0, 100.0, 1000.0}, {100.0, 100.0, 51.0}));
    EXPECT_TRUE(mesh.intersect({100.0, 100.0, 1000.0}, {100.0, 100.0, 49.0}));
    EXPECT_FALSE(mesh.intersect({100.0, 100.0, 40.0}, {100.0, 100.0, -10.0}));
    EXPECT_FALSE(mesh.intersect({100.0, 100.0, 40.0}, {100.0, 100.0, 40.0}));
    EXPECT_FALSE(mesh.intersect({kNaN, 100.0, 40.0}, {100.0, 100.0, 40.0}));
}

TEST(TerrainMesh, NoRayLeaksThroughRoughGround) {
    const auto raster = rough(64, 64);
    const TerrainMesh mesh(raster, south_west(raster.grid));
    const RandomKey key{.seed = 3};
    const double edge = 64 * 30.0;
    int leaks = 0;
    double worst_m = 0.0;
    for (std::uint64_t i = 0; i < 20000; ++i) {
        // Every second ray passes exactly through a vertex or an edge of the mesh, where leaks happen.
        double x = edge * uniform01(key, i, 0), y = edge * uniform01(key, i, 1);
        if (i % 2 == 0) x = (std::floor(x / 30.0) + 0.5) * 30.0;
        if (i % 4 == 0) y = (std::floor(y / 30.0) + 0.5) * 30.0;
        const Vec3 aim{x, y, 1500.0};
        const double zenith = i % 3 == 0 ? 0.0 : 1.0 * uniform01(key, i, 2), azimuth = 6.28 * uniform01(key, i, 3);
        const Vec3 up{std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith)};
        const Vec3 start = aim + (3000.0 / up.z) * up, end = aim - (100.0 / up.z) * up;
        const auto inside = [&](Vec3 p) { return p.x > 0.0 && p.x < edge && p.y > 0.0 && p.y < edge; };
        if (!inside(end) || !inside(aim + (110.0 / up.z) * up)) continue;  // enters or leaves through a side
        const auto hit = mesh.intersect(start, end);
        if (!hit) {
            ++leaks;
        } else if (zenith == 0.0 && (i % 4 == 0)) {  // over a vertex the height is known
            const int col = static_cast<int>(x / 30.0), row = 63 - static_cast<int>(y / 30.0);
            worst_m = std::max(worst_m, std::abs(hit->point_m.z - raster.at(row, col)));
        }
    }
    EXPECT_EQ(leaks, 0);
    EXPECT_LT(worst_m, 1e-3);
}

/// Rays side by side as of an image's line, and rays in all directions; some miss, some are nothing.
std::vector<SceneRay> many_rays(double edge_m) {
    std::vector<SceneRay> rays;
    for (int i = 0; i < 3000; ++i) {
        const double x = -10.0 + (edge_m + 20.0) * i / 3000.0, y = 0.37 * edge_m;
        rays.push_back({{0.5 * edge_m, 0.5 * edge_m, 6000.0}, {x, y, 1400.0}});
    }
    const RandomKey key{.seed = 5};
    for (std::uint64_t i = 0; i < 3001; ++i) {
        const auto place = [&](std::uint32_t axis) { return edge_m * (1.4 * uniform01(key, i, axis) - 0.2); };
        rays.push_back({{place(0), place(1), i % 7 == 0 ? 1520.0 : 2500.0}, {place(2), place(3), 1400.0}});
        if (i % 50 == 0) rays.back().start_m.x = kNaN;
        if (i % 51 == 0) rays.back().end_m = rays.back().start_m;
    }
    return rays;
}

TEST(TerrainMesh, RaysTogetherMeetWhatEachMeets) {
    auto raster = rough(64, 64);
    for (const bool with_holes : {false, true}) {
        if (with_holes) {
            for (int c = 0; c < 64; ++c) raster.at((5 * c) % 64, c) = std::numeric_limits<float>::quiet_NaN();
        }
        const TerrainMesh mesh(raster, south_west(raster.grid));
        const auto rays = many_rays(64 * 30.0);
        std::vector<std::optional<TerrainMesh::Hit>> hits(rays.size(), TerrainMesh::Hit{});
        mesh.intersect(rays, hits);
        int met = 0, missed = 0, other_facet = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const auto alone = mesh.intersect(rays[i].start_m, rays[i].end_m);
            ASSERT_EQ(hits[i].has_value(), alone.has_value()) << i;
            ++(alone ? met : missed);
            if (!alone) continue;
            EXPECT_NEAR(hits[i]->distance_m, alone->distance_m, 2e-3) << i;
            EXPECT_LT(length(hits[i]->point_m - alone->point_m), 2e-3) << i;
            if (length(hits[i]->normal - alone->normal) > 1e-4) ++other_facet;
        }
        EXPECT_GT(met, 4000);
        EXPECT_GT(missed, 200);
        EXPECT_LT(other_facet, 3);
    }
}

TEST(TerrainMesh, CellsWithoutHeightAreHoles) {
    const auto raster = heights(20, 20, 10.0, [](int c, int r) { return (c == 7 && r == 5) || c == 0 ? kNaN : 10.0; });
    const TerrainMesh mesh(raster, south_west(raster.grid));
    const auto down = [&](double x, double y) { return mesh.intersect({x, y, 100.0}, {x, y, 0.0}).has_value(); };
    for (int r = 0; r < 20; ++r) {
        for (int c = 0; c < 20; ++c) {
            const bool hole = (c == 7 && r == 5) || c == 0;
            for (const double off : {0.1, 5.0, 9.9}) {
                EXPECT_EQ(down(c * 10.0 + off, (19 - r) * 10.0 + off), !hole) << c << ' ' << r << ' ' << off;
            }
        }
    }
    EXPECT_FALSE(mesh.occluded({75.0, 145.0, 0.0}, {0.0, 0.0, 1.0}, 100.0));
    EXPECT_TRUE(mesh.occluded({95.0, 145.0, 0.0}, {0.0, 0.0, 1.0}, 100.0));
}

TEST(TerrainMesh, RidgeShadowsWhatLiesBehindIt) {
    // A ridge 50 m high along x = 105: at 45 degrees its shadow is 50 m long.
    const auto raster = heights(21, 5, 10.0, [](int c, int) { return c == 10 ? 50.0 : 0.0; });
    const TerrainMesh mesh(raster, south_west(raster.grid));
    const Vec3 sun = normalized(Vec3{-1.0, 0.0, 1.0});  // in the west
    EXPECT_TRUE(mesh.occluded({150.0, 25.0, 0.0}, sun, 1000.0));
    EXPECT_FALSE(mesh.occluded({160.0, 25.0, 0.0}, sun, 1000.0));
    EXPECT_FALSE(mesh.occluded({150.0, 25.0, 0.0}, sun, 20.0));
    EXPECT_FALSE(mesh.occluded({60.0, 25.0, 0.0}, sun, 1000.0));
}

TEST(TerrainMesh, RasterWithoutHeightsIsRefused) {
    const auto raster = heights(3, 3, 10.0, [](int, int) { return kNaN; });
    EXPECT_THROW(TerrainMesh(raster, {}), Error);
}

TEST(TerrainMesh, OneCellIsAHorizontalSquare) {
    const auto raster = heights(1, 1, 10.0, [](int, int) { return 3.0; });
    const TerrainMesh mesh(raster, south_west(raster.grid));
    const auto hit = mesh.intersect({9.0, 1.0, 100.0}, {9.0, 1.0, 0.0});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->point_m.z, 3.0, 1e-5);
}

}  // namespace
}  // namespace pyroscene::render
