#include "gis/vector_output.h"

#include <memory>

#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include "base/error.h"
#include "base/files.h"
#include "gis/crs.h"
#include "gis/extent.h"
#include "gis/gdal_support.h"

namespace pyroscene::gis {
namespace {

OGRSpatialReference spatial_reference(const std::string& crs) {
    OGRSpatialReference reference;
    reference.SetFromUserInput(crs.c_str());
    reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return reference;
}

DatasetPtr mask_dataset(const Raster<std::uint8_t>& mask) {
    const MapGrid& grid = mask.grid;
    DatasetPtr dataset = create_memory_dataset(grid.cols, grid.rows);
    auto geotransform = geotransform_of(grid);
    auto copy = mask.values;
    dataset->SetGeoTransform(geotransform.data());
    if (dataset->AddBand(GDT_Byte, nullptr) != CE_None ||
        dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, grid.cols, grid.rows, copy.data(), grid.cols, grid.rows,
                                            GDT_Byte, 0, 0, nullptr) != CE_None)
        throw runtime_error("perimeter", "cannot be set up in memory");
    return dataset;
}

DatasetPtr create_vector(const char* driver_name, const std::string& name, const std::string& subject,
                         const GdalErrors& errors) {
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(driver_name);
    DatasetPtr dataset(driver == nullptr ? nullptr : driver->Create(name.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    if (!dataset) throw runtime_error(subject, "cannot be written: " + errors.message());
    return dataset;
}

/// Outlines in map coordinates. The band is its own mask: only cells with 1 become polygons.
void outline(GDALDataset& raster, OGRLayer* cells, const std::string& subject, const GdalErrors& errors) {
    OGRFieldDefn value("value", OFTInteger);
    cells->CreateField(&value);
    GDALRasterBand* band = raster.GetRasterBand(1);
    if (GDALPolygonize(band, band, cells, 0, nullptr, nullptr, nullptr) != CE_None)
        throw runtime_error(subject, "outlines cannot be found: " + errors.message());
}

void add_fields(OGRLayer* layer, const std::map<std::string, std::string>& properties) {
    for (const auto& [name, text] : properties) {
        OGRFieldDefn field(name.c_str(), OFTString);
        layer->CreateField(&field);
    }
    OGRFieldDefn area("area_ha", OFTReal);
    layer->CreateField(&area);
}

}  // namespace

void write_polygons(const std::filesystem::path& path, const Raster<std::uint8_t>& mask,
                    const std::map<std::string, std::string>& properties) {
    initialise_gdal();
    const std::string subject = path.string();
    const GdalErrors errors;
    const DatasetPtr raster = mask_dataset(mask), memory = create_vector("Memory", "", subject, errors);
    const OGRSpatialReference map = spatial_reference(mask.grid.crs_wkt), geographic = spatial_reference(kGeographicCrs);
    OGRLayer* cells = memory->CreateLayer("cells", const_cast<OGRSpatialReference*>(&map), wkbPolygon, nullptr);
    outline(*raster, cells, subject, errors);

    AtomicFile file(path);
    DatasetPtr out = create_vector("GeoJSON", file.path().string(), subject, errors);
    const char* const options[] = {"RFC7946=YES", nullptr};
    OGRLayer* layer = out->CreateLayer("perimeter", const_cast<OGRSpatialReference*>(&geographic), wkbPolygon,
                                       const_cast<char**>(options));
    if (layer == nullptr) throw runtime_error(subject, "cannot be written: " + errors.message());
    add_fields(layer, properties);
    const std::unique_ptr<OGRCoordinateTransformation> to_geographic(OGRCreateCoordinateTransformation(&map, &geographic));
    constexpr double kSquareMetresPerHectare = 1e4;
    for (const auto& cell : *cells) {
        const std::unique_ptr<OGRGeometry> polygon(cell->GetGeometryRef()->clone());
        OGRFeature feature(layer->GetLayerDefn());
        for (const auto& [name, text] : properties) feature.SetField(name.c_str(), text.c_str());
        feature.SetField("area_ha", polygon->toPolygon()->get_Area() / kSquareMetresPerHectare);
        polygon->transform(to_geographic.get());
        feature.SetGeometry(polygon.get());
        if (layer->CreateFeature(&feature) != OGRERR_NONE)
            throw runtime_error(subject, "cannot be written: " + errors.message());
    }
    out.reset();
    if (errors.failed()) throw runtime_error(subject, "cannot be written: " + errors.message());
    file.commit();
}

}  // namespace pyroscene::gis
