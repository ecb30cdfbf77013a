#include "pipeline/endmember_table.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/error.h"
#include "base/files.h"

namespace pyroscene::pipeline {
namespace {

/// A table's abscissa: band numbers, or wavelengths in micrometres.
struct Abscissa {
    std::string column;
    bool is_band = false;
    std::vector<double> values;
};

Abscissa abscissa_of(const CsvTable& table) {
    for (const auto& [column, per_um] :
         {std::pair{"wavelength_um", 1.0}, std::pair{"wavelength_nm", 1e-3}, std::pair{"band", 0.0}}) {
        if (!table.has(column)) continue;
        Abscissa x{column, per_um == 0.0, table.numbers(column)};
        if (!x.is_band)
            for (double& v : x.values) v *= per_um;
        if (!std::is_sorted(x.values.begin(), x.values.end()))
            throw input_error(table.path, fmt::format("column '{}' must ascend", column));
        return x;
    }
    throw input_error(table.path, "no column 'wavelength_um', 'wavelength_nm' or 'band'");
}

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

std::vector<double> at_bands(const CsvTable& table, const Abscissa& x, const std::string& column,
                             const gis::ImageInfo& image) {
    const std::vector<double> y = table.numbers(column);
    const auto n = image.bands.size();
    if (x.is_band) {
        if (y.size() != n) throw input_error(table.path, fmt::format("{} bands, the image has {}", y.size(), n));
        for (std::size_t b = 0; b < n; ++b)
            if (x.values[b] != static_cast<double>(b + 1))
                throw input_error(table.path,
                                  fmt::format("column 'band' holds {} where {} is expected", x.values[b], b + 1));
        return y;
    }
    const bool nameless = std::none_of(image.bands.begin(), image.bands.end(),
                                       [](const auto& band) { return band.wavelength_um.has_value(); });
    if (nameless && y.size() == n) return y;
    for (std::size_t b = 0; b < n; ++b)
        if (!image.bands[b].wavelength_um)
            throw input_error(
                table.path, fmt::format("gives wavelengths, but band {} of the image has none; use a column 'band'", b + 1));
    const auto same = [&](std::size_t b) {
        return std::abs(x.values[b] - *image.bands[b].wavelength_um) <= tolerance_um(image.bands[b]);
    };
    bool all_same = y.size() == n;
    for (std::size_t b = 0; all_same && b < n; ++b) all_same = same(b);
    if (all_same) return y;
    std::vector<double> out;
    for (std::size_t b = 0; b < n; ++b) {
        const auto& band = image.bands[b];
        if (y.size() < 2 || *band.wavelength_um < x.values.front() || *band.wavelength_um > x.values.back())
            throw input_error(table.path,
                              fmt::format("does not cover band {} of the image at {:.4g} um", b + 1, *band.wavelength_um));
        out.push_back(band.fwhm_um && *band.fwhm_um > 0.0 ? gaussian_mean(x.values, y, *band.wavelength_um, *band.fwhm_um)
                                                          : interpolated(x.values, y, *band.wavelength_um));
    }
    return out;
}

}  // namespace

analysis::Endmembers read_endmembers(const std::filesystem::path& path, const gis::ImageInfo& image) {
    const CsvTable table = read_csv(path);
    const Abscissa x = abscissa_of(table);
    analysis::Endmembers library{{}, static_cast<int>(image.bands.size()), {}};
    for (const auto& column : table.columns) {
        if (column == x.column || column == "wavelength_um" || column == "wavelength_nm" || column == "fwhm_um" ||
            column == "band")
            continue;
        const auto spectrum = at_bands(table, x, column, image);
        library.names.push_back(column);
        library.spectra.insert(library.spectra.end(), spectrum.begin(), spectrum.end());
    }
    if (library.names.empty()) throw input_error(table.path, "no column with a spectrum");
    return library;
}

std::vector<double> read_noise(const std::filesystem::path& path, const gis::ImageInfo& image) {
    const CsvTable table = read_csv(path);
    return at_bands(table, abscissa_of(table), "noise", image);
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

}  // namespace pyroscene::pipeline
