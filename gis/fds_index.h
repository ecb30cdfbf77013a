#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace pyroscene::gis {

/// What the index of an FDS run (.smv) says of its meshes and of a kind of output files.
struct FdsMesh {
    std::vector<double> x_m, y_m, z_m;  ///< of the nodes
};
struct FdsFile {
    enum class Kind { Slice, Boundary, Geometry } kind = Kind::Slice;
    std::size_t mesh = 0;
    bool cell_centred = false;
    std::filesystem::path file;
    std::filesystem::path geometry;  ///< Geometry: of its triangles
    std::string label, unit;
};
struct FdsIndex {
    std::vector<FdsMesh> meshes;
    std::vector<FdsFile> files;
};

/// Reads the entries GRID, PDIM, TRNX, TRNY, TRNZ, SLCF, SLCC, SLCT, BNDF, BNDC and BNDE. Throws an input error naming file and line for an entry
/// that ends early or names a mesh that there is not.
FdsIndex read_fds_index(const std::filesystem::path& smv);

}  // namespace pyroscene::gis
