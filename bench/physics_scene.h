#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/w0_scene.h"
#include "radiometry/atmosphere.h"
#include "radiometry/flame_optics.h"
#include "radiometry/smoke.h"
#include "sensors/sensor.h"

namespace pyroscene::bench {

/// Tables that are read once for several scenes.
struct PhysicsTables {
    PhysicsTables();
    std::shared_ptr<const radiometry::FlameOptics> flame;
    radiometry::SmokeOptics smoke;
    radiometry::AtmosphereSet air;  ///< mid-latitude summer, 23 km visibility
    Spectrum dry_grass, char_black;
};

/// Scene W0 with all physics on: flames of soot, hot gas and potassium; a plume of smoke of 1 to 2 mg/m3 that scatters, leaning
/// downwind (east) from the fire over a third of the image; sun 40 degrees from the zenith in the south-west, sky, air below
/// a sensor in 3 km; grass, burnt ground.
class PhysicsScene {
public:
    /// \param grid  transport wavelengths; those that a render would pick: see picked_grid()
    PhysicsScene(const PhysicsTables& tables, radiometry::SpectralGrid grid);

    [[nodiscard]] render::RenderScene scene() const;
    [[nodiscard]] const radiometry::SpectralGrid& spectral() const noexcept { return spectral_; }

private:
    W0Scene w0_;
    fire::FlameField plume_;
    render::SceneOptics optics_;
    radiometry::SpectralGrid spectral_;
    radiometry::ViewAtmosphere atmosphere_;
};

/// Transport wavelengths of a sensor's bands as a render picks them for this air.
radiometry::SpectralGrid picked_grid(const PhysicsTables& tables, const std::vector<Spectrum>& responses);
/// Transport wavelengths of at most 1 cm-1, lines of potassium resolved.
radiometry::SpectralGrid fine_grid(const PhysicsTables& tables, const std::vector<Spectrum>& responses);

}  // namespace pyroscene::bench
