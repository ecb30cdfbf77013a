#include "imagery/pixel_match.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "base/constants.h"

namespace pyroscene::imagery {
namespace {

/// Metres on a plane that is true enough within an image: distances matter, and only those of a pixel.
struct Plane {
    double east_m_deg, north_m_deg;

    explicit Plane(double lat_deg) {
        north_m_deg = kEarthRadius_m * kDegree_rad;
        east_m_deg = north_m_deg * std::cos(lat_deg * kDegree_rad);
    }
};

/// Pixels by the square they lie in.
class Buckets {
public:
    Buckets(const gis::PixelPositions& from, const Plane& plane, double edge_m) : edge_m_(edge_m) {
        for (std::size_t i = 0; i < from.lon_deg.size(); ++i) {
            x_m_.push_back(from.lon_deg[i] * plane.east_m_deg);
            y_m_.push_back(from.lat_deg[i] * plane.north_m_deg);
            if (std::isfinite(x_m_[i]) && std::isfinite(y_m_[i]))
                squares_[key(square(x_m_[i]), square(y_m_[i]))].push_back(i);
        }
    }

    /// Calls use(pixel, squared distance) for the pixels in the square of a place and in the eight around it.
    template <class Use>
    void near(double x_m, double y_m, const Use& use) const {
        for (std::int64_t dy = -1; dy <= 1; ++dy)
            for (std::int64_t dx = -1; dx <= 1; ++dx) {
                const auto found = squares_.find(key(square(x_m) + dx, square(y_m) + dy));
                if (found == squares_.end()) continue;
                for (const std::size_t i : found->second) {
                    const double ex = x_m_[i] - x_m, ey = y_m_[i] - y_m;
                    use(i, ex * ex + ey * ey);
                }
            }
    }

private:
    [[nodiscard]] std::int64_t square(double m) const { return static_cast<std::int64_t>(std::floor(m / edge_m_)); }
    static std::int64_t key(std::int64_t x, std::int64_t y) { return x * 0x9E3779B1LL + y; }

    double edge_m_;
    std::vector<double> x_m_, y_m_;
    std::unordered_map<std::int64_t, std::vector<std::size_t>> squares_;
};

/// Larger edge of an image's middle pixel, m.
double pixel_edge_m(const gis::PixelPositions& of) {
    std::vector<float> edges;
    for (std::size_t i = 0; i < of.width_m.size(); ++i)
        if (std::isfinite(of.width_m[i]) && std::isfinite(of.height_m[i]))
            edges.push_back(std::max(of.width_m[i], of.height_m[i]));
    if (edges.empty()) return 1.0;
    const auto middle = edges.begin() + static_cast<std::ptrdiff_t>(edges.size() / 2);
    std::nth_element(edges.begin(), middle, edges.end());
    return static_cast<double>(*middle);
}

}  // namespace

std::vector<float> averaged_onto(const gis::PixelPositions& to, const gis::PixelPositions& from,
                                 std::span<const float> plane) {
    const auto valid = std::find_if(to.lat_deg.begin(), to.lat_deg.end(), [](double v) { return std::isfinite(v); });
    const Plane metres(valid == to.lat_deg.end() ? 0.0 : *valid);
    const Buckets buckets(from, metres, std::max(pixel_edge_m(to), pixel_edge_m(from)));
    std::vector<float> out(to.lon_deg.size(), std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (!std::isfinite(to.lon_deg[i]) || !std::isfinite(to.area_m2[i])) continue;
        const double reach_m2 = static_cast<double>(to.area_m2[i]) / kPi;
        double sum = 0.0, nearest_m2 = std::numeric_limits<double>::infinity(), nearest = std::nan("");
        int count = 0;
        buckets.near(to.lon_deg[i] * metres.east_m_deg, to.lat_deg[i] * metres.north_m_deg, [&](std::size_t p, double m2) {
            if (!std::isfinite(plane[p])) return;
            if (m2 <= reach_m2) {
                sum += static_cast<double>(plane[p]);
                ++count;
            }
            if (m2 < nearest_m2) {
                nearest_m2 = m2;
                nearest = static_cast<double>(plane[p]);
            }
        });
        out[i] = static_cast<float>(count > 0 ? sum / count : nearest);
    }
    return out;
}

}  // namespace pyroscene::imagery
