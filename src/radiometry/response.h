#pragma once

#include <array>
#include <string_view>

#include "base/spectrum.h"

namespace pyroscene::radiometry {

/// Throws an input error about `subject` unless the response is a usable polyline: at least two points, wavelengths finite,
/// positive and not descending, values finite and not negative, area > 0.
void check_response(const Spectrum& response, std::string_view subject);

/// Area under the polyline [um].
double response_area_um(const Spectrum& response) noexcept;

/// Exact moments  int_{lower}^{upper} R(lambda) u^k dlambda, k = 0..3, with u = (lambda - centre) / half width of the
/// interval, so u runs from -1 to 1 and no digits cancel. The response is zero outside its points.
std::array<double, 4> response_moments(const Spectrum& response, double lower_um, double upper_um) noexcept;

/// The part of the response within [lower_um, upper_um], which must lie within its points. A vertical edge at a limit keeps
/// the side that belongs to the part.
Spectrum clip_response(const Spectrum& response, double lower_um, double upper_um);

}  // namespace pyroscene::radiometry
