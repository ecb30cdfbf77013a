#include "pipeline/flame_export.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "drawing/line_plot.h"
#include "inputs/scene_inputs.h"
#include "pipeline/acquisition.h"

namespace pyroscene::pipeline {
namespace {

using fire::FlameField;
using scenario::Scenario;

double time_of(const Scenario& scenario, const FlameExportRequest& request) {
    if (request.acquisition.empty()) return request.time_s.value_or(0.0);
    for (const auto& a : scenario.acquisitions)
        if (a.id == request.acquisition) return a.time_s;
    std::vector<std::string> ids;
    for (const auto& a : scenario.acquisitions) ids.push_back(a.id);
    throw input_error("--acquisition",
                      fmt::format("the scenario has no '{}'; it has {}", request.acquisition, fmt::join(ids, ", ")));
}

/// The state of a frame, from the first frame on; one state at a time is in memory.
fire::FireState state_of(const Scenario& scenario, const inputs::SceneInputs& in, std::size_t last, const Monitor& monitor) {
    std::optional<fire::FireState> previous;
    for (std::size_t i = 0; i <= last; ++i) {
        if (monitor.is_cancelled()) throw Cancelled();
        if (monitor.progress) monitor.progress(static_cast<double>(i) / static_cast<double>(last + 1));
        previous = fire::advance(previous ? &*previous : nullptr, inputs::load_frame(scenario, in, i), scenario.fire);
    }
    if (monitor.progress) monitor.progress(1.0);
    return std::move(*previous);
}

/// Lattice indices of an interval, the last one excluded.
std::array<std::int64_t, 2> cells(double low_m, double high_m, double edge_m) {
    constexpr double kRounding = 1e-9;
    return {static_cast<std::int64_t>(std::floor(low_m / edge_m + kRounding)),
            static_cast<std::int64_t>(std::ceil(high_m / edge_m - kRounding))};
}

/// Extends the lattice of the flames to the map and sets its size.
void place_lattice(FlameExport& flame, const inputs::SceneInputs& in, const std::optional<int>& layers, bool crop) {
    const auto& g = flame.field.grid;
    const double half_x_m = 0.5 * in.grid.cols * in.grid.cell_m, half_y_m = 0.5 * in.grid.rows * in.grid.cell_m;
    auto [i_low, i_end] = cells(-half_x_m, half_x_m, g.dx_m);
    auto [j_low, j_end] = cells(-half_y_m, half_y_m, g.dy_m);
    auto k_low = cells(flame.above_ground ? 0.0 : in.lowest_m, 0.0, g.dz_m)[0];
    auto k_end = k_low + 1;
    --i_low, --j_low, ++i_end, ++j_end;
    if (!flame.field.empty()) {
        const auto first = [](double corner_m, double edge_m) {
            return static_cast<std::int64_t>(std::lround(corner_m / edge_m));
        };
        const std::array<std::int64_t, 3> own{first(g.corner_m.x, g.dx_m), first(g.corner_m.y, g.dy_m),
                                              first(g.corner_m.z, g.dz_m)};
        i_low = std::min(i_low, own[0]);
        j_low = std::min(j_low, own[1]);
        k_low = std::min(k_low, own[2]);
        i_end = std::max(i_end, own[0] + g.nx);
        j_end = std::max(j_end, own[1] + g.ny);
        flame.shift = {static_cast<int>(own[0] - i_low), static_cast<int>(own[1] - j_low), static_cast<int>(own[2] - k_low)};
        std::int64_t highest = 0;
        for_each_voxel(flame, [&](const ExportVoxel& v) { highest = std::max<std::int64_t>(highest, v.k); });
        k_end = std::max(k_end, k_low + highest + 1);
    } else {
        flame.field.grid.corner_m = {static_cast<double>(i_low) * g.dx_m, static_cast<double>(j_low) * g.dy_m,
                                     static_cast<double>(k_low) * g.dz_m};
    }
    flame.size = {static_cast<int>(i_end - i_low), static_cast<int>(j_end - j_low), static_cast<int>(k_end - k_low)};
    if (!layers) return;
    if (*layers < flame.size[2] && !crop)
        throw input_error("--layers",
                          fmt::format("{} layers of {} m are asked for, but the flames and the ground below them "
                                      "reach through {}",
                                      *layers, g.dz_m, flame.size[2]));
    flame.size[2] = *layers;
}

}  // namespace

void for_each_voxel(const FlameExport& flame, const std::function<void(const ExportVoxel&)>& visit) {
    std::vector<ExportVoxel> voxels;
    const auto& field = flame.field;
    constexpr int kEdge = FlameField::kBrickEdge;
    for (std::size_t c = 0; c < field.columns.size(); ++c) {
        const auto& column = field.columns[c];
        const int i0 = static_cast<int>(c % static_cast<std::size_t>(field.brick_cols)) * kEdge + flame.shift[0];
        const int j0 = static_cast<int>(c / static_cast<std::size_t>(field.brick_cols)) * kEdge + flame.shift[1];
        for (int b = 0; b < column.brick_count; ++b) {
            const auto& brick = field.bricks[static_cast<std::size_t>(column.first_brick + b)];
            const int k0 = (column.z_begin + b) * kEdge + flame.shift[2];
            for (int v = 0; v < FlameField::kBrickVoxels; ++v)
                if (const auto at = static_cast<std::size_t>(v); brick.fill[at] > 0.0F)
                    voxels.push_back({i0 + v % kEdge, j0 + v / kEdge % kEdge, k0 + v / (kEdge * kEdge), brick.fill[at],
                                      brick.temperature_K[at]});
        }
    }
    std::sort(voxels.begin(), voxels.end(),
              [](const ExportVoxel& a, const ExportVoxel& b) { return std::tie(a.k, a.j, a.i) < std::tie(b.k, b.j, b.i); });
    for (const auto& voxel : voxels) visit(voxel);
}

Vec3 FlameExport::corner_m() const noexcept {
    const auto& g = field.grid;
    return {origin_m.x + g.corner_m.x - shift[0] * g.dx_m, origin_m.y + g.corner_m.y - shift[1] * g.dy_m,
            origin_m.z + g.corner_m.z - shift[2] * g.dz_m};
}

FlameExport export_flame(const Scenario& scenario, const FlameExportRequest& request) {
    auto in = inputs::load_scene_inputs(scenario);
    auto cut = scenario;
    if (request.voxel_m) cut.flame.parameters.voxel_m = *request.voxel_m;
    FlameExport flame;
    flame.scenario = scenario.name;
    flame.crs_wkt = in.grid.crs_wkt;
    flame.time_s = time_of(scenario, request);
    flame.above_ground = request.above_ground;
    flame.origin_m = in.origin_m;
    const auto label = request.acquisition.empty() ? std::string("--time_s") : request.acquisition;
    const auto frame = inputs::frame_at(in.frames, flame.time_s, label);
    const auto state = state_of(scenario, in, frame, request.monitor);
    flame.heat_flux_W_m2 = inputs::load_frame(scenario, in, frame).heat_flux_W_m2;
    if (request.above_ground)
        for (float& height : in.terrain_m.values)
            if (!std::isnan(height)) height = 0.0F;
    flame.field = make_fire_scene(cut, in, state, flame.time_s).flame;
    auto& grid = flame.field.grid;
    if (flame.field.empty()) {
        const auto& v = cut.flame.parameters.voxel_m;
        grid.dx_m = v[0];
        grid.dy_m = v[1];
        grid.dz_m = v[2];
    }
    place_lattice(flame, in, request.layers, request.crop);
    return flame;
}

std::string dirsig_grid(const FlameExport& flame, int material, double concentration_ppm) {
    std::string out = fmt::format("{} {} {}\n", flame.size[0], flame.size[1], flame.size[2]);
    for_each_voxel(flame, [&](const ExportVoxel& v) {
        fmt::format_to(std::back_inserter(out), "{} {} {} {} {:.3f} {:.4f}\n", v.i, v.j, v.k, material, v.temperature_K,
                       static_cast<double>(v.fill) * concentration_ppm);
    });
    return out;
}

std::string dirsig_object(const FlameExport& flame, const std::string& grid_file) {
    const Vec3 corner = flame.corner_m();
    const auto& g = flame.field.grid;
    return fmt::format(
        "REGULAR_GRID {{\n    INSERT_POINT = {:.3f}, {:.3f}, {:.3f}\n    DELTA_X = {:g}\n    DELTA_Y = {:g}\n"
        "    DELTA_Z = {:g}\n    GRID_FILENAME = {}\n}}\n",
        corner.x, corner.y, corner.z, g.dx_m, g.dy_m, g.dz_m, grid_file);
}

std::string flame_csv(const FlameExport& flame) {
    std::string out = "x_m,y_m,z_m,fill,temperature_K,volume_m3\n";
    const Vec3 corner = flame.corner_m();
    const auto& g = flame.field.grid;
    const double volume_m3 = g.dx_m * g.dy_m * g.dz_m;
    for_each_voxel(flame, [&](const ExportVoxel& v) {
        fmt::format_to(std::back_inserter(out), "{:.3f},{:.3f},{:.3f},{:.7g},{:.6g},{:.6g}\n",
                       corner.x + (v.i + 0.5) * g.dx_m, corner.y + (v.j + 0.5) * g.dy_m, corner.z + (v.k + 0.5) * g.dz_m,
                       v.fill, v.temperature_K, static_cast<double>(v.fill) * volume_m3);
    });
    return out;
}

namespace {

/// Lattice indices from `first` to before `end` of a window's side, cut to the lattice.
struct IndexRange {
    int first, end;
    [[nodiscard]] int count() const noexcept { return end - first; }
    [[nodiscard]] bool contains(int i) const noexcept { return i >= first && i < end; }
};

IndexRange range_of(double low_m, double high_m, double corner_m, double edge_m, int size) {
    const auto [first, end] = cells(low_m - corner_m, high_m - corner_m, edge_m);
    const IndexRange range{static_cast<int>(std::clamp<std::int64_t>(first, 0, size)),
                           static_cast<int>(std::clamp<std::int64_t>(end, 0, size))};
    if (!(high_m > low_m) || range.count() <= 0)
        throw input_error("--window_m", fmt::format("{} to {} m from the centre hold nothing of the lattice ({} to {} m)",
                                                    low_m, high_m, corner_m, corner_m + size * edge_m));
    return range;
}

std::string clock(double time_s) {
    return fmt::format("{:02.0f}:{:02.0f} after ignition", std::floor(time_s / 60.0), std::fmod(time_s, 60.0));
}

}  // namespace

void write_side_view(const std::filesystem::path& path, const FlameExport& flame, const std::optional<MapWindow>& window) {
    const auto& g = flame.field.grid;
    const Vec3 corner = flame.corner_m() - flame.origin_m;
    IndexRange across{0, flame.size[0]}, along{0, flame.size[1]};
    if (window) {
        across = range_of(window->west_m, window->east_m, corner.x, g.dx_m, flame.size[0]);
        along = range_of(window->south_m, window->north_m, corner.y, g.dy_m, flame.size[1]);
    }
    drawing::PlotImage image;
    image.cols = across.count();
    image.rows = flame.size[2];
    image.values.assign(static_cast<std::size_t>(image.cols) * static_cast<std::size_t>(image.rows), 0.0F);
    for_each_voxel(flame, [&](const ExportVoxel& v) {
        if (!across.contains(v.i) || !along.contains(v.j) || v.k >= image.rows) return;
        image.values[static_cast<std::size_t>(image.rows - 1 - v.k) * static_cast<std::size_t>(image.cols) +
                     static_cast<std::size_t>(v.i - across.first)] += static_cast<float>(v.fill * g.dy_m);
    });
    image.x_low = corner.x + across.first * g.dx_m;
    image.x_high = corner.x + across.end * g.dx_m;
    image.y_low = corner.z;
    image.y_high = corner.z + image.rows * g.dz_m;
    image.unit = "m of flame along the line of sight";
    drawing::LinePlot plot;
    plot.width_px = 1100;
    plot.height_px = 340;
    plot.x.label = "east of the map's centre, m";
    plot.y.label = flame.above_ground ? "above the ground, m" : "height, m";
    const double exaggeration = (image.x_high - image.x_low) / drawing::plot_area(plot, true)[0] /
                                ((image.y_high - image.y_low) / drawing::plot_area(plot, true)[1]);
    plot.title = fmt::format("{}, {}, seen from the south, heights x {:.2g}  SYNTHETIC", flame.scenario, clock(flame.time_s),
                             exaggeration);
    plot.image = std::move(image);
    drawing::write_line_plots(path, std::vector{plot});
}

void write_top_view(const std::filesystem::path& path, const FlameExport& flame) {
    const auto& flux = flame.heat_flux_W_m2;
    drawing::PlotImage image;
    image.cols = flux.grid.cols;
    image.rows = flux.grid.rows;
    image.values = flux.values;
    image.x_low = flux.grid.west_m - flame.origin_m.x;
    image.x_high = flux.grid.east_m() - flame.origin_m.x;
    image.y_low = flux.grid.south_m() - flame.origin_m.y;
    image.y_high = flux.grid.north_m - flame.origin_m.y;
    image.unit = "heat flux, W m-2";
    drawing::LinePlot plot;
    plot.title = fmt::format("{}, {}  SYNTHETIC", flame.scenario, clock(flame.time_s));
    plot.x.label = "east of the map's centre, m";
    plot.y.label = "north of the map's centre, m";
    const auto margins = drawing::plot_area(plot, true);
    constexpr int kLongest_px = 640;
    const double scale = kLongest_px / static_cast<double>(std::max(image.cols, image.rows));
    plot.width_px += static_cast<int>(std::lround(scale * image.cols)) - margins[0];
    plot.height_px += static_cast<int>(std::lround(scale * image.rows)) - margins[1];
    plot.image = std::move(image);
    drawing::write_line_plots(path, std::vector{plot});
}

}  // namespace pyroscene::pipeline
