#include "radiometry/spectral_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "radiometry/planck.h"
#include "radiometry/response.h"

namespace pyroscene::radiometry {
namespace {

constexpr std::array<double, 14> kTemperatures_K{300.0, 340.0, 380.0, 420.0,  470.0,  530.0,  600.0,
                                                 700.0, 800.0, 930.0, 1100.0, 1300.0, 1600.0, 2000.0};
constexpr double kTolerance = 4e-6, kDark_W_m2_sr_um = 1e-3, kDarkFactor = 100.0;
constexpr double kNegligibleShare = 1e-3;  // of the band; such a cell joins its neighbour
constexpr std::size_t kMaximumCells = 512;

/// Two-point Gauss rule of a weight on an interval.
struct Rule {
    int count = 0;
    std::array<double, 2> lambda_um{}, weight{};
};

/// A cell of one band: its rule and what that rule gets wrong of the Planck mean at each temperature, in tolerances.
struct Cell {
    double lower_um = 0.0, upper_um = 0.0;
    Rule rule;
    std::array<double, kTemperatures_K.size()> error{};
};

/// Nodes are the zeros of the orthogonal polynomial of degree 2 of the response, from its moments (Golub & Welsch 1969:
/// eigenvalues and first eigenvector components of the Jacobi matrix). For a non-negative response they lie inside the
/// interval and the weights are positive.
Rule gauss_rule(const Spectrum& response, double lower_um, double upper_um) {
    const auto m = response_moments(response, lower_um, upper_um);
    if (!(m[0] > 0.0)) return {};
    const double centre = 0.5 * (lower_um + upper_um), half = 0.5 * (upper_um - lower_um);
    const double a0 = m[1] / m[0], b1 = m[2] / m[0] - a0 * a0;
    if (b1 < 1e-10) return {1, {centre + half * a0, 0.0}, {m[0], 0.0}};  // all weight at one place
    const double a1 = (m[3] - 2.0 * a0 * m[2] + a0 * a0 * m[1]) / (b1 * m[0]);
    const double mean = 0.5 * (a0 + a1), difference = 0.5 * (a1 - a0), root = std::hypot(difference, std::sqrt(b1));
    const double u0 = std::clamp(mean - root, -1.0, 1.0), u1 = std::clamp(mean + root, -1.0, 1.0);
    const double w0 = m[0] * (u1 - a0) / (u1 - u0);  // the rule must carry m0 and m1
    return {2, {centre + half * u0, centre + half * u1}, {w0, m[0] - w0}};
}

/// The whole band: its response and Planck integrals to compare with.
struct Band {
    const Spectrum& response;
    double area_um;
    std::array<double, kTemperatures_K.size()> allowed{};  // error of the integral [W m-2 sr-1]
};

Cell make_cell(const Band& band, double lower_um, double upper_um) {
    Cell cell{lower_um, upper_um, gauss_rule(band.response, lower_um, upper_um), {}};
    if (cell.rule.count == 0) return cell;
    const auto part = clip_response(band.response, lower_um, upper_um);
    const double area_um = response_area_um(part);
    for (std::size_t k = 0; k < kTemperatures_K.size(); ++k) {
        double sum = 0.0;
        for (std::size_t j = 0; j < 2; ++j)
            if (cell.rule.weight[j] > 0.0)
                sum += cell.rule.weight[j] * planck_radiance(cell.rule.lambda_um[j], kTemperatures_K[k]);
        cell.error[k] = std::abs(sum - area_um * band_mean_radiance(kTemperatures_K[k], part)) / band.allowed[k];
    }
    return cell;
}

Band make_band(const Spectrum& response) {
    Band band{response, response_area_um(response), {}};
    for (std::size_t k = 0; k < kTemperatures_K.size(); ++k) {
        const double mean = band_mean_radiance(kTemperatures_K[k], response);
        const double factor = std::min(std::max(1.0, kDark_W_m2_sr_um / mean), kDarkFactor);  // mean = 0: the latter
        band.allowed[k] = std::max(mean * band.area_um * kTolerance * factor, 1e-300);
    }
    return band;
}

/// Equal cells in ln(lambda) over the part where the response is not zero, negligible ones joined with a neighbour.
std::vector<double> first_edges(const Band& band, double maximum_relative_cell) {
    const auto& x = band.response.lambda_um;
    const auto& y = band.response.value;
    std::size_t first = 0, last = x.size() - 1;
    while (y[first] == 0.0 && y[first + 1] == 0.0) ++first;
    while (y[last] == 0.0 && y[last - 1] == 0.0) --last;
    const double span = std::log(x[last] / x[first]);
    const int count = std::max(1, static_cast<int>(std::ceil(span / maximum_relative_cell - 1e-9)));
    std::vector<double> edges{x[first]};
    for (int i = 1; i <= count; ++i) {
        const double edge = i == count ? x[last] : x[first] * std::exp(span * i / count);
        const double share = response_moments(band.response, edges.back(), edge)[0] / band.area_um;
        if (share >= kNegligibleShare || edges.size() == 1)
            edges.push_back(edge);
        else
            edges.back() = edge;
    }
    if (edges.size() > 2 && response_moments(band.response, edges[0], edges[1])[0] < kNegligibleShare * band.area_um)
        edges.erase(edges.begin() + 1);
    return edges;
}

/// Halves the worst cell until the errors, added up without regard to sign, are allowed at every temperature.
std::vector<Cell> make_cells(const Band& band, double maximum_relative_cell) {
    const auto edges = first_edges(band, maximum_relative_cell);
    std::vector<Cell> cells;
    for (std::size_t i = 1; i < edges.size(); ++i) cells.push_back(make_cell(band, edges[i - 1], edges[i]));
    while (cells.size() < kMaximumCells) {
        std::size_t worst_T = 0;
        double worst_total = 0.0;
        for (std::size_t k = 0; k < kTemperatures_K.size(); ++k) {
            double total = 0.0;
            for (const auto& cell : cells) total += cell.error[k];
            if (total > worst_total) {
                worst_total = total;
                worst_T = k;
            }
        }
        if (worst_total <= 1.0) break;
        const auto worst = std::max_element(
            cells.begin(), cells.end(), [&](const Cell& a, const Cell& b) { return a.error[worst_T] < b.error[worst_T]; });
        const double lower = worst->lower_um, upper = worst->upper_um, middle = std::sqrt(lower * upper);
        *worst = make_cell(band, middle, upper);
        cells.insert(worst, make_cell(band, lower, middle));
    }
    return cells;
}

/// Wavelength that splits the cell's response area so that `area_um` lies below it (bisection: monotone, exact enough).
double quantile_um(const Spectrum& response, double lower_um, double upper_um, double area_um) {
    double low = lower_um, high = upper_um;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (middle > lower_um && response_moments(response, lower_um, middle)[0] < area_um ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

/// Window with the mean and variance of the response in [lower, upper], within the cell and around the node.
std::array<double, 2> window_um(const Spectrum& response, const Cell& cell, double lower_um, double upper_um,
                                double node_um) {
    const auto m = response_moments(response, lower_um, upper_um);
    const double centre = 0.5 * (lower_um + upper_um), half = 0.5 * (upper_um - lower_um);
    const double mean = m[1] / m[0], reach = std::sqrt(3.0 * std::max(m[2] / m[0] - mean * mean, 0.0));
    const double low = std::max(centre + half * (mean - reach), cell.lower_um);
    const double high = std::min(centre + half * (mean + reach), cell.upper_um);
    return {std::min(low, node_um), std::max(high, node_um)};
}

void append(SpectralGrid& grid, const Band& band, const Cell& cell) {
    const auto& rule = cell.rule;
    const double split_um = rule.count == 2 ? quantile_um(band.response, cell.lower_um, cell.upper_um, rule.weight[0]) : 0.0;
    for (std::size_t j = 0; j < static_cast<std::size_t>(rule.count); ++j) {
        const double lower = rule.count == 2 && j == 1 ? split_um : cell.lower_um;
        const double upper = rule.count == 2 && j == 0 ? split_um : cell.upper_um;
        const auto window = window_um(band.response, cell, lower, upper, rule.lambda_um[j]);
        grid.lambda_um.push_back(rule.lambda_um[j]);
        grid.weight.push_back(rule.weight[j]);
        grid.cell_lower_um.push_back(window[0]);
        grid.cell_upper_um.push_back(window[1]);
    }
}

}  // namespace

double SpectralGrid::band_mean(int band, std::span<const float> node_values) const noexcept {
    const auto range = bands[static_cast<std::size_t>(band)];
    double sum = 0.0;
    for (auto i = static_cast<std::size_t>(range.begin); i < static_cast<std::size_t>(range.end); ++i)
        sum += weight[i] * static_cast<double>(node_values[i]);
    return sum;
}

SpectralGrid make_spectral_grid(std::span<const Spectrum> responses, double maximum_relative_cell) {
    SpectralGrid grid;
    for (std::size_t b = 0; b < responses.size(); ++b) {
        check_response(responses[b], fmt::format("response of band {} of {}", b + 1, responses.size()));
        const Band band = make_band(responses[b]);
        const int begin = grid.size();
        for (const auto& cell : make_cells(band, maximum_relative_cell)) append(grid, band, cell);
        double total = 0.0;
        for (auto i = static_cast<std::size_t>(begin); i < grid.weight.size(); ++i) total += grid.weight[i];
        for (auto i = static_cast<std::size_t>(begin); i < grid.weight.size(); ++i) grid.weight[i] /= total;
        grid.bands.push_back({begin, grid.size()});
    }
    return grid;
}

SpectralGrid monochromatic_grid(std::span<const double> lambda_um) {
    SpectralGrid grid;
    grid.lambda_um.assign(lambda_um.begin(), lambda_um.end());
    grid.cell_lower_um = grid.cell_upper_um = grid.lambda_um;
    grid.weight.assign(lambda_um.size(), 1.0);
    for (int i = 0; i < grid.size(); ++i) grid.bands.push_back({i, i + 1});
    return grid;
}

}  // namespace pyroscene::radiometry
