#pragma once

#include <vector>

namespace pyroscene::scenario {

/// The moments of a fire that the program computes, and how its fuel burns out.
struct FireFrames {
    std::vector<double> times_s;        ///< of the heat flux, ascending; the last is the end
    double mean_over_s = 6.0;           ///< the flux of a frame is the mean over so many seconds before it
    double coarse_burn_time_s = 300.0;  ///< e-folding time of 10-h and 100-h fuel
};

}  // namespace pyroscene::scenario
