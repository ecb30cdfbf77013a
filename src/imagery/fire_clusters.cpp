#include "imagery/fire_clusters.h"

#include <algorithm>
#include <cmath>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace pyroscene::imagery {
namespace {

/// Sums over a group while its pixels are visited.
struct Sums {
    double weight = 0.0;
    TwoBands::Radiances radiance;
    int with_background = 0;
};

void add_radiances(const ClusterInput& in, std::size_t i, Sums& sums) {
    const TwoBands::Radiances r{static_cast<double>(in.mir->values[i]), static_cast<double>(in.tir->values[i]),
                                static_cast<double>((*in.mir_background)[i]), static_cast<double>((*in.tir_background)[i])};
    if (!std::isfinite(r.mir + r.tir + r.mir_background + r.tir_background)) return;
    sums.radiance.mir += r.mir;
    sums.radiance.tir += r.tir;
    sums.radiance.mir_background += r.mir_background;
    sums.radiance.tir_background += r.tir_background;
    ++sums.with_background;
}

analysis::Bispectral solve_mean(const ClusterInput& in, const TwoBands& bands, const Sums& sums) {
    const double n = sums.with_background;
    if (n < 1.0) return {};
    const auto& r = sums.radiance;
    return bands.solve({r.mir / n, r.tir / n, r.mir_background / n, r.tir_background / n}, in.mir_noise / std::sqrt(n),
                       in.tir_noise / std::sqrt(n));
}

}  // namespace

analysis::Bispectral TwoBands::solve(const Radiances& r, double mir_noise, double tir_noise) const {
    if (!std::isfinite(r.mir_background) || !std::isfinite(r.tir_background)) return {};
    return analysis::bispectral(
        {r.mir, r.tir, r.mir_background, r.tir_background, thermometer_.temperature_K(r.tir_background), mir_noise,
         tir_noise},
        [&](double T_K) { return mir_.black_body(T_K); }, [&](double T_K) { return tir_.black_body(T_K); });
}

std::vector<FireCluster> fire_clusters(const ClusterInput& in) {
    const cv::Mat fire(in.where.lines, in.where.samples, CV_8UC1, const_cast<unsigned char*>(in.fire.data()));  // read only
    cv::Mat labels;
    const int count = cv::connectedComponents(fire, labels, 8, CV_32S);
    std::vector<FireCluster> fires(static_cast<std::size_t>(count - 1));
    std::vector<Sums> sums(fires.size());
    for (std::size_t i = 0; i < in.fire.size(); ++i) {
        if (in.fire[i] == 0) continue;
        const auto label = static_cast<std::size_t>(labels.at<int>(static_cast<int>(i)) - 1);
        FireCluster& of = fires[label];
        const double power = std::isfinite(in.frp_MW[i]) ? static_cast<double>(in.frp_MW[i]) : 0.0;
        const double weight = std::max(power, 1e-12);
        ++of.pixels;
        of.frp_MW += power;
        if (std::isfinite(in.where.area_m2[i])) of.area_ha += static_cast<double>(in.where.area_m2[i]) * 1e-4;
        of.lon_deg += weight * in.where.lon_deg[i];
        of.lat_deg += weight * in.where.lat_deg[i];
        sums[label].weight += weight;
        if (in.tir != nullptr) add_radiances(in, i, sums[label]);
    }
    std::optional<TwoBands> bands;
    if (in.tir != nullptr) bands.emplace(*in.mir, *in.tir);
    for (std::size_t f = 0; f < fires.size(); ++f) {
        fires[f].lon_deg /= sums[f].weight;
        fires[f].lat_deg /= sums[f].weight;
        if (bands) fires[f].mean = solve_mean(in, *bands, sums[f]);
    }
    std::stable_sort(fires.begin(), fires.end(),
                     [](const FireCluster& a, const FireCluster& b) { return a.frp_MW > b.frp_MW; });
    return fires;
}

}  // namespace pyroscene::imagery
