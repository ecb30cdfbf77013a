#include "analysis/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pyroscene::analysis {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::size_t at(int row, int col, int cols) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(col);
}

/// Separable Gaussian filter with zeros beyond the rim.
std::vector<double> smoothed(const std::vector<double>& plane, int cols, int rows) {
    constexpr int kHalf = 5;
    constexpr double kSigma = 1.5;
    std::array<double, 2 * kHalf + 1> window{};
    for (int i = -kHalf; i <= kHalf; ++i)
        window[static_cast<std::size_t>(i + kHalf)] = std::exp(-0.5 * i * i / (kSigma * kSigma));
    std::vector<double> across(plane.size(), 0.0), out(plane.size(), 0.0);
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col)
            for (int i = std::max(-kHalf, -col); i <= std::min(kHalf, cols - 1 - col); ++i)
                across[at(row, col, cols)] += window[static_cast<std::size_t>(i + kHalf)] * plane[at(row, col + i, cols)];
    for (int row = 0; row < rows; ++row)
        for (int i = std::max(-kHalf, -row); i <= std::min(kHalf, rows - 1 - row); ++i)
            for (int col = 0; col < cols; ++col)
                out[at(row, col, cols)] += window[static_cast<std::size_t>(i + kHalf)] * across[at(row + i, col, cols)];
    return out;
}

/// One pass of the exact distance transform: lower envelope of parabolas, squared distances in place with a stride.
void transform(double* f, int n, std::ptrdiff_t stride, std::vector<double>& values, std::vector<int>& places,
               std::vector<double>& bounds) {
    for (int i = 0; i < n; ++i) values[static_cast<std::size_t>(i)] = f[i * stride];
    int k = -1;
    for (int q = 0; q < n; ++q) {
        const double own = values[static_cast<std::size_t>(q)];
        if (own == kInfinity) continue;
        double crossing = -kInfinity;
        while (k >= 0) {
            const int p = places[static_cast<std::size_t>(k)];
            crossing =
                (own + static_cast<double>(q) * q - values[static_cast<std::size_t>(p)] - static_cast<double>(p) * p) /
                (2.0 * (q - p));
            if (crossing > bounds[static_cast<std::size_t>(k)]) break;
            --k;
            crossing = -kInfinity;
        }
        ++k;
        places[static_cast<std::size_t>(k)] = q;
        bounds[static_cast<std::size_t>(k)] = crossing;
    }
    if (k < 0) return;
    const int last = k;
    k = 0;
    for (int i = 0; i < n; ++i) {
        while (k < last && bounds[static_cast<std::size_t>(k + 1)] < i) ++k;
        const int p = places[static_cast<std::size_t>(k)];
        f[i * stride] = static_cast<double>(i - p) * (i - p) + values[static_cast<std::size_t>(p)];
    }
}

/// Pixels of a mask with a neighbour (by an edge) outside it; the rim of the image is no outline.
std::vector<unsigned char> outline(std::span<const unsigned char> mask, int cols, int rows) {
    std::vector<unsigned char> out(mask.size(), 0);
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < cols; ++col) {
            if (mask[at(row, col, cols)] == 0) continue;
            const bool inside =
                (row == 0 || mask[at(row - 1, col, cols)] != 0) && (row + 1 == rows || mask[at(row + 1, col, cols)] != 0) &&
                (col == 0 || mask[at(row, col - 1, cols)] != 0) && (col + 1 == cols || mask[at(row, col + 1, cols)] != 0);
            out[at(row, col, cols)] = inside ? 0 : 1;
        }
    }
    return out;
}

}  // namespace

double structural_similarity(std::span<const float> a, std::span<const float> b, int cols, int rows) {
    std::vector<double> weight(a.size(), 0.0), x(a.size(), 0.0), y(a.size(), 0.0);
    double low = kInfinity, high = -kInfinity;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (!std::isfinite(a[i]) || !std::isfinite(b[i])) continue;
        weight[i] = 1.0;
        x[i] = static_cast<double>(a[i]);
        y[i] = static_cast<double>(b[i]);
        low = std::min({low, x[i], y[i]});
        high = std::max({high, x[i], y[i]});
    }
    if (!(high >= low)) return std::numeric_limits<double>::quiet_NaN();
    const auto product = [](const std::vector<double>& p, const std::vector<double>& q) {
        std::vector<double> out(p.size());
        for (std::size_t i = 0; i < p.size(); ++i) out[i] = p[i] * q[i];
        return out;
    };
    const auto w = smoothed(weight, cols, rows), mx = smoothed(x, cols, rows), my = smoothed(y, cols, rows);
    const auto xx = smoothed(product(x, x), cols, rows), yy = smoothed(product(y, y), cols, rows),
               xy = smoothed(product(x, y), cols, rows);
    const double range = high > low ? high - low : 1.0, c1 = std::pow(0.01 * range, 2.0), c2 = std::pow(0.03 * range, 2.0);
    double sum = 0.0;
    std::int64_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (weight[i] == 0.0) continue;
        const double ux = mx[i] / w[i], uy = my[i] / w[i];
        const double vx = std::max(xx[i] / w[i] - ux * ux, 0.0), vy = std::max(yy[i] / w[i] - uy * uy, 0.0),
                     cov = xy[i] / w[i] - ux * uy;
        sum += (2.0 * ux * uy + c1) * (2.0 * cov + c2) / ((ux * ux + uy * uy + c1) * (vx + vy + c2));
        ++count;
    }
    return sum / static_cast<double>(count);
}

PlaneAgreement agreement(std::span<const float> a, std::span<const float> b, int cols, int rows) {
    PlaneAgreement out;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double x = static_cast<double>(a[i]), y = static_cast<double>(b[i]);
        if (!std::isfinite(x) || !std::isfinite(y)) continue;
        ++out.pixels;
        out.mean_a += x;
        out.mean_b += y;
        out.rmse += (x - y) * (x - y);
        out.mae += std::abs(x - y);
    }
    if (out.pixels == 0) return out;
    const auto n = static_cast<double>(out.pixels);
    out.mean_a /= n;
    out.mean_b /= n;
    out.bias = out.mean_a - out.mean_b;
    out.rmse = std::sqrt(out.rmse / n);
    out.mae /= n;
    double xx = 0.0, yy = 0.0, xy = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double x = static_cast<double>(a[i]) - out.mean_a, y = static_cast<double>(b[i]) - out.mean_b;
        if (!std::isfinite(x) || !std::isfinite(y)) continue;
        xx += x * x;
        yy += y * y;
        xy += x * y;
    }
    if (xx > 0.0 && yy > 0.0) out.correlation = xy / std::sqrt(xx * yy);
    out.ssim = structural_similarity(a, b, cols, rows);
    return out;
}

std::vector<float> distance_from(std::span<const unsigned char> mask, int cols, int rows) {
    std::vector<double> squared(mask.size());
    for (std::size_t i = 0; i < mask.size(); ++i) squared[i] = mask[i] != 0 ? 0.0 : kInfinity;
    const auto longest = static_cast<std::size_t>(std::max(cols, rows));
    std::vector<double> values(longest), bounds(longest);
    std::vector<int> places(longest);
    for (int col = 0; col < cols; ++col) transform(squared.data() + col, rows, cols, values, places, bounds);
    for (int row = 0; row < rows; ++row) transform(squared.data() + at(row, 0, cols), cols, 1, values, places, bounds);
    std::vector<float> out(mask.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<float>(std::sqrt(squared[i]));
    return out;
}

MaskAgreement mask_agreement(std::span<const unsigned char> a, std::span<const unsigned char> b, int cols, int rows) {
    MaskAgreement out;
    for (std::size_t i = 0; i < a.size(); ++i) {
        out.both += a[i] != 0 && b[i] != 0 ? 1 : 0;
        out.only_a += a[i] != 0 && b[i] == 0 ? 1 : 0;
        out.only_b += a[i] == 0 && b[i] != 0 ? 1 : 0;
    }
    const auto all = static_cast<double>(2 * out.both + out.only_a + out.only_b);
    out.dice = all > 0.0 ? 2.0 * static_cast<double>(out.both) / all : 1.0;
    const auto outline_a = outline(a, cols, rows), outline_b = outline(b, cols, rows);
    const auto from_a = distance_from(outline_a, cols, rows), from_b = distance_from(outline_b, cols, rows);
    std::vector<double> distances;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (outline_a[i] != 0) distances.push_back(static_cast<double>(from_b[i]));
        if (outline_b[i] != 0) distances.push_back(static_cast<double>(from_a[i]));
    }
    out.front_distance_mean = out.front_distance_95 = std::numeric_limits<double>::quiet_NaN();
    if (distances.empty() || !std::all_of(distances.begin(), distances.end(), [](double d) { return std::isfinite(d); }))
        return out;
    double sum = 0.0;
    for (const double d : distances) sum += d;
    out.front_distance_mean = sum / static_cast<double>(distances.size());
    const auto rank = distances.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(distances.size() - 1));
    std::nth_element(distances.begin(), rank, distances.end());
    out.front_distance_95 = *rank;
    return out;
}

std::vector<float> shifted(std::span<const float> plane, int cols, int rows, double dx, double dy) {
    std::vector<float> out(plane.size(), std::numeric_limits<float>::quiet_NaN());
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < cols; ++col) {
            const double x = col - dx, y = row - dy;
            if (!(x >= 0.0 && x <= cols - 1 && y >= 0.0 && y <= rows - 1)) continue;
            const int c = std::min(static_cast<int>(x), std::max(cols - 2, 0)),
                      r = std::min(static_cast<int>(y), std::max(rows - 2, 0));
            const double fx = x - c, fy = y - r;
            double sum = 0.0;
            for (int j = 0; j < 2; ++j) {
                for (int i = 0; i < 2; ++i) {
                    const double weight = (i != 0 ? fx : 1.0 - fx) * (j != 0 ? fy : 1.0 - fy);
                    if (weight > 0.0) sum += weight * static_cast<double>(plane[at(r + j, c + i, cols)]);
                }
            }
            out[at(row, col, cols)] = static_cast<float>(sum);
        }
    }
    return out;
}

}  // namespace pyroscene::analysis
