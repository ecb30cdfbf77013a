#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pyroscene::imagery {

/// Spectra as a file holds them.
struct SpectralLibrary {
    std::string path;
    bool by_band = false;   ///< x counts bands from 1; else wavelengths [um]
    std::vector<double> x;  ///< ascending
    std::vector<std::string> names;
    std::vector<std::vector<double>> spectra;  ///< [spectrum][x]
};

/// Reads a library: a CSV table with a column `wavelength_um`, `wavelength_nm` or `band` and one column per spectrum, or, by the
/// ending .sli (or the header's .hdr), an ENVI spectral library (header beside it: name.hdr or name.sli.hdr; any number type and
/// byte order; wavelength units nm or um; spectra are sorted by wavelength).
/// Throws an input error naming file and key: no abscissa, wavelengths that repeat, data shorter than the header says.
SpectralLibrary read_spectral_library(const std::filesystem::path& path);

}  // namespace pyroscene::imagery
