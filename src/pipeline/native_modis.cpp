// MODIS level 1B and geolocation: data sets, attributes and scaling of MOD021KM, MOD02HKM, MOD02QKM and MOD03 (MODIS Level 1B
// Product User's Guide, MCM-PUG-01-U-DNCN, and the MOD03 file specification) in HDF4. docs/outputs.md says what differs.
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "gis/hdf4_output.h"
#include "pipeline/native_swath.h"

namespace pyroscene::pipeline {
namespace {

constexpr double kFill = 65535.0, kSaturated = 65533.0, kMostCounts = 32767.0;
using gis::Numbers;
using gis::SampleType;

/// One data set of a level 1B file: its bands as MODIS names them. 13 and 14 have two gains, which are one band here.
struct BandSet {
    const char *name, *band_dimension, *long_name;
    std::vector<const char*> bands;
    bool reflective = false;
};

/// Which file a camera group fills.
struct Resolution {
    const char *group, *product, *frames;
    std::vector<BandSet> sets;
};

const Resolution* resolution_of(const std::string& group) {
    static const std::vector<Resolution> kAll{
        {"1km",
         "021KM",
         "Max_EV_frames",
         {{"EV_250_Aggr1km_RefSB",
           "Band_250M",
           "Earth View 250M Aggregated 1km Reflective Solar Bands Scaled Integers",
           {"1", "2"},
           true},
          {"EV_500_Aggr1km_RefSB",
           "Band_500M",
           "Earth View 500M Aggregated 1km Reflective Solar Bands Scaled Integers",
           {"3", "4", "5", "6", "7"},
           true},
          {"EV_1KM_RefSB",
           "Band_1KM_RefSB",
           "Earth View 1KM Reflective Solar Bands Scaled Integers",
           {"8", "9", "10", "11", "12", "13lo", "13hi", "14lo", "14hi", "15", "16", "17", "18", "19", "26"},
           true},
          {"EV_1KM_Emissive",
           "Band_1KM_Emissive",
           "Earth View 1KM Emissive Bands Scaled Integers",
           {"20", "21", "22", "23", "24", "25", "27", "28", "29", "30", "31", "32", "33", "34", "35", "36"},
           false}}},
        {"500m",
         "02HKM",
         "2*Max_EV_frames",
         {{"EV_250_Aggr500_RefSB",
           "Band_250M",
           "Earth View 250M Aggregated 500M Reflective Solar Bands Scaled Integers",
           {"1", "2"},
           true},
          {"EV_500_RefSB",
           "Band_500M",
           "Earth View 500M Reflective Solar Bands Scaled Integers",
           {"3", "4", "5", "6", "7"},
           true}}},
        {"250m",
         "02QKM",
         "4*Max_EV_frames",
         {{"EV_250_RefSB", "Band_250M", "Earth View 250M Reflective Solar Bands Scaled Integers", {"1", "2"}, true}}}};
    for (const auto& r : kAll)
        if (group == r.group) return &r;
    return nullptr;
}

std::string sensor_band_id(const std::string& modis_name) {
    return fmt::format("B{:02d}", std::stoi(modis_name));  // "13lo" -> 13
}

/// Counts of one band, or fill where it was not rendered; saturated pixels get the instrument's code.
std::vector<double> counts_of(const NativeJob& job, const Swath& swath, std::ptrdiff_t k, double step) {
    if (k < 0) return std::vector<double>(swath.size(), kFill);
    const auto& band = job.band(static_cast<std::size_t>(k));
    const auto radiance = radiance_of(job, k);
    auto plane = pack(swath, radiance, {step, 0.0, kFill, kMostCounts});
    // The detector clips to the last quantum; half of one below the limit is at the limit.
    if (band.saturation_radiance_W_m2_sr_um) {
        const double limit = *band.saturation_radiance_W_m2_sr_um * (1.0 - 0.5 / std::pow(2.0, band.bits.value_or(12)));
        for (std::size_t i = 0; i < plane.size(); ++i)
            if (swath.pixel[i] >= 0 && radiance[static_cast<std::size_t>(swath.pixel[i])] >= limit) plane[i] = kSaturated;
    }
    for (double& value : plane) value = value < 0.0 ? 0.0 : value;  // noise about zero
    return plane;
}

void add_band_set(const NativeJob& job, const Swath& swath, const Resolution& resolution, const BandSet& set,
                  gis::ArrayFile& file) {
    const std::vector<std::string> dimensions{set.band_dimension, "10*nscans", resolution.frames};
    file.dimensions.emplace_back(set.band_dimension, set.bands.size());
    gis::ArrayVariable counts{set.name, dimensions, "none", set.long_name, {}, SampleType::UInt16, kFill, {}, {}};
    gis::ArrayVariable uncertainty{std::string(set.name) + "_Uncert_Indexes",
                                   dimensions,
                                   "none",
                                   "uncertainty index; 15 = not usable",
                                   {},
                                   SampleType::UInt8,
                                   255.0,
                                   {},
                                   {}};
    Numbers radiance_scales, radiance_offsets, reflectance_scales, reflectance_offsets;
    std::vector<std::ptrdiff_t> rendered;
    for (const char* name : set.bands) {
        const auto k = rendered_band(job, sensor_band_id(name));
        const double step = k < 0 ? 1.0 : radiance_step(job, k, kMostCounts);
        rendered.push_back(k);
        radiance_scales.values.push_back(step);
        radiance_offsets.values.push_back(0.0);
        reflectance_offsets.values.push_back(0.0);
        reflectance_scales.values.push_back(
            k < 0 || !set.reflective ? step : step * reflectance_per_radiance(job, job.band(static_cast<std::size_t>(k))));
    }
    counts.make = [&job, &swath, rendered, steps = radiance_scales.values](std::size_t band) {
        return counts_of(job, swath, rendered[band], steps[band]);
    };
    uncertainty.make = [make = counts.make](std::size_t band) {
        auto index = make(band);
        for (double& value : index) value = value > kMostCounts ? 15.0 : 0.0;
        return index;
    };
    counts.attributes = {{"band_names", fmt::format("{}", fmt::join(set.bands, ","))},
                         {"valid_range", Numbers{SampleType::UInt16, {0.0, kMostCounts}}},
                         {"radiance_scales", radiance_scales},
                         {"radiance_offsets", radiance_offsets},
                         {"radiance_units", "Watts/m^2/micrometer/steradian"}};
    if (set.reflective) {
        counts.attributes.emplace_back("reflectance_scales", reflectance_scales);
        counts.attributes.emplace_back("reflectance_offsets", reflectance_offsets);
        counts.attributes.emplace_back("reflectance_units", "none");
    }
    file.variables.push_back(std::move(counts));
    file.variables.push_back(std::move(uncertainty));
}

/// Text in the object description language of EOS metadata.
std::string odl_object(const char* name, const std::string& value) {
    return fmt::format("OBJECT = {0}\nNUM_VAL = 1\nVALUE = \"{1}\"\nEND_OBJECT = {0}\n", name, value);
}

std::string core_metadata(const NativeJob& job, const std::string& short_name) {
    const auto [first, last] = time_span_s(job);
    const auto day = [](double t) { return UtcTime{t}.iso8601().substr(0, 10); };
    const auto clock = [](double t) {
        const double s = std::fmod(t, 86400.0);
        const auto whole = static_cast<int>(s);
        return fmt::format("{:02d}:{:02d}:{:09.6f}", whole / 3600, whole / 60 % 60, s - 60.0 * (whole / 60));
    };
    const bool aqua = job.job.sensor.platform_name.find("Aqua") != std::string::npos;
    std::string text = "GROUP = INVENTORYMETADATA\nGROUPTYPE = MASTERGROUP\nGROUP = COLLECTIONDESCRIPTIONCLASS\n";
    text += odl_object("SHORTNAME", short_name) + "END_GROUP = COLLECTIONDESCRIPTIONCLASS\nGROUP = RANGEDATETIME\n";
    text += odl_object("RANGEBEGINNINGDATE", day(first)) + odl_object("RANGEBEGINNINGTIME", clock(first));
    text += odl_object("RANGEENDINGDATE", day(last)) + odl_object("RANGEENDINGTIME", clock(last));
    text +=
        "END_GROUP = RANGEDATETIME\nGROUP = ASSOCIATEDPLATFORMINSTRUMENTSENSOR\n"
        "OBJECT = ASSOCIATEDPLATFORMINSTRUMENTSENSORCONTAINER\nCLASS = \"1\"\n";
    text += odl_object("ASSOCIATEDSENSORSHORTNAME", "MODIS") +
            odl_object("ASSOCIATEDPLATFORMSHORTNAME", aqua ? "Aqua" : "Terra") +
            odl_object("ASSOCIATEDINSTRUMENTSHORTNAME", "MODIS");
    return text +
           "END_OBJECT = ASSOCIATEDPLATFORMINSTRUMENTSENSORCONTAINER\n"
           "END_GROUP = ASSOCIATEDPLATFORMINSTRUMENTSENSOR\nEND_GROUP = INVENTORYMETADATA\nEND\n";
}

void write_file(const NativeJob& job, const std::string& product, gis::ArrayFile& file) {
    const bool aqua = job.job.sensor.platform_name.find("Aqua") != std::string::npos;
    const std::string short_name = (aqua ? "MYD" : "MOD") + product;
    file.attributes = {{"CoreMetadata.0", core_metadata(job, short_name)},
                       {"title", "synthetic image by Pyroscene, scenario " + job.job.scenario.name}};
    const double start = time_span_s(job)[0];
    gis::write_hdf4(
        job.file(fmt::format("{}.A{}.061.{}.hdf", short_name, granule_time(start), granule_time_with_seconds(start))), file);
}

void write_geolocation(const NativeJob& job, const Swath& swath, const char* frames) {
    gis::ArrayFile file;
    file.dimensions = {{"nscans*10", static_cast<std::size_t>(swath.lines)},
                       {frames, static_cast<std::size_t>(swath.samples)},
                       {"nscans", static_cast<std::size_t>(swath.scans())}};
    const auto add = [&](const char* name, const char* unit, GeolocationPlane plane, SampleType type, double scale,
                         double fill) {
        std::vector<double> values(job.image.where(plane).begin(), job.image.where(plane).end());
        if (plane == kViewAzimuth || plane == kSunAzimuth)
            for (double& v : values) v = v > 180.0 ? v - 360.0 : v;
        gis::ArrayVariable v{
            name, {"nscans*10", frames}, unit, "", pack(swath, values, {scale, 0.0, fill, 65535.0}), type, fill, {}, {}};
        if (scale != 0.0) v.attributes.emplace_back("scale_factor", Numbers{SampleType::Float64, {scale}});
        file.variables.push_back(std::move(v));
    };
    add("Latitude", "degrees", kLatitude, SampleType::Float32, 0.0, -999.0);
    add("Longitude", "degrees", kLongitude, SampleType::Float32, 0.0, -999.0);
    add("Height", "meters", kHeight, SampleType::Int16, 1.0, -32767.0);
    add("SensorZenith", "degrees", kViewZenith, SampleType::Int16, 0.01, -32767.0);
    add("SensorAzimuth", "degrees", kViewAzimuth, SampleType::Int16, 0.01, -32767.0);
    add("Range", "meters", kRange, SampleType::UInt16, 25.0, 0.0);
    add("SolarZenith", "degrees", kSunZenith, SampleType::Int16, 0.01, -32767.0);
    add("SolarAzimuth", "degrees", kSunAzimuth, SampleType::Int16, 0.01, -32767.0);
    file.variables.push_back(
        {"EV start time", {"nscans"}, "seconds", "", scan_start_tai93(job, swath), SampleType::Float64, {}, {}, {}});
    write_file(job, "03", file);
}

}  // namespace

void write_modis(const NativeJob& job) {
    const Resolution* resolution = resolution_of(job.job.group.id);
    if (resolution == nullptr) {
        job.report.warn(fmt::format("acquisition '{}': MODIS level 1B has no place for the group '{}'",
                                    job.job.acquisition.id, job.job.group.id));
        return;
    }
    const auto swath = whole_swath(job);
    gis::ArrayFile file;
    file.dimensions = {{"10*nscans", static_cast<std::size_t>(swath.lines)},
                       {resolution->frames, static_cast<std::size_t>(swath.samples)}};
    for (const auto& set : resolution->sets) add_band_set(job, swath, *resolution, set, file);
    write_file(job, resolution->product, file);
    if (job.job.group.id == "1km") write_geolocation(job, swath, "mframes");
}

}  // namespace pyroscene::pipeline
