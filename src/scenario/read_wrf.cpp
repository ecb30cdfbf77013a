#include "scenario/readers.h"

namespace fs = std::filesystem;

namespace pyroscene::scenario {

/// A file, a list of files, or a map with more.
WrfSource read_wrf(const config::Node& node, const fs::path& folder) {
    WrfSource wrf;
    const auto add = [&](const config::Node& file) {
        if (file.is_list())
            for (const auto& item : file.items()) wrf.files.push_back(read_file_name(item, folder));
        else
            wrf.files.push_back(read_file_name(file, folder));
    };
    if (!node.is_map()) {
        add(node);
        return wrf;
    }
    const config::Node file = node.child("file"), files = node.child("files");
    if (file.present() == files.present()) node.report("expected 'file' or 'files'");
    if (file.present()) add(file);
    if (files.present()) add(files);
    wrf.crs = node.text("crs", "");
    constexpr config::Range kPlace = config::Range::between(-1e8, 1e8);
    wrf.west_m = node.optional_number("west_m", kPlace);
    wrf.south_m = node.optional_number("south_m", kPlace);
    const bool whole = wrf.crs.empty() ? !wrf.west_m && !wrf.south_m : wrf.west_m && wrf.south_m;
    if (!whole) node.report("an idealised run is placed by 'crs', 'west_m' and 'south_m' together");
    if (const auto table = node.child("fuel_table"); table.present()) wrf.fuel_table = read_fuel_table(table, folder);
    wrf.plume = node.boolean("plume", false);
    node.finish();
    return wrf;
}

}  // namespace pyroscene::scenario
