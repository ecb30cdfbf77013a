#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "radiometry/assemble_atmosphere.h"

namespace pyroscene::radiometry {

/// What assemble_atmosphere works on: everything the runs say, and the nodes on which the table needs it.
class Assembly {
public:
    using Array = std::vector<double>;
    using Member = Array AtmosphereRun::*;
    using Filter = std::function<bool(const AtmosphereRun&)>;

    Assembly(std::vector<AtmosphereRun> runs, bool without_sun);
    AssembledAtmosphere make();

private:
    /// What the ground receives, and what of it is known only together with the view path.
    struct Ground {
        Array albedos;                          ///< of the runs over reflecting ground
        Array spherical_albedo, sky;            ///< S and the thermal irradiance
        std::vector<bool> sky_from_sunlit_run;  ///< per wavelength: sky taken from a run that has a sun too
        std::vector<Array> direct, diffuse;     ///< per sun zenith
        std::vector<Array> direct_seen;         ///< E_dir C from reflected light; NaN where unknown
    };

    void normalise();
    void make_axes();
    void make_path_axes();
    void fill_paths(AtmosphereTable& t);
    void append_path_node(AtmosphereTable& t, double altitude_km, double view_deg);
    void append_path_solar(AtmosphereTable& t, double altitude_km, double view_deg, const Filter& dark);
    void fill_ground(AtmosphereTable& t);
    void find_spherical_albedo(Ground& g);
    [[nodiscard]] bool spherical_albedo_from_reflection(Ground& g) const;
    [[nodiscard]] bool spherical_albedo_from_irradiance(Ground& g) const;
    void find_sky(Ground& g);
    void sky_from_looking_up(Array& sky);
    void split_sunlit_sky(Ground& g);
    void find_sun(Ground& g, std::size_t s);
    void fill_view_terms(AtmosphereTable& t, const Ground& g);
    [[nodiscard]] Array upward_transmittance(const Ground& g, const Filter& node) const;
    [[nodiscard]] Array correlation(const Ground& g, const Filter& node, std::size_t s) const;
    void extend_view(AtmosphereTable& t) const;
    void note(std::string text) { notes_.push_back(std::move(text)); }

    /// Tells the transmittance of a path down to the ground, or half of it (two_temperatures).
    [[nodiscard]] static bool is_path(const AtmosphereRun& r) {
        const bool of_a_pair = !r.total_radiance.empty() && r.geometry.surface_temperature_K;
        return !r.looks_up && (!r.transmittance.empty() || of_a_pair);
    }
    static bool is_dark(const AtmosphereRun& r) { return !r.geometry.albedo || *r.geometry.albedo <= 1e-6; }
    static bool looks_down(const AtmosphereRun& r) { return !r.looks_up; }

    /// Values of a term on the table's wavelengths, from the first wanted run that covers each; `missing` elsewhere.
    [[nodiscard]] Array collect(Member term, const Filter& wanted, double missing) const;
    [[nodiscard]] bool any(Member term, const Filter& wanted) const;
    [[nodiscard]] Filter at_node(double altitude_km, double view_deg) const;
    [[nodiscard]] Filter under_sun(double sun_deg) const;
    [[nodiscard]] Array two_temperatures(const Filter& node, Array* path_thermal) const;
    /// pi L / (A tau) of the first run that has it: what ground of albedo A receives. \param sun_deg < 0: of runs without a sun
    [[nodiscard]] Array ground_irradiance(Member reflected, double albedo, double sun_deg) const;

    std::vector<AtmosphereRun> runs_;
    bool without_sun_;
    std::vector<std::string> notes_;
    Array lambda_, altitude_km_, view_deg_, sun_deg_, azimuth_deg_;
};

namespace assembly {

inline constexpr double kSmallTau = 1e-4;  ///< below it reflected light says nothing about the ground

bool same(const std::optional<double>& a, double b);
/// Distinct values in ascending order.
std::vector<double> distinct(const std::vector<AtmosphereRun>& runs, const Assembly::Filter& wanted,
                             std::optional<double> RunGeometry::*of);
/// Linear between the run's samples.
double at_wavelength(const AtmosphereRun& run, const std::vector<double>& values, double lambda_um);
bool covers(const AtmosphereRun& run, double lambda_um);
void append(std::vector<float>& to, const std::vector<double>& values);

}  // namespace assembly

}  // namespace pyroscene::radiometry
