#include "unit/gis/wrf_file.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <cpl_string.h>
#include <gdal_priv.h>

#include "gis/gdal_support.h"

namespace pyroscene::gis {
namespace {

constexpr double kRadius_m = 6370000.0, kPi = 3.14159265358979323846;

using Dimensions = std::vector<std::shared_ptr<GDALDimension>>;

void write_floats(GDALGroup& root, const std::string& name, const Dimensions& dimensions, const std::vector<float>& values) {
    const auto array = root.CreateMDArray(name, dimensions, GDALExtendedDataType::Create(GDT_Float32), nullptr);
    std::vector<GUInt64> start(dimensions.size(), 0);
    std::vector<std::size_t> count;
    for (const auto& d : dimensions) count.push_back(static_cast<std::size_t>(d->GetSize()));
    array->Write(start.data(), count.data(), nullptr, nullptr, array->GetDataType(), values.data());
}

}  // namespace

double WrfTestFile::fire_value(const std::string& variable, int record, int col, int row) {
    if (variable == "ZSF") return 1000.0 + col + 100.0 * row;
    if (variable == "TIGN_G") return col < 4 ? 30.0 + col + 0.125 * row : 1e6;  // the last record is 70 s after the start
    if (variable == "FUEL_FRAC") return 0.5;
    if (variable == "FGIP") return 2.0;
    if (variable == "UF") return 3.0;
    if (variable == "VF") return -1.0;
    return record * 1000.0 + col + 20.0 * row;  // FGRNHFX
}

double WrfTestFile::air_value(const std::string& variable, int record, int k, int row, int col) {
    // Dry air above a cell and how much of it counts in a layer.
    if (variable == "MU") return 400.0 + 10.0 * col;
    if (variable == "MUB") return 88000.0 - 100.0 * row;
    if (variable == "C1H") return 1.0 - 0.1 * k;
    if (variable == "C2H") return 300.0 * k;
    if (variable == "heating_K_s") return record * 0.01 * (k + 1) * (col + 1);
    if (variable == "RTHFRTEN")
        return air_value("heating_K_s", record, k, row, col) *
               (air_value("C1H", record, k, row, col) *
                    (air_value("MU", record, k, row, col) + air_value("MUB", record, k, row, col)) +
                air_value("C2H", record, k, row, col));
    if (variable == "U") return 2.0 + 0.5 * col;
    if (variable == "V") return -1.0 - 0.25 * row;
    if (variable == "W") return 0.8 * k;
    if (variable == "PH") return 9.81 * (40.0 * k + 10.0 * k * k);
    return 9.81 * (1500.0 + 20.0 * k + 7.0 * row);  // PHB
}

std::pair<double, double> WrfTestFile::lon_lat(double x_m, double y_m) const {
    if (map_projection == 2) {  // Snyder 1987, eqs 21-1 to 21-15 with the true scale at a parallel
        const double pole = true1 < 0.0 ? -1.0 : 1.0;
        const double scale_m = kRadius_m * (1.0 + std::sin(std::abs(true1) * kPi / 180.0));
        const double colatitude = 2.0 * std::atan(std::hypot(x_m, y_m) / scale_m);
        return {stand_lon + std::atan2(x_m, -pole * y_m) * 180.0 / kPi, pole * (90.0 - colatitude * 180.0 / kPi)};
    }
    if (map_projection == 3) {  // eqs 7-4, 7-5
        const double scale_m = kRadius_m * std::cos(true1 * kPi / 180.0);
        return {stand_lon + x_m / scale_m * 180.0 / kPi,
                (2.0 * std::atan(std::exp(y_m / scale_m)) - kPi / 2.0) * 180.0 / kPi};
    }
    // Snyder 1987, eqs 15-1 to 15-5 and 14-9 (spherical Lambert conformal conic).
    const auto rad = [](double deg) { return deg * kPi / 180.0; };
    const auto t = [](double lat) { return std::tan(kPi / 4.0 + lat / 2.0); };
    const double n = std::log(std::cos(rad(true1)) / std::cos(rad(true2))) / std::log(t(rad(true2)) / t(rad(true1)));
    const double F = std::cos(rad(true1)) * std::pow(t(rad(true1)), n) / n;
    const double rho0 = kRadius_m * F / std::pow(t(rad(centre_lat)), n);
    const double rho = std::hypot(x_m, rho0 - y_m), theta = std::atan2(x_m, rho0 - y_m);
    const double lat = 2.0 * std::atan(std::pow(kRadius_m * F / rho, 1.0 / n)) - kPi / 2.0;
    return {stand_lon + theta / n * 180.0 / kPi, lat * 180.0 / kPi};
}

void WrfTestFile::write(const std::filesystem::path& path) const {
    initialise_gdal();
    auto* driver = GetGDALDriverManager()->GetDriverByName("netCDF");
    CPLStringList options;
    options.SetNameValue("FORMAT", format.c_str());
    const DatasetPtr dataset(driver->CreateMultiDimensional(path.c_str(), nullptr, options.List()));
    const auto root = dataset->GetRootGroup();
    std::map<std::string, double> numbers{{"MAP_PROJ", map_projection},
                                          {"DX", dx_m},
                                          {"DY", dy_m},
                                          {"TRUELAT1", true1},
                                          {"TRUELAT2", true2},
                                          {"MOAD_CEN_LAT", centre_lat},
                                          {"STAND_LON", stand_lon},
                                          {"CEN_LAT", centre_lat},
                                          {"CEN_LON", stand_lon}};
    for (const auto& [name, value] : attributes) numbers[name] = value;
    for (const auto& [name, value] : numbers)
        if (!std::isnan(value)) root->CreateAttribute(name, {}, GDALExtendedDataType::Create(GDT_Float64))->Write(value);
    root->CreateAttribute("START_DATE", {}, GDALExtendedDataType::CreateString())->Write(start.c_str());

    const auto dimension = [&](const char* name, int size) {
        const char* const unlimited[] = {"UNLIMITED=YES", nullptr};  // as WRF's Time
        return root->CreateDimension(name, {}, {}, static_cast<GUInt64>(size),
                                     std::string_view(name) == "Time" ? unlimited : nullptr);
    };
    const int records = static_cast<int>(times.size()), fine_cols = (cols + 1) * refine_x, fine_rows = (rows + 1) * refine_y;
    const auto time = dimension("Time", records), y = dimension("south_north", rows), x = dimension("west_east", cols);
    const auto fy = dimension("south_north_subgrid", fine_rows), fx = dimension("west_east_subgrid", fine_cols);
    const auto wanted = [&](const char* name) {
        return std::find(left_out.begin(), left_out.end(), name) == left_out.end();
    };

    if (wanted("Times")) {
        const auto type = GDALExtendedDataType::CreateString(19);
        const auto array = root->CreateMDArray("Times", {time}, type, nullptr);
        std::vector<const char*> texts;
        for (const auto& text : times) texts.push_back(text.c_str());
        const GUInt64 start_at = 0;
        const auto count = static_cast<std::size_t>(records);
        array->Write(&start_at, &count, nullptr, nullptr, type, texts.data());
    }
    std::vector<float> lon, lat;
    for (int t = 0; t < records; ++t)
        for (int r = 0; r < rows; ++r)
            for (int c = 0; c < cols; ++c) {
                const auto [at_lon, at_lat] = lon_lat(west_m + (c + 0.5) * dx_m, south_m + (r + 0.5) * dy_m);
                lon.push_back(static_cast<float>(at_lon + (r == 1 && c == 2 ? longitude_error_deg : 0.0)));
                lat.push_back(static_cast<float>(map_projection == 0 ? 0.0 : at_lat));
            }
    if (wanted("XLONG")) write_floats(*root, "XLONG", {time, y, x}, lon);
    if (wanted("XLAT")) write_floats(*root, "XLAT", {time, y, x}, lat);
    for (const auto& [name, scale] : {std::pair{"FGRNQFX", latent_heat}, {"FMC_G", 0.0}}) {
        if (!wanted(name)) continue;
        std::vector<float> values;
        for (int t = 0; t < records; ++t)
            for (int r = 0; r < fine_rows; ++r)
                for (int c = 0; c < fine_cols; ++c)
                    values.push_back(static_cast<float>(scale > 0.0 ? scale * fire_value("FGRNHFX", t, c, r) : 0.08));
        write_floats(*root, name, {time, fy, fx}, values);
    }
    if (wanted("GRNHFX")) {
        std::vector<float> values;
        for (int t = 0; t < records; ++t)
            for (int r = 0; r < rows; ++r)
                for (int c = 0; c < cols; ++c) {
                    double sum = 0.0;
                    for (int j = 0; j < refine_y; ++j)
                        for (int i = 0; i < refine_x; ++i)
                            sum += fire_value("FGRNHFX", t, c * refine_x + i, r * refine_y + j);
                    values.push_back(static_cast<float>(coarse_heat * sum / (refine_x * refine_y)));
                }
        write_floats(*root, "GRNHFX", {time, y, x}, values);
    }
    const auto z = dimension("bottom_top", layers), zs = dimension("bottom_top_stag", layers + 1);
    const auto ys = dimension("south_north_stag", rows + 1), xs = dimension("west_east_stag", cols + 1);
    for (const auto& [name, dimensions] : {std::pair<const char*, Dimensions>{"RTHFRTEN", {time, z, y, x}},
                                           {"U", {time, z, y, xs}},
                                           {"V", {time, z, ys, x}},
                                           {"W", {time, zs, y, x}},
                                           {"PH", {time, zs, y, x}},
                                           {"PHB", {time, zs, y, x}},
                                           {"MU", {time, y, x}},
                                           {"MUB", {time, y, x}},
                                           {"C1H", {time, z}},
                                           {"C2H", {time, z}}}) {
        if (!wanted(name)) continue;
        std::vector<float> values;
        const bool flat = dimensions.size() == 3, column = dimensions.size() == 2;
        const auto size = [&](std::size_t d) { return static_cast<int>(dimensions[d]->GetSize()); };
        const int layers_of = flat ? 1 : size(1), rows_of = column ? 1 : size(flat ? 1 : 2),
                  cols_of = column ? 1 : size(flat ? 2 : 3);
        for (int t = 0; t < records; ++t)
            for (int k = 0; k < layers_of; ++k)
                for (int r = 0; r < rows_of; ++r)
                    for (int c = 0; c < cols_of; ++c) values.push_back(static_cast<float>(air_value(name, t, k, r, c)));
        write_floats(*root, name, dimensions, values);
    }
    for (const char* name : {"ZSF", "TIGN_G", "FUEL_FRAC", "FGIP", "UF", "VF", "FGRNHFX"}) {
        if (!wanted(name)) continue;
        std::vector<float> values;
        for (int t = 0; t < records; ++t)
            for (int r = 0; r < fine_rows; ++r)
                for (int c = 0; c < fine_cols; ++c) values.push_back(static_cast<float>(fire_value(name, t, c, r)));
        write_floats(*root, name, {time, fy, fx}, values);
    }
}

}  // namespace pyroscene::gis
