#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "analysis/ortho.h"
#include "gis/image_stream.h"
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
    kPixelTime,
    kGeolocationPlanes
};
/// Positions of the planes in truth.tif that products use.
enum TruthPlane { kFlame, kFront, kScar, kBackground, kSmoke, kGroundTemperature, kFlameTemperature, kExitance };

/// The planes of geolocation.tif, each read when it is first asked for. Not for several threads at once.
class GeolocationFile {
public:
    GeolocationFile() = default;
    explicit GeolocationFile(std::filesystem::path path) : path_(std::move(path)) {}

    /// Reads planes ahead, at the same time.
    void read(std::initializer_list<GeolocationPlane> wanted) const;
    /// [line][sample], NaN = none
    [[nodiscard]] std::span<const double> plane(GeolocationPlane p) const;
    [[nodiscard]] double at(GeolocationPlane p, int sample, int line) const;

private:
    std::filesystem::path path_;
    mutable std::array<std::vector<double>, kGeolocationPlanes> planes_;
};

/// One rendered group read back, with its pixels on the map. Everything else stays in its files and is read a plane at a time.
struct RenderedImage {
    int samples = 0, lines = 0;
    std::size_t n = 0;
    GeolocationFile geolocation;
    std::unique_ptr<gis::ImageStream> radiance, truth;  ///< null when not read, truth also when the scenario has none
    std::vector<double> x_m, y_m;                       ///< on the map of the scene, NaN = none
    double gsd_m = 0.0;                                 ///< median
    std::vector<float> pixel_area_m2;
    analysis::ScanLines scans;

    [[nodiscard]] std::span<const double> where(GeolocationPlane p) const { return geolocation.plane(p); }
    [[nodiscard]] std::vector<float> truth_plane(std::size_t p) const { return truth->read_band(static_cast<int>(p) + 1); }
    [[nodiscard]] std::vector<float> radiance_plane(std::size_t band) const {
        return radiance->read_band(static_cast<int>(band) + 1);
    }
};

/// Opens radiance, geolocation and, where the scenario has it, truth of a job. Throws an input error naming a missing file.
RenderedImage read_rendered(const ProductJob& job);

/// The same without radiance and truth.
RenderedImage read_ground(const ProductJob& job);

/// A round ortho cell near the pixel size: two significant digits.
double ortho_cell_m(double gsd_m);

/// Where each map cell appears in the image; cells that terrain hides from the camera appear nowhere and are counted.
analysis::OrthoLookup visible_ground(const ProductJob& job, const RenderedImage& r, const MapGrid& grid, RunReport& report);

}  // namespace pyroscene::pipeline
