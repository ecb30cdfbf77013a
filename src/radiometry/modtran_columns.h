#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "radiometry/atmosphere_run.h"

namespace pyroscene::radiometry {

/// Columns of one MODTRAN run under normalised names (upper case, only letters and digits: TOTTRANS, PTHTHRML), whatever
/// file they come from.
struct ModtranColumns {
    std::string source;
    enum class Abscissa { Wavenumber, Micrometre, Nanometre } abscissa = Abscissa::Wavenumber;
    std::vector<double> x;
    std::map<std::string, std::vector<double>> columns;
    RunGeometry geometry;
    bool looks_up = false;
    std::optional<SpectralUnit> unit;
};

std::string normalised_name(std::string_view name);

/// A number as Fortran prints it (1.234E-101 may lack its E). nullopt for stars and anything else.
std::optional<double> fortran_number(std::string_view field);

/// Converts the units, sorts by wavelength and finds the terms by their names (both spellings of MODTRAN 5 and 6).
/// Throws an input error: no transmittance, a unit that contradicts the sun, a value out of range.
AtmosphereRun to_run(const ModtranColumns& columns, const RunHints& hints, const Spectrum& sun);

/// Sorts all arrays of a run by wavelength. Throws an input error when one occurs twice.
void sort_by_wavelength(AtmosphereRun& run);

/// Zenith angle at the ground of a straight ray with a zenith angle at some altitude (kModtranEarthRadius_km).
double zenith_at_ground_deg(double zenith_at_sensor_deg, double sensor_altitude_km, double ground_km);

/// Geometry from the numbers that MODTRAN's cards and JSON share; NaN or empty where they do not apply.
struct ModtranGeometry {
    int itype = 0, iparm = -1, day_of_year = 0;
    double h1_km = 0.0, h2_km = 0.0, zenith_deg = 0.0, parm1 = 0.0, parm2 = 0.0;
    double ground_km = 0.0, visibility_km = 0.0, albedo = -1.0;
    bool with_sun = false;
};
/// Also tells whether the path looks up from the ground. Horizontal paths give no altitude and angle.
void set_geometry(const ModtranGeometry& from, RunGeometry& to, bool& looks_up);

}  // namespace pyroscene::radiometry
