// Ingest of a WRF-SFIRE history file that is larger than memory may be: writes one of 2 GB (a line of fire that runs across 1000 x 1000
// fire cells), opens it as a scenario's input and reads terrain, arrival and every frame onto the map, in a process of its own. Prints one
// row of the benchmark table. The heat read must be the heat written.
//   bench_wrf [--records N]      default 62 records = 2 GB
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>

#include <fmt/format.h>
#include <gdal_priv.h>

#include "bench/measure.h"
#include "gis/crs.h"
#include "gis/gdal_support.h"
#include "inputs/load_scenario.h"
#include "inputs/scene_inputs.h"

namespace {

using namespace pyroscene;
namespace fs = std::filesystem;

constexpr int kAir = 100, kRefine = 10, kFire = kAir * kRefine, kPadded = (kAir + 1) * kRefine;
constexpr double kCell_m = 20.0, kStep_s = 60.0, kRate_m_s = 5.0, kFlux_W_m2 = 5e4;
constexpr const char* kProjection = "+proj=merc +lat_ts=40 +lon_0=-105 +a=6370000 +b=6370000 +units=m +no_defs +type=crs";
constexpr double kWest_m = 20000.0, kSouth_m = 3720000.0;

/// The front crosses the grid from the west; behind it the ground burns for two minutes.
float fire_value(const std::string& name, int record, int row, int col) {
    const double arrival_s = col * kCell_m / kRate_m_s, age_s = record * kStep_s - arrival_s;
    const bool burns = age_s > 0.0 && age_s <= 120.0;
    if (name == "FGRNHFX") return burns && row < kFire && col < kFire ? static_cast<float>(kFlux_W_m2) : 0.0F;
    if (name == "FGRNQFX") return 0.09F * fire_value("FGRNHFX", record, row, col);
    if (name == "TIGN_G") return static_cast<float>(age_s > 0.0 ? arrival_s : record * kStep_s + 1.0);
    if (name == "FUEL_FRAC") return age_s > 0.0 ? static_cast<float>(std::exp(-age_s / 60.0)) : 1.0F;
    if (name == "ZSF") return static_cast<float>(1500.0 + 50.0 * std::sin(row / 80.0) * std::cos(col / 60.0));
    if (name == "UF") return 4.0F;
    if (name == "VF") return 0.5F;
    return 0.7F;  // FGIP
}

class History {
public:
    History(const fs::path& file, int records) {
        gis::initialise_gdal();
        CPLStringList options;
        options.SetNameValue("FORMAT", "NC2");
        dataset_.reset(GetGDALDriverManager()->GetDriverByName("netCDF")->CreateMultiDimensional(file.c_str(), nullptr,
                                                                                                 options.List()));
        root_ = dataset_->GetRootGroup();
        attributes();
        CPLStringList unlimited;
        unlimited.SetNameValue("UNLIMITED", "YES");
        time_ = root_->CreateDimension("Time", {}, {}, static_cast<GUInt64>(records), unlimited.List());
        times(records);
        write_coordinates(records);
        write_fire(records);
    }

private:
    using Array = std::shared_ptr<GDALMDArray>;

    void attributes() {
        for (const auto& [name, value] : {std::pair{"MAP_PROJ", 3.0},
                                          {"DX", kCell_m * kRefine},
                                          {"DY", kCell_m * kRefine},
                                          {"TRUELAT1", 40.0},
                                          {"TRUELAT2", 40.0},
                                          {"MOAD_CEN_LAT", 32.0},
                                          {"STAND_LON", -105.0}})
            root_->CreateAttribute(name, {}, GDALExtendedDataType::Create(GDT_Float64))->Write(value);
        root_->CreateAttribute("START_DATE", {}, GDALExtendedDataType::CreateString())->Write("2020-07-01_18:00:00");
    }
    std::shared_ptr<GDALDimension> dimension(const char* name, int size) {
        return root_->CreateDimension(name, {}, {}, static_cast<GUInt64>(size), nullptr);
    }
    void times(int records) {
        const auto type = GDALExtendedDataType::CreateString(19);
        const auto array = root_->CreateMDArray("Times", {time_}, type, nullptr);
        std::vector<std::string> texts;
        for (int r = 0; r < records; ++r) texts.push_back(fmt::format("2020-07-01_{:02d}:{:02d}:00", 18 + r / 60, r % 60));
        std::vector<const char*> pointers;
        for (const auto& text : texts) pointers.push_back(text.c_str());
        const GUInt64 start = 0;
        const auto count = texts.size();
        array->Write(&start, &count, nullptr, nullptr, type, pointers.data());
    }
    static void write(const Array& array, int record, const std::vector<float>& values, std::size_t rows, std::size_t cols) {
        const std::array<GUInt64, 3> start{static_cast<GUInt64>(record), 0, 0};
        const std::array<std::size_t, 3> count{1, rows, cols};
        if (!array->Write(start.data(), count.data(), nullptr, nullptr, GDALExtendedDataType::Create(GDT_Float32),
                          values.data()))
            throw std::runtime_error("the history file cannot be written");
    }
    void write_coordinates(int records) {
        const auto y = dimension("south_north", kAir), x = dimension("west_east", kAir);
        std::vector<double> lon, lat;
        for (int row = 0; row < kAir; ++row)
            for (int col = 0; col < kAir; ++col) {
                lon.push_back(kWest_m + (col + 0.5) * kCell_m * kRefine);
                lat.push_back(kSouth_m + (row + 0.5) * kCell_m * kRefine);
            }
        gis::CrsTransform(kProjection, gis::kGeographicCrs).forward(lon, lat);
        const auto type = GDALExtendedDataType::Create(GDT_Float32);
        const auto xlong = root_->CreateMDArray("XLONG", {time_, y, x}, type, nullptr),
                   xlat = root_->CreateMDArray("XLAT", {time_, y, x}, type, nullptr);
        for (int r = 0; r < records; ++r) {
            write(xlong, r, std::vector<float>(lon.begin(), lon.end()), kAir, kAir);
            write(xlat, r, std::vector<float>(lat.begin(), lat.end()), kAir, kAir);
        }
    }
    void write_fire(int records) {
        const auto y = dimension("south_north_subgrid", kPadded), x = dimension("west_east_subgrid", kPadded);
        std::vector<std::pair<std::string, Array>> arrays;
        for (const char* name : {"FGRNHFX", "FGRNQFX", "TIGN_G", "FUEL_FRAC", "ZSF", "UF", "VF", "FGIP"})
            arrays.emplace_back(
                name, root_->CreateMDArray(name, {time_, y, x}, GDALExtendedDataType::Create(GDT_Float32), nullptr));
        std::vector<float> values(static_cast<std::size_t>(kPadded) * kPadded);
        for (int r = 0; r < records; ++r)
            for (const auto& [name, array] : arrays) {
                for (int row = 0; row < kPadded; ++row)
                    for (int col = 0; col < kPadded; ++col)
                        values[static_cast<std::size_t>(row) * kPadded + static_cast<std::size_t>(col)] =
                            fire_value(name, r, row, col);
                write(array, r, values, kPadded, kPadded);
            }
    }

    gis::DatasetPtr dataset_;
    std::shared_ptr<GDALGroup> root_;
    std::shared_ptr<GDALDimension> time_;
};

/// Sum of the flux over all frames and cells [W m-2], and the number of frames.
std::vector<double> ingest(const fs::path& scenario_file) {
    const auto scenario = inputs::load_scenario(scenario_file);
    const auto in = inputs::load_scene_inputs(scenario);
    double sum = 0.0;
    for (std::size_t i = 0; i < in.frames.size(); ++i) {
        const auto frame = inputs::load_frame(scenario, in, i);
        for (const float flux : frame.heat_flux_W_m2.values) sum += std::isfinite(flux) ? static_cast<double>(flux) : 0.0;
    }
    return {sum, static_cast<double>(in.frames.size())};
}

double written_flux(int records) {
    double sum = 0.0;
    for (int r = 0; r < records; ++r)
        for (int col = 0; col < kFire; ++col) sum += kFire * static_cast<double>(fire_value("FGRNHFX", r, 0, col));
    return sum;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const int records = argc == 3 && std::strcmp(argv[1], "--records") == 0 ? std::stoi(argv[2]) : 62;
        const bench::TemporaryFolder folder;
        const auto history = folder.path / "wrfout_d01_2020-07-01_18:00:00", scenario = folder.path / "scenario.yaml";
        bench::measure([&] {  // in a process of its own, so that this one stays small
            const History written(history, records);
            return std::vector{0.0};
        });
        std::ofstream(scenario) << "pyroscene: 1\ninputs:\n  wrf_sfire: \"" << history.string()
                                << "\"\nstart: 2020-07-01T18:00:00Z\nacquisitions:\n  - {id: a, sensor: wasp, time_s: 0, "
                                   "platform: {over: centre, altitude_agl_m: 3000}}\n";
        const auto usage = bench::measure([&] { return ingest(scenario); }, 2);
        const double share = usage.results.at(0) / written_flux(records);
        std::cout << fmt::format(
            "| ingest of a WRF-SFIRE history of {:.2f} GB, {:.0f} records of {} x {} fire cells, 2 threads | {:.1f} s wall, "
            "{:.1f} s "
            "CPU, {:.0f} MB | the file | {:.2f} of its size in memory | 1000 MB | heat read / written {:.7f} |\n",
            1e-9 * static_cast<double>(fs::file_size(history)), usage.results.at(1), kFire, kFire, usage.wall_s, usage.cpu_s,
            usage.peak_MB, usage.peak_MB * 1e6 / static_cast<double>(fs::file_size(history)), share);
        return std::abs(share - 1.0) < 1e-6 && usage.peak_MB <= 1000.0 ? 0 : 1;
    } catch (const std::exception& e) {
        std::cerr << "bench_wrf: " << e.what() << '\n';
        return 1;
    }
}
