#include "gis/landscape.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>
#include <gdal_priv.h>

#include "base/constants.h"
#include "base/error.h"
#include "gis/crs.h"
#include "gis/gdal_support.h"
#include "gis/memory_raster.h"
#include "gis/raster_source.h"
#include "gis/units.h"

namespace pyroscene::gis {
namespace {

constexpr double kUsualNodata = -9999.0;
constexpr int kFewestBands = 5, kMostBands = 8;

/// What a band is, how LANDFIRE stores it, and what it can be.
struct BandKind {
    const char *name, *lcp_key, *landfire_unit, *unit;
    double least, most;  ///< in `unit`
};
constexpr double kAny = std::numeric_limits<double>::infinity();
constexpr std::array<BandKind, kMostBands> kBands{{{"elevation", "ELEVATION", "m", "m", -500.0, 9000.0},
                                                   {"slope", "SLOPE", "degree", "", -kAny, kAny},
                                                   {"aspect", "ASPECT", "degree", "", -kAny, kAny},
                                                   {"fuel model", "FUEL_MODEL", "", "", -kAny, kAny},
                                                   {"canopy cover", "CANOPY_COV", "percent", "1", 0.0, 1.0},
                                                   {"canopy height", "CANOPY_HT", "m*10", "m", 0.0, 150.0},
                                                   {"canopy base height", "CBH", "m*10", "m", 0.0, 150.0},
                                                   {"canopy bulk density", "CBD", "kg m-3*100", "", -kAny, kAny}}};
const BandKind& kind_of(int band) { return kBands[static_cast<std::size_t>(band - 1)]; }

/// A unit text that may say by what the values were multiplied: "m*10", "Meters x 10".
struct StoredUnit {
    std::string unit;
    double scale = 1.0;
};
StoredUnit parse_stored_unit(const std::string& text) {
    const auto mark = text.find_last_of("*x");
    int times = 0;
    if (mark == std::string::npos) return {text};
    const auto digits = text.find_first_not_of(' ', mark + 1);
    if (digits == std::string::npos) return {text};
    const char* const end = text.data() + text.size();
    if (const auto read = std::from_chars(text.data() + digits, end, times); read.ptr != end || times <= 0) return {text};
    const auto last = text.find_last_not_of(' ', mark == 0 ? 0 : mark - 1);
    return {text.substr(0, last + 1), 1.0 / times};
}

std::string unit_text(GDALRasterBand& band, const BandKind& kind) {
    if (const char* lcp = band.GetMetadataItem(fmt::format("{}_UNIT_NAME", kind.lcp_key).c_str())) return lcp;
    const std::string tag = band.GetUnitType();
    return tag.empty() ? kind.landfire_unit : tag;
}

/// CRS of the file or the user's; both must agree, and with the header of an LCP.
CrsInfo landscape_crs(GDALDataset& dataset, const std::string& subject, const std::string& given) {
    const char* found = dataset.GetProjectionRef();
    const bool in_file = found != nullptr && *found != '\0';
    if (!in_file && given.empty())
        throw input_error(subject,
                          "does not say its coordinate reference system (an .lcp has it in a .prj beside it); give 'crs'");
    CrsInfo crs = in_file ? parse_crs(found, subject) : parse_crs(given, "inputs.landscape.crs");
    if (in_file && !given.empty() && !same_crs(crs.wkt, given))
        throw input_error(subject, fmt::format("says '{}', but inputs.landscape.crs '{}'", crs.name, given));
    if (!crs.geographic && !crs.projected)
        throw input_error(subject, fmt::format("'{}' is neither geographic nor projected", crs.name));
    if (const char* linear = dataset.GetMetadataItem("LINEAR_UNIT"); linear != nullptr && crs.projected) {
        const auto header = unit_conversion(linear, "m");
        constexpr double kSurveyFoot = 1e-5;  // relative difference of the two feet
        if (!header || std::abs(header->scale / crs.metres_per_unit - 1.0) > kSurveyFoot)
            throw input_error(subject,
                              fmt::format("its header counts in {}, its coordinate reference system '{}' in units of {} m",
                                          linear, crs.name, crs.metres_per_unit));
    }
    return crs;
}

/// Says of the band in memory what the file means.
void declare_band(GDALRasterBand& band, const BandKind& kind, const std::string& subject) {
    int present = 0;
    band.GetNoDataValue(&present);
    if (present == 0) band.SetNoDataValue(kUsualNodata);
    const std::string text = unit_text(band, kind);
    const StoredUnit stored = parse_stored_unit(text);
    if (*kind.unit == '\0') {
        band.SetUnitType("");
        return;
    }
    require_unit(subject, stored.unit, kind.unit);
    band.SetUnitType(stored.unit.c_str());
    if (stored.scale != 1.0) band.SetScale(stored.scale * band.GetScale());
}

std::vector<float> read_all(const std::filesystem::path& raster, int band) {
    const auto source = open_band(raster, band, kind_of(band).unit);
    return read_window(source, {0, 0, source.cols, source.rows});
}

void check_range(const std::filesystem::path& raster, int band, const std::string& subject) {
    const auto& kind = kind_of(band);
    for (const float value : read_all(raster, band))
        if (value < kind.least || value > kind.most)
            throw input_error(
                subject,
                fmt::format("{} of {:g}{}{}, expected {:g} to {:g}; is its unit or its nodata value wrong?", kind.name,
                            value, *kind.unit == 'm' ? " " : "", *kind.unit == 'm' ? kind.unit : "", kind.least, kind.most));
}

/// Sums of a correlation and of the distances from both readings of a slope.
struct SlopeFit {
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, yy = 0.0, xy = 0.0, off_degrees = 0.0, off_percent = 0.0;

    void add(double tangent, double stored) {
        const double degrees = std::atan(tangent) / kDegree_rad;
        n += 1.0;
        x += degrees;
        y += stored;
        xx += degrees * degrees;
        yy += stored * stored;
        xy += degrees * stored;
        off_degrees += std::abs(stored - degrees);
        off_percent += std::abs(stored - 100.0 * tangent);
    }
    [[nodiscard]] std::string note(bool says_percent) const {
        constexpr double kLeastCells = 20.0, kFlat_deg2 = 1.0, kFits = 0.5, kClearly = 0.5;
        const double sxx = xx - x * x / n, syy = yy - y * y / n, sxy = xy - x * y / n;
        if (n < kLeastCells || sxx / n < kFlat_deg2) return {};
        const double correlation = syy > 0.0 ? sxy / std::sqrt(sxx * syy) : 0.0;
        if (correlation < kFits)
            return fmt::format(
                "the slope band does not fit the elevations (correlation {:.2f}); slopes are taken from the elevations",
                correlation);
        const bool wrong = says_percent ? off_degrees < kClearly * off_percent : off_percent < kClearly * off_degrees;
        if (!wrong) return {};
        return fmt::format("the slope band says {}, but by the elevations it holds {}; slopes are taken from the elevations",
                           says_percent ? "per cent" : "degrees", says_percent ? "degrees" : "per cent");
    }
};

/// Compares the slope band with the slope of the elevations (Horn 1981).
std::string slope_note(const std::filesystem::path& raster, bool says_percent) {
    const auto source = open_band(raster, kElevation, "m");
    const auto z = read_all(raster, kElevation), slope = read_all(raster, kSlope);
    const auto& gt = source.geotransform;
    constexpr double kDegreeOfMeridian_m = 111320.0;
    const double north = gt[3] + 0.5 * source.rows * gt[5];
    const double unit_m = source.crs.geographic ? kDegreeOfMeridian_m : source.crs.metres_per_unit;
    const double east_m = unit_m * std::hypot(gt[1], gt[4]) * (source.crs.geographic ? std::cos(north * kDegree_rad) : 1.0);
    const double north_m = unit_m * std::hypot(gt[2], gt[5]);
    SlopeFit fit;
    for (int row = 1; row + 1 < source.rows; ++row)
        for (int col = 1; col + 1 < source.cols; ++col) {
            const auto at = [&](int dy, int dx) {
                return static_cast<double>(z[static_cast<std::size_t>(row + dy) * static_cast<std::size_t>(source.cols) +
                                             static_cast<std::size_t>(col + dx)]);
            };
            const double zx =
                (at(-1, 1) + 2 * at(0, 1) + at(1, 1) - at(-1, -1) - 2 * at(0, -1) - at(1, -1)) / (8.0 * east_m);
            const double zy =
                (at(-1, -1) + 2 * at(-1, 0) + at(-1, 1) - at(1, -1) - 2 * at(1, 0) - at(1, 1)) / (8.0 * north_m);
            const double stored =
                slope[static_cast<std::size_t>(row) * static_cast<std::size_t>(source.cols) + static_cast<std::size_t>(col)];
            if (const double tangent = std::hypot(zx, zy); std::isfinite(tangent + stored)) fit.add(tangent, stored);
        }
    return fit.note(says_percent);
}

}  // namespace

Landscape open_landscape(const std::filesystem::path& file, const std::string& crs) {
    const std::string subject = file.string();
    Landscape land;
    land.raster = memory_name("landscape", subject + "|" + crs, "landscape", "vrt");
    bool slope_in_percent = false;
    {
        const auto source = open_raster(file);
        land.bands = std::min(source->GetRasterCount(), kMostBands);
        if (land.bands < kFewestBands)
            throw input_error(
                subject,
                fmt::format("has {} band(s), expected at least {}: elevation, slope, aspect, fuel model, canopy cover",
                            land.bands, kFewestBands));
        require_geotransform(*source, subject);
        const CrsInfo found = landscape_crs(*source, subject, crs);
        const std::string slope_unit = unit_text(*source->GetRasterBand(kSlope), kind_of(kSlope));
        slope_in_percent = unit_conversion(slope_unit, "1").has_value() && !unit_conversion(slope_unit, "degree");
        const GdalErrors errors;
        auto* driver = GetGDALDriverManager()->GetDriverByName("VRT");
        const DatasetPtr copy(driver->CreateCopy(land.raster.c_str(), source.get(), FALSE, nullptr, nullptr, nullptr));
        if (!copy) throw runtime_error(subject, "cannot be wrapped in memory: " + errors.message());
        copy->SetProjection(found.wkt.c_str());
        for (int band = 1; band <= land.bands; ++band)
            declare_band(*copy->GetRasterBand(band), kind_of(band), fmt::format("{}, band {}", subject, band));
    }
    for (const int band : {kElevation, kCanopyCover, kCanopyHeight})
        if (band <= land.bands) check_range(land.raster, band, fmt::format("{}, band {}", subject, band));
    for (const float code : read_all(land.raster, kFuelModel))
        if (!std::isnan(code)) land.fuel_codes.insert(static_cast<int>(code));
    land.slope_note = slope_note(land.raster, slope_in_percent);
    return land;
}

std::filesystem::path raster_of_codes(const Landscape& landscape, const std::map<int, double>& value_of_code,
                                      const std::string& unit) {
    const auto source = open_band(landscape.raster, kFuelModel, "");
    auto values = read_all(landscape.raster, kFuelModel);
    for (float& value : values) {
        const auto known = std::isnan(value) ? value_of_code.end() : value_of_code.find(static_cast<int>(value));
        value = known == value_of_code.end() ? 0.0F : static_cast<float>(known->second);
    }
    MemoryRaster raster{source.cols, source.rows, source.geotransform, source.crs.wkt, unit, {}};
    raster.bands.push_back(std::move(values));
    return keep_in_memory("landscape", landscape.raster.string(), "of_codes", raster);
}

}  // namespace pyroscene::gis
