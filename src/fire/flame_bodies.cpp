#include "fire/flame_bodies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/constants.h"

namespace pyroscene::fire {
namespace {

constexpr int kEdge = FlameField::kBrickEdge;

FlameBody body_of(const FlameField& flame, const FlameField::Brick& brick, int first_i, int first_j, int first_k) {
    const VoxelGrid& g = flame.grid;
    const std::array<double, 3> face_m2{g.dy_m * g.dz_m, g.dx_m * g.dz_m, g.dx_m * g.dy_m};
    FlameBody body;
    double weights = 0.0;
    for (int v = 0; v < FlameField::kBrickVoxels; ++v) {
        const double fill = brick.fill[static_cast<std::size_t>(v)];
        if (!(fill > 0.0)) continue;
        const int i = first_i + v % kEdge, j = first_j + v / kEdge % kEdge, k = first_k + v / (kEdge * kEdge);
        const double T_K = brick.temperature_K[static_cast<std::size_t>(v)], weight = fill * T_K * T_K * T_K * T_K;
        const Vec3 centre{(i + 0.5) * g.dx_m, (j + 0.5) * g.dy_m, (k + 0.5) * g.dz_m};
        weights += weight;
        body.T_K += weight * T_K;
        body.middle_m = body.middle_m + weight * (g.corner_m + centre);
        body.filled_m3 += fill * g.dx_m * g.dy_m * g.dz_m;
        const auto is_air = [&](int di, int dj, int dk) { return !(voxel_at(flame, i + di, j + dj, k + dk).fill > 0.0F); };
        for (const int step : {-1, 1}) {
            if (is_air(step, 0, 0)) body.area_m2 += face_m2[0];
            if (is_air(0, step, 0)) body.area_m2 += face_m2[1];
            if (is_air(0, 0, step)) body.area_m2 += fill * face_m2[2];  // columns of flame stand on a share of the voxel
        }
    }
    if (!(weights > 0.0)) return {};
    body.T_K /= weights;
    body.middle_m = body.middle_m / weights;
    return body;
}

}  // namespace

std::vector<FlameBody> flame_bodies(const FlameField& flame) {
    std::vector<FlameBody> bodies;
    std::map<std::array<int, 3>, FlameBody> faces;  // by place of the brick; the order of the bricks
    for (int bj = 0; bj < flame.brick_rows; ++bj) {
        for (int bi = 0; bi < flame.brick_cols; ++bi) {
            const auto& column = flame.columns[static_cast<std::size_t>(bj) * static_cast<std::size_t>(flame.brick_cols) +
                                               static_cast<std::size_t>(bi)];
            for (int b = 0; b < column.brick_count; ++b) {
                const int bk = column.z_begin + b;
                const auto body = body_of(flame, flame.bricks[static_cast<std::size_t>(column.first_brick + b)], bi * kEdge,
                                          bj * kEdge, bk * kEdge);
                if (body.filled_m3 > 0.0) faces[{bj, bi, bk}] = body;
            }
        }
    }
    for (const auto& [at, body] : faces) {
        double volume_m3 = 0.0, area_m2 = 0.0;
        for (int n = 0; n < 27; ++n) {
            const auto found = faces.find({at[0] + n / 9 - 1, at[1] + n / 3 % 3 - 1, at[2] + n % 3 - 1});
            if (found == faces.end()) continue;
            volume_m3 += found->second.filled_m3;
            area_m2 += found->second.area_m2;
        }
        area_m2 = std::max(area_m2, std::cbrt(36.0 * kPi * volume_m3 * volume_m3));
        bodies.push_back(body);
        bodies.back().area_m2 = body.filled_m3 * area_m2 / volume_m3;
    }
    return bodies;
}

}  // namespace pyroscene::fire
