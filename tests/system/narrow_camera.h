#pragma once

#include <filesystem>
#include <functional>

#include "radiometry/atmosphere.h"

namespace pyroscene::test {

/// A framing camera of 40 x 40 pixels, 1 m wide from 1 km, whose bands lie where air is clear.
struct Band {
    const char* id;
    double lower_um, upper_um;
};
inline constexpr Band kNarrowBands[] = {
    {"RED", 0.64, 0.68}, {"SWIR", 1.55, 1.75}, {"MWIR", 3.8, 4.05}, {"LWIR", 10.2, 11.4}};
void write_narrow_camera(const std::filesystem::path& file);

/// Mid-latitude summer, visibility 23 km, as a scenario over ground of that height takes it.
radiometry::AtmosphereSet shipped_atmosphere(double ground_elevation_m);

/// Mean over a box of a product of quantities that are linear between the table's samples.
double band_mean(const radiometry::AtmosphericTerms& air, const Band& band,
                 const std::function<double(double lambda_um, const std::function<double(const std::vector<double>&)>&)>& f);

}  // namespace pyroscene::test
