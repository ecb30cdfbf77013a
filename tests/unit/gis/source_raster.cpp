#include "unit/gis/source_raster.h"

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include "base/error.h"

namespace pyroscene::gis {

SourceRaster& SourceRaster::band(const std::function<double(int, int)>& value, const std::string& unit) {
    std::vector<double> pixels;
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col) pixels.push_back(value(col, row));
    bands.push_back(std::move(pixels));
    units.push_back(unit);
    return *this;
}

SourceRaster& SourceRaster::band_at(const std::function<double(double, double)>& value, const std::string& unit) {
    const auto& gt = geotransform;
    return band(
        [&](int col, int row) {
            return value(gt[0] + (col + 0.5) * gt[1] + (row + 0.5) * gt[2],
                         gt[3] + (col + 0.5) * gt[4] + (row + 0.5) * gt[5]);
        },
        unit);
}

void SourceRaster::write(const std::filesystem::path& path) const {
    GDALAllRegister();
    CPLSetConfigOption("GDAL_TIFF_INTERNAL_MASK", "YES");
    auto* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    auto* ds = driver->Create(path.c_str(), cols, rows, static_cast<int>(bands.size()), GDALGetDataTypeByName(type.c_str()),
                              nullptr);
    ASSERT_NE(ds, nullptr);
    auto gt = geotransform;
    if (georeferenced) ds->SetGeoTransform(gt.data());
    if (!crs.empty()) {
        OGRSpatialReference srs;
        ASSERT_EQ(srs.SetFromUserInput(crs.c_str()), OGRERR_NONE);
        ds->SetSpatialRef(&srs);
    }
    for (std::size_t b = 0; b < bands.size(); ++b) {
        auto* band = ds->GetRasterBand(static_cast<int>(b) + 1);
        if (b < units.size() && !units[b].empty()) band->SetUnitType(units[b].c_str());
        if (nodata) band->SetNoDataValue(*nodata);
        if (scale) band->SetScale(*scale);
        if (offset) band->SetOffset(*offset);
        auto pixels = bands[b];
        ASSERT_EQ(band->RasterIO(GF_Write, 0, 0, cols, rows, pixels.data(), cols, rows, GDT_Float64, 0, 0, nullptr),
                  CE_None);
    }
    if (mask) {
        ds->CreateMaskBand(GMF_PER_DATASET);
        auto flags = *mask;
        ASSERT_EQ(ds->GetRasterBand(1)->GetMaskBand()->RasterIO(GF_Write, 0, 0, cols, rows, flags.data(), cols, rows,
                                                                GDT_Byte, 0, 0, nullptr),
                  CE_None);
    }
    GDALClose(ds);
}

std::string wkt_of(int epsg) {
    OGRSpatialReference srs;
    EXPECT_EQ(srs.importFromEPSG(epsg), OGRERR_NONE);
    char* text = nullptr;
    const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
    EXPECT_EQ(srs.exportToWkt(&text, options), OGRERR_NONE);
    std::string wkt(text);
    CPLFree(text);
    return wkt;
}

MapGrid grid_of(const SourceRaster& source) {
    return {.cols = source.cols,
            .rows = source.rows,
            .west_m = source.geotransform[0],
            .north_m = source.geotransform[3],
            .cell_m = source.geotransform[1],
            .crs_wkt = wkt_of(std::stoi(source.crs.substr(5)))};
}

std::string input_error_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Input) << e.what();
        return e.what();
    }
    ADD_FAILURE() << "no error";
    return {};
}

}  // namespace pyroscene::gis
