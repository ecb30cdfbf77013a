#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "render/terrain_heights.h"

namespace pyroscene::render {

/// Share of its cosine-weighted hemisphere in which a map cell sees the sky, 0 to 1, in steps of 2^-16; exact in elevation for
/// the skylines found. Cells are looked at when one near them is first asked for, a run of cells along a row at a time, because
/// many images see few cells of a large map. For several threads at once.
class SkyView {
public:
    /// The mesh of the heights must outlive this.
    explicit SkyView(const TerrainHeights& heights);
    ~SkyView();
    SkyView(const SkyView&) = delete;
    SkyView& operator=(const SkyView&) = delete;
    [[nodiscard]] double at(std::size_t cell) const;

private:
    static constexpr int kRun = 32;
    using Run = std::array<std::uint16_t, kRun>;

    /// One look from the middle of any cell along a skyline: how far, and where it meets the heights between cell centres.
    struct Look {
        double distance_m;
        int row, col;  ///< of the upper left of four cells, from the own one
        std::array<float, 4> weight;
    };
    struct Skyline {
        double dx, dy;
        std::vector<Look> looks;
    };
    using Slopes = std::array<float, kRun>;

    [[nodiscard]] Run* look_from(int row, int first_col) const;
    void climb(const Skyline& skyline, int row, int first_col, int count, Slopes& slope) const noexcept;
    void climb_on(const Skyline& skyline, std::size_t look, int row, int col, float& slope) const noexcept;

    TerrainHeights heights_;
    std::vector<Skyline> skylines_;
    std::size_t runs_per_row_;
    mutable std::vector<std::atomic<Run*>> runs_;
};

}  // namespace pyroscene::render
