#include "drawing/qgis_style.h"

#include <array>
#include <string_view>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/files.h"
#include "radiometry/planck.h"

namespace pyroscene::drawing {
namespace {

template <std::size_t N>
std::vector<ColourStop> evenly(const std::array<std::string_view, N>& colours, double low, double high) {
    std::vector<ColourStop> stops;
    for (std::size_t k = 0; k < N; ++k)
        stops.push_back({low + (high - low) * static_cast<double>(k) / (N - 1), std::string(colours[k])});
    return stops;
}

void write_renderer(std::filesystem::path raster, const std::string& renderer) {
    write_text_file(raster.replace_extension(".qml"),
                    "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n"
                    "<qgis version=\"3.22\" styleCategories=\"Symbology\">\n"
                    "  <pipe>\n" +
                        renderer + "  </pipe>\n</qgis>\n");
}

}  // namespace

std::vector<ColourStop> inferno(double low, double high) {
    constexpr std::array<std::string_view, 7> kColours{"#000004", "#320a5e", "#781c6d", "#bc3754",
                                                       "#ed6925", "#fbb61a", "#fcffa4"};
    return evenly(kColours, low, high);
}

std::vector<ColourStop> power_ladder(double high) {
    constexpr std::array<std::string_view, 6> kColours{"#ffffb2", "#fed976", "#feb24c", "#fd8d3c", "#f03b20", "#bd0026"};
    return evenly(kColours, 0.0, high);
}

std::vector<ColourStop> radiance_colours(double wavelength_um) {
    constexpr double kThermal_um = 3.0, kSun_K = 5772.0, kSunDisk_sr = 6.79e-5, kReflected = 0.5;
    if (wavelength_um >= kThermal_um)
        return inferno(radiometry::planck_radiance(wavelength_um, 280.0), radiometry::planck_radiance(wavelength_um, 700.0));
    return inferno(0.0, kReflected * kSunDisk_sr * radiometry::planck_radiance(wavelength_um, kSun_K) / kPi);
}

void write_qgis_style(const std::filesystem::path& raster, const RasterStyle& style) {
    const double low = style.stops.front().value, high = style.stops.back().value;
    std::string items;
    for (const auto& stop : style.stops)
        items += fmt::format("          <item value=\"{:.6g}\" color=\"{}\" alpha=\"255\" label=\"{:.6g} {}\"/>\n",
                             stop.value, stop.colour, stop.value, style.unit);
    write_renderer(
        raster, fmt::format("    <rasterrenderer type=\"singlebandpseudocolor\" band=\"{}\" opacity=\"1\" alphaBand=\"-1\" "
                            "classificationMin=\"{:.6g}\" classificationMax=\"{:.6g}\">\n"
                            "      <rastershader>\n"
                            "        <colorrampshader colorRampType=\"INTERPOLATED\" classificationMode=\"1\" clip=\"0\" "
                            "minimumValue=\"{:.6g}\" maximumValue=\"{:.6g}\">\n"
                            "{}"
                            "        </colorrampshader>\n"
                            "      </rastershader>\n"
                            "    </rasterrenderer>\n",
                            style.band, low, high, low, high, items));
}

void write_qgis_style(const std::filesystem::path& raster, const std::vector<ClassStyle>& classes) {
    std::string entries;
    for (const auto& c : classes)
        entries += fmt::format("        <paletteEntry value=\"{}\" color=\"{}\" alpha=\"255\" label=\"{}\"/>\n", c.value,
                               c.colour, c.name);
    write_renderer(
        raster, "    <rasterrenderer type=\"paletted\" band=\"1\" opacity=\"1\" alphaBand=\"-1\">\n      <colorPalette>\n" +
                    entries + "      </colorPalette>\n    </rasterrenderer>\n");
}

}  // namespace pyroscene::drawing
