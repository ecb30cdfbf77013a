#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

namespace pyroscene::analysis {

/// Coefficient of the power law L = a T^4 that fits black-body band radiances best: least squares without weights
///   a = sum L T^4 / sum T^8                                                    [W m-2 sr-1 um-1 K-4]
/// Source: Wooster et al. 2003 and 2005; thesis eq 6.4. Fitted over 650 to 1350 K it is 3.150e-9 for BIRD (3.4-4.2 um), 2.919e-9
/// for MODIS band 21; the law is up to 35 % off outside the middle of its range (600 K: -37 %).
double power_law_coefficient(std::span<const double> temperature_K, std::span<const double> radiance) noexcept;

/// Coefficients in the literature.
struct PublishedCoefficient {
    std::string_view name;
    double a_W_m2_sr_um_K4;
};
std::span<const PublishedCoefficient> published_coefficients() noexcept;

/// Fire radiative power per ground area by the MIR radiance method (thesis eq 6.6 with the background and the air it leaves out)
///   FRP = sigma / a (L - L_background) / tau                                   [W m-2]
double frp_mir_W_m2(double radiance, double background, double a, double transmittance) noexcept;

/// What the two-band method says of one pixel.
struct Bispectral {
    bool solved = false;
    double fraction = 0.0, temperature_K = 0.0, frp_W_m2 = 0.0;
    /// Standard deviations by linear propagation of the noise of both radiances; and the correlation of fraction and temperature.
    double fraction_sd = 0.0, temperature_sd_K = 0.0, frp_sd_W_m2 = 0.0, correlation = 0.0;
};

/// One pixel in two bands.
struct BispectralInput {
    double mir = 0.0, tir = 0.0;                        ///< radiances of the pixel, atmosphere taken out
    double mir_background = 0.0, tir_background = 0.0;  ///< of its surroundings
    double background_K = 300.0;
    double mir_noise = 0.0, tir_noise = 0.0;  ///< standard deviations, background included
};

/// Dozier 1981: L_i = p B_i(T) + (1 - p) L_background,i in both bands; T is bracketed in [400, 1800] K.
/// FRP = p sigma (T^4 - T_background^4). Not solved: radiance at or below the background, p outside (0, 1], no T in the bracket.
/// \param mir, tir  band radiance of a black body of a temperature [K]; must grow with it
Bispectral bispectral(const BispectralInput& in, const std::function<double(double)>& mir,
                      const std::function<double(double)>& tir);

/// Surroundings of fire pixels.
struct Background {
    double mean = 0.0, mean_absolute_deviation = 0.0;
    int pixels = 0;  ///< 0: no window had enough
};

/// Statistics of valid pixels that are no fire in the smallest window of 5 x 5 to 21 x 21 pixels around one that has at least
/// 8 of them and a quarter of its area; neighbours next to the pixel are left out, because its power spills into them.
Background background_around(std::span<const float> plane, std::span<const unsigned char> fire, int samples, int lines,
                             int sample, int line) noexcept;

/// Mean of all valid pixels that are no fire: for pixels inside fires too large for any window.
Background background_of_all(std::span<const float> plane, std::span<const unsigned char> fire) noexcept;

/// Fire pixels by contrast in the MIR: brightness temperature above `least_K`, and above the mean of the surroundings by 6 K and by
/// 3.5 mean absolute deviations; or above 360 K. Two passes: what the first finds is no background in the second.
std::vector<unsigned char> fire_pixels(std::span<const float> brightness_temperature_K, int samples, int lines,
                                       double least_K);

}  // namespace pyroscene::analysis
