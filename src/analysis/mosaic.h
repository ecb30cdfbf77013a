#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/ortho.h"

namespace pyroscene::analysis {

/// Which of several images a map cell shows.
enum class MosaicRule { NearestNadir, Latest, Earliest };

/// Images of one sensor on one map grid, merged cell by cell: which image each cell shows. Add them one after another; the
/// first of equals stays.
struct Mosaic {
    MapGrid grid;
    std::vector<float> member;           ///< number of the image, from 1; NaN = none
    std::vector<float> time_s;           ///< when the pixel was taken
    std::vector<float> view_zenith_deg;  ///< under which it was seen
};
Mosaic empty_mosaic(const MapGrid& grid);

/// One image: where its pixels lie on the mosaic's grid, and planes in sensor geometry, [line][sample].
struct MosaicMember {
    const OrthoLookup& lookup;
    int samples = 0, lines = 0;
    std::span<const float> view_zenith_deg, time_s;
};
/// Shows the image where it sees the ground and the rule prefers it, by time and zenith of the nearest pixel.
/// \param number  of the image, from 1
void add_to_mosaic(Mosaic& mosaic, const MosaicMember& member, MosaicRule rule, int number);

/// Puts one plane [line][sample] of image `number`, bilinear, into the cells of `band` [row][col] that show it.
void fill_from_member(const Mosaic& mosaic, const MosaicMember& member, int number, std::span<const float> plane,
                      std::span<float> band);

}  // namespace pyroscene::analysis
