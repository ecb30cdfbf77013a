#include "gis/vector_output.h"

#include <memory>

#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include "base/error.h"
#include "base/files.h"

namespace pyroscene::gis {
namespace {

struct CloseDataset {
    void operator()(GDALDataset* d) const { GDALClose(d); }
};
using DatasetPtr = std::unique_ptr<GDALDataset, CloseDataset>;

DatasetPtr mask_dataset(const Raster<std::uint8_t>& mask) {
    auto* driver = GetGDALDriverManager()->GetDriverByName("MEM");
    DatasetPtr dataset(driver->Create("", mask.grid.cols, mask.grid.rows, 1, GDT_Byte, nullptr));
    double transform[6] = {mask.grid.west_m, mask.grid.cell_m, 0.0, mask.grid.north_m, 0.0, -mask.grid.cell_m};
    dataset->SetGeoTransform(transform);
    auto copy = mask.values;
    const auto status = dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, mask.grid.cols, mask.grid.rows, copy.data(),
                                                            mask.grid.cols, mask.grid.rows, GDT_Byte, 0, 0, nullptr);
    if (status != CE_None) throw runtime_error("perimeter", CPLGetLastErrorMsg());
    return dataset;
}

}  // namespace

void write_polygons(const std::filesystem::path& path, const Raster<std::uint8_t>& mask,
                    const std::map<std::string, std::string>& properties) {
    GDALAllRegister();
    const auto raster = mask_dataset(mask);
    OGRSpatialReference map, geographic;
    map.SetFromUserInput(mask.grid.crs_wkt.c_str());
    geographic.SetWellKnownGeogCS("WGS84");
    map.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    geographic.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);

    DatasetPtr memory(GetGDALDriverManager()->GetDriverByName("Memory")->Create("", 0, 0, 0, GDT_Unknown, nullptr));
    OGRLayer* cells = memory->CreateLayer("cells", &map, wkbPolygon, nullptr);
    OGRFieldDefn value("value", OFTInteger);
    cells->CreateField(&value);
    // The band is its own mask: only cells with 1 become polygons.
    GDALRasterBand* band = raster->GetRasterBand(1);
    if (GDALPolygonize(band, band, cells, 0, nullptr, nullptr, nullptr) != CE_None)
        throw runtime_error(path.string(), CPLGetLastErrorMsg());

    AtomicFile file(path);
    auto* driver = GetGDALDriverManager()->GetDriverByName("GeoJSON");
    DatasetPtr out(driver->Create(file.path().c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    if (!out) throw runtime_error(path.string(), CPLGetLastErrorMsg());
    const char* options[] = {"RFC7946=YES", nullptr};
    OGRLayer* layer = out->CreateLayer("perimeter", &geographic, wkbPolygon, const_cast<char**>(options));
    for (const auto& [name, text] : properties) {
        OGRFieldDefn field(name.c_str(), OFTString);
        layer->CreateField(&field);
    }
    OGRFieldDefn area("area_ha", OFTReal);
    layer->CreateField(&area);
    const std::unique_ptr<OGRCoordinateTransformation> to_geographic(OGRCreateCoordinateTransformation(&map, &geographic));
    constexpr double kSquareMetresPerHectare = 1e4;
    for (const auto& cell : *cells) {
        const std::unique_ptr<OGRGeometry> polygon(cell->GetGeometryRef()->clone());
        OGRFeature feature(layer->GetLayerDefn());
        for (const auto& [name, text] : properties) feature.SetField(name.c_str(), text.c_str());
        feature.SetField("area_ha", polygon->toPolygon()->get_Area() / kSquareMetresPerHectare);
        polygon->transform(to_geographic.get());
        feature.SetGeometry(polygon.get());
        if (layer->CreateFeature(&feature) != OGRERR_NONE) throw runtime_error(path.string(), CPLGetLastErrorMsg());
    }
    out.reset();
    file.commit();
}

}  // namespace pyroscene::gis
