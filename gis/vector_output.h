#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/raster.h"

namespace pyroscene::gis {

/// Points, open lines, or rings: the first ring of a polygon is its outline, others are holes.
enum class GeometryKind { Point, Line, Polygon };

using Position = std::array<double, 2>;  ///< x, y in the CRS of the layer; longitude, latitude for a geographic one

/// A value of an attribute; monostate = not set.
using FieldValue = std::variant<std::monostate, double, std::int64_t, std::string>;

struct VectorField {
    std::string name;
    enum class Type { Real, Integer, Text, Time } type = Type::Text;  ///< values of a Time are ISO 8601 text
};

struct VectorFeature {
    std::vector<std::vector<Position>>
        parts;                       ///< a point has one part of one position, a line one or several, a polygon its rings
    std::vector<FieldValue> values;  ///< one per field of the layer
};

/// Features of one kind with the same attributes.
struct VectorLayer {
    std::string name, crs = "EPSG:4326";
    GeometryKind kind = GeometryKind::Point;
    std::vector<VectorField> fields;
    std::vector<VectorFeature> features;
    std::string style;  ///< OGR feature style, "PEN(c:#FF0000,w:3px)": for KML
};

/// Writes layers by the file's extension: .gpkg (every layer in its own CRS), .geojson (RFC 7946: WGS 84; one layer), .kmz
/// (WGS 84; a folder per layer, coloured by `style`, with the first field of type Time as the moment of a feature). Written atomically. Throws a runtime error naming the file.
void write_vector(const std::filesystem::path& path, std::span<const VectorLayer> layers);

/// Outlines of the connected cells that have one value (edges of cells, holes kept), per value other than 0.
struct Outline {
    int value = 0;
    std::vector<std::vector<Position>> rings;  ///< map coordinates
    double area_m2 = 0.0;
};
std::vector<Outline> outlines(const Raster<std::uint8_t>& classes);

}  // namespace pyroscene::gis
