#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "sensors/sensor.h"

namespace pyroscene::pipeline {

/// The only pixel of an image, band by band.
struct PixelSpectrum {
    std::string title;
    std::vector<const sensors::Band*> bands;
    std::vector<float> radiance_W_m2_sr_um;       ///< per band
    std::vector<float> brightness_temperature_K;  ///< per band, NaN where the radiance has none
};

/// Table of the spectrum, by wavelength: band, wavelength_um, fwhm_um, radiance_W_m2_sr_um, brightness_temperature_K.
void write_spectrum_table(const std::filesystem::path& path, const PixelSpectrum& spectrum);
/// Diagrams of radiance and brightness temperature over wavelength (PNG).
void write_spectrum_plot(const std::filesystem::path& path, const PixelSpectrum& spectrum);

}  // namespace pyroscene::pipeline
