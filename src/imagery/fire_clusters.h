#pragma once

#include <optional>
#include <vector>

#include "analysis/frp.h"
#include "gis/pixel_positions.h"
#include "imagery/image_channels.h"
#include "radiometry/planck.h"

namespace pyroscene::imagery {

/// The two-band method with the bands of an image.
class TwoBands {
public:
    TwoBands(const Channel& mir, const Channel& tir) : mir_(mir), tir_(tir), thermometer_(tir.response) {}
    struct Radiances {
        double mir = 0.0, tir = 0.0, mir_background = 0.0, tir_background = 0.0;
    };
    [[nodiscard]] analysis::Bispectral solve(const Radiances& r, double mir_noise, double tir_noise) const;

private:
    const Channel &mir_, &tir_;
    radiometry::BandThermometer thermometer_;
};

/// A group of touching fire pixels.
struct FireCluster {
    int pixels = 0;
    double lon_deg = 0.0, lat_deg = 0.0;  ///< centre weighted with power
    double frp_MW = 0.0, area_ha = 0.0;   ///< sum of its pixels; ground area
    analysis::Bispectral mean;            ///< of the mean radiances of the group (two bands); not solved without
};

/// What groups are made from; planes are [line][sample].
struct ClusterInput {
    const gis::PixelPositions& where;
    const std::vector<unsigned char>& fire;
    const std::vector<float>& frp_MW;  ///< NaN = none
    // For the two-band method on groups; null = not wanted.
    const Channel *mir = nullptr, *tir = nullptr;
    const std::vector<float>*mir_background = nullptr, *tir_background = nullptr;
    double mir_noise = 0.0, tir_noise = 0.0;
};

/// Groups of fire pixels that touch by an edge or a corner, strongest first. The two-band method on the mean radiances of a group is
/// BIRD's way: errors of registration and of the point spread between two bands cancel in the mean, and noise falls with the root of
/// the number of pixels (Zhukov et al. 2006, Remote Sens. Environ. 100:29).
std::vector<FireCluster> fire_clusters(const ClusterInput& input);

}  // namespace pyroscene::imagery
