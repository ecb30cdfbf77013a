#include "pipeline/footprints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/constants.h"
#include "pipeline/acquisition.h"

namespace pyroscene::pipeline {
namespace {

using nlohmann::json;

constexpr int kPointsPerSide = 24;

struct Ground {
    const sensors::ImageGeometry& image;
    double height_m;

    /// Where the image position lies on the ground, offsets in pixels from the pixel's centre; nothing beyond the horizon.
    [[nodiscard]] std::optional<gis::Geodetic> at(int sample, int line, double sample_offset, double line_offset) const {
        const auto p = sensors::scan_position_of(image, sample, line, sample_offset, line_offset);
        const auto point = sensors::intersect_height(sensors::sightline(image, p.scan, p.u, p.v).ray, height_m);
        return std::isfinite(point.lat_deg) ? std::optional(point) : std::nullopt;
    }
    [[nodiscard]] double view_zenith_rad(int sample, int line, const gis::Geodetic& ground) const {
        const auto p = sensors::scan_position_of(image, sample, line);
        return sensors::look_angles(ground, sensors::sightline(image, p.scan, p.u, p.v).ray.origin_m).zenith_rad;
    }
};

/// Closed, counter-clockwise; empty with fewer than three points.
json polygon(std::vector<gis::Geodetic> ring) {
    if (ring.size() < 3) return {};
    double twice_area = 0.0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const auto &a = ring[i], &b = ring[(i + 1) % ring.size()];
        twice_area += a.lon_deg * b.lat_deg - b.lon_deg * a.lat_deg;
    }
    if (twice_area < 0.0) std::reverse(ring.begin(), ring.end());
    ring.push_back(ring.front());
    json coordinates = json::array();
    for (const auto& p : ring) coordinates.push_back({p.lon_deg, p.lat_deg});
    return {{"type", "Polygon"}, {"coordinates", json::array({coordinates})}};
}

/// Around the image along the outer edges of its pixels.
std::vector<gis::Geodetic> outline(const Ground& ground) {
    const int last_sample = ground.image.samples - 1, last_line = ground.image.lines - 1;
    std::vector<gis::Geodetic> ring;
    const auto side = [&](double sample0, double line0, double sample1, double line1) {  // corners of pixels at integers
        for (int i = 0; i < kPointsPerSide; ++i) {
            const double along = static_cast<double>(i) / kPointsPerSide;
            const double x = sample0 + (sample1 - sample0) * along, y = line0 + (line1 - line0) * along;
            const int sample = std::min(static_cast<int>(x), last_sample), line = std::min(static_cast<int>(y), last_line);
            if (const auto p = ground.at(sample, line, x - sample - 0.5, y - line - 0.5)) ring.push_back(*p);
        }
    };
    const double samples = last_sample + 1, lines = last_line + 1;
    side(0.0, 0.0, samples, 0.0);
    side(samples, 0.0, samples, lines);
    side(samples, lines, 0.0, lines);
    side(0.0, lines, 0.0, 0.0);
    return ring;
}

double distance_m(const gis::Geodetic& a, const gis::Geodetic& b) {
    return length(gis::ecef_from_geodetic(a) - gis::ecef_from_geodetic(b));
}

double rounded(double value, double per_unit) { return std::round(value * per_unit) / per_unit; }

json pixel_feature(const Ground& ground, int sample, int line) {
    std::array<std::optional<gis::Geodetic>, 4> corners{};
    constexpr std::array<std::array<double, 2>, 4> kCorners{{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}};
    for (std::size_t i = 0; i < 4; ++i) corners[i] = ground.at(sample, line, kCorners[i][0], kCorners[i][1]);
    const auto centre = ground.at(sample, line, 0.0, 0.0);
    if (!centre || std::any_of(corners.begin(), corners.end(), [](const auto& c) { return !c; })) return {};
    const auto across_m = 0.5 * (distance_m(*corners[0], *corners[1]) + distance_m(*corners[3], *corners[2]));
    const auto along_m = 0.5 * (distance_m(*corners[0], *corners[3]) + distance_m(*corners[1], *corners[2]));
    return {{"type", "Feature"},
            {"geometry", polygon({*corners[0], *corners[1], *corners[2], *corners[3]})},
            {"properties",
             {{"kind", "pixel"},
              {"sample", sample},
              {"line", line},
              {"time_s", rounded(sensors::pixel_time_s(ground.image, sample, line), 1e6)},
              {"view_zenith_deg", rounded(ground.view_zenith_rad(sample, line, *centre) / kDegree_rad, 1e4)},
              {"across_m", rounded(across_m, 1e3)},
              {"along_m", rounded(along_m, 1e3)}}}};
}

void add_group(const scenario::Acquisition& a, const inputs::SceneInputs& in, const sensors::Sensor& sensor,
               const sensors::CameraGroup& group, json& features) {
    const auto image = resolve_geometry(a, in, nullptr, sensor, group);
    const Ground ground{image, in.mean_height_m};
    const auto add = [&](json feature) {
        if (feature.is_null() || feature["geometry"].is_null()) return;
        feature["properties"]["acquisition"] = a.id;
        feature["properties"]["sensor"] = sensor.id;
        feature["properties"]["group"] = group.id;
        features.push_back(std::move(feature));
    };
    add({{"type", "Feature"},
         {"geometry", polygon(outline(ground))},
         {"properties", {{"kind", "image"}, {"samples", image.samples}, {"lines", image.lines}, {"time_s", a.time_s}}}});
    for (const int line : {0, image.lines / 2, image.lines - 1})
        for (const int sample : {0, image.samples / 2, image.samples - 1}) add(pixel_feature(ground, sample, line));
}

}  // namespace

double pixel_width_m(const sensors::ImageGeometry& image, double ground_height_m) {
    const Ground ground{image, ground_height_m};
    const auto left = ground.at(image.samples / 2, image.lines / 2, -0.5, 0.0),
               right = ground.at(image.samples / 2, image.lines / 2, 0.5, 0.0);
    return left && right ? distance_m(*left, *right) : 0.0;
}

std::string footprints_geojson(const scenario::Scenario& scenario) {
    const auto in = inputs::load_scene_inputs(scenario);
    json features = json::array();
    for (const auto& a : scenario.acquisitions) {
        const auto sensor = sensors::load_sensor(a.sensor);
        for (const auto& id : wanted_groups(a, sensor)) add_group(a, in, sensor, sensor.group(id), features);
    }
    return json{{"type", "FeatureCollection"}, {"name", scenario.name + " footprints"}, {"features", features}}.dump(1) +
           "\n";
}

}  // namespace pyroscene::pipeline
