#include "render/mixture_ray.h"

#include <algorithm>
#include <cstddef>

namespace pyroscene::render {

MixtureRay::MixtureRay(const radiometry::FlameTable& table)
    : table_(&table),
      kernels_(&spectral_kernels()),
      continuum_depth_(static_cast<std::size_t>(table.stride)),
      depth_(continuum_depth_.size()),
      ahead_(continuum_depth_.size()),
      tau_(continuum_depth_.size(), 1.0F),
      opaque_(continuum_depth_.size() / SpectralKernels::kLanes) {
    std::size_t size = 0;
    for (const auto& gas : table.gases) size += static_cast<std::size_t>(gas.row_stride());
    sums_.resize(size);
    float* sums = sums_.data();
    for (const auto& gas : table.gases) {
        gases_.push_back({gas.species == radiometry::GasSpecies::CH4, static_cast<int>(gas.first_lambda.size()),
                          gas.first_lambda.data(), gas.rows.data(), gas.row_stride(), sums});
        sums += gas.row_stride();
    }
}

void MixtureRay::begin() {
    std::fill(sums_.begin(), sums_.end(), 0.0F);
    std::fill(continuum_depth_.begin(), continuum_depth_.end(), 0.0F);
    std::fill(depth_.begin(), depth_.end(), 0.0F);
    std::fill(tau_.begin(), tau_.end(), 1.0F);
    std::fill(opaque_.begin(), opaque_.end(), static_cast<unsigned char>(0));
}

void MixtureRay::add(double T_K, double fill_length_m, const PlanckRows& planck, float scale, float* flame) {
    const auto at = table_->at(T_K);
    const PlanckRows::Lookup emission = planck.at(T_K);
    MixturePiece piece;
    piece.n = table_->stride;
    piece.length_m = static_cast<float>(fill_length_m);
    piece.row = at.row;
    piece.next = at.next;
    piece.weight = at.weight;
    piece.next_weight = at.next_weight;
    piece.continuum = table_->continuum_per_m.data();
    piece.gases = gases_.data();
    piece.gas_count = static_cast<int>(gases_.size());
    piece.planck = planck.row(emission.row);
    piece.planck_weight = emission.weight.data();
    piece.planck_count = emission.count;
    piece.scale = scale;
    piece.continuum_depth = continuum_depth_.data();
    piece.depth = depth_.data();
    piece.ahead = ahead_.data();
    piece.tau = tau_.data();
    piece.opaque = opaque_.data();
    piece.flame = flame;
    kernels_->emit_mixture(piece);
}

}  // namespace pyroscene::render
