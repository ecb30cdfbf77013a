#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "imagery/fire_clusters.h"

namespace pyroscene::imagery {

/// What `pyroscene frp` was asked for.
struct FrpJob {
    std::filesystem::path image;            ///< radiances, W m-2 sr-1 um-1, with wavelength metadata
    bool bispectral = false;                ///< else the MIR radiance method
    std::optional<int> mir_band, tir_band;  ///< from 1; default: the bands nearest 3.96 and 11 um
    std::optional<double> coefficient;      ///< a of L = a T^4; default: fitted to the band's response over 650 to 1350 K
    std::optional<std::string>
        sensor;  ///< whose responses the bands have; default: the shipped sensor that the image names, else boxcars of the FWHM
    double mir_transmittance = 1.0, tir_transmittance = 1.0;
    double mir_path = 0.0, tir_path = 0.0;  ///< path radiance, W m-2 sr-1 um-1
    bool subtract_background = true;
    double least_temperature_K = 310.0;  ///< MIR brightness temperature below which nothing is a fire
    double mir_noise = 0.0,
           tir_noise = 0.0;        ///< standard deviations of the radiances, for the errors of the bispectral method
    std::filesystem::path output;  ///< GeoTIFF; the tables go beside it
    const std::atomic<bool>* cancelled = nullptr;
};

struct FrpReport {
    std::string mir_band, tir_band;
    double coefficient_W_m2_sr_um_K4 = 0.0;
    std::int64_t fire_pixels = 0, unsolved = 0;
    double total_MW = 0.0;
    std::vector<FireCluster> fires;  ///< strongest first
};

/// Writes
///   <output>              GeoTIFF: FRP per area, FRP of the pixel [MW], fire mask; bispectral: fraction, temperature and their errors
///   <output>_pixels.csv   one row per fire pixel, columns in the order of NASA FIRMS
///   <output>_fires.csv    one row per group of touching fire pixels; bispectral: also the solution of the group's mean radiances with
///                         standard deviations and the correlation of fraction and temperature
/// The background of a pixel is the mean of its surroundings (analysis::background_around), or of all pixels without fire where a
/// fire is too large for that.
/// Throws an input error: no suitable band, no place on the Earth, unit of the band that is no spectral radiance.
FrpReport frp_image(const FrpJob& job);

}  // namespace pyroscene::imagery
