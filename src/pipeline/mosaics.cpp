#include "pipeline/mosaics.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/mosaic.h"
#include "base/error.h"
#include "gis/tiff_writer.h"
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
    struct Member {
        analysis::OrthoLookup lookup;
        std::unique_ptr<gis::ImageStream> radiance;
    };
    const MapGrid grid = common_grid(job);
    auto mosaic = analysis::empty_mosaic(grid);
    std::vector<Member> members;
    const auto on_map = [](const Member& m, std::span<const float> zenith_deg, std::span<const float> time_s) {
        const auto& info = m.radiance->info();
        return analysis::MosaicMember{m.lookup, info.cols, info.rows, zenith_deg, time_s};
    };
    for (const auto& job_of_member : job.members) {
        if (job_of_member.bands != job.members.front().bands)
            throw input_error(fmt::format("mosaic '{}'", job.mosaic.id),
                              fmt::format("acquisitions '{}' and '{}' have not the same bands",
                                          job.members.front().acquisition.id, job_of_member.acquisition.id));
        auto image = read_rendered(job_of_member);
        members.push_back({visible_ground(job_of_member, image, grid, report), std::move(image.radiance)});
        const auto zenith_deg = plane_of(image, kViewZenith), time_s = plane_of(image, kPixelTime);
        analysis::add_to_mosaic(mosaic, on_map(members.back(), zenith_deg, time_s), rule_of(job.mosaic),
                                static_cast<int>(members.size()));
    }
    const auto& bands = members.front().radiance->info().bands;
    std::filesystem::create_directories(job.file.parent_path());
    gis::CogWriter out(job.file, raster_of(job, grid, bands));
    for (std::size_t b = 0; b < bands.size(); ++b) {
        std::vector<float> band(grid.size(), std::nanf(""));
        for (std::size_t k = 0; k < members.size(); ++k)
            analysis::fill_from_member(mosaic, on_map(members[k], {}, {}), static_cast<int>(k) + 1,
                                       members[k].radiance->read_band(static_cast<int>(b) + 1), band);
        out.write_band(b, band);
    }
    std::size_t next = bands.size();
    for (const auto* plane : {&mosaic.time_s, &mosaic.member, &mosaic.view_zenith_deg}) out.write_band(next++, *plane);
    out.finish();
    report.count("mosaics_made", 1);
}

}  // namespace pyroscene::pipeline
