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

/// A pixel's line of sight cut by the scene's upper and lower height, in the scene frame, with the view at both ends.
struct Chord {
    Vec3 top_m, bottom_m;  ///< scene frame (map minus origin)
    double top_lon_deg = 0.0, top_lat_deg = 0.0, bottom_lon_deg = 0.0, bottom_lat_deg = 0.0;
    Vec3 view_enu;  ///< unit vector ground -> sensor at the bottom end, east/north/up of the ellipsoid
    double top_range_m = 0.0, bottom_range_m = 0.0;
};

/// All lines of sight of one framing image. Exact chords are computed on a lattice of image positions and interpolated by
/// cubics (error < 1 mm on the ground, tested), so no projection call is left in the per-ray loop. Thread-safe after
/// construction.
class FrameChords {
public:
    /// \param scene_origin_m map coordinates of the scene frame's origin  \param bottom_m, top_m ellipsoidal heights of the
    /// two shells;
    ///        a platform below the upper shell starts the chord itself.
    /// Throws an input error when the camera does not look at the ground.
    FrameChords(const Sensor& sensor, const CameraGroup& group, const Pose& pose, const gis::MapProjection& map,
                Vec3 scene_origin_m, double bottom_m, double top_m);
    /// \param sample, line image position, pixel corners at integers, from a little outside the frame (-4) on.
    [[nodiscard]] Chord at(double sample, double line) const noexcept;
    /// Only the ends, at half the cost: all that a ray tracer needs of a sub-ray.
    struct Ends {
        Vec3 top_m, bottom_m;
    };
    [[nodiscard]] Ends ends(double sample, double line) const noexcept;

private:
    using Node = std::array<double, 16>;  ///< the 15 numbers of a Chord, ends first, padded to whole vector registers

    template <std::size_t count>
    [[nodiscard]] std::array<double, count> interpolate(double sample, double line) const noexcept;

    int cols_ = 0, rows_ = 0;                               ///< lattice nodes
    double first_ = 0.0, col_step_ = 0.0, row_step_ = 0.0;  ///< image position of node 0, distance of nodes [px]
    std::vector<Node> nodes_;
};

/// Positions inside (and, for wide PSFs, around) a pixel relative to its centre, and their weights (sum 1): n x n points,
/// equal-probability strata of the PSF (box detector when the shape is None). Each point is the centroid of its stratum,
/// so a radiance that is linear over each stratum is averaged exactly. Points run along the line first.
/// Throws an input error for n_per_axis < 1 or a width that is not positive.
struct PixelSamples {
    std::vector<std::array<double, 2>> offset;  ///< {sample, line}
    std::vector<double> weight;
};
PixelSamples pixel_samples(const Psf& across, const Psf& along, int n_per_axis);

}  // namespace pyroscene::sensors
