// The way back from image to map with a real camera model: chords cut an analytic terrain, the ortho look-up inverts them, and
// each cell must find the image position that the collinearity equations give for its ground point.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/ortho.h"
#include "base/constants.h"
#include "sensors/image_chords.h"

namespace pyroscene::sensors {
namespace {

struct View {
    const char *name, *crs;
    double lat_deg, lon_deg;
    double heading_deg, pitch_deg, roll_deg;
};
void PrintTo(const View& view, std::ostream* out) { *out << view.name; }

constexpr double kLowest_m = 900.0, kHighest_m = 2100.0;

/// Hills with slopes up to 46 deg; x, y relative to the scene origin.
double terrain_z_m(double x_m, double y_m) {
    return 1500.0 + 280.0 * std::sin(x_m / 450.0) * std::cos(y_m / 520.0) + 110.0 * std::sin((x_m + 0.7 * y_m) / 280.0);
}

/// First point of a chord on the terrain.
Vec3 first_hit(const Chord& chord) {
    const auto above = [&](double f) {
        const Vec3 p = lerp(chord.top_m, chord.bottom_m, f);
        return p.z - terrain_z_m(p.x, p.y);
    };
    double low = 0.0, high = 0.0;
    while (above(high) > 0.0) {
        low = high;
        high += 1.0 / 32.0;  // slopes below 47 deg, view zeniths below 43 deg: a ray meets the ground once
    }
    for (int i = 0; i < 32; ++i) (above(0.5 * (low + high)) > 0.0 ? low : high) = 0.5 * (low + high);
    return lerp(chord.top_m, chord.bottom_m, high);
}

/// Collinearity: image position (corners at integers) of an ECEF point for a camera without distortion or misalignment.
std::array<double, 2> project(const CameraGroup& camera, const Pose& pose, Vec3 ecef_m) {
    const gis::LocalAxes axes = gis::local_axes(pose.position.lat_deg, pose.position.lon_deg);
    const Vec3 v = ecef_m - gis::ecef_from_geodetic(pose.position);
    const double north = dot(v, axes.north), east = dot(v, axes.east), down = -dot(v, axes.up);
    const double cp = std::cos(pose.heading_rad), sp = std::sin(pose.heading_rad), ct = std::cos(pose.pitch_rad),
                 st = std::sin(pose.pitch_rad), cr = std::cos(pose.roll_rad), sr = std::sin(pose.roll_rad);
    const double along = cp * north + sp * east, across = -sp * north + cp * east;  // heading undone
    const double forward = ct * along - st * down, lower = st * along + ct * down;  // pitch undone
    const double right = cr * across + sr * lower, axis = -sr * across + cr * lower;
    const double scale = camera.focal_length_m / camera.pixel_pitch_m / axis;
    return {camera.principal_point_px[0] + 0.5 + scale * right, camera.principal_point_px[1] + 0.5 - scale * forward};
}

class SteepTerrain : public testing::TestWithParam<View> {
protected:
    void SetUp() override {
        const View& view = GetParam();
        pose_ = {.position = {view.lat_deg, view.lon_deg, 5200.0},
                 .heading_rad = view.heading_deg * kDegree_rad,
                 .pitch_rad = view.pitch_deg * kDegree_rad,
                 .roll_rad = view.roll_deg * kDegree_rad};
        // A fifth of WASP's pixels at five times the pitch keeps the test quick; angles stay as they are.
        camera_ = wasp_.group("ir");
        camera_.samples /= 5;
        camera_.lines /= 5;
        camera_.pixel_pitch_m *= 5.0;
        camera_.principal_point_px = {0.5 * (camera_.samples - 1), 0.5 * (camera_.lines - 1)};
        const auto under = map_.to_map(view.lat_deg, view.lon_deg);
        origin_m_ = {std::round(under[0]), std::round(under[1]), 0.0};
        camera_.scan.positions = camera_.samples;
        camera_.scan.lines_per_scan = camera_.lines;
        const ImageGeometry image{.sensor = &wasp_,
                                  .group = &camera_,
                                  .scan = camera_.scan,
                                  .path = standing(pose_),
                                  .samples = camera_.samples,
                                  .lines = camera_.lines};
        const ImageChords frame(image, map_, origin_m_, kLowest_m, kHighest_m);
        const ScanChords chords = frame.scan(0);
        for (int line = 0; line < camera_.lines; ++line)
            for (int sample = 0; sample < camera_.samples; ++sample) {
                const Vec3 hit = first_hit(chords.at(sample + 0.5, line + 0.5));
                x_m_.push_back(hit.x + origin_m_.x);
                y_m_.push_back(hit.y + origin_m_.y);
                z_m_.push_back(hit.z);
                brightness_.push_back(0.0f);
                for (const auto& offset : pixel_samples({}, {}, 4).offset) {
                    const Vec3 p = first_hit(chords.at(sample + 0.5 + offset[0], line + 0.5 + offset[1]));
                    brightness_.back() += square(p.x + origin_m_.x, p.y + origin_m_.y) / 16.0f;
                }
            }
        MapGrid like;
        like.crs_wkt = view.crs;
        grid_ = analysis::ortho_grid(like, 4.0, x_m_, y_m_);
        lookup_ = analysis::ortho_lookup(grid_, camera_.samples, camera_.lines, x_m_, y_m_, z_m_);
    }

    static constexpr double kSquare_m = 250.0;
    /// Black and white squares painted on the map.
    static float square(double x_m, double y_m) {
        return (static_cast<long>(std::floor(x_m / kSquare_m)) + static_cast<long>(std::floor(y_m / kSquare_m))) % 2 == 0
                   ? 0.0f
                   : 1.0f;
    }

    /// Image position that a map point must have.
    [[nodiscard]] std::array<double, 2> expected(double x_m, double y_m) const {
        const double z_m = terrain_z_m(x_m - origin_m_.x, y_m - origin_m_.y);
        return project(camera_, pose_, gis::ecef_from_geodetic(map_.to_geodetic(x_m, y_m, z_m)));
    }

    /// Every cell of the look-up against the collinearity equations.
    void expect_positions() const {
        double worst = 0.0;
        int seen = 0, wrong_side = 0;
        for (int row = 0; row < grid_.rows; row += 3)
            for (int col = 0; col < grid_.cols; col += 3) {
                const auto [sample, line] = expected(grid_.x_centre_m(col), grid_.y_centre_m(row));
                const std::size_t cell = grid_.index(row, col);
                const double inside = std::min({sample, camera_.samples - sample, line, camera_.lines - line});
                if (std::abs(inside) < 0.1) continue;  // on the rim either answer is right
                wrong_side += std::isfinite(lookup_.sample[cell]) != (inside > 0.0);
                if (!std::isfinite(lookup_.sample[cell]) || inside < 0.5) continue;
                ++seen;
                worst = std::max(worst, std::hypot(lookup_.sample[cell] - sample, lookup_.line[cell] - line));
            }
        EXPECT_GT(seen, 10000);
        EXPECT_EQ(wrong_side, 0);
        EXPECT_LT(worst, 0.1);
    }

    /// The edges between black and white squares in the resampled picture against the lines they were painted along. Edge
    /// points carry the 4 x 4 sampling of the picture, so each side of a square is averaged.
    void expect_checkerboard() const {
        const auto ortho = analysis::ortho_resample(lookup_, camera_.samples, camera_.lines, brightness_, false);
        std::map<std::pair<long, long>, std::vector<double>> sides;  // {edge, square along it} -> offsets [px]
        for (int row = 0; row < grid_.rows; ++row) {
            const double y_m = grid_.y_centre_m(row), square = y_m / kSquare_m, along = square - std::floor(square);
            if (along < 0.2 || along > 0.8) continue;  // away from the corners
            for (int col = 0; col + 1 < grid_.cols; ++col) {
                const float left = ortho[grid_.index(row, col)], right = ortho[grid_.index(row, col + 1)];
                if (!((left - 0.5f) * (right - 0.5f) < 0.0f)) continue;
                const double x_m = grid_.x_centre_m(col) + grid_.cell_m * (0.5 - left) / (right - left);
                const long edge = std::lround(x_m / kSquare_m);
                const auto found = expected(x_m, y_m), painted = expected(static_cast<double>(edge) * kSquare_m, y_m);
                sides[{edge, std::lround(std::floor(square))}].push_back(std::copysign(
                    std::hypot(found[0] - painted[0], found[1] - painted[1]), x_m - static_cast<double>(edge) * kSquare_m));
            }
        }
        int whole = 0;
        double worst_px = 0.0;
        for (const auto& [side, offsets] : sides) {
            if (offsets.size() < 30) continue;  // cut by the frame
            ++whole;
            worst_px = std::max(worst_px, std::abs(std::accumulate(offsets.begin(), offsets.end(), 0.0)) /
                                              static_cast<double>(offsets.size()));
        }
        EXPECT_GT(whole, 20);
        EXPECT_LT(worst_px, 0.1);
    }

    const Sensor wasp_ = load_sensor("wasp");
    const gis::MapProjection map_{GetParam().crs};
    CameraGroup camera_;
    Pose pose_;
    Vec3 origin_m_;
    std::vector<double> x_m_, y_m_, z_m_;
    std::vector<float> brightness_;
    MapGrid grid_;
    analysis::OrthoLookup lookup_;
};

TEST_P(SteepTerrain, LandsOnTheMapWithinATenthOfAPixel) {
    expect_positions();
    expect_checkerboard();
}

INSTANTIATE_TEST_SUITE_P(Maps, SteepTerrain,
                         testing::Values(View{"utm_north", "EPSG:32611", 46.7, -114.2, 37, 12, -15},
                                         View{"utm_south", "EPSG:32755", -36.5, 147.3, 200, -14, 12},
                                         View{"zone_edge", "EPSG:32611", 44.0, -119.98, 290, 8, 16},
                                         View{"beyond_zone_edge", "EPSG:32612", 44.0, -114.1, 135, 14, 8}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace pyroscene::sensors
