#include "gis/vector_output.h"

#include <memory>
#include <optional>

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

DatasetPtr create_vector(const char* driver_name, const std::string& name, const std::string& subject,
                         const GdalErrors& errors) {
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(driver_name);
    DatasetPtr dataset(driver == nullptr ? nullptr : driver->Create(name.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    if (!dataset) throw runtime_error(subject, "cannot be written: " + errors.message());
    return dataset;
}

/// What the formats differ in.
struct Format {
    const char* extension;
    const char* driver;
    bool geographic;      ///< coordinates are turned into WGS 84
    const char* options;  ///< of a layer
    bool styled, times;
};
constexpr std::array<Format, 3> kFormats{{{".gpkg", "GPKG", false, "SPATIAL_INDEX=YES", false, true},
                                          {".geojson", "GeoJSON", true, "RFC7946=YES", false, false},
                                          {".kmz", "LIBKML", true, "ADD_REGION=NO", true, true}}};

const Format& format_of(const std::filesystem::path& path) {
    for (const Format& f : kFormats)
        if (path.extension() == f.extension) return f;
    throw runtime_error(path.string(), "no vector format has this extension; there are .gpkg, .geojson, .kmz");
}

OGRwkbGeometryType geometry_type(GeometryKind kind) {
    return kind == GeometryKind::Point ? wkbPoint : kind == GeometryKind::Line ? wkbMultiLineString : wkbPolygon;
}

std::unique_ptr<OGRGeometry> geometry_of(const VectorFeature& feature, GeometryKind kind) {
    if (kind == GeometryKind::Point) {
        const Position p = feature.parts.at(0).at(0);
        return std::make_unique<OGRPoint>(p[0], p[1]);
    }
    const auto fill = [](OGRLineString& line, const std::vector<Position>& part) {
        for (const Position& p : part) line.addPoint(p[0], p[1]);
    };
    if (kind == GeometryKind::Line) {
        auto lines = std::make_unique<OGRMultiLineString>();
        for (const auto& part : feature.parts) {
            OGRLineString line;
            fill(line, part);
            lines->addGeometry(&line);
        }
        return lines;
    }
    auto polygon = std::make_unique<OGRPolygon>();
    for (const auto& part : feature.parts) {
        OGRLinearRing ring;
        fill(ring, part);
        ring.closeRings();
        polygon->addRing(&ring);
    }
    return polygon;
}

void set_value(OGRFeature& feature, int field, const FieldValue& value) {
    if (const auto* text = std::get_if<std::string>(&value)) feature.SetField(field, text->c_str());
    if (const auto* number = std::get_if<double>(&value)) feature.SetField(field, *number);
    if (const auto* count = std::get_if<std::int64_t>(&value)) feature.SetField(field, static_cast<GIntBig>(*count));
}

/// GeoJSON knows no times: text, as it was given.
OGRFieldType field_type(VectorField::Type type, const Format& format) {
    switch (type) {
        case VectorField::Type::Real:
            return OFTReal;
        case VectorField::Type::Integer:
            return OFTInteger64;
        case VectorField::Type::Time:
            return format.times ? OFTDateTime : OFTString;
        case VectorField::Type::Text:
            break;
    }
    return OFTString;
}

/// Name of the first field of type Time; empty = none.
std::string time_field(std::span<const VectorLayer> layers) {
    for (const auto& layer : layers)
        for (const auto& field : layer.fields)
            if (field.type == VectorField::Type::Time) return field.name;
    return {};
}

void write_layer(GDALDataset& out, const VectorLayer& layer, const Format& format, const std::string& subject,
                 const GdalErrors& errors) {
    const auto fail = [&] { throw runtime_error(subject, "cannot be written: " + errors.message()); };
    OGRSpatialReference own = spatial_reference(layer.crs),
                        target = format.geographic ? spatial_reference(kGeographicCrs) : own;
    const char* const options[] = {format.options, nullptr};
    OGRLayer* to = out.CreateLayer(layer.name.c_str(), &target, geometry_type(layer.kind), const_cast<char**>(options));
    if (to == nullptr) fail();
    for (const auto& field : layer.fields) {
        OGRFieldDefn definition(field.name.c_str(), field_type(field.type, format));
        to->CreateField(&definition);
    }
    const std::unique_ptr<OGRCoordinateTransformation> turn(
        format.geographic && !own.IsSame(&target) ? OGRCreateCoordinateTransformation(&own, &target) : nullptr);
    if (to->StartTransaction() != OGRERR_NONE) fail();
    for (const auto& feature : layer.features) {
        OGRFeature row(to->GetLayerDefn());
        for (std::size_t f = 0; f < layer.fields.size(); ++f)
            set_value(row, row.GetFieldIndex(layer.fields[f].name.c_str()), feature.values[f]);
        auto geometry = geometry_of(feature, layer.kind);
        if (turn) geometry->transform(turn.get());
        row.SetGeometry(geometry.get());
        if (format.styled && !layer.style.empty()) row.SetStyleString(layer.style.c_str());
        if (to->CreateFeature(&row) != OGRERR_NONE) fail();
    }
    if (to->CommitTransaction() != OGRERR_NONE) fail();
}

DatasetPtr class_dataset(const Raster<std::uint8_t>& classes) {
    const MapGrid& grid = classes.grid;
    DatasetPtr dataset = create_memory_dataset(grid.cols, grid.rows);
    auto geotransform = geotransform_of(grid);
    auto copy = classes.values;
    dataset->SetGeoTransform(geotransform.data());
    if (dataset->AddBand(GDT_Byte, nullptr) != CE_None ||
        dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, grid.cols, grid.rows, copy.data(), grid.cols, grid.rows,
                                            GDT_Byte, 0, 0, nullptr) != CE_None)
        throw runtime_error(classes.name, "cannot be set up in memory");
    return dataset;
}

std::vector<Position> positions_of(const OGRLinearRing& ring) {
    std::vector<Position> out;
    out.reserve(static_cast<std::size_t>(ring.getNumPoints()));
    for (int i = 0; i < ring.getNumPoints(); ++i) out.push_back({ring.getX(i), ring.getY(i)});
    return out;
}

}  // namespace

void write_vector(const std::filesystem::path& path, std::span<const VectorLayer> layers) {
    initialise_gdal();
    const Format& format = format_of(path);
    const std::string subject = path.string();
    const GdalErrors errors;
    // SQLite syncs after every statement unless told otherwise, and the file gets its name only when it is whole.
    const ThreadOption unsynced("OGR_SQLITE_SYNCHRONOUS", "OFF");
    const ThreadOption moment("LIBKML_TIMESTAMP_FIELD", time_field(layers).c_str());
    AtomicFile file(path);
    DatasetPtr out = create_vector(format.driver, file.path().string(), subject, errors);
    for (const auto& layer : layers) write_layer(*out, layer, format, subject, errors);
    out.reset();
    if (errors.failed()) throw runtime_error(subject, "cannot be written: " + errors.message());
    file.commit();
}

std::vector<Outline> outlines(const Raster<std::uint8_t>& classes) {
    initialise_gdal();
    const GdalErrors errors;
    const DatasetPtr raster = class_dataset(classes), memory = create_vector("Memory", "", classes.name, errors);
    OGRLayer* cells = memory->CreateLayer("cells", nullptr, wkbPolygon, nullptr);
    OGRFieldDefn value("value", OFTInteger);
    cells->CreateField(&value);
    // The band is its own mask: cells with 0 become no polygon.
    GDALRasterBand* band = raster->GetRasterBand(1);
    if (GDALPolygonize(band, band, cells, 0, nullptr, nullptr, nullptr) != CE_None)
        throw runtime_error(classes.name, "outlines cannot be found: " + errors.message());
    std::vector<Outline> out;
    for (const auto& cell : *cells) {
        const OGRPolygon& polygon = *cell->GetGeometryRef()->toPolygon();
        Outline outline{cell->GetFieldAsInteger(0), {positions_of(*polygon.getExteriorRing())}, polygon.get_Area()};
        for (int h = 0; h < polygon.getNumInteriorRings(); ++h)
            outline.rings.push_back(positions_of(*polygon.getInteriorRing(h)));
        out.push_back(std::move(outline));
    }
    return out;
}

}  // namespace pyroscene::gis
