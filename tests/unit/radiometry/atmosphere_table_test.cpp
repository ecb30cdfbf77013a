#include "radiometry/atmosphere_table.h"

#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "base/error.h"
#include "test_data.h"

namespace pyroscene::radiometry {
namespace {

constexpr const char* kDefaultFile = "lowtran7_midlatitude_summer_rural23_ground0.nc";

TEST(AtmosphereTable, ReadsAShippedFile) {
    const auto t = load_table("lowtran7_midlatitude_summer_rural5_ground0.nc");
    EXPECT_EQ(t.visibility_km, 5.0);
    EXPECT_EQ(t.ground_elevation_km, 0.0);
    EXPECT_EQ(t.lambda_count(), 1047U);
    EXPECT_EQ(t.sensor_altitude_km.size(), 10U);
    EXPECT_NEAR(t.sensor_altitude_km[0], 0.15, 1e-6);
    EXPECT_EQ(t.view_zenith_deg, (std::vector<double>{0, 15, 30, 45, 55, 60, 65}));
    EXPECT_EQ(t.solar_zenith_deg, (std::vector<double>{0, 30, 45, 60, 75}));
}

TEST(AtmosphereTable, EveryShippedFilePassesTheCheckAndIsWhatItsNameSays) {
    int files = 0;
    for (const auto& model : atmosphere_models())
        for (const auto& file : atmosphere_files(model)) {
            SCOPED_TRACE(file.file);
            const auto t = load_table(file.file);
            EXPECT_EQ(t.visibility_km, file.visibility_km);
            EXPECT_EQ(t.ground_elevation_km, file.ground_km);
            ++files;
        }
    EXPECT_EQ(files, 15);
}

TEST(AtmosphereTable, CheckFindsWhatIsWrong) {
    const auto good = load_table(kDefaultFile);
    const auto refuses = [&](const std::string& variable, const std::function<void(AtmosphereTable&)>& spoil) {
        auto t = good;
        spoil(t);
        try {
            check(t);
            ADD_FAILURE() << "accepted: " << variable;
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::Input);
            EXPECT_NE(std::string(e.what()).find(variable), std::string::npos) << e.what();
        }
    };
    refuses("transmittance", [](auto& t) { t.transmittance[5] = 1.01F; });
    refuses("transmittance", [](auto& t) { t.transmittance.pop_back(); });
    refuses("path_thermal_radiance", [](auto& t) { t.path_thermal_radiance[7] = -1.0F; });
    refuses("path_solar_radiance", [](auto& t) { t.path_solar_radiance[7] = std::numeric_limits<float>::quiet_NaN(); });
    refuses("spherical_albedo", [](auto& t) { t.spherical_albedo[0] = 2.0F; });
    refuses("relative_azimuth", [](auto& t) { t.relative_azimuth_deg = {0.0, 60.0, 180.0}; });
    refuses("wavelength", [](auto& t) { t.wavelength_um[3] = t.wavelength_um[2]; });
    refuses("visibility", [](auto& t) { t.visibility_km = 0.0; });
    EXPECT_NO_THROW(check(good));
}

TEST(AtmosphereFiles, NeededFilesBracketTheConditions) {
    using Names = std::vector<std::string>;
    const auto needed = [](const std::string& model, double visibility_km, ElevationRange ground) {
        Names names;
        for (const auto& file : needed_files(model, visibility_km, ground))
            names.push_back(file.file.substr(9, file.file.size() - 12));  // without "lowtran7_" and ".nc"
        return names;
    };
    EXPECT_EQ(needed("midlatitude_summer", 23.0, 0.0), (Names{"midlatitude_summer_rural23_ground0"}));
    EXPECT_EQ(needed("midlatitude_summer", 23.0, 1400.0),
              (Names{"midlatitude_summer_rural23_ground1", "midlatitude_summer_rural23_ground2"}));
    EXPECT_EQ(needed("midlatitude_summer", 23.0, {900.0, 2000.0}),
              (Names{"midlatitude_summer_rural23_ground0", "midlatitude_summer_rural23_ground1",
                     "midlatitude_summer_rural23_ground2"}));
    EXPECT_EQ(needed("us_standard_1976", 10.0, 0.0),
              (Names{"us_standard_1976_rural23_ground0", "us_standard_1976_rural5_ground0"}));
    EXPECT_EQ(
        needed("us_standard_1976", 60.0, 3500.0),
        (Names{"us_standard_1976_rural23_ground3", "us_standard_1976_rural23_ground0", "us_standard_1976_rural50_ground0"}));
    EXPECT_EQ(needed("tropical", 23.0, 0.0), (Names{"tropical_rural23_ground0"}));
    EXPECT_EQ(needed("tropical", 23.0, 2000.0), (Names{"tropical_rural23_ground0", "midlatitude_summer_rural23_ground0",
                                                       "midlatitude_summer_rural23_ground2"}));
    EXPECT_EQ(needed("tropical", 30.0, 0.0), (Names{"tropical_rural23_ground0", "midlatitude_summer_rural23_ground0",
                                                    "midlatitude_summer_rural50_ground0"}));
}

TEST(AtmosphereFiles, UnknownModelListsTheModels) {
    try {
        (void)needed_files("midlatitude", 23.0, 0.0);
        FAIL();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("midlatitude_summer"), std::string::npos) << e.what();
        EXPECT_NE(std::string(e.what()).find("tropical"), std::string::npos) << e.what();
    }
}

}  // namespace
}  // namespace pyroscene::radiometry
