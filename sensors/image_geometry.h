#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>

#include "sensors/trajectory.h"

namespace pyroscene::sensors {

/// One image: whose pixels, along which path, and which of them. Pointers are not owned.
struct ImageGeometry {
    const Sensor* sensor = nullptr;
    const CameraGroup* group = nullptr;
    ScanLaw scan{};
    Trajectory path{};    ///< at time 0 as the scan's: the middle of scan 0 (of the line, of the disk)
    double time_s = 0.0;  ///< added to times of the image (acquisition), not to those asked of the path
    int first_sample = 0, samples = 0;
    int first_line = 0, lines = 0;  ///< line = scan * lines_per_scan + line of the scan; may be negative
};

/// Law of a group (and view, "" = the first) with everything known: scans that shall be contiguous at nadir get their period
/// from height above ground and speed. Throws an input error for a view that does not exist.
ScanLaw resolved_scan(const Sensor& sensor, const CameraGroup& group, const std::string& view, double height_agl_m,
                      double ground_speed_m_s);

/// A line of sight and when it is looked along.
struct Sightline {
    EcefRay ray;
    Pose pose;            ///< roll as far as it is not compensated
    double time_s = 0.0;  ///< of the scan, without ImageGeometry::time_s
};
/// \param scan  number of the scan, may be a fraction  \param u, v  position in it (scan.h)
Sightline sightline(const ImageGeometry& image, double scan, double u, double v);

/// When a pixel of the image is taken, with ImageGeometry::time_s.
double pixel_time_s(const ImageGeometry& image, int sample, int line);

/// Position of a pixel (of the image, offsets from its centre in pixels) in its scan.
struct ScanPosition {
    int scan = 0;
    double u = 0.0, v = 0.0;
};
ScanPosition scan_position_of(const ImageGeometry& image, int sample, int line, double sample_offset = 0.0,
                              double line_offset = 0.0);

/// True for pixels that the instrument does not send (bow-tie deletion of VIIRS).
bool pixel_deleted(const ImageGeometry& image, int sample, int line);

/// Sets the samples and lines of the image to those that see any of the points (corners of a scene, at its lowest and highest
/// ground), with `margin` pixels around them. For laws of whole frames (Frame) it takes all. A disk also gets its time 0
/// moved to the middle of what is left. Throws an input error when the instrument does not see the points.
/// \param all_samples  keep whole lines  \param lines  as many lines, around scan 0 (on a disk around the points)
void crop_to(ImageGeometry& image, std::span<const gis::Geodetic> points, int margin, bool all_samples,
             std::optional<int> lines);

}  // namespace pyroscene::sensors
