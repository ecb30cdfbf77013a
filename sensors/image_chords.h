#pragma once

#include <array>
#include <vector>

#include "sensors/image_geometry.h"

namespace pyroscene::sensors {

/// A pixel's line of sight cut by the scene's upper and lower height, in the scene frame, with the view at both ends. Where the
/// lines of sight are open (ImageChords::open) it runs from the sensor to a fixed distance instead.
struct Chord {
    Vec3 top_m, bottom_m;  ///< scene frame (map minus origin)
    double top_lon_deg = 0.0, top_lat_deg = 0.0, bottom_lon_deg = 0.0, bottom_lat_deg = 0.0;
    Vec3 view_enu;  ///< unit vector ground -> sensor at the bottom end, east/north/up of the ellipsoid
    double top_range_m = 0.0, bottom_range_m = 0.0;
};

/// The numbers of a chord, ends first, padded to whole vector registers.
using ChordNode = std::array<double, 16>;

/// Lattice of positions inside a scan.
struct ChordLattice {
    int cols = 0, rows = 0;
    double first_u = 0.0, first_v = 0.0, step_u = 0.0, step_v = 0.0;
};

/// Chords of one scan, by position in it.
class ScanChords {
public:
    /// \param nodes  [row][col] of the lattice, must outlive this; null = `own` holds them
    ScanChords(const ChordLattice& lattice, const ChordNode* nodes, std::vector<ChordNode> own = {})
        : lattice_(lattice), nodes_(nodes), own_(std::move(own)) {}

    [[nodiscard]] Chord at(double u, double v) const noexcept;
    /// Only the ends, at half the cost: all that a ray tracer needs of a sub-ray.
    struct Ends {
        Vec3 top_m, bottom_m;
    };
    [[nodiscard]] Ends ends(double u, double v) const noexcept;

private:
    ChordLattice lattice_;
    const ChordNode* nodes_;
    std::vector<ChordNode> own_;
};

/// All lines of sight of one image. Exact chords are computed on a lattice of positions and scans and interpolated by cubics
/// (error on the ground < 1 mm or 1e-5 of a pixel, tested), so no projection call is left in the per-ray loop. Measured poses
/// are not interpolated from scan to scan. Thread-safe after construction.
class ImageChords {
public:
    /// \param scene_origin_m map coordinates of the scene frame's origin  \param bottom_m, top_m ellipsoidal heights of the
    /// two shells; a platform below the upper shell starts the chord itself.
    /// \param reach_m  farther from a camera that stands near the ground nothing of the scene is looked for (0 = never): when not
    /// all of its lines of sight come down within it they are open
    /// Throws an input error when any other instrument does not look at the ground.
    ImageChords(const ImageGeometry& image, const gis::MapProjection& map, Vec3 scene_origin_m, double bottom_m,
                double top_m, double reach_m = 0.0);

    /// Lines of sight do not end below the ground but `reach_m` away, wherever that is: they may look into the sky.
    [[nodiscard]] bool open() const noexcept { return open_; }

    /// Chords of a scan. Positions may be a little (4 pixels) outside it. Cheap, but make it once per run of pixels.
    [[nodiscard]] ScanChords scan(int number) const;

private:
    ChordLattice lattice_;
    bool open_ = false;
    int first_scan_ = 0, stride_ = 1, scan_nodes_ = 1;  ///< lattice nodes along the scans
    std::vector<ChordNode> nodes_;                      ///< [scan node][row][col]
};

}  // namespace pyroscene::sensors
