#include "render/terrain_mesh.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/error.h"
#include "render/sky_view.h"

namespace pyroscene::render {
namespace {

constexpr int kMaximumGridEdge = 16384;  // vertices; Embree counts them in 15 bits
constexpr double kMargin_m = 0.05;       // play around the scene box, far above the rounding of float32

/// Index of the raster cell that vertex line `v` of n + 2 stands on or next to, and the weights of it and its inner neighbour.
struct VertexSource {
    int cell, inner;
    double weight_cell, weight_inner;
};

VertexSource vertex_source(int v, int n) {
    if (v == 0) return {0, std::min(1, n - 1), 1.5, -0.5};  // the rim continues the slope of the last two centres
    if (v == n + 1) return {n - 1, std::max(0, n - 2), 1.5, -0.5};
    return {v - 1, v - 1, 1.0, 0.0};
}

/// Offset of vertex line `v` from the raster's edge in cells: 0, 0.5, 1.5, ..., n - 0.5, n.
double vertex_offset(int v, int n) { return v == 0 ? 0.0 : v == n + 1 ? static_cast<double>(n) : v - 0.5; }

/// Heights with every hole filled from its already filled neighbours, so that the mesh is finite everywhere; what lies over
/// a hole is dropped again when a ray hits it.
std::vector<float> without_holes(const Raster<float>& height_m) {
    std::vector<float> filled = height_m.values;
    const int rows = height_m.grid.rows, cols = height_m.grid.cols;
    if (std::none_of(filled.begin(), filled.end(), [](float h) { return std::isfinite(h); })) return filled;

    for (bool open = true; open;) {
        open = false;
        const std::vector<float> before = filled;
        for (int r = 0; r < rows; ++r) {
            for (int c = 0; c < cols; ++c) {
                float& h = filled[height_m.grid.index(r, c)];
                if (std::isfinite(h)) continue;
                double sum = 0.0;
                int count = 0;
                for (int dr = -1; dr <= 1; ++dr) {
                    for (int dc = -1; dc <= 1; ++dc) {
                        if (!height_m.grid.contains(r + dr, c + dc)) continue;
                        const float near = before[height_m.grid.index(r + dr, c + dc)];
                        if (std::isfinite(near)) sum += near, ++count;
                    }
                }
                if (count > 0)
                    h = static_cast<float>(sum / count);
                else
                    open = true;
            }
        }
    }
    return filled;
}

}  // namespace

struct TerrainMesh::Impl {
    static constexpr std::size_t kPacket = 16;  ///< rays that Embree traces side by side
    struct Query;

    MapGrid grid;
    std::vector<std::uint8_t> hole;  ///< per cell, empty when there is none
    Vec3 centre;                     ///< origin of the float32 frame, scene frame
    Vec3 lower, upper;               ///< scene box, scene frame
    double steepest = 0.0;
    std::vector<float> z;    ///< of the vertices, from the centre: Embree's own lie too far apart for many looks
    TerrainHeights heights;  ///< of these
    std::shared_ptr<const SkyView> sky_view;
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    RTCGeometry geometry = nullptr;  ///< owned by the scene once it is committed

    ~Impl() {
        if (scene != nullptr) rtcReleaseScene(scene);
        if (device != nullptr) rtcReleaseDevice(device);
    }

    [[nodiscard]] bool is_hole(double x_m, double y_m) const noexcept {
        const int col = std::clamp(static_cast<int>((x_m - lower.x) / grid.cell_m), 0, grid.cols - 1);
        const int row = std::clamp(static_cast<int>((upper.y - y_m) / grid.cell_m), 0, grid.rows - 1);
        return hole[grid.index(row, col)] != 0;
    }

    /// Drops hits over cells without height (Embree calls it for every candidate hit).
    static void reject_holes(const RTCFilterFunctionNArguments* args) {
        const auto& self = *static_cast<const Impl*>(args->geometryUserPtr);
        for (unsigned i = 0; i < args->N; ++i) {
            if (args->valid[i] != -1) continue;
            const auto along_m = static_cast<double>(RTCRayN_tfar(args->ray, args->N, i));
            const double x_m =
                self.centre.x + RTCRayN_org_x(args->ray, args->N, i) + along_m * RTCRayN_dir_x(args->ray, args->N, i);
            const double y_m =
                self.centre.y + RTCRayN_org_y(args->ray, args->N, i) + along_m * RTCRayN_dir_y(args->ray, args->N, i);
            if (self.is_hole(x_m, y_m)) args->valid[i] = 0;
        }
    }

    void build(const Raster<float>& height_m, Vec3 scene_origin_m);
    float* begin_geometry();
    void commit_geometry();
    bool clip(Vec3 start, Vec3 direction, double& near_m, double& far_m) const noexcept;
    void intersect_packet(std::span<const SceneRay> rays, std::span<std::optional<Hit>> hits) const noexcept;
};

void TerrainMesh::Impl::build(const Raster<float>& height_m, Vec3 scene_origin_m) {
    grid = height_m.grid;
    if (grid.cols < 1 || grid.rows < 1 || !(grid.cell_m > 0.0)) {
        throw input_error("terrain", "the raster has no cells; expected at least one");
    }
    const bool has_holes =
        std::any_of(height_m.values.begin(), height_m.values.end(), [](float h) { return !std::isfinite(h); });
    std::vector<float> filled;
    if (has_holes) filled = without_holes(height_m);
    const std::vector<float>& solid = has_holes ? filled : height_m.values;
    if (!std::isfinite(solid.front())) throw input_error("terrain", "no cell has a height; expected at least one");
    if (has_holes) {
        hole.resize(grid.size());
        std::transform(height_m.values.begin(), height_m.values.end(), hole.begin(),
                       [](float h) { return static_cast<std::uint8_t>(!std::isfinite(h)); });
    }

    // Heights of one line of vertices after the other: all of them at once would outweigh the mesh.
    const int width = grid.cols + 2, height = grid.rows + 2;
    std::vector<double> line(static_cast<std::size_t>(width)), line_before(line.size());
    const auto fill_line = [&](int r) {
        const VertexSource row = vertex_source(r, grid.rows);
        const auto at = [&](int cell_row, int col) { return static_cast<double>(solid[grid.index(cell_row, col)]); };
        const auto along = [&](int cell_row, const VertexSource& col) {
            return col.weight_cell * at(cell_row, col.cell) + col.weight_inner * at(cell_row, col.inner);
        };
        for (int c = 0; c < width; ++c) {
            const VertexSource col = vertex_source(c, grid.cols);
            line[static_cast<std::size_t>(c)] =
                row.weight_cell * along(row.cell, col) + row.weight_inner * along(row.inner, col);
        }
    };
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    for (int r = 0; r < height; ++r) {
        fill_line(r);
        const auto [low, high] = std::minmax_element(line.begin(), line.end());
        lowest = std::min(lowest, *low), highest = std::max(highest, *high);
    }
    lower = {grid.west_m - scene_origin_m.x, grid.south_m() - scene_origin_m.y, lowest};
    upper = {grid.east_m() - scene_origin_m.x, grid.north_m - scene_origin_m.y, highest};
    centre = 0.5 * (lower + upper);

    float* point = begin_geometry();
    const auto run_m = [&](int v, int last) { return (v == 1 || v == last ? 0.5 : 1.0) * grid.cell_m; };
    for (int r = 0; r < height; ++r) {
        std::swap(line, line_before);
        fill_line(r);
        const double y = upper.y - vertex_offset(r, grid.rows) * grid.cell_m;
        for (int c = 0; c < width; ++c) {
            const auto i = static_cast<std::size_t>(c);
            const double x = lower.x + vertex_offset(c, grid.cols) * grid.cell_m;
            for (const double v : {x - centre.x, y - centre.y, line[i] - centre.z}) *point++ = static_cast<float>(v);
            z.push_back(*(point - 1));
            if (c > 0) steepest = std::max(steepest, std::abs(line[i] - line[i - 1]) / run_m(c, width - 1));
            if (r > 0) steepest = std::max(steepest, std::abs(line[i] - line_before[i]) / run_m(r, height - 1));
        }
    }
    steepest *= std::sqrt(2.0);  // both edges of a facet may climb
    commit_geometry();
    sky_view = std::make_shared<const SkyView>(heights);
}

/// Starts Embree and returns the buffer for the vertices, [row][col] of x, y, z.
float* TerrainMesh::Impl::begin_geometry() {
    device = rtcNewDevice(nullptr);
    if (device == nullptr) throw runtime_error("terrain", "Embree could not be started");
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT);
    geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_GRID);
    const auto count = static_cast<std::size_t>(grid.cols + 2) * static_cast<std::size_t>(grid.rows + 2);
    auto* buffer = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), count));
    if (buffer == nullptr) throw runtime_error("terrain", "not enough memory for the terrain mesh");
    z.reserve(count);
    heights = {z.data(), grid.cols, grid.rows, grid.cell_m, lower, upper, centre.z};
    return buffer;
}

void TerrainMesh::Impl::commit_geometry() {
    const int width = grid.cols + 2, height = grid.rows + 2;
    std::vector<RTCGrid> tiles;  // neighbours share their border vertices
    for (int r = 0; r < height - 1; r += kMaximumGridEdge - 1) {
        for (int c = 0; c < width - 1; c += kMaximumGridEdge - 1) {
            tiles.push_back({static_cast<unsigned>(r) * static_cast<unsigned>(width) + static_cast<unsigned>(c),
                             static_cast<unsigned>(width),
                             static_cast<unsigned short>(std::min(kMaximumGridEdge, width - c)),
                             static_cast<unsigned short>(std::min(kMaximumGridEdge, height - r))});
        }
    }
    auto* tile_buffer = static_cast<RTCGrid*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_GRID, 0, RTC_FORMAT_GRID, sizeof(RTCGrid), tiles.size()));
    std::copy(tiles.begin(), tiles.end(), tile_buffer);

    rtcSetGeometryUserData(geometry, this);
    if (!hole.empty()) {
        rtcSetGeometryIntersectFilterFunction(geometry, &Impl::reject_holes);
        rtcSetGeometryOccludedFilterFunction(geometry, &Impl::reject_holes);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    if (rtcGetDeviceError(device) != RTC_ERROR_NONE)
        throw runtime_error("terrain", "Embree could not build the terrain mesh");
}

/// Cuts the ray's piece [near, far] to the scene box (slabs). Float32 then only sees numbers of the size of the scene.
bool TerrainMesh::Impl::clip(Vec3 start, Vec3 direction, double& near_m, double& far_m) const noexcept {
    const auto slab = [&](double s, double d, double lo, double hi) {
        if (d == 0.0) return s >= lo && s <= hi;
        const double a = (lo - s) / d, b = (hi - s) / d;
        near_m = std::max(near_m, std::min(a, b));
        far_m = std::min(far_m, std::max(a, b));
        return true;
    };
    return slab(start.x, direction.x, lower.x - kMargin_m, upper.x + kMargin_m) &&
           slab(start.y, direction.y, lower.y - kMargin_m, upper.y + kMargin_m) &&
           slab(start.z, direction.z, lower.z - kMargin_m, upper.z + kMargin_m) && near_m <= far_m;
}

TerrainMesh::TerrainMesh(const Raster<float>& height_m, Vec3 scene_origin_m) : impl_(std::make_unique<Impl>()) {
    impl_->build(height_m, scene_origin_m);
}
TerrainMesh::TerrainMesh(TerrainMesh&&) noexcept = default;
TerrainMesh::~TerrainMesh() = default;

/// A segment as Embree sees it: cut to the scene box, in float32 from the mesh's own origin.
struct TerrainMesh::Impl::Query {
    Vec3 start_m, direction;
    double near_m = 0.0, far_m = 0.0;
    Vec3 local_m;

    /// False for segments that miss the box.
    bool set(const Impl& mesh, Vec3 from_m, Vec3 to_m) noexcept {
        far_m = length(to_m - from_m);
        if (!(far_m > 0.0) || !std::isfinite(far_m)) return false;
        start_m = from_m;
        direction = (to_m - from_m) / far_m;
        near_m = 0.0;
        if (!mesh.clip(start_m, direction, near_m, far_m)) return false;
        local_m = start_m + near_m * direction - mesh.centre;
        return true;
    }
    [[nodiscard]] Hit hit(float tfar, Vec3 Ng) const noexcept {
        Hit hit;
        hit.distance_m = near_m + static_cast<double>(tfar);
        hit.point_m = start_m + hit.distance_m * direction;
        hit.normal = normalized(Ng);
        if (hit.normal.z < 0.0) hit.normal = -hit.normal;
        return hit;
    }
};

std::optional<TerrainMesh::Hit> TerrainMesh::intersect(Vec3 start_m, Vec3 end_m) const noexcept {
    Impl::Query query;
    if (!query.set(*impl_, start_m, end_m)) return std::nullopt;
    alignas(16) RTCRayHit q{};
    q.ray.org_x = static_cast<float>(query.local_m.x);
    q.ray.org_y = static_cast<float>(query.local_m.y);
    q.ray.org_z = static_cast<float>(query.local_m.z);
    q.ray.dir_x = static_cast<float>(query.direction.x);
    q.ray.dir_y = static_cast<float>(query.direction.y);
    q.ray.dir_z = static_cast<float>(query.direction.z);
    q.ray.tfar = static_cast<float>(query.far_m - query.near_m);
    q.ray.mask = ~0U;
    q.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(impl_->scene, &context, &q);
    if (q.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return query.hit(q.ray.tfar, {q.hit.Ng_x, q.hit.Ng_y, q.hit.Ng_z});
}

void TerrainMesh::Impl::intersect_packet(std::span<const SceneRay> rays, std::span<std::optional<Hit>> hits) const noexcept {
    std::array<Query, kPacket> queries;
    alignas(64) std::array<int, kPacket> valid{};
    alignas(64) RTCRayHit16 q{};
    for (std::size_t i = 0; i < rays.size(); ++i) {
        hits[i].reset();
        q.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        Query& query = queries[i];
        if (!query.set(*this, rays[i].start_m, rays[i].end_m)) continue;
        valid[i] = -1;
        q.ray.org_x[i] = static_cast<float>(query.local_m.x);
        q.ray.org_y[i] = static_cast<float>(query.local_m.y);
        q.ray.org_z[i] = static_cast<float>(query.local_m.z);
        q.ray.dir_x[i] = static_cast<float>(query.direction.x);
        q.ray.dir_y[i] = static_cast<float>(query.direction.y);
        q.ray.dir_z[i] = static_cast<float>(query.direction.z);
        q.ray.tfar[i] = static_cast<float>(query.far_m - query.near_m);
        q.ray.mask[i] = ~0U;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(valid.data(), scene, &context, &q);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (valid[i] == 0 || q.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
        hits[i] = queries[i].hit(q.ray.tfar[i], {q.hit.Ng_x[i], q.hit.Ng_y[i], q.hit.Ng_z[i]});
    }
}

void TerrainMesh::intersect(std::span<const SceneRay> rays, std::span<std::optional<Hit>> hits) const noexcept {
    for (std::size_t first = 0; first < rays.size(); first += Impl::kPacket) {
        const std::size_t count = std::min(Impl::kPacket, rays.size() - first);
        impl_->intersect_packet(rays.subspan(first, count), hits.subspan(first, count));
    }
}

bool TerrainMesh::occluded(Vec3 from_m, Vec3 direction, double distance_m) const noexcept {
    double near_m = 0.0, far_m = distance_m;
    if (!impl_->clip(from_m, direction, near_m, far_m)) return false;
    const Vec3 local = from_m + near_m * direction - impl_->centre;
    alignas(16) RTCRay ray{};
    ray.org_x = static_cast<float>(local.x);
    ray.org_y = static_cast<float>(local.y);
    // A point on the ground must not be shadowed by its own facet: lift it by more than the rounding of float32.
    ray.org_z = static_cast<float>(local.z + 1e-6 * length(impl_->upper - impl_->lower) + 1e-3);
    ray.dir_x = static_cast<float>(direction.x);
    ray.dir_y = static_cast<float>(direction.y);
    ray.dir_z = static_cast<float>(direction.z);
    ray.tfar = static_cast<float>(far_m - near_m);
    ray.mask = ~0U;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(impl_->scene, &context, &ray);
    return ray.tfar < 0.0F;
}

double TerrainHeights::at(double x_m, double y_m) const noexcept {
    const double col = (x_m - lower_m.x) / cell_m, row = (upper_m.y - y_m) / cell_m;
    if (!(col >= 0.0 && col <= cols && row >= 0.0 && row <= rows)) return std::numeric_limits<double>::quiet_NaN();
    const int c = std::min(static_cast<int>(col + 0.5), cols), r = std::min(static_cast<int>(row + 0.5), rows);
    const auto fraction = [](double place, int v, int n) {
        const double begin = vertex_offset(v, n);
        return (place - begin) / (vertex_offset(v + 1, n) - begin);
    };
    const double fx = fraction(col, c, cols), fy = fraction(row, r, rows);
    const auto z = [&](int dr, int dc) { return static_cast<double>(*stored(r + dr - 1, c + dc - 1)); };
    return zero_m + (1.0 - fy) * ((1.0 - fx) * z(0, 0) + fx * z(0, 1)) + fy * ((1.0 - fx) * z(1, 0) + fx * z(1, 1));
}

const TerrainHeights& TerrainMesh::heights() const noexcept { return impl_->heights; }
std::shared_ptr<const SkyView> TerrainMesh::sky_view() const noexcept { return impl_->sky_view; }
std::array<double, 2> TerrainMesh::height_range_m() const noexcept { return {impl_->lower.z, impl_->upper.z}; }
double TerrainMesh::steepest_slope() const noexcept { return impl_->steepest; }
const MapGrid& TerrainMesh::grid() const noexcept { return impl_->grid; }

}  // namespace pyroscene::render
