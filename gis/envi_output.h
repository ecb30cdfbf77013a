#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/map_grid.h"

namespace pyroscene::gis {

/// What an ENVI header says of its cube.
struct EnviHeader {
    int samples = 0, lines = 0, bands = 0;
    std::string description{};
    std::vector<std::string> band_names{};
    std::vector<double> wavelength_nm{}, fwhm_nm{};  ///< one per band, or none
    std::optional<double> ignore_value{};
    std::optional<MapGrid> grid{};  ///< `map info` and `coordinate system string`
    std::vector<std::array<std::string, 2>> more{};
};

/// Gives one line as [sample][band].
template <class T>
using EnviLine = std::function<void(int line, std::span<T> pixels)>;

/// Writes a cube interleaved by pixel (BIP), most significant byte first, and its header `path`.hdr, both atomically and line
/// by line. T is std::int16_t, std::int32_t, float or double. Throws a runtime error naming the file.
template <class T>
void write_envi(const std::filesystem::path& path, const EnviHeader& header, const EnviLine<T>& line);

/// Writes a cube whose pixels are those of another that write_envi() wrote with as many bands: pixel `source(line, sample)`
/// (counted along its lines), or `fill` in all bands where that is negative. Memory does not grow with the cubes.
template <class T>
void write_envi_rearranged(const std::filesystem::path& path, const EnviHeader& header, const std::filesystem::path& cube,
                           T fill, const std::function<std::ptrdiff_t(int line, int sample)>& source);

}  // namespace pyroscene::gis
