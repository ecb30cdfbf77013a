#include "pipeline/detect_image.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "analysis/frp.h"
#include "analysis/spectral_index.h"
#include "base/constants.h"
#include "base/error.h"
#include "base/files.h"
#include "gis/pixel_positions.h"
#include "pipeline/hotspots.h"
#include "pipeline/image_channels.h"
#include "pipeline/index_image.h"
#include "pipeline/pixel_match.h"
#include "pipeline/sun_of_image.h"

namespace pyroscene::pipeline {
namespace {

using analysis::Detection;
using analysis::FireClass;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr BandWish kMirModis{3.96, 3.4, 4.2, "MIR"}, kMirViirs{3.74, 3.4, 4.2, "MIR"},
    kThermal{11.0, 10.0, 12.6, "thermal infrared"}, kCloud{12.0, 11.7, 12.6, "12 um"}, kRed{0.65, 0.60, 0.70, "red"},
    kNir{0.86, 0.80, 0.90, "near infrared"}, kSwirModis{2.13, 2.05, 2.35, "SWIR"}, kSwirViirs{1.61, 1.55, 1.75, "SWIR"};
constexpr double kSensitiveLimit_K = 331.0;  ///< where MODIS band 22 saturates

/// Everything that is known of the image's pixels besides the planes that are tested.
struct Scene {
    const DetectJob& job;
    gis::PixelPositions where;
    std::size_t n = 0;
    std::vector<float> mir_K{}, tir_K{}, mir_radiance{};  ///< empty = no such band
    double mir_coefficient = 0.0;
    std::vector<float> sun_zenith_deg{};  ///< empty = not known
    std::vector<float> tested{};          ///< index, empty = mir_K
    std::string tested_name = "MIR brightness temperature", tested_unit = "K";
};

std::vector<unsigned char> read_water(const std::filesystem::path& path, const gis::ImageInfo& like) {
    gis::ImageStream file(path);
    if (file.info().cols != like.cols || file.info().rows != like.rows)
        throw input_error(path.string(), fmt::format("{} x {} pixels, the image has {} x {}", file.info().cols,
                                                     file.info().rows, like.cols, like.rows));
    std::vector<unsigned char> water;
    for (const float v : file.read_band(1)) water.push_back(v > 0.0F ? 1 : 0);
    return water;
}

/// Reflectances near one wavelength on the image's pixels, from it or from another image of the same ground; empty when that one
/// has no such band.
class Reflectances {
public:
    Reflectances(ImageChannels& image, const Scene& scene, const SunOfImage& sun) : image_(image), scene_(scene), sun_(sun) {
        if (!scene.job.reflective) return;
        other_.emplace(*scene.job.reflective);
        where_ = gis::pixel_positions(*scene.job.reflective);
    }
    [[nodiscard]] std::vector<float> plane(const BandWish& wish) {
        ImageChannels& from = other_ ? *other_ : image_;
        const int number = from.find(wish);
        if (number == 0) return {};
        Channel band = from.read(number, ImageChannels::Expect::RadianceOrReflectance);
        if (other_) band.values = averaged_onto(scene_.where, where_, band.values);
        return reflectances(band, sun_.zenith_deg, sun_.distance_AU);
    }

private:
    ImageChannels& image_;
    const Scene& scene_;
    const SunOfImage& sun_;
    std::optional<ImageChannels> other_;
    gis::PixelPositions where_;
};

/// MODIS sees 4 um with a sensitive band that saturates early (22) and a coarse one (21): the first where it is not saturated.
/// \return names of the bands
std::string read_mir(ImageChannels& image, int number, Scene& scene) {
    const int twin = scene.job.mir_band || scene.job.method != "mod14" ? 0 : image.twin(number);
    Channel mir = image.read(std::min(number, twin > 0 ? twin : number), ImageChannels::Expect::RadianceOrTemperature);
    std::string names = mir.name;
    scene.mir_K = mir.temperatures_K();
    if (twin > 0) {  // the later of the two is the sensitive one
        const Channel sensitive = image.read(std::max(number, twin), ImageChannels::Expect::RadianceOrTemperature);
        const auto fine_K = sensitive.temperatures_K();
        names = sensitive.name + ", " + names;
        for (std::size_t i = 0; i < scene.n; ++i) {
            if (static_cast<double>(fine_K[i]) >= kSensitiveLimit_K - 0.5) continue;
            scene.mir_K[i] = fine_K[i];
            mir.values[i] = sensitive.values[i];
        }
    }
    if (mir.unit != "K") {
        scene.mir_coefficient = mir.power_law_coefficient();
        scene.mir_radiance = std::move(mir.values);
    }
    return names;
}

/// Angles to the mirror image of the sun from the view angles of the geolocation file; empty when it has none.
std::vector<float> glint_angles(const gis::ImageInfo& info, const SunOfImage& sun) {
    if (info.geolocation.empty()) return {};
    gis::ImageStream file(info.geolocation);
    std::vector<float> zenith, azimuth;
    for (std::size_t b = 0; b < file.info().bands.size(); ++b) {
        const auto& name = file.info().bands[b].description;
        if (name == "view_zenith") zenith = file.read_band(static_cast<int>(b) + 1);
        if (name == "view_azimuth") azimuth = file.read_band(static_cast<int>(b) + 1);
    }
    if (zenith.size() != sun.zenith_deg.size() || azimuth.size() != zenith.size()) return {};
    std::vector<float> glint;
    for (std::size_t i = 0; i < zenith.size(); ++i)
        glint.push_back(static_cast<float>(
            analysis::glint_angle_deg(static_cast<double>(zenith[i]), static_cast<double>(azimuth[i]),
                                      static_cast<double>(sun.zenith_deg[i]), static_cast<double>(sun.azimuth_deg[i]))));
    return glint;
}

Detection contextual(ImageChannels& image, Scene& scene, DetectReport& report) {
    const DetectJob& job = scene.job;
    const bool viirs = job.method == "viirs375";
    const auto& info = image.info();
    const int mir = image.require(job.mir_band, viirs ? kMirViirs : kMirModis), tir = image.require(job.tir_band, kThermal);
    const std::string mir_names = read_mir(image, mir, scene);
    const Channel thermal = image.read(tir, ImageChannels::Expect::RadianceOrTemperature);
    scene.tir_K = thermal.temperatures_K();
    report.bands = fmt::format("{} and {}", mir_names, thermal.name);
    const SunOfImage sun = sun_of_image(job.image, info, scene.where, job.sun_zenith_deg);
    scene.sun_zenith_deg = sun.zenith_deg;
    Reflectances reflected(image, scene, sun);
    const auto red = reflected.plane(kRed), nir = reflected.plane(kNir),
               swir = reflected.plane(viirs ? kSwirViirs : kSwirModis);
    const auto glint = job.sun_zenith_deg ? std::vector<float>() : glint_angles(info, sun);
    std::vector<float> cloud_K;
    if (const int band = image.find(kCloud); band > 0 && !viirs)
        cloud_K = image.read(band, ImageChannels::Expect::RadianceOrTemperature).temperatures_K();
    std::vector<unsigned char> water;
    if (job.water) water = read_water(*job.water, info);
    if (red.empty() || nir.empty()) report.notes.emplace_back("no bands near 0.65 and 0.86 um: no test of reflectances");
    if (glint.empty()) report.notes.emplace_back("no view angles: no test for sun glint");
    if (water.empty() && !viirs) report.notes.emplace_back("no water mask: all pixels are land");
    analysis::ThermalScene planes{info.cols, info.rows, scene.mir_K,          scene.tir_K, cloud_K, red,
                                  nir,       swir,      scene.sun_zenith_deg, glint,       water};
    constexpr double kSaturationViirs_K = 367.0;
    if (viirs) planes.mir_saturation_K = kSaturationViirs_K;
    return viirs ? analysis::detect_viirs375(planes) : analysis::detect_mod14(planes);
}

Detection by_index(ImageChannels& image, Scene& scene, DetectReport& report) {
    const DetectJob& job = scene.job;
    const auto& index = *analysis::find_spectral_index(job.method);
    auto made = index_plane(image, index, nullptr, job.least_radiance);
    report.bands = fmt::format("{}", fmt::join(made.bands, ", "));
    scene.tested = std::move(made.values);
    scene.tested_name = job.method;
    scene.tested_unit = index.kind == analysis::SpectralIndex::Kind::Difference ? "W m-2 sr-1 um-1" : "1";
    auto found = analysis::detect_by_index(scene.tested, index, job.threshold, job.deviations);
    report.threshold = found.threshold;
    // A pixel too dark for the index holds no fire.
    for (std::size_t i = 0; i < scene.n; ++i)
        if (found.result.fire[i] == FireClass::NotProcessed && made.dark[i] != 0) found.result.fire[i] = FireClass::Clear;
    if (const int mir = image.find(kMirModis); mir > 0) read_mir(image, mir, scene);
    return std::move(found.result);
}

/// Power of each fire pixel by the MIR radiance method, MW; NaN without a MIR band.
std::vector<float> powers(const Scene& scene, const std::vector<unsigned char>& fire) {
    std::vector<float> power(scene.n, kNaN);
    if (scene.mir_radiance.empty()) return power;
    const auto far = analysis::background_of_all(scene.mir_radiance, fire);
    for (std::size_t i = 0; i < scene.n; ++i) {
        if (fire[i] == 0) continue;
        const auto samples = static_cast<std::size_t>(scene.where.samples);
        const auto near = analysis::background_around(scene.mir_radiance, fire, scene.where.samples, scene.where.lines,
                                                      static_cast<int>(i % samples), static_cast<int>(i / samples));
        const auto& background = near.pixels > 0 ? near : far;
        if (background.pixels == 0) continue;
        power[i] = static_cast<float>(
            analysis::frp_mir_W_m2(static_cast<double>(scene.mir_radiance[i]), background.mean, scene.mir_coefficient, 1.0) *
            static_cast<double>(scene.where.area_m2[i]) * 1e-6);
    }
    return power;
}

std::filesystem::path beside(const DetectJob& job, const std::string& ending) {
    auto path = job.output;
    return path.replace_filename(job.output.stem().string() + ending);
}

void write_rasters(const Scene& scene, const gis::ImageInfo& info, const Detection& found,
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
}

void write_hotspots(const Scene& scene, const gis::ImageInfo& info, const Detection& found,
                    const std::vector<float>& power_MW) {
    HotspotTable table;
    const auto when = date_and_clock(metadata_item(info, "ACQUISITION_DATE"));
    table.date = when.date;
    table.clock = when.clock;
    table.satellite = table.instrument = metadata_item(info, "SENSOR");
    table.synthetic = info.metadata.contains("synthetic");
    table.version = table.synthetic ? "synthetic" : "";
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

analysis::DetectionScore score(const Scene& scene, const std::filesystem::path& path, const gis::ImageInfo& info,
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
    for (std::size_t i = 0; i < area_m2.size(); ++i) {
        area_m2[i] = (area_m2[i] + front[i]) * scene.where.area_m2[i];
        power_MW[i] *= scene.where.area_m2[i] * 1e-6F;
    }
    return analysis::score_detection(fire, area_m2, power_MW, scene.job.least_area_m2);
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
    const Json json = {{"method", job.method},
                       {"least_area_m2", job.least_area_m2},
                       {"true_pixels", s.true_pixels},
                       {"found", s.found},
                       {"omission", s.omission()},
                       {"detected", s.detected},
                       {"false_alarms", s.false_alarms},
                       {"commission", s.commission()},
                       {"background_pixels", s.background},
                       {"by_frp_MW", bins(s.by_frp_MW)},
                       {"by_area_m2", bins(s.by_area_m2)}};
    write_text_file(beside(job, "_scores.json"), json.dump(2) + "\n");
}

void count_classes(const Detection& found, DetectReport& report) {
    for (const FireClass c : found.fire) {
        report.fire_pixels += analysis::is_fire(c) ? 1 : 0;
        report.unknown += c == FireClass::Unknown ? 1 : 0;
        report.glint += c == FireClass::Glint ? 1 : 0;
        report.cloud += c == FireClass::Cloud ? 1 : 0;
        report.water += c == FireClass::Water ? 1 : 0;
        report.land += c == FireClass::Clear ? 1 : 0;
    }
}

}  // namespace

std::vector<std::string> detection_methods() {
    std::vector<std::string> names{"mod14", "viirs375"};
    for (const auto& index : analysis::spectral_indices())
        if (index.of_fire) names.emplace_back(index.name);
    return names;
}

DetectReport detect_image(const DetectJob& job) {
    ImageChannels image(job.image, job.sensor);
    DetectReport report;
    report.method = job.method;
    Scene scene{job, gis::pixel_positions(job.image)};
    scene.n = scene.where.lon_deg.size();
    const bool by_context = job.method == "mod14" || job.method == "viirs375";
    const Detection found = by_context ? contextual(image, scene, report) : by_index(image, scene, report);
    if (job.cancelled != nullptr && job.cancelled->load()) throw Cancelled();
    count_classes(found, report);
    std::vector<unsigned char> fire;
    for (const FireClass c : found.fire) fire.push_back(analysis::is_fire(c) ? 1 : 0);
    const auto power_MW = powers(scene, fire);
    report.total_MW = scene.mir_radiance.empty() ? std::nan("") : 0.0;
    for (const float power : power_MW) report.total_MW += std::isfinite(power) ? static_cast<double>(power) : 0.0;
    write_rasters(scene, image.info(), found, power_MW);
    write_hotspots(scene, image.info(), found, power_MW);
    if (const auto truth = truth_of(job)) {
        report.score = score(scene, *truth, image.info(), fire);
        write_score(job, *report.score);
    }
    return report;
}

}  // namespace pyroscene::pipeline
