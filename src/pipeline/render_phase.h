#pragma once

#include <string>

#include "base/report.h"
#include "pipeline/acquisition.h"
#include "pipeline/output_names.h"

namespace pyroscene::pipeline {

/// What one camera group of one acquisition is rendered from.
struct GroupJob {
    const scenario::Scenario& scenario;
    const scenario::Acquisition& acquisition;
    const inputs::SceneInputs& inputs;
    const OpticalTables& tables;
    const FireScene& fire;
    const render::TerrainMesh& terrain;
    const sensors::Sensor& sensor;
    const sensors::CameraGroup& group;
    std::vector<int> bands;  ///< positions in sensor.bands
    sensors::ImageGeometry geometry;
    AcquisitionFiles files;
    std::string fingerprint;
};

/// Renders the group and writes radiance, geolocation and truth.
void render_group(const GroupJob& job, const Monitor& monitor, RunReport& report);

}  // namespace pyroscene::pipeline
