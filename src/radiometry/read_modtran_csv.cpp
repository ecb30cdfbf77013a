#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "radiometry/modtran_columns.h"

namespace pyroscene::radiometry {
namespace {

using Abscissa = ModtranColumns::Abscissa;

std::vector<std::string> fields_of(std::string line) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    std::vector<std::string> fields;
    std::istringstream in(line);
    for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
    return fields;
}

bool is_transmittance(const std::string& name) {
    return name == "TOTTRANS" || name == "COMBINTRANS" || name == "TOTALTRANS" || name == "TRANS";
}

bool is_header(const std::vector<std::string>& fields) {
    return fields.size() > 1 &&
           std::any_of(fields.begin(), fields.end(), [](const auto& f) { return is_transmittance(normalised_name(f)); });
}

std::optional<Abscissa> abscissa_of(const std::string& name, const std::string& unit) {
    if (name.starts_with("FREQ") || name.starts_with("WAVENUM")) return Abscissa::Wavenumber;
    if (!name.starts_with("WAVLEN") && !name.starts_with("WAVELEN") && name != "LAMBDA") return std::nullopt;
    const bool nanometres =
        unit.starts_with("NM") || unit.find("NANO") != std::string::npos || (name.ends_with("NM") && unit.empty());
    return nanometres ? Abscissa::Nanometre : Abscissa::Micrometre;
}

/// Unit of a radiance from words like "W SR-1 CM-2 / CM-1". Empty when it is not told.
std::optional<SpectralUnit> unit_in(const std::string& text) {
    const auto ends_with = [&](const char* what) { return text.ends_with(what); };
    if (ends_with("CM1") || ends_with("CM")) return SpectralUnit::PerWavenumber;
    const bool micro = text.starts_with("UW") || text.starts_with("MICROW");
    if (ends_with("NM") || ends_with("NM1")) return micro ? SpectralUnit::MicrowattPerNanometre : SpectralUnit::PerNanometre;
    if (ends_with("UM") || ends_with("UM1") || ends_with("MICRON") || ends_with("MICRON1"))
        return SpectralUnit::PerMicrometre;
    return std::nullopt;
}

struct Header {
    std::vector<std::string> names, units;
    std::size_t abscissa = 0;
};

Header header_of(const std::string& where, const std::vector<std::string>& names, const std::vector<std::string>& units,
                 ModtranColumns& c) {
    Header h;
    for (std::size_t k = 0; k < names.size(); ++k) {
        h.names.push_back(normalised_name(names[k]));
        h.units.push_back(k < units.size() ? normalised_name(units[k]) : std::string());
    }
    for (std::size_t k = 0; k < h.names.size(); ++k)
        if (const auto abscissa = abscissa_of(h.names[k], h.units[k])) {
            h.abscissa = k;
            c.abscissa = *abscissa;
            break;
        } else if (k + 1 == h.names.size()) {
            throw input_error(where, fmt::format("no column FREQ or WAVLEN; found {}", fmt::join(names, ", ")));
        }
    for (std::size_t k = 0; k < h.names.size(); ++k)
        if (h.names[k] == "TOTALRAD" || h.names[k] == "GRNDRFLT") c.unit = unit_in(h.units[k]);
    return h;
}

}  // namespace

std::vector<AtmosphereRun> read_modtran_csv(const std::string& path, const std::string& text, const RunHints& hints,
                                            const Spectrum& sun) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) rows.push_back(fields_of(line));
    std::size_t first = 0;
    while (first < rows.size() && !is_header(rows[first])) ++first;
    if (first == rows.size())
        throw input_error(path, "no header with a total transmittance (TOT_TRANS, COMBIN_TRANS): this is no MODTRAN csv");
    ModtranColumns c;
    c.source = fmt::format("{}:{}", path, first + 1);
    std::size_t row = first + 1;
    std::vector<std::string> units;
    while (row < rows.size() && !rows[row].empty() && !fortran_number(rows[row][0])) {
        if (units.empty()) units = rows[row];
        ++row;
    }
    const auto header = header_of(c.source, rows[first], units, c);
    for (; row < rows.size(); ++row) {
        const auto where = fmt::format("{}:{}", path, row + 1);
        if (rows[row].empty() || (rows[row].size() == 1 && normalised_name(rows[row][0]).empty())) continue;
        const auto start = fortran_number(rows[row][0]);
        if (start && *start == -9999.0) break;
        if (rows[row].size() < header.names.size())
            throw input_error(where, fmt::format("{} fields, expected {}", rows[row].size(), header.names.size()));
        for (std::size_t k = 0; k < header.names.size(); ++k) {
            const auto value = fortran_number(rows[row][k]);
            if (!value)
                throw input_error(where,
                                  fmt::format("column {} reads '{}', expected a number", header.names[k], rows[row][k]));
            if (k == header.abscissa)
                c.x.push_back(*value);
            else
                c.columns[header.names[k]].push_back(*value);
        }
    }
    if (c.abscissa == Abscissa::Micrometre && !c.x.empty() && *std::max_element(c.x.begin(), c.x.end()) > 150.0)
        c.abscissa = Abscissa::Nanometre;
    return {to_run(c, hints, sun)};
}

}  // namespace pyroscene::radiometry
