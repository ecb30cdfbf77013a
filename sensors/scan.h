#pragma once

#include <vector>

#include "base/vec3.h"

namespace pyroscene::sensors {

/// Law by which the pixels of a camera group look and take their time: one flat description for every instrument, evaluated by
/// scan_direction() and scan_time_s(). Angles are those of docs/scan-geometry.md.
///
/// An image is a sequence of SCANS, `period_s` apart, of `lines_per_scan` lines each. Inside a scan a position has two
/// coordinates, pixel corners at integers: u along the line (0 ... positions) and v across it (0 ... lines_per_scan, growing
/// in the direction of flight unless the leading detector comes first; downwards in the image for Frame and Disk).
struct ScanLaw {
    enum class Kind {
        Frame,      ///< area array, central projection: one scan holds all lines
        Pushbroom,  ///< line array, central projection
        LineArray,  ///< line array, equal angles (several cameras side by side)
        Mirror,     ///< scan mirror or rotating telescope across track
        Cone,       ///< line of sight on a cone around a tilted axis
        Disk        ///< two angles from a geostationary place: one scan holds all lines
    } kind = Kind::Frame;

    int positions = 0;               ///< along a line; VIIRS counts unaggregated samples here
    int lines_per_scan = 1;          ///< detectors along track
    double period_s = 0.0;           ///< from scan to scan; 0 = contiguous at nadir, from height and speed
    std::vector<double> rates_hz{};  ///< more than one: the slowest that leaves no gaps at nadir is taken
    double scan_rate_rad_s = 0.0;    ///< of the angle across track (of the cone's rotation); 0 = a line at once
    double step_across_rad = 0.0;    ///< between positions (of the cone's or disk's own angle)
    double step_along_rad = 0.0;     ///< between detectors, and the height of one
    double pitch_over_focal = 0.0, centre_position = 0.0;  ///< Pushbroom: central projection along the line
    double stagger = 0.0;  ///< Pushbroom: every second sample looks this far ahead, the others behind [+- lines]

    bool right_to_left = false;           ///< position 0 is at the right wing
    bool leading_detector_first = false;  ///< v = 0 looks ahead instead of behind
    bool image_rotates = false;           ///< a single 45 deg mirror turns the focal plane with the scan angle
    bool alternating = false;             ///< every second sweep runs the other way (the samples are put in order)
    bool line_corrector = false;          ///< sweeps are made straight: the platform stands still during one

    double amplitude_rad = 0.0;     ///< Mirror that swings like a sine: sigma = amplitude * sin(omega t)
    double ground_spacing_m = 0.0;  ///< Mirror sampled at equal distances on a round Earth
    double orbit_height_m = 0.0;    ///< for ground_spacing_m
    double cone_half_angle_rad = 0.0, cone_tilt_rad = 0.0, cone_centre_rad = 0.0;  ///< rotation angle of the line's middle
    bool sweep_x = false;  ///< Disk: fixed-grid angles of a sweep about x (GOES-R), else about y

    /// VIIRS: from the middle outwards, `width` samples of one pixel for `pixels` pixels on each side.
    struct Zone {
        int pixels = 0, width = 1;
        int deleted_rows = 0;  ///< lines at each rim of the scan that are not transmitted
    };
    std::vector<Zone> zones{};

    double roll_compensation_rad = 0.0;  ///< roll of the platform up to this is taken out

    /// Samples of a line of the image: positions, or what zones make of them.
    [[nodiscard]] int samples() const noexcept;
};

/// Position u of an image position along the line (pixel corners at integers); the same unless zones average samples.
double scan_position(const ScanLaw& law, double sample) noexcept;
/// Width of a pixel in positions, for its point-spread function.
double scan_pixel_width(const ScanLaw& law, int sample) noexcept;
/// True where the instrument sends no data: rim lines of a scan far from nadir (VIIRS).
bool scan_deletes(const ScanLaw& law, int sample, int line_of_scan) noexcept;

/// Angle across track of position u [rad], positive to the right wing (Mirror, LineArray).
double scan_angle_rad(const ScanLaw& law, double u) noexcept;
/// Unit direction in the body frame (forward, right, down), before misalignment. Frame has a camera instead: see framing.h.
Vec3 scan_direction(const ScanLaw& law, double u, double v) noexcept;
/// Direction of a mirror scanner from its angles: across track (right) and along track (forward), Section 2.3 of the notes
/// summed up in docs/scan-geometry.md: (sin tau, cos tau sin sigma, cos tau cos sigma).
Vec3 mirror_direction(double sigma_rad, double tau_rad) noexcept;

/// When scan n sees position u, v, relative to the middle of scan 0 [s]. `n` may be a fraction.
double scan_time_s(const ScanLaw& law, double n, double u, double v) noexcept;
/// Moment whose pose holds for it: the same, or the middle of the sweep behind a line corrector.
double scan_pose_time_s(const ScanLaw& law, double n, double u, double v) noexcept;

}  // namespace pyroscene::sensors
