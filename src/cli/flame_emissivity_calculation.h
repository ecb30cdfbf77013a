#pragma once

#include "cli/calc.h"

namespace pyroscene::cli {

/// `calc flame-emissivity`: emissivity and radiance of a homogeneous flame; with --plot over 0.35 to 15 um.
Calculation flame_emissivity_calculation();

}  // namespace pyroscene::cli
