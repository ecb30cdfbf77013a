#pragma once

#include <optional>

#include "base/report.h"
#include "inputs/scene_inputs.h"
#include "pipeline/output_names.h"
#include "pipeline/run.h"
#include "sensors/image_geometry.h"

namespace pyroscene::pipeline {

/// What the products of one rendered camera group are made from.
struct ProductJob {
    const scenario::Scenario& scenario;
    const scenario::Acquisition& acquisition;
    const inputs::SceneInputs& inputs;
    const sensors::Sensor& sensor;
    const sensors::CameraGroup& group;
    std::vector<int> bands;
    AcquisitionFiles files;
    std::string fingerprint;
    bool force = false;
    std::optional<sensors::ImageGeometry> geometry = {};  ///< for native forms
};

/// Makes the products the scenario asks for: brightness temperature, fractions, FRP, ortho COGs, vectors, quick-look, STAC item.
/// Returns false when they were all there already.
bool make_products(const ProductJob& job, const RunOptions& options, RunReport& report);

/// OUT/catalog.json with a link to every acquisition's item.json that exists.
void write_catalog(const scenario::Scenario& scenario, const std::filesystem::path& output);

}  // namespace pyroscene::pipeline
