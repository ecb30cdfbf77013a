#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "base/constants.h"
#include "gis/geodesy.h"
#include "gis/raster_output.h"
#include "radiometry/sun.h"
#include "render/scene.h"
#include "sensors/image_chords.h"

namespace pyroscene::pipeline {

/// Sun angles over the scene: exact at the centre, linear in latitude and longitude around it (a few km: < 0.001 deg).
class LocalSun {
public:
    LocalSun(double unix_s, const gis::Geodetic& centre) : centre_(centre) {
        const auto at = [&](double dlat, double dlon) {
            return radiometry::sun_position(unix_s, centre.lat_deg + dlat, centre.lon_deg + dlon);
        };
        constexpr double kStep_deg = 0.05;
        here_ = at(0.0, 0.0);
        const auto north = at(kStep_deg, 0.0), east = at(0.0, kStep_deg);
        zenith_per_deg_ = {(north.zenith_rad - here_.zenith_rad) / kStep_deg,
                           (east.zenith_rad - here_.zenith_rad) / kStep_deg};
        azimuth_per_deg_ = {std::remainder(north.azimuth_rad - here_.azimuth_rad, 2.0 * kPi) / kStep_deg,
                            std::remainder(east.azimuth_rad - here_.azimuth_rad, 2.0 * kPi) / kStep_deg};
    }
    [[nodiscard]] const radiometry::SunPosition& centre() const { return here_; }
    [[nodiscard]] double zenith_rad(double lat_deg, double lon_deg) const {
        return here_.zenith_rad + zenith_per_deg_[0] * (lat_deg - centre_.lat_deg) +
               zenith_per_deg_[1] * (lon_deg - centre_.lon_deg);
    }
    [[nodiscard]] double azimuth_rad(double lat_deg, double lon_deg) const {
        return here_.azimuth_rad + azimuth_per_deg_[0] * (lat_deg - centre_.lat_deg) +
               azimuth_per_deg_[1] * (lon_deg - centre_.lon_deg);
    }

private:
    gis::Geodetic centre_;
    radiometry::SunPosition here_;
    std::array<double, 2> zenith_per_deg_{}, azimuth_per_deg_{};
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
    [[nodiscard]] const std::vector<double>& planes() const noexcept { return planes_; }  ///< [plane][line][sample]
    /// Pixels that tie the image to the ground, evenly over it or over the part that sees something.
    [[nodiscard]] std::vector<gis::GroundControlPoint> control_points() const;

private:
    void place_line(const render::RadianceImage& lines, int line);

    const sensors::ImageGeometry* geometry_;
    const sensors::ImageChords* chords_;
    const LocalSun* sun_;
    std::optional<double> surroundings_m_;
    std::size_t pixels_;
    std::vector<double> planes_;
};

}  // namespace pyroscene::pipeline
