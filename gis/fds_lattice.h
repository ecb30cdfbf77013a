#pragma once

#include <string>
#include <vector>

#include "gis/fds_reader.h"

namespace pyroscene::gis {

/// One even grid over all meshes of an FDS run: the smallest spacing of any mesh, with its nodes (or cells) on those of that mesh. Meshes
/// of that spacing give it their values as they are; of coarser and stretched meshes nodes are interpolated and cells repeated.
class FdsLattice {
public:
    /// \param cells  the values are those of cells, not of nodes
    FdsLattice(const std::vector<FdsMesh>& meshes, bool cells, const std::string& subject);

    [[nodiscard]] int cols() const noexcept { return cols_; }
    [[nodiscard]] int rows() const noexcept { return rows_; }
    [[nodiscard]] double dx_m() const noexcept { return dx_m_; }
    [[nodiscard]] double dy_m() const noexcept { return dy_m_; }
    /// Outer corner of its pixels, whose centres the nodes are.
    [[nodiscard]] double west_m() const noexcept { return west_m_ - (cells_ ? 0.0 : 0.5 * dx_m_); }
    [[nodiscard]] double north_m() const noexcept { return south_m_ + (rows_ - (cells_ ? 0.0 : 0.5)) * dy_m_; }
    [[nodiscard]] std::size_t size() const noexcept {
        return static_cast<std::size_t>(cols_) * static_cast<std::size_t>(rows_);
    }

    /// A moment in the making: NaN where nothing has been laid, row 0 in the north.
    struct Moment {
        std::vector<float> values;
        std::vector<float> cell_m2;  ///< of the mesh that gave the value
    };
    [[nodiscard]] Moment moment() const;

    enum class Rule { Smallest, Largest };
    /// Lays what a reader has; where values meet that of the finer mesh counts, of equal ones by the rule. Values above `most` are none.
    /// Largest: values per area of ground that slopes become per area of the map.
    void lay(const FdsReader& reader, const FdsFile& file, const FdsMesh& mesh, Rule rule, float most, Moment& into) const;

private:
    /// Where a column or row of the lattice lies among the nodes of a mesh: between a node and the next, at a share of the way.
    struct Spot {
        int node = -1;  ///< -1 = not there
        double share = 0.0;
    };
    [[nodiscard]] std::vector<Spot> spots(const std::vector<double>& nodes_m, int first, int last, double start_m,
                                          double step_m, int count) const;
    void lay_patch(const FdsPatch& patch, const FdsFile& file, const FdsMesh& mesh, Rule rule, float most,
                   Moment& into) const;
    void lay_faces(const FdsReader& reader, const FdsMesh& mesh, Rule rule, float most, Moment& into) const;
    void put(float value, double cell_m2, std::size_t pixel, Rule rule, Moment& into) const;

    bool cells_;
    int cols_ = 0, rows_ = 0;
    double west_m_ = 0.0, south_m_ = 0.0, dx_m_ = 0.0, dy_m_ = 0.0;  ///< of the first node or cell
};

}  // namespace pyroscene::gis
