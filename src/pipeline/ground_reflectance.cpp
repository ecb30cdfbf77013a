#include "pipeline/ground_reflectance.h"

#include <algorithm>

#include "base/files.h"
#include "radiometry/user_spectra.h"

namespace pyroscene::pipeline {
namespace {

/// Means of one spectrum over the nodes' windows.
std::vector<double> on_grid(const radiometry::SurfaceLibrary& library, const scenario::Scenario& s, const std::string& name,
                            const radiometry::SpectralGrid& grid) {
    const auto& reflectance = library.reflectance[static_cast<std::size_t>(library.index_of(name))];
    if (s.surface.spectra.contains(name) && grid.size() > 0)
        check_coverage(library, name, *std::min_element(grid.cell_lower_um.begin(), grid.cell_lower_um.end()),
                       *std::max_element(grid.cell_upper_um.begin(), grid.cell_upper_um.end()));
    std::vector<double> out;
    for (std::size_t i = 0; i < static_cast<std::size_t>(grid.size()); ++i) {
        const double lower = grid.cell_lower_um[i], upper = grid.cell_upper_um[i];
        out.push_back(upper > lower ? mean_over(reflectance, lower, upper) : reflectance.at(grid.lambda_um[i]));
    }
    return out;
}

}  // namespace

radiometry::SurfaceLibrary scenario_surfaces(const scenario::Scenario& scenario) {
    auto library = radiometry::load_surfaces(data_folder() / "optical" / "surface_reflectance.csv");
    radiometry::add_spectra(library, scenario.surface.spectra);
    return library;
}

std::vector<float> ground_reflectance(const scenario::Scenario& scenario, const std::vector<std::string>& covers,
                                      const radiometry::SpectralGrid& grid) {
    const auto nodes = static_cast<std::size_t>(grid.size());
    const auto& surface = scenario.surface;
    if (surface.emissivity)
        return std::vector<float>((covers.size() + 1) * nodes, static_cast<float>(1.0 - *surface.emissivity));
    const auto library = scenario_surfaces(scenario);
    std::vector<float> out;
    for (const auto& name : covers)
        for (const double value : on_grid(library, scenario, name, grid)) out.push_back(static_cast<float>(value));
    const auto burned = on_grid(library, scenario, surface.burned, grid);
    const double share = surface.burn_severity;
    const auto ash = share > 0.0 ? on_grid(library, scenario, surface.ash, grid) : burned;
    for (std::size_t i = 0; i < nodes; ++i) out.push_back(static_cast<float>((1.0 - share) * burned[i] + share * ash[i]));
    return out;
}

radiometry::TotalEmissivity burnt_emissivity(const scenario::Scenario& scenario) {
    const auto& surface = scenario.surface;
    radiometry::TotalEmissivity out;
    if (surface.emissivity) {
        out.value.fill(*surface.emissivity);
        return out;
    }
    const auto library = scenario_surfaces(scenario);
    const auto of = [&](const std::string& name) {
        return radiometry::total_emissivity(library.reflectance[static_cast<std::size_t>(library.index_of(name))]);
    };
    const auto burned = of(surface.burned), ash = of(surface.ash);
    for (std::size_t i = 0; i < out.value.size(); ++i)
        out.value[i] = (1.0 - surface.burn_severity) * burned.value[i] + surface.burn_severity * ash.value[i];
    return out;
}

}  // namespace pyroscene::pipeline
