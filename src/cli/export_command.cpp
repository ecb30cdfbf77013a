#include "cli/export_command.h"

#include <filesystem>
#include <iostream>
#include <stdexcept>

#include <fmt/format.h>

#include "base/error.h"
#include "base/files.h"
#include "cli/progress.h"
#include "inputs/load_scenario.h"
#include "pipeline/flame_export.h"

namespace pyroscene::cli {
namespace {

struct Format {
    const char* name;
    const char* extension;
    void (*write)(const std::filesystem::path& path, const pipeline::FlameExport& flame, const ExportOptions& options);
};

void write_dirsig(const std::filesystem::path& path, const pipeline::FlameExport& flame, const ExportOptions& options) {
    write_text_file(path, pipeline::dirsig_grid(flame, options.material, options.concentration_ppm));
    auto object = path;
    object += ".odb";
    write_text_file(object, pipeline::dirsig_object(flame, path.filename().string()));
}

void write_side(const std::filesystem::path& path, const pipeline::FlameExport& flame, const ExportOptions& options) {
    std::optional<pipeline::MapWindow> window;
    if (const auto& w = options.window_m; !w.empty()) window = {w[0], w[1], w[2], w[3]};
    pipeline::write_side_view(path, flame, window);
}

constexpr Format kFormats[] = {
    {"dirsig-grid", ".grid", &write_dirsig},
    {"vdb", ".vdb", [](const auto& path, const auto& flame, const auto&) { pipeline::write_flame_vdb(path, flame); }},
    {"csv", ".csv",
     [](const auto& path, const auto& flame, const auto&) { write_text_file(path, pipeline::flame_csv(flame)); }},
    {"side-view", ".png", &write_side},
    {"top-view", ".png", [](const auto& path, const auto& flame, const auto&) { pipeline::write_top_view(path, flame); }},
};

const Format& format_of(const std::string& name) {
    for (const auto& format : kFormats)
        if (name == format.name) return format;
    throw std::invalid_argument("--format: unknown '" + name + "'");
}

pipeline::FlameExportRequest request_of(const ExportOptions& o) {
    if (o.acquisitions.size() + (o.time_s ? 1U : 0U) != 1U)
        throw std::invalid_argument("export: give one --acquisition or --time_s");
    pipeline::FlameExportRequest request;
    if (!o.acquisitions.empty()) request.acquisition = o.acquisitions.front();
    request.time_s = o.time_s;
    request.layers = o.layers;
    request.crop = o.format == "side-view";
    request.above_ground = o.above_ground;
    if (!o.window_m.empty() && o.window_m.size() != 4)
        throw std::invalid_argument("--window_m takes four numbers: west,east,south,north");
    if (o.voxel_m.empty()) return request;
    for (const double edge_m : o.voxel_m)
        if (!(edge_m >= 0.05 && edge_m <= 200.0)) throw std::invalid_argument("--voxel_m: edges lie within 0.05 and 200 m");
    if (o.voxel_m.size() != 3) throw std::invalid_argument("--voxel_m takes three edges: east,north,up");
    request.voxel_m = {o.voxel_m[0], o.voxel_m[1], o.voxel_m[2]};
    return request;
}

}  // namespace

std::vector<std::string> export_formats() {
    std::vector<std::string> names;
    for (const auto& format : kFormats) names.emplace_back(format.name);
    return names;
}

void export_command(const ExportOptions& options) {
    const auto& format = format_of(options.format);
    auto request = request_of(options);
    if (options.format == "vdb" && !pipeline::has_openvdb()) pipeline::write_flame_vdb("export", {});  // says why not
    const auto scene = inputs::load_scenario(options.scenario);
    Progress progress(options.quiet);
    request.monitor.progress = [&](double fraction) { progress.update("fire states", fraction); };
    request.monitor.cancelled = options.cancelled;
    const auto flame = pipeline::export_flame(scene, request);
    progress.finish();
    const auto name = request.acquisition.empty() ? fmt::format("t{:09.0f}", flame.time_s) : request.acquisition;
    const std::filesystem::path path = options.output.empty()
                                           ? std::filesystem::path("out") / scene.name / "export" / (name + format.extension)
                                           : std::filesystem::path(options.output);
    format.write(path, flame, options);
    if (options.quiet) return;
    const auto corner = flame.corner_m();
    const auto& g = flame.field.grid;
    fmt::print(
        "{}: {} x {} x {} voxels of {:g} x {:g} x {:g} m, south-west-bottom corner {:.3f} {:.3f} {:.3f} m, flames of "
        "{:.6g} m3\n",
        path.string(), flame.size[0], flame.size[1], flame.size[2], g.dx_m, g.dy_m, g.dz_m, corner.x, corner.y, corner.z,
        flame.field.emissive_volume_m3());
}

}  // namespace pyroscene::cli
