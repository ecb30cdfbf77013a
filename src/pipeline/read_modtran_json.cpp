#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "pipeline/import_atmosphere.h"
#include "radiometry/modtran_columns.h"

namespace pyroscene::pipeline {
namespace {

using Json = nlohmann::json;
using radiometry::ModtranColumns;

double number(const Json& object, const char* key, double fallback) {
    return object.contains(key) && object[key].is_number() ? object[key].get<double>() : fallback;
}

std::string word(const Json& object, const char* key) {
    return object.contains(key) && object[key].is_string() ? object[key].get<std::string>() : std::string();
}

void read_geometry(const Json& input, ModtranColumns& c) {
    const auto section = [&](const char* name) { return input.contains(name) ? input[name] : Json::object(); };
    const Json geometry = section("GEOMETRY"), surface = section("SURFACE"), options = section("RTOPTIONS"),
               spectral = section("SPECTRAL");
    const Json aerosols = input.contains("AEROSOLS") ? input["AEROSOLS"] : section("AEROSOL");
    radiometry::ModtranGeometry g;
    g.itype =
        geometry.contains("H1ALT") && geometry.contains("OBSZEN") ? static_cast<int>(number(geometry, "ITYPE", 3.0)) : 0;
    g.h1_km = number(geometry, "H1ALT", 0.0);
    g.h2_km = number(geometry, "H2ALT", 0.0);
    g.zenith_deg = number(geometry, "OBSZEN", 180.0);
    g.iparm = static_cast<int>(number(geometry, "IPARM", -1.0));
    g.parm1 = number(geometry, "PARM1", 0.0);
    g.parm2 = number(geometry, "PARM2", 0.0);
    g.day_of_year = static_cast<int>(number(geometry, "IDAY", 0.0));
    g.ground_km = number(surface, "GNDALT", 0.0);
    g.visibility_km = number(aerosols, "VIS", 0.0);
    g.albedo = number(surface, "SURREF", -1.0);
    const auto mode = word(options, "IEMSCT");
    g.with_sun = mode.empty() || mode.find("SOLAR") != std::string::npos;
    set_geometry(g, c.geometry, c.looks_up);
    const auto x = word(spectral, "XFLAG");
    if (x == "N" || x == "n") c.unit = radiometry::SpectralUnit::MicrowattPerNanometre;
    if (x == "M" || x == "m") c.unit = radiometry::SpectralUnit::PerMicrometre;
    if (x == "W" || x == "w") c.unit = radiometry::SpectralUnit::PerWavenumber;
}

void read_spectra(const Json& spectra, ModtranColumns& c) {
    std::string found;
    for (const auto& [name, values] : spectra.items()) {
        const auto key = radiometry::normalised_name(name);
        if (!values.is_array() || values.empty()) continue;
        std::vector<double> column;
        for (const auto& value : values) {
            if (!value.is_number())
                throw input_error(c.source, fmt::format("{} holds {}, expected numbers", name, value.dump()));
            column.push_back(value.get<double>());
        }
        found += (found.empty() ? "" : ", ") + name;
        const bool frequency = key.starts_with("FREQ") || key.starts_with("WAVENUM");
        if (frequency || key.starts_with("WAVLEN") || key.starts_with("WAVELEN")) {
            if (!c.x.empty() && !frequency) continue;  // both are there: the frequency is what the run used
            c.x = std::move(column);
            c.abscissa = frequency            ? ModtranColumns::Abscissa::Wavenumber
                         : c.x.back() > 150.0 ? ModtranColumns::Abscissa::Nanometre
                                              : ModtranColumns::Abscissa::Micrometre;
        } else {
            c.columns[key] = std::move(column);
        }
    }
    if (c.x.empty()) throw input_error(c.source, fmt::format("no spectral position (FREQ or WAVLEN); found {}", found));
    for (const auto& [name, column] : c.columns)
        if (column.size() != c.x.size())
            throw input_error(c.source,
                              fmt::format("{} has {} values for {} spectral positions", name, column.size(), c.x.size()));
}

}  // namespace

std::vector<radiometry::AtmosphereRun> read_modtran_json(const std::string& path, const std::string& text,
                                                         const radiometry::RunHints& hints, const Spectrum& sun) {
    Json document;
    try {
        document = Json::parse(text);
    } catch (const Json::parse_error& e) {
        throw input_error(path, fmt::format("is no JSON: {}", e.what()));
    }
    if (!document.is_object() || !document.contains("MODTRAN") || !document["MODTRAN"].is_array())
        throw input_error(path, "has no list MODTRAN: this is no MODTRAN6 JSON file");
    std::vector<radiometry::AtmosphereRun> runs;
    int number_of_case = 0;
    for (const auto& entry : document["MODTRAN"]) {
        ModtranColumns c;
        c.source = fmt::format("{}, case {}", path, number_of_case++);
        if (!entry.is_object() || !entry.contains("MODTRANOUTPUT"))
            throw input_error(c.source, "has no MODTRANOUTPUT; run it with JSONOPT WRT_INPUT_OUTPUT");
        if (entry.contains("MODTRANINPUT")) read_geometry(entry["MODTRANINPUT"], c);
        const auto& output = entry["MODTRANOUTPUT"];
        const Json spectra = output.contains("SPECTRA") ? output["SPECTRA"] : Json();
        for (const char* kind : {"RADIANCE", "TRANSMITTANCE", "IRRADIANCE"})
            if (spectra.is_object() && spectra.contains(kind) && spectra[kind].is_object() && c.x.empty())
                read_spectra(spectra[kind], c);
        if (c.x.empty()) throw input_error(c.source, "has no SPECTRA with RADIANCE, TRANSMITTANCE or IRRADIANCE");
        runs.push_back(to_run(c, hints, sun));
    }
    if (runs.empty()) throw input_error(path, "has no case");
    return runs;
}

}  // namespace pyroscene::pipeline
