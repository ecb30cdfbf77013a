#pragma once

#include "base/vec3.h"

namespace pyroscene::render {

/// A straight piece of a line of sight in the scene frame, from the sensor side to below the ground.
struct SceneRay {
    Vec3 start_m, end_m;
    bool open = false;  ///< where it meets no ground it looks into the sky, not past the scene
};

}  // namespace pyroscene::render
