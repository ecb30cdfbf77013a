#include <array>

#include <fmt/format.h>

#include "scenario/readers.h"

namespace fs = std::filesystem;

namespace pyroscene::scenario {
namespace {

constexpr std::array kModelKeys{"crs", "west_m", "south_m", "cols", "rows", "cell_m", "quantity", "offset_s"};

FluxModelSource read_place(const config::Node& node) {
    using config::Range;
    constexpr Range kPlace = Range::between(-1e8, 1e8), kCells = Range::between(1, 100000);
    FluxModelSource source;
    source.crs = node.text("crs", "");
    source.west_m = node.number("west_m", 0.0, kPlace);
    source.south_m = node.number("south_m", 0.0, kPlace);
    source.cols = static_cast<int>(node.integer("cols", 1, kCells));
    source.rows = static_cast<int>(node.integer("rows", 1, kCells));
    source.cell_m = node.number("cell_m", source.cell_m, Range::between(0.1, 10000.0));
    source.quantity = node.text("quantity", "");
    source.offset_s = node.number("offset_s", 0.0, kPlace);
    return source;
}

/// Keys that a program's files need, and those that they do not.
void check_keys(const config::Node& node, const FluxModelSource& source) {
    const bool quic = source.model == "quic-fire";
    const auto takes = [&](const char* key, bool needed, bool allowed) {
        if (needed && !node.has(key))
            node.report(fmt::format("key '{}' is missing: files of '{}' do not say it", key, source.model));
        if (!allowed && node.has(key)) node.child(key).report(fmt::format("does not belong to model '{}'", source.model));
        node.ignore(key);
    };
    for (const char* key : {"crs", "west_m", "south_m"}) takes(key, true, true);
    for (const char* key : {"cols", "rows", "cell_m"}) takes(key, quic, quic);
    takes("quantity", false, !quic);
    takes("files", quic, quic);
    takes("file", !quic, !quic);
    for (const char* key : {"band", "bands", "times_s"}) takes(key, false, false);
}

}  // namespace

void read_heat_flux(const config::Node& node, const fs::path& folder, Inputs& inputs) {
    if (!node.is_map()) return node.finish();
    FluxModelSource source = read_place(node);
    source.model = node.choice("model", "", {"quic-fire", "fds"});
    if (!node.has("model")) {
        for (const char* key : kModelKeys)
            if (node.has(key)) node.child(key).report("belongs to the files of a 'model'");
        inputs.heat_flux = read_raster_series(node, folder, 1);
        return node.finish();
    }
    check_keys(node, source);
    if (const auto file = node.child("file"); file.present()) source.files = {read_file_name(file, folder)};
    if (const auto files = node.child("files"); files.present()) {
        if (!files.is_list() || files.items().empty()) return files.report("expected a list of files");
        for (const auto& file : files.items()) source.files.push_back(read_file_name(file, folder));
    }
    inputs.flux_model = std::move(source);
    node.finish();
}

}  // namespace pyroscene::scenario
