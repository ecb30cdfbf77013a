#pragma once

#include <optional>
#include <vector>

#include "render/ground_mix.h"
#include "render/point_sources.h"
#include "render/receiver_lattice.h"
#include "render/receiver_light.h"
#include "render/scene_tables.h"
#include "render/smoke_shadow.h"
#include "render/smoke_veil.h"
#include "render/terrain_sight.h"

namespace pyroscene::render {

/// What the rows of GroundIrradiance become: the first look in full, and what the reflections between slopes need.
struct Rows {
    GroundIrradiance& light;
    std::vector<std::vector<TerrainPatch>> patches;  ///< [row]; empty on a plane
    std::vector<float> through;                      ///< [row][lambda] share that flames let through; only with patches
    std::vector<float> opacity;                      ///< [row][lambda] of flames [sr]; only where rows are interpolated
    const SmokeShadow* smoke = nullptr;              ///< null without a plume
};

/// From what a receiver sees to its irradiances on the transport grid. One per thread.
class RowWriter {
public:
    /// \param points  null: hemisphere quadrature
    /// \param plume   columns of the scene's plume; null: none
    RowWriter(const LightScene& shared, const SceneTables& tables, const PointSources* points, const FlameColumns* plume);

    /// Irradiance by flames alone; adds to `irradiance` and leaves their opacity for write().
    void flame(const Receiver& receiver, float* irradiance);
    void write(const Receiver& receiver, const LatticeReceiver& place, Rows& out);

private:
    bool interpolate(const LatticeReceiver& place, Rows& out);
    void sum_flame(float* irradiance);
    void add_slope(const GroundCell& ground, double weight_sr, const GroundLight& light);
    double look_at_terrain(const Receiver& receiver, const std::vector<std::int32_t>& row_of_cell,
                           std::vector<TerrainPatch>& patches);

    const LightScene* shared_;
    const PointSources* points_;  ///< null: hemisphere quadrature
    const SceneTables* tables_;
    const SpectralKernels* kernels_;
    ReceiverLight light_;
    std::optional<SmokeVeil> veil_;  ///< with a plume
    GroundMix mix_, fire_mix_;
    GroundSpectra terrain_, fire_;  ///< what slopes in view send; the glow of burning and burnt ground stands in `fire_`
    SmokySky smoky_sky_;
    std::vector<float> through_, opacity_, of_moment_, sky_, dimmed_sky_;
};

}  // namespace pyroscene::render
