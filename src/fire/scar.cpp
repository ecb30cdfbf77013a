#include "fire/scar.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/constants.h"

namespace pyroscene::fire {
namespace {

constexpr ScarModelRow kModels[] = {
    {ScarModel::DoubleExponential, "double_exponential", 2, ScarCooling{}},
    {ScarModel::SingleExponential, "single_exponential", 1,
     ScarCooling{.amplitude1_K = 800.0 - 34.0,
                 .time_constant1_s = 100.0,
                 .amplitude2_K = 0.0,
                 .time_constant2_s = 100.0,
                 .floor_K = kZeroCelsius_K + 34.0}},
};

}  // namespace

std::span<const ScarModelRow> scar_models() noexcept { return kModels; }

const ScarModelRow& scar_model(ScarModel model) noexcept {
    return *std::find_if(std::begin(kModels), std::end(kModels),
                         [&](const ScarModelRow& row) { return row.model == model; });
}

double scar_temperature_K(const ScarCooling& cooling, double time_s) noexcept {
    const double t = std::max(time_s, 0.0);
    return cooling.amplitude1_K * std::exp(-t / cooling.time_constant1_s) +
           cooling.amplitude2_K * std::exp(-t / cooling.time_constant2_s) + cooling.floor_K;
}

const ScarCooling& scar_of_cell(const FireState& state, const FireParameters& parameters, std::size_t cell) noexcept {
    const std::size_t scar_class = state.scar_class.values.empty() ? 0 : state.scar_class.values[cell];
    return scar_class == 0 || scar_class > parameters.scar_of_cover.size()
               ? parameters.scar
               : parameters.scar_of_cover[scar_class - 1].cooling;
}

double scar_or_ambient_K(const FireParameters& parameters, const ScarCooling& cooling, double time_s) noexcept {
    return std::max(parameters.ambient_temperature_K, scar_temperature_K(cooling, time_s));
}

double scar_or_ambient_K(const FireParameters& parameters, double time_s) noexcept {
    return scar_or_ambient_K(parameters, parameters.scar, time_s);
}

}  // namespace pyroscene::fire
