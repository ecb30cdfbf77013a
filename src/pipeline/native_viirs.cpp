// VIIRS level 1B and geolocation in netCDF-4: groups, variables, attributes and scaling of VNP02MOD, VNP02IMG, VNP03MOD and
// VNP03IMG (NASA VIIRS Level 1 Product User's Guide). docs/outputs.md says what differs.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "gis/netcdf_output.h"
#include "pipeline/native_swath.h"
#include "radiometry/planck.h"

namespace pyroscene::pipeline {
namespace {

constexpr double kFill = 65535.0, kBowtieDeleted = 65533.0, kMostCounts = 65527.0;
constexpr std::size_t kTableSize = 65536;
constexpr double kLongestReflective_um = 3.0;
using gis::Numbers;
using gis::SampleType;

const std::vector<std::string> kPixels{"number_of_lines", "number_of_pixels"};

Numbers ushorts(std::vector<double> values) { return {SampleType::UInt16, std::move(values)}; }
Numbers number(double value) { return {SampleType::Float32, {value}}; }

/// Level 1B letters of a platform: "NP" (Suomi NPP), "J1" (NOAA-20), "J2" (NOAA-21).
std::string platform_letters(const std::string& platform) {
    if (platform.find("20") != std::string::npos || platform.find("JPSS-1") != std::string::npos) return "J1";
    if (platform.find("21") != std::string::npos || platform.find("JPSS-2") != std::string::npos) return "J2";
    return "NP";
}

gis::ArrayFile file_of(const NativeJob& job, const Swath& swath, const std::string& short_name) {
    const auto [first, last] = time_span_s(job);
    const auto milliseconds = [](double t) {
        auto text = UtcTime{std::floor(t)}.iso8601();
        return text.substr(0, 19) + ".000Z";
    };
    gis::ArrayFile file;
    file.dimensions = {{"number_of_scans", static_cast<std::size_t>(swath.scans())},
                       {"number_of_lines", static_cast<std::size_t>(swath.lines)},
                       {"number_of_pixels", static_cast<std::size_t>(swath.samples)}};
    const auto letters = platform_letters(job.job.sensor.platform_name);
    file.attributes = {{"title", "synthetic image by Pyroscene, scenario " + job.job.scenario.name},
                       {"ShortName", short_name},
                       {"instrument", "VIIRS"},
                       {"platform", letters == "J1"   ? "JPSS-1"
                                    : letters == "J2" ? "JPSS-2"
                                                      : "Suomi-NPP"},
                       {"orbit_number", "0"},
                       {"time_coverage_start", milliseconds(first)},
                       {"time_coverage_end", milliseconds(last)},
                       {"Conventions", "CF-1.6"},
                       {"synthetic", "true"}};
    file.variables.push_back({"scan_line_attributes/scan_start_time",
                              {"number_of_scans"},
                              "seconds",
                              "start of the scan, seconds since 1993-01-01 TAI",
                              scan_start_tai93(job, swath),
                              SampleType::Float64,
                              {},
                              {}});
    return file;
}

void write_file(const NativeJob& job, const std::string& short_name, const gis::ArrayFile& file) {
    const double start = time_span_s(job)[0];
    gis::write_netcdf(
        job.file(fmt::format("{}.A{}.002.{}.nc", short_name, granule_time(start), granule_time_with_seconds(start))), file);
}

/// Pixels that the instrument does not send get a code of their own.
void mark_deleted(const NativeJob& job, const Swath& swath, std::vector<double>& counts) {
    for (std::size_t i = 0; i < counts.size(); ++i) {
        const int sample = static_cast<int>(i % static_cast<std::size_t>(swath.samples));
        const int line = static_cast<int>(i / static_cast<std::size_t>(swath.samples));
        if (sensors::scan_deletes(job.job.group.scan, sample, line % swath.lines_per_scan)) counts[i] = kBowtieDeleted;
    }
}

/// Brightness temperature of every count: the band's own Planck mean, inverted.
gis::ArrayVariable temperature_table(const sensors::Band& band, double step) {
    const radiometry::BandThermometer thermometer(band.response);
    gis::ArrayVariable table{"observation_data/" + band.id + "_brightness_temperature_lut",
                             {"number_of_LUT_values"},
                             "Kelvin",
                             band.id + " brightness temperature of each count",
                             std::vector<double>(kTableSize, -999.9),
                             SampleType::Float32,
                             -999.9,
                             {}};
    double most = 0.0;
    for (std::size_t count = 1; count <= static_cast<std::size_t>(kMostCounts); ++count) {
        const double T_K = thermometer.temperature_K(step * static_cast<double>(count));
        if (!std::isfinite(T_K)) continue;
        table.values[count] = T_K;
        most = std::max(most, T_K);
    }
    table.attributes = {{"valid_min", number(0.0)}, {"valid_max", number(std::ceil(most))}};
    return table;
}

void add_band(const NativeJob& job, const Swath& swath, std::size_t k, gis::ArrayFile& file) {
    const auto& band = job.band(k);
    const auto index = static_cast<std::ptrdiff_t>(k);
    const double step = radiance_step(job, index, kMostCounts);
    gis::ArrayVariable v{"observation_data/" + band.id, kPixels, "", "", {}, SampleType::UInt16, kFill, {}, {}};
    v.make = [&job, &swath, index, step](std::size_t) {
        auto counts = pack(swath, radiance_of(job, index), {step, 0.0, kFill, kFill});
        for (double& c : counts)
            if (c < 0.0) c = 0.0;
        mark_deleted(job, swath, counts);
        return counts;
    };
    const char* radiance_units = "Watts/meter^2/steradian/micrometer";
    v.attributes = {{"valid_min", ushorts({0.0})},
                    {"valid_max", ushorts({kMostCounts})},
                    {"flag_values", ushorts({65532.0, 65533.0, 65534.0})},
                    {"flag_meanings", "Missing_EV Bowtie_Deleted Cal_Fail"}};
    const auto add = [&](const char* key, gis::Attribute value) { v.attributes.emplace_back(key, std::move(value)); };
    add("add_offset", number(0.0));
    if (band.centre_um < kLongestReflective_um) {
        v.long_name = band.id + " earth view reflectance (times the cosine of the solar zenith angle)";
        add("scale_factor", number(step * reflectance_per_radiance(job, band)));
        add("radiance_scale_factor", number(step));
        add("radiance_add_offset", number(0.0));
        add("radiance_units", radiance_units);
    } else {
        v.long_name = band.id + " earth view radiance";
        v.unit = radiance_units;
        add("scale_factor", number(step));
        file.variables.push_back(temperature_table(band, step));
    }
    file.variables.push_back(std::move(v));
}

void write_geolocation(const NativeJob& job, const Swath& swath, const std::string& short_name) {
    auto file = file_of(job, swath, short_name);
    const auto add = [&](const char* name, const char* unit, GeolocationPlane plane, double scale, double fill) {
        std::vector<double> values(job.image.where(plane).begin(), job.image.where(plane).end());
        if (plane == kViewAzimuth || plane == kSunAzimuth)
            for (double& v : values) v = v > 180.0 ? v - 360.0 : v;
        const bool packed = scale != 0.0;
        gis::ArrayVariable v{std::string("geolocation_data/") + name,
                             kPixels,
                             unit,
                             "",
                             pack(swath, values, {scale, 0.0, fill, 32767.0}),
                             packed ? SampleType::Int16 : SampleType::Float32,
                             fill,
                             {}};
        if (packed)
            v.attributes = {{"scale_factor", number(scale)},
                            {"add_offset", number(0.0)},
                            {"valid_min", Numbers{SampleType::Int16, {-32767.0}}},
                            {"valid_max", Numbers{SampleType::Int16, {32767.0}}}};
        file.variables.push_back(std::move(v));
    };
    add("latitude", "degrees_north", kLatitude, 0.0, -999.9);
    add("longitude", "degrees_east", kLongitude, 0.0, -999.9);
    add("height", "meters", kHeight, 1.0, -32768.0);
    add("range", "meters", kRange, 100.0, -32768.0);
    add("sensor_zenith", "degrees", kViewZenith, 0.01, -32768.0);
    add("sensor_azimuth", "degrees", kViewAzimuth, 0.01, -32768.0);
    add("solar_zenith", "degrees", kSunZenith, 0.01, -32768.0);
    add("solar_azimuth", "degrees", kSunAzimuth, 0.01, -32768.0);
    write_file(job, short_name, file);
}

}  // namespace

void write_viirs(const NativeJob& job) {
    const auto& group = job.job.group.id;
    const char* kind = group == "i" ? "IMG" : group == "m" ? "MOD" : nullptr;
    if (kind == nullptr) {
        job.report.warn(
            fmt::format("acquisition '{}': the group '{}' has no level 1B form here", job.job.acquisition.id, group));
        return;
    }
    const auto swath = whole_swath(job);
    const auto letters = platform_letters(job.job.sensor.platform_name);
    const auto short_name = fmt::format("V{}02{}", letters, kind);
    auto file = file_of(job, swath, short_name);
    file.dimensions.emplace_back("number_of_LUT_values", kTableSize);
    for (std::size_t k = 0; k < job.job.bands.size(); ++k) add_band(job, swath, k, file);
    write_file(job, short_name, file);
    write_geolocation(job, swath, fmt::format("V{}03{}", letters, kind));
}

}  // namespace pyroscene::pipeline
