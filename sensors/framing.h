#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/vec3.h"
#include "gis/geodesy.h"
#include "sensors/sensor.h"

namespace pyroscene::sensors {

/// Where the perspective centre is and how the body points (FRD body frame, docs/coordinates.md).
struct Pose {
    gis::Geodetic position;
    double heading_rad = 0.0;  ///< of the body's x axis, clockwise from TRUE north
    double pitch_rad = 0.0;    ///< nose up
    double roll_rad = 0.0;     ///< right wing down: turns the nadir look to the left
    double time_s = 0.0;
};

/// A line of sight in ECEF, unit direction.
struct EcefRay {
    Vec3 origin_m, direction;
};

/// Ray through image position (sample, line), pixel CORNERS at integers (centre of the first pixel = 0.5, 0.5).
/// Method: sensor-geometry conventions of docs/coordinates.md; Brown's distortion is inverted by fixed-point iteration.
/// Throws an input error for a group without focal length and pixel pitch (an outline that can only be listed) and where
/// the distortion of the file has no inverse.
EcefRay pixel_ray(const Sensor& sensor, const CameraGroup& group, const Pose& pose, double sample, double line);

/// Ray of a direction in the frame of the instrument (forward, right, down), which the misalignment of the file turns into
/// the body's and the pose into ECEF.
EcefRay body_ray(const Sensor& sensor, const Pose& pose, Vec3 mounted);

/// Distance along a ray that comes from above to the surface of constant ellipsoidal height h_m [m], or NaN when the ray
/// misses, grazes it (elevation below 1e-6 rad) or starts below it. Accurate to 1e-6 m.
double distance_to_height_m(const EcefRay& ray, double h_m);

/// Where a ray meets the surface of constant ellipsoidal height h_m, or NaN when it misses. Accurate to < 1 mm.
gis::Geodetic intersect_height(const EcefRay& ray, double h_m);

/// Direction from a ground point to the sensor: zenith at the ellipsoid normal, azimuth clockwise from true north in
/// [0, 2 pi), range.
struct LookAngles {
    double zenith_rad = 0.0, azimuth_rad = 0.0, range_m = 0.0;
};
LookAngles look_angles(const gis::Geodetic& ground, Vec3 sensor_ecef_m);

/// Positions inside (and, for wide PSFs, around) a pixel relative to its centre, and their weights (sum 1): n x n points,
/// equal-probability strata of the PSF (box detector when the shape is None). Each point is the centroid of its stratum,
/// so a radiance that is linear over each stratum is averaged exactly. Points run along the line first.
/// Throws an input error for n_per_axis < 1 or a width that is not positive.
struct PixelSamples {
    std::vector<std::array<double, 2>> offset;  ///< {sample, line}
    std::vector<double> weight;
};
PixelSamples pixel_samples(const Psf& across, const Psf& along, int n_per_axis);

/// A point-spread function along one axis, cut into the same `base` strata, each of which may be halved again and again: a
/// pixel that is larger than what it looks at is sampled finer where there is something to see.
class PsfShares {
public:
    static constexpr int kLevels = 11;

    /// Throws an input error for base < 1 or a width that is not positive.
    PsfShares(const Psf& psf, int base);

    struct Share {
        double centre = 0.0;  ///< centroid, from the pixel's centre [samples]
        double width = 0.0;   ///< twice the way from the centroid to the nearer end
    };
    /// Share `index` of base x 2^level equal ones, level 0 to kLevels.
    [[nodiscard]] Share share(int level, int index) const noexcept;

private:
    int base_ = 1;
    std::vector<double> end_, moment_below_;  ///< [base x 2^kLevels + 1] of the finest shares
};

}  // namespace pyroscene::sensors
