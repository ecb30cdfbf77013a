#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pyroscene::drawing {

/// A colour at a value, "#rrggbb"; between two of them colours are interpolated.
struct ColourStop {
    double value = 0.0;
    std::string colour;
};

/// How QGIS shows one band of a raster.
struct RasterStyle {
    int band = 1;  ///< from 1
    std::string unit;
    std::vector<ColourStop> stops;  ///< ascending
};

/// The colour and name of a class.
struct ClassStyle {
    int value = 0;
    std::string colour, name;
};

/// Inferno (Smith and van der Walt 2015) from low to high.
std::vector<ColourStop> inferno(double low, double high);
/// Steps of fire radiative power from yellow to dark red: 0, 1/5 ... 5/5 of `high`.
std::vector<ColourStop> power_ladder(double high);

/// Range of radiances that is the same for every image of a band: in the thermal infrared (from 3 um on) of black bodies of 280 and
/// 700 K, below that from 0 to sunlight from a surface that reflects half of it.
std::vector<ColourStop> radiance_colours(double wavelength_um);

/// Writes NAME.qml beside NAME.tif, which QGIS applies when it opens the raster.
void write_qgis_style(const std::filesystem::path& raster, const RasterStyle& style);
/// The same for a raster of classes; classes without an entry are not shown.
void write_qgis_style(const std::filesystem::path& raster, const std::vector<ClassStyle>& classes);

}  // namespace pyroscene::drawing
