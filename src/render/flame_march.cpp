#include "render/flame_march.h"

namespace pyroscene::render {

FlameMarcher::FlameMarcher(const fire::FlameField& field) noexcept : field_(&field) {
    constexpr int kEdge = fire::FlameField::kBrickEdge;
    for (int j = 0; j < field.brick_rows; ++j) {
        for (int i = 0; i < field.brick_cols; ++i) {
            const auto& column = field.columns[static_cast<std::size_t>(j) * static_cast<std::size_t>(field.brick_cols) +
                                               static_cast<std::size_t>(i)];
            if (column.brick_count == 0) continue;
            const double low = column.z_begin * kEdge, high = (column.z_begin + column.brick_count) * kEdge;
            const bool first = end_i_ == first_i_;
            first_i_ = first ? i : std::min(first_i_, i);
            end_i_ = std::max(end_i_, i + 1);
            first_j_ = first ? j : first_j_;
            end_j_ = j + 1;
            bottom_ = first ? low : std::min(bottom_, low);
            top_ = first ? high : std::max(top_, high);
        }
    }
}

}  // namespace pyroscene::render
