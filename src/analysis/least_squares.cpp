#include "analysis/least_squares.h"

#include <cmath>
#include <cstddef>

namespace pyroscene::analysis {
namespace {

std::size_t at(int row, int col, int cols) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(col);
}

double dot(const double* a, const double* b, int n) {
    double sum = 0.0;
    for (int i = 0; i < n; ++i) sum += a[i] * b[i];
    return sum;
}

/// Orthonormalises the n vectors of length m in place (Gram-Schmidt, twice: as good as Householder) and fills the n x n
/// triangular factor, row major.
void orthonormalise(std::vector<double>& vectors, int n, int m, std::vector<double>& triangle) {
    triangle.assign(at(n, 0, n), 0.0);
    for (int j = 0; j < n; ++j) {
        double* v = vectors.data() + at(j, 0, m);
        for (int pass = 0; pass < 2; ++pass) {
            for (int i = 0; i < j; ++i) {
                const double* q = vectors.data() + at(i, 0, m);
                const double share = dot(q, v, m);
                triangle[at(i, j, n)] += share;
                for (int b = 0; b < m; ++b) v[b] -= share * q[b];
            }
        }
        const double norm = std::sqrt(dot(v, v, m));
        triangle[at(j, j, n)] = norm;
        for (int b = 0; norm > 0.0 && b < m; ++b) v[b] /= norm;
    }
}

}  // namespace

SubsetFactor factor_subset(const std::vector<double>& r, int k, std::uint32_t subset) {
    SubsetFactor f;
    for (int j = 0; j < k; ++j) {
        if ((subset >> j & 1U) == 0) continue;
        f.members[static_cast<std::size_t>(f.size++)] = static_cast<std::uint8_t>(j);
        for (int i = 0; i < k; ++i) f.basis.push_back(r[at(i, j, k)]);
    }
    const int n = f.size;
    std::vector<double> t;
    orthonormalise(f.basis, n, k, t);
    f.inverse.assign(at(n, 0, n), 0.0);
    for (int col = 0; col < n; ++col) {
        f.inverse[at(col, col, n)] = 1.0 / t[at(col, col, n)];
        for (int row = col - 1; row >= 0; --row) {
            double sum = 0.0;
            for (int i = row + 1; i <= col; ++i) sum += t[at(row, i, n)] * f.inverse[at(i, col, n)];
            f.inverse[at(row, col, n)] = -sum / t[at(row, row, n)];
        }
    }
    for (int row = 0; row < n; ++row) {
        const double* of_row = f.inverse.data() + at(row, 0, n);
        f.variance.push_back(dot(of_row, of_row, n));
    }
    return f;
}

double project(const SubsetFactor& f, int k, const Coordinates& z, Coordinates& y) noexcept {
    double explained = 0.0;
    for (int i = 0; i < f.size; ++i) {
        const double share = dot(f.basis.data() + at(i, 0, k), z.data(), k);
        y[static_cast<std::size_t>(i)] = share;
        explained += share * share;
    }
    return explained;
}

void solve(const SubsetFactor& f, const Coordinates& y, Coordinates& a) noexcept {
    for (int i = 0; i < f.size; ++i)
        a[static_cast<std::size_t>(i)] = dot(f.inverse.data() + at(i, i, f.size), y.data() + i, f.size - i);
}

TallFactor factor_tall(const std::vector<double>& columns, int k, int l) {
    TallFactor f;
    f.q = columns;
    orthonormalise(f.q, k, l, f.r);
    return f;
}

}  // namespace pyroscene::analysis
