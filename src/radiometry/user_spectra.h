#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "radiometry/surfaces.h"

namespace pyroscene::radiometry {

/// A reflectance spectrum of the user's. Two kinds of files:
///   CSV   columns wavelength_um or wavelength_nm, and reflectance or emissivity (1 - reflectance)
///   ENVI  spectral library (.sli with its .hdr): the spectrum called `name`, or the only one; header keys samples, lines,
///         data type (4, 5), byte order, wavelength, wavelength units, spectra names, reflectance scale factor, data ignore
///         value (such samples are left out)
/// Wavelengths ascend or descend. Throws an input error naming file and line, sample or header key: unknown columns, values
/// outside 0..1 (with a hint for percent), wavelengths out of order or outside 0.1..1000 um, truncated library, no such spectrum.
Spectrum load_reflectance(const std::filesystem::path& path, const std::string& name);

/// Stretches of a spectrum (lower, upper wavelength) without samples: more than 10 times its usual step and 5 % of the wavelength.
std::vector<std::array<double, 2>> gaps_um(const Spectrum& spectrum);

/// Adds spectra to a library under the user's names; one of a known name replaces it.
void add_spectra(SurfaceLibrary& library, const std::map<std::string, std::filesystem::path>& files);

/// Throws an input error naming the spectrum unless it covers a range of wavelengths (within 0.1 %).
void check_coverage(const SurfaceLibrary& library, const std::string& name, double lower_um, double upper_um);

}  // namespace pyroscene::radiometry
