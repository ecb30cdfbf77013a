#include "gis/netcdf_input.h"

#include <cmath>

#include <gdal_priv.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "source_folder.h"
#include "unit/gis/source_raster.h"

namespace pyroscene::gis {
namespace {

std::filesystem::path default_atmosphere() {
    return source_folder() / "data/atmosphere/lowtran7_midlatitude_summer_rural23_ground0.nc";
}

TEST(NetCdf, ReadsATableWithItsDimensionsInFileOrder) {
    const NamedArray tau = read_netcdf_variable(default_atmosphere(), "transmittance");
    EXPECT_EQ(tau.dimensions, (std::vector<std::string>{"sensor_altitude", "view_zenith", "wavelength"}));
    EXPECT_EQ(tau.shape, (std::vector<std::size_t>{10, 7, 1047}));
    EXPECT_EQ(tau.values.size(), 10u * 7u * 1047u);
    EXPECT_EQ(tau.unit, "1");
    EXPECT_EQ(read_netcdf_variable(default_atmosphere(), "wavelength").unit, "um");
}

// README of the tables: mean vertical transmittance of 10.5-11.5 um from the ground to space 0.677, to 4.2 km 0.686.
TEST(NetCdf, RowsAreWhereTheyBelong) {
    const auto lambda = read_netcdf_variable(default_atmosphere(), "wavelength").values;
    const auto altitude = read_netcdf_variable(default_atmosphere(), "sensor_altitude").values;
    const auto tau = read_netcdf_variable(default_atmosphere(), "transmittance").values;
    const auto mean = [&](std::size_t level) {
        double sum = 0.0;
        int count = 0;
        for (std::size_t i = 0; i < lambda.size(); ++i)
            if (lambda[i] >= 10.5 && lambda[i] <= 11.5) sum += tau[level * 7 * lambda.size() + i], ++count;
        return sum / count;
    };
    EXPECT_NEAR(altitude[5], 4.2, 1e-6);
    EXPECT_NEAR(mean(9), 0.677, 0.003);
    EXPECT_NEAR(mean(5), 0.686, 0.003);
}

TEST(NetCdf, ScalarsHaveNoDimension) {
    const NamedArray visibility = read_netcdf_variable(default_atmosphere(), "visibility");
    EXPECT_TRUE(visibility.shape.empty());
    EXPECT_EQ(visibility.values, (std::vector<double>{23.0}));
}

TEST(NetCdf, AppliesFillValueScaleAndOffset) {
    const TempFolder folder;
    GDALAllRegister();
    {
        auto* driver = GetGDALDriverManager()->GetDriverByName("netCDF");
        const std::unique_ptr<GDALDataset> file(driver->CreateMultiDimensional((folder / "a.nc").c_str(), nullptr, nullptr));
        const auto root = file->GetRootGroup();
        const auto x = root->CreateDimension("x", "", "", 3);
        const auto array = root->CreateMDArray("packed", {x}, GDALExtendedDataType::Create(GDT_Int16), nullptr);
        array->SetNoDataValue(-9.0);
        array->SetScale(0.5);
        array->SetOffset(100.0);
        array->SetUnit("K");
        const double raw[] = {-9.0, 0.0, 7.0};
        const GUInt64 start[] = {0};
        const std::size_t count[] = {3};
        ASSERT_TRUE(array->Write(start, count, nullptr, nullptr, GDALExtendedDataType::Create(GDT_Float64), raw));
    }
    const NamedArray packed = read_netcdf_variable(folder / "a.nc", "packed");
    EXPECT_EQ(packed.unit, "K");
    EXPECT_TRUE(std::isnan(packed.values[0]));
    EXPECT_EQ(packed.values[1], 100.0);
    EXPECT_EQ(packed.values[2], 103.5);
}

TEST(NetCdf, SaysWhatIsMissing) {
    const std::string unknown = input_error_of([] { (void)read_netcdf_variable(default_atmosphere(), "tau"); });
    EXPECT_NE(unknown.find("ground0.nc, variable 'tau': not in the file; it has "), std::string::npos);
    EXPECT_NE(unknown.find("transmittance"), std::string::npos);
    EXPECT_NE(input_error_of([] { (void)read_netcdf_variable("/nonexistent/a.nc", "tau"); }).find("a.nc: no such file"),
              std::string::npos);
    const TempFolder folder;
    write_text_file(folder / "text.nc", "text");
    EXPECT_NE(input_error_of([&] { (void)read_netcdf_variable(folder / "text.nc", "tau"); }).find("is not a netCDF file"),
              std::string::npos);
}

}  // namespace
}  // namespace pyroscene::gis
