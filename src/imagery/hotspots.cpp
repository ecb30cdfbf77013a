#include "imagery/hotspots.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/files.h"
#include "imagery/image_channels.h"

namespace pyroscene::imagery {
namespace {

/// One column: its name, its type, and its text with the digits that FIRMS gives.
struct Column {
    const char* name;
    gis::VectorField::Type type;
    std::string (*text)(const HotspotTable&, const Hotspot&);
};

std::string number(double value, int decimals) {
    return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : std::string();
}

using Type = gis::VectorField::Type;

constexpr std::array<Column, 14> kColumns{{
    {"latitude", Type::Real, [](const HotspotTable&, const Hotspot& h) { return number(h.latitude_deg, 5); }},
    {"longitude", Type::Real, [](const HotspotTable&, const Hotspot& h) { return number(h.longitude_deg, 5); }},
    {"brightness", Type::Real, [](const HotspotTable&, const Hotspot& h) { return number(h.mir_K, 2); }},
    {"scan", Type::Real, [](const HotspotTable&, const Hotspot& h) { return fmt::format("{:.4g}", h.scan_km); }},
    {"track", Type::Real, [](const HotspotTable&, const Hotspot& h) { return fmt::format("{:.4g}", h.track_km); }},
    {"acq_date", Type::Text, [](const HotspotTable& t, const Hotspot&) { return t.date; }},
    {"acq_time", Type::Text, [](const HotspotTable& t, const Hotspot&) { return t.clock; }},
    {"satellite", Type::Text, [](const HotspotTable& t, const Hotspot&) { return t.satellite; }},
    {"instrument", Type::Text, [](const HotspotTable& t, const Hotspot&) { return t.instrument; }},
    {"confidence", Type::Text, [](const HotspotTable&, const Hotspot& h) { return h.confidence; }},
    {"version", Type::Text, [](const HotspotTable& t, const Hotspot&) { return t.version; }},
    {"bright_t31", Type::Real, [](const HotspotTable&, const Hotspot& h) { return number(h.tir_K, 2); }},
    {"frp", Type::Real,
     [](const HotspotTable&, const Hotspot& h) {
         return std::isfinite(h.frp_MW) ? fmt::format("{:.6g}", h.frp_MW) : std::string();
     }},
    {"daynight", Type::Text,
     [](const HotspotTable&, const Hotspot& h) {
         return h.day_or_night == ' ' ? std::string() : std::string(1, h.day_or_night);
     }},
}};

std::string name_of(const Column& column, const HotspotTable& table) {
    const std::string name = column.name;
    if (table.viirs_names && name == "brightness") return "bright_ti4";
    if (table.viirs_names && name == "bright_t31") return "bright_ti5";
    return name;
}

}  // namespace

HotspotTable hotspots_of(const gis::ImageInfo& info) {
    const auto when = date_and_clock(metadata_item(info, "ACQUISITION_DATE"));
    HotspotTable table;
    table.date = when.date;
    table.clock = when.clock;
    table.satellite = table.instrument = metadata_item(info, "SENSOR");
    table.synthetic = info.metadata.contains("synthetic");
    table.version = table.synthetic ? "synthetic" : "";
    return table;
}

void write_hotspots_csv(const std::filesystem::path& path, const HotspotTable& table) {
    std::string text;
    for (const Column& column : kColumns) text += name_of(column, table) + (&column == &kColumns.back() ? "\n" : ",");
    for (const Hotspot& row : table.rows)
        for (const Column& column : kColumns) text += column.text(table, row) + (&column == &kColumns.back() ? "\n" : ",");
    write_text_file(path, text);
}

gis::VectorLayer hotspot_layer(const HotspotTable& table) {
    gis::VectorLayer layer;
    layer.name = "hot_spots";
    for (const Column& column : kColumns) layer.fields.push_back({name_of(column, table), column.type});
    layer.fields.push_back({"synthetic", Type::Integer});
    for (const Hotspot& row : table.rows) {
        gis::VectorFeature feature{{{{row.longitude_deg, row.latitude_deg}}}, {}};
        for (const Column& column : kColumns) {
            const std::string text = column.text(table, row);
            if (text.empty())
                feature.values.emplace_back();
            else if (column.type == Type::Real)
                feature.values.emplace_back(std::stod(text));
            else
                feature.values.emplace_back(text);
        }
        feature.values.emplace_back(static_cast<std::int64_t>(table.synthetic ? 1 : 0));
        layer.features.push_back(std::move(feature));
    }
    return layer;
}

}  // namespace pyroscene::imagery
