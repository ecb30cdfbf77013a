#include "pipeline/native_swath.h"

#include <algorithm>
#include <cmath>
#include <ctime>

#include <fmt/format.h>

#include "base/constants.h"
#include "imagery/image_channels.h"
#include "radiometry/sun.h"

namespace pyroscene::pipeline {

Swath whole_swath(const NativeJob& job) {
    const auto& r = job.image;
    Swath swath;
    swath.lines_per_scan = std::max(1, r.scans.lines_per_scan);
    swath.samples = std::max(job.job.group.scan.samples(), r.samples);
    const int before = r.scans.first_line_of_scan;
    swath.lines = (before + r.lines + swath.lines_per_scan - 1) / swath.lines_per_scan * swath.lines_per_scan;
    const auto& metadata = r.radiance->info().metadata;
    const auto first = metadata.find("FIRST_SAMPLE");
    const int first_sample = first == metadata.end() ? 0 : std::stoi(first->second);
    swath.pixel.assign(static_cast<std::size_t>(swath.samples) * static_cast<std::size_t>(swath.lines), -1);
    for (int line = 0; line < r.lines; ++line)
        for (int s = 0; s < r.samples; ++s)
            swath.pixel[static_cast<std::size_t>(before + line) * static_cast<std::size_t>(swath.samples) +
                        static_cast<std::size_t>(first_sample + s)] = static_cast<std::ptrdiff_t>(line) * r.samples + s;
    return swath;
}

std::vector<double> pack(const Swath& swath, std::span<const double> plane, const Packing& packing) {
    std::vector<double> out(swath.size(), packing.fill);
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (swath.pixel[i] < 0) continue;
        const double value = plane[static_cast<std::size_t>(swath.pixel[i])];
        if (std::isnan(value)) continue;
        out[i] = packing.scale == 0.0
                     ? value
                     : std::clamp(std::round(packing.offset + value / packing.scale), -packing.most, packing.most);
    }
    return out;
}

std::array<double, 2> time_span_s(const NativeJob& job) {
    double first = 1e300, last = -1e300;
    for (const double t : job.image.where(kPixelTime))
        if (!std::isnan(t)) first = std::min(first, t), last = std::max(last, t);
    const double start = job.job.scenario.start.unix_s;
    return first <= last ? std::array{start + first, start + last} : std::array{job.unix_s(), job.unix_s()};
}

namespace {

/// Leap seconds from 1993-01-01 on: the days that follow them (IERS Bulletin C).
double tai93(double unix_s) {
    constexpr double k1993 = 725846400.0;
    constexpr std::array<double, 10> kLeap{741484800.0,  773020800.0,  820454400.0,  867715200.0,  915148800.0,
                                           1136073600.0, 1230768000.0, 1341100800.0, 1435708800.0, 1483228800.0};
    return unix_s - k1993 +
           static_cast<double>(std::count_if(kLeap.begin(), kLeap.end(), [&](double t) { return t <= unix_s; }));
}

std::string utc_text(double unix_s, const char* format) {
    const auto seconds = static_cast<std::time_t>(std::floor(unix_s));
    std::tm parts{};
    gmtime_r(&seconds, &parts);
    std::array<char, 64> text{};
    return {text.data(), std::strftime(text.data(), text.size(), format, &parts)};
}

}  // namespace

std::vector<double> scan_start_tai93(const NativeJob& job, const Swath& swath) {
    const auto time = job.image.where(kPixelTime);
    std::vector<double> start(static_cast<std::size_t>(swath.scans()), tai93(time_span_s(job)[0]));
    const auto per_scan = static_cast<std::size_t>(swath.lines_per_scan) * static_cast<std::size_t>(swath.samples);
    for (std::size_t scan = 0; scan < start.size(); ++scan) {
        double first = 1e300;
        for (std::size_t i = scan * per_scan; i < (scan + 1) * per_scan; ++i)
            if (swath.pixel[i] >= 0 && time[static_cast<std::size_t>(swath.pixel[i])] < first)
                first = time[static_cast<std::size_t>(swath.pixel[i])];
        if (first < 1e300) start[scan] = tai93(job.job.scenario.start.unix_s + first);
    }
    return start;
}

std::ptrdiff_t rendered_band(const NativeJob& job, const std::string& id) {
    for (std::size_t k = 0; k < job.job.bands.size(); ++k)
        if (job.band(k).id == id) return static_cast<std::ptrdiff_t>(k);
    return -1;
}

std::vector<double> radiance_of(const NativeJob& job, std::ptrdiff_t band) {
    const auto plane = job.image.radiance_plane(static_cast<std::size_t>(band));
    return {plane.begin(), plane.end()};
}

double radiance_step(const NativeJob& job, std::ptrdiff_t band, double steps) {
    double most = job.band(static_cast<std::size_t>(band)).saturation_radiance_W_m2_sr_um.value_or(0.0);
    for (const double L : radiance_of(job, band))
        if (L > most) most = L;
    return (most > 0.0 ? most : 1.0) / steps;
}

double reflectance_per_radiance(const NativeJob& job, const sensors::Band& band) {
    const auto& centre = job.job.inputs.centre;
    const double d = radiometry::sun_position(job.unix_s(), centre.lat_deg, centre.lon_deg).distance_AU;
    return kPi * d * d / imagery::solar_irradiance_W_m2_um(band.response);
}

std::string granule_time(double unix_s) { return utc_text(unix_s, "%Y%j.%H%M"); }
std::string granule_time_with_seconds(double unix_s) { return utc_text(unix_s, "%Y%j%H%M%S"); }

}  // namespace pyroscene::pipeline
