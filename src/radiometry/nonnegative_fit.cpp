#include "radiometry/nonnegative_fit.h"

#include <algorithm>
#include <cmath>

namespace pyroscene::radiometry {
namespace {

using Array = std::vector<double>;

double dot(std::span<const double> a, std::span<const double> b) noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

/// Least squares on the columns in use by modified Gram-Schmidt with one reorthogonalisation; a column that depends on those
/// before it gets weight 0.
Array solve(const FitColumns& columns, const std::vector<std::size_t>& used, std::span<const double> target) {
    const std::size_t n = used.size(), rows = columns.rows;
    Array q(n * rows), r(n * n, 0.0), along(n), weight(n, 0.0);
    for (std::size_t j = 0; j < n; ++j) {
        const std::span<double> v(q.data() + j * rows, rows);
        const auto column = columns[used[j]];
        std::copy(column.begin(), column.end(), v.begin());
        const double size = std::sqrt(dot(v, v));
        for (int pass = 0; pass < 2; ++pass) {
            for (std::size_t k = 0; k < j; ++k) {
                const std::span<const double> before(q.data() + k * rows, rows);
                const double share = dot(before, v);
                r[k * n + j] += share;
                for (std::size_t i = 0; i < rows; ++i) v[i] -= share * before[i];
            }
        }
        const double left = std::sqrt(dot(v, v));
        if (!(left > 1e-11 * size)) continue;  // r[j][j] stays 0
        r[j * n + j] = left;
        for (double& x : v) x /= left;
        along[j] = dot(v, target);
    }
    for (std::size_t j = n; j-- > 0;) {
        if (r[j * n + j] == 0.0) continue;
        double sum = along[j];
        for (std::size_t k = j + 1; k < n; ++k) sum -= r[j * n + k] * weight[k];
        weight[j] = sum / r[j * n + j];
    }
    return weight;
}

/// Moves from `weight` (feasible) towards `wanted` until a weight reaches zero and drops those that did.
void step_towards(const Array& wanted, std::vector<std::size_t>& used, Array& weight) {
    double share = 1.0;
    for (std::size_t j = 0; j < used.size(); ++j)
        if (wanted[j] <= 0.0) share = std::min(share, weight[j] / std::max(weight[j] - wanted[j], 1e-300));
    std::size_t kept = 0;
    for (std::size_t j = 0; j < used.size(); ++j) {
        const double next = weight[j] + share * (wanted[j] - weight[j]);
        if (wanted[j] <= 0.0 && next <= 1e-14) continue;
        used[kept] = used[j];
        weight[kept++] = next;
    }
    used.resize(kept);
    weight.resize(kept);
}

}  // namespace

NonnegativeFit nonnegative_fit(const FitColumns& columns, std::span<const double> target, double tolerance,
                               std::size_t most_columns) {
    std::vector<std::size_t> used;
    std::vector<bool> refused(columns.count(), false);
    Array weight, residual(target.begin(), target.end());
    NonnegativeFit best;
    const auto largest = [&] {
        double most = 0.0;
        for (const double x : residual) most = std::max(most, std::abs(x));
        return most;
    };
    best.largest_residual = largest();
    for (std::size_t round = 0; round < 4 * most_columns && best.largest_residual > tolerance; ++round) {
        std::size_t next = columns.count();
        double steepest = 0.0;
        for (std::size_t c = 0; c < columns.count(); ++c) {
            if (refused[c] || std::find(used.begin(), used.end(), c) != used.end()) continue;
            const double slope = dot(columns[c], residual) / std::sqrt(std::max(dot(columns[c], columns[c]), 1e-300));
            if (slope > steepest) {
                steepest = slope;
                next = c;
            }
        }
        if (next == columns.count() || used.size() >= most_columns) break;
        used.push_back(next);
        weight.push_back(0.0);
        Array wanted = solve(columns, used, target);
        if (!(wanted.back() > 0.0)) {  // rounding: it only seemed to help
            used.pop_back();
            weight.pop_back();
            refused[next] = true;
            continue;
        }
        while (std::any_of(wanted.begin(), wanted.end(), [](double w) { return w <= 0.0; })) {
            step_towards(wanted, used, weight);
            wanted = solve(columns, used, target);
        }
        weight = wanted;
        residual.assign(target.begin(), target.end());
        for (std::size_t j = 0; j < used.size(); ++j) {
            const auto column = columns[used[j]];
            for (std::size_t i = 0; i < residual.size(); ++i) residual[i] -= weight[j] * column[i];
        }
        if (const double now = largest(); now < best.largest_residual) best = {used, weight, now};
    }
    return best;
}

}  // namespace pyroscene::radiometry
