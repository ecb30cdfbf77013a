#include "pipeline/spectrum_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "base/files.h"
#include "drawing/line_plot.h"

namespace pyroscene::pipeline {
namespace {

/// Positions of the bands by wavelength: channels of spectrometers that overlap are not in order.
std::vector<std::size_t> by_wavelength(const PixelSpectrum& s) {
    std::vector<std::size_t> order(s.bands.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return s.bands[a]->centre_um < s.bands[b]->centre_um; });
    return order;
}

}  // namespace

void write_spectrum_table(const std::filesystem::path& path, const PixelSpectrum& s) {
    std::string text = "band,wavelength_um,fwhm_um,radiance_W_m2_sr_um,brightness_temperature_K\n";
    for (const std::size_t b : by_wavelength(s)) {
        const float T_K = s.brightness_temperature_K[b];
        text += fmt::format("{},{:.6g},{:.4g},{:.7g},{}\n", s.bands[b]->id, s.bands[b]->centre_um, s.bands[b]->fwhm_um,
                            s.radiance_W_m2_sr_um[b], std::isfinite(T_K) ? fmt::format("{:.6g}", T_K) : "");
    }
    write_text_file(path, text);
}

void write_spectrum_plot(const std::filesystem::path& path, const PixelSpectrum& s) {
    drawing::PlotSeries radiance{"", {}, {}}, temperature{"", {}, {}};
    for (const std::size_t b : by_wavelength(s)) {
        for (auto* series : {&radiance, &temperature}) series->x.push_back(s.bands[b]->centre_um);
        radiance.y.push_back(s.radiance_W_m2_sr_um[b]);
        temperature.y.push_back(s.brightness_temperature_K[b]);
    }
    const drawing::PlotAxis wavelength{"wavelength, um", false, {}, {}};
    const auto diagram = [&](const std::string& title, const char* unit, const drawing::PlotSeries& series) {
        return drawing::LinePlot{title, wavelength, {unit, false, {}, {}}, {series}, 900, 360, {}};
    };
    std::vector<drawing::LinePlot> plots{diagram(s.title, "radiance, W m-2 sr-1 um-1", radiance)};
    if (std::any_of(temperature.y.begin(), temperature.y.end(), [](double v) { return std::isfinite(v); }))
        plots.push_back(diagram("", "brightness temperature, K", temperature));
    drawing::write_line_plots(path, plots);
}

}  // namespace pyroscene::pipeline
