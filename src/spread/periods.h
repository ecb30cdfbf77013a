#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "spread/fire_shape.h"

namespace pyroscene::spread {

/// Shapes of the fire in the periods of the weather, made when they are needed and forgotten when they no longer are.
class Periods {
public:
    /// \param start_s  of each period, ascending; the first holds before its start too, the last for ever
    Periods(const std::vector<double>& start_s, const std::function<FireShapes(std::size_t period)>& shapes)
        : start_s_(start_s), make_(shapes), shapes_(start_s.size()) {}

    [[nodiscard]] std::size_t at(double time_s) const noexcept {
        std::size_t p = first_;
        while (p + 1 < shapes_.size() && start_s_[p + 1] <= time_s) ++p;
        return p;
    }
    [[nodiscard]] double end_s(std::size_t period) const noexcept {
        return period + 1 < shapes_.size() ? start_s_[period + 1] : std::numeric_limits<double>::infinity();
    }
    const FireShapes& shapes(std::size_t period) {
        for (; made_ <= period; ++made_) shapes_[made_] = make_(made_);
        return shapes_[period];
    }
    /// Whether the weather of a time is still kept.
    [[nodiscard]] bool knows(double time_s) const noexcept { return first_ == 0 || start_s_[first_] <= time_s; }
    /// Nothing before this time will be asked for again.
    void forget_before(double time_s) {
        for (; first_ + 1 < shapes_.size() && start_s_[first_ + 1] <= time_s; ++first_) {
            shapes(first_);
            FireShapes().swap(shapes_[first_]);
        }
    }

private:
    const std::vector<double>& start_s_;
    const std::function<FireShapes(std::size_t period)>& make_;
    std::vector<FireShapes> shapes_;
    std::size_t first_ = 0, made_ = 0;
};

}  // namespace pyroscene::spread
