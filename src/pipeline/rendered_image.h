#pragma once

#include <optional>
#include <span>
#include <vector>

#include "analysis/ortho.h"
#include "gis/raster_output.h"
#include "pipeline/products_phase.h"

namespace pyroscene::pipeline {

/// Positions of the planes in geolocation.tif.
enum GeolocationPlane {
    kLongitude,
    kLatitude,
    kHeight,
    kViewZenith,
    kViewAzimuth,
    kSunZenith,
    kSunAzimuth,
    kRange,
    kPixelTime
};
/// Positions of the planes in truth.tif that products use.
enum TruthPlane { kFlame, kFront, kScar, kBackground, kSmoke, kGroundTemperature, kFlameTemperature, kExitance };

/// One rendered group read back, with its pixels on the map.
struct RenderedImage {
    int samples = 0, lines = 0;
    std::size_t n = 0;
    gis::ImageFile radiance, geolocation;
    std::optional<gis::ImageFile> truth;
    std::vector<double> x_m, y_m;  ///< on the map of the scene, NaN = none
    double gsd_m = 0.0;            ///< median
    std::vector<float> pixel_area_m2;
    analysis::ScanLines scans;

    [[nodiscard]] std::span<const double> where(GeolocationPlane p) const {
        return std::span(geolocation.pixels).subspan(p * n, n);
    }
    [[nodiscard]] std::vector<float> truth_plane(std::size_t p) const {
        return {truth->pixels.begin() + static_cast<std::ptrdiff_t>(p * n),
                truth->pixels.begin() + static_cast<std::ptrdiff_t>((p + 1) * n)};
    }
    [[nodiscard]] std::vector<float> radiance_plane(std::size_t band) const {
        return {radiance.pixels.begin() + static_cast<std::ptrdiff_t>(band * n),
                radiance.pixels.begin() + static_cast<std::ptrdiff_t>((band + 1) * n)};
    }
};

/// Reads radiance, geolocation and, where the scenario has it, truth of a job. Throws an input error naming a missing file.
RenderedImage read_rendered(const ProductJob& job);

/// The same without radiance and truth, and these two for an image that has only its ground.
RenderedImage read_ground(const ProductJob& job);
void read_pixels(const ProductJob& job, RenderedImage& r);

/// A round ortho cell near the pixel size: two significant digits.
double ortho_cell_m(double gsd_m);

/// Where each map cell appears in the image; cells that terrain hides from the camera appear nowhere and are counted.
analysis::OrthoLookup visible_ground(const ProductJob& job, const RenderedImage& r, const MapGrid& grid, RunReport& report);

}  // namespace pyroscene::pipeline
