#include "pipeline/mosaics.h"

#include <algorithm>

#include <fmt/format.h>

#include "analysis/mosaic.h"
#include "base/error.h"
#include "pipeline/rendered_image.h"

namespace pyroscene::pipeline {
namespace {

analysis::MosaicRule rule_of(const scenario::Mosaic& mosaic) {
    switch (mosaic.rule) {
        case scenario::Mosaic::Rule::NearestNadir:
            return analysis::MosaicRule::NearestNadir;
        case scenario::Mosaic::Rule::Latest:
            return analysis::MosaicRule::Latest;
        case scenario::Mosaic::Rule::Earliest:
            break;
    }
    return analysis::MosaicRule::Earliest;
}

/// Ground of all images, and the coarsest of their cells.
MapGrid common_grid(const MosaicJob& job) {
    std::vector<double> x_m, y_m;
    double cell_m = 0.0;
    for (const auto& member : job.members) {
        const auto ground = read_ground(member);
        cell_m = std::max(cell_m, ortho_cell_m(ground.gsd_m));
        x_m.insert(x_m.end(), ground.x_m.begin(), ground.x_m.end());
        y_m.insert(y_m.end(), ground.y_m.begin(), ground.y_m.end());
    }
    return analysis::ortho_grid(job.members.front().inputs.grid, cell_m, x_m, y_m);
}

std::vector<float> plane_of(const RenderedImage& image, GeolocationPlane plane) {
    const auto values = image.where(plane);
    return {values.begin(), values.end()};
}

gis::OutputRaster raster_of(const MosaicJob& job, const MapGrid& grid, std::vector<gis::OutputBand> bands) {
    const auto& first = job.members.front();
    gis::OutputRaster out;
    out.grid = grid;
    out.cols = grid.cols;
    out.rows = grid.rows;
    out.bands = std::move(bands);
    out.bands.push_back({"time since start", "s", {}, {}, {}});
    out.bands.push_back({"number of the image", "1", {}, {}, {}});
    out.bands.push_back({"view zenith", "degree", {}, {}, {}});
    out.acquisition_time = UtcTime{first.scenario.start.unix_s + first.acquisition.time_s}.iso8601();
    out.metadata = {{"SCENARIO", first.scenario.name},
                    {"MOSAIC", job.mosaic.id},
                    {"SENSOR", first.sensor.id},
                    {"CAMERA_GROUP", first.group.id},
                    {"START", first.scenario.start.iso8601()},
                    {"FINGERPRINT", job.fingerprint}};
    for (std::size_t k = 0; k < job.members.size(); ++k)
        out.metadata[fmt::format("IMAGE_{}", k + 1)] = job.members[k].acquisition.id;
    return out;
}

}  // namespace

void write_mosaic(const MosaicJob& job, RunReport& report) {
    const MapGrid grid = common_grid(job);
    const auto band_count = job.members.front().bands.size();
    auto mosaic = analysis::empty_mosaic(grid, band_count);
    std::vector<gis::OutputBand> bands;
    for (std::size_t k = 0; k < job.members.size(); ++k) {
        const auto& member = job.members[k];
        if (member.bands != job.members.front().bands)
            throw input_error(fmt::format("mosaic '{}'", job.mosaic.id),
                              fmt::format("acquisitions '{}' and '{}' have not the same bands",
                                          job.members.front().acquisition.id, member.acquisition.id));
        const auto image = read_rendered(member);
        if (bands.empty()) bands = image.radiance.bands;
        const auto lookup = visible_ground(member, image, grid, report);
        const std::vector<float> pixels(image.radiance.pixels.begin(), image.radiance.pixels.end());
        const auto zenith_deg = plane_of(image, kViewZenith), time_s = plane_of(image, kPixelTime);
        analysis::add_to_mosaic(mosaic, {lookup, image.samples, image.lines, pixels, zenith_deg, time_s},
                                rule_of(job.mosaic), static_cast<int>(k) + 1);
    }
    std::vector<float> out = std::move(mosaic.pixels);
    for (const auto* plane : {&mosaic.time_s, &mosaic.member, &mosaic.view_zenith_deg})
        out.insert(out.end(), plane->begin(), plane->end());
    std::filesystem::create_directories(job.file.parent_path());
    gis::write_cog(job.file, raster_of(job, grid, std::move(bands)), std::span<const float>(out));
    report.count("mosaics_made", 1);
}

}  // namespace pyroscene::pipeline
