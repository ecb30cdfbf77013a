#include "fire/fireline_laws.h"

#include <cmath>

namespace pyroscene::fire {
namespace {

/// a I^b with I in kW m-1.
double power_law_m(const FlameHeightInputs& in, double a, double b) noexcept {
    if (!(in.fireline_intensity_W_m > 0.0)) return 0.0;  // also catches NaN
    return a * std::pow(1e-3 * in.fireline_intensity_W_m, b);
}

constexpr double kTwoThirds = 2.0 / 3.0;

}  // namespace

double flame_length_byram_m(const FlameHeightInputs& in) noexcept { return power_law_m(in, 0.0775, 0.46); }
double flame_length_weise_biging_m(const FlameHeightInputs& in) noexcept { return power_law_m(in, 0.016, 0.70); }
double flame_length_thomas_m(const FlameHeightInputs& in) noexcept { return power_law_m(in, 0.0266, kTwoThirds); }
double flame_length_nelson_adkins_m(const FlameHeightInputs& in) noexcept { return power_law_m(in, 0.0475, 0.493); }
double flame_length_nelson_lab_m(const FlameHeightInputs& in) noexcept { return power_law_m(in, 0.0142, kTwoThirds); }
double flame_length_nelson_field_m(const FlameHeightInputs& in) noexcept { return power_law_m(in, 0.0155, kTwoThirds); }
double flame_length_butler_m(const FlameHeightInputs& in) noexcept { return power_law_m(in, 0.0175, kTwoThirds); }
double flame_length_clark_m(const FlameHeightInputs& in) noexcept { return power_law_m(in, 0.000722, 0.9934); }
double flame_length_fernandes_m(const FlameHeightInputs& in) noexcept { return power_law_m(in, 0.045, 0.543); }

double flame_length_finney_grumstrup_m(const FlameHeightInputs& in) noexcept {
    if (!(in.front_depth_m > 0.0)) return 0.0;
    return power_law_m(in, 0.01051, 0.774) * std::pow(in.front_depth_m, -0.161);
}

}  // namespace pyroscene::fire
