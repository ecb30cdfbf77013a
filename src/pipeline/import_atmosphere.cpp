#include "pipeline/import_atmosphere.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/csv.h"
#include "base/error.h"
#include "base/files.h"
#include "gis/netcdf_output.h"

namespace fs = std::filesystem;

namespace pyroscene::pipeline {
namespace {

using radiometry::AtmosphereRun;
using radiometry::RunGeometry;
using radiometry::RunHints;

Spectrum sun_spectrum() {
    const auto table = read_csv(data_folder() / "optical" / "solar_irradiance.csv");
    return {Quantity::Irradiance, table.numbers("wavelength_um"), table.numbers("irradiance_W_m2_um")};
}

std::vector<std::string> words(const std::string& text) {
    std::istringstream in(text);
    std::vector<std::string> out;
    for (std::string word; in >> word;) out.push_back(word);
    return out;
}

/// One file with all that is said about it.
struct Source {
    fs::path file;
    std::string format;
    RunHints hints;
    std::vector<std::string> uvspec_columns;
    bool uvspec_thermal = false;
};

std::string extension(const fs::path& file) {
    std::string text = file.extension().string();
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

std::string detect_format(const Source& source, const std::string& text) {
    if (source.format != "auto") return source.format;
    const auto ext = extension(source.file);
    if (ext == ".json") return "json";
    if (ext == ".chn") return "chn";
    if (ext == ".csv") return text.find("wavelength_um") != std::string::npos ? "table" : "csv";
    if (!source.uvspec_columns.empty()) return "uvspec";
    if (text.find("SPECTRAL") != std::string::npos && text.find("EQUIVALENT WIDTH") != std::string::npos) return "chn";
    return "tape7";
}

/// uvspec does not print the sun at the top of the atmosphere, but less of it than all and more than a hundredth reaches the
/// ground somewhere below 1.3 um; a wrong unit is off by a thousand.
void check_sun_at_ground(const AtmosphereRun& run, const Spectrum& sun) {
    constexpr double kClear_um = 1.3, kMost = 1.5, kLeast = 0.01;
    double largest = 0.0;
    bool any = false;
    for (std::size_t i = 0; i < run.direct_normal.size(); ++i) {
        if (run.wavelength_um[i] > kClear_um || !(sun.at(run.wavelength_um[i]) > 0.0)) continue;
        largest = std::max(largest, run.direct_normal[i] / sun.at(run.wavelength_um[i]));
        any = true;
    }
    if (any && !(largest > kLeast && largest < kMost))
        throw input_error(run.source,
                          fmt::format("the direct sun is at most {:.3g} times that above the atmosphere, expected {} to 1; "
                                      "is the unit right (--unit, or column unit of a list)?",
                                      largest, kLeast));
}

std::vector<AtmosphereRun> read_source(const Source& source, const Spectrum& sun) {
    const auto path = source.file.string();
    const auto text = read_text_file(source.file);
    const auto format = detect_format(source, text);
    if (format == "tape7") return radiometry::read_modtran_table(path, text, source.hints, sun);
    if (format == "csv") return radiometry::read_modtran_csv(path, text, source.hints, sun);
    if (format == "json") return read_modtran_json(path, text, source.hints, sun);
    if (format == "chn") return radiometry::read_modtran_channels(path, text, source.hints, sun);
    if (format == "table") return {radiometry::read_exchange_csv(path, source.hints)};
    if (source.uvspec_columns.empty())
        throw input_error(path, "libRadtran tables have no header; name their columns (for example lambda edir edn)");
    auto run = radiometry::read_uvspec(path, text, source.uvspec_columns, source.uvspec_thermal, source.hints);
    check_sun_at_ground(run, sun);
    return {std::move(run)};
}

struct ListColumn {
    const char* name;
    std::optional<double> RunGeometry::*value;
    double minimum, maximum;
};
constexpr std::array<ListColumn, 9> kListColumns{
    {{"sensor_altitude_km", &RunGeometry::sensor_altitude_km, 1e-3, 1e5},
     {"view_zenith_deg", &RunGeometry::view_zenith_deg, 0.0, 89.0},
     {"sun_zenith_deg", &RunGeometry::sun_zenith_deg, 0.0, 89.0},
     {"relative_azimuth_deg", &RunGeometry::relative_azimuth_deg, 0.0, 180.0},
     {"albedo", &RunGeometry::albedo, 0.0, 1.0},
     {"ground_elevation_km", &RunGeometry::ground_elevation_km, -1.0, 9.0},
     {"visibility_km", &RunGeometry::visibility_km, 0.1, 1000.0},
     {"surface_temperature_K", &RunGeometry::surface_temperature_K, 1.0, 4000.0},
     {"day_of_year", &RunGeometry::day_of_year, 0.0, 366.0}}};

bool is_list(const fs::path& file) {
    return extension(file) == ".csv" && read_text_file(file).find("wavelength_um") == std::string::npos && [&] {
        try {
            return read_csv(file).has("file");
        } catch (const Error&) {
            return false;  // a MODTRAN csv need not be as even as ours
        }
    }();
}

std::vector<Source> read_list(const fs::path& list, const Source& common) {
    const auto table = read_csv(list);
    std::vector<std::string> known{"file", "format", "unit", "columns", "source"};
    for (const auto& c : kListColumns) known.emplace_back(c.name);
    for (const auto& column : table.columns)
        if (std::find(known.begin(), known.end(), column) == known.end())
            throw input_error(table.path,
                              fmt::format("column '{}' is unknown; there are {}", column, fmt::join(known, ", ")));
    std::vector<Source> sources;
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
        const auto where = fmt::format("{}:{}", table.path, table.row_lines[r]);
        const auto cell = [&](const char* name) {
            return table.has(name) ? table.rows[r][table.column(name)] : std::string();
        };
        Source s = common;
        s.file = list.parent_path() / cell("file");
        if (cell("file").empty()) throw input_error(where, "no file is named");
        if (!cell("format").empty()) s.format = cell("format");
        if (!cell("unit").empty()) s.hints.unit = radiometry::spectral_unit(cell("unit"), where + ", unit");
        if (!cell("columns").empty()) s.uvspec_columns = words(cell("columns"));
        if (const auto kind = cell("source"); !kind.empty()) {
            if (kind != "solar" && kind != "thermal")
                throw input_error(where, fmt::format("source '{}', expected solar or thermal", kind));
            s.uvspec_thermal = kind == "thermal";
        }
        for (const auto& c : kListColumns) {
            const auto text = cell(c.name);
            if (text.empty()) continue;
            const double value = parse_number(text, fmt::format("{}, {}", where, c.name));
            if (!(value >= c.minimum && value <= c.maximum))
                throw input_error(where, fmt::format("{} {}, expected {} to {}", c.name, value, c.minimum, c.maximum));
            s.hints.geometry.*c.value = value;
        }
        sources.push_back(std::move(s));
    }
    if (sources.empty()) throw input_error(table.path, "the list of runs is empty");
    return sources;
}

gis::ArrayVariable variable(const char* name, std::vector<std::string> dimensions, const char* unit, const char* meaning,
                            const std::vector<float>& values) {
    return {name, std::move(dimensions), unit, meaning, {values.begin(), values.end()}, gis::SampleType::Float32, {}, {}};
}

}  // namespace

std::vector<AtmosphereRun> read_atmosphere_runs(const ImportAtmosphereRequest& request) {
    const std::vector<std::string> formats{"auto", "tape7", "csv", "json", "chn", "uvspec", "table"};
    const auto sun = sun_spectrum();
    std::vector<AtmosphereRun> runs;
    for (const auto& file : request.files) {
        std::error_code ignored;
        if (!fs::is_regular_file(file, ignored)) throw input_error(file.string(), "no such file");
        const Source common{file, request.format, request.hints, request.uvspec_columns, request.uvspec_thermal};
        for (const auto& source :
             request.format == "auto" && is_list(file) ? read_list(file, common) : std::vector{common}) {
            if (std::find(formats.begin(), formats.end(), source.format) == formats.end())
                throw input_error(source.file.string(), fmt::format("format '{}' is unknown; there are {}", source.format,
                                                                    fmt::join(formats, ", ")));
            auto read = read_source(source, sun);
            std::move(read.begin(), read.end(), std::back_inserter(runs));
        }
    }
    return runs;
}

void write_atmosphere_table(const fs::path& path, const radiometry::AtmosphereTable& t,
                            const std::map<std::string, std::string>& attributes) {
    const std::vector<std::string> path_axes{"sensor_altitude", "view_zenith", "wavelength"};
    gis::ArrayFile file;
    file.attributes = attributes;
    const auto axis = [&](const char* name, const char* unit, const char* meaning, const std::vector<double>& values) {
        file.dimensions.emplace_back(name, values.size());
        file.variables.push_back({name, {name}, unit, meaning, values, gis::SampleType::Float64, {}, {}});
    };
    axis("sensor_altitude", "km", "above the ground", t.sensor_altitude_km);
    axis("view_zenith", "degree", "at the ground", t.view_zenith_deg);
    axis("solar_zenith", "degree", "at the ground", t.solar_zenith_deg);
    axis("relative_azimuth", "degree", "sun minus line of sight (sensor to target): 0 looks towards the sun",
         t.relative_azimuth_deg);
    axis("wavelength", "um", "in vacuum", t.wavelength_um);
    file.variables.push_back({"visibility", {}, "km", "", {t.visibility_km}, gis::SampleType::Float64, {}, {}});
    file.variables.push_back(
        {"ground_elevation", {}, "km", "above sea level", {t.ground_elevation_km}, gis::SampleType::Float64, {}, {}});
    const char *radiance = "W m-2 sr-1 um-1", *irradiance = "W m-2 um-1";
    file.variables.push_back(
        variable("toa_solar_irradiance", {"wavelength"}, irradiance, "at 1 AU, normal to the beam", t.toa_solar_irradiance));
    file.variables.push_back(variable("transmittance", path_axes, "1", "ground to sensor", t.transmittance));
    file.variables.push_back(variable("path_thermal_radiance", path_axes, radiance, "", t.path_thermal_radiance));
    file.variables.push_back(variable("path_solar_radiance",
                                      {"sensor_altitude", "view_zenith", "solar_zenith", "relative_azimuth", "wavelength"},
                                      radiance, "ground albedo 0, 1 AU", t.path_solar_radiance));
    file.variables.push_back(variable("direct_solar_irradiance", {"solar_zenith", "wavelength"}, irradiance,
                                      "normal to the beam, 1 AU", t.direct_solar_irradiance));
    file.variables.push_back(variable("diffuse_solar_irradiance", {"solar_zenith", "wavelength"}, irradiance,
                                      "horizontal, ground albedo 0, 1 AU", t.diffuse_solar_irradiance));
    file.variables.push_back(
        variable("thermal_sky_irradiance", {"wavelength"}, irradiance, "horizontal", t.thermal_sky_irradiance));
    file.variables.push_back(
        variable("spherical_albedo", {"wavelength"}, "1", "of the air seen from below", t.spherical_albedo));
    file.variables.push_back(variable("diffuse_upward_transmittance", path_axes, "1", "light of the surroundings",
                                      t.diffuse_upward_transmittance));
    file.variables.push_back(variable("solar_path_correlation",
                                      {"sensor_altitude", "view_zenith", "solar_zenith", "wavelength"}, "1",
                                      "of the reflected direct sun", t.solar_path_correlation));
    gis::write_netcdf(path, file);
}

ImportAtmosphereResult import_atmosphere(const ImportAtmosphereRequest& request) {
    auto runs = read_atmosphere_runs(request);
    ImportAtmosphereResult result;
    result.runs = runs.size();
    std::string sources;
    for (const auto& run : runs) sources += (sources.empty() ? "" : ", ") + fs::path(run.source).filename().string();
    auto assembled = radiometry::assemble_atmosphere(std::move(runs), request.without_sun);
    result.table = std::move(assembled.table);
    result.notes = std::move(assembled.notes);
    std::map<std::string, std::string> attributes{
        {"title", "Atmosphere look-up table for Pyroscene"}, {"source", sources}, {"history", request.command_line}};
    if (!result.notes.empty()) attributes["comment"] = fmt::format("{}", fmt::join(result.notes, "; "));
    write_atmosphere_table(request.output, result.table, attributes);
    return result;
}

}  // namespace pyroscene::pipeline
