#include "gis/tags.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_priv.h>

#include "base/error.h"
#include "gis/crs.h"

namespace pyroscene::gis {

std::map<std::string, std::string> default_metadata(GDALMajorObject& object) {
    std::map<std::string, std::string> items;
    for (char** item = object.GetMetadata(); item != nullptr && *item != nullptr; ++item) {
        const std::string text(*item);
        if (const auto equals = text.find('='); equals != std::string::npos)
            items.emplace(text.substr(0, equals), text.substr(equals + 1));
    }
    return items;
}

template <class T>
void StatisticsSum::add(std::span<const T> pixels) noexcept {
    std::size_t i = 0;
    const auto one = [&] { lanes_[pixels_++ % lanes_.size()].add(static_cast<double>(pixels[i++]), first_); };
    for (; std::isnan(first_) && i < pixels.size(); one()) first_ = static_cast<double>(pixels[i]);
    while (pixels_ % lanes_.size() != 0 && i < pixels.size()) one();
    auto lanes = lanes_;  // in registers
    const std::size_t begin = i;
    for (; i + lanes.size() <= pixels.size(); i += lanes.size())
        for (std::size_t k = 0; k < lanes.size(); ++k) lanes[k].add(static_cast<double>(pixels[i + k]), first_);
    lanes_ = lanes;
    pixels_ += i - begin;
    while (i < pixels.size()) one();
}
template void StatisticsSum::add(std::span<const float>) noexcept;
template void StatisticsSum::add(std::span<const double>) noexcept;

BandStatistics StatisticsSum::statistics() const noexcept {
    Lane all;
    for (const Lane& lane : lanes_) {
        all.minimum = std::min(all.minimum, lane.minimum);
        all.maximum = std::max(all.maximum, lane.maximum);
        all.sum += lane.sum;
        all.sum_of_squares += lane.sum_of_squares;
        all.valid += lane.valid;
    }
    BandStatistics s;
    s.any = all.valid > 0;
    if (!s.any) return s;
    const auto n = static_cast<double>(all.valid);
    s.minimum = all.minimum;
    s.maximum = all.maximum;
    s.mean = first_ + all.sum / n;
    s.standard_deviation = std::sqrt(std::max(0.0, all.sum_of_squares / n - (all.sum / n) * (all.sum / n)));
    s.valid_percent = 100.0 * n / static_cast<double>(pixels_);
    return s;
}

namespace {

class TagList {
public:
    void add(int band, const char* domain, const std::string& key, std::string value) {
        tags_.push_back({.band = band, .domain = domain, .key = key, .value = std::move(value)});
    }
    std::vector<Tag> take() { return std::move(tags_); }

private:
    std::vector<Tag> tags_;
};

/// "{a, b}" as ENVI headers write lists; the separators inside an element give way.
template <class Range, class Text>
std::string envi_list(const Range& elements, Text text) {
    std::string list = "{";
    for (const auto& element : elements) {
        std::string one = text(element);
        std::replace_if(
            one.begin(), one.end(), [](char c) { return c == ',' || c == '{' || c == '}'; }, ';');
        list += (list.size() > 1 ? ", " : "") + one;
    }
    return list + "}";
}

/// Digits that a sum of decimal fractions does not spoil.
std::string number(double value) { return fmt::format("{:.12g}", value); }

void add_time(TagList& tags, const std::string& iso, const std::string& subject) {
    int year = 0, month = 0, day = 0, hour = 0, minute = 0;
    double second = 0.0;
    if (std::sscanf(iso.c_str(), "%4d-%2d-%2dT%2d:%2d:%lf", &year, &month, &day, &hour, &minute, &second) != 6)
        throw runtime_error(subject, fmt::format("acquisition time '{}' is not of the form 2017-07-15T22:00:00Z", iso));
    const int whole_second = static_cast<int>(second);
    tags.add(0, "", "ACQUISITION_DATE", iso);
    tags.add(0, "", "TIFFTAG_DATETIME",
             fmt::format("{:04}:{:02}:{:02} {:02}:{:02}:{:02}", year, month, day, hour, minute, whole_second));
    tags.add(0, "IMAGERY", "ACQUISITIONDATETIME",
             fmt::format("{:04}-{:02}-{:02} {:02}:{:02}:{:02}", year, month, day, hour, minute, whole_second));
}

void add_wavelengths(TagList& tags, const std::vector<OutputBand>& bands) {
    for (std::size_t i = 0; i < bands.size(); ++i) {
        const auto& band = bands[i];
        const int b = static_cast<int>(i) + 1;
        if (!band.wavelength_um) continue;
        tags.add(b, "", "wavelength", number(*band.wavelength_um));
        tags.add(b, "", "wavelength_units", "Micrometers");
        tags.add(b, "", "bbl", "1");
        tags.add(b, "IMAGERY", "CENTRAL_WAVELENGTH_UM", number(*band.wavelength_um));
        if (!band.fwhm_um) continue;
        tags.add(b, "", "fwhm", number(*band.fwhm_um));
        tags.add(b, "IMAGERY", "FWHM_UM", number(*band.fwhm_um));
    }
    const auto all = [&](auto has) { return !bands.empty() && std::all_of(bands.begin(), bands.end(), has); };
    if (!all([](const OutputBand& b) { return b.wavelength_um.has_value(); })) return;
    tags.add(0, "ENVI", "wavelength", envi_list(bands, [](const OutputBand& b) { return number(*b.wavelength_um); }));
    tags.add(0, "ENVI", "wavelength_units", "Micrometers");
    if (all([](const OutputBand& b) { return b.fwhm_um.has_value(); }))
        tags.add(0, "ENVI", "fwhm", envi_list(bands, [](const OutputBand& b) { return number(*b.fwhm_um); }));
}

void add_geolocation(TagList& tags, const std::filesystem::path& file) {
    const std::string path = std::filesystem::absolute(file).lexically_normal().string();
    const std::pair<const char*, std::string> items[] = {
        {"X_DATASET", path},
        {"X_BAND", "1"},
        {"Y_DATASET", path},
        {"Y_BAND", "2"},
        {"PIXEL_OFFSET", "0"},
        {"PIXEL_STEP", "1"},
        {"LINE_OFFSET", "0"},
        {"LINE_STEP", "1"},
        {"SRS", parse_crs(kGeographicCrs, "geolocation").wkt},
        {"GEOREFERENCING_CONVENTION", "PIXEL_CENTER"},
    };
    for (const auto& [key, value] : items) tags.add(0, "GEOLOCATION", key, value);
}

void add_classes(TagList& tags, const OutputRaster& raster) {
    const auto same = [](const std::string& name) { return name; };
    const std::string names = envi_list(raster.class_names, same);
    tags.add(0, "ENVI", "classes", number(static_cast<double>(raster.class_names.size())));
    tags.add(0, "ENVI", "class_names", names);
    std::vector<short> lookup;
    for (std::size_t i = 0; i < raster.class_names.size(); ++i) {
        const ClassColour c = class_colour(i);
        lookup.insert(lookup.end(), {c.red, c.green, c.blue});
    }
    tags.add(0, "ENVI", "class_lookup", envi_list(lookup, [](short v) { return std::to_string(v); }));
    for (std::size_t b = 1; b <= raster.bands.size(); ++b) tags.add(static_cast<int>(b), "", "class_names", names);
}

void add_statistics(TagList& tags, const std::vector<BandStatistics>& statistics) {
    for (std::size_t i = 0; i < statistics.size(); ++i) {
        const auto& s = statistics[i];
        const int band = static_cast<int>(i) + 1;
        if (s.any) {
            tags.add(band, "", "STATISTICS_MINIMUM", number(s.minimum));
            tags.add(band, "", "STATISTICS_MAXIMUM", number(s.maximum));
            tags.add(band, "", "STATISTICS_MEAN", number(s.mean));
            tags.add(band, "", "STATISTICS_STDDEV", number(s.standard_deviation));
        }
        tags.add(band, "", "STATISTICS_VALID_PERCENT", fmt::format("{:.6g}", s.valid_percent));
    }
}

}  // namespace

std::vector<Tag> output_tags(const OutputRaster& raster, const std::vector<BandStatistics>& statistics,
                             const std::string& subject) {
    TagList tags;
    for (const auto& [key, value] : raster.metadata) tags.add(0, "", key, value);
    if (raster.synthetic) tags.add(0, "", "synthetic", "true");
    if (!raster.acquisition_time.empty()) add_time(tags, raster.acquisition_time, subject);
    if (raster.geolocation) add_geolocation(tags, *raster.geolocation);
    tags.add(0, "ENVI", "band_names", envi_list(raster.bands, [](const OutputBand& b) { return b.description; }));
    tags.add(0, "ENVI", "data_ignore_value", raster.classes ? "255" : "nan");
    if (raster.classes) add_classes(tags, raster);
    add_wavelengths(tags, raster.bands);
    for (std::size_t i = 0; i < raster.bands.size(); ++i)
        for (const auto& [key, value] : raster.bands[i].metadata) tags.add(static_cast<int>(i) + 1, "", key, value);
    add_statistics(tags, statistics);
    return tags.take();
}

ClassColour class_colour(std::size_t class_index) noexcept {
    // Vegetation, flame, scar, water and neutrals first; classes beyond the list repeat it.
    constexpr std::array<ClassColour, 10> kColours{{{86, 125, 70},
                                                    {230, 60, 20},
                                                    {60, 50, 45},
                                                    {70, 120, 190},
                                                    {190, 190, 190},
                                                    {245, 190, 60},
                                                    {140, 90, 50},
                                                    {150, 110, 180},
                                                    {90, 180, 170},
                                                    {240, 240, 240}}};
    return kColours[class_index % kColours.size()];
}

bool is_derived_band_key(const std::string& key) {
    return key == "wavelength" || key == "wavelength_units" || key == "fwhm" || key == "bbl" || key == "class_names" ||
           key.starts_with("STATISTICS_");
}

}  // namespace pyroscene::gis
