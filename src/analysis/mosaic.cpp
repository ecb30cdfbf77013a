#include "analysis/mosaic.h"

#include <cmath>
#include <limits>

namespace pyroscene::analysis {

Mosaic empty_mosaic(const MapGrid& grid, std::size_t band_count) {
    constexpr float kNoData = std::numeric_limits<float>::quiet_NaN();
    const std::size_t n = grid.size();
    return {grid,
            band_count,
            std::vector<float>(band_count * n, kNoData),
            std::vector<float>(n, kNoData),
            std::vector<float>(n, kNoData),
            std::vector<float>(n, kNoData)};
}

void add_to_mosaic(Mosaic& mosaic, const MosaicMember& member, MosaicRule rule, int number) {
    const auto on_map = [&](std::span<const float> plane, bool nearest) {
        return ortho_resample(member.lookup, member.samples, member.lines, plane, nearest);
    };
    const std::size_t n = mosaic.grid.size();
    const std::size_t image = static_cast<std::size_t>(member.samples) * static_cast<std::size_t>(member.lines);
    const auto time_s = on_map(member.time_s, true), zenith_deg = on_map(member.view_zenith_deg, true);
    std::vector<bool> taken(n, false);
    for (std::size_t i = 0; i < n; ++i) {
        if (std::isnan(time_s[i]) || std::isnan(zenith_deg[i])) continue;
        const bool better = rule == MosaicRule::NearestNadir ? zenith_deg[i] < mosaic.view_zenith_deg[i]
                            : rule == MosaicRule::Latest     ? time_s[i] > mosaic.time_s[i]
                                                             : time_s[i] < mosaic.time_s[i];
        if (!better && !std::isnan(mosaic.member[i])) continue;
        taken[i] = true;
        mosaic.member[i] = static_cast<float>(number);
        mosaic.time_s[i] = time_s[i];
        mosaic.view_zenith_deg[i] = zenith_deg[i];
    }
    for (std::size_t b = 0; b < mosaic.band_count; ++b) {
        const auto plane = on_map(member.pixels.subspan(b * image, image), false);
        for (std::size_t i = 0; i < n; ++i)
            if (taken[i]) mosaic.pixels[b * n + i] = plane[i];
    }
}

}  // namespace pyroscene::analysis
