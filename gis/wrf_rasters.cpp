#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <cpl_minixml.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal_priv.h>

#include "base/error.h"
#include "gis/gdal_support.h"
#include "gis/memory_raster.h"
#include "gis/raster_source.h"
#include "gis/wrf_sfire.h"

namespace pyroscene::gis {
namespace {

/// Extent of one of the two grids in pixels of its variables. GDAL turns netCDF files north up, which brings the padding of
/// the fire grid, the northernmost rows and easternmost columns of the file, to the top and the right.
struct Extent {
    int cols, rows, padding_rows;
    double cell_x_m, cell_y_m;
};

Extent extent(const WrfSfire& wrf, WrfGrid grid) {
    if (grid == WrfGrid::Atmosphere) return {wrf.cols, wrf.rows, 0, wrf.dx_m, wrf.dy_m};
    return {wrf.cols * wrf.refine_x, wrf.rows * wrf.refine_y, wrf.refine_y, wrf.dx_m / wrf.refine_x,
            wrf.dy_m / wrf.refine_y};
}

std::string escaped(const std::string& text) {
    char* xml = CPLEscapeString(text.c_str(), -1, CPLES_XML);
    std::string out(xml);
    CPLFree(xml);
    return out;
}

/// Names of one series must not meet those of another in the same process.
std::string series_key(const WrfSfire& wrf) {
    std::string all;
    for (const auto& moment : wrf.moments) all += moment.file.string() + fmt::format("#{};", moment.record);
    return all;
}

std::string source_xml(const WrfMoment& moment, const std::string& variable, const Extent& e) {
    return fmt::format(
        "<SimpleSource><SourceFilename relativeToVRT=\"0\">{}</SourceFilename><SourceBand>{}</SourceBand>"
        "<SrcRect xOff=\"0\" yOff=\"{}\" xSize=\"{}\" ySize=\"{}\"/><DstRect xOff=\"0\" yOff=\"0\" xSize=\"{}\" "
        "ySize=\"{}\"/></SimpleSource>",
        escaped(fmt::format("NETCDF:\"{}\":{}", moment.file.string(), variable)), moment.record + 1, e.padding_rows, e.cols,
        e.rows, e.cols, e.rows);
}

std::string band_xml(const WrfBand& band, int number, const std::string& unit, const Extent& e, WrfCombine combine) {
    const bool several = band.variables.size() > 1;
    std::string out = fmt::format("<VRTRasterBand dataType=\"Float32\" band=\"{}\"{}>", number,
                                  several ? " subClass=\"VRTDerivedRasterBand\"" : "");
    out += fmt::format(
        "<Description>{}</Description><UnitType>{}</UnitType><Metadata><MDI key=\"time_s\">{:.3f}</MDI></Metadata>",
        escaped(band.variables.front()), escaped(unit), band.time_s);
    if (several)
        out += fmt::format("<PixelFunctionType>{}</PixelFunctionType><SourceTransferType>Float32</SourceTransferType>",
                           combine == WrfCombine::Sum ? "sum" : "mul");
    for (const auto& variable : band.variables) out += source_xml(*band.moment, variable, e);
    return out + "</VRTRasterBand>";
}

void write_memory_file(const std::string& name, const std::string& text) {
    VSILFILE* file = VSIFOpenL(name.c_str(), "wb");
    const bool written = file != nullptr && VSIFWriteL(text.data(), 1, text.size(), file) == text.size();
    if (file != nullptr) VSIFCloseL(file);
    if (!written) throw runtime_error(name, "cannot be kept in memory");
}

std::string dataset_head(const WrfSfire& wrf, const Extent& e) {
    return fmt::format(
        "<VRTDataset rasterXSize=\"{}\" rasterYSize=\"{}\"><SRS "
        "dataAxisToSRSAxisMapping=\"1,2\">{}</SRS><GeoTransform>{:.17g}, "
        "{:.17g}, 0, {:.17g}, 0, {:.17g}</GeoTransform>",
        e.cols, e.rows, escaped(wrf.crs_wkt), wrf.west_m, e.cell_x_m, wrf.north_m, -e.cell_y_m);
}

/// The front stands inside a cell, and where is told by the times before and behind it. The file says of the cells ahead only
/// that the fire is not there yet: the first of them get the time at which it comes if it goes on as it came, not before now.
void extend_by_a_cell(std::vector<float>& times_s, int cols, int rows, float now_s) {
    const auto known = times_s;
    const auto at = [&](int col, int row) {
        const bool inside = col >= 0 && row >= 0 && col < cols && row < rows;
        return inside ? known[static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(col)]
                      : std::numeric_limits<float>::quiet_NaN();
    };
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < cols; ++col) {
            if (!std::isnan(at(col, row))) continue;
            float earliest = std::numeric_limits<float>::quiet_NaN();
            for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}) {
                const float near = at(col + dx, row + dy), step = near - at(col + 2 * dx, row + 2 * dy);
                if (step >= 0.0F) earliest = std::fmin(earliest, near + step);
            }
            times_s[static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(col)] =
                std::isnan(earliest) ? earliest : std::max(earliest, now_s);
        }
    }
}

}  // namespace

std::filesystem::path wrf_raster(const WrfSfire& wrf, const std::string& name, const std::string& unit, WrfGrid grid,
                                 std::span<const WrfBand> bands, WrfCombine combine) {
    initialise_gdal();
    const Extent e = extent(wrf, grid);
    std::string xml = dataset_head(wrf, e);
    for (std::size_t i = 0; i < bands.size(); ++i) xml += band_xml(bands[i], static_cast<int>(i) + 1, unit, e, combine);
    const auto file = memory_name("wrf", series_key(wrf), name, "vrt");
    write_memory_file(file, xml + "</VRTDataset>");
    return file;
}

std::filesystem::path wrf_arrival(const WrfSfire& wrf, double epoch_unix_s) {
    const WrfMoment& last = wrf.moments.back();
    const Extent e = extent(wrf, WrfGrid::Fire);
    const WrfBand band{&last, {"TIGN_G"}, 0.0};
    const auto raw = open_band(wrf_raster(wrf, "tign_g", "s", WrfGrid::Fire, {&band, 1}), 1, "s");
    auto values = read_window(raw, {0, 0, e.cols, e.rows});
    // Cells that the fire has not reached hold the present or any later time.
    const auto now_s = static_cast<float>(last.unix_s - wrf.simulation_start_unix_s);
    const auto shift_s = static_cast<float>(wrf.simulation_start_unix_s - epoch_unix_s);
    for (float& value : values) value = value < now_s ? value : std::numeric_limits<float>::quiet_NaN();
    extend_by_a_cell(values, e.cols, e.rows, now_s);
    for (float& value : values) {
        value += shift_s;
        if (value < 0.0F)
            throw input_error(
                last.file.string(),
                fmt::format("the fire has burned since {:g} s before the scenario's start; set start to the ignition",
                            -static_cast<double>(value)));
    }
    MemoryRaster arrival{e.cols, e.rows, north_up(wrf.west_m, wrf.north_m, e.cell_x_m, e.cell_y_m), wrf.crs_wkt, "s", {}};
    arrival.bands.push_back(std::move(values));
    return keep_in_memory("wrf", series_key(wrf), "arrival", arrival);
}

double wrf_integral(const WrfSfire& wrf, const WrfMoment& moment, const std::string& variable, WrfGrid grid) {
    const Extent e = extent(wrf, grid);
    const WrfBand band{&moment, {variable}, 0.0};
    const auto source = open_band(wrf_raster(wrf, "integral", "", grid, {&band, 1}), 1, "");
    double sum = 0.0;
    for (const float value : read_window(source, {0, 0, e.cols, e.rows}))
        if (std::isfinite(value)) sum += static_cast<double>(value);
    return sum * e.cell_x_m * e.cell_y_m;
}

}  // namespace pyroscene::gis
