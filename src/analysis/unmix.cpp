#include "analysis/unmix.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>

#include "analysis/least_squares.h"
#include "base/error.h"

namespace pyroscene::analysis {
namespace {

constexpr int kMostCached = 10;
constexpr int kChunk = 256;  ///< pixels whose coordinates are computed together
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void check(const Endmembers& library, const UnmixSettings& s) {
    const int k = library.count(), l = library.bands;
    const auto require = [](bool holds, const std::string& message) {
        if (!holds) throw input_error("endmembers", message);
    };
    require(k >= 1 && k <= kMostEndmembers, fmt::format("{} spectra, expected 1 to {}", k, kMostEndmembers));
    require(l > k, fmt::format("{} bands for {} spectra, expected more bands than spectra", l, k));
    require(library.spectra.size() == static_cast<std::size_t>(k) * static_cast<std::size_t>(l),
            "spectra and bands do not fit together");
    for (int j = 0; j < k; ++j) {
        const double* spectrum = library.spectrum(j);
        require(std::all_of(spectrum, spectrum + l, [](double v) { return std::isfinite(v); }),
                fmt::format("'{}' holds a value that is not finite", library.names[static_cast<std::size_t>(j)]));
    }
    require(s.noise.empty() || s.noise.size() == static_cast<std::size_t>(l),
            fmt::format("noise of {} bands, expected {}", s.noise.size(), l));
    require(std::all_of(s.noise.begin(), s.noise.end(), [](double n) { return n > 0.0 && std::isfinite(n); }),
            "noise must be above 0");
    require(
        s.alpha_enter > 0.0 && s.alpha_enter <= s.alpha_remove && s.alpha_remove < 1.0,
        fmt::format("alpha to enter {} and to leave {}, expected 0 < enter <= leave < 1", s.alpha_enter, s.alpha_remove));
}

/// Everything that all pixels share.
struct UnmixTables {
    UnmixSettings settings;
    int k = 0, l = 0;
    std::vector<double> r;                  ///< [k][k] triangular factor of the weighted library
    std::vector<double> q;                  ///< [k][band], weights included: z = q x
    std::vector<double> weight;             ///< [band] 1 / noise, or 1
    std::vector<double> f_enter, f_remove;  ///< [size of the subset that is tested with its member]
    std::vector<double> chi2;               ///< [size of the subset] flagged above, with noise
    std::vector<SubsetFactor> cache;

    [[nodiscard]] std::uint32_t everything() const noexcept { return (1U << k) - 1U; }
    const SubsetFactor& factor(std::uint32_t subset, SubsetFactor& scratch) const {
        if (!cache.empty()) return cache[subset];
        return scratch = factor_subset(r, k, subset);
    }
};

/// One pixel in the coordinates of the library.
class Pixel {
public:
    Pixel(const UnmixTables& shared, const Coordinates& z, double length2) : s_(shared), z_(z), length2_(length2) {
        double inside = 0.0;
        for (int i = 0; i < s_.k; ++i) inside += z_[static_cast<std::size_t>(i)] * z_[static_cast<std::size_t>(i)];
        outside_ = std::max(length2 - inside, 0.0);
        inside_ = inside;
    }

    /// Stepwise selection; returns the subset that remains.
    std::uint32_t select() {
        std::uint32_t subset = s_.everything();
        for (int move = 0; move < 2 * s_.k; ++move) {
            const std::uint32_t before = subset;
            if (std::popcount(subset) > 1) subset = without_the_weakest(subset);
            if (subset != s_.everything()) subset = with_the_strongest(subset);
            if (subset == before) break;
        }
        return subset;
    }

    /// Fractions of a subset by one of the solvers; zero elsewhere. Narrows `subset` to the members in use.
    void fractions(LeastSquares solver, std::uint32_t& subset, Coordinates& a) {
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

    /// Sum of squared residuals of any fractions.
    [[nodiscard]] double squared_error(const Coordinates& a) const {
        const Coordinates rest = residual(a);
        double sum = outside_;
        for (int i = 0; i < s_.k; ++i) sum += rest[static_cast<std::size_t>(i)] * rest[static_cast<std::size_t>(i)];
        return sum;
    }

private:
    [[nodiscard]] double unexplained(double explained) const { return outside_ + std::max(inside_ - explained, 0.0); }
    /// F of one degree of freedom against the rest; rounding of the spectrum's length is no evidence.
    [[nodiscard]] double f(double gain, double error, int degrees) const {
        if (gain <= 1e-14 * length2_) return 0.0;
        return error > 0.0 ? gain / (error / degrees) : kInfinity;
    }

    std::uint32_t without_the_weakest(std::uint32_t subset) {
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

    std::uint32_t with_the_strongest(std::uint32_t subset) {
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

    void scatter(const SubsetFactor& factor, const Coordinates& of_subset, Coordinates& a) const {
        std::fill_n(a.begin(), s_.k, 0.0);
        for (int i = 0; i < factor.size; ++i)
            a[static_cast<std::size_t>(factor.members[static_cast<std::size_t>(i)])] =
                of_subset[static_cast<std::size_t>(i)];
    }

    void free(std::uint32_t subset, Coordinates& a) {
        const SubsetFactor& factor = s_.factor(subset, scratch_);
        Coordinates y, of_subset;
        project(factor, s_.k, z_, y);
        solve(factor, y, of_subset);
        scatter(factor, of_subset, a);
    }

    /// Least squares with sum one: a + G 1 (1 - 1'a) / (1'G 1), G = T^-1 T^-T.
    void sum_to_one(std::uint32_t subset, Coordinates& a) {
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

    [[nodiscard]] Coordinates residual(const Coordinates& a) const {
        Coordinates rest{};
        for (int i = 0; i < s_.k; ++i) {
            double sum = z_[static_cast<std::size_t>(i)];
            for (int j = i; j < s_.k; ++j)
                sum -= s_.r[static_cast<std::size_t>(i * s_.k + j)] * a[static_cast<std::size_t>(j)];
            rest[static_cast<std::size_t>(i)] = sum;
        }
        return rest;
    }

    /// Correlation of a member's spectrum with the residual.
    [[nodiscard]] double gradient(int j, const Coordinates& rest) const {
        double sum = 0.0;
        for (int i = 0; i <= j; ++i) sum += s_.r[static_cast<std::size_t>(i * s_.k + j)] * rest[static_cast<std::size_t>(i)];
        return sum;
    }

    /// Moves `a` towards the solution on `active` until a member reaches zero; that one leaves. Repeats until none does.
    template <class Solve>
    void move_inside(std::uint32_t& active, Coordinates& a, Solve&& solve_on) {
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

    /// Lawson and Hanson 1974, chapter 23.
    void non_negative(std::uint32_t& subset, Coordinates& a) {
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

    /// The same with sum one: starts from the member that alone fits best.
    void fully_constrained(std::uint32_t& subset, Coordinates& a) {
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

    /// Member with the largest gradient above a level; -1 when none stands out of the rounding.
    [[nodiscard]] int steepest(std::uint32_t among, const Coordinates& a, double level) const {
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

    const UnmixTables& s_;
    const Coordinates& z_;
    double length2_, inside_ = 0.0, outside_ = 0.0;
    SubsetFactor scratch_;
};

}  // namespace

double f_threshold(double alpha, int degrees) {
    return boost::math::quantile(boost::math::complement(boost::math::fisher_f(1.0, degrees), alpha));
}

struct Unmixer::Impl : UnmixTables {};

Unmixer::Unmixer(const Endmembers& library, const UnmixSettings& settings) : impl_(std::make_unique<Impl>()) {
    check(library, settings);
    UnmixTables& s = *impl_;
    s.settings = settings;
    s.k = library.count();
    s.l = library.bands;
    for (int b = 0; b < s.l; ++b)
        s.weight.push_back(settings.noise.empty() ? 1.0 : 1.0 / settings.noise[static_cast<std::size_t>(b)]);
    std::vector<double> columns = library.spectra;
    for (std::size_t i = 0; i < columns.size(); ++i) columns[i] *= s.weight[i % static_cast<std::size_t>(s.l)];
    TallFactor tall = factor_tall(columns, s.k, s.l);
    for (int j = 0; j < s.k; ++j) {
        double norm2 = 0.0;
        for (int i = 0; i <= j; ++i) norm2 += std::pow(tall.r[static_cast<std::size_t>(i * s.k + j)], 2.0);
        if (!(tall.r[static_cast<std::size_t>(j * s.k + j)] > 1e-10 * std::sqrt(norm2)))
            throw input_error("endmembers", fmt::format("'{}' is a mixture of the spectra before it, or zero",
                                                        library.names[static_cast<std::size_t>(j)]));
    }
    s.r = std::move(tall.r);
    s.q = std::move(tall.q);
    for (std::size_t i = 0; i < s.q.size(); ++i) s.q[i] *= s.weight[i % static_cast<std::size_t>(s.l)];
    s.f_enter.push_back(0.0);
    s.f_remove.push_back(0.0);
    s.chi2.push_back(0.0);
    for (int size = 1; size <= s.k; ++size) {
        s.f_enter.push_back(f_threshold(settings.alpha_enter, s.l - size));
        s.f_remove.push_back(f_threshold(settings.alpha_remove, s.l - size));
        s.chi2.push_back(boost::math::quantile(
            boost::math::complement(boost::math::chi_squared(s.l - size), settings.unexplained_alpha)));
    }
    if (s.k > kMostCached) return;
    s.cache.resize(std::size_t{1} << s.k);
    for (std::uint32_t subset = 1; subset < s.cache.size(); ++subset) s.cache[subset] = factor_subset(s.r, s.k, subset);
}

Unmixer::~Unmixer() = default;
Unmixer::Unmixer(Unmixer&&) noexcept = default;
int Unmixer::endmembers() const noexcept { return impl_->k; }
int Unmixer::bands() const noexcept { return impl_->l; }

void Unmixer::unmix(const float* pixels, std::ptrdiff_t stride, int count, const UnmixOutput& out) const {
    const UnmixTables& s = *impl_;
    std::vector<double> z(static_cast<std::size_t>(s.k) * kChunk);
    std::array<double, kChunk> length2{};
    for (int first = 0; first < count; first += kChunk) {
        const int n = std::min(kChunk, count - first);
        std::fill(z.begin(), z.end(), 0.0);
        length2.fill(0.0);
        for (int b = 0; b < s.l; ++b) {
            const float* x = pixels + b * stride + first;
            const double w2 = s.weight[static_cast<std::size_t>(b)] * s.weight[static_cast<std::size_t>(b)];
            for (int p = 0; p < n; ++p)
                length2[static_cast<std::size_t>(p)] += w2 * static_cast<double>(x[p]) * static_cast<double>(x[p]);
            for (int j = 0; j < s.k; ++j) {
                const double q =
                    s.q[static_cast<std::size_t>(j) * static_cast<std::size_t>(s.l) + static_cast<std::size_t>(b)];
                double* row = z.data() + static_cast<std::ptrdiff_t>(j) * kChunk;
                for (int p = 0; p < n; ++p) row[p] += q * static_cast<double>(x[p]);
            }
        }
        for (int p = 0; p < n; ++p) {
            const auto at = static_cast<std::size_t>(first + p);
            const auto fraction = [&](int j) -> float& {
                return out.fractions[static_cast<std::size_t>(j) * static_cast<std::size_t>(count) + at];
            };
            const double x2 = length2[static_cast<std::size_t>(p)];
            if (!std::isfinite(x2)) {
                for (int j = 0; j < s.k; ++j) fraction(j) = kNaN;
                out.residual_rms[at] = out.chosen[at] = out.unexplained[at] = kNaN;
                continue;
            }
            Coordinates of_pixel, a{};
            for (int j = 0; j < s.k; ++j)
                of_pixel[static_cast<std::size_t>(j)] =
                    z[static_cast<std::size_t>(j) * kChunk + static_cast<std::size_t>(p)];
            Pixel pixel(s, of_pixel, x2);
            std::uint32_t subset = s.settings.stepwise ? pixel.select() : s.everything();
            pixel.fractions(s.settings.solver, subset, a);
            const double error = pixel.squared_error(a);
            for (int j = 0; j < s.k; ++j) fraction(j) = static_cast<float>(a[static_cast<std::size_t>(j)]);
            out.residual_rms[at] = static_cast<float>(std::sqrt(error / s.l));
            out.chosen[at] = static_cast<float>(subset);
            const bool unexplained = s.settings.noise.empty()
                                         ? std::sqrt(error) > s.settings.unexplained_relative * std::sqrt(x2)
                                         : error > s.chi2[static_cast<std::size_t>(std::popcount(subset))];
            out.unexplained[at] = unexplained ? 1.0F : 0.0F;
        }
    }
}

}  // namespace pyroscene::analysis
