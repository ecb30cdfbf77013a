#include "sensors/sensor_file.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include <fmt/format.h>

#include "base/constants.h"

namespace pyroscene::sensors {
namespace {

using config::Node;
using config::Range;

constexpr const char* kSchema = "pyroscene-sensor/1";
constexpr double kKnot_m_s = 1852.0 / 3600.0;

/// Accepts keys that describe the instrument but change nothing here: facts for readers, quantities that follow from
/// others (ifov, fov, gsd, swath), and the laws of scan types that have no rays yet.
void accept(const Node& node, std::initializer_list<const char*> keys) {
    for (const char* key : keys) node.ignore(key);
}

void read_platform(const Node& platform, Sensor& sensor) {
    sensor.airborne = platform.choice("type", "airborne", {"airborne", "spaceborne"}) == "airborne";
    sensor.platform_name = platform.text("name", "");
    sensor.altitude_agl_m = platform.number("altitude_agl_m", 0.0, Range::positive());
    sensor.ground_speed_m_s = platform.number("ground_speed_m_s", 0.0, Range::not_negative());
    if (const auto knots = platform.optional_number("ground_speed_knots", Range::not_negative()))
        sensor.ground_speed_m_s = *knots * kKnot_m_s;
    if (const Node orbit = platform.child("orbit"); orbit.present()) {
        sensor.altitude_agl_m = orbit.number("altitude_m", 0.0, Range::positive());
        sensor.ground_speed_m_s = orbit.number("ground_speed_m_s", 0.0, Range::not_negative());
        sensor.orbit = Orbit{sensor.altitude_agl_m, orbit.number("inclination_deg", 0.0, Range::between(0.0, 180.0)),
                             orbit.optional_number("sub_longitude_deg", Range::between(-180.0, 180.0))};
        accept(orbit, {"kind", "local_time"});
        orbit.finish();
    }
    accept(platform, {"alternative", "target_local_m", "position_local_m"});
    platform.finish();
}

void read_distortion(const Node& distortion, CameraGroup& group) {
    if (!distortion.present()) return;
    static_cast<void>(distortion.choice("model", "brown", {"brown"}));
    if (const auto k = distortion.numbers("k", group.radial.size()); !k.empty())
        std::copy(k.begin(), k.end(), group.radial.begin());
    if (const auto p = distortion.numbers("p", group.tangential.size()); !p.empty())
        std::copy(p.begin(), p.end(), group.tangential.begin());
    distortion.finish();
}

/// A frame camera needs four numbers; one that has none of them but a line length is an outline, which can only be listed.
void read_framing_group(const Node& node, CameraGroup& group) {
    const bool outline = node.has("samples_per_line") && !node.has("nx") && !node.has("ny") && !node.has("focal_length_mm");
    if (outline) return;
    const Range pixels = Range::between(1, 100000);
    group.samples = static_cast<int>(node.required_child("nx").as_integer(1, pixels));
    group.lines = static_cast<int>(node.required_child("ny").as_integer(1, pixels));
    group.focal_length_m = 1e-3 * node.required_child("focal_length_mm").as_number(1.0, Range::positive());
    group.pixel_pitch_m = 1e-6 * node.required_child("pixel_pitch_um").as_number(1.0, Range::positive());
    group.principal_point_px = {0.5 * (group.samples - 1), 0.5 * (group.lines - 1)};
}

CameraGroup read_group(const std::string& id, const Node& node, const Node& geometry, const Sensor& sensor) {
    CameraGroup group;
    group.id = id;
    const auto count = [](const Node& parent, const char* key) {
        return static_cast<int>(parent.integer(key, 0, Range::between(1, 1e6)));
    };
    group.samples = count(node, "samples_per_line");
    if (group.samples == 0) group.samples = count(geometry, "samples_per_line");
    group.lines = count(node, "detectors_along_track");
    group.focal_length_m = 1e-3 * node.number("focal_length_mm", 0.0, Range::positive());
    group.pixel_pitch_m = 1e-6 * node.number("pixel_pitch_um", 0.0, Range::positive());
    if (sensor.scan == ScanType::Framing) read_framing_group(node, group);
    if (const auto point = node.numbers("principal_point_px", 2); !point.empty())
        group.principal_point_px = {point[0], point[1]};
    read_distortion(node.child("distortion"), group);
    read_scan(geometry, node, sensor, group);
    accept(node, {"nx",
                  "ny",
                  "ifov_across_mrad",
                  "ifov_along_mrad",
                  "step_across_mrad",
                  "step_mrad",
                  "fov_deg",
                  "gsd_nadir_m",
                  "gsd_edge_m",
                  "gsd_mean_m",
                  "native_gsd_m",
                  "alternative",
                  "alternative_optics",
                  "across_binning",
                  "average_of_fine",
                  "detector_pitch_um",
                  "detectors_across_track",
                  "effective_focal_length_mm",
                  "f_number",
                  "line_period_s",
                  "line_spacing_m",
                  "line_step_m",
                  "modules",
                  "note",
                  "pixels_per_detector",
                  "sample_rate_hz",
                  "sample_spacing_nadir_m",
                  "sample_step_m",
                  "sensor",
                  "subframes_per_frame",
                  "unaggregated_samples"});
    node.finish();
    return group;
}

constexpr std::array<std::pair<const char*, ScanType>, 7> kScanTypes{{{"framing", ScanType::Framing},
                                                                      {"pushbroom", ScanType::Pushbroom},
                                                                      {"whiskbroom", ScanType::Whiskbroom},
                                                                      {"line_scanner", ScanType::LineScanner},
                                                                      {"conical", ScanType::Conical},
                                                                      {"spin_scan", ScanType::SpinScan},
                                                                      {"geo_scan", ScanType::GeoScan}}};

ScanType read_scan_type(const Node& geometry) {
    std::vector<std::string> words;
    for (const auto& [word, type] : kScanTypes) words.emplace_back(word);
    static_cast<void>(geometry.required_child("scan_type"));
    const std::string word = geometry.choice("scan_type", "framing", words);
    const auto found =
        std::find_if(kScanTypes.begin(), kScanTypes.end(), [&](const auto& entry) { return word == entry.first; });
    return found->second;
}

void accept_scan_law(const Node& geometry) {
    accept(geometry, {"active_scan_s",
                      "active_scan_time_s",
                      "aggregation_zones",
                      "along_track_per_scan_m",
                      "arrangement",
                      "bidirectional",
                      "bow_tie",
                      "bow_tie_deletion",
                      "cone_axis_tilt_forward_deg",
                      "cone_half_angle_deg",
                      "constant_resolution",
                      "cross_track_half_angle_deg",
                      "cycle_s",
                      "detector_ifov_mrad",
                      "detectors",
                      "f_number",
                      "fixed_grid",
                      "focal_length_mm",
                      "footprint_m",
                      "forward_overlap",
                      "fov_deg",
                      "frame_deg",
                      "frame_interval_s",
                      "frame_step_mrad",
                      "frame_time_s",
                      "frames_per_scan",
                      "full_disk_s",
                      "gimbal_cross_track_deg",
                      "legacy_samples_per_line",
                      "line_period_s",
                      "line_rate_hz",
                      "mechanism",
                      "min_contiguous_line_rate_hz",
                      "mirror_frequency_hz",
                      "mirror_rate_rpm",
                      "mirror_rpm",
                      "modelling_advice",
                      "note",
                      "oscillation_hz",
                      "pixel_pitch_um",
                      "pixel_time_s",
                      "pixels_per_rotation",
                      "ray_rule",
                      "roll_compensation_deg",
                      "roll_stabilised",
                      "rotation_period_s",
                      "rows_staggered",
                      "sample_pitch_um",
                      "samples_per_line",
                      "scan_direction",
                      "scan_efficiency",
                      "scan_half_angle_deg",
                      "scan_line_corrector",
                      "scan_lines_ir",
                      "scan_lines_vis",
                      "scan_period_s",
                      "scan_rate_hz",
                      "spectral_step_um",
                      "spin_rpm",
                      "stagger_row_distance_um",
                      "step_across_mrad",
                      "step_deg",
                      "step_ns_mrad",
                      "step_rotation_deg",
                      "steps",
                      "swath_m",
                      "time_of_sample",
                      "turnaround_s",
                      "views"});
}

void read_geometry(const Node& geometry, Sensor& sensor) {
    sensor.scan = read_scan_type(geometry);
    if (const auto offset = geometry.numbers("boresight_offset_deg", sensor.boresight_offset_rad.size()); !offset.empty())
        std::transform(offset.begin(), offset.end(), sensor.boresight_offset_rad.begin(),
                       [](double angle_deg) { return angle_deg * kDegree_rad; });
    const Node groups = geometry.required_child("groups");
    for (const auto& id : groups.keys()) sensor.groups.push_back(read_group(id, groups.child(id), geometry, sensor));
    if (groups.present() && sensor.groups.empty()) groups.report("expected at least one group of pixels");
    groups.finish();
    accept_scan_law(geometry);
    geometry.finish();
}

/// Angles between samples and between lines of the first group [mrad]: they turn an angular PSF width into samples.
struct Steps {
    double across_mrad = 1.0, along_mrad = 1.0;
};
Steps sample_steps(const Node& geometry) {
    const Node groups = geometry.child("groups");
    const auto ids = groups.keys();
    const Node group = ids.empty() ? Node() : groups.child(ids.front());
    const double ifov = group.number("ifov_across_mrad", 1.0, Range::positive());
    return {
        group.number("step_across_mrad", geometry.number("step_across_mrad", ifov, Range::positive()), Range::positive()),
        group.number("ifov_along_mrad", ifov, Range::positive())};
}

Psf::Shape psf_shape(const Node& node) {
    const std::string word = node.text("shape", "none");
    if (word == "box_conv_box" || word.starts_with("trapezoid")) return Psf::Shape::Trapezoid;  // may go on in words
    const std::string shape =
        node.choice("shape", "none", {"none", "box", "triangle", "gaussian", "trapezoid", "box_conv_box"});
    if (shape == "box") return Psf::Shape::Box;
    if (shape == "triangle") return Psf::Shape::Triangle;
    if (shape == "gaussian") return Psf::Shape::Gaussian;
    return Psf::Shape::None;
}

Psf read_psf_axis(const Node& node, double step_mrad) {
    Psf psf;
    if (!node.present()) return psf;
    psf.shape = psf_shape(node);
    const auto fwhm_mrad = node.optional_number("fwhm_mrad", Range::positive());
    const double fwhm = node.number("fwhm_samples", fwhm_mrad.value_or(step_mrad) / step_mrad, Range::positive());
    // A triangle is twice as wide at its base as at half height; a box is as wide everywhere.
    const double base =
        node.number("width_samples", psf.shape == Psf::Shape::Triangle ? 2.0 * fwhm : fwhm, Range::positive());
    psf.width_samples = node.number("base_samples", psf.shape == Psf::Shape::Gaussian ? fwhm : base, Range::positive());
    // Without two widths: three samples summed, each a box of a third seen through a detector of a third.
    if (psf.shape == Psf::Shape::Trapezoid) psf.second_width_samples = psf.width_samples / 3.0;
    if (const auto widths = node.numbers("widths_samples", 2); !widths.empty()) {
        psf.width_samples = widths[0];
        psf.second_width_samples = widths[1];
        if (!(widths[0] > 0.0 && widths[1] > 0.0)) node.report("widths_samples must be > 0");
    }
    node.ignore("reason");
    node.finish();
    return psf;
}

std::vector<std::array<std::string, 2>> read_pairs(const Node& node) {
    std::vector<std::array<std::string, 2>> pairs;
    for (const auto& key : node.keys()) pairs.push_back({key, node.text(key, "")});
    return pairs;
}

}  // namespace

Sensor read_sensor_file(const std::filesystem::path& path) {
    const config::Document document(path);
    const Node root = document.root();
    Sensor sensor;
    sensor.source_path = path.string();
    if (const Node schema = root.required_child("schema"); schema.present() && schema.as_text(kSchema) != kSchema)
        schema.report(fmt::format("found '{}', expected '{}'", schema.as_text(""), kSchema));
    sensor.id = root.required_child("id").as_text("");
    sensor.name = root.text("name", sensor.id);
    const Node platform = root.required_child("platform"), geometry = root.required_child("geometry"),
               psf = root.child("psf");
    read_platform(platform, sensor);
    read_geometry(geometry, sensor);
    const Steps steps = sample_steps(geometry);
    sensor.psf_across = read_psf_axis(psf.child("along_scan"), steps.across_mrad);
    sensor.psf_along = read_psf_axis(psf.child("along_track"), steps.along_mrad);
    if (const Node stray = psf.child("stray"); stray.present()) {
        sensor.stray.share = stray.required_child("share").as_number(0.0, Range::between(0.0, 0.5));
        sensor.stray.fwhm_samples = stray.required_child("fwhm_samples").as_number(1.0, Range::between(0.5, 1000.0));
        stray.ignore("note");
        stray.finish();
    }
    accept(psf, {"mtf_nyquist", "note", "optics_blur_fwhm_samples"});
    psf.finish();
    read_bands(root, read_digitisation(root.child("digitisation")), sensor);
    read_distribution(root.child("distribution"), sensor);
    sensor.confidence = read_pairs(root.child("confidence"));
    sensor.sources = read_pairs(root.child("sources"));
    accept(root, {"fire_notes", "notes", "scene", "thesis_maxima_w_cm2_sr_um"});
    root.finish();
    document.throw_if_any();
    return sensor;
}

}  // namespace pyroscene::sensors
