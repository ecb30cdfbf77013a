#include "imagery/index_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/error.h"
#include "drawing/qgis_style.h"
#include "gis/pixel_positions.h"
#include "gis/raster_input.h"
#include "sensors/detector.h"

namespace pyroscene::imagery {
namespace {

constexpr const char* kDifference = "dnbr";

/// The index of one file.
IndexPlane plane_of(const std::filesystem::path& path, const IndexJob& job, const analysis::SpectralIndex& index,
                    gis::ImageInfo* info) {
    ImageChannels image(path, job.sensor);
    if (info != nullptr) *info = image.info();
    const auto& bands = image.info().bands;
    const bool done = std::all_of(bands.begin(), bands.end(), [](const auto& b) { return b.unit == "1"; });
    std::optional<SunOfImage> sun;
    if (index.reflectance)
        sun = done ? SunOfImage{} : sun_of_image(path, image.info(), gis::pixel_positions(path), job.sun_zenith_deg);
    return index_plane(image, index, sun ? &*sun : nullptr);
}

struct Writer {
    const IndexJob& job;
    const gis::ImageInfo& info;

    [[nodiscard]] gis::OutputRaster raster() const {
        gis::OutputRaster out;
        out.cols = info.cols;
        out.rows = info.rows;
        out.like = job.image;
        out.synthetic = info.metadata.contains("synthetic");
        out.acquisition_time = metadata_item(info, "ACQUISITION_DATE");
        out.metadata["SOURCE_IMAGE"] = job.image.filename().string();
        out.metadata["INDEX"] = job.name;
        return out;
    }
    void write(const std::filesystem::path& path, const gis::OutputRaster& out, const std::vector<float>& pixels) const {
        if (info.on_map)
            gis::write_cog(path, out, pixels);
        else
            gis::write_geotiff(path, out, pixels);
    }
};

void summarise(const std::vector<float>& values, IndexReport& report) {
    report.median = analysis::robust_statistics(values).median;
    report.minimum = std::numeric_limits<double>::infinity();
    report.maximum = -report.minimum;
    for (const float v : values) {
        if (!std::isfinite(v)) continue;
        report.minimum = std::min(report.minimum, static_cast<double>(v));
        report.maximum = std::max(report.maximum, static_cast<double>(v));
    }
}

/// NBR from before the fire on the pixels of the image from after it.
std::vector<float> nbr_before(const IndexJob& job, const analysis::SpectralIndex& nbr, const gis::ImageInfo& after) {
    gis::ImageInfo info;
    const auto plane = plane_of(*job.before, job, nbr, &info);
    const bool same_size = info.cols == after.cols && info.rows == after.rows;
    if (!info.on_map || !after.on_map) {
        if (same_size) return plane.values;
        throw input_error(job.before->string(),
                          fmt::format("{} x {} pixels, the later image has {} x {}, and both are not on a map", info.cols,
                                      info.rows, after.cols, after.rows));
    }
    const auto grid = gis::make_map_grid(job.image, {}, {});
    if (same_size && grid == gis::make_map_grid(*job.before, {}, {})) return plane.values;
    // By way of a file: resampling reads files.
    gis::OutputRaster out;
    out.cols = info.cols;
    out.rows = info.rows;
    out.like = *job.before;
    out.bands = {{"nbr", "1", {}, {}, {}}};
    auto path = job.output;
    path.replace_filename("." + job.output.stem().string() + "_before.tif");
    gis::write_geotiff(path, out, plane.values);
    auto on_grid = gis::read_band({path, 1, gis::Resampling::Bilinear, "nbr", "1"}, grid);
    std::filesystem::remove(path);
    return std::move(on_grid.values);
}

IndexReport burn_severity(const IndexJob& job) {
    if (!job.before) throw input_error("dnbr", "needs --before, the image from before the fire");
    const auto& nbr = *analysis::find_spectral_index("nbr");
    IndexReport report;
    gis::ImageInfo info;
    const auto after = plane_of(job.image, job, nbr, &info);
    const auto before = nbr_before(job, nbr, info);
    report.bands = after.bands;
    std::vector<float> dnbr(before.size());
    for (std::size_t i = 0; i < dnbr.size(); ++i) dnbr[i] = before[i] - after.values[i];
    summarise(dnbr, report);
    const auto relative = analysis::relative_dnbr(dnbr, before);
    const auto classes = analysis::burn_severity(dnbr);
    const auto where = gis::pixel_positions(job.image);
    const Writer writer{job, info};
    auto severity = writer.raster();
    severity.classes = true;
    severity.class_names = {"no data"};
    for (const auto& c : analysis::severity_classes()) {
        severity.class_names.emplace_back(c.name);
        report.severity.push_back({std::string(c.name), 0, 0.0});
    }
    for (std::size_t i = 0; i < classes.size(); ++i) {
        if (classes[i] == 0) continue;
        auto& of = report.severity[classes[i] - 1];
        ++of.pixels;
        if (std::isfinite(where.area_m2[i])) of.area_ha += static_cast<double>(where.area_m2[i]) * 1e-4;
    }
    auto out = writer.raster();
    out.bands = {{"dNBR", "1", {}, {}, {}}, {"RdNBR", "1", {}, {}, {}}};
    std::vector<float> pixels = std::move(dnbr);
    pixels.insert(pixels.end(), relative.begin(), relative.end());
    writer.write(job.output, out, pixels);
    severity.bands = {{"burn severity", "", {}, {}, {}}};
    auto path = job.output;
    path.replace_filename(job.output.stem().string() + "_severity.tif");
    writer.write(path, severity, {classes.begin(), classes.end()});
    constexpr std::array<const char*, 7> kColours{"#1a9850", "#a6d96a", "#e0e0d0", "#fee08b",
                                                  "#fdae61", "#f46d43", "#a50026"};
    std::vector<drawing::ClassStyle> styles;
    for (std::size_t k = 0; k < kColours.size(); ++k)
        styles.push_back({static_cast<int>(k) + 1, kColours[k], severity.class_names[k + 1]});
    drawing::write_qgis_style(path, styles);
    return report;
}

/// Radiance at which a band saturates when no surface lit by the sun reaches it, else nothing.
std::optional<double> limit_above_sunlight(const Channel& channel) {
    if (!channel.detector || !channel.detector->saturation_radiance_W_m2_sr_um) return {};
    const double limit = *channel.detector->saturation_radiance_W_m2_sr_um;
    return limit >= solar_irradiance_W_m2_um(channel.response) / kPi ? std::optional(limit) : std::nullopt;
}

/// What the detector tells of the index: its noise, and where all bands are at their limit.
void add_detector(const std::vector<Channel>& channels, const analysis::SpectralIndex& index,
                  std::span<const std::span<const float>> planes, std::span<const double> centres_um, IndexPlane& out) {
    if (!std::all_of(channels.begin(), channels.end(), [](const auto& c) { return c.detector.has_value(); })) return;
    std::vector<std::vector<float>> noise;
    for (const auto& c : channels) noise.push_back(sensors::noise_and_rounding(*c.detector, c.values));
    const std::vector<std::span<const float>> spans(noise.begin(), noise.end());
    out.noise = analysis::spectral_index_noise(index, planes, spans, centres_um);
    out.burnt_out.assign(out.values.size(), 1);
    for (const auto& c : channels) {
        constexpr double kRounding = 1e-6;  // of a limit kept as float
        const double limit = limit_above_sunlight(c).value_or(std::numeric_limits<double>::infinity()) * (1.0 - kRounding);
        for (std::size_t i = 0; i < out.burnt_out.size(); ++i)
            if (!(static_cast<double>(c.values[i]) >= limit)) out.burnt_out[i] = 0;
    }
}

}  // namespace

IndexPlane index_plane(ImageChannels& image, const analysis::SpectralIndex& index, const SunOfImage* sun,
                       double least_radiance) {
    IndexPlane out;
    std::vector<Channel> channels;
    std::vector<double> centres_um;
    for (int b = 0; b < index.bands; ++b) {
        const auto& wanted = index.band[static_cast<std::size_t>(b)];
        const std::string what = fmt::format("index {}", index.name);
        const int number = image.require(
            {}, {wanted.best_um, wanted.best_um - wanted.tolerance_um, wanted.best_um + wanted.tolerance_um, what.c_str()});
        Channel band = image.read(
            number, sun != nullptr ? ImageChannels::Expect::RadianceOrReflectance : ImageChannels::Expect::Radiance);
        out.bands.push_back(fmt::format("{} ({:.4g} um)", band.name, band.centre_um));
        centres_um.push_back(band.centre_um);
        if (sun != nullptr) band.values = reflectances(band, sun->zenith_deg, sun->distance_AU);
        channels.push_back(std::move(band));
    }
    std::vector<std::span<const float>> planes;
    for (const auto& c : channels) planes.emplace_back(c.values);
    out.values = analysis::spectral_index(index, planes, centres_um);
    if (sun != nullptr) return out;
    add_detector(channels, index, planes, centres_um, out);
    out.dark.assign(out.values.size(), 0);
    for (std::size_t i = 0; i < out.values.size(); ++i) {
        const bool dark = std::all_of(planes.begin(), planes.end(),
                                      [&](const auto& p) { return static_cast<double>(p[i]) < least_radiance; });
        out.dark[i] = dark ? 1 : 0;
        if (dark) out.values[i] = std::numeric_limits<float>::quiet_NaN();
    }
    return out;
}

std::vector<std::string> index_names() {
    std::vector<std::string> names{kDifference};
    for (const auto& index : analysis::spectral_indices()) names.emplace_back(index.name);
    return names;
}

IndexReport index_image(const IndexJob& job) {
    if (job.name == kDifference) return burn_severity(job);
    const auto& index = *analysis::find_spectral_index(job.name);
    gis::ImageInfo info;
    const auto plane = plane_of(job.image, job, index, &info);
    IndexReport report;
    report.bands = plane.bands;
    summarise(plane.values, report);
    const Writer writer{job, info};
    auto out = writer.raster();
    out.bands = {{job.name, index.kind == analysis::SpectralIndex::Kind::Difference ? "W m-2 sr-1 um-1" : "1", {}, {}, {}}};
    writer.write(job.output, out, plane.values);
    return report;
}

}  // namespace pyroscene::imagery
