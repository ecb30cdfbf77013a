#pragma once

#include <span>
#include <vector>

namespace pyroscene::analysis {

/// Fire radiative energy from powers at moments: E(t_k) = sum of (t_i - t_i-1) (P_i + P_i-1) / 2 (trapezoids; nothing before the first
/// moment and after the last). NaN counts as no power.
/// \param time_s ascending   \param power  one per moment   \return energy up to each moment, unit of power x s
std::vector<double> fire_radiative_energy(std::span<const double> time_s, std::span<const double> power);

/// The same for planes, moment by moment: add() them in order of time.
class EnergyMap {
public:
    /// Throws nothing; planes must have one size and times ascend.
    void add(double time_s, std::span<const float> power);
    [[nodiscard]] const std::vector<double>& energy() const noexcept { return energy_; }
    /// When the power of a cell was largest [s]; NaN where there never was any.
    [[nodiscard]] const std::vector<float>& time_of_peak_s() const noexcept { return peak_s_; }

private:
    double last_s_ = 0.0;
    std::vector<float> last_, peak_, peak_s_;
    std::vector<double> energy_;
};

}  // namespace pyroscene::analysis
