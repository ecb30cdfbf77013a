#include "imagery/detection_files.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/files.h"
#include "drawing/qgis_style.h"
#include "imagery/hotspots.h"
#include "imagery/image_channels.h"

namespace pyroscene::imagery {
namespace {

using analysis::Detection;
using analysis::FireClass;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

std::filesystem::path beside(const DetectJob& job, const std::string& ending) {
    auto path = job.output;
    return path.replace_filename(job.output.stem().string() + ending);
}

void write_rasters(const DetectionScene& scene, const gis::ImageInfo& info, const Detection& found,
                   const std::vector<float>& power_MW) {
    gis::OutputRaster out;
    out.cols = info.cols;
    out.rows = info.rows;
    out.like = scene.job.image;
    out.synthetic = info.metadata.contains("synthetic");
    out.metadata["SOURCE_IMAGE"] = scene.job.image.filename().string();
    out.metadata["METHOD"] = scene.job.method;
    const auto write = [&](const std::filesystem::path& path, const std::vector<float>& pixels) {
        if (info.on_map)
            gis::write_cog(path, out, pixels);
        else
            gis::write_geotiff(path, out, pixels);
    };
    auto layers = out;
    std::vector<float> pixels;
    const auto add = [&](const std::string& name, const std::string& unit, const std::vector<float>& plane) {
        layers.bands.push_back({name, unit, {}, {}, {}});
        pixels.insert(pixels.end(), plane.begin(), plane.end());
    };
    add("confidence", "%", found.confidence_percent);
    add(scene.tested_name, scene.tested_unit, scene.tested.empty() ? scene.mir_K : scene.tested);
    add("MIR temperature of the surroundings", "K", found.background_mir_K);
    add("fire radiative power of the pixel", "MW", power_MW);
    std::swap(out, layers);
    write(beside(scene.job, "_layers.tif"), pixels);
    std::swap(out, layers);
    out.classes = true;
    out.class_names = {"not processed",
                       "",
                       "sun glint",
                       "water",
                       "cloud",
                       "no fire",
                       "unknown",
                       "fire, low confidence",
                       "fire, nominal confidence",
                       "fire, high confidence"};
    out.bands = {{"fire class", "", {}, {}, {}}};
    std::vector<float> classes;
    for (const FireClass c : found.fire) classes.push_back(static_cast<float>(c));
    write(scene.job.output, classes);
    drawing::write_qgis_style(scene.job.output, {{2, "#80deea", "sun glint"},
                                                 {3, "#4678be", "water"},
                                                 {4, "#f0f0f0", "cloud"},
                                                 {5, "#bfc8b4", "no fire"},
                                                 {6, "#9670b4", "unknown"},
                                                 {7, "#ffd54f", "fire, low confidence"},
                                                 {8, "#ff7f00", "fire, nominal confidence"},
                                                 {9, "#d50000", "fire, high confidence"}});
}

void write_hotspots(const DetectionScene& scene, const gis::ImageInfo& info, const Detection& found,
                    const std::vector<float>& power_MW) {
    HotspotTable table = hotspots_of(info);
    table.viirs_names = scene.job.method == "viirs375";
    const auto value = [](const std::vector<float>& plane, std::size_t i) {
        return plane.empty() ? static_cast<double>(kNaN) : static_cast<double>(plane[i]);
    };
    for (std::size_t i = 0; i < scene.n; ++i) {
        if (!analysis::is_fire(found.fire[i]) || !std::isfinite(scene.where.lon_deg[i])) continue;
        Hotspot h{scene.where.lat_deg[i], scene.where.lon_deg[i], value(scene.mir_K, i), value(scene.tir_K, i)};
        h.scan_km = static_cast<double>(scene.where.width_m[i]) * 1e-3;
        h.track_km = static_cast<double>(scene.where.height_m[i]) * 1e-3;
        h.frp_MW = value(power_MW, i);
        h.confidence = table.viirs_names ? std::string(1, "lnh"[static_cast<std::size_t>(found.fire[i]) - 7])
                                         : fmt::format("{:.0f}", found.confidence_percent[i]);
        constexpr float kDay_deg = 85.0F;
        if (!scene.sun_zenith_deg.empty()) h.day_or_night = scene.sun_zenith_deg[i] < kDay_deg ? 'D' : 'N';
        table.rows.push_back(std::move(h));
    }
    write_hotspots_csv(beside(scene.job, "_hotspots.csv"), table);
    const std::vector<gis::VectorLayer> layers{hotspot_layer(table)};
    gis::write_vector(beside(scene.job, "_hotspots.geojson"), layers);
    gis::write_vector(beside(scene.job, "_hotspots.gpkg"), layers);
}

/// truth.tif beside radiance.tif, truth_ir.tif beside radiance_ir.tif.
std::optional<std::filesystem::path> truth_of(const DetectJob& job) {
    if (job.truth) return job.truth;
    constexpr std::string_view kRadiance = "radiance";
    const std::string name = job.image.filename().string();
    if (!name.starts_with(kRadiance)) return std::nullopt;
    const auto path = job.image.parent_path() / ("truth" + name.substr(kRadiance.size()));
    return std::filesystem::exists(path) ? std::optional(path) : std::nullopt;
}

analysis::DetectionScore score(const DetectionScene& scene, const std::filesystem::path& path, const gis::ImageInfo& info,
                               const std::vector<unsigned char>& fire) {
    gis::ImageStream truth(path);
    if (truth.info().cols != info.cols || truth.info().rows != info.rows)
        throw input_error(path.string(), fmt::format("{} x {} pixels, the image has {} x {}", truth.info().cols,
                                                     truth.info().rows, info.cols, info.rows));
    const auto plane = [&](const std::string& name) {
        for (std::size_t b = 0; b < truth.info().bands.size(); ++b)
            if (truth.info().bands[b].description == name) return truth.read_band(static_cast<int>(b) + 1);
        throw input_error(path.string(), "no band named " + name);
    };
    auto area_m2 = plane("fraction_flame");
    const auto front = plane("fraction_front");
    auto power_MW = plane("fire_radiant_exitance");
    const auto ground_K = plane("ground_temperature");
    constexpr float kHot_K = 400.0F, kNeither_m2 = 1e-6F;  // ground this hot is no fire, and calling it one no false alarm
    for (std::size_t i = 0; i < area_m2.size(); ++i) {
        area_m2[i] = (area_m2[i] + front[i]) * scene.where.area_m2[i];
        if (area_m2[i] == 0.0F && ground_K[i] > kHot_K) area_m2[i] = kNeither_m2;
        power_MW[i] *= scene.where.area_m2[i] * 1e-6F;
    }
    return analysis::score_detection(fire, area_m2, power_MW, info.cols, scene.job.least_area_m2);
}

void write_score(const DetectJob& job, const analysis::DetectionScore& s) {
    using Json = nlohmann::ordered_json;
    const auto bins = [](const std::vector<analysis::ScoreBin>& of) {
        Json out = Json::array();
        for (const auto& b : of)
            out.push_back({{"from", b.lower},
                           {"to", std::isfinite(b.upper) ? Json(b.upper) : Json(nullptr)},
                           {"true_pixels", b.true_pixels},
                           {"found", b.found},
                           {"omission", b.true_pixels > 0 ? Json(b.omission()) : Json(nullptr)}});
        return out;
    };
    const Json json = {{"method", job.method},           {"least_area_m2", job.least_area_m2},
                       {"true_pixels", s.true_pixels},   {"found", s.found},
                       {"omission", s.omission()},       {"detected", s.detected},
                       {"false_alarms", s.false_alarms}, {"false_alarms_within_2_pixels_of_fire", s.beside},
                       {"commission", s.commission()},   {"background_pixels", s.background},
                       {"by_frp_MW", bins(s.by_frp_MW)}, {"by_area_m2", bins(s.by_area_m2)}};
    write_text_file(beside(job, "_scores.json"), json.dump(2) + "\n");
}

}  // namespace

void write_detection(const DetectionScene& scene, const gis::ImageInfo& info, const Detection& found,
                     const std::vector<float>& power_MW) {
    write_rasters(scene, info, found, power_MW);
    write_hotspots(scene, info, found, power_MW);
}

std::optional<analysis::DetectionScore> score_against_truth(const DetectionScene& scene, const gis::ImageInfo& info,
                                                            const std::vector<unsigned char>& fire) {
    const auto truth = truth_of(scene.job);
    if (!truth) return std::nullopt;
    auto result = score(scene, *truth, info, fire);
    write_score(scene.job, result);
    return result;
}

}  // namespace pyroscene::imagery
