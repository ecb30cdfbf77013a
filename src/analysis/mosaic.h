#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/ortho.h"

namespace pyroscene::analysis {

/// Which of several images a map cell shows.
enum class MosaicRule { NearestNadir, Latest, Earliest };

/// Images of one sensor on one map grid, merged cell by cell. Add them one after another; the first of equals stays.
struct Mosaic {
    MapGrid grid;
    std::size_t band_count = 0;
    std::vector<float> pixels;           ///< [band][row][col]; NaN = no image sees the cell
    std::vector<float> member;           ///< number of the image, from 1; NaN = none
    std::vector<float> time_s;           ///< when the pixel was taken
    std::vector<float> view_zenith_deg;  ///< under which it was seen
};
Mosaic empty_mosaic(const MapGrid& grid, std::size_t band_count);

/// One image: its planes in sensor geometry, [band][line][sample] and [line][sample].
struct MosaicMember {
    const OrthoLookup& lookup;  ///< on the mosaic's grid
    int samples = 0, lines = 0;
    std::span<const float> pixels;
    std::span<const float> view_zenith_deg, time_s;
};
/// Shows the image where it sees the ground and the rule prefers it. Pixels are bilinear, time and zenith those of the nearest
/// pixel. \param number  of the image, from 1
void add_to_mosaic(Mosaic& mosaic, const MosaicMember& member, MosaicRule rule, int number);

}  // namespace pyroscene::analysis
