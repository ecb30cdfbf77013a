#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "gis/resample.h"

namespace pyroscene::gis {
namespace {

struct Point {
    double x = 0.0, y = 0.0;
};

/// Convex polygon with few corners, on the stack: a quadrilateral cut by four half planes has at most eight.
struct Polygon {
    std::array<Point, 10> corners;
    int count = 0;
    void add(Point p) noexcept { corners[static_cast<std::size_t>(count++)] = p; }
};

double signed_area(const Polygon& p) noexcept {
    // Relative to the first corner: no cancellation of large coordinates.
    double twice = 0.0;
    for (int i = 2; i < p.count; ++i) {
        const Point o = p.corners[0], a = p.corners[static_cast<std::size_t>(i - 1)],
                    b = p.corners[static_cast<std::size_t>(i)];
        twice += (a.x - o.x) * (b.y - o.y) - (b.x - o.x) * (a.y - o.y);
    }
    return 0.5 * twice;
}

/// Part of the polygon where sign * (coordinate - bound) >= 0 (Sutherland and Hodgman 1974).
Polygon cut(const Polygon& p, double Point::*coordinate, double bound, double sign) noexcept {
    Polygon out;
    for (int i = 0; i < p.count; ++i) {
        const Point a = p.corners[static_cast<std::size_t>(i)], b = p.corners[static_cast<std::size_t>((i + 1) % p.count)];
        const double da = sign * (a.*coordinate - bound), db = sign * (b.*coordinate - bound);
        if (da >= 0.0) out.add(a);
        if ((da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0)) {
            const double f = da / (da - db);
            out.add({a.x + f * (b.x - a.x), a.y + f * (b.y - a.y)});
        }
    }
    return out;
}

/// A target cell in source pixel coordinates, oriented so that its area is positive.
class Quadrilateral {
public:
    explicit Quadrilateral(const CellOutline& outline) {
        for (std::size_t i = 0; i < 4; ++i) polygon_.add({outline.col[i], outline.row[i]});
        if (signed_area(polygon_) < 0.0) std::reverse(polygon_.corners.begin(), polygon_.corners.begin() + 4);
        low_ = high_ = polygon_.corners[0];
        for (std::size_t i = 0; i < 4; ++i) {
            const Point a = polygon_.corners[i], b = polygon_.corners[(i + 1) % 4];
            edges_[i] = {.x_slope = a.y - b.y, .y_slope = b.x - a.x, .origin = a};
            low_ = {std::min(low_.x, a.x), std::min(low_.y, a.y)};
            high_ = {std::max(high_.x, a.x), std::max(high_.y, a.y)};
        }
    }
    [[nodiscard]] Point low() const noexcept { return low_; }
    [[nodiscard]] Point high() const noexcept { return high_; }

    /// Area common with the pixel [col, col+1] x [row, row+1].
    [[nodiscard]] double overlap(int col, int row) const noexcept {
        bool inside = true;
        for (const Edge& e : edges_) {  // value >= 0 on the inner side; its extremes over the pixel are at corners
            const double base = e.x_slope * (col - e.origin.x) + e.y_slope * (row - e.origin.y);
            if (base + std::max(0.0, e.x_slope) + std::max(0.0, e.y_slope) <= 0.0) return 0.0;
            inside = inside && base + std::min(0.0, e.x_slope) + std::min(0.0, e.y_slope) >= 0.0;
        }
        if (inside) return 1.0;
        Polygon part = cut(polygon_, &Point::x, col, 1.0);
        part = cut(part, &Point::x, col + 1.0, -1.0);
        part = cut(part, &Point::y, row, 1.0);
        part = cut(part, &Point::y, row + 1.0, -1.0);
        return std::max(0.0, signed_area(part));
    }

private:
    struct Edge {
        double x_slope = 0.0, y_slope = 0.0;
        Point origin;
    };
    Polygon polygon_;
    std::array<Edge, 4> edges_;
    Point low_, high_;
};

/// Below this share of valid area a cell counts as not covered: it is rounding, not data.
constexpr double kLeastCoverage = 1e-6;

}  // namespace

double SourcePixels::weight_of_row(int row) const noexcept {
    return row_weights[static_cast<std::size_t>(std::clamp(row - window.row, 0, window.rows - 1))];
}

float average_by_area(const SourcePixels& source, const CellOutline& outline) noexcept {
    const Quadrilateral cell(outline);
    double area = 0.0, covered = 0.0, sum = 0.0;
    for (int row = static_cast<int>(std::floor(cell.low().y)); row < cell.high().y; ++row) {
        const double weight = source.weight_of_row(row);
        for (int col = static_cast<int>(std::floor(cell.low().x)); col < cell.high().x; ++col) {
            const double part = weight * cell.overlap(col, row), value = source.at(col, row);
            area += part;
            if (part == 0.0 || std::isnan(value)) continue;
            covered += part;
            sum += part * value;
        }
    }
    return covered > kLeastCoverage * area ? static_cast<float>(sum / area) : std::numeric_limits<float>::quiet_NaN();
}

}  // namespace pyroscene::gis
