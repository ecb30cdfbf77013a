#include "gis/vector_input.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include "base/error.h"
#include "gis/crs.h"
#include "gis/extent.h"
#include "gis/gdal_support.h"

namespace pyroscene::gis {
namespace {

DatasetPtr open_vector(const std::string& name) {
    initialise_gdal();
    const GdalErrors errors;
    DatasetPtr dataset(GDALDataset::Open(name.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
    if (dataset) return dataset;
    std::error_code ignored;
    if (!std::filesystem::exists(name, ignored)) throw input_error(name, "no such file");
    throw input_error(name, "is not a vector file that can be read: " + errors.message());
}

OGRLayer* find_layer(GDALDataset& dataset, const ShapesRequest& request) {
    std::string names;
    for (auto&& layer : dataset.GetLayers()) {
        if (request.layer == layer->GetName()) return layer;
        names += (names.empty() ? "" : ", ") + std::string(layer->GetName());
    }
    if (request.layer.empty() && dataset.GetLayerCount() == 1) return dataset.GetLayer(0);
    if (request.layer.empty()) throw input_error(request.file.string(), "holds several layers; name one of " + names);
    throw input_error(request.file.string(), fmt::format("has no layer '{}'; it has {}", request.layer, names));
}

std::string crs_of(const OGRLayer& layer, const ShapesRequest& request) {
    const auto* reference = const_cast<OGRLayer&>(layer).GetSpatialRef();
    if (reference == nullptr) {
        if (request.crs.empty())
            throw input_error(request.file.string(), "does not say its coordinate reference system; give 'crs'");
        return request.crs;
    }
    char* text = nullptr;
    const GdalErrors errors;
    const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
    const bool done = reference->exportToWkt(&text, options) == OGRERR_NONE;
    const std::string wkt = done ? text : "";
    CPLFree(text);
    if (!done) throw input_error(request.file.string(), "has a coordinate reference system that cannot be read");
    if (!request.crs.empty() && !same_crs(parse_crs(request.crs, "crs").wkt, wkt))
        throw input_error(request.file.string(), fmt::format("says its coordinate reference system is '{}', 'crs' says '{}'",
                                                             reference->GetName(), request.crs));
    return wkt;
}

Path path_of(const OGRSimpleCurve& curve) {
    Path path;
    for (const auto& point : curve) path.push_back({point.getX(), point.getY()});
    return path;
}

/// Adds a geometry, its parts and curves as straight pieces.
void add(Shapes& shapes, const OGRGeometry& geometry) {
    if (geometry.IsEmpty()) return;
    if (geometry.hasCurveGeometry()) {
        const std::unique_ptr<OGRGeometry> straight(geometry.getLinearGeometry());
        return add(shapes, *straight);
    }
    switch (wkbFlatten(geometry.getGeometryType())) {
        case wkbPoint:
            shapes.points.push_back({geometry.toPoint()->getX(), geometry.toPoint()->getY()});
            return;
        case wkbLineString:
            shapes.lines.push_back(path_of(*geometry.toLineString()));
            return;
        case wkbPolygon: {
            auto& rings = shapes.polygons.emplace_back();
            for (const auto* ring : geometry.toPolygon()) rings.push_back(path_of(*ring));
            return;
        }
        case wkbMultiPoint:
        case wkbMultiLineString:
        case wkbMultiPolygon:
        case wkbGeometryCollection:
            for (const auto* part : geometry.toGeometryCollection()) add(shapes, *part);
            return;
        default:
            return;  // surfaces of three-dimensional models are no places to burn
    }
}

void transform(Path& path, const CrsTransform& to_map) {
    std::vector<double> x, y;
    for (const auto& p : path) x.push_back(p[0]), y.push_back(p[1]);
    to_map.forward(x, y);
    for (std::size_t i = 0; i < path.size(); ++i) path[i] = {x[i], y[i]};
}

template <class Visit>
void for_each_path(Shapes& shapes, const Visit& visit) {
    visit(shapes.points);
    for (auto& line : shapes.lines) visit(line);
    for (auto& polygon : shapes.polygons)
        for (auto& ring : polygon) visit(ring);
}

void fill(OGRSimpleCurve& curve, const Path& path) {
    for (const auto& p : path) curve.addPoint(p[0], p[1]);
}

/// The shapes as one OGR geometry, which rasterising wants.
OGRGeometryCollection collection_of(const Shapes& shapes, bool areas_only) {
    OGRGeometryCollection all;
    for (const auto& polygon : shapes.polygons) {
        OGRPolygon area;
        for (const auto& path : polygon) {
            OGRLinearRing ring;
            fill(ring, path);
            ring.closeRings();
            area.addRing(&ring);
        }
        all.addGeometry(&area);
    }
    if (areas_only) return all;
    for (const auto& path : shapes.lines) {
        OGRLineString line;
        fill(line, path);
        all.addGeometry(&line);
    }
    for (const auto& p : shapes.points) {
        const OGRPoint point(p[0], p[1]);
        all.addGeometry(&point);
    }
    return all;
}

}  // namespace

Shapes read_shapes(const ShapesRequest& request, const MapGrid& grid) {
    const std::string name = request.file.string();
    const auto dataset = open_vector(name);
    OGRLayer* layer = find_layer(*dataset, request);
    Shapes shapes;
    for (const auto& feature : *layer)
        if (const auto* geometry = feature->GetGeometryRef(); geometry != nullptr) add(shapes, *geometry);
    if (shapes.empty()) throw input_error(name, fmt::format("layer '{}' holds no point, line or polygon", layer->GetName()));
    shapes_to_map(shapes, crs_of(*layer, request), grid, name);
    return shapes;
}

void shapes_to_map(Shapes& shapes, const std::string& crs, const MapGrid& grid, const std::string& subject) {
    const CrsTransform to_map(parse_crs(crs, subject).wkt, grid.crs_wkt);
    for_each_path(shapes, [&](Path& path) {
        const Path before = path;
        transform(path, to_map);
        for (std::size_t i = 0; i < path.size(); ++i)
            if (!std::isfinite(path[i][0]) || !std::isfinite(path[i][1]))
                throw input_error(subject,
                                  fmt::format("position {}, {} cannot be drawn on the map", before[i][0], before[i][1]));
    });
}

Raster<std::uint8_t> cells_of(const Shapes& shapes, const MapGrid& grid, bool touched) {
    Raster<std::uint8_t> mask(grid, "mask", "1");
    auto collection = collection_of(shapes, !touched);
    if (collection.IsEmpty()) return mask;
    auto dataset = create_memory_dataset(grid.cols, grid.rows);
    auto geotransform = geotransform_of(grid);
    dataset->SetGeoTransform(geotransform.data());
    const GdalErrors errors;
    int band = 1;
    double value = 1.0;
    OGRGeometryH geometry = OGRGeometry::ToHandle(&collection);
    char option[] = "ALL_TOUCHED=TRUE";
    char* options[] = {touched ? option : nullptr, nullptr};
    if (dataset->AddBand(GDT_Byte, nullptr) != CE_None ||
        GDALRasterizeGeometries(GDALDataset::ToHandle(dataset.get()), 1, &band, 1, &geometry, nullptr, nullptr, &value,
                                options, nullptr, nullptr) != CE_None ||
        dataset->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, grid.cols, grid.rows, mask.values.data(), grid.cols, grid.rows,
                                            GDT_Byte, 0, 0, nullptr) != CE_None)
        throw runtime_error("shapes", "cannot be drawn on the map: " + errors.message());
    return mask;
}

int close_lines(Shapes& shapes, double reach_m) {
    const auto apart = [](const Position& a, const Position& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); };
    auto left = std::move(shapes.lines);
    shapes.lines.clear();
    int areas = 0;
    while (!left.empty()) {
        Path path = std::move(left.front());
        left.erase(left.begin());
        // Goes on with the line whose end is nearest until it is back at its start.
        while (path.size() < 3 || apart(path.front(), path.back()) > reach_m) {
            std::size_t next = left.size();
            double nearest_m = reach_m;
            for (std::size_t i = 0; i < left.size(); ++i)
                if (const double d = std::min(apart(path.back(), left[i].front()), apart(path.back(), left[i].back()));
                    d <= nearest_m)
                    next = i, nearest_m = d;
            if (next == left.size()) break;
            Path piece = std::move(left[next]);
            left.erase(left.begin() + static_cast<std::ptrdiff_t>(next));
            if (apart(path.back(), piece.back()) < apart(path.back(), piece.front()))
                std::reverse(piece.begin(), piece.end());
            path.insert(path.end(), piece.begin(), piece.end());
        }
        if (path.size() >= 3 && apart(path.front(), path.back()) <= reach_m) {
            shapes.polygons.push_back({std::move(path)});
            ++areas;
        } else {
            shapes.lines.push_back(std::move(path));
        }
    }
    return areas;
}

}  // namespace pyroscene::gis
