#pragma once

#include "cli/calc.h"

namespace pyroscene::cli {

/// `calc spread`: Rothermel's surface fire for one fuel, wind and slope.
Calculation spread_calculation();

}  // namespace pyroscene::cli
