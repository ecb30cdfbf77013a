#include "render/sky_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/constants.h"
#include "render/terrain_sight.h"

namespace pyroscene::render {
namespace {

constexpr double kPlane_rad = 2.0 * kPi / kSkylinePlanes;
constexpr double kShares = 65535.0;

}  // namespace

SkyView::SkyView(const TerrainHeights& heights)
    : heights_(heights),
      runs_per_row_((static_cast<std::size_t>(heights.cols) + kRun - 1) / kRun),
      runs_(runs_per_row_ * static_cast<std::size_t>(heights.rows)) {
    const double diagonal_m = heights.cell_m * std::hypot(heights.cols, heights.rows);
    for (int p = 0; p < kSkylinePlanes; ++p) {
        const double azimuth = kPlane_rad * (p + 0.5);
        Skyline skyline{std::cos(azimuth), std::sin(azimuth), {}};
        for (double r_m = heights.cell_m; r_m < diagonal_m; r_m = next_look_m(r_m, heights.cell_m)) {
            const double col = r_m * skyline.dx / heights.cell_m, row = -r_m * skyline.dy / heights.cell_m;
            const auto c = static_cast<float>(col - std::floor(col)), r = static_cast<float>(row - std::floor(row));
            skyline.looks.push_back({r_m,
                                     static_cast<int>(std::floor(row)),
                                     static_cast<int>(std::floor(col)),
                                     {(1.0F - r) * (1.0F - c), (1.0F - r) * c, r * (1.0F - c), r * c}});
        }
        skylines_.push_back(std::move(skyline));
    }
}

SkyView::~SkyView() {
    for (const auto& run : runs_) delete run.load();
}

double SkyView::at(std::size_t cell) const {
    const auto cols = static_cast<std::size_t>(heights_.cols);
    const std::size_t row = cell / cols, col = cell % cols;
    auto& place = runs_[row * runs_per_row_ + col / kRun];
    const Run* run = place.load(std::memory_order_acquire);
    if (run == nullptr) {
        // Threads that come at the same time find the same; the first one's is kept.
        Run* const found = look_from(static_cast<int>(row), static_cast<int>(col / kRun) * kRun);
        Run* there = nullptr;
        if (place.compare_exchange_strong(there, found, std::memory_order_acq_rel)) {
            run = found;
        } else {
            delete found;
            run = there;
        }
    }
    return (*run)[col % kRun] / kShares;
}

SkyView::Run* SkyView::look_from(int row, int first_col) const {
    const int count = std::min(kRun, heights_.cols - first_col);
    std::array<Vec3, kRun> normal;
    for (int i = 0; i < count; ++i) normal[static_cast<std::size_t>(i)] = cell_normal(heights_, row, first_col + i);
    std::array<double, kRun> hidden_sr{};
    Slopes slope;
    for (const Skyline& skyline : skylines_) {
        climb(skyline, row, first_col, count, slope);
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
            const PlaneWeight weight{normal[i].x * skyline.dx + normal[i].y * skyline.dy, normal[i].z};
            const double in_plane_sr = kPlane_rad * weight.hidden_by(static_cast<double>(slope[i]));
            if (in_plane_sr >= kLeastHidden_sr) hidden_sr[i] += in_plane_sr;
        }
    }
    auto run = std::make_unique<Run>();
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
        (*run)[i] = static_cast<std::uint16_t>(std::lround(std::clamp(1.0 - hidden_sr[i] / kPi, 0.0, 1.0) * kShares));
    return run.release();
}

/// Slopes of the skyline from cells along a row. The same look of all cells meets the heights with the same weights, so that they
/// go together, as long as none of them leaves the cell centres; then each goes on alone.
void SkyView::climb(const Skyline& skyline, int row, int first_col, int count, Slopes& slope) const noexcept {
    slope.fill(-std::numeric_limits<float>::infinity());
    std::array<float, kRun> own{}, most{};
    const auto n = static_cast<std::size_t>(count);
    const auto highest = static_cast<float>(heights_.upper_m.z - heights_.zero_m);
    const float* z = heights_.stored(row, first_col);
    for (std::size_t i = 0; i < n; ++i) {
        own[i] = z[i];
        most[i] = highest - own[i];
    }
    const auto line = static_cast<std::ptrdiff_t>(heights_.cols) + 2;
    for (std::size_t k = 0; k < skyline.looks.size(); ++k) {
        const Look& look = skyline.looks[k];
        const auto per_m = static_cast<float>(1.0 / look.distance_m);
        int higher = 0;
        for (std::size_t i = 0; i < n; ++i) higher |= static_cast<int>(most[i] * per_m > slope[i]);
        if (higher == 0) return;  // nothing farther away can stand higher
        const int r = row + look.row, c = first_col + look.col;
        if (r < 0 || r + 1 >= heights_.rows || c < 0 || c + count >= heights_.cols) {
            for (std::size_t i = 0; i < n; ++i) climb_on(skyline, k, row, first_col + static_cast<int>(i), slope[i]);
            return;
        }
        const float* upper = heights_.stored(r, c);
        const float* lower = upper + line;
        const auto [a, b, d, e] = look.weight;
        for (std::size_t i = 0; i < n; ++i) {
            const float h = a * upper[i] + b * upper[i + 1] + (d * lower[i] + e * lower[i + 1]);
            const float seen = (h - own[i]) * per_m;
            slope[i] = slope[i] > seen ? slope[i] : seen;
        }
    }
}

/// One cell from a look on, as far as the rim of the raster.
void SkyView::climb_on(const Skyline& skyline, std::size_t look, int row, int col, float& slope) const noexcept {
    const double x_m = heights_.lower_m.x + (col + 0.5) * heights_.cell_m,
                 y_m = heights_.upper_m.y - (row + 0.5) * heights_.cell_m;
    const double own_m = heights_.zero_m + static_cast<double>(*heights_.stored(row, col)),
                 most_m = heights_.upper_m.z - own_m;
    for (; look < skyline.looks.size(); ++look) {
        const double r_m = skyline.looks[look].distance_m;
        if (most_m / r_m <= static_cast<double>(slope)) return;
        const double h_m = heights_.at(x_m + r_m * skyline.dx, y_m + r_m * skyline.dy);
        if (!(h_m > -1e9)) return;  // left the raster
        slope = std::max(slope, static_cast<float>((h_m - own_m) / r_m));
    }
}

}  // namespace pyroscene::render
