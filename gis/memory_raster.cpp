#include "gis/memory_raster.h"

#include <cmath>
#include <functional>

#include <fmt/format.h>
#include <gdal_priv.h>

#include "base/error.h"
#include "gis/crs.h"
#include "gis/gdal_support.h"

namespace pyroscene::gis {

std::string memory_name(const std::string& folder, const std::string& key, const std::string& name, const char* ending) {
    return fmt::format("/vsimem/{}_{:016x}/{}.{}", folder, std::hash<std::string>{}(key), name, ending);
}

std::filesystem::path keep_in_memory(const std::string& folder, const std::string& key, const std::string& name,
                                     const MemoryRaster& raster) {
    initialise_gdal();
    const auto file = memory_name(folder, key, name, "tif");
    const GdalErrors errors;
    auto* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    const DatasetPtr dataset(
        driver->Create(file.c_str(), raster.cols, raster.rows, static_cast<int>(raster.bands.size()), GDT_Float32, nullptr));
    if (!dataset) throw runtime_error(file, "cannot be kept in memory: " + errors.message());
    auto transform = raster.geotransform;
    dataset->SetGeoTransform(transform.data());
    dataset->SetProjection(raster.crs_wkt.c_str());
    for (std::size_t i = 0; i < raster.bands.size(); ++i) {
        auto* band = dataset->GetRasterBand(static_cast<int>(i) + 1);
        band->SetUnitType(raster.unit.c_str());
        band->SetNoDataValue(std::nan(""));
        auto* pixels = const_cast<float*>(raster.bands[i].data());  // GDAL writes from it only
        if (band->RasterIO(GF_Write, 0, 0, raster.cols, raster.rows, pixels, raster.cols, raster.rows, GDT_Float32, 0, 0,
                           nullptr) != CE_None)
            throw runtime_error(file, "cannot be kept in memory: " + errors.message());
    }
    return file;
}

std::array<double, 6> north_up(double west_m, double north_m, double cell_x_m, double cell_y_m) noexcept {
    return {west_m, cell_x_m, 0.0, north_m, 0.0, -cell_y_m};
}

std::filesystem::path with_crs(const std::filesystem::path& file, const std::string& crs, const std::string& key) {
    if (crs.empty()) return file;
    const auto source = open_raster(file);
    const CrsInfo given = parse_crs(crs, key);
    const char* found = source->GetProjectionRef();
    if (found != nullptr && *found != '\0') {
        const CrsInfo own = parse_crs(found, file.string());
        if (!same_crs(own.wkt, given.wkt))
            throw input_error(file.string(), fmt::format("says '{}', but {} '{}'", own.name, key, crs));
        return file;
    }
    const auto name = memory_name("crs", file.string() + "|" + crs, file.stem().string(), "vrt");
    const GdalErrors errors;
    auto* driver = GetGDALDriverManager()->GetDriverByName("VRT");
    const DatasetPtr copy(driver->CreateCopy(name.c_str(), source.get(), FALSE, nullptr, nullptr, nullptr));
    if (!copy) throw runtime_error(file.string(), "cannot be wrapped in memory: " + errors.message());
    copy->SetProjection(given.wkt.c_str());
    return name;
}

}  // namespace pyroscene::gis
