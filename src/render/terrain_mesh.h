#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>

#include "base/raster.h"
#include "base/vec3.h"
#include "render/scene_ray.h"
#include "render/terrain_heights.h"

namespace pyroscene::render {

class SkyView;

/// The ground as an Embree grid geometry (ROBUST) with a local origin. Vertices sit at cell centres, with an outer ring on
/// the raster's rim, so the mesh covers the raster exactly. Cells without height are holes (exactly these cells:
/// the surface around them continues to their edge).
class TerrainMesh {
public:
    /// \param height_m terrain heights on the map grid  \param scene_origin_m map x, y of the scene frame's origin; z is height
    TerrainMesh(const Raster<float>& height_m, Vec3 scene_origin_m);
    TerrainMesh(TerrainMesh&&) noexcept;
    ~TerrainMesh();

    struct Hit {
        double distance_m = 0.0;  ///< along the ray
        Vec3 point_m, normal;     ///< scene frame; the normal is the facet's, unit, z > 0
    };
    /// First ground point on the segment start -> end (scene frame). Thread-safe.
    [[nodiscard]] std::optional<Hit> intersect(Vec3 start_m, Vec3 end_m) const noexcept;
    /// The same for many rays at once, hits[i] of rays[i]: a fraction of the cost where they lie side by side. Which of two facets
    /// a ray meets on their common edge may depend on the rays beside it. Thread-safe.
    void intersect(std::span<const SceneRay> rays, std::span<std::optional<Hit>> hits) const noexcept;
    /// True when terrain lies between the point and a place `distance_m` away. Thread-safe.
    [[nodiscard]] bool occluded(Vec3 from_m, Vec3 direction, double distance_m) const noexcept;
    /// Height of the vertices, bilinear in between (within a facet's bend of what `intersect` meets); also defined over
    /// holes; NaN outside the raster.
    [[nodiscard]] double height_at(double x_m, double y_m) const noexcept { return heights().at(x_m, y_m); }
    [[nodiscard]] const TerrainHeights& heights() const noexcept;
    /// Share of the sky that the cells see, for all cameras. Must not outlive this.
    [[nodiscard]] std::shared_ptr<const SkyView> sky_view() const noexcept;
    /// {lowest, highest} height [m].
    [[nodiscard]] std::array<double, 2> height_range_m() const noexcept;
    /// Upper bound of the tangent of any facet's slope: a sun higher than this casts no terrain shadow.
    [[nodiscard]] double steepest_slope() const noexcept;
    [[nodiscard]] const MapGrid& grid() const noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace pyroscene::render
