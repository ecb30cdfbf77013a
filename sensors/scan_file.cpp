#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/constants.h"
#include "sensors/sensor_file.h"

namespace pyroscene::sensors {
namespace {

using config::Node;
using config::Range;

/// What the sections geometry and geometry.groups.<g> of a file say together; the group's own number wins.
class Numbers {
public:
    Numbers(const Node& geometry, const Node& group) : geometry_(geometry), group_(group) {}

    /// 0 when neither has it.
    [[nodiscard]] double either(const char* key) const {
        const double common = geometry_.number(key, 0.0, Range::positive());
        return group_.number(key, common, Range::positive());
    }
    [[nodiscard]] double common(const char* key) const { return geometry_.number(key, 0.0, Range::positive()); }
    [[nodiscard]] double own(const char* key) const { return group_.number(key, 0.0, Range::positive()); }
    [[nodiscard]] double first_of(const char* key) const {
        const auto numbers = group_.numbers(key);
        return numbers.empty() ? 0.0 : numbers.front();
    }
    [[nodiscard]] bool flag(const char* key) const { return geometry_.boolean(key, false); }
    [[nodiscard]] const Node& geometry() const { return geometry_; }
    [[nodiscard]] const Node& group() const { return group_; }

private:
    const Node &geometry_, &group_;
};

double first_positive(std::initializer_list<double> candidates) {
    const auto found = std::find_if(candidates.begin(), candidates.end(), [](double c) { return c > 0.0; });
    return found == candidates.end() ? 0.0 : *found;
}

/// Distance to the side of the ground track of what the end of a line looks at, on a sphere; infinite past the horizon.
double half_swath_m(ScanLaw law, int positions, double height_m) {
    constexpr double kEarthRadius_m = 6378137.0;
    law.positions = positions;
    const Vec3 d = scan_direction(law, positions, 0.5 * law.lines_per_scan);
    const double sideways = std::hypot(d.x, d.y), nadir_angle = std::atan2(sideways, d.z);
    const double sine = (1.0 + height_m / kEarthRadius_m) * std::sin(nadir_angle);
    if (sine >= 1.0) return 1e30;
    return kEarthRadius_m * (std::asin(sine) - nadir_angle) * std::abs(d.y) / sideways;
}

/// Positions that see a strip of this width.
int positions_for_swath(const ScanLaw& law, double swath_m, double height_m) {
    // A quarter turn to each side: beyond it a cone comes back.
    int low = 1, high = static_cast<int>(std::min(1e5, kPi / std::max(1e-9, law.step_across_rad)));
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        (half_swath_m(law, middle, height_m) < 0.5 * swath_m ? low : high) = middle;
    }
    return low;
}

/// Times between scans: one period, or rates to choose from.
void read_period(const Numbers& n, ScanLaw& law) {
    std::vector<double> rates_hz = n.geometry().numbers("scan_rate_hz");
    if (const double rate_hz = n.common("line_rate_hz"); rate_hz > 0.0) rates_hz.push_back(rate_hz);
    std::sort(rates_hz.begin(), rates_hz.end());
    const double turned_s = n.common("active_scan_s") > 0.0 ? n.common("active_scan_s") + n.common("turnaround_s") : 0.0;
    law.period_s = first_positive({n.own("line_period_s"), n.common("line_period_s"), n.common("scan_period_s"),
                                   n.common("rotation_period_s"), turned_s});
    if (law.period_s > 0.0 || rates_hz.empty()) return;
    if (!(rates_hz.front() > 0.0)) n.geometry().child("scan_rate_hz").report("expected more than 0");
    law.period_s = 1.0 / rates_hz.front();
    if (rates_hz.size() > 1) law.rates_hz = rates_hz;
}

void read_pushbroom(const Numbers& n, CameraGroup& group) {
    ScanLaw& law = group.scan;
    group.focal_length_m = 1e-3 * n.either("focal_length_mm");
    group.pixel_pitch_m = 1e-6 * n.either("pixel_pitch_um");
    const bool own_array = n.own("pixel_pitch_um") > 0.0;
    const double ifov_rad = 1e-3 * n.own("ifov_across_mrad");
    if (group.focal_length_m > 0.0 && group.pixel_pitch_m > 0.0) {
        const double sample_pitch_m = own_array ? 0.0 : 1e-6 * n.common("sample_pitch_um");
        law.kind = ScanLaw::Kind::Pushbroom;
        law.pitch_over_focal = (sample_pitch_m > 0.0 ? sample_pitch_m : group.pixel_pitch_m) / group.focal_length_m;
        law.step_across_rad = law.pitch_over_focal;
        law.step_along_rad = group.pixel_pitch_m / group.focal_length_m;
        const double view_rad = n.either("fov_deg") * kDegree_rad;
        if (law.positions == 0) law.positions = static_cast<int>(2.0 * std::tan(0.5 * view_rad) / law.pitch_over_focal);
        law.centre_position = 0.5 * (law.positions - 1);
        const auto rows = own_array ? 0 : n.geometry().integer("rows_staggered", 0, Range::between(1, 2));
        if (rows == 2) law.stagger = 0.5 * 1e-6 * n.common("stagger_row_distance_um") / group.pixel_pitch_m;
    } else {
        law.kind = ScanLaw::Kind::LineArray;
        const double half_rad = n.common("cross_track_half_angle_deg") * kDegree_rad;
        law.step_across_rad = half_rad > 0.0 && law.positions > 0 ? 2.0 * half_rad / law.positions : ifov_rad;
        law.step_along_rad = 1e-3 * n.own("ifov_along_mrad");
    }
    law.lines_per_scan = 1;
}

/// VIIRS: zones of averaged samples, and the lines at the rim of a scan that are not sent from them.
void read_zones(const Numbers& n, const std::string& group_id, ScanLaw& law) {
    const Node node = n.geometry().child("aggregation_zones");
    const int samples = law.positions;
    const auto whole = n.group().integer("unaggregated_samples", 0, Range::between(1, 1e6));
    const auto pixels = node.numbers("aggregated_per_side_m"), widths = node.numbers("samples_averaged", pixels.size());
    for (const char* key : {"half_angle_deg", "single_gain_only", "note"}) node.ignore(key);
    node.finish();
    if (whole == 0 || pixels.empty() || widths.empty()) return;
    double total = 0.0;
    for (const double p : pixels) total += 2.0 * p;
    const Node deletion = n.geometry().child("bow_tie_deletion");
    const char* keys[] = {"zone_2to1_rows_each_side", "zone_1to1_rows_each_side"};
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        ScanLaw::Zone zone{static_cast<int>(std::lround(pixels[i] * samples / total)), static_cast<int>(widths[i]), 0};
        if (deletion.present() && i > 0 && i < 3) {
            const Node rows = deletion.child(keys[i - 1]);
            for (const auto& key : rows.keys()) {
                const auto count = rows.integer(key, 0, Range::between(0, 100));
                if (key == group_id) zone.deleted_rows = static_cast<int>(count);
            }
        }
        law.zones.push_back(zone);
    }
    law.positions = static_cast<int>(whole);
}

void read_mirror(const Numbers& n, const Sensor& sensor, const CameraGroup& group, ScanLaw& law) {
    law.kind = ScanLaw::Kind::Mirror;
    const auto subframes = static_cast<double>(n.group().integer("subframes_per_frame", 1, Range::between(1, 100)));
    law.step_across_rad = 1e-3 * first_positive({n.common("frame_step_mrad") / subframes, n.own("step_across_mrad"),
                                                 n.common("step_across_mrad"), n.own("ifov_across_mrad")});
    law.step_along_rad = 1e-3 * n.own("ifov_along_mrad");
    if (!(law.step_along_rad > 0.0) && sensor.altitude_agl_m > 0.0)
        law.step_along_rad = n.first_of("gsd_nadir_m") / sensor.altitude_agl_m;
    if (!(law.step_along_rad > 0.0)) law.step_along_rad = 1e-3 * n.own("ifov_across_mrad");
    law.orbit_height_m = sensor.altitude_agl_m;
    const double swath_m = n.common("swath_m");
    const double sample_step_m = n.own("sample_step_m");
    if (sample_step_m > 0.0 || !(law.step_across_rad > 0.0))
        law.ground_spacing_m = sample_step_m > 0.0 ? sample_step_m : swath_m / std::max(1, law.positions);
    if (law.positions == 0) law.positions = positions_for_swath(law, swath_m, sensor.altitude_agl_m);
    if (n.common("oscillation_hz") > 0.0) {
        law.alternating = true;
        law.amplitude_rad = n.common("scan_half_angle_deg") * kDegree_rad;
        // Samples at equal distances: as many as the swing reaches.
        while (law.positions > 1 && scan_angle_rad(law, law.positions) > law.amplitude_rad) --law.positions;
    }
    law.alternating = law.alternating || n.flag("bidirectional");
    law.line_corrector = n.flag("scan_line_corrector");
    // A single detector on the axis stays there; that its outline turns too is part of the point-spread function's width.
    const bool single_mirror = n.geometry().choice("mirror", "paddle", {"paddle", "rotating_45"}) == "rotating_45";
    law.image_rotates = single_mirror && law.lines_per_scan > 1;
    read_period(n, law);
    const double sample_time_s = first_positive(
        {n.common("frame_time_s") / subframes, n.own("sample_rate_hz") > 0.0 ? 1.0 / n.own("sample_rate_hz") : 0.0,
         n.common("active_scan_s") / law.positions, n.common("scan_efficiency") * law.period_s / law.positions});
    // A line of sight that turns evenly: once round in the time of a scan, as behind a 45 deg mirror or two-faced paddle.
    law.scan_rate_rad_s = sample_time_s > 0.0 && law.step_across_rad > 0.0 ? law.step_across_rad / sample_time_s
                          : law.period_s > 0.0                             ? 2.0 * kPi / law.period_s
                                                                           : 0.0;
    read_zones(n, group.id, law);
    law.roll_compensation_rad = n.common("roll_compensation_deg") * kDegree_rad;
    if (n.flag("roll_stabilised")) law.roll_compensation_rad = kPi;
}

/// Views of a cone, the first in the file first.
void read_cone(const Numbers& n, const Sensor& sensor, CameraGroup& group) {
    ScanLaw law = group.scan;
    law.kind = ScanLaw::Kind::Cone;
    law.cone_half_angle_rad = n.common("cone_half_angle_deg") * kDegree_rad;
    law.cone_tilt_rad = n.geometry().number("cone_axis_tilt_forward_deg", 0.0, Range::between(-90.0, 90.0)) * kDegree_rad;
    law.step_along_rad = 1e-3 * n.own("ifov_along_mrad");
    if (!(law.step_along_rad > 0.0)) law.step_along_rad = n.first_of("gsd_nadir_m") / sensor.altitude_agl_m;
    const double across_rad = first_positive({1e-3 * n.own("ifov_across_mrad"), law.step_along_rad});
    const double step_deg = n.common("step_rotation_deg");
    law.step_across_rad = step_deg > 0.0 ? step_deg * kDegree_rad : across_rad / std::sin(law.cone_half_angle_rad);
    read_period(n, law);
    law.scan_rate_rad_s = law.period_s > 0.0 ? 2.0 * kPi / law.period_s : 0.0;
    const Node views = n.geometry().child("views");
    for (const auto& name : views.keys()) {
        const Node view = views.child(name);
        ScanLaw one = law;
        const double middle_deg = view.number("rotation_deg", name == "nadir" ? 180.0 : 0.0, Range::between(-360.0, 360.0));
        one.cone_centre_rad = middle_deg * kDegree_rad;
        one.positions = static_cast<int>(view.integer("pixels", 0, Range::between(1, 100000)));
        const double swath_m = view.number("swath_m", 0.0, Range::positive());
        if (view.boolean("straight", false)) {
            one.kind = ScanLaw::Kind::Mirror;
            one.step_across_rad = across_rad;
        }
        if (one.positions == 0) one.positions = positions_for_swath(one, swath_m, sensor.altitude_agl_m);
        for (const char* key : {"offset", "zenith_deg", "note"}) view.ignore(key);
        view.finish();
        group.views.push_back({name, one});
    }
    if (group.views.empty())
        views.report("expected at least one view");
    else
        group.scan = group.views.front().scan;
}

void read_disk(const Numbers& n, const Sensor& sensor, const CameraGroup& group, ScanLaw& law) {
    law.kind = ScanLaw::Kind::Disk;
    if (sensor.scan == ScanType::GeoScan) {
        law.step_across_rad = law.step_along_rad = 1e-3 * n.own("step_mrad");
        const double disk_rad = 1e-3 * n.common("full_disk_mrad");
        law.positions = law.lines_per_scan =
            law.step_along_rad > 0.0 ? static_cast<int>(std::lround(disk_rad / law.step_along_rad)) : 0;
        const Node fixed_grid = n.geometry().child("fixed_grid");
        law.sweep_x = fixed_grid.choice("sweep_axis", "y", {"x", "y"}) == "x";
        for (const char* key : {"perspective_height_m", "semi_major_m", "semi_minor_m"}) fixed_grid.ignore(key);
        fixed_grid.finish();
        law.period_s = n.common("full_disk_s") / std::max(1, law.lines_per_scan);
        return;
    }
    const double infrared_lines = n.common("scan_lines_ir"), spin_s = 60.0 / std::max(1e-9, n.common("spin_rpm"));
    const double lines = group.id == "vis" ? n.common("scan_lines_vis") : infrared_lines;
    law.lines_per_scan = static_cast<int>(lines);
    const double turns_per_line = lines > 0.0 ? infrared_lines / lines : 0.0;
    law.step_along_rad = 1e-3 * n.common("step_ns_mrad") * turns_per_line;
    law.step_across_rad = 1e-3 * first_positive({n.own("step_across_mrad"), n.own("ifov_across_mrad")});
    const auto frame_deg = n.geometry().numbers("frame_deg");
    constexpr double kUsualFrame_deg = 20.0;
    if (law.positions == 0 && law.step_across_rad > 0.0)
        law.positions =
            static_cast<int>((frame_deg.empty() ? kUsualFrame_deg : frame_deg.front()) * kDegree_rad / law.step_across_rad);
    law.period_s = spin_s * turns_per_line;
    law.scan_rate_rad_s = 2.0 * kPi / spin_s;
}

/// Coarse pixels that are means of fine ones (OLS): as many fewer, as much larger.
void average_pixels(const Numbers& n, ScanLaw& law) {
    const auto counts = n.group().numbers("average_of_fine");
    if (counts.size() != 2 || !(counts[0] >= 1.0 && counts[1] >= 1.0)) return;
    law.period_s *= counts[0];
    // Every second sweep runs the other way only as long as each sweep makes a line.
    if (counts[0] > 1.0) law.alternating = false;
}

void finish(const CameraGroup& group, const Node& node, const char* view, const ScanLaw& law) {
    if (law.positions > 0 && law.lines_per_scan > 0 && law.step_along_rad > 0.0 &&
        (law.step_across_rad > 0.0 || law.ground_spacing_m > 0.0))
        return;
    node.report(
        fmt::format("group '{}'{}: samples per line and the angles of a pixel do not follow from the file; give "
                    "samples_per_line, ifov_across_mrad and ifov_along_mrad",
                    group.id, view));
}

}  // namespace

void read_scan(const Node& geometry, const Node& node, const Sensor& sensor, CameraGroup& group) {
    const Numbers n(geometry, node);
    ScanLaw& law = group.scan;
    law.positions = group.samples;
    law.lines_per_scan = std::max(1, group.lines);
    law.right_to_left = geometry.choice("first_sample", "left", {"left", "right"}) == "right";
    law.leading_detector_first = geometry.choice("first_detector", "trailing", {"trailing", "leading"}) == "leading";
    switch (sensor.scan) {
        case ScanType::Framing:
            if (group.focal_length_m > 0.0) return;  // Frame: the camera itself says how it looks
            read_pushbroom(n, group);
            break;
        case ScanType::Pushbroom:
            read_pushbroom(n, group);
            read_period(n, law);
            if (const double step_m = n.own("line_step_m"); step_m > 0.0 && !(law.period_s > 0.0))
                law.period_s = sensor.ground_speed_m_s > 0.0 ? step_m / sensor.ground_speed_m_s : 0.0;
            break;
        case ScanType::Whiskbroom:
        case ScanType::LineScanner:
            read_mirror(n, sensor, group, law);
            average_pixels(n, law);
            break;
        case ScanType::Conical:
            read_cone(n, sensor, group);
            break;
        case ScanType::SpinScan:
        case ScanType::GeoScan:
            read_disk(n, sensor, group, law);
            break;
    }
    finish(group, node, "", law);
    for (const auto& view : group.views) finish(group, node, (", view '" + view.name + "'").c_str(), view.scan);
    group.samples = law.samples();
    group.lines = law.lines_per_scan;
}

}  // namespace pyroscene::sensors
