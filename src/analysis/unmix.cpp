#include "analysis/unmix.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>

#include "analysis/mixed_pixel.h"
#include "base/error.h"

namespace pyroscene::analysis {
namespace {

constexpr int kMostCached = 10;
constexpr int kChunk = 256;  ///< pixels whose coordinates are computed together
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

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
            MixedPixel pixel(s, of_pixel, x2);
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
