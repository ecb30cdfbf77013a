#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "base/constants.h"
#include "render/scene.h"

namespace pyroscene::render {

struct SceneTables;

/// A piece of ground that receives light: a map cell with its mean slope.
struct Receiver {
    std::size_t cell = 0;         ///< of the map grid
    double x_m = 0.0, y_m = 0.0;  ///< centre, scene frame
    Vec3 normal{0.0, 0.0, 1.0};
};
Receiver receiver_at(const RenderScene& scene, std::size_t cell);

/// Normal of a cell's mean slope.
Vec3 cell_normal(const TerrainHeights& heights, int row, int col) noexcept;

/// Weight of the elevations below a line of sight, in one vertical plane per radian of azimuth:
///   F(t) = int (n . omega) cos(e) de up to e = atan t  =  n_h (e + sin e cos e) / 2 + n_z sin^2(e) / 2
/// with n_h the component of the receiver's normal along the plane.
struct PlaneWeight {
    double along = 0.0, up = 1.0;
    [[nodiscard]] double below(double slope) const noexcept;
    /// Of the elevations between the own surface and a skyline; 0 where the skyline is lower.
    [[nodiscard]] double hidden_by(double skyline) const noexcept;
    /// Slope of the receiver's own surface: nothing below it is seen.
    [[nodiscard]] double lowest_slope() const noexcept { return -along / up; }
};

/// Slope of the terrain's skyline from a point into a horizontal direction, scanned to the rim of the raster in steps of a
/// cell that grow to a tenth of the distance.
double skyline_slope(const TerrainMesh& terrain, Vec3 from_m, double dx, double dy) noexcept;
inline double next_look_m(double distance_m, double cell_m) noexcept {
    return distance_m + std::max(cell_m, 0.1 * distance_m);
}

/// Vertical planes in which a receiver looks for terrain that hides the sky.
inline constexpr int kSkylinePlanes = 16;
inline constexpr double kLeastHidden_sr = 1e-4;  ///< of one plane

/// Directions of the receiver's hemisphere that meet terrain instead of sky: calls visit(direction, weight_sr) with
/// cosine-weighted solid angles of at most pi / `directions` each. Returns the sum of the weights.
template <class Visit>
double hidden_by_terrain(const TerrainMesh& terrain, const Receiver& receiver, int directions, Visit&& visit) {
    const Vec3 from{receiver.x_m, receiver.y_m, terrain.height_at(receiver.x_m, receiver.y_m)};
    constexpr double kPlane_rad = 2.0 * kPi / kSkylinePlanes;
    double sum_sr = 0.0;
    for (int p = 0; p < kSkylinePlanes; ++p) {
        const double azimuth = kPlane_rad * (p + 0.5), dx = std::cos(azimuth), dy = std::sin(azimuth);
        const PlaneWeight weight{receiver.normal.x * dx + receiver.normal.y * dy, receiver.normal.z};
        const double lowest = weight.lowest_slope(), skyline = skyline_slope(terrain, from, dx, dy);
        if (!(skyline > lowest)) continue;
        const double hidden_sr = kPlane_rad * (weight.below(skyline) - weight.below(lowest));
        if (hidden_sr < kLeastHidden_sr) continue;  // the bend of one facet against the next
        sum_sr += hidden_sr;
        const int strata = std::max(1, static_cast<int>(std::ceil(hidden_sr * directions / kPi)));
        const double low_rad = std::atan(lowest), step_rad = (std::atan(skyline) - low_rad) / strata;
        double below = weight.below(lowest);
        for (int s = 0; s < strata; ++s) {
            const double up_to =
                s + 1 == strata ? weight.below(skyline) : weight.below(std::tan(low_rad + (s + 1) * step_rad));
            const double elevation = low_rad + (s + 0.5) * step_rad, c = std::cos(elevation);
            visit(Vec3{c * dx, c * dy, std::sin(elevation)}, kPlane_rad * (up_to - below));
            below = up_to;
        }
    }
    return sum_sr;
}

/// Terrain that a receiver sees in one of its directions.
struct TerrainPatch {
    std::int32_t row = -1;  ///< of GroundIrradiance
    std::int32_t material = 0;
    float weight_sr = 0.0F;
};

/// Light that slopes throw on each other beyond the first look, for one kind of irradiance on its rows:
///   D_n+1(i) = t(i) sum_j w_ij rho_j / pi D_n(j),   E(i) += D_n+1(i)
/// where D_1 is by how much the irradiance of a row differs from what the first look took for granted.
/// \param through [row][lambda] share that flames let through   \param irradiance  E, in and out   \param change D_1, in; used up
/// \param bounces looks in all, the first one included; \param decay the n-th look uses every decay^(n-2)-th direction
void reflect_between_slopes(const SceneTables& tables, const std::vector<std::vector<TerrainPatch>>& patches,
                            const std::vector<float>& through, int bounces, int decay, std::vector<float>& irradiance,
                            std::vector<float>& change);

}  // namespace pyroscene::render
