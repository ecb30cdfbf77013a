#include "gis/resample.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <gdalwarper.h>

#include "base/constants.h"
#include "base/error.h"
#include "gis/extent.h"

namespace pyroscene::gis {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Ground area of a pixel of each row, up to a common factor: constant on a map, the ellipsoid's meridian and parallel arcs
/// for north-up geographic pixels (WGS 84; e^2 of the other ellipsoids differs by 1e-4 of itself).
std::vector<double> row_weights(const SourceBand& source, const PixelWindow& window) {
    std::vector<double> weights(static_cast<std::size_t>(window.rows), 1.0);
    if (!source.crs.geographic) return weights;
    constexpr double kEccentricity2 = 6.69437999014e-3;
    for (int row = 0; row < window.rows; ++row) {
        const auto& gt = source.geotransform;
        const double lat_deg = gt[3] + gt[5] * (window.row + row + 0.5) + gt[4] * 0.5 * source.cols;
        const double s = std::sin(std::clamp(lat_deg, -89.999, 89.999) * kDegree_rad);
        weights[static_cast<std::size_t>(row)] = std::sqrt(1.0 - s * s) / std::pow(1.0 - kEccentricity2 * s * s, 2);
    }
    return weights;
}

/// What the warper needs to go from its output strip to the window held in memory.
struct StripTransform {
    const GridMapping* mapping = nullptr;
    PixelWindow window;
    int first_row = 0;
};

int transform_strip(void* argument, int to_source, int count, double* x, double* y, double*, int* success) {
    const auto& strip = *static_cast<const StripTransform*>(argument);
    const std::span<double> col(x, static_cast<std::size_t>(count)), row(y, static_cast<std::size_t>(count));
    const auto shift = [](std::span<double> values, double by) {
        for (double& v : values) v += by;
    };
    if (to_source != 0) {
        shift(row, strip.first_row);
        strip.mapping->grid_to_source(col, row);
        shift(col, -strip.window.col);
        shift(row, -strip.window.row);
    } else {
        shift(col, strip.window.col);
        shift(row, strip.window.row);
        strip.mapping->source_to_grid(col, row);
        shift(row, -strip.first_row);
    }
    for (std::size_t i = 0; i < col.size(); ++i) success[i] = std::isfinite(col[i]) && std::isfinite(row[i]) ? 1 : 0;
    return TRUE;
}

/// Float raster over memory that someone else owns; NaN is nodata.
DatasetPtr wrap_memory(float* pixels, int cols, int rows) {
    DatasetPtr dataset = create_memory_dataset(cols, rows);
    const std::string pointer = fmt::format("DATAPOINTER={}", fmt::ptr(pixels));
    const char* const options[] = {pointer.c_str(), nullptr};
    if (dataset->AddBand(GDT_Float32, const_cast<char**>(options)) != CE_None)
        throw runtime_error("raster in memory", "cannot be set up");
    dataset->GetRasterBand(1)->SetNoDataValue(kNaN);
    return dataset;
}

struct WarpOptionsCloser {
    void operator()(GDALWarpOptions* options) const noexcept { GDALDestroyWarpOptions(options); }
};
struct ApproximationCloser {
    void operator()(void* transformer) const noexcept { GDALDestroyApproxTransformer(transformer); }
};

/// Destination pixels per source pixel as the warper wants it. It would guess from bounding boxes, and a slightly turned grid
/// would be blurred; here it is exact, and 1 unless the source is clearly finer.
std::string warp_scale(double source_pixels_per_cell) {
    return fmt::format("{:.17g}", source_pixels_per_cell < 1.1 ? 1.0 : 1.0 / source_pixels_per_cell);
}

/// Largest error of the interpolated pixel positions [source pixels].
constexpr double kPositionTolerance_px = 0.01;

void warp_strip(const GridMapping& mapping, SourcePixels& source, int grid_cols, int first_row, int last_row,
                Resampling rule, float* out) {
    const GdalErrors errors;
    DatasetPtr from = wrap_memory(source.values.data(), source.window.cols, source.window.rows);
    DatasetPtr to = wrap_memory(out, grid_cols, last_row - first_row);
    StripTransform strip{.mapping = &mapping, .window = source.window, .first_row = first_row};
    const std::unique_ptr<void, ApproximationCloser> fast(
        GDALCreateApproxTransformer(transform_strip, &strip, kPositionTolerance_px));
    const std::unique_ptr<GDALWarpOptions, WarpOptionsCloser> options(GDALCreateWarpOptions());
    options->hSrcDS = from.get();
    options->hDstDS = to.get();
    GDALWarpInitDefaultBandMapping(options.get(), 1);
    GDALWarpInitSrcNoDataReal(options.get(), kNaN);
    GDALWarpInitDstNoDataReal(options.get(), kNaN);
    options->eResampleAlg = rule == Resampling::Nearest ? GRA_NearestNeighbour : GRA_Bilinear;
    options->eWorkingDataType = GDT_Float32;
    options->dfWarpMemoryLimit = 4e9;  // one piece: the strip is already small, and its result must not depend on cuts
    options->pfnTransformer = GDALApproxTransform;
    options->pTransformerArg = fast.get();
    char** settings = CSLSetNameValue(nullptr, "INIT_DEST", "NO_DATA");
    settings = CSLSetNameValue(settings, "NUM_THREADS", "1");
    settings = CSLSetNameValue(settings, "SAMPLE_GRID", "YES");
    settings = CSLSetNameValue(settings, "XSCALE", warp_scale(mapping.cols_per_cell()).c_str());
    options->papszWarpOptions = CSLSetNameValue(settings, "YSCALE", warp_scale(mapping.rows_per_cell()).c_str());
    GDALWarpOperation operation;
    if (operation.Initialize(options.get()) != CE_None ||
        operation.ChunkAndWarpImage(0, 0, grid_cols, last_row - first_row) != CE_None)
        throw runtime_error("resampling", errors.message());
    to->FlushCache();
}

/// Source pixels held at once (128 MB as float).
constexpr std::size_t kWindowLimit = std::size_t{1} << 25;

struct Resampler {
    const SourceBand& source;
    const MapGrid& grid;
    const GridMapping& mapping;
    Resampling rule;
    bool overlaps = false;

    void run(int first_row, int last_row, float* out) {
        const PixelWindow window = mapping.source_window(first_row, last_row);
        if (window.empty()) return;
        if (window.size() > kWindowLimit && last_row - first_row > 1) {
            const int middle = first_row + (last_row - first_row) / 2;
            run(first_row, middle, out);
            run(middle, last_row, out + grid.index(middle - first_row, 0));
            return;
        }
        overlaps = true;
        SourcePixels pixels{
            .window = window, .values = read_window(source, window), .row_weights = row_weights(source, window)};
        if (rule == Resampling::Conserve)
            average_by_area(mapping, pixels, grid.cols, first_row, last_row, out);
        else
            warp_strip(mapping, pixels, grid.cols, first_row, last_row, rule, out);
    }
};

bool all_nan(const std::vector<float>& values) {
    return std::all_of(values.begin(), values.end(), [](float v) { return std::isnan(v); });
}

}  // namespace

std::vector<float> resample(const SourceBand& source, const MapGrid& grid, Resampling rule) {
    const GridMapping mapping(grid, source);
    std::vector<float> values;
    if (mapping.identical()) {
        values = read_window(source, {.cols = source.cols, .rows = source.rows});
    } else {
        values.assign(grid.size(), kNaN);
        Resampler resampler{.source = source, .grid = grid, .mapping = mapping, .rule = rule};
        resampler.run(0, grid.rows, values.data());
        if (!resampler.overlaps)
            throw input_error(source.subject, fmt::format("does not overlap the map; found {}, expected {}",
                                                          describe_extent(source), describe_extent(grid)));
    }
    if (all_nan(values))
        throw input_error(source.subject, "holds only nodata on the map; expected at least one cell with a value");
    return values;
}

}  // namespace pyroscene::gis
