#include "inputs/wrf_inputs.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "gis/wrf_plume.h"
#include "gis/wrf_sfire.h"

namespace pyroscene::inputs {
namespace {

using gis::WrfGrid;
using scenario::RasterSource;

/// Latent over sensible heat of burning fuel of moisture f (kg water per kg dry fuel), phys/module_fr_sfire_phys.F, 1415-1417:
/// 0.56 kg of water form per kg of fuel; 2.5 MJ/kg to evaporate, 17.433 MJ/kg of heat.
double latent_share(double moisture) {
    const double water = moisture / (1.0 + moisture);
    return (water + 0.56 * (1.0 - water)) * 2.5e6 / ((1.0 - water) * 17.433e6);
}

class Series {
public:
    Series(const gis::WrfSfire& wrf, double start_unix_s) : wrf_(wrf), start_unix_s_(start_unix_s) {
        for (const auto& moment : wrf.moments)
            if (moment.unix_s >= start_unix_s) moments_.push_back(&moment);
    }
    [[nodiscard]] const std::vector<const gis::WrfMoment*>& moments() const { return moments_; }

    /// Every moment one band for each group of variables.
    [[nodiscard]] RasterSource raster(const std::string& name, const std::string& unit, WrfGrid grid,
                                      const std::vector<std::vector<std::string>>& bands,
                                      gis::WrfCombine combine = gis::WrfCombine::Sum, bool first_only = false) const {
        std::vector<gis::WrfBand> all;
        for (const auto* moment : moments_) {
            for (const auto& variables : bands) all.push_back({moment, variables, moment->unix_s - start_unix_s_});
            if (first_only) break;
        }
        return {.files = {gis::wrf_raster(wrf_, name, unit, grid, all, combine)}, .bands = {}, .times_s = {}};
    }

private:
    const gis::WrfSfire& wrf_;
    double start_unix_s_;
    std::vector<const gis::WrfMoment*> moments_;
};

RasterSource terrain(const gis::WrfSfire& wrf, const Series& series, const std::string& file,
                     std::vector<std::string>& notes) {
    if (wrf.has("ZSF")) return series.raster("terrain", "m", WrfGrid::Fire, {{"ZSF"}}, gis::WrfCombine::Sum, true);
    if (!wrf.has("HGT")) throw input_error(file, "has neither ZSF nor HGT; give inputs.terrain");
    notes.push_back("the WRF files have no ZSF: terrain is HGT of the atmosphere's grid");
    return series.raster("terrain", "m", WrfGrid::Atmosphere, {{"HGT"}}, gis::WrfCombine::Sum, true);
}

std::optional<scenario::WindSource> wind(const gis::WrfSfire& wrf, const Series& series, std::vector<std::string>& notes) {
    scenario::WindSource source;
    if (wrf.has("UF") && wrf.has("VF")) {
        source.raster = series.raster("wind", "m s-1", WrfGrid::Fire, {{"UF"}, {"VF"}});
        return source;
    }
    if (!wrf.has("U10") || !wrf.has("V10")) {
        notes.push_back("the WRF files have neither UF, VF nor U10, V10: calm air; give inputs.wind");
        return std::nullopt;
    }
    notes.push_back("the WRF files have no UF, VF: wind is U10, V10, at 10 m");
    source.raster = series.raster("wind", "m s-1", WrfGrid::Atmosphere, {{"U10"}, {"V10"}});
    return source;
}

/// Heat of the fire grid and of the atmosphere's grid must agree, latent heat must fit the moisture.
void check_heat(const gis::WrfSfire& wrf, const Series& series, std::vector<std::string>& notes) {
    constexpr double kTolerance = 1e-3, kLatentTolerance = 0.2;
    const auto& moments = series.moments();
    for (const std::size_t i : {std::size_t{0}, moments.size() / 2, moments.size() - 1}) {
        const double fire_W = gis::wrf_integral(wrf, *moments[i], "FGRNHFX", WrfGrid::Fire);
        if (!(fire_W > 0.0)) continue;
        if (wrf.has("GRNHFX")) {
            const double coarse_W = gis::wrf_integral(wrf, *moments[i], "GRNHFX", WrfGrid::Atmosphere);
            if (std::abs(coarse_W / fire_W - 1.0) > kTolerance) {
                notes.push_back(
                    fmt::format("WRF record {} of {}: FGRNHFX sums to {:.4g} W, GRNHFX of the atmosphere's grid to {:.4g} W",
                                moments[i]->record, moments[i]->file.string(), fire_W, coarse_W));
                return;
            }
        }
        if (!wrf.has("FGRNQFX") || !wrf.has("FMC_G")) continue;
        const double latent_W = gis::wrf_integral(wrf, *moments[i], "FGRNQFX", WrfGrid::Fire);
        const double cells = static_cast<double>(wrf.cols) * wrf.refine_x * wrf.rows * wrf.refine_y;
        const double cell_m2 = wrf.dx_m / wrf.refine_x * wrf.dy_m / wrf.refine_y;
        const double moisture = gis::wrf_integral(wrf, *moments[i], "FMC_G", WrfGrid::Fire) / (cells * cell_m2);
        const double expected = latent_share(moisture);
        if (std::abs(latent_W / fire_W / expected - 1.0) > kLatentTolerance) {
            notes.push_back(
                fmt::format("WRF record {} of {}: FGRNQFX is {:.3g} of FGRNHFX, but fuel of moisture {:.3g} gives {:.3g}",
                            moments[i]->record, moments[i]->file.string(), latent_W / fire_W, moisture, expected));
            return;
        }
    }
}

gis::WrfSfire open(const scenario::WrfSource& source) {
    std::optional<gis::LocalPlacement> placement;
    if (source.west_m) placement = {source.crs, *source.west_m, *source.south_m};
    return gis::open_wrf_sfire(source.files, placement);
}

void check_plume(const gis::WrfSfire& wrf, const Series& series, const std::string& file, std::vector<std::string>& notes) {
    std::vector<std::string> missing;
    for (const auto& name : gis::wrf_plume_variables())
        if (!wrf.has(name)) missing.push_back(name);
    if (!missing.empty())
        throw input_error(file, fmt::format("has no {}, which inputs.wrf_sfire.plume needs", fmt::join(missing, ", ")));
    if (!wrf.has("GRNHFX")) return;
    constexpr double kTolerance = 2.0;
    for (auto moment = series.moments().rbegin(); moment != series.moments().rend(); ++moment) {
        const double fire_W = gis::wrf_integral(wrf, **moment, "GRNHFX", WrfGrid::Atmosphere);
        if (!(fire_W > 0.0)) continue;
        const double air_W = gis::wrf_heating_W(wrf, **moment);
        if (!(air_W * kTolerance > fire_W && air_W < kTolerance * fire_W))
            notes.push_back(
                fmt::format("WRF record {} of {}: RTHFRTEN heats the air with {:.3g} W, GRNHFX is {:.3g} W: the "
                            "plume is too {}",
                            (*moment)->record, (*moment)->file.string(), air_W, fire_W, air_W < fire_W ? "cool" : "hot"));
        return;
    }
}

}  // namespace

std::filesystem::path wrf_plume_levels(const scenario::Scenario& s, double time_s) {
    const auto wrf = open(*s.inputs.wrf_sfire);
    const gis::WrfMoment* found = nullptr;
    for (const auto& moment : wrf.moments)
        if (moment.unix_s - s.start.unix_s <= time_s) found = &moment;
    if (found == nullptr)
        throw input_error(wrf.moments.front().file.string(),
                          fmt::format("begins after {:g} s, when a plume is needed", time_s));
    return gis::wrf_plume(wrf, *found, s.inputs.plume->levels_m);
}

scenario::Scenario with_wrf_inputs(scenario::Scenario s) {
    if (!s.inputs.wrf_sfire) return s;
    const auto& source = *s.inputs.wrf_sfire;
    const auto wrf = open(source);
    const auto file = source.files.front().string();
    const Series series(wrf, s.start.unix_s);
    if (series.moments().empty())
        throw input_error(file, fmt::format("ends {:g} s before the scenario's start ({})",
                                            s.start.unix_s - wrf.moments.back().unix_s, s.start.iso8601()));
    if (const auto skipped = wrf.moments.size() - series.moments().size(); skipped > 0)
        s.notes.push_back(fmt::format("{} of {} WRF records lie before the scenario's start and are left out", skipped,
                                      wrf.moments.size()));

    if (source.plume) check_plume(wrf, series, file, s.notes);

    auto& in = s.inputs;
    if (in.terrain.files.empty()) in.terrain = terrain(wrf, series, file, s.notes);
    if (in.heat_flux.files.empty()) {
        if (!wrf.has("FGRNHFX"))
            throw input_error(
                file, fmt::format("has no FGRNHFX, the heat flux of the fire; it has {}", fmt::join(wrf.variables, ", ")));
        std::vector<std::string> fluxes{"FGRNHFX"};
        if (wrf.has("FCANHFX")) fluxes.emplace_back("FCANHFX");
        in.heat_flux = series.raster("heat_flux", "W m-2", WrfGrid::Fire, {fluxes});
        check_heat(wrf, series, s.notes);
    }
    const auto missing = [&](const char* names, const char* consequence) {
        s.notes.push_back(fmt::format("the WRF files have no {}: {}", names, consequence));
    };
    if (!in.fuel_load) {
        if (wrf.has("FUEL_FRAC") && wrf.has("FGIP"))
            in.fuel_load =
                series.raster("fuel_load", "kg m-2", WrfGrid::Fire, {{"FUEL_FRAC", "FGIP"}}, gis::WrfCombine::Product);
        else
            missing("FUEL_FRAC and FGIP", "no fuel load");
    }
    if (!in.arrival) {
        if (wrf.has("TIGN_G"))
            in.arrival = RasterSource{.files = {gis::wrf_arrival(wrf, s.start.unix_s)}, .bands = {}, .times_s = {}};
        else
            missing("TIGN_G", "clocks of scars start at the records that show them burning");
    }
    if (!in.wind || !in.wind->has_source())
        if (auto found = wind(wrf, series, s.notes)) {
            if (!in.wind) in.wind.emplace();
            in.wind->raster = std::move(found->raster);
        }
    if (!in.cover && !source.fuel_table.empty()) {
        if (!wrf.has("NFUEL_CAT")) throw input_error(file, "has no NFUEL_CAT, which fuel_table is about");
        in.cover = scenario::CoverSource{
            series.raster("fuel", "", WrfGrid::Fire, {{"NFUEL_CAT"}}, gis::WrfCombine::Sum, true), source.fuel_table};
    }
    return s;
}

}  // namespace pyroscene::inputs
