#include "render/fire_detail.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pyroscene::render {
namespace {

constexpr double kHot_K = 1.0;         // above ambient: a scar that still glows
constexpr double kBrightLight = 1e-4;  // of the brightest cell: the wide halo of a fire holds a few per cent of its light
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Standard errors of the area of flaming and of hot cells in a square of kErrorSquare_m, or in a pixel that is larger.
constexpr double kFlamingError = 0.002, kHotError = 0.01, kErrorSquare_m = 500.0;
constexpr double kMostPerCell = 40.0;

double error_of_pixel(double error, double area_m2) {
    return error * std::max(1.0, kErrorSquare_m / std::sqrt(std::max(area_m2, 1.0)));
}

/// One random point in each square of edge s: those on the rim of a cell of width w count by chance. Four rims of w / s
/// squares, each of variance 1/6 on average, give a standard error of sqrt(2/3) (s / w)^1.5 of the area of one cell, and less
/// by the root of their number for n cells.
double points_per_cell(double cells, double error) {
    const double wanted = std::sqrt(2.0 / 3.0) / (error * std::sqrt(std::max(cells, 1.0)));
    return std::clamp(std::pow(wanted, 2.0 / 3.0), 1.0, kMostPerCell);
}

}  // namespace

FireDetail::FireDetail(const RenderScene& scene, const GroundIrradiance* light)
    : map_(scene.terrain->grid()), origin_m_(scene.scene_origin_m) {
    fine_ = scene.surface->refinement;
    if (!scene.flame->empty()) {
        const double voxel_m = std::min(scene.flame->grid.dx_m, scene.flame->grid.dy_m);
        fine_ = std::max(fine_, static_cast<int>(std::lround(map_.cell_m / voxel_m)));
    }
    fine_ = std::clamp(fine_, 1, kMostFine);
    hot_.assign(map_.size(), 0);
    fine_block_.assign(map_.size(), -1);
    mark_ground(scene);
    if (light != nullptr && !light->irradiance_W_m2_um.empty()) mark_lit_ground(*light);
    if (!scene.flame->empty()) mark_flames(scene);
    any_hot_ = std::find(hot_.begin(), hot_.end(), std::uint8_t{1}) != hot_.end();
    build_pyramid();
}

void FireDetail::mark_flaming(int fine_row, int fine_col) {
    if (fine_row < 0 || fine_col < 0 || fine_row >= map_.rows * fine_ || fine_col >= map_.cols * fine_) return;
    auto& block = fine_block_[map_.index(fine_row / fine_, fine_col / fine_)];
    if (block < 0) {
        block = static_cast<std::int32_t>(fine_cells_.size());
        fine_cells_.emplace_back();
    }
    fine_cells_[static_cast<std::size_t>(block)].set(
        static_cast<std::size_t>((fine_row % fine_) * fine_ + fine_col % fine_));
}

void FireDetail::mark_ground(const RenderScene& scene) {
    const fire::SurfaceField& surface = *scene.surface;
    const double hot_K = surface.ambient_temperature_K + kHot_K;
    const int per_map_cell = surface.refinement;
    // The detail's fine cells that a fine cell of the surface touches.
    const auto first = [&](int i) { return i * fine_ / per_map_cell; };
    const auto last = [&](int i) { return ((i + 1) * fine_ + per_map_cell - 1) / per_map_cell - 1; };
    surface.for_each_own_cell([&](int r, int c, std::size_t i) {
        if (surface.base_temperature_K[i] > hot_K) hot_[map_.index(r / per_map_cell, c / per_map_cell)] = 1;
        if (!(surface.front_fraction[i] > 0.0F)) return;
        for (int fr = first(r); fr <= last(r); ++fr)
            for (int fc = first(c); fc <= last(c); ++fc) mark_flaming(fr, fc);
    });
}

void FireDetail::mark_lit_ground(const GroundIrradiance& light) {
    const auto sum_of_row = [&](std::int32_t row) {
        const float* first =
            light.irradiance_W_m2_um.data() + static_cast<std::ptrdiff_t>(row) * static_cast<std::ptrdiff_t>(light.stride);
        double sum = 0.0;
        for (int l = 0; l < light.lambda_count; ++l) sum += static_cast<double>(first[l]);
        return sum;
    };
    double brightest = 0.0;
    for (const std::int32_t row : light.row_of_cell)
        if (row >= 0) brightest = std::max(brightest, sum_of_row(row));
    for (std::size_t i = 0; i < hot_.size(); ++i)
        if (light.row_of_cell[i] >= 0 && sum_of_row(light.row_of_cell[i]) > kBrightLight * brightest) hot_[i] = 1;
}

void FireDetail::mark_flames(const RenderScene& scene) {
    const fire::FlameField& flame = *scene.flame;
    const fire::VoxelGrid& grid = flame.grid;
    constexpr int kEdge = fire::FlameField::kBrickEdge;
    const auto mark_voxels = [&](int i, int j, int top) {
        const double x_m = grid.corner_m.x + i * grid.dx_m, y_m = grid.corner_m.y + j * grid.dy_m;
        const double ground_m = scene.terrain->height_at(x_m + 0.5 * grid.dx_m, y_m + 0.5 * grid.dy_m);
        if (std::isfinite(ground_m))
            flame_height_m_ = std::max(flame_height_m_, grid.corner_m.z + top * grid.dz_m - ground_m);
        constexpr double kRim = 1e-6;  // of a fine cell: voxels that end where it begins
        const auto col = [&](double x, double rim) {
            return static_cast<int>(std::floor(map_.col_at(x + origin_m_.x) * fine_ + rim));
        };
        const auto row = [&](double y, double rim) {
            return static_cast<int>(std::floor(map_.row_at(y + origin_m_.y) * fine_ + rim));
        };
        for (int r = row(y_m + grid.dy_m, kRim); r <= row(y_m, -kRim); ++r)
            for (int c = col(x_m, kRim); c <= col(x_m + grid.dx_m, -kRim); ++c) mark_flaming(r, c);
    };
    for (int bj = 0; bj < flame.brick_rows; ++bj)
        for (int bi = 0; bi < flame.brick_cols; ++bi) {
            const auto& column = flame.columns[static_cast<std::size_t>(bj) * static_cast<std::size_t>(flame.brick_cols) +
                                               static_cast<std::size_t>(bi)];
            std::array<int, kEdge * kEdge> top{};  // of each column of voxels, 0 = empty
            for (int b = 0; b < column.brick_count; ++b) {
                const auto& brick = flame.bricks[static_cast<std::size_t>(column.first_brick + b)];
                for (std::size_t v = 0; v < brick.fill.size(); ++v)
                    if (brick.fill[v] > 0.0F)
                        top[v % top.size()] = (column.z_begin + b) * kEdge + static_cast<int>(v / top.size()) + 1;
            }
            for (std::size_t v = 0; v < top.size(); ++v)
                if (top[v] > 0)
                    mark_voxels(bi * kEdge + static_cast<int>(v % kEdge), bj * kEdge + static_cast<int>(v / kEdge), top[v]);
        }
}

void FireDetail::build_pyramid() {
    int cols = map_.cols, rows = map_.rows;
    do {
        const Level* below = levels_.empty() ? nullptr : &levels_.back();
        Level level{(cols + 1) / 2, (rows + 1) / 2, {}, {}};
        level.flaming.assign(static_cast<std::size_t>(level.cols) * static_cast<std::size_t>(level.rows), 0);
        level.hot = level.flaming;
        for (int r = 0; r < rows; ++r)
            for (int c = 0; c < cols; ++c) {
                const auto from = static_cast<std::size_t>(r) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(c);
                const auto to =
                    static_cast<std::size_t>(r / 2) * static_cast<std::size_t>(level.cols) + static_cast<std::size_t>(c / 2);
                if (below != nullptr) {
                    level.flaming[to] += below->flaming[from];
                    level.hot[to] += below->hot[from];
                    continue;
                }
                level.hot[to] += hot_[from];
                if (fine_block_[from] >= 0)
                    level.flaming[to] +=
                        static_cast<std::uint32_t>(fine_cells_[static_cast<std::size_t>(fine_block_[from])].count());
            }
        cols = level.cols;
        rows = level.rows;
        levels_.push_back(std::move(level));
    } while (cols > 1 || rows > 1);
}

bool FireDetail::misses(const GroundBox& box) const noexcept {
    return !(map_.col_at(box.east + origin_m_.x) >= 0.0 && map_.col_at(box.west + origin_m_.x) <= map_.cols &&
             map_.row_at(box.south + origin_m_.y) >= 0.0 && map_.row_at(box.north + origin_m_.y) <= map_.rows);
}

/// Cells of a level (0 = the map) that a box touches.
FireDetail::Window FireDetail::window(const GroundBox& box, std::size_t level) const noexcept {
    const double scale = std::ldexp(1.0, -static_cast<int>(level));
    const int cols = level == 0 ? map_.cols : levels_[level - 1].cols,
              rows = level == 0 ? map_.rows : levels_[level - 1].rows;
    const auto inside = [](double position, int n) { return static_cast<int>(std::clamp(position, 0.0, n - 1.0)); };
    return {inside(map_.row_at(box.north + origin_m_.y) * scale, rows),
            inside(map_.row_at(box.south + origin_m_.y) * scale, rows),
            inside(map_.col_at(box.west + origin_m_.x) * scale, cols),
            inside(map_.col_at(box.east + origin_m_.x) * scale, cols)};
}

/// Lowest level at which the box is at most as many cells wide.
std::size_t FireDetail::level_of(const GroundBox& box, double cells) const noexcept {
    std::size_t level = 0;
    const double width = std::max(box.east - box.west, box.north - box.south) / map_.cell_m;
    for (double span = width; span > cells && level < levels_.size(); span *= 0.5) ++level;
    return level;
}

FireDetail::Spacing FireDetail::spacing(const GroundBox& pixel, double area_m2) const noexcept {
    double flaming = 0.0, hot = 0.0;
    if (!misses(pixel)) {
        constexpr double kCellsAcross = 8.0;  // the counts are right to the rim of such cells
        const std::size_t level = std::max<std::size_t>(level_of(pixel, kCellsAcross), 1);
        const Level& at = levels_[level - 1];
        const Window w = window(pixel, level);
        for (int r = w.first_row; r <= w.last_row; ++r)
            for (int c = w.first_col; c <= w.last_col; ++c) {
                const auto i = static_cast<std::size_t>(r) * static_cast<std::size_t>(at.cols) + static_cast<std::size_t>(c);
                flaming += at.flaming[i];
                hot += at.hot[i];
            }
    }
    return {map_.cell_m / fine_ / points_per_cell(flaming, error_of_pixel(kFlamingError, area_m2)),
            map_.cell_m / points_per_cell(hot, error_of_pixel(kHotError, area_m2))};
}

double FireDetail::finest_spacing_m(double area_m2) const noexcept {
    if (!fine_cells_.empty()) return map_.cell_m / fine_ / points_per_cell(1.0, error_of_pixel(kFlamingError, area_m2));
    return any_hot_ ? map_.cell_m / points_per_cell(1.0, error_of_pixel(kHotError, area_m2)) : kInfinity;
}

bool FireDetail::flames_within(const GroundBox& box) const noexcept {
    const std::size_t level = level_of(box, 2.0);
    const Window w = window(box, level);
    const double north = map_.row_at(box.north + origin_m_.y) * fine_, south = map_.row_at(box.south + origin_m_.y) * fine_;
    const double west = map_.col_at(box.west + origin_m_.x) * fine_, east = map_.col_at(box.east + origin_m_.x) * fine_;
    const auto of_cell = [&](double position, int cell) {
        return static_cast<int>(std::clamp(position - cell * fine_, 0.0, fine_ - 1.0));
    };
    for (int r = w.first_row; r <= w.last_row; ++r)
        for (int c = w.first_col; c <= w.last_col; ++c) {
            if (level > 0) {
                const Level& at = levels_[level - 1];
                if (at.flaming[static_cast<std::size_t>(r) * static_cast<std::size_t>(at.cols) +
                               static_cast<std::size_t>(c)] > 0)
                    return true;
                continue;
            }
            const std::int32_t block = fine_block_[map_.index(r, c)];
            if (block < 0) continue;
            const FineCells& cells = fine_cells_[static_cast<std::size_t>(block)];
            for (int fr = of_cell(north, r); fr <= of_cell(south, r); ++fr)
                for (int fc = of_cell(west, c); fc <= of_cell(east, c); ++fc)
                    if (cells[static_cast<std::size_t>(fr * fine_ + fc)]) return true;
        }
    return false;
}

bool FireDetail::hot_within(const GroundBox& box) const noexcept {
    const std::size_t level = level_of(box, 2.0);
    const Window w = window(box, level);
    for (int r = w.first_row; r <= w.last_row; ++r)
        for (int c = w.first_col; c <= w.last_col; ++c) {
            if (level == 0) {
                if (hot_[map_.index(r, c)] != 0) return true;
                continue;
            }
            const Level& at = levels_[level - 1];
            if (at.hot[static_cast<std::size_t>(r) * static_cast<std::size_t>(at.cols) + static_cast<std::size_t>(c)] > 0)
                return true;
        }
    return false;
}

double FireDetail::spacing_within_m(const GroundBox& part, const Spacing& pixel) const noexcept {
    if (misses(part)) return kInfinity;
    if (flames_within(part)) return pixel.flaming_m;
    return hot_within(part) ? pixel.hot_m : kInfinity;
}

}  // namespace pyroscene::render
