#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/fire_detection.h"

namespace pyroscene::analysis {

/// A number computed from two or three bands of a pixel.
struct SpectralIndex {
    enum class Kind {
        NormalisedDifference,  ///< (a - b) / (a + b)
        Ratio,                 ///< a / b
        Difference,            ///< a - b
        Absorption,            ///< a / (share b + (1 - share) c): depth of a band against both sides of it
        Contrast               ///< (a - k) / k, k on the straight line from b to c at the wavelength of a
    };
    struct Band {
        double best_um = 0.0, tolerance_um = 0.0;
    };
    std::string_view name{};
    Kind kind = Kind::Ratio;
    int bands = 2;
    std::array<Band, 3> band{};
    double share = 0.0;         ///< of b, for Absorption
    bool reflectance = false;   ///< of reflectances; else of radiances
    bool of_fire = false;       ///< fires raise it: detect_by_index() is meant for it
    double least_excess = 0.0;  ///< of a fire above the scene, in the unit of the index, whatever the scatter
    double least_value = -1e9;  ///< no fire lies below, whatever the scene
    std::string_view formula{}, source{};
};

/// All there are: ndvi, nbr (reflectances); hfdi, co2, k-line, akbd, aviris-k, aviris-co2 (radiances, fire).
std::span<const SpectralIndex> spectral_indices() noexcept;
const SpectralIndex* find_spectral_index(std::string_view name) noexcept;

/// The index of every pixel. \param planes, centre_um  one per band of the index. NaN where a band has no data or a
/// denominator is not above zero.
std::vector<float> spectral_index(const SpectralIndex& index, std::span<const std::span<const float>> planes,
                                  std::span<const double> centre_um);

/// Standard deviation of the index from independent noise of its bands, to first order. \param noise  standard deviations, shaped like
/// the planes
std::vector<float> spectral_index_noise(const SpectralIndex& index, std::span<const std::span<const float>> planes,
                                        std::span<const std::span<const float>> noise, std::span<const double> centre_um);

/// Middle and scatter of a scene that few pixels disturb: median and 1.4826 x median distance from it (the standard deviation of
/// normal values). NaN is left out.
struct RobustStatistics {
    double median = 0.0, deviation = 0.0;
};
RobustStatistics robust_statistics(std::span<const float> values);

/// When an index is fire.
struct IndexRule {
    std::optional<double>
        threshold{};  ///< default by day: median of the scene + max(`deviations` x its scatter, least excess of the
                      ///< index), but not below its least value; by night, when all that is lit is lit by fire:
                      ///< least value + least excess, and above the least value by `deviations` x the noise of the pixel
    double deviations = 6.0;
    bool night = false;
};

/// An index of a scene, pixel by pixel. Empty where nothing is known but the values.
struct IndexScene {
    std::span<const float> values{};
    std::span<const float> noise{};              ///< standard deviation of a value
    std::span<const unsigned char> dark{};       ///< 1 = too dark for an index
    std::span<const unsigned char> burnt_out{};  ///< 1 = all bands at their limit, and no sunlit ground reaches that
};

/// Fire where the index lies above the threshold; nominal, and high above twice its distance from the median. Confidence 50 to 100 %.
/// Where the detector is at its limit the index says nothing, and the pixel is fire with high confidence. NaN: not processed, or
/// without fire where `dark`.
struct IndexDetection {
    Detection result;
    RobustStatistics scene;
    double threshold = 0.0;
};
IndexDetection detect_by_index(const IndexScene& scene, const SpectralIndex& index, const IndexRule& rule);

/// Burn severity from dNBR = NBR before - NBR after: Key and Benson 2006 (FIREMON, table LA-1). Class 0 = no data.
struct SeverityClass {
    std::string_view name;
    double below;  ///< dNBR
};
std::span<const SeverityClass> severity_classes() noexcept;  ///< ascending; the last one has no upper end
/// \return for each pixel 1 + position in severity_classes(), 0 for NaN
std::vector<unsigned char> burn_severity(std::span<const float> dnbr);
/// Relative dNBR, dNBR / sqrt(|NBR before|) (Miller and Thode 2007 in units of NBR); NaN where |NBR before| is below 0.001.
std::vector<float> relative_dnbr(std::span<const float> dnbr, std::span<const float> nbr_before);

}  // namespace pyroscene::analysis
