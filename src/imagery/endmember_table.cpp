#include "imagery/endmember_table.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/files.h"
#include "imagery/sensor_of_image.h"
#include "imagery/spectral_library.h"
#include "radiometry/response.h"

namespace pyroscene::imagery {
namespace {

/// Half the width that counts as "the same wavelength".
double tolerance_um(const gis::OutputBand& band) { return band.fwhm_um ? 0.1 * *band.fwhm_um : 1e-3 * *band.wavelength_um; }

double interpolated(const std::vector<double>& x, const std::vector<double>& y, double at) {
    const auto next = std::upper_bound(x.begin(), x.end(), at);
    const auto j =
        static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(next - x.begin(), 1, static_cast<std::ptrdiff_t>(x.size()) - 1));
    const double f = (at - x[j - 1]) / (x[j] - x[j - 1]);
    return y[j - 1] + f * (y[j] - y[j - 1]);
}

/// Mean over a Gaussian response, 41 points over two and a half widths to either side.
double gaussian_mean(const std::vector<double>& x, const std::vector<double>& y, double centre, double fwhm) {
    constexpr int kPoints = 41;
    double sum = 0.0, weights = 0.0;
    for (int i = 0; i < kPoints; ++i) {
        const double t = 5.0 * i / (kPoints - 1) - 2.5, at = centre + t * fwhm;
        if (at < x.front() || at > x.back()) continue;
        const double weight = std::exp(-4.0 * std::log(2.0) * t * t);
        sum += weight * interpolated(x, y, at);
        weights += weight;
    }
    return sum / weights;
}

/// Mean over a band's response, exact for the polyline of the spectrum. NaN when the spectrum covers less than 99 % of the response.
double response_mean(const std::vector<double>& x, const std::vector<double>& y, const Spectrum& response) {
    double sum = 0.0, covered = 0.0;
    for (std::size_t i = 0; i + 1 < x.size(); ++i) {
        const auto moments = radiometry::response_moments(response, x[i], x[i + 1]);
        sum += 0.5 * (y[i] + y[i + 1]) * moments[0] + 0.5 * (y[i + 1] - y[i]) * moments[1];
        covered += moments[0];
    }
    constexpr double kEnough = 0.99;
    return covered >= kEnough * radiometry::response_area_um(response) ? sum / covered : std::nan("");
}

/// How spectra of a library come to the bands of an image: as they are, or as means over each band.
class Resampling {
public:
    Resampling(const SpectralLibrary& library, const std::filesystem::path& image_path, const gis::ImageInfo& image,
               const std::optional<std::string>& sensor)
        : library_(library), image_(image) {
        const auto n = image.bands.size(), rows = library.x.size();
        if (library.by_band) {
            if (rows != n) throw input_error(library.path, fmt::format("{} bands, the image has {}", rows, n));
            for (std::size_t b = 0; b < n; ++b)
                if (library.x[b] != static_cast<double>(b + 1))
                    throw input_error(library.path,
                                      fmt::format("column 'band' holds {} where {} is expected", library.x[b], b + 1));
            return;
        }
        const bool nameless = std::none_of(image.bands.begin(), image.bands.end(),
                                           [](const auto& band) { return band.wavelength_um.has_value(); });
        if (nameless && rows == n) return;
        for (std::size_t b = 0; b < n; ++b)
            if (!image.bands[b].wavelength_um)
                throw input_error(library.path, fmt::format("gives wavelengths, but band {} of the image has none; use a "
                                                            "column 'band'",
                                                            b + 1));
        as_they_are_ = rows == n;
        for (std::size_t b = 0; as_they_are_ && b < n; ++b)
            as_they_are_ = std::abs(library.x[b] - *image.bands[b].wavelength_um) <= tolerance_um(image.bands[b]);
        if (as_they_are_) return;
        if (const auto known = sensor_of_image(image, sensor))
            for (const auto& band : image.bands) responses_.push_back(band_of_image(*known, band, image_path).response);
    }

    [[nodiscard]] std::vector<double> at_bands(const std::vector<double>& y) const {
        if (as_they_are_) return y;
        const auto& x = library_.x;
        std::vector<double> out;
        for (std::size_t b = 0; b < image_.bands.size(); ++b) {
            const auto& band = image_.bands[b];
            double value = std::nan("");
            if (y.size() >= 2 && *band.wavelength_um >= x.front() && *band.wavelength_um <= x.back()) {
                if (!responses_.empty())
                    value = response_mean(x, y, responses_[b]);
                else if (band.fwhm_um && *band.fwhm_um > 0.0)
                    value = gaussian_mean(x, y, *band.wavelength_um, *band.fwhm_um);
                else
                    value = interpolated(x, y, *band.wavelength_um);
            }
            if (std::isnan(value))
                throw input_error(library_.path, fmt::format("does not cover band {} of the image at {:.4g} um", b + 1,
                                                             *band.wavelength_um));
            out.push_back(value);
        }
        return out;
    }

private:
    const SpectralLibrary& library_;
    const gis::ImageInfo& image_;
    bool as_they_are_ = true;
    std::vector<Spectrum> responses_;  ///< of the bands; empty when no sensor is known
};

}  // namespace

analysis::Endmembers read_endmembers(const std::filesystem::path& path, const std::filesystem::path& image_path,
                                     const gis::ImageInfo& image, const std::optional<std::string>& sensor) {
    const auto table = read_spectral_library(path);
    if (table.names.empty()) throw input_error(table.path, "no column with a spectrum");
    const Resampling resampling(table, image_path, image, sensor);
    analysis::Endmembers library{table.names, static_cast<int>(image.bands.size()), {}};
    for (const auto& values : table.spectra) {
        const auto spectrum = resampling.at_bands(values);
        library.spectra.insert(library.spectra.end(), spectrum.begin(), spectrum.end());
    }
    return library;
}

std::vector<double> read_noise(const std::filesystem::path& path, const std::filesystem::path& image_path,
                               const gis::ImageInfo& image) {
    const auto table = read_spectral_library(path);
    const auto noise = std::find(table.names.begin(), table.names.end(), "noise");
    if (noise == table.names.end())
        throw input_error(table.path, fmt::format("no column 'noise'; the table has {}", fmt::join(table.names, ", ")));
    return Resampling(table, image_path, image, {})
        .at_bands(table.spectra[static_cast<std::size_t>(noise - table.names.begin())]);
}

void write_endmembers(const std::filesystem::path& path, const analysis::Endmembers& library, const gis::ImageInfo& image) {
    const bool wavelengths = std::all_of(image.bands.begin(), image.bands.end(),
                                         [](const auto& band) { return band.wavelength_um.has_value(); }) &&
                             std::is_sorted(image.bands.begin(), image.bands.end(), [](const auto& a, const auto& b) {
                                 return *a.wavelength_um < *b.wavelength_um;
                             });
    std::string text = wavelengths ? "wavelength_um" : "band";
    for (const auto& name : library.names) text += "," + name;
    text += "\n";
    for (int b = 0; b < library.bands; ++b) {
        text += wavelengths ? fmt::format("{:.9g}", *image.bands[static_cast<std::size_t>(b)].wavelength_um)
                            : std::to_string(b + 1);
        for (int j = 0; j < library.count(); ++j) text += fmt::format(",{:.9g}", library.spectrum(j)[b]);
        text += "\n";
    }
    write_text_file(path, text);
}

}  // namespace pyroscene::imagery
