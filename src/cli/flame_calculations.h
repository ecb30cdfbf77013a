#pragma once

#include "cli/calc.h"

namespace pyroscene::cli {

/// `calc flame-height`: every row of the flame-height table.
Calculation flame_height_calculation();

/// `calc flame-tilt`: every row of the tilt table.
Calculation flame_tilt_calculation();

/// `calc thesis-potassium`: appendix A as printed.
Calculation thesis_potassium_calculation();
/// `calc alkali-width`.
Calculation alkali_width_calculation();

}  // namespace pyroscene::cli
