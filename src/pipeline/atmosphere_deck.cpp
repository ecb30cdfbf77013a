#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/constants.h"
#include "base/error.h"
#include "base/files.h"
#include "inputs/scene_inputs.h"
#include "pipeline/acquisition.h"
#include "pipeline/atmosphere_deck_codes.h"
#include "radiometry/sun.h"
#include "sensors/sensor.h"

namespace pyroscene::pipeline {
namespace {

const scenario::Acquisition& find(const scenario::Scenario& s, const std::string& id) {
    std::vector<std::string> ids;
    for (const auto& a : s.acquisitions) {
        if (a.id == id) return a;
        ids.push_back(a.id);
    }
    throw input_error("--acquisition", fmt::format("no '{}'; there are {}", id, fmt::join(ids, ", ")));
}

/// Angle from the vertical of the farthest corner of any camera group of the acquisition; the widest tabulated angle for other
/// scanners.
double widest_view_deg(const scenario::Acquisition& a, const sensors::Sensor& sensor) {
    constexpr double kWidest_deg = 65.0;
    double half_rad = 0.0;
    for (const auto& id : wanted_groups(a, sensor)) {
        const auto& g = sensor.group(id);
        if (!(g.focal_length_m > 0.0)) return kWidest_deg;
        half_rad = std::max(half_rad, std::atan(0.5 * std::hypot(g.samples, g.lines) * g.pixel_pitch_m / g.focal_length_m));
    }
    const double tilt_rad =
        std::acos(std::cos(a.platform.pitch_deg * kDegree_rad) * std::cos(a.platform.roll_deg * kDegree_rad));
    return std::min((tilt_rad + half_rad) / kDegree_rad, kWidest_deg);
}

}  // namespace

int deck_model_number(const std::string& model) {
    constexpr std::array<std::pair<const char*, int>, 5> kNumbers{{{"tropical", 1},
                                                                   {"midlatitude_summer", 2},
                                                                   {"midlatitude_winter", 3},
                                                                   {"subarctic_summer", 4},
                                                                   {"us_standard_1976", 6}}};
    for (const auto& [name, number] : kNumbers)
        if (model == name) return number;
    return 2;
}

DeckGeometry deck_geometry(const scenario::Scenario& s, const std::string& acquisition_id) {
    const auto& a = find(s, acquisition_id);
    if (!s.atmosphere.file && s.atmosphere.model == "none")
        throw input_error("atmosphere.model", "'none' has no air that a code could compute; name a model atmosphere");
    const auto in = inputs::load_scene_inputs(s);
    const auto sensor = sensors::load_sensor(a.sensor);
    DeckGeometry g;
    g.model = s.atmosphere.model;
    g.visibility_km = s.atmosphere.visibility_km;
    g.ground_elevation_km = 1e-3 * s.atmosphere.ground_elevation_m.value_or(in.mean_height_m);
    const auto& p = a.platform;
    const double above_mean_m = p.altitude_m ? *p.altitude_m - in.mean_height_m
                                : p.altitude_agl_m
                                    ? *p.altitude_agl_m + in.highest_m - in.mean_height_m  // wherever it flies
                                    : sensor.altitude_agl_m;
    g.sensor_altitude_km = 1e-3 * std::max(above_mean_m, 1.0);
    const double widest_deg = widest_view_deg(a, sensor);
    for (const double node : {0.0, 20.0, 40.0, 55.0, 65.0}) {
        g.view_zenith_deg.push_back(node);
        if (node >= widest_deg) break;
    }
    const double unix_s = s.start.unix_s + a.time_s;
    const auto sun = radiometry::sun_position(unix_s, in.centre.lat_deg, in.centre.lon_deg);
    g.sun_zenith_deg = s.render.sun ? sun.zenith_rad / kDegree_rad : 180.0;
    const std::string date = UtcTime{unix_s}.iso8601();
    const auto year_start = parse_utc(date.substr(0, 4) + "-01-01T00:00:00Z");
    g.day_of_year = 1 + static_cast<int>((unix_s - year_start->unix_s) / 86400.0);
    g.lower_um = 1e3;
    g.upper_um = 0.0;
    for (const auto& group : wanted_groups(a, sensor))
        for (const int b : wanted_bands(a, sensor, group)) {
            const auto& lambda_um = sensor.bands[static_cast<std::size_t>(b)].response.lambda_um;
            g.lower_um = std::min(g.lower_um, 0.99 * lambda_um.front());
            g.upper_um = std::max(g.upper_um, 1.01 * lambda_um.back());
        }
    return g;
}

std::vector<DeckRun> deck_runs(const DeckGeometry& g) {
    const bool day = g.sun_zenith_deg < 89.0;
    std::vector<DeckRun> runs;
    const auto add = [&](double view, double azimuth, double albedo, bool sun) {
        runs.push_back({fmt::format("run_{:02d}", runs.size()), view, azimuth, albedo, sun});
    };
    for (const double view : g.view_zenith_deg) {
        if (!day) {
            add(view, 0.0, 0.0, false);
            continue;
        }
        add(view, 0.0, 0.0, true);
        if (view > 0.0) add(view, 90.0, 0.0, true);
        if (view > 0.0) add(view, 180.0, 0.0, true);
        add(view, 0.0, 0.5, true);
    }
    if (day) add(0.0, 0.0, 1.0, true);
    add(0.0, 0.0, 1.0, false);
    return runs;
}

DeckFiles deck_files(const DeckGeometry& g, const std::string& code) {
    if (code == "modtran6") return modtran6_files(g, deck_runs(g));
    if (code == "modtran5") return modtran5_files(g, deck_runs(g));
    if (code == "libradtran") return libradtran_files(g);
    throw input_error("--for", fmt::format("'{}' is unknown; there are modtran6, modtran5, libradtran", code));
}

std::vector<std::string> write_atmosphere_deck(const scenario::Scenario& s, const std::string& acquisition_id,
                                               const std::string& code, const std::filesystem::path& folder) {
    const auto files = deck_files(deck_geometry(s, acquisition_id), code);
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    if (failed) throw runtime_error(folder.string(), "cannot be made: " + failed.message());
    std::vector<std::string> names;
    for (const auto& [name, text] : files) {
        write_text_file(folder / name, text);
        names.push_back(name);
    }
    return names;
}

}  // namespace pyroscene::pipeline
