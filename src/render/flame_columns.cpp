#include "render/flame_columns.h"

namespace pyroscene::render {

FlameColumns::FlameColumns(const fire::FlameField& field) : field_(&field) {
    occupied_.assign(field.columns.size(), -1);
    first_part_.push_back(0);
    for (int j = 0; j < field.brick_rows; ++j) {
        for (int i = 0; i < field.brick_cols; ++i) {
            const auto at =
                static_cast<std::size_t>(j) * static_cast<std::size_t>(field.brick_cols) + static_cast<std::size_t>(i);
            if (field.columns[at].brick_count == 0) continue;
            occupied_[at] = static_cast<std::int32_t>(columns_.size());
            bricks_ = empty()
                          ? CellBox{i, j, i + 1, j + 1}
                          : CellBox{std::min(bricks_.first_i, i), bricks_.first_j, std::max(bricks_.end_i, i + 1), j + 1};
            add_brick_column(field.columns[at], i, j);
        }
    }
}

void FlameColumns::add_brick_column(const fire::FlameField::BrickColumn& bricks, int brick_i, int brick_j) {
    const bool first = columns_.empty();
    BrickColumns& columns = columns_.emplace_back();
    const int bottom = bricks.z_begin * kEdge, top = bottom + bricks.brick_count * kEdge;
    int lowest = top, highest = bottom;
    for (int c = 0; c < kEdge * kEdge; ++c) {
        Column& column = columns[static_cast<std::size_t>(c)];
        column.first_voxel = (bricks.first_brick - bricks.z_begin) * fire::FlameField::kBrickVoxels + c;
        for (int k = bottom; k < top; ++k) {
            if (!(fill(voxel(column, k)) > 0.0F)) continue;
            if (column.k_end == 0) column.k_begin = k;
            column.k_end = k + 1;
        }
        if (column.k_end == 0) continue;
        lowest = std::min(lowest, static_cast<int>(column.k_begin));
        highest = std::max(highest, static_cast<int>(column.k_end));
    }
    lowest_ = first ? lowest : std::min(lowest_, lowest);
    highest_ = first ? highest : std::max(highest_, highest);

    boxes_.push_back(occupied_box(brick_i, brick_j, 0, 0, kEdge).value_or(Box{}));
    constexpr int kPart = 2;
    for (int j = 0; j < kEdge; j += kPart) {
        for (int i = 0; i < kEdge; i += kPart) {
            if (const auto part = occupied_box(brick_i, brick_j, i, j, kPart)) parts_.push_back(*part);
        }
    }
    first_part_.push_back(parts_.size());
}

std::optional<FlameColumns::Box> FlameColumns::occupied_box(int brick_i, int brick_j, int i, int j, int size) const {
    int first_i = kEdge, end_i = 0, first_j = kEdge, end_j = 0;
    for (int v = j; v < j + size; ++v) {
        for (int u = i; u < i + size; ++u) {
            if (columns_.back()[static_cast<std::size_t>(v * kEdge + u)].k_end == 0) continue;
            first_i = std::min(first_i, u), end_i = std::max(end_i, u + 1);
            first_j = std::min(first_j, v), end_j = std::max(end_j, v + 1);
        }
    }
    if (end_i == 0) return std::nullopt;
    const fire::VoxelGrid& g = field_->grid;
    const auto x_m = [&](int u) { return g.corner_m.x + (brick_i * kEdge + u) * g.dx_m; };
    const auto y_m = [&](int v) { return g.corner_m.y + (brick_j * kEdge + v) * g.dy_m; };
    return Box{x_m(first_i), y_m(first_j), x_m(end_i), y_m(end_j)};
}

}  // namespace pyroscene::render
