#include "pipeline/state_file.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/csv.h"
#include "base/error.h"
#include "base/files.h"
#include "drawing/qgis_style.h"
#include "gis/image_stream.h"
#include "gis/tiff_writer.h"

namespace pyroscene::pipeline {
namespace {

using fire::FireState;

/// The float rasters of a state in band order after the class band; angles are degrees in the file, radians inside.
struct StateBand {
    const char* name;
    const char* unit;
    SparseRaster<float> FireState::*raster;
    double to_file;
};
constexpr StateBand kBands[] = {
    {"arrival_time", "s", &FireState::arrival_time_s, 1.0},
    {"last_burning_time", "s", &FireState::last_burning_time_s, 1.0},
    {"surface_temperature", "K", &FireState::surface_temperature_K, 1.0},
    {"front_fraction", "1", &FireState::front_fraction, 1.0},
    {"flame_height", "m", &FireState::flame_height_m, 1.0},
    {"ember_height", "m", &FireState::ember_height_m, 1.0},
    {"flame_tilt_from_vertical", "degree", &FireState::flame_tilt_rad, 1.0 / kDegree_rad},
    {"flame_azimuth", "degree", &FireState::flame_azimuth_rad, 1.0 / kDegree_rad},
};

/// The columns of the table of embers beside a state.
struct EmberColumn {
    const char* name;
    double fire::Ember::*value;
};
constexpr EmberColumn kEmberColumns[] = {
    {"release_s", &fire::Ember::release_s},
    {"x_m", &fire::Ember::x_m},
    {"y_m", &fire::Ember::y_m},
    {"ground_x_m", &fire::Ember::ground_x_m},
    {"ground_y_m", &fire::Ember::ground_y_m},
    {"bottom_m", &fire::Ember::bottom_m},
    {"edge_m", &fire::Ember::edge_m},
    {"east_m_s", &fire::Ember::east_m_s},
    {"north_m_s", &fire::Ember::north_m_s},
    {"rise_m_s", &fire::Ember::rise_m_s},
};

double number(const std::map<std::string, std::string>& metadata, const char* key, const std::filesystem::path& path) {
    const auto it = metadata.find(key);
    if (it == metadata.end()) throw runtime_error(path.string(), fmt::format("state file without '{}'", key));
    return parse_number(it->second, path.string() + ": " + key);
}

std::filesystem::path ember_path(std::filesystem::path state) {
    const auto name = state.stem().string() + "_embers.csv";
    return state.replace_filename(name);
}

/// Shortest digits that read back as the same number.
void write_embers(const std::filesystem::path& path, const std::vector<fire::Ember>& embers) {
    std::string text;
    for (const auto& column : kEmberColumns) text += fmt::format("{}{}", text.empty() ? "" : ",", column.name);
    text += '\n';
    for (const auto& ember : embers) {
        for (const auto& column : kEmberColumns)
            text += fmt::format("{}{}", &column == kEmberColumns ? "" : ",", ember.*column.value);
        text += '\n';
    }
    write_text_file(path, text);
}

std::vector<fire::Ember> read_embers(const std::filesystem::path& path, std::size_t count) {
    std::vector<fire::Ember> embers(count);
    if (count == 0) return embers;
    const auto table = read_csv(path);
    if (table.rows.size() != count)
        throw runtime_error(path.string(),
                            fmt::format("found {} embers, expected {}; run again with --force", table.rows.size(), count));
    for (const auto& column : kEmberColumns) {
        const auto values = table.numbers(column.name);
        for (std::size_t i = 0; i < count; ++i) embers[i].*column.value = values[i];
    }
    return embers;
}

/// Some rows of one band at a time.
void write_bands(const std::filesystem::path& path, const FireState& state, gis::OutputRaster raster) {
    const auto cols = static_cast<std::size_t>(raster.cols);
    const int rows = raster.rows;
    gis::TiffWriter writer(path, std::move(raster));
    const auto& classes = state.cell_class.values;
    std::vector<float> pixels;
    for (std::size_t b = 0; b <= std::size(kBands); ++b)
        for (int first = 0; first < rows; first += writer.tile_rows()) {
            const int count = std::min(writer.tile_rows(), rows - first);
            const std::size_t begin = static_cast<std::size_t>(first) * cols;
            pixels.resize(static_cast<std::size_t>(count) * cols);
            if (b == 0) {
                std::copy_n(classes.begin() + static_cast<std::ptrdiff_t>(begin), pixels.size(), pixels.begin());
            } else {
                const StateBand& band = kBands[b - 1];
                (state.*band.raster).copy(begin, pixels);
                for (float& v : pixels) v = static_cast<float>(v * band.to_file);
            }
            writer.write({b, 1, first, count}, pixels);
        }
    writer.finish();
}

}  // namespace

std::filesystem::path state_path(const std::filesystem::path& output, double time_s) {
    const bool whole = std::abs(time_s - std::round(time_s)) < 5e-4;
    return output / "state" / (whole ? fmt::format("t{:09.0f}.tif", time_s) : fmt::format("t{:013.3f}.tif", time_s));
}

void write_state(const std::filesystem::path& path, const FireState& state, const std::string& fingerprint,
                 const std::string& acquisition_time) {
    gis::OutputRaster out;
    const MapGrid& grid = state.cell_class.grid;
    out.grid = grid;
    out.cols = grid.cols;
    out.rows = grid.rows;
    out.acquisition_time = acquisition_time;
    out.bands.push_back({"class (0 unburned, 1 front, 2 scar, 255 no data)", "1", {}, {}, {}});
    for (const auto& band : kBands) out.bands.push_back({band.name, band.unit, {}, {}, {}});
    const auto& statistics = state.height_statistics;
    out.metadata = {{"FINGERPRINT", fingerprint},
                    {"TIME_S", fmt::format("{}", state.time_s)},
                    {"HEIGHT_COUNT", fmt::format("{}", statistics.count)},
                    {"HEIGHT_MEAN_M", fmt::format("{:.17g}", statistics.mean_m)},
                    {"HEIGHT_M2_M2", fmt::format("{:.17g}", statistics.m2_m2)},
                    {"EMBER_COUNT", fmt::format("{}", state.embers.size())},
                    {"HEAT_RELEASE_W", fmt::format("{:.17g}", state.heat_release_W)}};
    // The table first: a state file that exists is complete.
    if (!state.embers.empty()) write_embers(ember_path(path), state.embers);
    drawing::write_qgis_style(path, {{0, "#dfe8d2", "unburned"}, {1, "#e31a1c", "front"}, {2, "#5a5048", "scar"}});
    write_bands(path, state, std::move(out));
}

FireState read_state(const std::filesystem::path& path, const MapGrid& grid, const SharedRaster<float>& predicted_arrival) {
    gis::ImageStream image(path);
    const auto& info = image.info();
    if (info.cols != grid.cols || info.rows != grid.rows || info.bands.size() != std::size(kBands) + 1)
        throw runtime_error(path.string(), "is not a state of this scenario; run again with --force");
    FireState state;
    state.time_s = number(info.metadata, "TIME_S", path);
    state.height_statistics.count = static_cast<std::int64_t>(number(info.metadata, "HEIGHT_COUNT", path));
    state.height_statistics.mean_m = number(info.metadata, "HEIGHT_MEAN_M", path);
    state.height_statistics.m2_m2 = number(info.metadata, "HEIGHT_M2_M2", path);
    state.heat_release_W = number(info.metadata, "HEAT_RELEASE_W", path);
    state.embers = read_embers(ember_path(path), static_cast<std::size_t>(number(info.metadata, "EMBER_COUNT", path)));
    state.cell_class = Raster<std::uint8_t>(grid, "class", "1");
    const std::size_t n = grid.size();
    auto pixels = image.read_band(1);
    for (std::size_t i = 0; i < n; ++i)
        state.cell_class.values[i] = static_cast<std::uint8_t>(std::isnan(pixels[i]) ? 255.0F : pixels[i]);
    for (std::size_t b = 0; b < std::size(kBands); ++b) {
        pixels = image.read_band(static_cast<int>(b) + 2);
        const auto value = [&](std::size_t i) { return static_cast<float>(pixels[i] / kBands[b].to_file); };
        // What the first cell has, most cells have: nothing burns there.
        auto& raster = state.*kBands[b].raster;
        raster = SparseRaster<float>(grid, kBands[b].name, kBands[b].unit, value(0));
        for (std::size_t i = 0; i < n; ++i) raster.set(i, value(i));
    }
    state.predicted_arrival_time_s = predicted_arrival;
    return state;
}

}  // namespace pyroscene::pipeline
