#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/unmix.h"
#include "gis/image_stream.h"

namespace pyroscene::imagery {

/// Spectra of a library (pipeline/spectral_library.h: CSV or ENVI .sli), in the unit of the image, at its bands. Rows that lie at
/// the image's wavelengths (to a tenth of a band's width) are taken as they are; otherwise the spectra are averaged over each band's
/// response (`sensor`, else the shipped sensor that the image names), over a Gaussian of its FWHM where no response is known, or
/// interpolated where the image tells no width either. An image without any wavelength takes a table of as many rows as it has
/// bands, in order. Throws an input error naming file and column: wrong number of rows, wavelengths that the image lacks or
/// the library does not cover, no spectrum.
analysis::Endmembers read_endmembers(const std::filesystem::path& table, const std::filesystem::path& image_path,
                                     const gis::ImageInfo& image, const std::optional<std::string>& sensor);

/// Standard deviation of the noise per band from a table with the same first column and a column `noise`.
std::vector<double> read_noise(const std::filesystem::path& table, const std::filesystem::path& image_path,
                               const gis::ImageInfo& image);

/// The inverse of read_endmembers().
void write_endmembers(const std::filesystem::path& table, const analysis::Endmembers& library, const gis::ImageInfo& image);

}  // namespace pyroscene::imagery
