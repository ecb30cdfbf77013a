#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/error.h"
#include "sensors/framing.h"

namespace pyroscene::sensors {
namespace {

/// Convolution of two centred boxes of widths a >= b: box (b = 0), triangle (a = b), trapezoid in between. Area 1.
class TwoBoxes {
public:
    TwoBoxes(double width_1, double width_2)
        : a_(std::max(width_1, width_2)), b_(std::min(width_1, width_2)), base_(0.5 * (a_ + b_)), flat_(0.5 * (a_ - b_)) {}

    /// Position below which the fraction p <= 0.5 of the area lies.
    [[nodiscard]] double quantile(double p) const {
        const double flank = 0.5 * b_ / a_;
        return p <= flank ? -base_ + std::sqrt(2.0 * a_ * b_ * p) : -flat_ + (p - flank) * a_;
    }
    /// Integral of t f(t) from the left end to x <= 0.
    [[nodiscard]] double first_moment(double x) const {
        const double on_flank = std::min(x, -flat_);
        const double flank =
            b_ > 0.0
                ? (2.0 * std::pow(on_flank, 3) + 3.0 * base_ * on_flank * on_flank - std::pow(base_, 3)) / (6.0 * a_ * b_)
                : 0.0;
        return x <= -flat_ ? flank : flank + 0.5 * (x * x - flat_ * flat_) / a_;
    }

private:
    double a_, b_, base_, flat_;
};

class Gaussian {
public:
    explicit Gaussian(double fwhm) : sigma_(fwhm / (2.0 * std::sqrt(2.0 * std::log(2.0)))) {}

    [[nodiscard]] double quantile(double p) const {
        double low = -40.0, high = 0.0;  // the normal distribution function underflows below -38
        for (int i = 0; i < 100; ++i) {
            const double middle = 0.5 * (low + high);
            (0.5 * std::erfc(-middle / std::sqrt(2.0)) < p ? low : high) = middle;
        }
        return 0.5 * (low + high) * sigma_;
    }
    [[nodiscard]] double first_moment(double x) const {
        const double z = x / sigma_;
        return -sigma_ * std::exp(-0.5 * z * z) / std::sqrt(2.0 * kPi);
    }

private:
    double sigma_;
};

/// Centroids of n strata of equal area of a symmetric distribution. The left half is computed and mirrored, so that the
/// points are symmetric to the last bit.
template <class Distribution>
std::vector<double> centroids(const Distribution& distribution, int n) {
    std::vector<double> point(static_cast<std::size_t>(n), 0.0);
    double moment_below = 0.0;
    for (int i = 0; i < n / 2; ++i) {
        const double moment = distribution.first_moment(distribution.quantile((i + 1.0) / n));
        point[static_cast<std::size_t>(i)] = (moment - moment_below) * n;
        point[static_cast<std::size_t>(n - 1 - i)] = -point[static_cast<std::size_t>(i)];
        moment_below = moment;
    }
    return point;
}

/// What `use` makes of the distribution along one axis.
template <class Use>
auto with_distribution(const Psf& psf, Use&& use) {
    if (psf.shape != Psf::Shape::None && !(psf.width_samples > 0.0))
        throw input_error("psf", fmt::format("width {} samples, expected more than 0", psf.width_samples));
    switch (psf.shape) {
        case Psf::Shape::Box:
            return use(TwoBoxes(psf.width_samples, 0.0));
        case Psf::Shape::Triangle:
            return use(TwoBoxes(0.5 * psf.width_samples, 0.5 * psf.width_samples));
        case Psf::Shape::Trapezoid:
            return use(TwoBoxes(psf.width_samples, psf.second_width_samples));
        case Psf::Shape::Gaussian:
            return use(Gaussian(psf.width_samples));
        case Psf::Shape::None:
            break;
    }
    return use(TwoBoxes(1.0, 0.0));
}

std::vector<double> axis_points(const Psf& psf, int n) {
    return with_distribution(psf, [n](const auto& distribution) { return centroids(distribution, n); });
}

void check_count(int n_per_axis) {
    if (n_per_axis < 1)
        throw input_error("samples per pixel axis", fmt::format("found {}, expected at least 1", n_per_axis));
}

}  // namespace

PixelSamples pixel_samples(const Psf& across, const Psf& along, int n_per_axis) {
    check_count(n_per_axis);
    const auto sample = axis_points(across, n_per_axis), line = axis_points(along, n_per_axis);
    PixelSamples points;
    for (const double y : line)
        for (const double x : sample) points.offset.push_back({x, y});
    points.weight.assign(points.offset.size(), 1.0 / static_cast<double>(points.offset.size()));
    return points;
}

PsfShares::PsfShares(const Psf& psf, int base) : base_(base) {
    check_count(base);
    const int n = base << kLevels;
    end_.assign(static_cast<std::size_t>(n) + 1, 0.0);
    moment_below_ = end_;
    with_distribution(psf, [&](const auto& distribution) {
        for (int i = 0; 2 * i <= n; ++i) {  // the right half mirrors the left one
            const auto left = static_cast<std::size_t>(i), right = static_cast<std::size_t>(n - i);
            const double end = 2 * i == n ? 0.0 : distribution.quantile(static_cast<double>(i) / n);
            end_[left] = end;
            end_[right] = -end;
            moment_below_[left] = moment_below_[right] = i == 0 ? 0.0 : distribution.first_moment(end);
        }
    });
}

PsfShares::Share PsfShares::share(int level, int index) const noexcept {
    const auto from = static_cast<std::size_t>(index) << (kLevels - level);
    const auto to = static_cast<std::size_t>(index + 1) << (kLevels - level);
    const double centre = (moment_below_[to] - moment_below_[from]) * std::ldexp(base_, level);
    return {centre, 2.0 * std::min(centre - end_[from], end_[to] - centre)};
}

}  // namespace pyroscene::sensors
