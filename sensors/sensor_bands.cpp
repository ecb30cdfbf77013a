#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/csv.h"
#include "base/error.h"
#include "base/files.h"
#include "sensors/sensor_file.h"

namespace fs = std::filesystem;

namespace pyroscene::sensors {
namespace {

using config::Node;
using config::Range;

/// Nominal band between its edges: two points, zero outside (Spectrum::at with clamp = false).
Spectrum boxcar(double lower_um, double upper_um) { return {Quantity::Response, {lower_um, upper_um}, {1.0, 1.0}}; }

/// Gaussian responses end where they are 0.2 % of the peak, as the channel tables prescribe.
constexpr double kGaussianReach_fwhm = 1.5;

/// exp(-4 ln2 ((l - centre) / fwhm)^2)
Spectrum gaussian(double centre_um, double fwhm_um) {
    constexpr int kHalfPoints = 30;
    Spectrum s{Quantity::Response, {}, {}};
    for (int i = -kHalfPoints; i <= kHalfPoints; ++i) {
        const double offset_fwhm = kGaussianReach_fwhm * i / kHalfPoints;
        s.lambda_um.push_back(centre_um + offset_fwhm * fwhm_um);
        s.value.push_back(std::exp(-4.0 * std::log(2.0) * offset_fwhm * offset_fwhm));
    }
    return s;
}

/// Tables named by a sensor file: beside it, one folder up (specs/ and srf/ are neighbours), or among the shipped ones.
class Tables {
public:
    explicit Tables(fs::path sensor_file) : sensor_file_(std::move(sensor_file)) {}

    const CsvTable& open(const std::string& name) {
        if (const auto known = tables_.find(name); known != tables_.end()) return known->second;
        return tables_.emplace(name, read_csv(find(name))).first->second;
    }

private:
    [[nodiscard]] fs::path find(const std::string& name) const {
        const fs::path folder = sensor_file_.parent_path();
        for (const fs::path& candidate : {folder / name, folder / ".." / name, sensor_folder() / name})
            if (fs::is_regular_file(candidate)) return candidate;
        throw input_error(name, fmt::format("no such table in '{}', the folder above, or '{}'", folder.string(),
                                            sensor_folder().string()));
    }

    fs::path sensor_file_;
    std::map<std::string, CsvTable> tables_;
};

/// Response of one band from a table `band,wavelength_um,response`, scaled to a peak of 1.
Spectrum measured_response(const CsvTable& table, const std::string& band) {
    const std::size_t name = table.column("band");
    const auto wavelength_um = table.numbers("wavelength_um"), response = table.numbers("response");
    Spectrum s{Quantity::Response, {}, {}};
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        if (table.rows[i][name] != band) continue;
        const std::string place = fmt::format("{}:{}", table.path, table.row_lines[i]);
        if (!(wavelength_um[i] > (s.lambda_um.empty() ? 0.0 : s.lambda_um.back())))
            throw input_error(place, fmt::format("wavelength {} of band '{}' does not ascend", wavelength_um[i], band));
        if (!(response[i] >= 0.0)) throw input_error(place, fmt::format("response {}, expected at least 0", response[i]));
        s.lambda_um.push_back(wavelength_um[i]);
        s.value.push_back(response[i]);
    }
    const double peak = s.value.empty() ? 0.0 : *std::max_element(s.value.begin(), s.value.end());
    if (s.value.size() < 2 || !(peak > 0.0)) throw input_error(table.path, fmt::format("no response of a band '{}'", band));
    for (double& r : s.value) r /= peak;
    return s;
}

void read_nominal_response(const Node& node, const std::array<double, 2>& edges_um, const std::string& shape, Band& band) {
    band.response_source = fmt::format("{} {:g} - {:g} um", shape, edges_um[0], edges_um[1]);
    if (shape == "boxcar") {
        band.response = boxcar(edges_um[0], edges_um[1]);
    } else if (band.centre_um > kGaussianReach_fwhm * band.fwhm_um) {
        band.response = gaussian(band.centre_um, band.fwhm_um);
    } else {
        node.report(fmt::format("a gaussian of width {:g} um around {:g} um reaches below 0", band.fwhm_um, band.centre_um));
    }
}

/// Fills the response; leaves it empty, with a problem reported, when it cannot be had.
void read_response(const Node& node, const std::optional<std::array<double, 2>>& edges_um, Tables& tables, Band& band) {
    band.measured_response = node.choice("srf", "nominal", {"nominal", "measured"}) == "measured";
    const std::string shape = node.choice("srf_shape", "boxcar", {"boxcar", "gaussian"});
    const Node file = band.measured_response ? node.required_child("srf_file") : node.child("srf_file");
    const std::string column = node.text("srf_band", band.id);
    if (!band.measured_response && edges_um) read_nominal_response(node, *edges_um, shape, band);
    if (!band.measured_response || !file.present()) return;
    band.response_source = fmt::format("{}, band {}", file.as_text(""), column);
    try {
        band.response = measured_response(tables.open(file.as_text("")), column);
    } catch (const Error& problem) {
        file.report(problem.what());
    }
}

/// Group named by a band; "all", or nothing, means the only one there is.
std::string read_group_name(const Node& node, const Sensor& sensor) {
    const std::string name = node.text("group", "all");
    if (name == "all" && sensor.groups.size() == 1) return sensor.groups.front().id;
    std::vector<std::string> ids;
    for (const auto& group : sensor.groups) ids.push_back(group.id);
    if (std::find(ids.begin(), ids.end(), name) == ids.end())
        node.child("group").report(
            fmt::format("no group '{}' in geometry.groups; there are {}", name, fmt::join(ids, ", ")));
    return name;
}

/// Nominal 50 % points of a band; nothing, and a problem reported, when they cannot be used.
std::optional<std::array<double, 2>> read_edges(const Node& node) {
    static_cast<void>(node.required_child("edges_um"));
    const auto edges_um = node.numbers("edges_um", 2);
    if (edges_um.empty()) return std::nullopt;
    if (edges_um[0] > 0.0 && edges_um[0] < edges_um[1]) return std::array{edges_um[0], edges_um[1]};
    node.child("edges_um").report(fmt::format("[{:g}, {:g}] um, expected 0 < lower < upper", edges_um[0], edges_um[1]));
    return std::nullopt;
}

Band read_band(const Node& node, const Digitisation& digitisation, const Sensor& sensor, Tables& tables) {
    Band band;
    band.id = node.required_child("id").as_text("");
    band.group = read_group_name(node, sensor);
    band.centre_um = node.required_child("center_um").as_number(1.0, Range::positive());
    const auto edges_um = read_edges(node);
    if (edges_um) band.fwhm_um = (*edges_um)[1] - (*edges_um)[0];
    read_response(node, edges_um, tables, band);
    read_detector(node, digitisation, band);
    for (const char* key : {"derived", "detector", "gain", "minimum_temperature_k", "noise_requirement_k",
                            "thermal_constants", "time_shared_with"})
        node.ignore(key);
    node.finish();
    return band;
}

/// Channels of an imaging spectrometer: a table `channel,center_um,fwhm_um` with gaussian responses.
void read_channel_table(const Node& spectral, Tables& tables, Sensor& sensor) {
    static_cast<void>(spectral.choice("srf", "gaussian", {"gaussian"}));
    const Node file = spectral.required_child("bands_file");
    const std::string group = read_group_name(spectral, sensor);
    for (const char* key : {"alternative_bands_file", "channels", "kind", "range_um", "spectrometers", "srf_rule"})
        spectral.ignore(key);
    spectral.finish();
    if (!file.present()) return;
    try {
        const CsvTable& table = tables.open(file.as_text(""));
        const std::size_t name = table.column("channel");
        const auto centre_um = table.numbers("center_um"), fwhm_um = table.numbers("fwhm_um");
        for (std::size_t i = 0; i < table.rows.size(); ++i) {
            if (!(fwhm_um[i] > 0.0) || !(centre_um[i] > kGaussianReach_fwhm * fwhm_um[i]))
                throw input_error(
                    fmt::format("{}:{}", table.path, table.row_lines[i]),
                    fmt::format("centre {} um, width {} um: expected a positive channel", centre_um[i], fwhm_um[i]));
            Band band;
            band.id = table.rows[i][name];
            band.group = group;
            band.centre_um = centre_um[i];
            band.fwhm_um = fwhm_um[i];
            band.response = gaussian(centre_um[i], fwhm_um[i]);
            band.response_source = fmt::format("gaussian, {}", file.as_text(""));
            sensor.bands.push_back(std::move(band));
        }
    } catch (const Error& problem) {
        file.report(problem.what());
    }
}

}  // namespace

void read_bands(const Node& root, const Digitisation& digitisation, Sensor& sensor) {
    Tables tables(sensor.source_path);
    if (const Node spectral = root.child("spectral"); spectral.present()) {
        read_channel_table(spectral, tables, sensor);
        read_channel_detectors(root, digitisation, sensor.bands);
        return;
    }
    const Node list = root.required_child("bands");
    for (const Node& node : list.items()) {
        Band band = read_band(node, digitisation, sensor, tables);
        if (sensor.band_index(band.id) >= 0) node.report(fmt::format("band '{}' is given twice", band.id));
        sensor.bands.push_back(std::move(band));
    }
    if (list.present() && sensor.bands.empty()) list.report("expected at least one band");
}

}  // namespace pyroscene::sensors
