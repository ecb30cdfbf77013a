#include "imagery/sun_of_image.h"

#include <tbb/parallel_for.h>

#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "base/time.h"
#include "imagery/image_channels.h"
#include "radiometry/sun.h"

namespace pyroscene::imagery {

SunOfImage sun_of_image(const std::filesystem::path& path, const gis::ImageInfo& info, const gis::PixelPositions& where,
                        const std::optional<double>& zenith_deg) {
    const std::size_t n = where.lon_deg.size();
    const auto time = parse_utc(metadata_item(info, "ACQUISITION_DATE"));
    SunOfImage sun{std::vector<float>(n, std::nanf("")), std::vector<float>(n, std::nanf("")), 1.0};
    if (time) sun.distance_AU = radiometry::sun_position(time->unix_s, 0.0, 0.0).distance_AU;
    if (zenith_deg) {
        sun.zenith_deg.assign(n, static_cast<float>(*zenith_deg));
        return sun;
    }
    if (!time)
        throw input_error(path.string(),
                          "no metadata item ACQUISITION_DATE (2017-07-15T22:00:00Z); give --sun-zenith instead");
    tbb::parallel_for(std::size_t{0}, n, [&](std::size_t i) {
        if (!std::isfinite(where.lon_deg[i]) || !std::isfinite(where.lat_deg[i])) return;
        const auto position = radiometry::sun_position(time->unix_s, where.lat_deg[i], where.lon_deg[i]);
        sun.zenith_deg[i] = static_cast<float>(position.zenith_rad / kDegree_rad);
        sun.azimuth_deg[i] = static_cast<float>(position.azimuth_rad / kDegree_rad);
    });
    return sun;
}

}  // namespace pyroscene::imagery
