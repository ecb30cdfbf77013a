#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace pyroscene::gis {

/// What the index of an FDS run (.smv) says of its meshes and of a kind of output files.
struct FdsMesh {
    std::vector<double> x_m, y_m;  ///< of the nodes
};
struct FdsFile {
    enum class Kind { Slice, Boundary } kind = Kind::Slice;
    std::size_t mesh = 0;
    bool cell_centred = false;
    std::filesystem::path file;
    std::string label, unit;
};
struct FdsIndex {
    std::vector<FdsMesh> meshes;
    std::vector<FdsFile> files;
};

/// Reads the entries GRID, PDIM, TRNX, TRNY, SLCF, SLCC, SLCT, BNDF and BNDC. Throws an input error naming file and line for an entry
/// that ends early or names a mesh that there is not.
FdsIndex read_fds_index(const std::filesystem::path& smv);

/// Values on a rectangle of nodes (or cells) of a mesh at the last moment of a file, first index fastest.
struct FdsPatch {
    int i_first = 0, i_last = 0, j_first = 0, j_last = 0;
    std::vector<float> values;
};
/// Horizontal patches of a slice or boundary file: of constant height or along the terrain; of surfaces that face up.
std::vector<FdsPatch> read_fds_patches(const FdsFile& file);

}  // namespace pyroscene::gis
