#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>

/// Landscape files of FARSITE and FlamMap (LCP, version 4) and of LANDFIRE (GeoTIFF): one file with terrain, fuel and canopy.
namespace pyroscene::gis {

/// Their bands, from 1. The first five are always there.
enum LandscapeBand { kElevation = 1, kSlope, kAspect, kFuelModel, kCanopyCover, kCanopyHeight, kCanopyBase, kCanopyDensity };

struct Landscape {
    std::filesystem::path
        raster;  ///< name of the same bands in memory, with CRS, nodata, units and scales that every reader honours
    int bands = 0;
    std::set<int> fuel_codes;  ///< that occur
    std::string slope_note;  ///< what is wrong with the slope band, which nothing else uses; empty = it fits the elevations
};

/// Opens a landscape. Units come from the file (band metadata of an LCP, unit tags of a GeoTIFF, "m*10" included), else they are LANDFIRE's:
/// m, degrees, degrees, code, per cent, m x 10, m x 10, kg/m3 x 100; nodata is -9999 where the file does not say.
/// \param crs  of a file that does not say its own (an LCP without .prj); empty = none
/// Input errors naming file and band: fewer than 5 bands, no or another CRS, horizontal unit of the header against the CRS, unknown
/// units, values that cannot be (an elevation outside -500 to 9000 m, cover above 100 %, trees above 150 m).
Landscape open_landscape(const std::filesystem::path& file, const std::string& crs);

/// Name of a raster in memory with a value for each code of the fuel band, 0 for codes that are not listed.
std::filesystem::path raster_of_codes(const Landscape& landscape, const std::map<int, double>& value_of_code,
                                      const std::string& unit);

}  // namespace pyroscene::gis
