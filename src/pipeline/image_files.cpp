#include "pipeline/image_files.h"

#include <cmath>
#include <string>

#include <fmt/format.h>
#include <tbb/parallel_invoke.h>

#include "base/constants.h"
#include "pipeline/sensor_json.h"
#include "sensors/detector.h"

namespace pyroscene::pipeline {
namespace {

std::map<std::string, std::string> common_metadata(const GroupJob& job) {
    const auto pose = job.geometry.path.at(0.0);
    const auto& group = job.group;
    const auto& scan = job.geometry.scan;
    const auto place_in_scan = sensors::scan_position_of(job.geometry, 0, 0);
    const bool lines_of_scans = scan.kind != sensors::ScanLaw::Kind::Frame && scan.kind != sensors::ScanLaw::Kind::Disk;
    return {{"FINGERPRINT", job.fingerprint},
            {"SCAN_TYPE", scan_type_name(job.sensor.scan)},
            {"FIRST_SAMPLE", fmt::format("{}", job.geometry.first_sample)},
            {"FIRST_LINE", fmt::format("{}", job.geometry.first_line)},
            {"LINES_PER_SCAN", fmt::format("{}", lines_of_scans ? scan.lines_per_scan : job.geometry.lines)},
            {"FIRST_LINE_OF_SCAN", fmt::format("{}", lines_of_scans ? static_cast<int>(std::floor(place_in_scan.v)) : 0)},
            {"SCENARIO", job.scenario.name},
            {"ACQUISITION", job.acquisition.id},
            {"SENSOR", job.sensor.id},
            {"CAMERA_GROUP", group.id},
            {"TIME_S", fmt::format("{}", job.acquisition.time_s)},
            {"PLATFORM_LATITUDE_DEG", fmt::format("{:.10f}", pose.position.lat_deg)},
            {"PLATFORM_LONGITUDE_DEG", fmt::format("{:.10f}", pose.position.lon_deg)},
            {"PLATFORM_HEIGHT_M", fmt::format("{:.4f}", pose.position.h_m)},
            {"PLATFORM_HEADING_DEG", fmt::format("{}", pose.heading_rad / kDegree_rad)},
            {"PLATFORM_PITCH_DEG", fmt::format("{}", pose.pitch_rad / kDegree_rad)},
            {"PLATFORM_ROLL_DEG", fmt::format("{}", pose.roll_rad / kDegree_rad)},
            {"FOCAL_LENGTH_M", fmt::format("{:.12g}", group.focal_length_m)},
            {"PIXEL_PITCH_M", fmt::format("{:.12g}", group.pixel_pitch_m)},
            {"PHYSICS", job.scenario.physics == fire::Physics::Thesis ? "thesis" : "default"}};
}

gis::OutputRaster sensor_raster(const GroupJob& job) {
    gis::OutputRaster out;
    out.cols = job.geometry.samples;
    out.rows = job.geometry.lines;
    out.geolocation = job.files.geolocation();
    out.metadata = common_metadata(job);
    out.acquisition_time = UtcTime{job.scenario.start.unix_s + job.acquisition.time_s}.iso8601();
    return out;
}

gis::OutputRaster radiance_raster(const GroupJob& job) {
    auto out = sensor_raster(job);
    for (const int b : job.bands) {
        const auto& band = job.sensor.bands[static_cast<std::size_t>(b)];
        gis::OutputBand meta{band.id + " radiance", "W m-2 sr-1 um-1", band.centre_um, band.fwhm_um, {{"band_id", band.id}}};
        if (band.saturation_radiance_W_m2_sr_um)
            meta.metadata["saturation_radiance"] = fmt::format("{:.6g}", *band.saturation_radiance_W_m2_sr_um);
        out.bands.push_back(std::move(meta));
    }
    out.compression = gis::compression_of_image(out.bands.size());
    return out;
}

/// Planes of the truth that do not belong to a band.
const std::vector<gis::OutputBand> kPixelTruth{
    {"fraction_flame", "1", {}, {}, {}},    {"fraction_front", "1", {}, {}, {}},
    {"fraction_scar", "1", {}, {}, {}},     {"fraction_background", "1", {}, {}, {}},
    {"fraction_smoke", "1", {}, {}, {}},    {"ground_temperature", "K", {}, {}, {}},
    {"flame_temperature", "K", {}, {}, {}}, {"fire_radiant_exitance", "W m-2", {}, {}, {}},
    {"scene_coverage", "1", {}, {}, {}}};

std::size_t term_count(bool plume) {
    return static_cast<std::size_t>(plume ? render::kTermCount : render::kTermCount - render::kSmokeTermCount);
}

/// After the planes of pixels, for each band: noise-free radiance, saturation, every term.
gis::OutputRaster truth_raster(const GroupJob& job, bool plume) {
    auto out = sensor_raster(job);
    out.compression = gis::Compression::Zstd;  // the largest file; read by this program and by GDAL, hardly by others
    out.bands = kPixelTruth;
    for (const int b : job.bands) {
        const auto& band = job.sensor.bands[static_cast<std::size_t>(b)];
        const auto radiance = [&](const std::string& name) {
            return gis::OutputBand{
                band.id + " " + name, "W m-2 sr-1 um-1", band.centre_um, band.fwhm_um, {{"band_id", band.id}}};
        };
        out.bands.push_back(radiance("radiance_noise_free"));
        out.bands.push_back({band.id + " saturated", "1", {}, {}, {{"band_id", band.id}}});
        for (std::size_t t = 0; t < term_count(plume); ++t)
            out.bands.push_back(radiance(std::string("term_") + render::kTermNames[t]));
    }
    return out;
}

/// Light that strays across the focal plane needs the whole of it.
int lines_that_fit(const GroupJob& job, std::size_t values_per_pixel) {
    if (job.sensor.stray.share > 0.0) return job.geometry.lines;
    return gis::rows_of_part(values_per_pixel * static_cast<std::size_t>(job.geometry.samples), job.geometry.lines);
}

}  // namespace

ImageFiles::ImageFiles(const GroupJob& job, bool plume) : job_(&job), saturated_(job.bands.size()) {
    for (const int b : job.bands) {
        bands_.push_back(job.sensor.bands[static_cast<std::size_t>(b)]);
        if (job.scenario.render.noise) continue;
        bands_.back().noise = {};
        if (auto& range = bands_.back().sensitive_range) range->noise = {};
    }
    auto radiance = radiance_raster(job);
    const bool wants_truth = job.scenario.products.truth;
    auto truth = wants_truth ? truth_raster(job, plume) : gis::OutputRaster{};
    lines_at_once_ = lines_that_fit(job, radiance.bands.size() + truth.bands.size());
    radiance.tile_rows = truth.tile_rows = lines_at_once_;
    radiance_.emplace(job.files.radiance(), std::move(radiance));
    if (wants_truth) truth_.emplace(job.files.truth(), std::move(truth));
    lines_at_once_ = radiance_->tile_rows();
}

void ImageFiles::measure(std::size_t k, std::size_t first_pixel, std::vector<float>& plane,
                         std::vector<std::uint8_t>& saturated) {
    const auto stream = fmt::format("noise/{}/{}", job_->acquisition.id, bands_[k].id);
    const RandomKey key{job_->scenario.seed, stream_id(stream.c_str()), 0};
    sensors::add_stray_light(job_->sensor.stray, job_->geometry.samples, plane);
    saturated.resize(plane.size());
    saturated_[k] += sensors::apply_detector(bands_[k], key, plane, saturated, first_pixel);
}

void ImageFiles::add_pixel_truth(const render::RadianceImage& lines, const gis::RasterPart& part) {
    Buffer<float> no_smoke;  // without a plume the fraction is 0 wherever something is seen
    if (lines.smoke_fraction.empty())
        for (const float flame : lines.flame_fraction) no_smoke.push_back(flame * 0.0F);
    const auto& smoke = lines.smoke_fraction.empty() ? no_smoke : lines.smoke_fraction;
    auto plane = part;
    for (const Buffer<float>* values :
         {&lines.flame_fraction, &lines.front_fraction, &lines.scar_fraction, &lines.background_fraction, &smoke,
          &lines.ground_temperature_K, &lines.flame_temperature_K, &lines.radiant_exitance_W_m2, &lines.coverage}) {
        truth_->write(plane, std::span<const float>(*values));
        ++plane.first_band;
    }
}

void ImageFiles::add(const render::RadianceImage& lines, RunReport& report) {
    const PhaseTimer timer(report, "render/write");
    const std::size_t n = lines.coverage.size();
    const auto first_pixel = static_cast<std::size_t>(lines.first_line) * static_cast<std::size_t>(lines.samples);
    gis::RasterPart part{0, 1, lines.first_line, lines.lines}, truth_part = part;
    if (truth_) add_pixel_truth(lines, truth_part);
    truth_part.first_band = kPixelTruth.size();
    std::vector<float> plane;
    std::vector<std::uint8_t> saturated;
    for (std::size_t k = 0; k < bands_.size(); ++k) {
        const auto of_band = [&](const Buffer<float>& cube) { return std::span<const float>(cube).subspan(k * n, n); };
        const auto noise_free = of_band(lines.radiance_W_m2_sr_um);
        plane.assign(noise_free.begin(), noise_free.end());
        measure(k, first_pixel, plane, saturated);
        part.first_band = k;
        radiance_->write(part, plane);
        if (!truth_) continue;
        const auto add_truth = [&](std::span<const float> values) {
            truth_->write(truth_part, values);
            ++truth_part.first_band;
        };
        add_truth(noise_free);
        plane.assign(saturated.begin(), saturated.end());
        add_truth(plane);
        for (const auto& term : lines.terms)
            if (!term.empty()) add_truth(of_band(term));
    }
}

void ImageFiles::finish(const Geolocation& geolocation, RunReport& report) {
    const PhaseTimer timer(report, "render/write");
    for (std::size_t k = 0; k < bands_.size(); ++k)
        report.count(fmt::format("saturated_pixels/{}/{}", job_->acquisition.id, bands_[k].id), saturated_[k]);
    auto out = sensor_raster(*job_);
    out.geolocation.reset();
    out.compression = gis::Compression::Zstd;
    out.tile_rows = 128;  // a part of it is read without the rest
    for (const auto& [name, unit] : kGeolocationBands) out.bands.push_back({name, unit, {}, {}, {}});
    const auto write_geolocation = [&] { gis::write_geotiff(job_->files.geolocation(), out, geolocation.planes()); };
    tbb::parallel_invoke(write_geolocation, [&] {
        if (truth_) truth_->finish();
    });
    radiance_->set_control_points(geolocation.control_points());
    radiance_->finish();
}

}  // namespace pyroscene::pipeline
