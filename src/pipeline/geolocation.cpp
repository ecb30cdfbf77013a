#include "pipeline/geolocation.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "base/constants.h"

namespace pyroscene::pipeline {
namespace {

double positive_degrees(double angle_rad) {
    const double degrees = std::fmod(angle_rad / kDegree_rad, 360.0);
    return degrees < 0.0 ? degrees + 360.0 : degrees;
}

}  // namespace

LocalSun::LocalSun(double unix_s, const gis::Geodetic& centre)
    : unix_s_(unix_s), centre_(centre), here_(radiometry::sun_position(unix_s, centre.lat_deg, centre.lon_deg)) {
    constexpr double kStep_deg = 0.05;
    const auto north = radiometry::sun_position(unix_s, centre.lat_deg + kStep_deg, centre.lon_deg),
               east = radiometry::sun_position(unix_s, centre.lat_deg, centre.lon_deg + kStep_deg);
    zenith_per_deg_ = {(north.zenith_rad - here_.zenith_rad) / kStep_deg, (east.zenith_rad - here_.zenith_rad) / kStep_deg};
    azimuth_per_deg_ = {std::remainder(north.azimuth_rad - here_.azimuth_rad, 2.0 * kPi) / kStep_deg,
                        std::remainder(east.azimuth_rad - here_.azimuth_rad, 2.0 * kPi) / kStep_deg};
}

radiometry::SunPosition LocalSun::at(double lat_deg, double lon_deg) const {
    constexpr double kNear_deg = 0.1, kNearZenith_rad = 20.0 * kDegree_rad;
    const double north_deg = lat_deg - centre_.lat_deg, east_deg = std::remainder(lon_deg - centre_.lon_deg, 360.0);
    if (std::abs(north_deg) > kNear_deg || std::abs(east_deg) > kNear_deg || here_.zenith_rad < kNearZenith_rad)
        return radiometry::sun_position(unix_s_, lat_deg, lon_deg);
    return {here_.zenith_rad + zenith_per_deg_[0] * north_deg + zenith_per_deg_[1] * east_deg,
            here_.azimuth_rad + azimuth_per_deg_[0] * north_deg + azimuth_per_deg_[1] * east_deg, here_.distance_AU};
}

Geolocation::Geolocation(const sensors::ImageGeometry& geometry, const sensors::ImageChords& chords, const LocalSun& sun,
                         std::optional<double> surroundings_m)
    : geometry_(&geometry),
      chords_(&chords),
      sun_(&sun),
      surroundings_m_(surroundings_m),
      pixels_(static_cast<std::size_t>(geometry.samples) * static_cast<std::size_t>(geometry.lines)) {
    planes_.resize(pixels_ * kGeolocationBands.size());
}

void Geolocation::add(const render::RadianceImage& lines) {
    tbb::parallel_for(lines.first_line, lines.first_line + lines.lines, [&](int line) { place_line(lines, line); });
}

void Geolocation::place_line(const render::RadianceImage& lines, int line) {
    const auto& geometry = *geometry_;
    const auto scan = chords_->scan(sensors::scan_position_of(geometry, 0, line).scan);
    const auto samples = static_cast<std::size_t>(lines.samples);
    for (int sample = 0; sample < lines.samples; ++sample) {
        const std::size_t here =
            static_cast<std::size_t>(line - lines.first_line) * samples + static_cast<std::size_t>(sample);
        const std::size_t i = static_cast<std::size_t>(line) * samples + static_cast<std::size_t>(sample);
        const bool on_map = lines.coverage[here] > 0.0F;
        if (!on_map && (!surroundings_m_ || chords_->open() || sensors::pixel_deleted(geometry, sample, line))) {
            for (std::size_t b = 0; b < kGeolocationBands.size(); ++b) planes_[b * pixels_ + i] = std::nan("");
            continue;
        }
        const auto position = sensors::scan_position_of(geometry, sample, line);
        const auto chord = scan.at(position.u, position.v);
        const Vec3 hit_m = on_map ? Vec3{lines.hit_x_m[here], lines.hit_y_m[here], lines.hit_z_m[here]}
                                  : Vec3{0.0, 0.0, surroundings_m_.value_or(0.0)};
        const Vec3 way_m = chord.bottom_m - chord.top_m;
        const double f = chords_->open() ? dot(hit_m - chord.top_m, way_m) / dot(way_m, way_m)
                                         : (chord.top_m.z - hit_m.z) / (chord.top_m.z - chord.bottom_m.z);
        const double lon = std::lerp(chord.top_lon_deg, chord.bottom_lon_deg, f);
        const double lat = std::lerp(chord.top_lat_deg, chord.bottom_lat_deg, f);
        const Vec3 v = chord.view_enu;
        const auto sun = sun_->at(lat, lon);
        const double values[] = {lon,
                                 lat,
                                 hit_m.z,
                                 std::atan2(std::hypot(v.x, v.y), v.z) / kDegree_rad,
                                 positive_degrees(std::atan2(v.x, v.y)),
                                 sun.zenith_rad / kDegree_rad,
                                 positive_degrees(sun.azimuth_rad),
                                 std::lerp(chord.top_range_m, chord.bottom_range_m, f),
                                 sensors::pixel_time_s(geometry, sample, line)};
        for (std::size_t b = 0; b < std::size(values); ++b) planes_[b * pixels_ + i] = values[b];
    }
}

std::vector<gis::GroundControlPoint> Geolocation::control_points() const {
    const auto& image = *geometry_;
    const auto& planes = planes_;
    std::vector<gis::GroundControlPoint> points;
    const std::size_t n = pixels_;
    constexpr int kPerAxis = 9;
    for (int r = 0; r < kPerAxis; ++r)
        for (int c = 0; c < kPerAxis; ++c) {
            const int line = r * (image.lines - 1) / (kPerAxis - 1), sample = c * (image.samples - 1) / (kPerAxis - 1);
            const std::size_t i =
                static_cast<std::size_t>(line) * static_cast<std::size_t>(image.samples) + static_cast<std::size_t>(sample);
            if (!std::isnan(planes[i]))
                points.push_back({sample + 0.5, line + 0.5, planes[i], planes[n + i], planes[2 * n + i]});
        }
    // A scene that fills a corner of the image may lie between them: then its own pixels, evenly.
    constexpr std::size_t kFewest = 4, kMost = 64;
    if (points.size() >= kFewest) return points;
    std::vector<std::size_t> seen;
    for (std::size_t i = 0; i < n; ++i)
        if (!std::isnan(planes[i])) seen.push_back(i);
    points.clear();
    const auto samples = static_cast<std::size_t>(image.samples);
    for (std::size_t k = 0; k < seen.size(); k += std::max<std::size_t>(1, seen.size() / kMost)) {
        const std::size_t i = seen[k];
        points.push_back({static_cast<double>(i % samples) + 0.5, static_cast<double>(i / samples) + 0.5, planes[i],
                          planes[n + i], planes[2 * n + i]});
    }
    return points;
}

}  // namespace pyroscene::pipeline
