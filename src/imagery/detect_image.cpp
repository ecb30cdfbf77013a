#include "imagery/detect_image.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/frp.h"
#include "analysis/spectral_index.h"
#include "base/error.h"
#include "gis/pixel_positions.h"
#include "imagery/detection_files.h"
#include "imagery/image_channels.h"
#include "imagery/index_image.h"
#include "imagery/pixel_match.h"
#include "imagery/sun_of_image.h"

namespace pyroscene::imagery {
namespace {

using analysis::Detection;
using analysis::FireClass;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr BandWish kMirModis{3.96, 3.4, 4.2, "MIR"}, kMirViirs{3.74, 3.4, 4.2, "MIR"},
    kThermal{11.0, 10.0, 12.6, "thermal infrared"}, kCloud{12.0, 11.7, 12.6, "12 um"}, kRed{0.65, 0.60, 0.70, "red"},
    kNir{0.86, 0.80, 0.90, "near infrared"}, kSwirModis{2.13, 2.05, 2.35, "SWIR"}, kSwirViirs{1.61, 1.55, 1.75, "SWIR"};
constexpr double kSensitiveLimit_K = 331.0;  ///< where MODIS band 22 saturates

using Scene = DetectionScene;

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

/// Whether the sun is down over the middle of the image; an image without a time is taken for one by day.
bool by_night(const gis::ImageInfo& info, Scene& scene) {
    const bool known = scene.job.sun_zenith_deg || !metadata_item(info, "ACQUISITION_DATE").empty();
    if (!known) return false;
    scene.sun_zenith_deg = sun_of_image(scene.job.image, info, scene.where, scene.job.sun_zenith_deg).zenith_deg;
    auto zenith_deg = scene.sun_zenith_deg;
    std::erase_if(zenith_deg, [](float v) { return !std::isfinite(v); });
    if (zenith_deg.empty()) return false;
    const auto middle = zenith_deg.begin() + static_cast<std::ptrdiff_t>(zenith_deg.size() / 2);
    std::nth_element(zenith_deg.begin(), middle, zenith_deg.end());
    constexpr float kNight_deg = 90.0F;
    return *middle > kNight_deg;
}

Detection by_index(ImageChannels& image, Scene& scene, DetectReport& report) {
    const DetectJob& job = scene.job;
    const auto& index = *analysis::find_spectral_index(job.method);
    auto made = index_plane(image, index, nullptr, job.least_radiance);
    report.bands = fmt::format("{}", fmt::join(made.bands, ", "));
    scene.tested = std::move(made.values);
    scene.tested_name = job.method;
    scene.tested_unit = index.kind == analysis::SpectralIndex::Kind::Difference ? "W m-2 sr-1 um-1" : "1";
    auto found = analysis::detect_by_index({scene.tested, made.noise, made.dark, made.burnt_out}, index,
                                           {job.threshold, job.deviations, by_night(image.info(), scene)});
    report.threshold = found.threshold;
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
    write_detection(scene, image.info(), found, power_MW);
    report.score = score_against_truth(scene, image.info(), fire);
    return report;
}

}  // namespace pyroscene::imagery
