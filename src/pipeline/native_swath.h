#pragma once

#include "gis/array_file.h"
#include "pipeline/native.h"

namespace pyroscene::pipeline {

/// The image laid into whole scans and whole lines of the instrument, as level 1B files have them. What was not rendered is
/// fill.
struct Swath {
    int samples = 0, lines = 0, lines_per_scan = 1;
    std::vector<std::ptrdiff_t> pixel;  ///< [line][sample] of the image, -1 = not rendered

    [[nodiscard]] std::size_t size() const { return pixel.size(); }
    [[nodiscard]] int scans() const { return lines / lines_per_scan; }
};
Swath whole_swath(const NativeJob& job);

/// Values as they are stored: offset + value / scale, rounded unless `scale` is 0 (stored as they are).
struct Packing {
    double scale = 0.0, offset = 0.0, fill = 0.0, most = 0.0;
};
std::vector<double> pack(const Swath& swath, std::span<const double> plane, const Packing& packing);

/// First and last moment of the image, Unix seconds.
std::array<double, 2> time_span_s(const NativeJob& job);
/// First moment of each scan [s since 1993-01-01, TAI], as EOS counts it.
std::vector<double> scan_start_tai93(const NativeJob& job, const Swath& swath);

/// Position of a band among the rendered ones, or -1.
std::ptrdiff_t rendered_band(const NativeJob& job, const std::string& id);
std::vector<double> radiance_of(const NativeJob& job, std::ptrdiff_t band);

/// Radiance of one stored step, such that the saturation of the band, or the brightest pixel, is `steps` of them.
double radiance_step(const NativeJob& job, std::ptrdiff_t band, double steps);
/// Reflectance (pi L d^2 / E0, not divided by the cosine of the sun's zenith angle) per radiance.
double reflectance_per_radiance(const NativeJob& job, const sensors::Band& band);

/// "2017196.2300" of a moment, and the same with seconds and without a dot.
std::string granule_time(double unix_s);
std::string granule_time_with_seconds(double unix_s);

}  // namespace pyroscene::pipeline
