#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/files.h"
#include "pipeline/acquisition.h"
#include "pipeline/footprints.h"
#include "pipeline/ground_reflectance.h"
#include "pipeline/plume_scene.h"
#include "pipeline/run.h"
#include "pipeline/scenario_warnings.h"
#include "radiometry/spectral_grid.h"
#include "radiometry/sun.h"

namespace pyroscene::pipeline {
namespace {

using scenario::Scenario;

/// Runs one test; what it throws as a refusal of input becomes a problem.
bool passes(CheckResult& result, const std::function<void()>& test) {
    try {
        test();
        return true;
    } catch (const Error& e) {
        result.problems.emplace_back(e.what());
        return false;
    }
}

/// Every raster for itself, so that all problems show at once even when the terrain is fine and others are not.
void check_rasters(const Scenario& s, const inputs::SceneInputs& in, CheckResult& result) {
    for (std::size_t i = 0; i < in.frames.size(); ++i)
        if (!passes(result, [&] { (void)inputs::load_frame(s, in, i); })) break;
    if (s.inputs.plume && !s.acquisitions.empty())
        passes(result, [&] { (void)make_plume(s, in, s.acquisitions.front().time_s); });
    if (s.inputs.fuel_load) {
        const auto& fuel = *s.inputs.fuel_load;
        passes(result, [&] {
            (void)gis::read_band({fuel.files.front(), fuel.bands.empty() ? 1 : fuel.bands.front(), gis::Resampling::Conserve,
                                  "fuel load", "kg m-2"},
                                 in.grid);
        });
    }
}

/// Nominal cost of a ray and of a ray times wavelength, one core of an ordinary machine [s]; docs/physics-render.md measures them.
constexpr double kRay_s = 1.0e-6, kRayWavelength_s = 1.0e-8, kPixelWavelength_s = 2.0e-8;

/// How many wavelengths each band takes: one by one where they are few, else the fewest and the most.
std::string per_band_text(const radiometry::SpectralGrid& grid, const std::vector<std::string>& ids) {
    constexpr std::size_t kFew = 8;
    std::vector<std::string> each;
    int fewest = grid.size(), most = 0;
    for (std::size_t b = 0; b < ids.size(); ++b) {
        const int n = grid.bands[b].end - grid.bands[b].begin;
        fewest = std::min(fewest, n);
        most = std::max(most, n);
        each.push_back(fmt::format("{}: {}", ids[b], n));
    }
    if (ids.size() <= kFew) return fmt::format("{}", fmt::join(each, ", "));
    return fewest == most ? fmt::format("{} a band", most) : fmt::format("{} to {} a band", fewest, most);
}

/// Wavelengths that the bands of a group are computed at: how many in all and per band, and without hot gas.
std::string wavelengths_text(const radiometry::SpectralGrid& grid, const std::vector<Spectrum>& responses,
                             const std::vector<std::string>& ids) {
    const int plain = radiometry::make_spectral_grid(responses).size();
    return fmt::format("{} bands on {} transport wavelengths ({}{})", responses.size(), grid.size(),
                       per_band_text(grid, ids),
                       plain == grid.size() ? "" : fmt::format("; {} in all without hot gas", plain));
}

std::string two_digits(double value) { return value < 10.0 ? fmt::format("{:.2g}", value) : fmt::format("{:.0f}", value); }

bool has_smoke(const Scenario& s) { return s.inputs.plume || s.plume.rise || !s.plume.layers.empty(); }

/// Of the files that a render writes: floats, and doubles for the geolocation.
double bytes_per_pixel(const Scenario& s, double bands) {
    const double terms = render::kTermCount - (has_smoke(s) ? 0 : render::kSmokeTermCount);
    constexpr double kGeolocation = 9.0, kTruth = 9.0;  // bands; kTruth: fractions, temperatures, exitance, coverage
    return 4.0 * bands + 8.0 * kGeolocation + (s.products.truth ? 4.0 * (kTruth + bands * (terms + 2.0)) : 0.0);
}

/// Of the rays that every pixel has; the rest depends on what burns.
struct Cost {
    double seconds = 0.0;      ///< of one core
    bool wide_pixels = false;  ///< that get more rays where fire burns
};

/// What the estimate leaves out.
std::string not_counted(const Scenario& s, const Cost& cost) {
    std::vector<std::string> parts;
    if (cost.wide_pixels) parts.emplace_back("more rays for fire in wide pixels");
    if (s.render.flame_light && !s.flame.off) parts.emplace_back("light of flames");
    if (has_smoke(s)) parts.emplace_back("smoke");
    return parts.empty() ? "" : fmt::format("; not counted: {}", fmt::join(parts, ", "));
}

std::string acquisition_summary(const Scenario& s, const inputs::SceneInputs& in, const std::optional<OpticalTables>& tables,
                                const scenario::Acquisition& a, Cost& cost, std::vector<std::string>& warnings) {
    const auto sensor = sensors::load_sensor(a.sensor);
    std::string out;
    const std::size_t frame = inputs::frame_at(in.frames, a.time_s, a.id);
    for (const auto& id : wanted_groups(a, sensor)) {
        const auto& group = sensor.group(id);
        std::vector<Spectrum> responses;
        std::vector<std::string> band_ids;
        for (const int b : wanted_bands(a, sensor, id)) {
            responses.push_back(sensor.bands[static_cast<std::size_t>(b)].response);
            band_ids.push_back(sensor.bands[static_cast<std::size_t>(b)].id);
        }
        const auto geometry = resolve_geometry(a, in, nullptr, sensor, group);
        if (!tables) continue;  // what is wrong with them has been said
        const double agl_m = std::max(1.0, geometry.path.at(0.0).position.h_m - in.mean_height_m);
        const auto sun = radiometry::sun_position(s.start.unix_s + a.time_s, in.centre.lat_deg, in.centre.lon_deg);
        const auto grid = transport_grid(s, in, *tables, responses, agl_m, sun);
        for (const auto& warning : air_warnings(s, *tables, agl_m, 0.0, sun))
            if (std::find(warnings.begin(), warnings.end(), warning) == warnings.end()) warnings.push_back(warning);
        (void)ground_reflectance(s, in.cover_names, grid);  // for what is wrong with the user's spectra
        const bool point =
            sensor.psf_across.shape == sensors::Psf::Shape::None && sensor.psf_along.shape == sensors::Psf::Shape::None;
        const double rays_per_pixel = point ? 1.0 : s.render.samples_per_axis * s.render.samples_per_axis;
        const double pixels = static_cast<double>(geometry.samples) * geometry.lines, n = grid.size();
        const double cost_s = pixels * (rays_per_pixel * (kRay_s + kRayWavelength_s * n) + kPixelWavelength_s * n);
        cost.seconds += cost_s;
        const double width_m = pixel_width_m(geometry, in.mean_height_m);
        const bool wide = !point && width_m > in.grid.cell_m;
        cost.wide_pixels = cost.wide_pixels || wide;
        const double megabytes = 1e-6 * pixels * bytes_per_pixel(s, static_cast<double>(responses.size()));
        out += fmt::format(
            "  {}: {} group {}, {} x {} pixels, {}, {:.0f} rays per pixel{}, fire state of {:g} s, about {} s of one core; "
            "radiance, geolocation and truth of {} MB before compression\n",
            a.id, sensor.id, id, geometry.samples, geometry.lines, wavelengths_text(grid, responses, band_ids),
            rays_per_pixel, wide ? fmt::format(" and many more where fire burns in its {:.0f} m", width_m) : "",
            in.frames[frame].time_s, two_digits(cost_s), two_digits(megabytes));
    }
    return out;
}

}  // namespace

CheckResult check(const Scenario& scenario) {
    CheckResult result;
    inputs::SceneInputs in;
    if (!passes(result, [&] { in = inputs::load_scene_inputs(scenario); })) {
        // The frames can still be looked at by themselves.
        const auto before = result.problems;
        if (!scenario.inputs.spread && !scenario.inputs.arrival_model)
            passes(result, [&] { (void)inputs::heat_flux_frames(scenario.inputs.heat_flux); });
        if (result.problems.size() > 1 && result.problems.back() == before.front()) result.problems.pop_back();
        return result;
    }
    check_rasters(scenario, in, result);
    std::optional<OpticalTables> tables;
    if (!scenario.acquisitions.empty()) passes(result, [&] { tables = load_optical_tables(scenario, in); });
    Cost cost;
    std::string acquisitions;
    std::vector<std::string> air;
    for (const auto& a : scenario.acquisitions)
        passes(result, [&] { acquisitions += acquisition_summary(scenario, in, tables, a, cost, air); });
    if (!result.problems.empty()) return result;
    result.warnings = scenario_warnings(scenario, in);
    result.warnings.insert(result.warnings.end(), air.begin(), air.end());
    const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
    for (const auto& note : scenario.notes) acquisitions += "  note: " + note + "\n";
    result.summary = fmt::format(
        "{}: ready to run\n  map: {} x {} cells of {:g} m, terrain {:.0f} to {:.0f} m, centre {:.4f} N {:.4f} E\n  frames: "
        "{} ({:g} s to {:g} s)\n{}"
        "  estimated rendering time: {:.1f} s on {} cores{}\n",
        scenario.name, in.grid.cols, in.grid.rows, in.grid.cell_m, in.lowest_m, in.highest_m, in.centre.lat_deg,
        in.centre.lon_deg, in.frames.size(), in.frames.front().time_s, in.frames.back().time_s, acquisitions,
        cost.seconds / cores, cores, not_counted(scenario, cost));
    return result;
}

}  // namespace pyroscene::pipeline
