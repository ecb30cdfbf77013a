// History files of WRF-SFIRE: every peculiarity of their layout gives the right place or one clear error, never a shifted raster.
#include "gis/wrf_sfire.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/files.h"
#include "gis/geodesy.h"
#include "gis/raster_input.h"
#include "gis/wrf_plume.h"
#include "unit/gis/wrf_file.h"

namespace pyroscene::gis {
namespace {

class WrfSfireFiles : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = std::filesystem::temp_directory_path() /
                  ("wrf_sfire_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + "_" +
                   ::testing::UnitTest::GetInstance()->current_test_info()->name());
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path write(const WrfTestFile& file, const std::string& name = "wrfout_d01_2020-07-01_18:00:00") {
        file.write(folder_ / name);
        return folder_ / name;
    }
    static std::string refusal(const std::vector<std::filesystem::path>& files,
                               const std::optional<LocalPlacement>& placement = {}) {
        try {
            (void)open_wrf_sfire(files, placement);
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::Input);
            return e.what();
        }
        return "accepted";
    }
    static Raster<float> read(const WrfSfire& wrf, const std::string& variable, int moment, const char* unit) {
        const WrfBand band{&wrf.moments[static_cast<std::size_t>(moment)], {variable}, 0.0};
        const auto file = wrf_raster(wrf, variable, unit, WrfGrid::Fire, {&band, 1});
        const auto grid = make_map_grid(file, {}, {});
        return read_band({file, 1, Resampling::Bilinear, variable, unit}, grid);
    }
    std::filesystem::path folder_;
};

void expect_in_place(const WrfTestFile& layout, const WrfSfire& wrf, const Raster<float>& z) {
    ASSERT_EQ(z.grid.cols, layout.cols * layout.refine_x);  // the padding is gone
    ASSERT_EQ(z.grid.rows, layout.rows * layout.refine_y);
    const MapProjection map(z.grid.crs_wkt);
    for (int row = 0; row < z.grid.rows; ++row)
        for (int col = 0; col < z.grid.cols; ++col) {
            const int from_south = z.grid.rows - 1 - row;
            ASSERT_EQ(z.values[z.grid.index(row, col)], WrfTestFile::fire_value("ZSF", 0, col, from_south));
        }
    // The middle of the fire cell by the formulas of the projection, within the resolution of float32 coordinates.
    const double cell_m = layout.dx_m / layout.refine_x;
    const auto [lon, lat] = layout.lon_lat(layout.west_m + 4.5 * cell_m, layout.south_m + 2.5 * cell_m);
    const auto at = map.to_geodetic(z.grid.x_centre_m(4), z.grid.y_centre_m(z.grid.rows - 3));
    EXPECT_NEAR((at.lon_deg - lon) * 111e3 * std::cos(lat * 0.01745), 0.0, 0.7);
    EXPECT_NEAR((at.lat_deg - lat) * 111e3, 0.0, 0.5);
    EXPECT_LT(wrf.placement_residual_m, 1.4);
}

TEST_F(WrfSfireFiles, FireCellsLieWhereTheProjectionSays) {
    const WrfTestFile layout;
    const auto wrf = open_wrf_sfire({write(layout)}, {});
    EXPECT_EQ(wrf.refine_x, 3);
    expect_in_place(layout, wrf, read(wrf, "ZSF", 0, "m"));
}

TEST_F(WrfSfireFiles, ClassicFilesReadTheSame) {
    WrfTestFile layout;
    layout.format = "NC";
    const auto wrf = open_wrf_sfire({write(layout)}, {});
    expect_in_place(layout, wrf, read(wrf, "ZSF", 0, "m"));
}

TEST_F(WrfSfireFiles, RefinementMayDifferByDirection) {
    WrfTestFile layout;
    layout.refine_x = 4, layout.refine_y = 2, layout.dx_m = 80.0, layout.dy_m = 40.0;
    const auto wrf = open_wrf_sfire({write(layout)}, {});
    EXPECT_EQ(wrf.refine_x, 4);
    EXPECT_EQ(wrf.refine_y, 2);
    expect_in_place(layout, wrf, read(wrf, "ZSF", 0, "m"));
}

struct Projection {
    const char* name;
    int map_projection;
    double true1, stand_lon, west_m, south_m;
};

class WrfProjections : public WrfSfireFiles, public ::testing::WithParamInterface<Projection> {};

TEST_P(WrfProjections, PutFireCellsWhereTheirFormulasSay) {
    const auto& p = GetParam();
    WrfTestFile layout;
    layout.map_projection = p.map_projection;
    layout.true1 = p.true1, layout.stand_lon = p.stand_lon, layout.west_m = p.west_m, layout.south_m = p.south_m;
    const auto wrf = open_wrf_sfire({write(layout)}, {});
    expect_in_place(layout, wrf, read(wrf, "ZSF", 0, "m"));
    // The same file under another projection's number is refused, not shifted.
    layout.attributes = {{"MAP_PROJ", p.map_projection == 3 ? 1.0 : 3.0}, {"TRUELAT1", 30.0}};
    EXPECT_NE(refusal({write(layout, "wrong")}).find("float32 explains"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(All, WrfProjections,
                         ::testing::Values(Projection{"north_pole", 2, 60.0, -150.0, 120000.0, -2700000.0},
                                           Projection{"south_pole", 2, -71.0, 20.0, -300000.0, 2500000.0},
                                           Projection{"mercator", 3, 15.0, -60.0, -50000.0, 1700000.0},
                                           Projection{"mercator_south", 3, -10.0, 30.0, 70000.0, -1200000.0}),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

// Heating becomes excess by the balance that wrf_plume.h writes, with winds at the centres of cells.
TEST_F(WrfSfireFiles, HeatingMakesAPlume) {
    const WrfTestFile layout;
    const auto wrf = open_wrf_sfire({write(layout)}, {});
    const std::vector<double> levels_m{5.0, 35.0, 90.0, 1000.0};
    const auto file = wrf_plume(wrf, wrf.moments[1], levels_m);
    const auto grid = make_map_grid(file, {}, {});
    ASSERT_EQ(grid.cols, layout.cols);
    std::vector<Raster<float>> bands;
    for (int band = 1; band <= 4; ++band)
        bands.push_back(
            read_band({.file = file, .band = band, .resampling = Resampling::Nearest, .name = "excess", .unit = "K"}, grid));
    const auto air = [](const char* name, int k, int row, int col) { return WrfTestFile::air_value(name, 1, k, row, col); };
    for (int row = 0; row < layout.rows; ++row)
        for (int col = 0; col < layout.cols; ++col) {
            std::vector<double> height, excess;
            for (int k = 0; k < layout.layers; ++k) {
                const auto z = [&](int level) {
                    return 60.0 * level + 10.0 * level * level;
                };  // (PH + PHB) / 9.81 above the ground
                const double dz = z(k + 1) - z(k);
                const double airing = (air("U", k, row, col) + air("U", k, row, col + 1)) / 2.0 / 90.0 -
                                      (air("V", k, row, col) + air("V", k, row + 1, col)) / 2.0 / 90.0 +
                                      0.8 * (k + 0.5) / dz;
                excess.push_back((air("heating_K_s", k, row, col) + (k > 0 ? 0.8 * k * excess.back() / dz : 0.0)) / airing);
                height.push_back((z(k) + z(k + 1)) / 2.0);
            }
            const int map_row = layout.rows - 1 - row;
            EXPECT_NEAR(bands[0].at(map_row, col), excess[0], 1e-5 * excess[0]);
            EXPECT_NEAR(bands[1].at(map_row, col), excess[0], 1e-5 * excess[0]);  // the centre of the lowest layer
            const double share = (90.0 - height[0]) / (height[1] - height[0]);
            EXPECT_NEAR(bands[2].at(map_row, col), std::lerp(excess[0], excess[1], share), 1e-5 * excess[1]);
            EXPECT_EQ(bands[3].at(map_row, col), 0.0F);
        }
    const auto lacking = open_wrf_sfire({write({.left_out = {"W"}}, "lacking")}, {});
    EXPECT_THROW((void)wrf_plume(lacking, lacking.moments[0], levels_m), Error);
}

TEST_F(WrfSfireFiles, MomentsOfSeveralFilesComeInOrderOfTime) {
    WrfTestFile early, late;
    late.times = {"2020-07-01_18:00:10", "2020-07-01_18:00:20"};  // a restart repeats the last moment
    const auto a = write(early, "wrfout_d01_2020-07-01_18-00-00"), b = write(late, "wrfout_d01_2020-07-01_18-00-10");
    const auto wrf = open_wrf_sfire({b, a}, {});
    ASSERT_EQ(wrf.moments.size(), 3U);
    EXPECT_EQ(wrf.moments[0].unix_s, 1593626400.0);  // date -u -d '2020-07-01 18:00:00' +%s
    EXPECT_EQ(wrf.moments[1].unix_s, 1593626410.0);
    EXPECT_EQ(wrf.moments[2].unix_s, 1593626420.0);
    EXPECT_EQ(wrf.moments[2].record, 1);
}

TEST_F(WrfSfireFiles, ArrivalCountsFromTheEpochAndEndsWithTheFire) {
    const WrfTestFile layout;
    const auto wrf = open_wrf_sfire({write(layout)}, {});
    const auto file = wrf_arrival(wrf, wrf.simulation_start_unix_s + 20.0);
    const auto grid = make_map_grid(file, {}, {});
    const auto arrival = read_band({file, 1, Resampling::Nearest, "arrival", "s"}, grid);
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col) {
            const float value = arrival.values[grid.index(row, col)];
            if (col < 4)
                EXPECT_FLOAT_EQ(value, static_cast<float>(10.0 + col + 0.125 * (grid.rows - 1 - row)));
            else if (col == 4)  // would come after one more second, but had not come 70 s after the start
                EXPECT_FLOAT_EQ(value, 50.0F);
            else
                EXPECT_TRUE(std::isnan(value));
        }
    EXPECT_THROW((void)wrf_arrival(wrf, wrf.simulation_start_unix_s + 40.0), Error);
}

TEST_F(WrfSfireFiles, SumsAndProductsOfVariables) {
    const WrfTestFile layout;
    const auto wrf = open_wrf_sfire({write(layout)}, {});
    const WrfBand both{&wrf.moments[1], {"FGIP", "FUEL_FRAC"}, 0.0};
    const auto product = wrf_raster(wrf, "fuel", "kg m-2", WrfGrid::Fire, {&both, 1}, WrfCombine::Product);
    const auto sum = wrf_raster(wrf, "sum", "kg m-2", WrfGrid::Fire, {&both, 1}, WrfCombine::Sum);
    const auto grid = make_map_grid(product, {}, {});
    EXPECT_EQ(read_band({product, 1, Resampling::Conserve, "fuel", "kg m-2"}, grid).values[7], 1.0F);
    EXPECT_EQ(read_band({sum, 1, Resampling::Conserve, "fuel", "kg m-2"}, grid).values[7], 2.5F);
}

TEST_F(WrfSfireFiles, IntegralCoversTheFireCellsAlone) {
    const WrfTestFile layout;
    const auto wrf = open_wrf_sfire({write(layout)}, {});
    double sum = 0.0;
    for (int row = 0; row < layout.rows * layout.refine_y; ++row)
        for (int col = 0; col < layout.cols * layout.refine_x; ++col) sum += WrfTestFile::fire_value("FGRNHFX", 1, col, row);
    EXPECT_NEAR(wrf_integral(wrf, wrf.moments[1], "FGRNHFX", WrfGrid::Fire), sum * 30.0 * 30.0, 1e-6 * sum * 900.0);
}

TEST_F(WrfSfireFiles, IdealisedRunsNeedAPlace) {
    WrfTestFile layout;
    layout.map_projection = 0;
    const auto file = write(layout);
    EXPECT_NE(refusal({file}).find("MAP_PROJ 0"), std::string::npos);
    const auto wrf = open_wrf_sfire({file}, LocalPlacement{"EPSG:32613", 500000.0, 4400000.0});
    EXPECT_EQ(wrf.west_m, 500000.0);
    EXPECT_EQ(wrf.north_m, 4400000.0 + 5 * 90.0);
    EXPECT_NE(refusal({write(WrfTestFile{}, "real")}, LocalPlacement{"EPSG:32613", 0.0, 0.0}).find("of its own"),
              std::string::npos);
}

TEST_F(WrfSfireFiles, JunkIsRefusedByName) {
    const auto says = [&](const WrfTestFile& layout, const std::string& words) {
        const auto message = refusal({write(layout)});
        EXPECT_NE(message.find(words), std::string::npos) << message;
    };
    WrfTestFile wrong;
    wrong.longitude_error_deg = 1e-3;  // 80 m
    says(wrong, "float32 explains");
    says({.attributes = {{"TRUELAT1", 20.0}}}, "wrong MAP_PROJ, TRUELAT");
    says({.attributes = {{"STAND_LON", -104.0}}}, "float32 explains");
    says({.attributes = {{"MAP_PROJ", 6.0}}}, "MAP_PROJ 6");
    says({.attributes = {{"DX", std::nan("")}}}, "global attribute DX");
    says({.attributes = {{"DX", 45.0}}}, "DX = 45 m");
    says({.left_out = {"Times"}}, "no variable 'Times'");
    says({.left_out = {"XLAT"}}, "XLAT");
    says({.times = {"yesterday"}}, "no time of the form");
    EXPECT_NE(refusal({folder_ / "nothing"}).find("no such file"), std::string::npos);
    WrfTestFile other;
    other.west_m += 900.0, other.cols = 6;
    const auto a = write(WrfTestFile{}, "a"), b = write(other, "b");
    EXPECT_NE(refusal({a, b}).find("another grid"), std::string::npos);
}

}  // namespace
}  // namespace pyroscene::gis
