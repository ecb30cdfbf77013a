#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <vector>

#include "render/scene.h"

namespace pyroscene::render {

/// A box of the scene frame [m].
struct GroundBox {
    double west = 0.0, south = 0.0, east = 0.0, north = 0.0;
};

/// Where the fire is on the map, for cameras whose pixels are wider than what burns in them: fine cells in which something
/// flames, and map cells that are hot from burning or brightly lit by flames. A pyramid over the map answers for boxes of any
/// size.
class FireDetail {
public:
    FireDetail(const RenderScene& scene, const GroundIrradiance* light);

    /// Widest spacing of rays that will do for a pixel, where something flames and where ground is hot [m].
    struct Spacing {
        double flaming_m = 0.0, hot_m = 0.0;
    };
    /// So dense that random points in squares of this spacing hold the area of `n` single cells with the standard error that
    /// docs/physics-render.md states, n being the cells of each kind in the box.
    /// \param area_m2  of the pixel on the ground
    [[nodiscard]] Spacing spacing(const GroundBox& pixel, double area_m2) const noexcept;
    /// The smallest that can be asked for by a pixel of this size; infinite without fire.
    [[nodiscard]] double finest_spacing_m(double area_m2) const noexcept;
    /// What holds in a part of a pixel; infinity where there is no fire.
    [[nodiscard]] double spacing_within_m(const GroundBox& part, const Spacing& pixel) const noexcept;
    /// Height of the highest flame above the ground below it [m]: a ray may meet flame this far above its ground point.
    [[nodiscard]] double flame_height_m() const noexcept { return flame_height_m_; }

private:
    static constexpr int kMostFine = 16;
    using FineCells = std::bitset<kMostFine * kMostFine>;
    struct Level {
        int cols = 0, rows = 0;
        std::vector<std::uint32_t> flaming, hot;  ///< fine cells, map cells
    };
    struct Window {
        int first_row, last_row, first_col, last_col;
    };

    void mark_ground(const RenderScene& scene);
    void mark_lit_ground(const GroundIrradiance& light);
    void mark_flames(const RenderScene& scene);
    void mark_flaming(int fine_row, int fine_col);
    void build_pyramid();
    [[nodiscard]] Window window(const GroundBox& box, std::size_t level) const noexcept;
    [[nodiscard]] bool misses(const GroundBox& box) const noexcept;
    [[nodiscard]] std::size_t level_of(const GroundBox& box, double cells) const noexcept;
    [[nodiscard]] bool flames_within(const GroundBox& box) const noexcept;
    [[nodiscard]] bool hot_within(const GroundBox& box) const noexcept;

    MapGrid map_;
    Vec3 origin_m_;
    int fine_ = 1;                          ///< fine cells per map cell and axis
    std::vector<std::uint8_t> hot_;         ///< [map cell]
    std::vector<std::int32_t> fine_block_;  ///< [map cell] into fine_cells_, -1 = nothing flames
    std::vector<FineCells> fine_cells_;
    std::vector<Level> levels_;  ///< [0] cells twice as wide as the map's, ... one cell
    bool any_hot_ = false;
    double flame_height_m_ = 0.0;
};

}  // namespace pyroscene::render
