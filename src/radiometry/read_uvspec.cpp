#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/constants.h"
#include "base/csv.h"
#include "base/error.h"
#include "radiometry/modtran_columns.h"

namespace pyroscene::radiometry {
namespace {

struct UvspecRow {
    double lambda_um = 0.0;
    std::map<std::string, double> values;
};

std::vector<UvspecRow> rows_of(const std::string& path, const std::string& text, const std::vector<std::string>& columns) {
    if (std::find(columns.begin(), columns.end(), "lambda") == columns.end())
        throw input_error(path, fmt::format("the columns must name lambda, found {}", fmt::join(columns, " ")));
    std::vector<UvspecRow> rows;
    std::istringstream in(text);
    int line_number = 0;
    for (std::string line; std::getline(in, line);) {
        ++line_number;
        std::istringstream words(line);
        std::vector<std::string> fields;
        for (std::string word; words >> word;) fields.push_back(word);
        if (fields.empty() || fields[0].starts_with("#")) continue;
        if (fields.size() != columns.size())
            throw input_error(fmt::format("{}:{}", path, line_number),
                              fmt::format("{} numbers, expected the {} columns {}", fields.size(), columns.size(),
                                          fmt::join(columns, " ")));
        UvspecRow row;
        for (std::size_t k = 0; k < columns.size(); ++k) {
            const auto value = fortran_number(fields[k]);
            if (!value || !std::isfinite(*value))
                throw input_error(fmt::format("{}:{}", path, line_number),
                                  fmt::format("column {} reads '{}', expected a number", columns[k], fields[k]));
            row.values[columns[k]] = *value;
        }
        row.lambda_um = 1e-3 * row.values.at("lambda");
        rows.push_back(std::move(row));
    }
    if (rows.size() < 2) throw input_error(path, fmt::format("{} lines, expected at least 2", rows.size()));
    return rows;
}

/// Output at two levels holds two lines per wavelength: ground and sensor. Their direct beams give the transmittance.
void take_two_levels(const std::string& path, const std::vector<UvspecRow>& rows, AtmosphereRun& run) {
    for (std::size_t i = 0; i + 1 < rows.size(); i += 2) {
        const auto &a = rows[i], &b = rows[i + 1];
        if (a.lambda_um != b.lambda_um)
            throw input_error(path, fmt::format("{:.6g} um has one line, expected one for the ground and one for the sensor",
                                                a.lambda_um));
        const bool a_is_ground = a.values.at("zout") < b.values.at("zout");
        const double ground = (a_is_ground ? a : b).values.at("edir"), sensor = (a_is_ground ? b : a).values.at("edir");
        run.wavelength_um.push_back(a.lambda_um);
        run.transmittance.push_back(sensor > 0.0 ? std::clamp(ground / sensor, 0.0, 1.0) : 0.0);
    }
}

bool has_two_levels(const std::vector<UvspecRow>& rows) {
    return rows[0].values.contains("zout") && rows[0].values.contains("edir") && rows[0].lambda_um == rows[1].lambda_um;
}

void take_one_level(const std::vector<UvspecRow>& rows, bool thermal, SpectralUnit unit, AtmosphereRun& run) {
    const auto cosine = std::cos(run.geometry.sun_zenith_deg.value_or(0.0) * kDegree_rad);
    for (const auto& row : rows) {
        const double factor = to_product_unit(unit, row.lambda_um);
        const auto take = [&](const char* column, std::vector<double>& to, double scale) {
            if (const auto it = row.values.find(column); it != row.values.end()) to.push_back(scale * factor * it->second);
        };
        run.wavelength_um.push_back(row.lambda_um);
        take("uu", thermal ? run.total_radiance : run.path_solar, 1.0);
        take("edn", thermal ? run.thermal_sky : run.diffuse, 1.0);
        if (!thermal && row.values.contains("edir") && cosine > 0.0) take("edir", run.direct_normal, 1.0 / cosine);
    }
}

}  // namespace

AtmosphereRun read_uvspec(const std::string& path, const std::string& text, const std::vector<std::string>& columns,
                          bool thermal, const RunHints& hints) {
    const auto rows = rows_of(path, text, columns);
    AtmosphereRun run;
    run.source = path;
    run.geometry = hints.geometry;
    run.includes_thermal = thermal;
    run.includes_sun = !thermal;
    if (has_two_levels(rows))
        take_two_levels(path, rows, run);
    else
        take_one_level(rows, thermal, hints.unit.value_or(SpectralUnit::MilliwattPerNanometreM2), run);
    for (std::size_t i = 0; i < run.wavelength_um.size(); ++i) {
        const double lambda_um = run.wavelength_um[i];
        if (!(lambda_um > (i > 0 ? run.wavelength_um[i - 1] : 0.0)))
            throw input_error(path, fmt::format("wavelength {:.6g} um, expected positive and ascending", lambda_um));
        for (const auto* values : {&run.path_solar, &run.total_radiance, &run.diffuse, &run.thermal_sky, &run.direct_normal})
            if (!values->empty() && !((*values)[i] >= -1e-9 && (*values)[i] < 1e6))
                throw input_error(path,
                                  fmt::format("{:.6g} W m-2 (sr-1) um-1 at {:.6g} um, expected 0 to 1e6; is the unit right?",
                                              (*values)[i], lambda_um));
    }
    return run;
}

AtmosphereRun read_exchange_csv(const std::string& path, const RunHints& hints) {
    const auto table = read_csv(path);
    AtmosphereRun run;
    run.source = path;
    run.geometry = hints.geometry;
    run.wavelength_um = table.numbers("wavelength_um");
    struct Known {
        const char* name;
        std::vector<double>* to;
        double maximum;
    };
    const std::vector<Known> known{{"transmittance", &run.transmittance, 1.0},
                                   {"path_thermal_W_m2_sr_um", &run.path_thermal, 1e6},
                                   {"path_solar_W_m2_sr_um", &run.path_solar, 1e6},
                                   {"toa_irradiance_W_m2_um", &run.toa_irradiance, 1e5},
                                   {"direct_irradiance_W_m2_um", &run.direct_normal, 1e5},
                                   {"diffuse_irradiance_W_m2_um", &run.diffuse, 1e5},
                                   {"thermal_irradiance_W_m2_um", &run.thermal_sky, 1e5},
                                   {"spherical_albedo", &run.spherical_albedo, 1.0},
                                   {"diffuse_transmittance", &run.diffuse_transmittance, 10.0},
                                   {"solar_correlation", &run.correlation, 1e6}};
    std::vector<std::string> names{"wavelength_um"};
    for (const auto& k : known) names.emplace_back(k.name);
    for (const auto& column : table.columns)
        if (std::find(names.begin(), names.end(), column) == names.end())
            throw input_error(table.path,
                              fmt::format("column '{}' is unknown; there are {}", column, fmt::join(names, ", ")));
    for (std::size_t i = 0; i < run.wavelength_um.size(); ++i)
        if (!(run.wavelength_um[i] > (i > 0 ? run.wavelength_um[i - 1] : 0.0)))
            throw input_error(fmt::format("{}:{}", table.path, table.row_lines[i]),
                              "wavelengths must be positive and ascend");
    for (const auto& k : known) {
        if (!table.has(k.name)) continue;
        *k.to = table.numbers(k.name);
        for (std::size_t i = 0; i < k.to->size(); ++i)
            if (!((*k.to)[i] >= 0.0 && (*k.to)[i] <= k.maximum))
                throw input_error(fmt::format("{}:{}", table.path, table.row_lines[i]),
                                  fmt::format("{} is {}, expected 0 to {}", k.name, (*k.to)[i], k.maximum));
    }
    return run;
}

}  // namespace pyroscene::radiometry
