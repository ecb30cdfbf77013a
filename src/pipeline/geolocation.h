#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "base/buffer.h"
#include "gis/geodesy.h"
#include "gis/raster_output.h"
#include "radiometry/sun.h"
#include "render/scene.h"
#include "sensors/image_chords.h"

namespace pyroscene::pipeline {

/// The sun over an image at one moment: linear within 0.1 degrees of latitude and longitude of the centre, where that is right to 0.003
/// degrees, exact beyond, and where the sun stands within 20 degrees of the zenith, as its azimuth turns fast there.
class LocalSun {
public:
    LocalSun(double unix_s, const gis::Geodetic& centre);
    [[nodiscard]] const radiometry::SunPosition& centre() const noexcept { return here_; }
    [[nodiscard]] radiometry::SunPosition at(double lat_deg, double lon_deg) const;

private:
    double unix_s_;
    gis::Geodetic centre_;
    radiometry::SunPosition here_;
    std::array<double, 2> zenith_per_deg_{}, azimuth_per_deg_{};  ///< north, east
};

/// The planes of geolocation.tif in its order: name and unit.
inline constexpr std::array<std::array<const char*, 2>, 9> kGeolocationBands{{{"longitude", "degree"},
                                                                              {"latitude", "degree"},
                                                                              {"height", "m"},
                                                                              {"view_zenith", "degree"},
                                                                              {"view_azimuth", "degree"},
                                                                              {"sun_zenith", "degree"},
                                                                              {"sun_azimuth", "degree"},
                                                                              {"range", "m"},
                                                                              {"time", "s"}}};

/// Where and when each pixel of an image looks, a few lines after another.
class Geolocation {
public:
    /// \param surroundings_m  height of the ground beyond the map, which pixels past it show; nothing: such pixels have no place
    Geolocation(const sensors::ImageGeometry& geometry, const sensors::ImageChords& chords, const LocalSun& sun,
                std::optional<double> surroundings_m);
    void add(const render::RadianceImage& lines);
    [[nodiscard]] std::span<const double> planes() const noexcept { return planes_; }  ///< [plane][line][sample]
    /// Pixels that tie the image to the ground, evenly over it or over the part that sees something.
    [[nodiscard]] std::vector<gis::GroundControlPoint> control_points() const;

private:
    void place_line(const render::RadianceImage& lines, int line);

    const sensors::ImageGeometry* geometry_;
    const sensors::ImageChords* chords_;
    const LocalSun* sun_;
    std::optional<double> surroundings_m_;
    std::size_t pixels_;
    Buffer<double> planes_;
};

}  // namespace pyroscene::pipeline
