#include "radiometry/alkali_thesis.h"

#include <cmath>

#include "base/constants.h"

namespace pyroscene::radiometry {
namespace {

constexpr double kThesisIonisation_J = 6.92064e-19, kThesisBoltzmann_J_K = 1.38e-23, kThesisPlanck_J_s = 6.63e-34;
constexpr double kElectronMass_kg = 9.109e-31;

/// Saha's right-hand side [1/m3] without the partition functions.
double saha_per_m3(double T_K, double k_J_K, double h_J_s, double energy_J) noexcept {
    return 2.0 * std::pow(2.0 * kPi * kElectronMass_kg * k_J_K * T_K / (h_J_s * h_J_s), 1.5) *
           std::exp(-energy_J / (k_J_K * T_K));
}

}  // namespace

double thesis_ionised_fraction(const ThesisPotassium& in, double T_K) noexcept {
    const double R = in.partition_ratio / in.electron_density_per_m3 *
                     saha_per_m3(T_K, kThesisBoltzmann_J_K, kThesisPlanck_J_s, kThesisIonisation_J);
    return R / (R + 1.0);
}

double thesis_potassium_power_W(const ThesisPotassium& in, double T_K) noexcept {
    return 1.6 * in.potassium_density_per_m3 * in.decay_rate_per_s * in.excited_share * in.excited_energy_J *
           thesis_ionised_fraction(in, T_K) * in.volume_m3;
}

double thesis_potassium_ratio(const ThesisPotassium& in, double T_K, double emissivity, double lower_nm,
                              double upper_nm) noexcept {
    constexpr double kStep_nm = 0.01;
    double sum = 0.0;
    const int steps = static_cast<int>(std::lround((upper_nm - lower_nm) / kStep_nm));
    for (int i = 0; i < steps; ++i) {
        const double lambda_m = (lower_nm + (i + 0.5) * kStep_nm) * 1e-9;
        const double exponent = kThesisPlanck_J_s * kLightSpeed_m_s / (lambda_m * kThesisBoltzmann_J_K * T_K);
        sum += 2.0 * kPi * kThesisPlanck_J_s * kLightSpeed_m_s * kLightSpeed_m_s * emissivity /
               (std::pow(lambda_m, 5) * std::expm1(exponent)) * 1e-9 * kStep_nm;
    }
    return thesis_potassium_power_W(in, T_K) / (sum * 1e-9 * in.aperture_m2);
}

double potassium_ionised_fraction(double T_K, double atoms_per_m3) noexcept {
    constexpr double kIonisation_J = 4.340664 * 1.602176634e-19, kPartitionRatio = 0.5;
    const double r = kPartitionRatio * saha_per_m3(T_K, kBoltzmann_J_K, kPlanck_J_s, kIonisation_J) / atoms_per_m3;
    return 2.0 * r / (r + std::sqrt(r * r + 4.0 * r));  // the positive root of f^2 + r f - r = 0
}

}  // namespace pyroscene::radiometry
