#include "analysis/mixed_pixel.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace pyroscene::analysis {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

MixedPixel::MixedPixel(const UnmixTables& shared, const Coordinates& z, double length2)
    : s_(shared), z_(z), length2_(length2) {
    double inside = 0.0;
    for (int i = 0; i < s_.k; ++i) inside += z_[static_cast<std::size_t>(i)] * z_[static_cast<std::size_t>(i)];
    outside_ = std::max(length2 - inside, 0.0);
    inside_ = inside;
}

std::uint32_t MixedPixel::select() {
    std::uint32_t subset = s_.everything();
    for (int move = 0; move < 2 * s_.k; ++move) {
        const std::uint32_t before = subset;
        if (std::popcount(subset) > 1) subset = without_the_weakest(subset);
        if (subset != s_.everything()) subset = with_the_strongest(subset);
        if (subset == before) break;
    }
    return subset;
}

void MixedPixel::fractions(LeastSquares solver, std::uint32_t& subset, Coordinates& a) {
    switch (solver) {
        case LeastSquares::Unconstrained:
            free(subset, a);
            break;
        case LeastSquares::SumToOne:
            sum_to_one(subset, a);
            break;
        case LeastSquares::NonNegative:
            non_negative(subset, a);
            break;
        case LeastSquares::FullyConstrained:
            fully_constrained(subset, a);
            break;
    }
}

double MixedPixel::squared_error(const Coordinates& a) const {
    const Coordinates rest = residual(a);
    double sum = outside_;
    for (int i = 0; i < s_.k; ++i) sum += rest[static_cast<std::size_t>(i)] * rest[static_cast<std::size_t>(i)];
    return sum;
}

double MixedPixel::unexplained(double explained) const { return outside_ + std::max(inside_ - explained, 0.0); }

double MixedPixel::f(double gain, double error, int degrees) const {
    if (gain <= 1e-14 * length2_) return 0.0;
    return error > 0.0 ? gain / (error / degrees) : kInfinity;
}

std::uint32_t MixedPixel::without_the_weakest(std::uint32_t subset) {
    const SubsetFactor& factor = s_.factor(subset, scratch_);
    Coordinates y, a;
    const double error = unexplained(project(factor, s_.k, z_, y));
    solve(factor, y, a);
    double least = kInfinity;
    int weakest = -1;
    for (int i = 0; i < factor.size; ++i) {
        const auto n = static_cast<std::size_t>(i);
        const double of_member = f(a[n] * a[n] / factor.variance[n], error, s_.l - factor.size);
        if (of_member >= least) continue;
        least = of_member;
        weakest = factor.members[n];
    }
    const bool leaves = weakest >= 0 && least < s_.f_remove[static_cast<std::size_t>(factor.size)];
    return leaves ? subset & ~(1U << weakest) : subset;
}

std::uint32_t MixedPixel::with_the_strongest(std::uint32_t subset) {
    Coordinates y;
    const double explained = project(s_.factor(subset, scratch_), s_.k, z_, y);
    const int size = std::popcount(subset) + 1;
    double most = 0.0;
    int strongest = -1;
    for (int j = 0; j < s_.k; ++j) {
        if ((subset >> j & 1U) != 0) continue;
        const double with = project(s_.factor(subset | 1U << j, scratch_), s_.k, z_, y);
        const double of_member = f(with - explained, unexplained(with), s_.l - size);
        if (of_member <= most) continue;
        most = of_member;
        strongest = j;
    }
    const bool enters = strongest >= 0 && most > s_.f_enter[static_cast<std::size_t>(size)];
    return enters ? subset | 1U << strongest : subset;
}

void MixedPixel::scatter(const SubsetFactor& factor, const Coordinates& of_subset, Coordinates& a) const {
    std::fill_n(a.begin(), s_.k, 0.0);
    for (int i = 0; i < factor.size; ++i)
        a[static_cast<std::size_t>(factor.members[static_cast<std::size_t>(i)])] = of_subset[static_cast<std::size_t>(i)];
}

void MixedPixel::free(std::uint32_t subset, Coordinates& a) {
    const SubsetFactor& factor = s_.factor(subset, scratch_);
    Coordinates y, of_subset;
    project(factor, s_.k, z_, y);
    solve(factor, y, of_subset);
    scatter(factor, of_subset, a);
}

void MixedPixel::sum_to_one(std::uint32_t subset, Coordinates& a) {
    const SubsetFactor& factor = s_.factor(subset, scratch_);
    const int n = factor.size;
    Coordinates y, of_subset, h{}, g;
    project(factor, s_.k, z_, y);
    solve(factor, y, of_subset);
    for (int col = 0; col < n; ++col)
        for (int row = 0; row <= col; ++row)
            h[static_cast<std::size_t>(col)] += factor.inverse[static_cast<std::size_t>(row * n + col)];
    solve(factor, h, g);
    double sum = 0.0, sum_g = 0.0;
    for (int i = 0; i < n; ++i) {
        sum += of_subset[static_cast<std::size_t>(i)];
        sum_g += g[static_cast<std::size_t>(i)];
    }
    for (int i = 0; i < n; ++i)
        of_subset[static_cast<std::size_t>(i)] += g[static_cast<std::size_t>(i)] * (1.0 - sum) / sum_g;
    scatter(factor, of_subset, a);
}

Coordinates MixedPixel::residual(const Coordinates& a) const {
    Coordinates rest{};
    for (int i = 0; i < s_.k; ++i) {
        double sum = z_[static_cast<std::size_t>(i)];
        for (int j = i; j < s_.k; ++j) sum -= s_.r[static_cast<std::size_t>(i * s_.k + j)] * a[static_cast<std::size_t>(j)];
        rest[static_cast<std::size_t>(i)] = sum;
    }
    return rest;
}

double MixedPixel::gradient(int j, const Coordinates& rest) const {
    double sum = 0.0;
    for (int i = 0; i <= j; ++i) sum += s_.r[static_cast<std::size_t>(i * s_.k + j)] * rest[static_cast<std::size_t>(i)];
    return sum;
}

template <class Solve>
void MixedPixel::move_inside(std::uint32_t& active, Coordinates& a, Solve&& solve_on) {
    while (active != 0) {
        Coordinates goal{};
        solve_on(active, goal);
        double step = 1.0;
        int first = -1;
        for (int j = 0; j < s_.k; ++j) {
            const auto n = static_cast<std::size_t>(j);
            if ((active >> j & 1U) == 0 || goal[n] > 0.0) continue;
            const double way = a[n] - goal[n], reach = way > 0.0 ? a[n] / way : 0.0;
            if (first >= 0 && reach >= step) continue;
            step = reach;
            first = j;
        }
        if (first < 0) {
            a = goal;
            return;
        }
        for (int j = 0; j < s_.k; ++j) {
            const auto n = static_cast<std::size_t>(j);
            a[n] += step * (goal[n] - a[n]);
        }
        a[static_cast<std::size_t>(first)] = 0.0;
        active &= ~(1U << first);
    }
}

void MixedPixel::non_negative(std::uint32_t& subset, Coordinates& a) {
    const std::uint32_t allowed = subset;
    std::uint32_t active = 0;
    std::fill_n(a.begin(), s_.k, 0.0);
    for (int round = 0; round < 3 * s_.k; ++round) {
        const int next = steepest(allowed & ~active, a, 0.0);
        if (next < 0) break;
        active |= 1U << next;
        move_inside(active, a, [&](std::uint32_t on, Coordinates& goal) { free(on, goal); });
        if ((active >> next & 1U) == 0) break;  // rounding: the member that entered left at once
    }
    subset = active;
}

void MixedPixel::fully_constrained(std::uint32_t& subset, Coordinates& a) {
    const std::uint32_t allowed = subset;
    double least = kInfinity;
    std::uint32_t active = 0;
    for (int j = 0; j < s_.k; ++j) {
        if ((allowed >> j & 1U) == 0) continue;
        Coordinates alone{};
        alone[static_cast<std::size_t>(j)] = 1.0;
        const double error = squared_error(alone);
        if (error >= least) continue;
        least = error;
        a = alone;
        active = 1U << j;
    }
    for (int round = 0; round < 3 * s_.k; ++round) {
        // In the optimum all members in use have the same gradient, the multiplier of the sum.
        const double multiplier = gradient(std::countr_zero(active), residual(a));
        const int next = steepest(allowed & ~active, a, multiplier);
        if (next < 0) break;
        active |= 1U << next;
        move_inside(active, a, [&](std::uint32_t on, Coordinates& goal) { sum_to_one(on, goal); });
        if ((active >> next & 1U) == 0) break;
    }
    subset = active;
}

int MixedPixel::steepest(std::uint32_t among, const Coordinates& a, double level) const {
    const Coordinates rest = residual(a);
    double most = 0.0;
    int found = -1;
    for (int j = 0; j < s_.k; ++j) {
        if ((among >> j & 1U) == 0) continue;
        double norm2 = 0.0;
        for (int i = 0; i <= j; ++i) {
            const double r = s_.r[static_cast<std::size_t>(i * s_.k + j)];
            norm2 += r * r;
        }
        const double above = (gradient(j, rest) - level) / std::sqrt(norm2 * std::max(length2_, 1e-300));
        if (above <= std::max(most, 1e-12)) continue;
        most = above;
        found = j;
    }
    return found;
}

}  // namespace pyroscene::analysis
