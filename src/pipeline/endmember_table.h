#pragma once

#include <filesystem>
#include <vector>

#include "analysis/unmix.h"
#include "gis/image_stream.h"

namespace pyroscene::pipeline {

/// Spectra of a table at the bands of an image. The table has a column `band` (counted from 1), `wavelength_um` or
/// `wavelength_nm`, and one column per spectrum in the unit of the image. Rows that lie at the image's wavelengths (to a tenth of
/// a band's width) are taken as they are; otherwise the spectra are averaged over a Gaussian of each band's FWHM, or interpolated
/// where the image does not tell it. An image without any wavelength takes a table of as many rows as it has bands, in order. Throws an input error naming file and column: wrong number of rows, wavelengths that the
/// image lacks or the table does not cover, no spectrum.
analysis::Endmembers read_endmembers(const std::filesystem::path& table, const gis::ImageInfo& image);

/// Standard deviation of the noise per band from a table with the same first column and a column `noise`.
std::vector<double> read_noise(const std::filesystem::path& table, const gis::ImageInfo& image);

/// The inverse of read_endmembers().
void write_endmembers(const std::filesystem::path& table, const analysis::Endmembers& library, const gis::ImageInfo& image);

}  // namespace pyroscene::pipeline
