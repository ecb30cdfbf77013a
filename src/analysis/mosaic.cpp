#include "analysis/mosaic.h"

#include <cmath>
#include <limits>

namespace pyroscene::analysis {

Mosaic empty_mosaic(const MapGrid& grid) {
    const std::vector<float> nothing(grid.size(), std::numeric_limits<float>::quiet_NaN());
    return {grid, nothing, nothing, nothing};
}

void add_to_mosaic(Mosaic& mosaic, const MosaicMember& member, MosaicRule rule, int number) {
    const auto on_map = [&](std::span<const float> plane) {
        return ortho_resample(member.lookup, member.samples, member.lines, plane, true);
    };
    const auto time_s = on_map(member.time_s), zenith_deg = on_map(member.view_zenith_deg);
    for (std::size_t i = 0; i < time_s.size(); ++i) {
        if (std::isnan(time_s[i]) || std::isnan(zenith_deg[i])) continue;
        const bool better = rule == MosaicRule::NearestNadir ? zenith_deg[i] < mosaic.view_zenith_deg[i]
                            : rule == MosaicRule::Latest     ? time_s[i] > mosaic.time_s[i]
                                                             : time_s[i] < mosaic.time_s[i];
        if (!better && !std::isnan(mosaic.member[i])) continue;
        mosaic.member[i] = static_cast<float>(number);
        mosaic.time_s[i] = time_s[i];
        mosaic.view_zenith_deg[i] = zenith_deg[i];
    }
}

void fill_from_member(const Mosaic& mosaic, const MosaicMember& member, int number, std::span<const float> plane,
                      std::span<float> band) {
    const auto on_map = ortho_resample(member.lookup, member.samples, member.lines, plane, false);
    for (std::size_t i = 0; i < on_map.size(); ++i)
        if (mosaic.member[i] == static_cast<float>(number)) band[i] = on_map[i];
}

}  // namespace pyroscene::analysis
