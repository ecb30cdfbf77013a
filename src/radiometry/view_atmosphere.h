#pragma once

#include <cstddef>
#include <vector>

namespace pyroscene::radiometry {

/// Light from above on the ground, [lambda]. Solar terms are zero at night.
struct GroundIllumination {
    std::vector<float> direct_normal_irradiance_W_m2_um;  ///< on a plane normal to the beam
    std::vector<float> diffuse_irradiance_W_m2_um;        ///< horizontal, including ground-sky bounces
    std::vector<float> thermal_irradiance_W_m2_um;        ///< horizontal, from the sky
};

/// Everything the atmosphere does on the transport grid of one acquisition: illumination of the ground and, per height of
/// the ground and view zenith angle, what happens between there and the sensor. Index i runs over the SpectralGrid's nodes.
/// Illumination of the ground: the members of the base at height 0.
struct ViewAtmosphere : GroundIllumination {
    std::vector<GroundIllumination> illumination;  ///< [height]; empty: that of height 0 at all heights

    // View dependent: [height][node][lambda], heights falling, nodes ascending in secant of the view zenith angle at the ground.
    std::vector<double> height_m{0.0};  ///< of the ground, above a reference
    std::vector<double> node_secant;
    std::vector<float> transmittance;
    std::vector<float> ln_transmittance_step;  ///< to the next node (0 at the last), at least -6; empty: one node
    std::vector<float> ln_transmittance_drop;  ///< to the next lower ground (0 at the last), at least -6; empty: one height
    std::vector<float> path_thermal_W_m2_sr_um;
    std::vector<float> path_solar_a0, path_solar_a1, path_solar_a2;  ///< cosine series in relative azimuth [W m-2 sr-1 um-1]
    std::vector<float> solar_correlation;                            ///< C of the reflected beam, 1 in clear windows
    std::vector<float> adjacency_W_m2_sr_um;                         ///< light of the surroundings scattered into the view

    [[nodiscard]] int lambda_count() const noexcept { return static_cast<int>(direct_normal_irradiance_W_m2_um.size()); }
    /// Of ground at height_m[i].
    [[nodiscard]] const GroundIllumination& illumination_at(std::size_t i) const noexcept {
        return illumination.empty() ? *this : illumination[i];
    }

    /// View terms interpolated to one direction, arrays of lambda_count().
    struct View {
        std::vector<float> transmittance, path_thermal, path_solar, solar_correlation, adjacency;
        void resize(int n);
    };
    /// \param view_zenith_rad at the ground, clamped to 85 deg  \param relative_azimuth_rad sun azimuth minus azimuth of
    ///        the line of sight (sensor to target): 0 = looking towards the sun  \param ground_m height of the ground seen, as
    ///        height_m, clamped.  `out` must be resized; no allocation.
    void at(double view_zenith_rad, double relative_azimuth_rad, double ground_m, View& out) const noexcept;
};

/// No air at all: transmittance and solar correlation 1, everything else 0; `lambda_count` nodes.
ViewAtmosphere vacuum(int lambda_count);

}  // namespace pyroscene::radiometry
