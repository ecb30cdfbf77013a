#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/unmix.h"

namespace pyroscene::imagery {

/// What `pyroscene unmix` was asked for.
struct UnmixJob {
    std::filesystem::path image;  ///< any raster with as many bands as the library knows wavelengths for
    std::optional<std::filesystem::path>
        endmembers;  ///< CSV: wavelength_um (or wavelength_nm, or band), then a column per spectrum; or ENVI .sli
    std::optional<std::string> sensor;           ///< whose responses average finer spectra; default: as the image says
    std::optional<std::filesystem::path> truth;  ///< truth.tif of the same image: endmembers if none are given, and scores
    std::optional<std::filesystem::path> noise;  ///< CSV: wavelength_um or band, noise
    double pure_fraction = 0.98;                 ///< pixels of truth with so much of one class make its mean spectrum
    std::optional<double> purest_fraction;       ///< classes without such pixels: their purest ones, if they hold so much
    analysis::UnmixSettings settings;
    std::filesystem::path output;  ///< GeoTIFF, a COG where the image lies on a map
    int threads = 0;               ///< 0 = all cores
    std::function<void(double fraction_done)> on_progress;
    const std::atomic<bool>* cancelled = nullptr;
};

/// How well the fractions of one class agree with the truth.
struct FractionScore {
    std::string name;
    std::int64_t pixels = 0;
    double rms_error = 0.0, mean_error = 0.0;
};

struct UnmixReport {
    analysis::Endmembers library;
    std::int64_t pixels = 0, unexplained = 0;
    std::vector<double> chosen_percent;  ///< [endmember] of the pixels with data
    std::vector<FractionScore> scores;   ///< of endmembers that the truth has under the same name
};

/// Unmixes an image in blocks of lines: one thread reads while the others compute. Output bands: the fraction of each
/// endmember, residual_rms, chosen, unexplained (see analysis::UnmixOutput), then, with a truth, the true fraction of each endmember that it knows.
/// Beside the output: <output>_endmembers.csv with endmembers that came from the truth, <output>_scores.csv with the errors against it.
/// Throws an input error: neither endmembers nor truth, spectra that do not cover the bands, truth of another size.
UnmixReport unmix_image(const UnmixJob& job);

}  // namespace pyroscene::imagery
