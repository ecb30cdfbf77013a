#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "radiometry/atmosphere_table.h"

namespace pyroscene::radiometry {

/// Contiguous samples of a table's wavelength axis.
struct LambdaRange {
    std::size_t begin = 0, end = 0;
    [[nodiscard]] std::size_t size() const noexcept { return end - begin; }
};

/// What one table says about one path, in the quantities that interpolate well: ln(transmittance), and path radiance
/// divided by the absorptance 1 - transmittance (the effective source of the path). Arrays over a LambdaRange.
struct PathTerms {
    std::vector<double> ln_tau;                        ///< <= 0
    std::vector<double> thermal_source;                ///< L_pt / (1 - tau)
    std::array<std::vector<double>, 3> solar_source;   ///< L_ps / (1 - tau) at relative azimuth 0, 90, 180 deg
    std::vector<double> correlation;                   ///< C >= 1
    std::vector<double> diffuse_transmittance;         ///< t_d
    std::vector<double> direct, diffuse, thermal_sky;  ///< irradiances of the ground
    std::vector<double> spherical_albedo;
    void resize(std::size_t n);
};

/// 85 deg. The tables hold for plane layers of air; nearer to the horizon that says nothing any more.
inline constexpr double kLargestViewSecant = 11.473713245669854;

/// A table reduced to one sensor altitude and one sun zenith angle, for all its view angles. Scheme of
/// data/atmosphere/README.md: ln tau and t_d in u = 1 - exp(-h / 4 km), sources (the thermal one by its brightness temperature) and ln C in ln h, in the secant of the sun
/// zenith; E_dif in its cosine. Below the lowest altitude node tau, C and t_d go to 1, 1 and 0 at the ground and the sources
/// keep their value; above the highest one the table is clamped.
class TableSlice {
public:
    /// \param altitude_km above ground, >= 0   \param sun_zenith_rad 0 .. pi/2, clamped to the table's largest
    TableSlice(const AtmosphereTable& table, LambdaRange range, double altitude_km, double sun_zenith_rad);

    /// Terms of a view direction, linear in the secant between the table's view angles. Beyond the last of them ln tau goes on as
    /// between the last two, up to kLargestViewSecant; the other terms, sources among them, stay.
    void at(double view_secant, PathTerms& out) const;

private:
    struct Node {
        std::vector<double> ln_tau, thermal_source, ln_correlation, diffuse_transmittance;
        std::array<std::vector<double>, 3> ln_solar_source;
    };
    struct SlicePosition;
    static void fill_view_node(const AtmosphereTable& table, std::size_t v, LambdaRange range, const SlicePosition& at,
                               Node& node);
    void follow_beers_law(double beyond_secant, std::vector<double>& ln_tau) const;
    void fill_ground(const AtmosphereTable& table, LambdaRange range, const SlicePosition& at);

    std::vector<double> secant_;
    std::vector<Node> nodes_;  ///< per view zenith of the table
    std::vector<double> direct_, diffuse_, thermal_sky_, spherical_albedo_;
};

}  // namespace pyroscene::radiometry
