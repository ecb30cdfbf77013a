// Fire spread speed: six hours of fire over 1000 x 1000 cells of 30 m, hills, patches of five fuels with bare spots, wind that
// turns every hour, in a process of its own on two threads. Prints one row of the benchmark table.
#include <array>
#include <cmath>
#include <iostream>

#include <fmt/format.h>

#include "bench/measure.h"
#include "fire/gradients.h"
#include "spread/landscape.h"

namespace {

using namespace pyroscene;

constexpr int kCells = 1000;
constexpr double kHours = 6.0, kHour_s = 3600.0;

spread::Landscape landscape() {
    const MapGrid grid{.cols = kCells, .rows = kCells, .west_m = 0.0, .north_m = 0.0, .cell_m = 30.0, .crs_wkt = "map"};
    spread::Landscape land;
    land.models = spread::standard_fuel_models();
    land.fuel = Raster<std::uint16_t>(grid, "fuel", "1");
    Raster<float> terrain_m(grid, "elevation", "m");
    constexpr std::array<std::uint16_t, 5> kFuels{1, 3, 102, 122, 147};
    for (int row = 0; row < kCells; ++row)
        for (int col = 0; col < kCells; ++col) {
            terrain_m.at(row, col) = static_cast<float>(150.0 * std::sin(row / 37.0) * std::cos(col / 53.0));
            const int patch = (row / 20) * 7 + (col / 20) * 13 + (row / 20) * (col / 20);
            const bool bare = (row * 31 + col * 17) % 41 == 0;
            land.fuel.at(row, col) = bare ? std::uint16_t{0} : kFuels[static_cast<std::size_t>(patch) % kFuels.size()];
        }
    auto slope = fire::terrain_slope(terrain_m);
    land.slope_east = std::move(slope.east);
    land.slope_north = std::move(slope.north);
    return land;
}

std::vector<spread::Weather> weather() {
    std::vector<spread::Weather> all;
    for (int hour = 0; hour < static_cast<int>(kHours); ++hour) {
        const double towards_rad = 0.6 * hour;
        all.push_back({kHour_s * hour,
                       {9.0 * std::sin(towards_rad), {}},
                       {9.0 * std::cos(towards_rad), {}},
                       {{{0.04, {}}, {0.05, {}}, {0.06, {}}, {0.4, {}}, {0.8, {}}}}});
    }
    return all;
}

}  // namespace

int main() {
    try {
        const auto land = landscape();
        const auto periods = weather();
        const auto usage = bench::measure(
            [&] {
                std::vector<spread::Seed> seeds;  // so many that nearly all burns
                for (int i = 0; i < 36; ++i) seeds.push_back({i % 6 * 160.0 + 100.5, i / 6 * 160.0 + 100.5, 0.0});
                const auto fire = spread::spread_fire(land, periods, {}, seeds, kHours * kHour_s);
                double burnt = 0.0;
                for (const float t : fire.arrival_time_s.values) burnt += std::isnan(t) ? 0.0 : 1.0;
                return std::vector{burnt};
            },
            2);
        std::cout << fmt::format(
            "| spread, {} x {} cells, {:.0f} h of fire, {:.0f} cells burnt, 2 threads | {:.2f} s wall, {:.2f} s CPU, {:.0f} "
            "MB | the fire "
            "itself | {:.0f} x real time | P 5 s; 1000 x real time | |\n",
            kCells, kCells, kHours, usage.results.at(0), usage.wall_s, usage.cpu_s, usage.peak_MB,
            kHours * kHour_s / usage.wall_s);
        return 0;
    } catch (const std::exception& e) {
        std::cerr << "bench_spread: " << e.what() << '\n';
        return 1;
    }
}
