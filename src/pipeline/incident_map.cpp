#include "pipeline/incident_map.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "analysis/fire_lines.h"
#include "base/csv.h"
#include "gis/vector_output.h"
#include "pipeline/fronts.h"

namespace pyroscene::pipeline {
namespace {

using fire::CellClass;
using gis::FieldValue;
using gis::VectorLayer;
using Type = gis::VectorField::Type;

constexpr double kSquareMetresPerHectare = 1e4, kSquareMetresPerAcre = 4046.8564224;
constexpr double kJoin_m = 60.0;  ///< hot cells nearer than this are one area
constexpr int kIsolatedCells = 2;
/// LIBKML insists on an icon for a coloured point.
constexpr const char* kPointStyle =
    "SYMBOL(id:\"http://maps.google.com/mapfiles/kml/shapes/placemark_circle.png\",c:#FFD000)";

/// A layer with the attributes that all have, and what is its own.
class MapLayer {
public:
    MapLayer(const IncidentMapTitle& title, const std::string& crs, const char* name, gis::GeometryKind kind,
             const char* style, std::vector<gis::VectorField> own_fields)
        : title_(title) {
        layer_.name = name;
        layer_.crs = crs;
        layer_.kind = kind;
        layer_.style = style;
        layer_.fields = {{"IncidentName", Type::Text}, {"FeatureCategory", Type::Text}, {"MapMethod", Type::Text},
                         {"DateCurrent", Type::Time},  {"Comments", Type::Text},        {"synthetic", Type::Integer}};
        layer_.fields.insert(layer_.fields.end(), own_fields.begin(), own_fields.end());
    }

    void add(const char* category, std::vector<std::vector<gis::Position>> parts, std::vector<FieldValue> own) {
        gis::VectorFeature feature{std::move(parts), {}};
        feature.values = {title_.incident,
                          std::string(category),
                          std::string("Modeled"),
                          title_.datetime,
                          fmt::format("SYNTHETIC, simulated by Pyroscene for {}: not a real fire", title_.acquisition),
                          std::int64_t{1}};
        feature.values.insert(feature.values.end(), own.begin(), own.end());
        layer_.features.push_back(std::move(feature));
    }
    [[nodiscard]] const VectorLayer& layer() const { return layer_; }

private:
    const IncidentMapTitle& title_;
    VectorLayer layer_;
};

std::vector<gis::VectorField> area_fields() { return {{"GISAcres", Type::Real}, {"area_ha", Type::Real}}; }
std::vector<FieldValue> area_values(double area_m2) {
    return {area_m2 / kSquareMetresPerAcre, area_m2 / kSquareMetresPerHectare};
}

bool is(const fire::FireState& state, std::size_t i, CellClass c) {
    return state.cell_class.values[i] == static_cast<std::uint8_t>(c);
}

VectorLayer perimeter(const IncidentMapTitle& title, const fire::FireState& state) {
    const MapGrid& grid = state.cell_class.grid;
    Raster<std::uint8_t> burned(grid, "perimeter", "1");
    for (std::size_t i = 0; i < grid.size(); ++i)
        burned.values[i] = is(state, i, CellClass::Front) || is(state, i, CellClass::Scar) ? 1 : 0;
    MapLayer out(title, grid.crs_wkt, "perimeter", gis::GeometryKind::Polygon, "PEN(c:#000000,w:2px);BRUSH(fc:#00000033)",
                 area_fields());
    for (auto& outline : gis::outlines(burned))
        out.add("Wildfire Daily Fire Perimeter", std::move(outline.rings), area_values(outline.area_m2));
    return out.layer();
}

double length_m(const std::vector<gis::Position>& line) {
    double sum = 0.0;
    for (std::size_t k = 1; k < line.size(); ++k)
        sum += std::hypot(line[k][0] - line[k - 1][0], line[k][1] - line[k - 1][1]);
    return sum;
}

/// One feature per connected front, the largest first.
VectorLayer front(const IncidentMapTitle& title, const fire::FireState& state, const std::filesystem::path& fronts_csv) {
    const MapGrid& grid = state.cell_class.grid;
    std::vector<std::uint8_t> burning(grid.size()), unburned(grid.size());
    for (std::size_t i = 0; i < grid.size(); ++i) {
        burning[i] = is(state, i, CellClass::Front) ? 1 : 0;
        unburned[i] = is(state, i, CellClass::Unburned) ? 1 : 0;
    }
    const auto labels = find_fronts(state, Raster<float>(grid, "heat flux", "W m-2")).label;
    std::map<int, std::vector<std::vector<gis::Position>>> parts;
    for (const auto& line : analysis::fire_lines(burning, unburned, grid.cols, grid.rows)) {
        std::vector<gis::Position> on_map;
        for (const auto& p : line.points)
            on_map.push_back({grid.west_m + p[0] * grid.cell_m, grid.north_m - p[1] * grid.cell_m});
        parts[labels.values[line.cell]].push_back(std::move(on_map));
    }
    std::optional<CsvTable> table;
    if (std::filesystem::exists(fronts_csv)) table = read_csv(fronts_csv);
    MapLayer out(
        title, grid.crs_wkt, "front", gis::GeometryKind::Line, "PEN(c:#E31A1C,w:4px)",
        {{"front", Type::Integer}, {"length_m", Type::Real}, {"mean_depth_m", Type::Real}, {"intensity_kW_m", Type::Real}});
    for (auto& [number, lines] : parts) {
        const int label = number;
        double total_m = 0.0;
        for (const auto& line : lines) total_m += length_m(line);
        const auto of_front = [&](const char* column) -> FieldValue {
            const auto row = static_cast<std::size_t>(label - 1);
            if (!table || row >= table->rows.size()) return {};
            return table->numbers(column)[row];
        };
        out.add("Fire Edge", std::move(lines),
                {std::int64_t{label}, total_m, of_front("mean_depth_m"), of_front("intensity_kW_m")});
    }
    return out.layer();
}

/// Areas of intense and scattered heat, and points of isolated heat.
std::vector<VectorLayer> heat(const IncidentMapTitle& title, const fire::FireState& state) {
    const MapGrid& grid = state.cell_class.grid;
    std::vector<analysis::Heat> cells(grid.size(), analysis::Heat::None);
    for (std::size_t i = 0; i < grid.size(); ++i) {
        if (is(state, i, CellClass::Front))
            cells[i] = analysis::Heat::Flaming;
        else if (is(state, i, CellClass::Scar) && static_cast<double>(state.surface_temperature_K[i]) >= title.hot_K)
            cells[i] = analysis::Heat::Hot;
    }
    const int join_cells = std::max(1, static_cast<int>(std::lround(kJoin_m / grid.cell_m)));
    const auto classes = analysis::heat_classes(cells, grid.cols, grid.rows, join_cells, kIsolatedCells);
    Raster<std::uint8_t> areas(grid, "heat", "1");
    MapLayer points(title, grid.crs_wkt, "isolated_heat", gis::GeometryKind::Point, kPointStyle, {{"ground_K", Type::Real}});
    for (std::size_t i = 0; i < grid.size(); ++i) {
        if (classes[i] != analysis::HeatClass::Isolated) {
            areas.values[i] = static_cast<std::uint8_t>(classes[i]);
            continue;
        }
        const auto row = static_cast<int>(i / static_cast<std::size_t>(grid.cols)),
                   col = static_cast<int>(i % static_cast<std::size_t>(grid.cols));
        points.add("Isolated Heat", {{{grid.x_centre_m(col), grid.y_centre_m(row)}}},
                   {static_cast<double>(state.surface_temperature_K[i])});
    }
    MapLayer polygons(title, grid.crs_wkt, "heat", gis::GeometryKind::Polygon, "PEN(c:#FF7F00,w:1px);BRUSH(fc:#FF7F0099)",
                      area_fields());
    for (auto& outline : gis::outlines(areas))
        polygons.add(outline.value == static_cast<int>(analysis::HeatClass::Intense) ? "Intense Heat" : "Scattered Heat",
                     std::move(outline.rings), area_values(outline.area_m2));
    return {polygons.layer(), points.layer()};
}

}  // namespace

void write_incident_map(const std::filesystem::path& folder, const std::string& suffix, const IncidentMapTitle& title,
                        const fire::FireState& state, const std::filesystem::path& fronts_csv) {
    std::vector<VectorLayer> layers{perimeter(title, state), front(title, state, fronts_csv)};
    for (auto& layer : heat(title, state)) layers.push_back(std::move(layer));
    for (const auto& layer : layers) gis::write_vector(folder / (layer.name + suffix + ".geojson"), {&layer, 1});
    gis::write_vector(folder / ("incident_map" + suffix + ".gpkg"), layers);
    gis::write_vector(folder / ("incident_map" + suffix + ".kmz"), layers);
}

}  // namespace pyroscene::pipeline
