#pragma once

#include <functional>
#include <vector>

#include "sensors/framing.h"

namespace pyroscene::sensors {

/// Path of a platform: its pose at any time [s], the zero of which is the caller's.
struct Trajectory {
    std::function<Pose(double time_s)> at;
    double ground_speed_m_s = 0.0;  ///< of the point below, for scans that shall leave no gaps
    bool smooth = true;             ///< false: measured poses, with an attitude that changes from line to line
};

/// A platform that does not move: one frame, or a geostationary satellite.
Trajectory standing(const Pose& pose);

/// Straight flight: along the geodesic that starts with the pose's heading, at its height above the ellipsoid, with its
/// pitch and roll. At time 0 it is at the pose. \param ground_speed_m_s  on the ellipsoid
Trajectory straight_flight(const Pose& pose, double ground_speed_m_s);

/// Poses in order of time: positions by cubic Hermite polynomials in ECEF, attitudes by the shortest turn (slerp). Asked for
/// times outside it throws an input error.
/// Throws an input error for less than two poses or times that do not ascend.
Trajectory flown(std::vector<Pose> poses);

/// Circular orbit around a turning Earth that at time 0 sees `target` in direction `body` (unit vector forward, right, down).
/// The yaw is steered to the velocity over the ground, z looks along the ellipsoid normal. Heights are above the ellipsoid
/// under the satellite at time 0; the radius stays.
/// \param pitch_rad, roll_rad  pointing of the whole satellite
/// Throws an input error when the orbit does not come over this latitude or the direction passes the Earth.
Trajectory orbit_pass(const Orbit& orbit, bool ascending, const gis::Geodetic& target, Vec3 body, double pitch_rad = 0.0,
                      double roll_rad = 0.0);

/// Where a geostationary satellite stands: body x points north, y east, z to the centre of the Earth.
Trajectory geostationary(const Orbit& orbit);

}  // namespace pyroscene::sensors
