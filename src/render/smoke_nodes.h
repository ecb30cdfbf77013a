#pragma once

#include <array>
#include <span>
#include <vector>

#include "render/diffusion_nodes.h"
#include "render/smoke_run.h"

namespace pyroscene::render {

struct SceneTables;
class SmokeLight;

/// The few wavelengths at which rays are marched through smoke (SmokeRun), and how the results come to all others. Extinction,
/// asymmetry and the share of flames are smooth along wavelength, so the wavelengths are cut, in ascending order, into intervals
/// with up to four of them as nodes and polynomials between, cut in two until trial functions of those spectra come out right: transmittances
/// of optical depths up to 8 within 2e-4 and, above 1e-3, 2 % of themselves; phase functions and shares within 5e-3. Weights
/// sum to 1, so a furnace stays one. A wavelength alone is its own node.
class SmokeNodes {
public:
    /// \param warmest_K  temperature of smoke
    SmokeNodes(const SceneTables& tables, const SmokeLight& light, std::span<const double> lambda_um, double warmest_K);

    [[nodiscard]] int count() const noexcept { return node_.n; }
    /// Sets the nodes of a run and their way to the wavelengths; all of it lives as long as this.
    void set(SmokeRun& run) const noexcept;

private:
    /// What the march depends on at one wavelength.
    struct Optics {
        double extinction, absorption, asymmetry, beam, flame_k, flame_spread, flame_share_m2;
        std::array<double, DiffusionNodes::kCount> diffusion;
    };
    struct Share {
        int node;
        double weight;
    };
    [[nodiscard]] std::vector<double> falling_extinction(std::span<const std::size_t> order) const;
    void cut(std::span<const std::size_t> order, std::span<const double> curve);
    void gather_shares();
    void gather_spectra();

    std::vector<Optics> optics_;                 ///< [wavelength]
    std::vector<std::size_t> wavelength_of_;     ///< [node]
    std::vector<std::vector<Share>> shares_of_;  ///< [wavelength]
    bool scatters_ = false, diffuse_ = false;
    SmokeWaySpectra node_;
    std::vector<float> spectra_;  ///< that node_ points into
    std::vector<int> first_, node_of_, first_diffusion_, end_diffusion_;
    std::vector<float> weight_;
    std::vector<unsigned char> glows_;
};

}  // namespace pyroscene::render
