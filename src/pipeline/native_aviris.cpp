// AVIRIS as its users get it: ENVI cubes of radiance in the units of the instrument's calibration, and the geometry files that
// belong to them (input geometry, look-up table, observation). Names and order of the planes: AVIRIS data product readme,
// JPL; see docs/outputs.md for what differs.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/files.h"
#include "gis/envi_output.h"
#include "gis/tiff_writer.h"
#include "pipeline/native.h"
#include "radiometry/sun.h"

namespace pyroscene::pipeline {
namespace {

constexpr double kNative_per_SI = 0.1;  ///< uW cm-2 nm-1 sr-1 in one W m-2 sr-1 um-1
constexpr int kNoCounts = -50;          ///< fill of the integer cubes
constexpr double kNoValue = -9999.0;

gis::EnviHeader header(const NativeJob& job, const std::string& what, std::vector<std::string> bands) {
    gis::EnviHeader h;
    h.samples = job.image.samples;
    h.lines = job.image.lines;
    h.bands = static_cast<int>(bands.size());
    h.description = fmt::format("{}; {} of scenario {}, {} (synthetic)", what, job.job.acquisition.id, job.job.scenario.name,
                                job.job.sensor.name);
    h.band_names = std::move(bands);
    h.more = {{"sensor type", "AVIRIS"}, {"acquisition time", UtcTime{job.unix_s()}.iso8601()}, {"synthetic", "true"}};
    return h;
}

gis::EnviHeader cube_header(const NativeJob& job, const std::string& what, double fill) {
    std::vector<std::string> names;
    gis::EnviHeader h = header(job, what, {});
    for (std::size_t k = 0; k < job.job.bands.size(); ++k) {
        h.band_names.push_back("channel " + job.band(k).id);
        h.wavelength_nm.push_back(1e3 * job.band(k).centre_um);
        h.fwhm_nm.push_back(1e3 * job.band(k).fwhm_um);
    }
    h.bands = static_cast<int>(job.job.bands.size());
    h.ignore_value = fill;
    return h;
}

/// A cube, which has its header beside it.
std::filesystem::path cube_file(const NativeJob& job, const std::string& name) {
    (void)job.file(name + ".hdr");
    return job.file(name);
}

gis::EnviHeader on_grid(gis::EnviHeader h, const MapGrid& grid) {
    h.samples = grid.cols;
    h.lines = grid.rows;
    h.grid = grid;
    return h;
}

/// The pixel a map cell takes, or -1: the one whose area holds the cell's centre.
std::ptrdiff_t source_pixel(const NativeJob& job, std::size_t cell) {
    const auto& r = job.image;
    const float sample = job.lookup.sample[cell], line = job.lookup.line[cell];
    if (std::isnan(sample) || std::isnan(line)) return -1;
    const auto s = std::min(static_cast<std::ptrdiff_t>(sample), static_cast<std::ptrdiff_t>(r.samples - 1));
    const auto i = std::min(static_cast<std::ptrdiff_t>(line), static_cast<std::ptrdiff_t>(r.lines - 1)) * r.samples + s;
    return std::isfinite(r.x_m[static_cast<std::size_t>(i)]) ? i : -1;
}

/// Cube in sensor geometry and on the map. `count` turns radiance of a band into what is stored.
template <class T, class Count>
void write_cubes(const NativeJob& job, const std::string& stem, T fill, const Count& count) {
    const auto& r = job.image;
    const std::size_t bands = job.job.bands.size(), samples = static_cast<std::size_t>(r.samples);
    const std::string what = std::is_same_v<T, float> ? "radiance, uW cm-2 nm-1 sr-1" : "radiance, uW cm-2 nm-1 sr-1 x gain";
    const auto h = cube_header(job, what, fill);
    const auto cube = cube_file(job, stem + "_img");
    const int most = gis::rows_of_part(samples * bands, r.lines);
    int first = 0, read = 0;  // lines in memory
    std::vector<float> radiance;
    gis::write_envi<T>(cube, h, [&](int line, std::span<T> out) {
        if (line >= first + read) {
            first = line;
            read = std::min(most, r.lines - line);
            radiance.resize(static_cast<std::size_t>(read) * samples * bands);
            r.radiance->read(first, read, radiance);
        }
        for (std::size_t k = 0; k < bands; ++k) {
            const float* in =
                &radiance[(k * static_cast<std::size_t>(read) + static_cast<std::size_t>(line - first)) * samples];
            for (std::size_t s = 0; s < samples; ++s)
                out[s * bands + k] = std::isnan(in[s]) ? fill : count(k, static_cast<double>(in[s]) * kNative_per_SI);
        }
    });
    const MapGrid& grid = job.lookup.grid;
    gis::write_envi_rearranged<T>(cube_file(job, stem + "_ort_img"), on_grid(h, grid), cube, fill,
                                  [&](int row, int col) { return source_pixel(job, grid.index(row, col)); });
}

void write_gains(const NativeJob& job, const std::string& stem) {
    std::string text;
    for (const int b : job.job.bands)
        text += fmt::format("{:14.6f} {:6d}\n", job.job.sensor.native_gain[static_cast<std::size_t>(b)], b + 1);
    write_text_file(job.file(stem + ".gain"), text);
}

void write_input_geometry(const NativeJob& job, const std::string& stem) {
    const auto& r = job.image;
    auto h = header(job,
                    "input geometry: ground point of each pixel centre on the map of the ort files, height above the "
                    "ellipsoid in m",
                    {"Easting", "Northing", "Elevation"});
    h.ignore_value = kNoValue;
    gis::write_envi<double>(cube_file(job, stem + "_ort_igm"), h, [&](int line, std::span<double> out) {
        for (int s = 0; s < r.samples; ++s) {
            const auto i =
                static_cast<std::size_t>(line) * static_cast<std::size_t>(r.samples) + static_cast<std::size_t>(s);
            const std::array<double, 3> point{r.x_m[i], r.y_m[i], r.where(kHeight)[i]};
            for (std::size_t k = 0; k < point.size(); ++k)
                out[static_cast<std::size_t>(s) * point.size() + k] = std::isfinite(point[0]) ? point[k] : kNoValue;
        }
    });
}

/// Sample and line from 1 on; negative where the pixel's centre lies in another cell, that is where a gap between pixel
/// centres is filled; 0 = none.
void write_lookup_table(const NativeJob& job, const std::string& stem) {
    const auto& r = job.image;
    const MapGrid& grid = job.lookup.grid;
    const auto h = on_grid(header(job, "geometry look-up table", {"GLT Sample Lookup", "GLT Line Lookup"}), grid);
    gis::write_envi<std::int32_t>(cube_file(job, stem + "_ort_glt"), h, [&](int row, std::span<std::int32_t> out) {
        for (int col = 0; col < grid.cols; ++col) {
            const auto found = source_pixel(job, grid.index(row, col));
            auto* to = &out[2 * static_cast<std::size_t>(col)];
            to[0] = to[1] = 0;
            if (found < 0) continue;
            const auto i = static_cast<std::size_t>(found);
            const bool own = static_cast<int>(std::floor(grid.col_at(r.x_m[i]))) == col &&
                             static_cast<int>(std::floor(grid.row_at(r.y_m[i]))) == row;
            to[0] = (own ? 1 : -1) * static_cast<std::int32_t>(found % r.samples + 1);
            to[1] = (own ? 1 : -1) * static_cast<std::int32_t>(found / r.samples + 1);
        }
    });
}

/// Slope of the scene's terrain and where it falls to, clockwise from true north [rad].
struct Slope {
    double slope_rad = 0.0, aspect_rad = 0.0;
};
Slope slope_at(const Raster<float>& terrain, double x_m, double y_m, double convergence_rad) {
    const MapGrid& g = terrain.grid;
    const int col = std::clamp(static_cast<int>(std::floor(g.col_at(x_m))), 1, g.cols - 2);
    const int row = std::clamp(static_cast<int>(std::floor(g.row_at(y_m))), 1, g.rows - 2);
    const double east = (terrain.at(row, col + 1) - terrain.at(row, col - 1)) / (2.0 * g.cell_m);
    const double north = (terrain.at(row - 1, col) - terrain.at(row + 1, col)) / (2.0 * g.cell_m);
    return {std::atan(std::hypot(east, north)), std::atan2(-east, -north) + convergence_rad};
}

double degrees_of_turn(double angle_rad) {
    const double degrees = std::fmod(angle_rad / kDegree_rad, 360.0);
    return degrees < 0.0 ? degrees + 360.0 : degrees;
}

void write_observation(const NativeJob& job, const std::string& stem) {
    const auto& r = job.image;
    const auto& in = job.job.inputs;
    const double distance_AU = radiometry::sun_position(job.unix_s(), in.centre.lat_deg, in.centre.lon_deg).distance_AU;
    const double convergence_rad = gis::MapProjection(in.grid.crs_wkt).convergence_rad(in.origin_m.x, in.origin_m.y);
    auto h =
        header(job, "observation geometry: m, degrees (azimuths clockwise from true north), UTC hours, AU",
               {"Path length (sensor-to-ground in meters)", "To-sensor azimuth (0 to 360 degrees cw from N)",
                "To-sensor zenith (0 to 90 degrees from zenith)", "To-sun azimuth (0 to 360 degrees cw from N)",
                "To-sun zenith (0 to 90 degrees from zenith)", "Phase (degrees between to-sensor and to-sun vectors)",
                "Slope (local surface slope in degrees)", "Aspect (local surface aspect 0 to 360 degrees clockwise from N)",
                "Cosine i (cosine of the angle between the surface normal and to-sun)", "UTC time (decimal hours)",
                "Earth-sun distance (AU)"});
    h.ignore_value = kNoValue;
    const double start_of_day_s = std::floor(job.unix_s() / 86400.0) * 86400.0;
    gis::write_envi<double>(cube_file(job, stem + "_obs"), h, [&](int line, std::span<double> out) {
        constexpr std::size_t kPlanes = 11;
        for (int s = 0; s < r.samples; ++s) {
            const auto i =
                static_cast<std::size_t>(line) * static_cast<std::size_t>(r.samples) + static_cast<std::size_t>(s);
            const auto to = out.subspan(static_cast<std::size_t>(s) * kPlanes, kPlanes);
            std::fill(to.begin(), to.end(), kNoValue);
            if (!std::isfinite(r.x_m[i])) continue;
            const auto angle = [&](GeolocationPlane p) { return r.where(p)[i] * kDegree_rad; };
            const double view = angle(kViewZenith), sun = angle(kSunZenith);
            const auto [slope, aspect] = slope_at(in.terrain_m, r.x_m[i], r.y_m[i], convergence_rad);
            const double phase = std::cos(view) * std::cos(sun) +
                                 std::sin(view) * std::sin(sun) * std::cos(angle(kViewAzimuth) - angle(kSunAzimuth));
            const double cos_i =
                std::cos(slope) * std::cos(sun) + std::sin(slope) * std::sin(sun) * std::cos(angle(kSunAzimuth) - aspect);
            const std::array<double, kPlanes> values{
                r.where(kRange)[i],
                r.where(kViewAzimuth)[i],
                r.where(kViewZenith)[i],
                r.where(kSunAzimuth)[i],
                r.where(kSunZenith)[i],
                std::acos(std::clamp(phase, -1.0, 1.0)) / kDegree_rad,
                slope / kDegree_rad,
                degrees_of_turn(aspect),
                cos_i,
                (job.job.scenario.start.unix_s + r.where(kPixelTime)[i] - start_of_day_s) / 3600.0,
                distance_AU};
            std::copy(values.begin(), values.end(), to.begin());
        }
    });
}

}  // namespace

void write_aviris(const NativeJob& job) {
    const std::string stem = job.job.acquisition.id + job.job.files.suffix + "_rdn";
    if (job.job.sensor.native_form == sensors::NativeForm::AvirisEnvi) {
        constexpr double kMost = 32767.0, kLeast = kNoCounts + 1;
        std::int64_t clipped = 0;
        write_cubes<std::int16_t>(job, stem, kNoCounts, [&](std::size_t k, double radiance) {
            const double counts =
                std::round(radiance * job.job.sensor.native_gain[static_cast<std::size_t>(job.job.bands[k])]);
            if (counts > kMost) ++clipped;
            return static_cast<std::int16_t>(std::clamp(counts, kLeast, kMost));
        });
        job.report.count("native_counts_clipped/" + job.job.acquisition.id, clipped);
        write_gains(job, stem);
    } else {
        write_cubes<float>(job, stem, static_cast<float>(kNoValue),
                           [](std::size_t, double radiance) { return static_cast<float>(radiance); });
    }
    write_input_geometry(job, stem);
    write_lookup_table(job, stem);
    write_observation(job, stem);
}

}  // namespace pyroscene::pipeline
