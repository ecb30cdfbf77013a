#include "analysis/rpc.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/least_squares.h"
#include "base/error.h"

namespace pyroscene::analysis {
namespace {

constexpr std::size_t kTerms = 20;
constexpr std::size_t kUnknowns = 2 * kTerms - 1;
using Terms = std::array<double, kTerms>;

/// Monomials in the order of RPC00B: L longitude, P latitude, H height.
Terms monomials(const RationalCamera& c, double lat_deg, double lon_deg, double h_m) noexcept {
    const double P = (lat_deg - c.lat_deg.offset) / c.lat_deg.scale, L = (lon_deg - c.lon_deg.offset) / c.lon_deg.scale,
                 H = (h_m - c.h_m.offset) / c.h_m.scale;
    return {1.0,       L,         P,         H,         L * P,     L * H,     P * H,     L * L,     P * P,     H * H,
            P * L * H, L * L * L, L * P * P, L * H * H, L * L * P, P * P * P, P * H * H, L * L * H, P * P * H, H * H * H};
}

double dot(const Terms& a, const Terms& b) noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < kTerms; ++i) sum += a[i] * b[i];
    return sum;
}

template <class Get>
RationalCamera::Range range_of(std::span<const GroundTie> ties, const Get& get) {
    double low = get(ties.front()), high = low;
    for (const auto& tie : ties) low = std::min(low, get(tie)), high = std::max(high, get(tie));
    return {0.5 * (low + high), std::max(0.5 * (high - low), 1e-9)};
}

/// Numerator and denominator of one image axis: numerator - value * (denominator - 1) = value, each row divided by the
/// denominator of the round before.
void fit_axis(const std::vector<Terms>& terms, const std::vector<double>& value, Terms& numerator, Terms& denominator) {
    constexpr int kRounds = 4;
    constexpr double kRidge = 1e-7;
    const std::size_t rows = terms.size() + kUnknowns;
    denominator = {1.0};
    for (int round = 0; round < kRounds; ++round) {
        std::vector<double> columns(kUnknowns * rows, 0.0), right(rows, 0.0);
        for (std::size_t i = 0; i < terms.size(); ++i) {
            const double weight = 1.0 / dot(terms[i], denominator);
            for (std::size_t t = 0; t < kTerms; ++t) columns[t * rows + i] = weight * terms[i][t];
            for (std::size_t t = 1; t < kTerms; ++t) columns[(kTerms + t - 1) * rows + i] = -weight * value[i] * terms[i][t];
            right[i] = weight * value[i];
        }
        for (std::size_t u = 0; u < kUnknowns; ++u)
            columns[u * rows + terms.size() + u] = kRidge * std::sqrt(static_cast<double>(terms.size()));
        const auto qr = factor_tall(columns, static_cast<int>(kUnknowns), static_cast<int>(rows));
        std::array<double, kUnknowns> x{};
        for (std::size_t u = kUnknowns; u-- > 0;) {
            double sum = 0.0;
            for (std::size_t i = 0; i < rows; ++i) sum += qr.q[u * rows + i] * right[i];
            for (std::size_t v = u + 1; v < kUnknowns; ++v) sum -= qr.r[u * kUnknowns + v] * x[v];
            x[u] = sum / qr.r[u * kUnknowns + u];
        }
        std::copy_n(x.begin(), kTerms, numerator.begin());
        std::copy(x.begin() + kTerms, x.end(), denominator.begin() + 1);
    }
}

}  // namespace

std::array<double, 2> project(const RationalCamera& c, double lat_deg, double lon_deg, double h_m) noexcept {
    const Terms t = monomials(c, lat_deg, lon_deg, h_m);
    return {c.sample.offset + c.sample.scale * dot(t, c.sample_numerator) / dot(t, c.sample_denominator),
            c.line.offset + c.line.scale * dot(t, c.line_numerator) / dot(t, c.line_denominator)};
}

RationalCamera fit_rational_camera(std::span<const GroundTie> ties) {
    if (ties.size() < kUnknowns)
        throw input_error("RPC", fmt::format("{} ties of image and ground, expected {} or more", ties.size(), kUnknowns));
    RationalCamera c;
    c.line = range_of(ties, [](const GroundTie& t) { return t.line; });
    c.sample = range_of(ties, [](const GroundTie& t) { return t.sample; });
    c.lat_deg = range_of(ties, [](const GroundTie& t) { return t.lat_deg; });
    c.lon_deg = range_of(ties, [](const GroundTie& t) { return t.lon_deg; });
    c.h_m = range_of(ties, [](const GroundTie& t) { return t.h_m; });
    std::vector<Terms> terms;
    std::vector<double> line, sample;
    for (const auto& tie : ties) {
        terms.push_back(monomials(c, tie.lat_deg, tie.lon_deg, tie.h_m));
        line.push_back((tie.line - c.line.offset) / c.line.scale);
        sample.push_back((tie.sample - c.sample.offset) / c.sample.scale);
    }
    fit_axis(terms, line, c.line_numerator, c.line_denominator);
    fit_axis(terms, sample, c.sample_numerator, c.sample_denominator);
    return c;
}

double largest_residual_px(const RationalCamera& camera, std::span<const GroundTie> ties) noexcept {
    double largest = 0.0;
    for (const auto& tie : ties) {
        const auto [sample, line] = project(camera, tie.lat_deg, tie.lon_deg, tie.h_m);
        largest = std::max(largest, std::hypot(sample - tie.sample, line - tie.line));
    }
    return largest;
}

std::vector<std::array<std::string, 2>> rpc_metadata(const RationalCamera& c, double residual_px) {
    std::vector<std::array<std::string, 2>> out{{"ERR_BIAS", "0"}, {"ERR_RAND", fmt::format("{:.3g}", residual_px)}};
    const auto range = [&](const std::string& name, const RationalCamera::Range& r) {
        out.push_back({name + "_OFF", fmt::format("{:.12g}", r.offset)});
        out.push_back({name + "_SCALE", fmt::format("{:.12g}", r.scale)});
    };
    range("LINE", c.line);
    range("SAMP", c.sample);
    range("LAT", c.lat_deg);
    range("LONG", c.lon_deg);
    range("HEIGHT", c.h_m);
    out.push_back({"LINE_NUM_COEFF", fmt::format("{:.15g}", fmt::join(c.line_numerator, " "))});
    out.push_back({"LINE_DEN_COEFF", fmt::format("{:.15g}", fmt::join(c.line_denominator, " "))});
    out.push_back({"SAMP_NUM_COEFF", fmt::format("{:.15g}", fmt::join(c.sample_numerator, " "))});
    out.push_back({"SAMP_DEN_COEFF", fmt::format("{:.15g}", fmt::join(c.sample_denominator, " "))});
    return out;
}

}  // namespace pyroscene::analysis
