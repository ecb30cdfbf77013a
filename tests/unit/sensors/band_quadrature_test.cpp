// Transport wavelengths of every band of every shipped sensor, through the air and the flame of a render, against 1 cm-1.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "band_reference.h"
#include "gis/netcdf_input.h"
#include "source_folder.h"

namespace pyroscene::sensors {
namespace {

class EverySensor : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(, EverySensor, testing::ValuesIn(sensor_ids()), [](const auto& test) {
    std::string name = test.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

TEST_P(EverySensor, BandsAreWithinHalfAPercent) {
    const auto data = source_folder() / "data";
    const auto optics = radiometry::load_flame_optics(data / "optical");
    const auto air = radiometry::make_atmosphere_set(
        "midlatitude_summer", 23.0, 0.0, [&](const std::string& file, const std::string& variable) {
            return gis::read_netcdf_variable(data / "atmosphere" / file, variable).values;
        });
    const Sensor sensor = load_sensor(GetParam());
    const auto errors = bench::quadrature_errors(sensor, optics, air);
    EXPECT_EQ(errors.size(), sensor.bands.size());
    for (const auto& e : errors)
        EXPECT_LT(std::abs(e.worst), 5e-3) << e.band->id << ", " << e.band->centre_um << " um, " << e.nodes
                                           << " wavelengths: " << bench::kReferenceScenes[std::max(e.scene, 0)];
}

}  // namespace
}  // namespace pyroscene::sensors
