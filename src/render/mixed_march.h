#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "render/flame_march.h"

namespace pyroscene::render {

/// A piece of a ray within one voxel; ray parameters in [0, 1].
struct RaySegment {
    double from = 0.0, to = 0.0;
    float temperature_K = 0.0F, fill = 0.0F;
};

/// A piece of a ray with at most one flame voxel and one smoke voxel; fill x length of what is absent is 0.
struct MixedPiece {
    float flame_K = 0.0F, smoke_K = 0.0F;
    double flame_m = 0.0, smoke_m = 0.0;
    double from = 0.0, to = 0.0;  ///< ray parameters
};

/// Voxels of a field along a ray as segments, from `start_m` on. Their ends are those of the march, so that the lengths of a
/// merged ray add up to those of either field.
inline void list_segments(const FlameColumns& field, Vec3 start_m, Vec3 end_m, std::vector<RaySegment>& out) {
    out.clear();
    march_pieces(field, start_m, end_m, [&](float T_K, float fill, double from, double to) {
        out.push_back({from, to, T_K, fill});
        return true;
    });
}

/// Two lattices in order along the ray: calls visit(MixedPiece) for each piece between neighbouring voxel faces of either.
template <class Visit>
void merge_segments(const std::vector<RaySegment>& flame, const std::vector<RaySegment>& smoke, double ray_m,
                    Visit&& visit) {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    std::size_t f = 0, s = 0;
    double at = 0.0;
    while (f < flame.size() || s < smoke.size()) {
        const double flame_from = f < flame.size() ? flame[f].from : kNever;
        const double smoke_from = s < smoke.size() ? smoke[s].from : kNever;
        at = std::max(at, std::min(flame_from, smoke_from));
        const bool in_flame = flame_from <= at, in_smoke = smoke_from <= at;
        double until = kNever;
        until = std::min(until, in_flame ? flame[f].to : flame_from);
        until = std::min(until, in_smoke ? smoke[s].to : smoke_from);
        const double length_m = std::max(until - at, 0.0) * ray_m;
        MixedPiece piece;
        piece.from = at;
        piece.to = until;
        if (in_flame) piece.flame_K = flame[f].temperature_K, piece.flame_m = flame[f].fill * length_m;
        if (in_smoke) piece.smoke_K = smoke[s].temperature_K, piece.smoke_m = smoke[s].fill * length_m;
        if (length_m > 0.0) visit(piece);
        if (in_flame && flame[f].to <= until) ++f;
        if (in_smoke && smoke[s].to <= until) ++s;
        at = std::max(at, until);
    }
}

}  // namespace pyroscene::render
