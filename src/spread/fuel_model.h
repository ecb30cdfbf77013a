#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "fire/burn_out.h"

namespace pyroscene::spread {

/// Size classes of a fuel bed: dead wood by its time lag, live herbs, live woody plants.
enum FuelClass { kOneHour, kTenHours, kHundredHours, kHerb, kWoody, kFuelClasses };
using PerFuelClass = std::array<double, kFuelClasses>;

/// Parameters of a fire-behaviour fuel model (Anderson 1982; Scott and Burgan 2005).
struct FuelModel {
    int number = 0;
    std::string code;                  ///< FM3, GR2
    bool dynamic = false;              ///< cured herbs count as dead fuel
    double depth_m = 0.0;              ///< of the fuel bed
    double extinction_moisture = 0.0;  ///< of dead fuel, water / dry mass
    double heat_dead_J_kg = 0.0, heat_live_J_kg = 0.0;
    PerFuelClass load_kg_m2{};
    PerFuelClass surface_to_volume_per_m{};

    [[nodiscard]] double total_load_kg_m2() const noexcept;
    /// Characteristic surface-to-volume ratio of the uncured bed (fire/residence_time.h); 0 without fuel.
    [[nodiscard]] double characteristic_surface_to_volume_per_m() const noexcept;
};

using FuelModels = std::map<int, FuelModel>;

/// A table of fuel models with the columns of data/fuel/fuel_models_53.csv that are in SI. Throws an input error naming file, line and
/// column for a value out of range, a number given twice or above 65535, and below 1.
FuelModels read_fuel_models(const std::filesystem::path& csv);

/// The 53 models that ship: 1-13 and 101-204.
const FuelModels& standard_fuel_models();

/// Codes that carry no fire (data/fuel/nonburnable.csv): 91 urban, 92 snow, 93 agriculture, 98 water, 99 bare.
const std::set<int>& nonburnable_codes();

/// How the fuel of a model burns out: the fine dead and live classes while its flames stand, 10-h and 100-h fuel over
/// `coarse_time_s` (fire/burn_out.h). An assumption: fuel models do not say it.
fire::BurnOut burn_out_of(const FuelModel& model, double coarse_time_s) noexcept;

}  // namespace pyroscene::spread
