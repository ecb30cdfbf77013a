#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "gis/image_stream.h"
#include "gis/vector_output.h"

namespace pyroscene::imagery {

/// A fire pixel. NaN = not known: its field stays empty.
struct Hotspot {
    double latitude_deg = 0.0, longitude_deg = 0.0;
    double mir_K = std::numeric_limits<double>::quiet_NaN(), tir_K = std::numeric_limits<double>::quiet_NaN();
    double scan_km = 0.0, track_km = 0.0;  ///< pixel size across and along
    double frp_MW = std::numeric_limits<double>::quiet_NaN();
    std::string confidence{};  ///< percent, or l, n, h
    char day_or_night = ' ';
};

/// The hot spots of one image, in the columns of NASA FIRMS.
struct HotspotTable {
    std::string date, clock;  ///< "2017-07-15", "2305", UTC
    std::string satellite, instrument, version;
    bool viirs_names = false;  ///< bright_ti4 and bright_ti5 instead of brightness and bright_t31
    bool synthetic = false;
    std::vector<Hotspot> rows;
};

/// Without rows: date, clock, instrument and origin as the image says them.
HotspotTable hotspots_of(const gis::ImageInfo& info);

/// Columns latitude, longitude, brightness, scan, track, acq_date, acq_time, satellite, instrument, confidence, version, bright_t31,
/// frp, daynight.
void write_hotspots_csv(const std::filesystem::path& path, const HotspotTable& table);

/// The same as points, with one more field: synthetic (1 or 0).
gis::VectorLayer hotspot_layer(const HotspotTable& table);

}  // namespace pyroscene::imagery
