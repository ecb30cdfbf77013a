#pragma once

#include <array>
#include <vector>

#include "gis/fds_index.h"
#include "gis/fortran_records.h"

namespace pyroscene::gis {

/// Values over a rectangle of a mesh, its nodes i_first to i_last and j_first to j_last, x fastest: one per node, or, of files of
/// cells, one per cell and a row and a column that mean nothing.
struct FdsPatch {
    int i_first = 0, i_last = 0, j_first = 0, j_last = 0;
    std::vector<float> values;
};

/// A triangle of ground that is no box.
struct FdsFace {
    std::array<double, 3> x_m{}, y_m{};
    double seen_from_above = 0.0;  ///< its area on the map / its area
};

/// An output of FDS on the ground, moment by moment: slices of constant height or along the terrain, sums over the height of slices that
/// are volumes (x m), boundary files on surfaces that face up (.bf), boundary files on complex geometry (.be). Layout: DUMP_SLCF, DUMP_BNDF,
/// DUMP_SLICE_GEOM_DATA of FDS's Source/dump.f90. All throw an input error for files that end inside a record or are of another layout.
class FdsReader {
public:
    /// \param volume  of slices: take those that are volumes, and sum them
    FdsReader(const FdsFile& file, const FdsMesh& mesh, bool volume);

    /// Whether the file has anything to say of the ground.
    [[nodiscard]] bool on_ground() const noexcept;
    /// Goes to the next moment; false at the end.
    bool next();
    [[nodiscard]] double time_s() const noexcept { return time_s_; }
    [[nodiscard]] const std::vector<FdsPatch>& patches() const noexcept { return patches_; }
    [[nodiscard]] const std::vector<FdsFace>& faces() const noexcept { return faces_; }
    [[nodiscard]] const std::vector<float>& face_values() const noexcept { return face_values_; }

private:
    struct Block {
        std::array<int, 6> box{};  ///< first and last node along x, y, z
        bool wanted = false;
    };
    void read_faces(const FdsFile& file);
    [[nodiscard]] FdsPatch patch_of(const Block& block, std::vector<float> values) const;

    const FdsMesh& mesh_;
    FortranRecords records_;
    bool geometry_ = false, cell_centred_ = false;
    std::vector<Block> blocks_;
    double time_s_ = 0.0;
    std::vector<FdsPatch> patches_;
    std::vector<FdsFace> faces_;
    std::vector<float> face_values_;
};

}  // namespace pyroscene::gis
