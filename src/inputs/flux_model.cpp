#include "inputs/flux_model.h"

#include <fmt/format.h>

#include "base/error.h"
#include "gis/fire_model_files.h"

namespace pyroscene::inputs {

scenario::Scenario with_flux_model(scenario::Scenario s) {
    if (!s.inputs.flux_model) return s;
    const auto& source = *s.inputs.flux_model;
    const gis::LocalPlacement place{source.crs, source.west_m, source.south_m};
    const auto series = source.model == "fds"
                            ? gis::fds_heat_flux(source.files.front(), source.quantity, place)
                            : gis::quic_fire_heat_flux(source.files, {source.cols, source.rows, source.cell_m, place});
    auto& flux = s.inputs.heat_flux;
    flux = {};
    flux.files = {series.raster};
    for (std::size_t i = 0; i < series.times_s.size(); ++i) {
        const double time_s = series.times_s[i] + source.offset_s;
        if (time_s < 0.0) continue;
        flux.bands.push_back(static_cast<int>(i) + 1);
        flux.times_s.push_back(time_s);
    }
    const auto before = series.times_s.size() - flux.times_s.size();
    if (flux.times_s.empty())
        throw input_error(source.files.front().string(), fmt::format("ends {:g} s before the scenario's start",
                                                                     -(series.times_s.back() + source.offset_s)));
    if (before > 0)
        s.notes.push_back(fmt::format("{} of {} moments of the heat flux lie before the scenario's start and are left out",
                                      before, series.times_s.size()));
    return s;
}

std::vector<std::filesystem::path> flux_model_files(const scenario::FluxModelSource& source) {
    auto files = source.files;
    if (source.model == "fds")
        for (auto& file : gis::fds_files(files.front(), gis::fds_flux_labels(source.quantity)))
            files.push_back(std::move(file));
    return files;
}

}  // namespace pyroscene::inputs
