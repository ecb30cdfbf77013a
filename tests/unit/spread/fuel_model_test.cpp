#include "spread/fuel_model.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "base/error.h"
#include "unit/base/temp_folder.h"

namespace pyroscene::spread {
namespace {

constexpr const char* kHeader =
    "number,code,dynamic,depth_m,mx_dead_frac,heat_dead_kJ_kg,heat_live_kJ_kg,load_1h_kg_m2,load_10h_kg_m2,load_100h_kg_m2,"
    "load_herb_kg_m2,load_woody_kg_m2,sav_1h_1_m,sav_10h_1_m,sav_100h_1_m,sav_herb_1_m,sav_woody_1_m\n";

TEST(FuelModels, ShipFiftyThree) {
    const auto& models = standard_fuel_models();
    EXPECT_EQ(models.size(), 53U);
    EXPECT_EQ(models.at(4).code, "FM4");
    EXPECT_NEAR(models.at(4).total_load_kg_m2(), 3.593467, 1e-5);
    EXPECT_NEAR(models.at(3).characteristic_surface_to_volume_per_m(), 4921.26, 0.01);
    EXPECT_FALSE(models.at(2).dynamic);
    EXPECT_TRUE(models.at(102).dynamic);
    for (const int code : {91, 92, 93, 98, 99}) EXPECT_TRUE(nonburnable_codes().contains(code)) << code;
}

TEST(FuelModels, BurnOutByTheirSizes) {
    const auto grass = burn_out_of(standard_fuel_models().at(3), 300.0),
               slash = burn_out_of(standard_fuel_models().at(11), 300.0);
    EXPECT_EQ(grass.coarse_share, 0.0);
    EXPECT_NEAR(grass.fine_time_s, 15.36 / 2.302585, 1e-4);
    // Anderson: 1.5, 4.51 and 5.51 tons per acre of 1-h, 10-h and 100-h fuel.
    EXPECT_NEAR(slash.coarse_share, (4.51 + 5.51) / (1.5 + 4.51 + 5.51), 2e-3);
    EXPECT_EQ(slash.coarse_time_s, 300.0);
}

class FuelModelFile : public testing::Test {
protected:
    std::filesystem::path write(const std::string& rows) {
        const auto path = folder_.path() / "fuel.csv";
        std::ofstream(path) << kHeader << rows;
        return path;
    }
    std::string problem(const std::string& rows) {
        try {
            read_fuel_models(write(rows));
        } catch (const Error& e) {
            return e.what();
        }
        return "";
    }

private:
    TempFolder folder_;
};

TEST_F(FuelModelFile, IsReadWithNumbersOfTheUsers) {
    const auto models = read_fuel_models(write("28,MACCHIA,0,1.2,0.3,19000,19500,0.8,0.3,0,0,0.9,5000,358,98,4900,4000\n"));
    ASSERT_EQ(models.size(), 1U);
    EXPECT_EQ(models.at(28).code, "MACCHIA");
    EXPECT_EQ(models.at(28).heat_live_J_kg, 19.5e6);
    EXPECT_EQ(models.at(28).load_kg_m2[kWoody], 0.9);
}

TEST_F(FuelModelFile, NamesLineAndColumnOfWhatIsWrong) {
    const std::string good = "28,A,0,1.2,0.3,19000,19500,0.8,0.3,0,0,0.9,5000,358,98,4900,4000\n";
    EXPECT_NE(problem(good + good).find("fuel.csv:3: fuel model 28 is given twice"), std::string::npos);
    EXPECT_NE(problem("28,A,0,-1,0.3,19000,19500,0.8,0.3,0,0,0.9,5000,358,98,4900,4000\n")
                  .find("fuel.csv:2: column 'depth_m': found -1"),
              std::string::npos);
    EXPECT_NE(problem("28,A,0,1,30,19000,19500,0.8,0.3,0,0,0.9,5000,358,98,4900,4000\n").find("mx_dead_frac"),
              std::string::npos);
    EXPECT_NE(problem("28,A,0,1,0.3,19000,19500,0,0,0,0,0,5000,358,98,4900,4000\n").find("has no load"), std::string::npos);
    EXPECT_NE(problem("2.5,A,0,1,0.3,19000,19500,1,0,0,0,0,5000,358,98,4900,4000\n").find("whole number"),
              std::string::npos);
}

}  // namespace
}  // namespace pyroscene::spread
