#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "base/csv.h"
#include "base/spectrum.h"
#include "gis/netcdf_input.h"
#include "radiometry/atmosphere.h"
#include "source_folder.h"

namespace pyroscene::radiometry {

inline Spectrum boxcar(double lower_um, double upper_um) { return {Quantity::Response, {lower_um, upper_um}, {1.0, 1.0}}; }

/// Measured responses by band name (origin: comment in the file).
inline std::map<std::string, Spectrum> measured_responses() {
    const auto table = read_csv(source_folder() / "tests/unit/radiometry/data/responses.csv");
    const auto lambda_um = table.numbers("wavelength_um"), response = table.numbers("response");
    std::map<std::string, Spectrum> bands;
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        auto& band = bands[table.rows[i][table.column("band")]];
        band.kind = Quantity::Response;
        band.lambda_um.push_back(lambda_um[i]);
        band.value.push_back(response[i]);
    }
    return bands;
}

inline std::vector<double> read_atmosphere(const std::string& file, const std::string& variable) {
    return gis::read_netcdf_variable(source_folder() / "data/atmosphere" / file, variable).values;
}

inline AtmosphereSet load_atmosphere(const std::string& model, double visibility_km = 23.0, ElevationRange ground = 0.0) {
    return make_atmosphere_set(model, visibility_km, ground, read_atmosphere);
}

inline AtmosphereTable load_table(const std::string& file) {
    return make_atmosphere_table([&](const std::string& variable) { return read_atmosphere(file, variable); });
}

}  // namespace pyroscene::radiometry
