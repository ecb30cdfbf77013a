#include "render/smoke_nodes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/constants.h"
#include "render/scene_tables.h"
#include "render/smoke_light.h"

namespace pyroscene::render {
namespace {

constexpr std::size_t kNodes = 4;

double ratio(double value, double reference) { return reference > 0.0 ? value / reference : 0.0; }
double log_of(double value) { return std::log(std::max(value, 1e-12)); }

double henyey_greenstein(double g, double cosine) { return (1.0 - g * g) / std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5); }

/// Lagrange's weights of the nodes at one place.
std::array<double, kNodes> lagrange(std::span<const double> nodes, double at) {
    std::array<double, kNodes> weight{};
    for (std::size_t j = 0; j < nodes.size(); ++j) {
        weight[j] = 1.0;
        for (std::size_t other = 0; other < nodes.size(); ++other)
            if (other != j) weight[j] *= (at - nodes[other]) / (nodes[j] - nodes[other]);
    }
    return weight;
}

/// Places of `count` nodes in an interval: those of Chebyshev's polynomial, as near as there are wavelengths.
std::vector<std::size_t> pick(std::span<const double> way, std::size_t count) {
    const double length = way.back() - way.front(), least = 1e-4 * length / static_cast<double>(kNodes);
    std::vector<std::size_t> picked;
    for (std::size_t j = 0; j < count; ++j) {
        const double angle = kPi * (static_cast<double>(j) + 0.5) / static_cast<double>(count);
        const double wanted = way.front() + length * 0.5 * (1.0 - std::cos(angle));
        auto i = static_cast<std::size_t>(std::lower_bound(way.begin(), way.end(), wanted) - way.begin());
        if (i > 0 && (i == way.size() || wanted - way[i - 1] < way[i] - wanted)) --i;
        if (picked.empty() || way[i] > way[picked.back()] + least) picked.push_back(i);
    }
    return picked;
}

/// Where to cut an interval: in its largest gap if that is wide (between bands), else in the middle.
std::size_t place_to_cut(std::span<const double> way) {
    constexpr double kWide = 0.2;
    std::size_t widest = 1;
    for (std::size_t i = 2; i < way.size(); ++i)
        if (way[i] - way[i - 1] > way[widest] - way[widest - 1]) widest = i;
    if (way[widest] - way[widest - 1] > kWide * (way.back() - way.front())) return widest;
    const double middle = 0.5 * (way.front() + way.back());
    const auto half = static_cast<std::size_t>(std::lower_bound(way.begin(), way.end(), middle) - way.begin());
    return std::clamp<std::size_t>(half, 1, way.size() - 1);
}

/// Functions of the optics that must come out right between nodes, all of the order of 1; the first ones are transmittances.
constexpr std::size_t kTransmittances = 8, kTrials = 16;

template <class Optics>
std::array<double, kTrials> trials(const Optics& o, const Optics& reference) {
    std::array<double, kTrials> t{};
    std::size_t n = 0;
    for (const double depth : {0.1, 0.7, 3.0, 8.0}) t[n++] = std::exp(-depth * ratio(o.extinction, reference.extinction));
    for (const double depth : {0.3, 3.0}) t[n++] = std::exp(-depth * ratio(o.absorption, reference.absorption));
    t[n++] = std::exp(-2.0 * ratio(o.beam, reference.beam));
    t[n++] = std::exp(-2.0 * ratio(o.flame_k, reference.flame_k));
    for (const double cosine : {-1.0, 0.3, 1.0}) t[n++] = henyey_greenstein(o.asymmetry, cosine);
    t[n++] = ratio(o.flame_spread, reference.flame_spread);
    t[n++] = ratio(o.flame_share_m2, reference.flame_share_m2);
    for (const double fall : {1.0, 3.0, 8.0}) {  // what the diffusion's nodes may say
        double sum = 0.0;
        for (std::size_t d = 0; d < o.diffusion.size(); ++d)
            sum += o.diffusion[d] * std::exp(-fall * static_cast<double>(d) / static_cast<double>(o.diffusion.size() - 1));
        t[n++] = sum;
    }
    return t;
}

template <class Trials>
bool agree(const Trials& found, const Trials& expected) {
    for (std::size_t i = 0; i < found.size(); ++i) {
        const double error = std::abs(found[i] - expected[i]), value = std::abs(expected[i]);
        const double allowed =
            i < kTransmittances ? std::min(2e-4, 2e-2 * std::max(value, 1e-3)) : 5e-3 * std::max(value, 1.0);
        if (error > allowed) return false;
    }
    return true;
}

/// Blocks of wavelengths at which a black body is not lost in the light around the smoke.
std::vector<unsigned char> glowing_blocks(const SceneTables& tables, double T_K) {
    constexpr float kLeastShare = 1e-7F;
    const SmokeSpectra& s = tables.smoke;
    const PlanckRows::Lookup at = tables.planck.at(T_K);
    std::vector<unsigned char> glows(static_cast<std::size_t>(tables.stride / SpectralKernels::kLanes), 0);
    for (std::size_t l = 0; l < static_cast<std::size_t>(tables.lambdas); ++l) {
        float B = 0.0F;
        for (int j = 0; j < at.count; ++j) B += at.weight[static_cast<std::size_t>(j)] * tables.planck.row(at.row + j)[l];
        if (B > kLeastShare * (s.sky_radiance[l] + s.ground_radiance[l] + s.ground_lit[l]))
            glows[l / SpectralKernels::kLanes] = 1;
    }
    return glows;
}

}  // namespace

SmokeNodes::SmokeNodes(const SceneTables& tables, const SmokeLight& light, std::span<const double> lambda_um,
                       double warmest_K)
    : glows_(glowing_blocks(tables, warmest_K)) {
    const SmokeSpectra& s = tables.smoke;
    scatters_ = s.scatters;
    diffuse_ = !s.diffusion.empty();
    const auto at = [](const std::vector<float>& spectrum, std::size_t l) {
        return spectrum.empty() ? 0.0 : static_cast<double>(spectrum[l]);
    };
    for (std::size_t l = 0; l < lambda_um.size(); ++l) {
        Optics o{at(s.extinction_per_m, l),
                 at(tables.absorption_per_m, l),
                 at(s.asymmetry, l),
                 at(s.beam_per_m, l),
                 at(s.flame_per_m, l),
                 at(s.flame_spread_per_m, l),
                 scatters_ ? static_cast<double>(light.flame_share_m2()[l]) : 0.0,
                 {}};
        for (std::size_t d = 0; diffuse_ && d < o.diffusion.size(); ++d)
            o.diffusion[d] = at(s.diffusion.weight, d * static_cast<std::size_t>(tables.stride) + l);
        optics_.push_back(o);
    }
    std::vector<std::size_t> order(lambda_um.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return lambda_um[a] < lambda_um[b]; });
    std::vector<double> way{0.0};  // along the curve of the optics
    for (std::size_t i = 1; i < order.size(); ++i) {
        const Optics &a = optics_[order[i - 1]], &b = optics_[order[i]];
        const auto step = [](double from, double to) { return std::abs(log_of(to) - log_of(from)); };
        way.push_back(way.back() + step(a.extinction, b.extinction) + step(a.absorption, b.absorption) +
                      step(a.flame_share_m2, b.flame_share_m2) + 2.0 * std::abs(b.asymmetry - a.asymmetry) +
                      step(a.beam, b.beam) + step(a.flame_k, b.flame_k));
    }
    shares_of_.resize(lambda_um.size());
    cut(order, way);
    gather_shares();
    gather_spectra();
    optics_.clear();
    shares_of_.clear();
}

/// -ln of the extinction where it falls all along an interval, as it mostly does; else nothing. Transmittances are smooth
/// functions of it even where the optics have corners, at the samples of their table.
std::vector<double> SmokeNodes::falling_extinction(std::span<const std::size_t> order) const {
    std::vector<double> way;
    for (const std::size_t l : order) {
        way.push_back(-log_of(optics_[l].extinction));
        if (way.size() > 1 && way.back() < way[way.size() - 2]) return {};
    }
    return way.back() - way.front() > 1e-6 ? way : std::vector<double>{};
}

/// Makes nodes for an interval, as few as do, or cuts it in two.
void SmokeNodes::cut(std::span<const std::size_t> order, std::span<const double> curve) {
    const std::vector<double> by_extinction = falling_extinction(order);
    const std::span<const double> way = by_extinction.empty() ? curve : std::span<const double>(by_extinction);
    std::vector<std::array<double, kTrials>> wanted;
    wanted.reserve(order.size());
    for (const std::size_t l : order) wanted.push_back(trials(optics_[l], optics_[order[order.size() / 2]]));
    for (std::size_t count = 1; count <= std::min(kNodes, order.size()); ++count) {
        const auto picked = pick(way, count);
        std::vector<double> places;
        places.reserve(picked.size());
        for (const std::size_t i : picked) places.push_back(way[i]);
        std::vector<std::array<double, kNodes>> weights;
        bool good = true;
        for (std::size_t i = 0; i < order.size() && good; ++i) {
            weights.push_back(lagrange(places, way[i]));
            std::array<double, kTrials> found{};
            for (std::size_t t = 0; t < kTrials; ++t)
                for (std::size_t j = 0; j < picked.size(); ++j) found[t] += weights.back()[j] * wanted[picked[j]][t];
            good = agree(found, wanted[i]);
        }
        if (!good) continue;
        const auto begin = static_cast<int>(wavelength_of_.size());
        for (const std::size_t i : picked) wavelength_of_.push_back(order[i]);
        for (std::size_t i = 0; i < order.size(); ++i)
            for (std::size_t j = 0; j < picked.size(); ++j)
                if (weights[i][j] != 0.0) shares_of_[order[i]].push_back({begin + static_cast<int>(j), weights[i][j]});
        return;
    }
    const std::size_t first = place_to_cut(curve);
    cut(order.first(first), curve.first(first));
    cut(order.subspan(first), curve.subspan(first));
}

/// Entries of each block of wavelengths: the nodes that any of them needs.
void SmokeNodes::gather_shares() {
    constexpr std::size_t kLanes = SpectralKernels::kLanes;
    first_.push_back(0);
    for (std::size_t block = 0; block < shares_of_.size(); block += kLanes) {
        for (std::size_t lane = 0; lane < kLanes && block + lane < shares_of_.size(); ++lane) {
            for (const Share& share : shares_of_[block + lane]) {
                const auto known = std::find(node_of_.begin() + first_.back(), node_of_.end(), share.node);
                const auto entry = static_cast<std::size_t>(known - node_of_.begin());
                if (known == node_of_.end()) {
                    node_of_.push_back(share.node);
                    weight_.resize(weight_.size() + kLanes, 0.0F);
                }
                weight_[entry * kLanes + lane] = static_cast<float>(share.weight);
            }
        }
        first_.push_back(static_cast<int>(node_of_.size()));
    }
}

void SmokeNodes::gather_spectra() {
    node_.n = padded(static_cast<int>(wavelength_of_.size()));
    const auto n = static_cast<std::size_t>(node_.n);
    constexpr std::size_t kPlain = 7;
    spectra_.assign((kPlain + DiffusionNodes::kCount) * n, 0.0F);
    for (std::size_t j = 0; j < wavelength_of_.size(); ++j) {
        const Optics& o = optics_[wavelength_of_[j]];
        const double plain[kPlain] = {o.extinction, o.absorption,   o.asymmetry,     o.beam,
                                      o.flame_k,    o.flame_spread, o.flame_share_m2};
        for (std::size_t q = 0; q < kPlain; ++q) spectra_[q * n + j] = static_cast<float>(plain[q]);
        for (std::size_t d = 0; d < o.diffusion.size(); ++d)
            spectra_[(kPlain + d) * n + j] = static_cast<float>(o.diffusion[d]);
    }
    const auto row = [&](std::size_t q) { return spectra_.data() + q * n; };
    node_.extinction = row(0), node_.absorption = row(1), node_.asymmetry = row(2), node_.beam = row(3);
    node_.flame_k = row(4), node_.flame_spread = row(5), node_.flame_share_m2 = row(6);
    if (!diffuse_) return;
    node_.diffusion_weight = row(kPlain);
    for (int block = 0; block < node_.n; block += SpectralKernels::kLanes) {
        const auto weighs = [&](int d) {
            const float* weight = row(kPlain + static_cast<std::size_t>(d)) + block;
            return std::any_of(weight, weight + SpectralKernels::kLanes, [](float w) { return w != 0.0F; });
        };
        int first = 0, end = DiffusionNodes::kCount;
        while (first < end && !weighs(first)) ++first;
        while (end > first && !weighs(end - 1)) --end;
        first_diffusion_.push_back(first);
        end_diffusion_.push_back(end);
    }
    node_.first_diffusion = first_diffusion_.data();
    node_.end_diffusion = end_diffusion_.data();
}

void SmokeNodes::set(SmokeRun& run) const noexcept {
    run.node = node_;
    run.first = first_.data();
    run.node_of = node_of_.data();
    run.weight = weight_.data();
    run.glows = glows_.data();
}

}  // namespace pyroscene::render
