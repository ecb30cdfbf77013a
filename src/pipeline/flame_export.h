#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "base/raster.h"
#include "base/report.h"
#include "fire/flame_field.h"
#include "scenario/scenario.h"

namespace pyroscene::pipeline {

/// The flames of one moment for other programs.
struct FlameExport {
    std::string scenario, crs_wkt;
    double time_s = 0.0;
    bool above_ground = false;  ///< heights count from the ground below each flame: a flat scene
    fire::FlameField field;
    Raster<float> heat_flux_W_m2;  ///< of the frame
    Vec3 origin_m;                 ///< map coordinates of the scene frame's origin; z = 0
    /// Lattice that covers the map with one voxel to spare on each side, and the flames: voxels of `field` shifted by these.
    std::array<int, 3> size{}, shift{};
    [[nodiscard]] Vec3 corner_m() const noexcept;  ///< of the lattice: south-west-bottom, map coordinates
};

/// What to take out of a scenario.
struct FlameExportRequest {
    std::string acquisition;                       ///< id; empty = time_s
    std::optional<double> time_s;                  ///< since ignition
    std::optional<std::array<double, 3>> voxel_m;  ///< default: the scenario's
    std::optional<int> layers;                     ///< height of the lattice in voxels; default: as high as the flames
    bool crop = false;                             ///< flames above the layers are left out instead of refused
    bool above_ground = false;
    Monitor monitor;
};

/// Goes through the frames up to the moment, keeping nothing on disk, and cuts its flames into voxels. Throws an input error:
/// no such acquisition, a time before the first frame, flames higher than the layers asked for.
FlameExport export_flame(const scenario::Scenario& scenario, const FlameExportRequest& request);

/// A voxel with flame in it, by its indices in the lattice of the export.
struct ExportVoxel {
    int i = 0, j = 0, k = 0;
    float fill = 0.0F, temperature_K = 0.0F;
};
/// All of them, ordered by k, then j, then i.
void for_each_voxel(const FlameExport& flame, const std::function<void(const ExportVoxel&)>& visit);

/// The regular grid of DIRSIG (thesis appendix C.3): nx ny nz, then i j k material temperature_K concentration_ppm for each
/// voxel with flame; i to the east, j to the north, k up, from 0.
/// \param concentration_ppm of a voxel filled with flame; others have it times their fill
std::string dirsig_grid(const FlameExport& flame, int material, double concentration_ppm);
/// The object that places such a grid in a DIRSIG scene (thesis appendix C.2), in map metres.
std::string dirsig_object(const FlameExport& flame, const std::string& grid_file);

/// Table with the centre of each voxel with flame in map coordinates: x_m,y_m,z_m,fill,temperature_K,volume_m3.
std::string flame_csv(const FlameExport& flame);

/// OpenVDB file with the float grids `density` (fill) and `temperature` (K), a fog volume each. World space is metres from the
/// map's centre (east, north, up); its map coordinates are in the metadata. Throws a runtime error when the program was built
/// without OpenVDB.
void write_flame_vdb(const std::filesystem::path& path, const FlameExport& flame);
bool has_openvdb() noexcept;

/// Part of the map, metres from its centre.
struct MapWindow {
    double west_m = 0.0, east_m = 0.0, south_m = 0.0, north_m = 0.0;
};

/// PNG: the flames in a window (nullopt = the whole lattice) seen from the south, as metres of flame along the line of sight (fill
/// x voxel edge, summed), over the height of the lattice; heights are drawn larger than widths, the title says by how much.
/// Throws an input error for a window without extent or beside the lattice.
void write_side_view(const std::filesystem::path& path, const FlameExport& flame, const std::optional<MapWindow>& window);

/// PNG: the heat flux of the frame on the map, logarithmic over three decades.
void write_top_view(const std::filesystem::path& path, const FlameExport& flame);

}  // namespace pyroscene::pipeline
