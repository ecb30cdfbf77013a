#include "gis/wrf_sfire.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>

#include <cpl_conv.h>
#include <fmt/format.h>
#include <gdal_priv.h>

#include "base/error.h"
#include "gis/crs.h"
#include "gis/gdal_support.h"
#include "gis/netcdf_input.h"

namespace pyroscene::gis {
namespace {

constexpr const char* kSphere = "+a=6370000 +b=6370000 +units=m +no_defs +type=crs";  // share/module_llxy.F

/// A file while it is looked at.
struct File {
    std::filesystem::path path;
    DatasetPtr dataset;
    std::shared_ptr<GDALGroup> root;

    explicit File(const std::filesystem::path& p) : path(p) {
        initialise_gdal();
        const GdalErrors errors;
        dataset = open_netcdf(p);
        if (dataset) root = dataset->GetRootGroup();
        std::error_code ignored;
        if (!root && !std::filesystem::exists(p, ignored)) throw input_error(p.string(), "no such file");
        if (!root) throw input_error(p.string(), "is not a netCDF file that can be read: " + errors.message());
    }

    [[nodiscard]] std::string text(const char* attribute) const {
        const auto found = root->GetAttribute(attribute);
        const char* value = found ? found->ReadAsString() : nullptr;
        return value == nullptr ? "" : value;
    }
    [[nodiscard]] double number(const char* attribute) const {
        const auto found = root->GetAttribute(attribute);
        if (!found)
            throw input_error(path.string(),
                              fmt::format("has no global attribute {}; is it a WRF history file?", attribute));
        return found->ReadAsDouble();
    }
    [[nodiscard]] int dimension(const char* name) const {
        for (const auto& d : root->GetDimensions())
            if (d->GetName() == name) return static_cast<int>(d->GetSize());
        return 0;
    }
};

/// "2000-08-01_18:00:06" as seconds since 1970.
double unix_seconds(const std::string& text, const std::string& subject) {
    int year = 0, month = 0, day = 0, hour = 0, minute = 0;
    double second = 0.0;
    if (std::sscanf(text.c_str(), "%d-%d-%d_%d:%d:%lf", &year, &month, &day, &hour, &minute, &second) != 6)
        throw input_error(subject, fmt::format("'{}' is no time of the form 2000-08-01_18:00:06", text));
    const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                                           std::chrono::day(static_cast<unsigned>(day))};
    if (!date.ok()) throw input_error(subject, fmt::format("'{}' is no date", text));
    const auto days = std::chrono::sys_days(date).time_since_epoch().count();
    return 86400.0 * static_cast<double>(days) + 3600.0 * hour + 60.0 * minute + second;
}

/// Dates of the records. GDAL shows the characters [record][19] of some files as strings [record], of others one by one.
std::vector<std::string> times_of(const File& file) {
    const auto array = file.root->OpenMDArray("Times");
    if (!array || array->GetDataType().GetClass() != GEDTC_STRING || array->GetDimensionCount() < 1 ||
        array->GetDimensionCount() > 2)
        throw input_error(file.path.string(), "has no variable 'Times' with the date of each record");
    std::vector<std::size_t> count;
    for (const auto& d : array->GetDimensions()) count.push_back(static_cast<std::size_t>(d->GetSize()));
    const std::size_t pieces = count.size() == 2 ? count[1] : 1;
    std::vector<char*> texts(count[0] * pieces, nullptr);
    const std::vector<GUInt64> start(count.size(), 0);
    const GdalErrors errors;
    if (!texts.empty() && !array->Read(start.data(), count.data(), nullptr, nullptr, array->GetDataType(), texts.data()))
        throw input_error(file.path.string(), "'Times' cannot be read: " + errors.message());
    std::vector<std::string> out(count[0]);
    for (std::size_t i = 0; i < texts.size(); ++i) {
        if (texts[i] != nullptr) out[i / pieces] += texts[i];
        CPLFree(texts[i]);
    }
    return out;
}

/// Layout and projection, which all files of a series share.
struct Layout {
    int map_projection = 0;
    std::array<double, 4> parallels{};  ///< TRUELAT1, TRUELAT2, MOAD_CEN_LAT, STAND_LON
    double dx_m = 0.0, dy_m = 0.0;
    int cols = 0, rows = 0, refine_x = 1, refine_y = 1;
    bool operator==(const Layout&) const = default;
};

int refinement(const File& file, const char* subgrid, const char* coarse) {
    const int fine = file.dimension(subgrid), cells = file.dimension(coarse);
    if (fine == 0)
        throw input_error(file.path.string(),
                          fmt::format("has no dimension {}: no fire grid (run WRF with ifire = 2 and sr_x, sr_y)", subgrid));
    if (cells == 0) throw input_error(file.path.string(), fmt::format("has no dimension {}", coarse));
    if (fine % (cells + 1) != 0)
        throw input_error(file.path.string(),
                          fmt::format("{} = {} is no multiple of {} + 1 = {}", subgrid, fine, coarse, cells + 1));
    return fine / (cells + 1);
}

Layout layout_of(const File& file) {
    Layout l;
    l.map_projection = static_cast<int>(std::lround(file.number("MAP_PROJ")));
    l.dx_m = file.number("DX");
    l.dy_m = file.number("DY");
    if (!(l.dx_m > 0.0) || !(l.dy_m > 0.0)) throw input_error(file.path.string(), "DX and DY must be above 0");
    l.refine_x = refinement(file, "west_east_subgrid", "west_east");
    l.refine_y = refinement(file, "south_north_subgrid", "south_north");
    l.cols = file.dimension("west_east");
    l.rows = file.dimension("south_north");
    if (l.map_projection != 0)
        l.parallels = {file.number("TRUELAT1"), file.number("TRUELAT2"), file.number("MOAD_CEN_LAT"),
                       file.number("STAND_LON")};
    return l;
}

std::string projection_text(const File& file, const Layout& l) {
    const auto [true1, true2, centre, meridian] = l.parallels;
    switch (l.map_projection) {
        case 1:
            return fmt::format("+proj=lcc +lat_1={:.9g} +lat_2={:.9g} +lat_0={:.9g} +lon_0={:.9g} {}", true1, true2, centre,
                               meridian, kSphere);
        case 2:
            return fmt::format("+proj=stere +lat_0={} +lat_ts={:.9g} +lon_0={:.9g} {}", true1 < 0.0 ? -90 : 90, true1,
                               meridian, kSphere);
        case 3:
            return fmt::format("+proj=merc +lat_ts={:.9g} +lon_0={:.9g} {}", true1, meridian, kSphere);
        default:
            throw input_error(
                file.path.string(),
                fmt::format("MAP_PROJ {} is not supported; 1 (Lambert), 2 (polar stereographic), 3 (Mercator) and 0 "
                            "(idealised) are",
                            l.map_projection));
    }
}

/// First record of a coordinate of the atmosphere, row by row from the south.
std::vector<double> coordinates(const File& file, const char* name, const Layout& l) {
    auto array = NetcdfFile(file.path).read_record(name, 0);
    const std::size_t cells = static_cast<std::size_t>(l.cols) * static_cast<std::size_t>(l.rows);
    if (array.values.size() != cells)
        throw input_error(file.path.string(), fmt::format("{} has {} values in its first record, expected {}", name,
                                                          array.values.size(), cells));
    return std::move(array.values);
}

double float_step(double value) {
    const auto f = static_cast<float>(std::abs(value));
    return static_cast<double>(std::nextafter(f, std::numeric_limits<float>::max()) - f);
}

/// Fits the corner: mean over all cells of projected position minus its place in the regular grid.
void place_on_map(const File& file, const Layout& l, WrfSfire& wrf) {
    auto x = coordinates(file, "XLONG", l), y = coordinates(file, "XLAT", l);
    const auto [south, north] = std::minmax_element(y.begin(), y.end());
    if (*south == *north)
        throw input_error(file.path.string(), "XLAT is the same everywhere, as in idealised runs, but MAP_PROJ is not 0");
    constexpr double kMetresPerDegree = 6370000.0 * 3.14159265358979323846 / 180.0;
    const double resolution_m = kMetresPerDegree * std::max(float_step(x.front()), float_step(*north));
    CrsTransform(kGeographicCrs, wrf.crs_wkt).forward(x, y);
    double west = 0.0, bottom = 0.0;
    const auto each = [&](auto&& visit) {
        for (int r = 0; r < l.rows; ++r)
            for (int c = 0; c < l.cols; ++c) {
                const auto i = static_cast<std::size_t>(r) * static_cast<std::size_t>(l.cols) + static_cast<std::size_t>(c);
                visit(x[i] - (c + 0.5) * l.dx_m, y[i] - (r + 0.5) * l.dy_m);
            }
    };
    each([&](double dx, double dy) { west += dx, bottom += dy; });
    const auto cells = static_cast<double>(x.size());
    wrf.west_m = west / cells;
    wrf.north_m = bottom / cells + l.rows * l.dy_m;
    double worst = 0.0;
    each([&](double dx, double dy) { worst = std::max({worst, std::abs(dx - wrf.west_m), std::abs(dy - bottom / cells)}); });
    wrf.placement_residual_m = worst;
    if (!(worst <= 2.0 * resolution_m))
        throw input_error(
            file.path.string(),
            fmt::format("XLONG, XLAT lie up to {:.1f} m from a regular grid of DX = {:g} m in the projection that its "
                        "attributes name (float32 explains {:.1f} m): wrong MAP_PROJ, TRUELAT, STAND_LON or MOAD_CEN_LAT",
                        worst, l.dx_m, 2.0 * resolution_m));
}

void place(const File& file, const Layout& l, const std::optional<LocalPlacement>& placement, WrfSfire& wrf) {
    if (l.map_projection == 0) {
        if (!placement)
            throw input_error(file.path.string(),
                              "is an idealised run (MAP_PROJ 0) without a place on Earth; give crs, west_m and south_m");
        wrf.crs_wkt = parse_map_crs(placement->crs, "crs of the WRF run").wkt;
        wrf.west_m = placement->west_m;
        wrf.north_m = placement->south_m + l.rows * l.dy_m;
        return;
    }
    if (placement)
        throw input_error(file.path.string(), "has a map projection of its own; leave crs, west_m and south_m out");
    wrf.crs_wkt = parse_map_crs(projection_text(file, l), file.path.string()).wkt;
    place_on_map(file, l, wrf);
}

void add_moments(const File& file, WrfSfire& wrf) {
    const auto times = times_of(file);
    for (std::size_t i = 0; i < times.size(); ++i)
        wrf.moments.push_back({file.path, static_cast<int>(i), unix_seconds(times[i], file.path.string() + ", Times")});
}

std::set<std::string> variables_of(const File& file) {
    const auto names = file.root->GetMDArrayNames();
    return {names.begin(), names.end()};
}

/// In order of time; where two files hold the same moment, as a restart writes it again, the later file's counts.
void sort_moments(std::vector<WrfMoment>& moments) {
    std::stable_sort(moments.begin(), moments.end(), [](const auto& a, const auto& b) { return a.unix_s < b.unix_s; });
    std::vector<WrfMoment> unique;
    for (auto& moment : moments) {
        if (!unique.empty() && unique.back().unix_s == moment.unix_s) unique.pop_back();
        unique.push_back(std::move(moment));
    }
    moments = std::move(unique);
}

}  // namespace

WrfSfire open_wrf_sfire(const std::vector<std::filesystem::path>& files, const std::optional<LocalPlacement>& placement) {
    // It would turn every raster upside down, and nothing in an idealised run would tell.
    if (CPLGetConfigOption("GDAL_NETCDF_BOTTOMUP", nullptr) != nullptr)
        throw input_error("GDAL_NETCDF_BOTTOMUP",
                          "is set in the environment; WRF files are read in GDAL's own order, unset it");
    WrfSfire wrf;
    std::optional<Layout> first;
    for (const auto& path : files) {
        const File file(std::filesystem::absolute(path));
        const Layout layout = layout_of(file);
        if (!first) {
            first = layout;
            place(file, layout, placement, wrf);
            const auto start = file.text("SIMULATION_START_DATE");
            wrf.simulation_start_unix_s =
                unix_seconds(start.empty() ? file.text("START_DATE") : start, path.string() + ", START_DATE");
            wrf.variables = variables_of(file);
        } else {
            if (!(layout == *first))
                throw input_error(path.string(),
                                  fmt::format("has another grid or projection than {}", files.front().string()));
            std::set<std::string> both;
            for (const auto& name : variables_of(file))
                if (wrf.has(name)) both.insert(name);
            wrf.variables = std::move(both);
        }
        add_moments(file, wrf);
    }
    if (!first) throw input_error("WRF-SFIRE input", "no file given");
    if (wrf.moments.empty()) throw input_error(files.front().string(), "holds no record");
    sort_moments(wrf.moments);
    wrf.dx_m = first->dx_m;
    wrf.dy_m = first->dy_m;
    wrf.cols = first->cols;
    wrf.rows = first->rows;
    wrf.refine_x = first->refine_x;
    wrf.refine_y = first->refine_y;
    return wrf;
}

}  // namespace pyroscene::gis
