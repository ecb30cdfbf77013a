#pragma once

#include <array>
#include <vector>

#include "render/flame_columns.h"
#include "render/scene.h"
#include "render/scene_tables.h"

namespace pyroscene::render {

/// How much smoke lies between a plume and its sources of light, free of wavelengths: nodes at the centres of voxel columns on
/// the faces between voxels, so that a horizontally uniform layer is exact whatever the size of its voxels. Columns are
/// fill x length. Terrain neither shadows smoke nor hides flames from it.
///
/// Flames light smoke as point sources, one per brick of flame: projected area A / 4 (A: faces towards air) times emissivity at
/// the mean chord 4 V / A (Cauchy), isotropic; the front under them as flat patches, one per map cell, that shine upward with the
/// cosine through the mean flame. All have one spectrum.
class SmokeLight {
public:
    /// What is known at a node (PastSun: on the sun's rays behind it; only for light scattered more than once) and interpolated between nodes.
    enum Quantity { ToSun, PastSun, Above, Below, FlamePerM2, ToFlame, FlameX, FlameY, FlameZ, kQuantities };
    using Node = std::array<float, kQuantities>;

    /// \param plume  columns of scene.plume; must outlive this
    SmokeLight(const RenderScene& scene, const SceneTables& tables, const FlameColumns& plume);

    /// At a point of the plume; outside its box the nearest node's. FlameX.. is the mean direction of the flames' light, its
    /// length 1 when all comes from one side.
    [[nodiscard]] Node at(Vec3 point_m) const noexcept;

    /// [lambda] share of the sphere that flames fill per FlamePerM2, and their mean radiance.
    [[nodiscard]] const float* flame_share_m2() const noexcept { return flame_share_m2_.data(); }
    [[nodiscard]] const float* flame_radiance() const noexcept { return flame_radiance_.data(); }

private:
    struct Source {
        Vec3 at_m;
        double weight, softening_m2;
        bool flat = false;  ///< shines upward with the cosine, twice its mean straight up
    };
    void find_box();
    void find_sources(const SceneTables& tables);
    /// Both add to the shares of the sphere and to `emission` [lambda]. \return area of all flame bodies [m2]
    double add_flames(const SceneTables& tables, std::vector<float>& emission, std::vector<Source>& sources);
    void add_front(const SceneTables& tables, double flame_area_m2, std::vector<float>& emission,
                   std::vector<Source>& sources);
    void fill_nodes();
    [[nodiscard]] bool is_near_smoke(const std::vector<float>& fill, int i, int j, int k, int reach) const noexcept;
    void add_sun_columns(const std::vector<float>& fill, Vec3 direction, Quantity into);
    void light_by_flames(Vec3 at_m, bool marches, Node& node) const;
    void between_marches();
    [[nodiscard]] std::size_t node_index(int i, int j, int k) const noexcept {
        return (static_cast<std::size_t>(k) * static_cast<std::size_t>(ny_) + static_cast<std::size_t>(j)) *
                   static_cast<std::size_t>(nx_) +
               static_cast<std::size_t>(i);
    }

    const RenderScene* scene_;
    const FlameColumns* plume_;
    bool diffuse_ = false;
    Vec3 corner_m_;
    int nx_ = 0, ny_ = 0, nz_ = 0;
    std::vector<Node> nodes_;                                                                        ///< [nz + 1][ny][nx]
    std::vector<float> source_x_m_, source_y_m_, source_z_m_, source_weight_, softening_m2_, flat_;  ///< FlameSources
    std::vector<float> flame_share_m2_, flame_radiance_;
};

}  // namespace pyroscene::render
