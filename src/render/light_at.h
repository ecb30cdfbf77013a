#pragma once

#include "render/ground_mix.h"
#include "render/scene.h"

namespace pyroscene::render {

/// Rows of the flame light around a map position and their bilinear weights (cell means sit at cell centres). Fills
/// `row_count`, `row`, `weight`, `open` and `hidden` of `out`.
void light_around(const GroundIrradiance& light, double x_m, double y_m, GroundLight& out);

/// Cosine of the sun's incidence at a hit, 0 where the facet faces away or terrain shadows it.
double sun_cosine(const RenderScene& scene, const TerrainMesh::Hit& hit) noexcept;

}  // namespace pyroscene::render
